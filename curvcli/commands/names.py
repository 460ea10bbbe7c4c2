"""Names of the commands, and the variable that asks for a completion."""

from __future__ import annotations

COMMANDS = ("analyze", "batch", "check", "compare", "curves", "passes", "sample", "help", "completion")


# These tell and set up; no configuration concerns them, and a broken one does not stop them.
UNCONFIGURED = ("help", "completion")


# With this variable set the program completes a line of the shell; see `curvcli completion`.
COMPLETE = "_CURVCLI_COMPLETE"
