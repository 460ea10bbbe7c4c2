"""`python -m benchmarks`: every table, or those that are named."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import get_args

import click

from . import compute, end_to_end, files, growth, startup
from .meshes import Mesh, Order, Shape

SIZES = (10_000, 100_000, 1_000_000, 4_000_000)
TABLES = ("startup", "compute", "files", "end-to-end", "growth")


@click.command()
@click.argument("tables", nargs=-1, type=click.Choice(TABLES), metavar="[TABLE]...")
@click.option("--quick", is_flag=True, help="Small meshes, three rounds, the main peers: a minute or two.")
@click.option(
    "--cache", type=click.Path(file_okay=False), help="Folder that keeps the meshes (default: a temporary one)."
)
@click.option("--repeats", type=click.IntRange(1), help="Rounds of every case (default: 5; quick: 3).")
@click.option("--size", "sizes", type=click.IntRange(100), multiple=True, help="Vertices; repeatable.")
@click.option("--shape", type=click.Choice(get_args(Shape)), default="sphere", show_default=True)
@click.option(
    "--order",
    "orders",
    type=click.Choice(get_args(Order)),
    multiple=True,
    help="Order of the vertices.",
)
def main(
    tables: tuple[str, ...],
    quick: bool,
    cache: str | None,
    repeats: int | None,
    sizes: tuple[int, ...],
    shape: Shape,
    orders: tuple[Order, ...],
) -> None:
    """Measure curvcli beside its peers, in one run, and print medians and ratios.

    TABLE: startup, compute, files, end-to-end, growth; all of them if none is named. Peers that are not
    installed are named and left out: pip install '.[bench]'.
    """
    chosen, rounds = tables or TABLES, repeats or (3 if quick else 5)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(cache or temporary)
        folder.mkdir(parents=True, exist_ok=True)

        def mesh(size: int, order: Order = "regular") -> Mesh:
            return Mesh(folder, shape, size, order)

        def of_sizes(quickly: tuple[int, ...], fully: tuple[int, ...]) -> list[Mesh]:
            return [
                mesh(size, order) for size in sizes or (quickly if quick else fully) for order in orders or ("regular",)
            ]

        if "startup" in chosen:
            startup.tables(mesh(1000), rounds)
        warm = mesh(10_000)  # so large that it takes the same imports as larger ones
        if "compute" in chosen:
            for one in of_sizes((100_000,), SIZES):
                compute.tables(one, warm, rounds, quick)
        if "files" in chosen:
            for one in of_sizes((100_000,), SIZES):
                files.tables(one, warm, rounds)
        if "end-to-end" in chosen:
            for one in of_sizes((100_000,), SIZES):
                end_to_end.tables(one, rounds)
        if "growth" in chosen:
            growth.tables(of_sizes((10_000, 100_000), SIZES[1:]), rounds)


if __name__ == "__main__":
    main()
