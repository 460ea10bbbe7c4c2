"""Errors of estimates over sizes, triangulations and noise, beside peers; `python -m benchmarks.accuracy`."""
