"""Everything that a text from outside can be: what it would do where it is obeyed, and the files that bring it in."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import polars as pl

import curvcli

# By what obeys them: terminals, rich, browsers, Markdown, spreadsheets, runners of GitHub, XML.
TERMINAL = ["\x1b]0;title\x07", "\x1b[5;7mblink", "\x9b5;7m", "\u202etxt.exe", "\u2066x\u2069", "\u200ex", "a\u2028b"]
LINES = ["a\x85b", "a\x0bb", "a\rb", "\x1c", "\x7f", "\u2029"]
MARKUP = ["[/x]", "[link=http://x.y]z[/link]", "[bold]b", ":smile:", "a\\", "[red", "\\[b]", "[@click=x]y[/]"]
WEB = ["<script>alert(1)</script>", "<img/src=x>", "&lt;", '"><b>', "</title>", "]]>", "<!--", "{{7*7}}", "${x}"]
MARKDOWN = ["`x`", "|a|", "**b**", "[a](http://x.y)", "![a](http://x.y)", "#1", "@user", "~~~", "$x$"]
SHEET = ["=1+1", '=HYPERLINK("x")', "+1+1", "-1+1", "@SUM(A1)", "\uff1d1+1", "'=1", "-5", "+1e3", "\t=1"]
RUNNER = ["::error::x", "%0A::error::x", "::stop-commands::x", "##[error]x", "a%25b", ",title=x"]
XML = ["\x00", "\ufffe", "\uffff", "\x01", "\x08", "\x0c"]
PAYLOADS = [*TERMINAL, *LINES, *MARKUP, *WEB, *MARKDOWN, *SHEET, *RUNNER, *XML]

# One word each: what a name in a file made of words can be.
WORDS = [text for text in PAYLOADS if len(text.encode().split()) == 1]

CUBE = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
"""
FACES = [(4, 3, 2), (4, 2, 1), (5, 6, 7), (5, 7, 8), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 4, 8), (3, 8, 7)]


@dataclass(frozen=True)
class Source:
    """name: of the source. make: the mesh in a folder, and the options with which its texts are seen.

    texts: those that are found in it. rows: whether they are labels of regions.
    """

    name: str
    make: Callable[[Path], list[str]]
    texts: list[str] = field(default_factory=list)
    rows: bool = False


def _obj(record: str, option: str) -> Callable[[Path], list[str]]:
    def make(folder: Path) -> list[str]:
        lines = [CUBE]
        for place, word in enumerate(WORDS):
            a, b, c = FACES[place % len(FACES)]
            lines.append(f"{record} {word}\nf {a} {b} {c}\n")
        (folder / "m.obj").write_bytes("".join(lines).encode())
        return ["m.obj", "--regions", option]

    return make


def ply(
    folder: Path, name: str = "m.ply", *, vertex: Sequence[str] = (), face: Sequence[str] = (), comment: str = ""
) -> None:
    """A tetrahedron with properties of these names."""
    header = ["ply", "format ascii 1.0", *([f"comment {comment}"] if comment else []), "element vertex 4"]
    header += [f"property double {axis}" for axis in "xyz"] + [f"property double {one}" for one in vertex]
    header += ["element face 4", "property list uchar int vertex_indices", *(f"property int {one}" for one in face)]
    points, faces = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"], ["3 0 2 1", "3 0 1 3", "3 1 2 3", "3 2 0 3"]
    rows = [" ".join([point, *("1" for _ in vertex)]) for point in points]
    rows += [" ".join([one, *(str(k) for _ in face)]) for k, one in enumerate(faces)]
    (folder / name).write_bytes("\n".join([*header, "end_header", *rows, ""]).encode())


def _properties(folder: Path) -> list[str]:
    ply(folder, vertex=WORDS, face=WORDS, comment=" ".join(WORDS))
    return ["m.ply", "--regions", "[/x]"]


def _property(text: str) -> Callable[[Path], list[str]]:
    def make(folder: Path) -> list[str]:
        ply(folder, face=[text])
        return ["m.ply", "--regions", text]

    return make


def _file(name: str) -> Callable[[Path], list[str]]:
    def make(folder: Path) -> list[str]:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        ply(path.parent, path.name)
        return [name]

    return make


def _solids(folder: Path) -> list[str]:
    facet = "facet normal 0 0 0\nouter loop\nvertex {} 0 0\nvertex 1 {} 0\nvertex 0 1 {}\nendloop\nendfacet\n"
    solids = [f"solid {word}\n{facet.format(k, k + 2, k + 3)}endsolid {word}\n" for k, word in enumerate(WORDS)]
    (folder / "m.stl").write_bytes("".join(solids).encode())
    return ["m.stl"]


def _unit(folder: Path) -> list[str]:
    ply(folder)
    return ["m.ply", "--unit", "[/x]<b>=1|`::error::%0A"]


FILES = [text.replace("/", "_") for text in PAYLOADS if "\x00" not in text]
SOURCES = [
    Source("groups", _obj("g", "groups"), WORDS, rows=True),
    Source("objects", _obj("o", "objects"), WORDS, rows=True),
    Source("materials", _obj("usemtl", "materials"), WORDS, rows=True),
    Source("solids", _solids),
    Source("properties", _properties),
    Source("unit", _unit),
    *(Source(f"property {k}", _property(text)) for k, text in enumerate(("[/x]", "\x9b5;7m", "=1+1", "a\\"))),
    Source("folder", _file("scans[/x].ply")),
    Source("file of all", _file("".join(FILES)[:180] + ".ply")),
    Source("file of the rest", _file("::error::" + "".join(FILES)[180:340] + ".ply")),
    Source("formula", _file("=1+1.ply")),
]


def stored(folder: Path) -> list[list[str]]:
    """Files of curvcli with texts in every place that is read again, as the arguments of `compare`."""
    ply(folder)
    analysis = curvcli.analyze(folder / "m.ply")
    report = analysis.report()
    hostile = "".join(PAYLOADS)
    for text in PAYLOADS:
        report["totals"][text] = 1.0
        report["columns"][text] = dict(report["columns"]["K"])
    report["input"]["path"] = report["input"]["sha256"] = report["curvcli"] = hostile
    report["conventions"]["unit"] = hostile
    report["checks"] = [{**row, "name": row["name"] + hostile, "detail": hostile} for row in report["checks"]]
    report["warnings"] = [{"code": hostile, "count": 1, "message": hostile, "hint": hostile, "examples": [hostile]}]
    report["components"][0]["name"] = hostile
    report["loops"] = []
    (folder / "r.json").write_text(json.dumps(report))
    table = pl.DataFrame({"vertex": [0, 1, 2, 3], "x": [0.0, 1, 0, 0]})
    extra = {text: [2.0] * 4 for text in PAYLOADS} | {"status": PAYLOADS[:4]}
    table = table.with_columns(*(pl.Series(name, values) for name, values in extra.items()))
    table.write_csv(folder / "t.csv")
    table.write_parquet(folder / "t.parquet")
    (folder / "u.csv").write_text('"\x1b]0;x\x07","[/x]"\n1,2\n')
    (folder / "u.json").write_text(json.dumps({"schema_version": hostile, "topology": 1, "checks": 1}))
    exact = table.with_columns(normal_x=pl.Series([1.0] * 4), K_density=pl.Series([1.0] * 4)).drop("status")
    exact.write_csv(folder / "e.csv")
    others = ["r.json", "t.csv", "t.parquet", "u.csv", "u.json", "e.csv"]
    return [["m.ply", other] for other in others] + [["r.json", "r.json"], ["t.csv", "t.parquet"]]
