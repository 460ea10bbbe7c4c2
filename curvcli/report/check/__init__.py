"""Verdicts of a check: requirements, assertions and the formats they are written in."""
