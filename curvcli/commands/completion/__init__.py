"""Completion of the command line by shells."""

from .cli import command

__all__ = ["command"]
