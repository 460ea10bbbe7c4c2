"""Names of the commands, and the environment variable of shell completion."""

from __future__ import annotations

COMMANDS = ("analyze", "batch", "check", "compare", "curves", "passes", "sample", "help", "completion")


# Commands without configuration: a broken file does not stop them.
UNCONFIGURED = ("help", "completion")


# With this variable set the program completes a command line; see `curvcli completion`.
COMPLETE = "_CURVCLI_COMPLETE"
