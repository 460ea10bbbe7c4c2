"""Worker: a process that takes one mesh after the other from stdin and sends rows on stdout."""

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
    """Work until stdin ends, which is when the parent ends; then exit at once, even during work."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent decides
    tasks = sys.stdin.buffer
    # Output of libraries must not come between the rows.
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

    # Here, so that this time does not count for the first mesh.
    load_passes()
    import_libraries()
    if limits.memory is not None:
        start_polars()
        limit_address_space(limits.memory)
    _answer(answers, Ready(__version__))
    while True:
        task = todo.get()
        # After an out-of-memory error the heap is fragmented: the next mesh gets a new process.
        row, spent = run(task.item, task.settings, limits)
        _answer(answers, Done(row, spent))


def _listen(tasks: BinaryIO, todo: SimpleQueue[Task]) -> None:
    """Receive tasks while the worker works, so that it ends with its parent even during endless work."""
    while True:
        try:
            todo.put(receive(tasks, Task))
        except BaseException:
            os._exit(0)


def _answer(stream: BinaryIO, answer: Ready | Done) -> None:
    """Send an answer; if the parent is gone, drop it."""
    try:
        send(stream, answer)
    except BrokenPipeError:
        os._exit(0)
