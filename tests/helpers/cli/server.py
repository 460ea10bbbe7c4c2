"""curvcli as a server that forks: many commands wait for one start of Python and its libraries, each is a process.

`python server.py SOCKET` imports what commands use and serves until its stdin ends, which it does with whoever started
it; `python server.py SOCKET --ask ARGUMENT...` runs one command with the streams, the folder and the environment of
whoever asks, and ends with its exit code.
"""

from __future__ import annotations

import json
import os
import select
import socket
import sys
import traceback
from collections.abc import Sequence

# What a command imports; no threads are started by importing these, so that a fork is whole.
MODULES = (
    *("trimesh", "polars", "scipy.sparse.csgraph", "rich.console", "rich.table", "msgspec", "cmap"),
    *(
        "curvcli.analysis.result",
        "curvcli.report.check.judge",
        "curvcli.report.compare.values",
        "curvcli.output.tables.columns",
        "curvcli.curves",
        "curvcli.analysis.maps",
    ),
    *("curvcli.report.build", "curvcli.report.terminal.summary", "curvcli.output.write", "curvcli.samples"),
    *(f"curvcli.commands.{name}" for name in ("analyze", "batch", "check", "compare", "curves", "passes", "sample")),
)


def ask(address: str, arguments: list[str], streams: Sequence[int] = (0, 1, 2), limit: int = 0) -> list[int]:
    """Have a command run; its exit code, its peak of memory in kB and its milliseconds of processor time.

    limit: seconds of processor time after which the system ends it.
    """
    with socket.socket(socket.AF_UNIX) as line:
        line.settimeout(4 * limit or None)
        line.connect(address)
        order = json.dumps([arguments, os.getcwd(), dict(os.environ), limit]).encode()
        socket.send_fds(line, [len(order).to_bytes(8, "big")], streams)
        line.sendall(order)
        with line.makefile() as answers:
            found: list[int] = json.loads(answers.read())
            return found


def serve(address: str) -> None:
    """Answer until nobody can ask any more; each command runs in a child."""
    from importlib import import_module

    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    for name in MODULES:
        import_module(name)
    from curvcli.curvatures.catalogue import load_passes

    load_passes()
    with socket.socket(socket.AF_UNIX) as door:
        door.bind(address)
        door.listen()
        print("ready", flush=True)
        while sys.stdin not in select.select([door, sys.stdin], [], [])[0]:
            line, _ = door.accept()
            if os.fork() == 0:
                if os.fork():  # the grandchild is nobody's zombie
                    os._exit(0)
                door.close()
                answer(line)
                os._exit(0)
            os.wait()
            line.close()
    os.unlink(address)


def answer(line: socket.socket) -> None:
    """Run the command that was ordered in a child, and tell how it ended and what it took."""
    size, streams, _, _ = socket.recv_fds(line, 8, 3)
    order = b""
    while len(order) < int.from_bytes(size, "big"):
        order += line.recv(1 << 16)
    arguments, folder, environment, limit = json.loads(order)
    child = os.fork()
    if child == 0:
        line.close()
        for number, stream in enumerate(streams):
            os.dup2(stream, number)
            os.close(stream)
        # Streams remember what they were opened on.
        sys.stdin = os.fdopen(0, closefd=False)
        sys.stdout = os.fdopen(1, "w", encoding="utf-8", closefd=False)
        sys.stderr = os.fdopen(2, "w", 1, encoding="utf-8", errors="backslashreplace", closefd=False)
        os.chdir(folder)
        os.environ.clear()
        os.environ.update(environment)
        sys.argv = ["curvcli", *arguments]
        if limit:
            import resource

            resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
        run()
    for stream in streams:
        os.close(stream)
    _, status, used = os.wait4(child, 0)
    spent = round(1000 * (used.ru_utime + used.ru_stime))
    line.sendall(json.dumps([os.waitstatus_to_exitcode(status), used.ru_maxrss, spent]).encode())


def run() -> None:
    """Run `curvcli`."""
    from curvcli.__main__ import main

    code = 70
    try:
        main()
    except SystemExit as end:
        code = int(end.code or 0)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


if __name__ == "__main__":
    if sys.argv[2:3] == ["--ask"]:
        sys.exit(ask(sys.argv[1], sys.argv[3:])[0])
    serve(sys.argv[1])
