"""The command `curvcli`, and `python -m curvcli`: hears Ctrl-C before it imports anything that takes time."""

from __future__ import annotations

import os

# `signal` itself wraps these in enumerations, whose import takes longer than all that happens before.
from _signal import SIGINT, default_int_handler, getsignal, signal  # type: ignore[import-not-found]

_heard: list[int] = []


def main() -> None:
    """Run curvcli and exit with the code of the interface."""
    if getsignal(SIGINT) is default_int_handler:
        signal(SIGINT, _wait)
    from .commands.main import main as run

    try:
        run(_wait, _heard)
    finally:
        import gc

        # Nobody need look through all that was imported for circles: the system takes everything back at once.
        gc.freeze()


def _wait(number: int, frame: object) -> None:
    """Remember it until the program can say that it was interrupted; who insists need not wait."""
    if _heard:
        os._exit(128 + number)
    _heard.append(number)


if __name__ == "__main__":
    main()
