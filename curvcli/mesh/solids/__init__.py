"""Closed surfaces in space: on which side of them a point lies, which lie inside which, and which cross."""
