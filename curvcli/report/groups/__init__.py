"""Comparison of two groups of reports: tests of the difference of means, effect sizes, corrections."""
