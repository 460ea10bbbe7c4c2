"""Verdicts of a check: requirements, assertions and output formats."""
