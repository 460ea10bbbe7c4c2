"""Reading a file of labels, by its suffix or its content."""

from __future__ import annotations

import os

from ...errors import InputError
from ..content import inflate, open_regular, read_whole
from ..registry import input_formats
from .base import LabelFile

SUFFIXES = (".npy", ".csv", ".tsv", ".txt", ".annot", ".label", ".gii")
# FreeSurfer's names of values of vertices, without the hemisphere before them.
_VALUES = (".curv", ".crv", ".sulc", ".thickness", ".area", ".volume")
_GZIP = b"\x1f\x8b"


def is_label_file(name: str) -> bool:
    """Test for the name of a file of labels: a suffix of one, a name of FreeSurfer, or a file with any suffix."""
    path = name.lower().removesuffix(".gz")
    suffix = os.path.splitext(path)[1]
    starts = input_formats()["freesurfer"].starts
    return (
        suffix in (*SUFFIXES, *_VALUES)
        or os.path.basename(path).startswith(starts)
        or bool(suffix and os.path.isfile(name))
    )


def read_labels(path: str) -> LabelFile:
    """Read labels of faces or vertices.

    Errors: InputError for a file that cannot be read or has other content; MissingExtraError for GIFTI without nibabel.
    """
    try:
        with open_regular(path, None) as file:
            data = read_whole(file, None)
        return _read(inflate(data, None) if data.startswith(_GZIP) else data, path)
    except InputError as error:
        error.path = path
        raise
    except ValueError as error:
        raise InputError(f"{error}, expected one whole number per face or vertex", path=path) from None


def _read(data: bytes, path: str) -> LabelFile:
    from . import freesurfer

    name = os.path.basename(path).lower().removesuffix(".gz")
    stem, suffix = os.path.splitext(name)
    if suffix == ".npy":
        from .numpy_array import read_array

        return read_array(data)
    if suffix == ".annot":
        return freesurfer.read_annotation(data)
    if suffix == ".label" or freesurfer.LABEL_SIGN.match(data):
        # The name of the region is that of the file, in its own case.
        return freesurfer.read_label(data, os.path.basename(path)[: len(stem)])
    if suffix == ".gii" or data.lstrip()[:1] == b"<":
        from .gifti import read_gifti_labels

        return read_gifti_labels(data)
    starts = input_formats()["freesurfer"].starts
    if suffix not in SUFFIXES and (
        suffix in _VALUES or name.startswith(starts) or data.startswith(freesurfer.NEW_VALUES)
    ):
        return freesurfer.read_values(data)
    from .text import read_text

    return read_text(data)
