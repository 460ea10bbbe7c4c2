"""Make docs/gallery.md and its pictures: `python docs/make_gallery.py` runs the commands of the page."""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS.parent))

SINGLE, SMALL, PAIR, WIDE, FLAT = "640x520", "440x370", "840x420", "700x290", "1000x300"


@dataclass(frozen=True)
class Entry:
    """A picture: its file's stem, title, text, and the commands that make it, without `curvcli`.

    {totals} in the text are the totals of the meshes that the commands analyse, by `MESH.KEY`.
    """

    stem: str
    title: str
    text: str
    commands: tuple[str, ...]

    @property
    def pictures(self) -> list[str]:
        """The files that the commands write into docs/gallery, in their order."""
        words = [word for command in self.commands for word in shlex.split(command)]
        return [word for word in words if word.endswith(".png")]


ENTRIES = (
    Entry(
        "torus",
        "Gauss curvature on a torus",
        "K is positive outside, negative inside, and 0 on the two circles where a plane touches the torus. The angle "
        "defects of all vertices sum to {torus.K:.1f} = 2πχ.",
        (
            "sample torus --size 6000 -o torus.ply",
            f"analyze torus.ply -o torus.png --color-by K_density --view 20,40 --size {SINGLE}",
        ),
    ),
    Entry(
        "unduloid",
        "Mean curvature on an unduloid",
        "The principal curvatures change from bulge to neck; their sum is constant. All three panels have one range. "
        "Grey is undefined, on the boundary.",
        (
            "sample unduloid --size 6000 -o unduloid.ply",
            "analyze unduloid.ply -o unduloid.png --color-by h_signed,kappa_1,kappa_2 --range=-2.5:2.5 "
            f"--view fit --size {FLAT}",
        ),
    ),
    Entry(
        "monkey_saddle",
        "Positive and negative curvature of a monkey saddle",
        "K⁺ is the solid angle of the normal cone of the convex hull of a star, and K⁻ = K⁺ − K. A saddle has K⁻ only. "
        "Their sum is 2π times the average number of critical points of height functions.",
        (
            "sample monkey_saddle --size 3000 -o monkey.ply",
            "analyze monkey.ply -p core,K_plus,K_minus -o monkey.png --color-by K_minus,K_plus "
            f"--view 40,35 --size {PAIR}",
        ),
    ),
    Entry(
        "clifford",
        "Willmore energy and Möbius transformations",
        "A Clifford torus and two of its images under inversions. The energy moves over the surface; its sum stays "
        "near 8π² = 78.96: {clifford.willmore:.2f}, {far.willmore:.2f}, {cyclide.willmore:.2f}. Bobenko's conformal "
        "energy, which tends to 2π² = 19.74, is kept exactly by inversions of the vertices: "
        "{clifford.willmore_conformal:.6f}, {far.willmore_conformal:.6f}, {cyclide.willmore_conformal:.6f}.",
        (
            "sample clifford_torus --size 5000 -o clifford.ply",
            "sample cyclide --size 5000 --set distance=2.5 -o cyclide.ply",
            "sample cyclide --size 5000 --set distance=4 -o far.ply",
            *(
                f"analyze {name}.ply -p core,willmore_conformal -o {name}.png --color-by willmore --range 0:0.06 "
                "--view -60,50 --size 480x440"
                for name in ("clifford", "far", "cyclide")
            ),
        ),
    ),
    Entry(
        "areas",
        "Two areas of a vertex on bad triangles",
        "An ellipsoid through random points, its triangles long and thin. A third of the faces (A) depends on the "
        "triangles. The cell of the intrinsic Voronoi diagram (A_voronoi) depends on the points only. Both sum to the "
        "area.",
        (
            "sample irregular_ellipsoid --size 200 --set a=2 --set b=1 --set c=1 -o irregular.ply",
            "analyze irregular.ply -p core,A_voronoi -o areas.png --color-by A,A_voronoi --edges-on --range 0.03:0.2 "
            f"--view fit --size {WIDE}",
        ),
    ),
    Entry(
        "boy",
        "Mean curvature without an orientation",
        "Boy's surface is one-sided and H has no sign, so h_signed is null. Its size h is defined.",
        (
            "sample projective_plane --size 8000 -o boy.ply",
            f"analyze boy.ply -o boy.png --color-by h --view 30,35 --background black --size {SINGLE}",
        ),
    ),
    Entry(
        "trefoil",
        "A knotted tube",
        "κ₁ is the curvature of the tube. κ₂ is the curvature of its bends, positive on the outer side and negative on "
        "the inner.",
        (
            "sample trefoil_tube --size 12000 -o trefoil.ply",
            f"analyze trefoil.ply -o trefoil.png --color-by kappa_2 --view top --size {SINGLE}",
        ),
    ),
    Entry(
        "book",
        "Edges of more than two faces",
        "The edges of the spine of a book have another colour than its boundary. Statuses have the colours of labels.",
        (
            "sample book -o book.ply",
            f"analyze book.ply -o book.png --color-by status --view 35,25 --size {SINGLE}",
        ),
    ),
    Entry(
        "noise",
        "Outliers beyond the range",
        "The colours end at the 98th percentile, and the legend has the number of values beyond. The line in the "
        "histogram weights each vertex by its area.",
        (
            "sample irregular_torus --size 6000 -o noise.ply",
            f"analyze noise.ply -o noise.png --color-by K_density --view 20,40 --size {SMALL}",
            f"analyze noise.ply -o noise.hist.png --color-by K_density,h_signed --size {PAIR}",
        ),
    ),
)


