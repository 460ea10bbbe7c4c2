"""Comparison of all outputs of two commits, byte for byte."""
