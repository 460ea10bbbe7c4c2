"""`python -m benchmarks.accuracy`: tables of errors as Markdown on stdout, and pictures where a folder is named."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from .cases import NOISE, QUICK_NOISE, QUICK_SIZES, SIZES, TRIANGULATIONS, cases
from .measure import errors, present, this_python
from .tables import draw, pages


@click.command()
@click.argument("surfaces", nargs=-1, type=click.Choice(list(TRIANGULATIONS)), metavar="[SURFACE]...")
@click.option("--quick", is_flag=True, help="1,000 and 4,000 vertices, noise 0 and 0.001: under a minute.")
@click.option("--size", "sizes", type=click.IntRange(200), multiple=True, help="Vertices; repeatable.")
@click.option("--noise", type=click.FloatRange(0), multiple=True, help="Part of the largest extent; repeatable.")
@click.option("--rings", type=click.IntRange(1), default=2, show_default=True, help="Scale of all estimates.")
@click.option("--peers/--no-peers", default=False, help="Also libigl, PyMeshLab and trimesh, as far as installed.")
@click.option("--python", default=this_python(), help="The interpreter that has the peers (default: this one).")
@click.option("--plots", type=click.Path(file_okay=False, path_type=Path), help="Folder for a picture per surface.")
def main(
    surfaces: tuple[str, ...],
    quick: bool,
    sizes: tuple[int, ...],
    noise: tuple[float, ...],
    rings: int,
    peers: bool,
    python: str,
    plots: Path | None,
) -> None:
    """Relative L² errors of K and H against exact values, over sizes and over noise.

    SURFACE: sphere, torus, ellipsoid, catenoid, unduloid, cylinder; all if none is named. Boundary vertices are left
    out. Where the exact values are zero, errors are root mean squares. `order` is that of the convergence in the edge
    length, from the first size to the last.
    """
    here, missing = present(python) if peers else ([], [])
    for peer in missing:
        click.echo(f"{peer} is not installed and left out", err=True)
    chosen = list(
        cases(sizes or (QUICK_SIZES if quick else SIZES), noise or (QUICK_NOISE if quick else NOISE), surfaces)
    )
    measured = {}
    for number, case in enumerate(chosen, start=1):
        click.echo(f"{number} of {len(chosen)}: {case}", err=True)
        measured[case] = errors(case, rings, here, python)
    click.echo(f"Made by `{command_line(sys.argv[1:])}`.\n")
    for key in ("K", "h"):
        for page in pages(measured, key):
            click.echo(page)
    if plots is not None:
        plots.mkdir(parents=True, exist_ok=True)
        for path in draw(plots, measured):
            click.echo(f"wrote {path}", err=True)


def command_line(words: list[str]) -> str:
    """The command as others may repeat it, without the places that are particular to this machine."""
    kept, words = ["python -m benchmarks.accuracy"], list(words)
    while words:
        word = words.pop(0)
        if word in ("--python", "--plots"):
            words = words[1:]
        elif not word.startswith(("--python=", "--plots=")):
            kept.append(word)
    return " ".join(kept)


if __name__ == "__main__":
    main()
