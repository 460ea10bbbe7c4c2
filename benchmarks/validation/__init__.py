"""The validation page: how near the columns are to what is known; `python -m benchmarks.validation` makes it."""
