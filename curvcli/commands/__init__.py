"""Command line: one file per command, which parses options, calls the library and chooses an exit code."""
