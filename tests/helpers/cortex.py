"""Files of FreeSurfer and GIFTI in every dialect, written by code of the tests and by nibabel."""

from __future__ import annotations

import base64
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.helpers.every_format import Shape

FOOTER: dict[str, Any] = {
    "head": [2, 0, 20],
    "valid": "1  # volume info valid",
    "filename": "../mri/filled-pretess255.mgz",
    "volume": [256, 256, 256],
    "voxelsize": [1.0, 1.0, 1.0],
    "xras": [-1.0, 0.0, 0.0],
    "yras": [0.0, 0.0, -1.0],
    "zras": [0.0, 1.0, 0.0],
    "cras": [5.4, 18.0, -0.1],
}


def triangles(shape: Shape, comment: bytes = b"created by a test\n\n", footer: bytes = b"") -> bytes:
    """A binary surface of triangles."""
    faces = shape.triangles
    counts = np.array([len(shape.points), len(faces)], ">i4").tobytes()
    return (
        b"\xff\xff\xfe"
        + comment
        + counts
        + shape.points.astype(">f4").tobytes()
        + faces.astype(">i4").tobytes()
        + footer
    )


def quadrangles(points: NDArray[np.float64], quads: NDArray[np.integer[Any]], *, old: bool) -> bytes:
    """A binary surface of quadrangles: hundredths as int16 (old), or floats."""
    at = np.round(points * 100).astype(">i2") if old else points.astype(">f4")
    head = (b"\xff\xff\xff" if old else b"\xff\xff\xfd") + three(len(points)) + three(len(quads))
    return head + at.tobytes() + b"".join(three(int(corner)) for corner in quads.reshape(-1))


def three(number: int) -> bytes:
    """An integer of three bytes."""
    return number.to_bytes(3, "big")


def text(shape: Shape) -> bytes:
    """The text that `mris_convert lh.white lh.white.asc` writes, with all digits."""
    lines = ["#!ascii version of lh.white", f"{len(shape.points)} {len(shape.triangles)}"]
    lines += [f"{x!r}  {y!r}  {z!r}  0" for x, y, z in shape.points.tolist()]
    lines += [f"{a} {b} {c} 0" for a, b, c in shape.triangles.tolist()]
    return ("\n".join(lines) + "\n").encode()


def by_nibabel(path: Path, shape: Shape, footer: dict[str, Any] | None = None) -> None:
    """A binary surface, written by nibabel."""
    import nibabel

    nibabel.freesurfer.write_geometry(path, shape.points, shape.triangles, "created by a test", footer)


ENCODINGS = ("ASCII", "Base64Binary", "GZipBase64Binary")
_NAMES = {"f4": "NIFTI_TYPE_FLOAT32", "f8": "NIFTI_TYPE_FLOAT64", "i4": "NIFTI_TYPE_INT32", "u1": "NIFTI_TYPE_UINT8"}


def data_array(
    values: NDArray[Any],
    intent: str,
    *,
    encoding: str = "GZipBase64Binary",
    big: bool = False,
    columns: bool = False,
    inside: str = "",
) -> str:
    """The element of an array. columns: in column-major order. inside: further elements before the data."""
    order = "F" if columns else "C"
    kind = values.dtype.str[1:]
    if encoding == "ASCII":
        data = "\n".join(repr(float(x)) if kind[0] == "f" else str(int(x)) for x in values.ravel(order))
    else:
        raw = values.astype((">" if big else "<") + kind).tobytes(order)
        data = base64.b64encode(raw if encoding == "Base64Binary" else zlib.compress(raw)).decode()
    sizes = " ".join(f'Dim{k}="{size}"' for k, size in enumerate(values.shape))
    return (
        f'<DataArray Intent="NIFTI_INTENT_{intent}" DataType="{_NAMES[kind]}" ArrayIndexingOrder='
        f'"{"Column" if columns else "Row"}MajorOrder" Dimensionality="{values.ndim}" {sizes} Encoding="{encoding}" '
        f'Endian="{"Big" if big else "Little"}Endian" ExternalFileName="" ExternalFileOffset="">\n{inside}'
        f"<Data>{data}</Data>\n</DataArray>\n"
    )


def gifti(*arrays: str, table: str = "", count: int | None = None) -> bytes:
    """A GIFTI file of these arrays. count: announced arrays, if it is another number."""
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<!DOCTYPE GIFTI SYSTEM "http://www.nitrc.org/frs/download.php/115/gifti.dtd">\n'
        f'<GIFTI Version="1.0" NumberOfDataArrays="{len(arrays) if count is None else count}">\n'
        f"<MetaData/>\n<LabelTable>{table}</LabelTable>\n{''.join(arrays)}</GIFTI>\n"
    ).encode()


def surface_gii(shape: Shape, kind: str = "f4", **options: Any) -> bytes:
    """A GIFTI surface in one dialect."""
    points = data_array(shape.points.astype(kind), "POINTSET", **options)
    return gifti(points, data_array(shape.triangles, "TRIANGLE", **options))
