"""Kernels: array computations that several passes share."""
