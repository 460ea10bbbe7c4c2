"""A worker: a process of its own that takes one mesh after the other from stdin and answers with rows on stdout."""

from __future__ import annotations

import os
import signal
import sys
import threading
import warnings
from queue import SimpleQueue
from typing import BinaryIO

from .._version import __version__
from .messages import Done, Ready, Task, receive, send
from .model import Limits


def main() -> None:
    """Work until stdin ends, which it does with the parent, however that ended; then end at once, work or not."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent decides
    tasks = sys.stdin.buffer
    # Whatever a library prints must not come between the rows.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    warnings.simplefilter("ignore")
    limits = receive(tasks, Limits)
    todo: SimpleQueue[Task] = SimpleQueue()
    threading.Thread(target=_listen, args=(tasks, todo), daemon=True).start()

    from ..curvatures.catalogue import load_passes
    from ..loading.libraries import import_libraries, start_polars
    from ..support.memory import limit_address_space
    from .run import run

    # Here, so that the first mesh is not charged with it.
    load_passes()
    import_libraries()
    if limits.memory is not None:
        start_polars()
        limit_address_space(limits.memory)
    _answer(answers, Ready(__version__))
    while True:
        task = todo.get()
        # Memory in pieces serves nobody: the next mesh gets a fresh process.
        row, spent = run(task.item, task.settings, limits)
        _answer(answers, Done(row, spent))


def _listen(tasks: BinaryIO, todo: SimpleQueue[Task]) -> None:
    """Take tasks while the worker works, so that it does not outlive its parent, be it at work for ever."""
    while True:
        try:
            todo.put(receive(tasks, Task))
        except BaseException:
            os._exit(0)


def _answer(stream: BinaryIO, answer: Ready | Done) -> None:
    """Hand an answer over; a parent that is gone wants none."""
    try:
        send(stream, answer)
    except BrokenPipeError:
        os._exit(0)
