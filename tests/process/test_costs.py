"""Inputs made to cost far more than their size: refused in one line, or done within a bound."""

from __future__ import annotations

import contextlib
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import polars as pl
import pytest

import curvcli
from curvcli.errors import InputError
from curvcli.loading.tables import read_stored_table
from curvcli.mesh import welding as weld
from tests.helpers.cli.program import CUBE, command, environment
from tests.helpers.cli.program import curvcli as run

MEGABYTE = 1 << 20


class Cost(NamedTuple):
    code: int
    err: str
    megabytes: float


# What a process held counts with what the one held that it was forked from: so it is started by a small one.
METER = """
import resource, subprocess, sys
done = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL)
print(done.returncode, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def cost(*arguments: object, folder: Path) -> Cost:
    """A run as a process of its own, and the most memory that it held."""
    line = [sys.executable, "-S", "-c", METER, *command(*map(str, arguments))]
    done = subprocess.run(line, capture_output=True, text=True, env=environment(), cwd=folder, timeout=300)
    code, kilobytes = map(int, done.stdout.split())
    return Cost(code, done.stderr, kilobytes / 1024)


# ---------------------------------------------------------------------------- configuration

DOTTED = ".".join(["a"] * 6000)


@pytest.mark.parametrize(
    "text",
    [
        f"{DOTTED} = 1\n",
        f"[{DOTTED}]\n",
        f"[[{DOTTED}]]\n",
        ". ".join(["'a b'"] * 6000) + " = 1\n",
        f"x = {{ {DOTTED} = 1 }}\n",
        f"x = [1, {{ {DOTTED} = 1 }}]\n",
        f'x = """\n""" # {DOTTED}\n{DOTTED} = 1\n',
        "#" * (2 * MEGABYTE),
    ],
    ids=["key", "table", "tables", "quoted", "inline", "nested", "after a text", "long"],
)
def test_a_configuration_out_of_proportion(text: str, tmp_path: Path) -> None:
    (tmp_path / "curvcli.toml").write_text(text)
    found = cost("analyze", CUBE, folder=tmp_path)
    assert found.code == 2
    assert found.err.startswith("curvcli: ")
    assert "curvcli.toml: " in found.err
    assert found.err.count("\n") == 1
    assert found.megabytes < 100


def test_a_usual_configuration_with_many_dots_is_read(tmp_path: Path) -> None:
    many = ", ".join(["'a.b'"] * 90)
    text = f"# {'.' * 200}\n[analyze]\nunit = 'mm' # {'a .. b' * 100}\n[compare]\nonly = [{many}]\n"
    (tmp_path / "curvcli.toml").write_text(text)
    assert run("analyze", CUBE, "--get", "conventions.unit", folder=tmp_path) == (0, "mm\n", "")


# ---------------------------------------------------------------------------- stored tables


def bombs(folder: Path) -> dict[str, str]:
    """Small files of large tables, and what is said of each."""
    rows = 2_000_000
    zeros = {f"c{k}": pl.zeros(rows, eager=True) for k in range(40)}
    pl.DataFrame({"vertex": pl.zeros(rows, eager=True), **zeros}).write_parquet(folder / "rows.parquet")
    pl.DataFrame({"vertex": [0, 1], "s": ["a" * 90_000_000, "b"]}).write_parquet(folder / "word.parquet")
    pl.DataFrame({"vertex": [0, 1], "s": [[0] * 5_000_000, [1]]}).write_parquet(folder / "list.parquet")
    words = ["a" * 2000] * 100_000
    pl.DataFrame({"vertex": np.arange(100_000), "s": words}).write_parquet(folder / "words.parquet")
    lines = [",".join(["vertex", *(f"c{k}" for k in range(9000))]), *map(str, range(9000))]
    (folder / "wide.csv").write_text("\n".join(lines) + "\n")
    (folder / "wide.tsv").write_text("\n".join(lines).replace(",", "\t") + "\n")
    return {
        "rows.parquet": "a table that unpacks to",
        "word.parquet": "a table that unpacks to",
        "list.parquet": "holds neither numbers nor words",
        "words.parquet": "column `s` of 200000000 bytes found",
        "wide.csv": "9001 rows of 9001 columns",
        "wide.tsv": "9001 rows of 9001 columns",
    }


@pytest.mark.slow
def test_tables_out_of_proportion(tmp_path: Path) -> None:
    for name, words in bombs(tmp_path).items():
        assert (tmp_path / name).stat().st_size < 2 * MEGABYTE, name
        found = cost("compare", CUBE, name, folder=tmp_path)
        assert (found.code, words in found.err, found.err.count("\n")) == (3, True, 1), (name, found)
        assert found.megabytes < 400, (name, found)


def test_max_bytes_bounds_what_is_unpacked(tmp_path: Path) -> None:
    pl.DataFrame({"vertex": np.arange(50_000), "K": np.zeros(50_000)}).write_parquet(tmp_path / "t.parquet")
    path = tmp_path / "t.parquet"
    assert path.stat().st_size < 400_000
    assert len(read_stored_table(str(path), max_bytes=1_000_000)["K"]) == 50_000
    with pytest.raises(InputError, match=r"unpacks to 8\d* bytes found, at most 500000 allowed; --max-bytes"):
        read_stored_table(str(path), max_bytes=500_000)


def test_a_record_that_lies_is_refused(tmp_path: Path) -> None:
    """A changed byte of the record or of the headers of pages: refused in one line, or a table."""
    pl.DataFrame({"vertex": np.arange(10), "K": np.linspace(0, 1, 10)}).write_parquet(tmp_path / "t.parquet")
    content = bytearray((tmp_path / "t.parquet").read_bytes())
    path = tmp_path / "d.parquet"
    for at in [*range(4, 40), *range(len(content) - 300, len(content), 3)]:
        for bits in (0x80, 0x7F):
            damaged = bytearray(content)
            damaged[at] ^= bits
            path.write_bytes(damaged)
            with contextlib.suppress(InputError):
                read_stored_table(str(path), max_bytes=MEGABYTE)


# ---------------------------------------------------------------------------- meshes


def test_a_crowd_in_one_spot_is_welded_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """The groups of pairs that are looked at in blocks are those of all pairs at once."""
    random = np.random.default_rng(1)
    xyz = np.concatenate([random.random((3000, 3)), 0.5 + 2e-3 * random.random((400, 3))]).T
    at_once = weld.weld_within(xyz, 1e-3)
    monkeypatch.setattr(weld, "_PAIRS", 1000)
    assert (weld.weld_within(xyz, 1e-3) == at_once).all()
    assert 300 < (at_once != np.arange(3400)).sum() < 420


@pytest.mark.slow
def test_a_crowd_in_one_spot_takes_memory_in_proportion(tmp_path: Path) -> None:
    random = np.random.default_rng(2)
    points = np.concatenate([random.random((120_000, 3)), 0.5 + 1e-4 * random.random((4_500, 3))])
    lines = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in points.tolist()]
    lines += [f"f {k} {k + 1} {k + 2}" for k in range(1, 2000)]
    (tmp_path / "crowd.obj").write_text("\n".join(lines) + "\n")
    apart = cost("analyze", "crowd.obj", "-q", "-p", "topology", folder=tmp_path)
    near = cost("analyze", "crowd.obj", "-q", "-p", "topology", "--weld", "1e-4", folder=tmp_path)
    assert (apart.code, near.code) == (0, 0)
    assert near.megabytes < apart.megabytes + 150


@pytest.mark.slow
def test_a_long_name_on_every_face(tmp_path: Path) -> None:
    count = 1500
    lines = [f"v {k % 40} {k // 40} 0" for k in range(1600)]
    lines += ["g " + "n" * 200_000] + [f"f {k} {k + 1} {k + 41}" for k in range(1, count)]
    (tmp_path / "long.obj").write_text("\n".join(lines) + "\n")
    words = ("analyze", "long.obj", "-q", "--regions", "groups", "--force", "--table")
    for suffix in ("csv", "tsv"):
        found = cost(*words, f"faces=t.{suffix}", folder=tmp_path)
        assert (found.code, "names of up to 200,000 characters" in found.err) == (3, True)
        assert not (tmp_path / f"t.{suffix}").exists()
    for suffix in ("parquet", "npz"):
        found = cost(*words, f"faces=t.{suffix}", folder=tmp_path)
        assert (found.code, found.err) == (0, "")
        assert (tmp_path / f"t.{suffix}").stat().st_size < 2 * MEGABYTE


@pytest.mark.parametrize("radius", ["1e9", "200e"])
def test_a_radius_larger_than_the_mesh(radius: str, tmp_path: Path) -> None:
    """Every vertex has the whole mesh around it, whose mean is the same everywhere; or the radius is refused."""
    for size in (1000, 12_000):
        assert run("sample", "icosphere", "--size", str(size), "-q", "-o", tmp_path / f"{size}.ply").code == 0
    words = ("--radius", radius, "-p", "K_ring", "-q", "-o")
    assert run("analyze", tmp_path / "1000.ply", *words, tmp_path / "k.csv").code == 0
    mean = pl.read_csv(tmp_path / "k.csv")["K_ring"].to_numpy()
    area = float(run("analyze", tmp_path / "1000.ply", "--get", "totals.area").out)
    assert np.allclose(mean, 4 * np.pi / area, rtol=1e-12, atol=0)
    ended = run("analyze", tmp_path / "12000.ply", *words, tmp_path / "l.csv")
    assert ended.code == 3
    assert "12000.ply: the radius takes in about " in ended.complaint


def test_a_radius_that_takes_in_more_than_it_seems(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A crowd within the radius of each other, in a mesh whose other edges are long."""
    from curvcli.mesh import neighbourhoods
    from curvcli.mesh.scale import parse_radius

    monkeypatch.setattr(neighbourhoods, "_MOST_EXPECTED", 100)
    random = np.random.default_rng(3)
    points = np.concatenate([1e-3 * random.random((600, 3)), 1e3 * random.random((60, 3))])
    faces = np.stack([np.arange(658), np.arange(1, 659), np.arange(2, 660)], axis=1)
    surface = curvcli.Surface(points, faces)
    with pytest.raises(InputError, match="the radius takes in more than 100 vertices"):
        list(neighbourhoods.neighbourhoods(surface, parse_radius("1")))


