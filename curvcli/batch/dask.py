"""Engine of a Dask cluster: the workers of one machine, each owned by a thread of a Dask worker."""

from __future__ import annotations

import logging
import threading
import uuid
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any

from .._version import __version__
from ..errors import CurvcliError, MissingExtraError, UsageError
from .model import BatchItem, BatchSettings, Engine, Limits, Row
from .outcome import lost
from .processes import ONE_THREAD, WorkerProcess

# Seconds to wait for a scheduler, and then for its first worker.
_WAIT = 15.0


class SchedulerLostError(CurvcliError):
    """Connection to a cluster lost during the work."""


@contextmanager
def connect(scheduler: str, limits: Limits) -> Iterator[Engine]:
    """Engine on the cluster at an address, or on `local:N` Dask workers of this machine.

    If a Dask worker is killed, its meshes are tried again elsewhere; only a mesh that ends several of them is given up.
    Workers must see the folder of the outputs, and have the same version of curvcli.
    Errors: MissingExtraError without Dask, UsageError for an address where no scheduler or no worker answers, and for
    workers with another version.
    """
    try:
        import distributed  # noqa: F401
    except ImportError:
        raise MissingExtraError(f"--scheduler {scheduler}: needs Dask; `pip install 'curvcli[dask]'`") from None
    if scheduler.startswith("local:"):
        count = scheduler.removeprefix("local:")
        if not count.isdecimal() or int(count) < 1:
            raise UsageError(f"--scheduler {scheduler}: expected local:N with a number of workers")
    elif "://" not in scheduler:
        raise UsageError(f"--scheduler {scheduler}: expected an address such as tcp://host:8786, or local:N")

    from distributed import Future, as_completed

    for name in ("distributed.client", "distributed.scheduler", "distributed.nanny", "distributed.core"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # a dead worker is reported in a row, or retried
    with ExitStack() as stack:
        client = _client(stack, scheduler)

        def engine(items: Sequence[BatchItem], settings: BatchSettings) -> Iterator[Row]:
            run = uuid.uuid4().hex
            futures: dict[Future, BatchItem] = {
                client.submit(in_worker, item, settings, limits, key=f"curvcli-{run}-{index}", pure=False): item
                for index, item in enumerate(items)
            }
            for future in as_completed(list(futures), loop=client.loop):
                yield _row(future, futures.pop(future), limits, scheduler)
                future.release()

        yield engine


def _client(stack: ExitStack, scheduler: str) -> Any:
    from distributed import Client, LocalCluster

    if scheduler.startswith("local:"):
        count = int(scheduler.removeprefix("local:"))
        cluster = LocalCluster(
            n_workers=count, threads_per_worker=1, processes=True, dashboard_address=None, env=ONE_THREAD
        )
        client = stack.enter_context(Client(stack.enter_context(cluster)))
    else:
        try:
            client = stack.enter_context(Client(scheduler, timeout=_WAIT, set_as_default=False))
        except (OSError, TimeoutError, ValueError) as error:
            raise UsageError(f"--scheduler {scheduler}: no scheduler answers ({error})") from None
    try:
        client.wait_for_workers(1, timeout=_WAIT)
    except TimeoutError:
        raise UsageError(f"--scheduler {scheduler}: it has no workers; start one with `dask worker`") from None
    _check_versions(client, scheduler)
    return client


def _check_versions(client: Any, scheduler: str) -> None:
    """Refuse workers with another version of curvcli."""
    versions = client.run(_version, on_error="return")
    others = {str(version) for version in versions.values()} - {__version__}
    if others:
        raise UsageError(
            f"--scheduler {scheduler}: curvcli {__version__} here, {', '.join(sorted(others))} on the workers; "
            "install the same version on all"
        )
    try:
        client.get_versions(check=True)
    except ValueError as error:
        lines = " ".join(str(error).split())
        raise UsageError(f"--scheduler {scheduler}: workers differ from this machine: {lines}") from None


def _version() -> str:
    return __version__


def _row(future: Any, item: BatchItem, limits: Limits, scheduler: str) -> Row:
    from concurrent.futures import CancelledError

    from distributed.scheduler import KilledWorker

    try:
        row: Row = future.result()
    except KilledWorker:
        return lost(item.path, -9, limits, late=False)
    except (CancelledError, OSError) as error:
        raise SchedulerLostError(f"--scheduler {scheduler}: lost ({error}); --resume continues") from error
    return row


_mine = threading.local()


def in_worker(item: BatchItem, settings: BatchSettings, limits: Limits) -> Row:
    """Run one mesh on a Dask worker, in a separate process, so that limits hold and a crash affects no other mesh.

    Each thread of the Dask worker keeps its process for the next mesh; the process ends when the Dask worker does.
    """
    if getattr(_mine, "limits", None) != limits:
        if hasattr(_mine, "worker"):
            _mine.worker.end()
        _mine.worker, _mine.limits = WorkerProcess(limits), limits
    row: Row = _mine.worker.run(item, settings)
    return row
