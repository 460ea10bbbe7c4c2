"""A small file of each format, and what is said of one that cannot be read."""

from __future__ import annotations

from typing import Any

import pytest

from curvcli.errors import InputError
from curvcli.loading.read import read_mesh_file
from tests.helpers.spelling import binary_stl
from tests.loading.test_ply import ascii_ply
from tests.loading.test_stl import TETRAHEDRON

OBJ = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
PLY = ascii_ply("3 0 1 2\n3 0 2 3\n")
STL = binary_stl(TETRAHEDRON)
CONTENT = {"obj": OBJ, "ply": PLY, "stl": STL}


def refused(source: Any, **options: Any) -> str:
    with pytest.raises(InputError) as error:
        read_mesh_file(source, **options)
    assert str(error.value).isprintable(), "one line, whatever the file is called"
    return str(error.value)
