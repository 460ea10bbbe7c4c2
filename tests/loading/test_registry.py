"""The registry of input formats: each declares itself, and only itself."""

from __future__ import annotations

import ast
import io
import re
from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.errors import InputError, MissingExtraError
from curvcli.loading import entrance, registry
from curvcli.loading.pieces import Pieces
from curvcli.loading.registry import InputFormat, ParserOptions, input_formats, register, suffixes

PACKAGE = Path(curvcli.__file__).parent
OFF = b"OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0.1\n3 2 0 1\n"


def never(_pieces: Pieces) -> bool:
    return False


def test_formats_are_those_of_the_folder() -> None:
    folder = PACKAGE / "loading" / "formats"
    modules = {path.stem for path in folder.iterdir() if not path.name.startswith("_")}
    assert {name.replace("3", "three") for name in input_formats()} == modules
    assert list(suffixes()) == [ending for one in input_formats().values() for ending in one.endings]


def test_no_other_module_lists_them() -> None:
    """A tuple, list or set of names of formats stands nowhere."""
    names = set(suffixes())
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Tuple | ast.List | ast.Set):
                words = {
                    one.value.lstrip(".")
                    for one in node.elts
                    if isinstance(one, ast.Constant) and str is type(one.value)
                }
                assert not words >= names, f"{path.relative_to(PACKAGE)}:{node.lineno}"


def test_a_name_is_taken_once(monkeypatch: pytest.MonkeyPatch) -> None:
    input_formats()
    monkeypatch.setattr(registry, "_registered", dict(registry._registered))
    with pytest.raises(ValueError, match="two input formats named ply"):
        register(InputFormat(name="other", has_sign=never, suffixes=("ply",)))
    register(InputFormat(name="other", has_sign=never))
    with pytest.raises(ValueError, match="named other"):
        register(InputFormat(name="other", has_sign=never, suffixes=("else",)))


def test_a_missing_library_is_named() -> None:
    needy = InputFormat(name="other", has_sign=never, library="no_such_library", extra="things")
    with pytest.raises(
        MissingExtraError, match=re.escape("OTHER needs no_such_library: `pip install 'curvcli[things]'`")
    ):
        needy.require()


def test_a_format_without_a_parser_is_read_by_trimesh() -> None:
    plain = InputFormat(name="off", has_sign=never)
    mesh = entrance.load_through_trimesh(Pieces(OFF), plain, ParserOptions())
    assert mesh.format == "off"
    np.testing.assert_array_equal(mesh.xyz.T, [[0, 0, 0], [1, 0, 0], [0, 1, 0.1]])
    assert mesh.corners.tolist() == [2, 0, 1]
    for damaged in (OFF.replace(b"0.1", b"x"), b"OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", b"nothing"):
        with pytest.raises(InputError):
            entrance.load_through_trimesh(Pieces(damaged), plain, ParserOptions())


def test_the_stream_gives_its_bytes_once() -> None:
    stream = entrance.MeshStream(Pieces(b"abcdef"), ParserOptions())
    assert isinstance(stream, io.RawIOBase)
    assert (stream.read(2), stream.read(), stream.read(1)) == (b"ab", b"cdef", b"")
