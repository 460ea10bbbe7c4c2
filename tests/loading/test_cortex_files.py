"""Surfaces and labels that packages of the field ship: read as nibabel reads them."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from curvcli.errors import InputError
from curvcli.loading.label_files.read import read_labels
from curvcli.loading.read import read_mesh_file
from curvcli.mesh.file import Labels

nibabel = pytest.importorskip("nibabel", reason="nibabel reads GIFTI")
FOLDERS = {"nilearn": ("datasets/data/fsaverage5", "surface/tests/data"), "nibabel": ("gifti/tests/data",)}
SUFFIXES = (".gii", ".gii.gz", ".annot", ".label")

# What is refused, and why: parts of files, and data in another file.
REFUSED = {
    "external.gii": "another file",
    "external.gii.gz": "another file",
    "ascii_flat_data.gii": "vertex index",
    "base64bin.gii": "vertex index",
    "test.label": "a number of rows",
}


def files() -> list[Any]:
    found = []
    for package, folders in FOLDERS.items():
        spec = find_spec(package)
        if spec is None or spec.origin is None:
            found.append(pytest.param(None, marks=pytest.mark.skip(reason=f"{package} is not installed")))
            continue
        paths = (path for folder in folders for path in sorted((Path(spec.origin).parent / folder).glob("*")))
        found += [pytest.param(path, id=f"{package}-{path.name}") for path in paths if path.name.endswith(SUFFIXES)]
    return found


@pytest.mark.parametrize("path", files())
def test_real_files(path: Path) -> None:
    name = path.name
    is_surface = False
    if ".gii" in name:
        if name in REFUSED and "external" in name:
            arrays = ()
            is_surface = True
        else:
            arrays = nibabel.load(path).darrays
            is_surface = 1009 in {array.intent for array in arrays}
    if name in REFUSED:
        with pytest.raises(InputError, match=REFUSED[name]):
            read_mesh_file(path) if is_surface else read_labels(str(path))
        return
    if is_surface:
        mesh = read_mesh_file(path)
        points, faces = (array.data for array in arrays[:2])
        np.testing.assert_array_equal(mesh.xyz.T, points)
        np.testing.assert_array_equal(mesh.corners.reshape(-1, 3), faces)
    elif name.endswith(".annot"):
        values = read_labels(str(path)).values
        assert isinstance(values, Labels)
        codes, _, names = nibabel.freesurfer.read_annot(path)
        assert list(values.names) == [label.decode() for label in names]
        np.testing.assert_array_equal(values.codes, codes)
    elif len(arrays) == 1:
        values = read_labels(str(path)).values
        if isinstance(values, Labels):
            keys = {label.label: label.key for label in nibabel.load(path).labeltable.labels}
            key = np.array([keys[name] if name in keys else int(name) for name in values.names])
            np.testing.assert_array_equal(key[values.codes], arrays[0].data.ravel())
        else:
            np.testing.assert_array_equal(values, arrays[0].data.ravel())
    else:
        with pytest.raises(InputError, match=f"{len(arrays)} arrays of labels found"):
            read_labels(str(path))
