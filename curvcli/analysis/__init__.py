"""Analyses: the request, the result, its totals and its notices."""
