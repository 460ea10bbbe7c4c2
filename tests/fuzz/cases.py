"""One case: a file by some name, and how curvcli is called on it."""

from __future__ import annotations

from dataclasses import dataclass

from hypothesis import strategies as st

from tests.fuzz.damage import damaged
from tests.fuzz.shapes import extreme
from tests.fuzz.writers import Written, obj, ply, stl, strips, whole
from tests.helpers.spelling import Meant

TABLES = ("edges", "faces", "loops", "components")


@dataclass(frozen=True)
class Case:
    """A file name and its bytes, the command, its options, and the outputs asked for as (option, name).

    meant: what the file means if it is whole, otherwise None.
    """

    name: str
    data: bytes
    command: str = "analyze"
    options: tuple[str, ...] = ()
    outputs: tuple[tuple[str, str], ...] = ()
    meant: Meant | None = None


def _options(kind: str) -> st.SearchStrategy[tuple[str, ...]]:
    labels = {"obj": ["groups", "objects", "materials"], "ply": ["part", "mark", "x"], "stl": ["groups"]}[kind]
    choice = st.sampled_from(
        [
            (),
            ("-p", "topology"),
            ("-p", "paper"),
            ("-p", "all"),
            ("--strict",),
            ("--weld", "exact"),
            ("--weld", "none"),
            ("--weld", "1e-3"),
            ("--orient", "outward"),
            ("--area", "mixed"),
            ("--area", "voronoi"),
            ("--rings", "1"),
            ("--radius", "0.5"),
            ("--radius", "2e"),
            ("--mean", "average"),
            ("--max-faces", "3"),
            ("--max-bytes", "300"),
            ("--max-bytes", "1000000"),
            ("--precision", "5"),
            *(("--regions", label) for label in labels),
        ]
    )
    few = st.lists(choice, max_size=2, unique_by=lambda option: option[:1])
    return few.map(lambda several: tuple(word for option in several for word in option))


_OUTPUTS = st.lists(
    st.sampled_from(
        [
            *(("-o", f"out.{suffix}") for suffix in ("csv", "csv", "tsv", "json", "ply", "obj", "npz", "parquet")),
            *(("--table", f"{table}.csv") for table in TABLES),
            ("--table", "faces.csv"),
        ]
    ),
    max_size=3,
    unique=True,
).map(tuple)


def _name(draw: st.DrawFn, kind: str) -> str:
    which = draw(st.integers(0, 19))
    if which == 0:
        return "mesh." + draw(st.sampled_from(["obj", "ply", "stl", "off", "txt", "gz", "OBJ", "obj.bak"]))
    if which == 1:
        return f"mesh.{kind}.gz"
    return "mesh" if which == 2 and draw(st.booleans()) else f"mesh.{kind}"


def _called(draw: st.DrawFn, name: str, data: bytes, kind: str, meant: Meant | None) -> Case:
    command = "curves" if draw(st.integers(0, 7)) == 0 else "analyze"
    with_files = draw(st.integers(0, 3)) == 0
    if command == "curves":
        return Case(name, data, command, (), (("-o", "out.csv"),) if with_files else (), meant)
    return Case(name, data, command, draw(_options(kind)), draw(_OUTPUTS) if with_files else (), meant)


@st.composite
def sound(draw: st.DrawFn) -> Case:
    """A whole file under its own name."""
    written = draw(whole())
    return _called(draw, f"mesh.{written.kind}", written.data, written.kind, written.meant)


@st.composite
def ends(draw: st.DrawFn) -> Case:
    """A whole file of coordinates at the ends of the range, with every quantity there is."""
    shape = draw(extreme())
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in shape.points]
    lines += ["f " + " ".join(str(corner + 1) for corner in polygon) for polygon in shape.polygons]
    scale = draw(st.sampled_from([(), ("--rings", "1"), ("--rings", "3"), ("--radius", "1"), ("--radius", "2e")]))
    options = draw(st.sampled_from([(), ("--area", "voronoi"), ("--area", "mixed"), ("--orient", "outward")]))
    outputs = draw(st.sampled_from([(), (("-o", "out.csv"), ("-o", "out.json"), ("--table", "edges.csv"))]))
    return Case("mesh.obj", "\n".join(lines).encode(), "analyze", ("-p", "all", *scale, *options), outputs, None)


_BY_KIND = {"obj": obj(), "ply": ply(), "stl": stl(), "strips": strips()}


@st.composite
def mutated(draw: st.DrawFn, kind: str) -> Case:
    """A file of one kind after some accidents, spliced now and then with any other."""
    written: Written = draw(_BY_KIND[kind])
    other: Written = draw(whole())
    data = draw(damaged(written.data, other.data))
    return _called(draw, _name(draw, written.kind), data, written.kind, None)


@st.composite
def noise(draw: st.DrawFn) -> Case:
    """Bytes or words at random, after a beginning that promises something or not."""
    begin = draw(
        st.sampled_from(
            [
                b"",
                b"solid x\n",
                b"ply\nformat ascii 1.0\n",
                b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                b"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n",
                b"v 0 0 0\nv 1 0 0\nv 0 1 0\n",
                b"\x1f\x8b\x08\0\0\0\0\0\0\xff",
                b"\0" * 80 + b"\1\0\0\0",
                b"\xef\xbb\xbf",
            ]
        )
    )
    words = [b"v", b"f", b"l", b"1", b"2", b"3", b"-1", b"0.5", b"\n", b"\n", b" ", b"#", b"\\\n", b"facet", b"vertex",
             b"endfacet", b"element", b"property", b"end_header", b"face", b"float", b"list", b"x"]  # fmt: skip
    tail = draw(
        st.one_of(st.binary(max_size=300), st.lists(st.sampled_from(words), max_size=80).map(lambda w: b" ".join(w)))
    )
    kind = draw(st.sampled_from(["obj", "ply", "stl"]))
    return _called(draw, _name(draw, kind), begin + tail, kind, None)
