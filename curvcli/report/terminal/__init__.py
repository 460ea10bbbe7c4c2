"""Summaries for the terminal; the one place beside the commands that imports rich."""