@pytest.mark.parametrize("suffix", ["vtp", "vtu"])
def test_very_many_properties(suffix: str, tmp_path: Path) -> None:
    """VTK looks through all arrays for each: 30,000 took 40 seconds, and four times as many 16 times as long."""
    for count in (2000, 20_000):
        properties = [f"property uchar p{k}" for k in range(count)]
        head = [
            "ply",
            "format ascii 1.0",
            "element vertex 3",
            *(f"property double {axis}" for axis in "xyz"),
            *properties,
        ]
        faces = ["element face 1", "property list uchar int vertex_indices", "end_header"]
        rows = [f"{x} {y} 0{' 1' * count}" for x, y in ((0, 0), (1, 0), (0, 1))]
        (tmp_path / f"{count}.ply").write_text("\n".join([*head, *faces, *rows, "3 0 1 2"]) + "\n")
    assert run("analyze", tmp_path / "2000.ply", "-q", "-o", tmp_path / f"k.{suffix}").code == 0
    ended = run("analyze", tmp_path / "20000.ply", "-q", "-o", tmp_path / f"l.{suffix}")
    assert (ended.code, f"properties are too many for .{suffix}" in ended.complaint) == (3, True)
    assert run("analyze", tmp_path / "20000.ply", "-q", "-o", tmp_path / "l.ply").code == 0
