"""Exact identities, one file per idea; `catalogue` lists the files."""

from .base import Check

__all__ = ["Check"]
