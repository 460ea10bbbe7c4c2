"""Engine of one machine: reused worker processes, each with one mesh at a time."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from queue import SimpleQueue

from .._version import __version__
from .messages import NO_MESSAGE, Done, Ready, Task, receive, send
from .model import BatchItem, BatchSettings, Engine, Limits, Row
from .outcome import lost

# One thread per worker: there are as many workers as processors to use.
_POOLS = ("POLARS_MAX", "OMP_NUM", "OPENBLAS_NUM", "MKL_NUM", "NUMEXPR_NUM", "VECLIB_MAXIMUM", "RAYON_NUM")
ONE_THREAD = {f"{pool}_THREADS": "1" for pool in _POOLS}
_STARTS = 3


class WorkerProcess:
    """Process that runs one mesh after the other; it is replaced when it dies or is stopped by the timeout."""

    def __init__(self, limits: Limits):
        self._limits = limits
        self._process: subprocess.Popen[bytes] | None = None
        self._is_ready = False
        self._stopped = False
        self._late = False
        self._lock = threading.Lock()

    def begin(self) -> None:
        """Start the process without waiting until it is ready."""
        with self._lock:
            if not self._stopped:
                self._process = _start()
        if self._process is not None:
            with suppress(OSError):  # it has died already, and reading its answer will fail
                send(self._process.stdin, self._limits)  # type: ignore[arg-type]

    def run(self, item: BatchItem, settings: BatchSettings) -> Row:
        """Run one mesh and return its row, even if the process dies."""
        process = self._ready()
        self._late = False
        timer = threading.Timer(self._limits.seconds or 0, self._too_late)
        if self._limits.seconds is not None:
            timer.start()
        try:
            send(process.stdin, Task(item, settings))  # type: ignore[arg-type]
            done = receive(process.stdout, Done)  # type: ignore[arg-type]
        except NO_MESSAGE:
            self.end()
            done = Done(lost(item.path, process.returncode, self._limits, late=self._late), True)
        finally:
            timer.cancel()
            if timer.ident is not None:
                timer.join()
        if done.spent or self._late:
            self.end()
        return done.row

    def stop(self) -> None:
        """Kill the process for good; a thread that waits for its answer gets the error."""
        with self._lock:
            self._stopped = True
            if self._process is not None:
                self._process.kill()

    def end(self) -> None:
        """Kill the process and free its resources; to be called by the thread that uses it."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            for stream in (self._process.stdin, self._process.stdout):
                with suppress(OSError):
                    stream.close()  # type: ignore[union-attr]
            self._process, self._is_ready = None, False

    def _too_late(self) -> None:
        self._late = True
        if self._process is not None:
            self._process.kill()

    def _ready(self) -> subprocess.Popen[bytes]:
        """Process that has sent `Ready`; starting does not count as time of a mesh."""
        if self._process is not None and self._is_ready and self._process.poll() is None:
            return self._process
        if self._is_ready:
            self.end()
        ended = 0
        for _ in range(_STARTS):
            if self._process is None:
                self.begin()
            if self._process is None:
                break
            process = self._process
            try:
                if receive(process.stdout, Ready).version == __version__:  # type: ignore[arg-type]
                    self._is_ready = True
                    return process
            except NO_MESSAGE:
                ended = process.wait()
            self.end()
        raise RuntimeError(f"a worker cannot start: it ends with {ended}")


def _start() -> subprocess.Popen[bytes]:
    # With the sys.path of this process, so that a worker imports the same modules and none from its folder.
    program = f"import sys; sys.path[:] = {sys.path!r}; from curvcli.batch.worker import main; main()"
    return subprocess.Popen(
        [sys.executable, "-c", program],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=os.environ | ONE_THREAD,
    )


@contextmanager
def here(limits: Limits, jobs: int, soon: int = 0) -> Iterator[Engine]:
    """Engine on this machine with so many workers; leaving the block ends all of them.

    soon: number of meshes that are certain: their workers start at once.
    """
    workers: list[WorkerProcess] = []
    idle: SimpleQueue[WorkerProcess] = SimpleQueue()
    pool = ThreadPoolExecutor(jobs, "curvcli-batch")

    def hire(meshes: int) -> None:
        for _ in range(min(jobs, meshes) - len(workers)):
            workers.append(WorkerProcess(limits))
            idle.put(workers[-1])

    def engine(items: Sequence[BatchItem], settings: BatchSettings) -> Iterator[Row]:
        hire(len(items))
        for future in as_completed([pool.submit(do, item, settings) for item in items]):
            yield future.result()

    def do(item: BatchItem, settings: BatchSettings) -> Row:
        worker = idle.get()
        try:
            return worker.run(item, settings)
        finally:
            idle.put(worker)

    try:
        hire(soon)
        for worker in workers:
            worker.begin()
        yield engine
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        for worker in workers:
            worker.stop()
        pool.shutdown()
        for worker in workers:
            worker.end()