def make(folder: Path, entry: Entry) -> None:
    """Run the commands of an entry in a folder."""
    from curvcli.commands.main import cli

    with _within(folder):
        for command in entry.commands:
            cli.main([*shlex.split(command), "--quiet"], standalone_mode=False)


def totals(folder: Path, entry: Entry) -> dict[str, float]:
    """The totals that the text of an entry names, of the meshes in a folder, by `MESH.KEY`."""
    from curvcli import analyze

    found = {}
    for name, key in dict.fromkeys(re.findall(r"{(\w+)\.(\w+):", entry.text)):
        value = analyze(str(folder / f"{name}.ply"), ["core", key] if key not in ("K", "area") else "core").totals[key]
        assert isinstance(value, float)
        found[f"{name}.{key}"] = value
    return found


def section(entry: Entry, numbers: dict[str, float]) -> str:
    """The section of the page about an entry."""

    def shown(found: re.Match[str]) -> str:
        return format(round(numbers[found[1]], 9) + 0.0, found[2])

    text = re.sub(r"{([\w.]+):([^}]*)}", shown, entry.text)
    pictures = " ".join(f"![{entry.title}: {name}](gallery/{name})" for name in entry.pictures)
    lines = [f"## {entry.title}", "", text, "", pictures, "", _FENCE]
    lines += [f"curvcli {command}" for command in entry.commands]
    return "\n".join([*lines, "```", ""])


_FENCE = '```sh title="Not run by the tests: docs/make_gallery.py runs it and keeps the pictures"'
_HEAD = """# Gallery

Each quantity has a shape that shows its meaning. The commands below a picture make it; `python docs/make_gallery.py`
runs them all (`pip install 'curvcli[pictures]'`). The legend below a surface has the range, its rule, the number of
values beyond it, and the number of undefined values.
"""


def main() -> None:
    """Write all pictures and the page."""
    gallery = DOCS / "gallery"
    gallery.mkdir(exist_ok=True)
    sections = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for entry in ENTRIES:
            make(folder, entry)
            sections.append(section(entry, totals(folder, entry)))
            for picture in entry.pictures:
                (gallery / picture).write_bytes((folder / picture).read_bytes())
    (DOCS / "gallery.md").write_text("\n".join([_HEAD, *sections]), encoding="utf-8")


@contextlib.contextmanager
def _within(folder: Path) -> Iterator[None]:
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


if __name__ == "__main__":
    main()
