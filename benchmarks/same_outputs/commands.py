"""Command lines that are run at both commits, for each mesh and once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

REQUIREMENTS = (
    "closed,oriented,outward,connected,convex,genus=0,euler=2,components=1,minimal=0.1,cmc=0.1,"
    "no-unreferenced,no-duplicate-vertices"
)
CHECK = ("--require", REQUIREMENTS, "--assert", "absmax(K) < 3", "--assert", "mean(h_signed) > 0")
TABLES = [word for kind in ("edges", "faces", "loops", "components") for word in ("--table", f"{kind}={kind}.csv")]
FORMATS = [
    word for suffix in ("tsv", "obj", "vtp", "vtu", "glb", "md", "html", "npz") for word in ("-o", f"k.{suffix}")
]
FILES = ("-o", "k.csv", "-o", "k.ply", "-o", "k.json")


class Case(NamedTuple):
    """A command line. subject: the name of its mesh, or empty. name: of the command, unique for each subject."""

    subject: str
    name: str
    words: list[str]


def of_mesh(subject: str, mesh: str, moved: str | None, labels: str | None) -> Iterator[Case]:
    """The command lines of one mesh, with paths relative to the folder of the output.

    moved: the mesh rotated and with a moved vertex; None where the mesh cannot be read. labels: one for each face.
    """

    def case(name: str, *words: str) -> Case:
        return Case(subject, name, [*words])

    yield case("core", "analyze", mesh, *FILES, *TABLES)
    yield case("paper", "analyze", mesh, "-p", "paper", *FILES)
    yield case("all", "analyze", mesh, "-p", "all", *FILES, *TABLES)
    yield case("formats", "analyze", mesh, *FORMATS)
    yield case("conventions", "analyze", mesh, *FILES, "--orient", "outward", "--mean", "average", "--area", "mixed",
               "--unit", "mm", "--weld", "exact", "--precision", "9")  # fmt: skip
    yield case("scales", "analyze", mesh, *FILES, "--rings", "1,3")
    yield case("get", "analyze", mesh, "--json", "-p", "topology")
    yield case("check", "check", mesh)
    for kind in ("text", "json", "junit", "sarif", "github"):
        yield case(f"check-{kind}", "check", mesh, *CHECK, "--format", kind)
    yield case("curves", "curves", mesh, "-o", "c.csv", "-o", "c.json")
    yield case("curves-text", "curves", mesh)
    if moved is None:
        return
    if labels is not None:
        yield case("regions", "analyze", mesh, "--regions", labels, *FILES, "--table", "regions=regions.csv")
    yield case("moved", "analyze", moved, "-o", "k.json", "-q")
    yield case("compare", "compare", mesh, moved, "--json")
    yield case("compare-text", "compare", mesh, moved)
    yield case("compare-table", "compare", mesh, moved, "-o", "d.csv")
    yield case("compare-reports", "compare", "../core/k.json", "../moved/k.json")
    yield case("compare-stored", "compare", mesh, "../moved/k.json", "--json")
    yield case("map", "compare", mesh, moved, "--map", "--json")


def of_samples(names: list[str]) -> Iterator[Case]:
    """The samples themselves."""
    for name in names:
        yield Case("", f"sample-{name}", ["sample", name, "-o", "s.ply", "-o", "s.csv", "-o", "s.stl"])
    yield Case("", "samples", ["sample"])


def once(folders: list[str]) -> Iterator[Case]:
    """Command lines without a mesh, and a batch of each folder."""
    yield Case("", "passes", ["passes"])
    yield Case("", "passes-json", ["passes", "--json"])
    yield Case("", "schema", ["analyze", "--schema"])
    yield Case("", "no-command", ["analyse"])
    yield Case("", "no-pass", ["analyze", "missing.ply", "-p", "KAPPA"])
    yield Case("", "missing", ["analyze", "missing.ply"])
    for number, folder in enumerate(folders):
        yield Case("", f"batch-{number}", ["batch", f"{folder}/**/*.*", "-o", "out", "--save", "csv,json", "-j", "1"])
