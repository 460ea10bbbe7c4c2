"""Import the libraries of an analysis ahead of the first mesh or of a bound on memory."""

from __future__ import annotations

from importlib import import_module

from ..support.memory import require_polars


def import_libraries() -> None:
    """Import polars, the graph functions of scipy and trimesh's loader."""
    for name in ("polars", "scipy.sparse.csgraph", "trimesh.exchange.load"):
        import_module(name)


def start_polars() -> None:
    """Start the threads and the allocator of polars, so that a bound on the address space does not count them.

    Errors: MemoryError where their address space is not to be had.
    """
    require_polars(0)
    import polars as pl

    pl.DataFrame({"x": [1.0]}).lazy().select(pl.col("x").sum()).collect()
