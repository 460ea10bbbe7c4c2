"""The console that reports are printed on."""

from __future__ import annotations

import rich.console


class Console(rich.console.Console):
    """A console that lets a closed pipe through as the BrokenPipeError it is.

    rich would end the program with a SystemExit, which does not tell that the work was done and its outputs are whole.
    """

    def on_broken_pipe(self) -> None:
        """Called while the BrokenPipeError is handled."""
        raise
