"""Summaries for the terminal; only this folder and the commands import rich."""
