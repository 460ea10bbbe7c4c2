"""Settings of random meshes: the same ones in every run, so that a failure is a failure everywhere."""

from __future__ import annotations

import signal
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "curvcli",
    deadline=None,
    derandomize=True,
    max_examples=40,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
settings.load_profile("curvcli")


# Ctrl-C, kill and a lost terminal, as a program finds them that was started in the foreground.
HANDLERS = {
    signal.SIGINT: signal.default_int_handler,
    signal.SIGTERM: signal.SIG_DFL,
    signal.SIGHUP: signal.SIG_DFL,
}


def _listen() -> None:
    for number, handler in HANDLERS.items():
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, handler)


def pytest_configure(config: pytest.Config) -> None:
    """A shell in the background passes on that Ctrl-C is to be ignored; programs under test listen to it."""
    _listen()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Neighbours stay in one process, so that what a module has worked out is worked out once."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log) if config.getvalue("dist") == "load" else None


def pytest_runtest_teardown(item: pytest.Item) -> None:
    """The program, called within a test, ends by ignoring signals; what later tests start would inherit that."""
    _listen()
