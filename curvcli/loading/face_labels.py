"""Labels of the faces of a surface, from numbers or names of its polygons, triangles or vertices."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, Notice
from ..mesh.file import Labels
from ..mesh.surface import Surface
from ..support.words import number_of
from .label_files.base import LabelFile, LabelledElement


def face_labels(surface: Surface, given: LabelFile, source: str) -> tuple[Labels, Labels, list[Notice]]:
    """Labels (F,) of the triangles, the labels as given, and notices of choices that were made.

    Without a column or header of elements, their number decides: polygons of the file, triangles, vertices, in this
    order. A polygon's label passes to its triangles. source: in messages.
    Errors: InputError for labels of another number, that are no whole numbers, or of elements that are not there.
    """
    size = len(given.values.codes) if isinstance(given.values, Labels) else _length(given.values, source)
    element, notices = given.element, []
    header = given.header and element is not None
    if element is None:
        element, header = _element(surface, size, given.header, source)
        if element != "vertex" and size - header == surface.n_vertices:
            message = "labels that fit both faces and vertices, taken for those of faces"
            notices.append(Notice("ambiguous_labels", size - header, message, "a first line `vertex` decides in text"))
    labels = given.values if isinstance(given.values, Labels) else _coded(given.values, source, element)
    if header:
        labels = replace(labels, codes=labels.codes[1:])
    if given.index is not None:
        labels = _placed(surface, labels, given.index, element, source)
    _check_number(surface, len(labels.codes), element, source)
    if element == "vertex":
        faces, unlike, undecided = from_vertices(labels.codes, surface.faces)
        if unlike:
            message = (
                f"faces with corners of different labels: {unlike - undecided} got the label of two corners, "
                f"{undecided} that of the lowest corner"
            )
            notices.append(Notice("labels_of_vertices", unlike, message, "labels per face leave no choice"))
    else:
        by_polygon = element == "polygon" and surface.polygon is not None
        faces = labels.codes[surface.polygon] if by_polygon else labels.codes
    return replace(labels, codes=faces), labels, notices


def from_vertices(labels: NDArray[np.int32], faces: NDArray[np.integer[Any]]) -> tuple[NDArray[np.int32], int, int]:
    """Labels (F,) of faces from those of vertices (V,): that of two corners, else that of the corner of lowest index.

    Also the numbers of faces with unlike corners, and of those with three different ones. -1 counts as a label.
    """
    a, b, c = (labels[faces[:, corner]] for corner in range(3))
    of_two = (a == b) | (a == c)
    result = np.where(of_two, a, np.where(b == c, b, labels[faces.min(axis=1)]))
    equal = (a == b) & (b == c)
    return result, int(np.count_nonzero(~equal)), int(np.count_nonzero(~(of_two | (b == c))))


def _length(values: NDArray[Any], source: str) -> int:
    if values.ndim != 1 or values.dtype.kind not in "iufb":
        raise InputError(
            f"{source}: shape {values.shape} of {values.dtype}, expected one whole number per face or vertex"
        )
    return len(values)


def _counts(surface: Surface) -> dict[LabelledElement, int]:
    polygons = surface.file.polygons if surface.file is not None else surface.n_faces
    return {"polygon": polygons, "face": surface.n_faces, "vertex": surface.n_vertices}


def _element(surface: Surface, size: int, header: bool, source: str) -> tuple[LabelledElement, bool]:
    """The element of so many labels, and a flag: the first of them is a header."""
    counts = _counts(surface)
    for first in range(2 if header else 1):
        for element, count in counts.items():
            if size - first == count:
                return element, bool(first)
    raise _other_number(surface, size, None, source)


def _check_number(surface: Surface, size: int, element: LabelledElement, source: str) -> None:
    counts = _counts(surface)
    if size != counts[element] and not (element != "vertex" and size == counts["face"]):
        raise _other_number(surface, size, element, source)


def _other_number(surface: Surface, size: int, element: LabelledElement | None, source: str) -> InputError:
    polygons, triangles, vertices = _counts(surface).values()
    expected = f"{polygons} (faces)" if polygons == triangles else f"{polygons} (polygons) or {triangles} (triangles)"
    if element == "vertex":
        expected = f"{vertices} (vertices)"
    elif element is None and vertices != triangles:
        expected = f"{expected.replace(' or', ',')} or {vertices} (vertices)"
    return InputError(f"{source}: {number_of(size, 'label')}, expected {expected}")


def _coded(values: NDArray[Any], source: str, element: LabelledElement) -> Labels:
    """Numbers as labels in ascending order; negative numbers are none."""
    # Beyond, a floating-point type skips whole numbers, and two labels would be equal.
    bits = np.finfo(values.dtype).nmant + 1 if values.dtype.kind == "f" else 63
    with np.errstate(invalid="ignore"):
        whole = values.astype(np.int64)
        wrong = np.flatnonzero((whole != values) | (np.abs(values) >= 2.0**bits))
    if len(wrong):
        first = int(wrong[0])
        expected = f"a whole number below 2^{bits}" + (", or integers in a .npy file" if bits < 63 else "")
        name = "vertex" if element == "vertex" else "face"
        raise InputError(f"{source}: label {values[first]} of {name} {first}, expected {expected}")
    names, codes = _distinct(np.maximum(whole, -1))
    return Labels(codes, tuple(map(str, names.tolist())))


def _distinct(numbers: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """The distinct numbers from 0 on, ascending, and (n,) the place of each number among them; -1 for -1."""
    largest = int(numbers.max(initial=-1))
    if largest > len(numbers) + (1 << 16):
        known = numbers >= 0
        names, codes = np.unique(numbers[known], return_inverse=True)
        indices = np.full(len(numbers), -1, np.int32)
        indices[known] = codes
        return names, indices
    present = np.bincount(numbers + 1, minlength=largest + 2)[1:] > 0
    place = np.append(np.cumsum(present, dtype=np.int32) - np.int32(1), np.int32(-1))
    return np.flatnonzero(present), place[numbers]  # the last place stands for -1


def _placed(
    surface: Surface, labels: Labels, index: NDArray[np.int64], element: LabelledElement, source: str
) -> Labels:
    """Labels in the order of the elements, -1 for elements that have no row."""
    counts = _counts(surface)
    count = counts[element]
    if element == "face" and len(index) == counts["polygon"]:
        count = counts["polygon"]
    wrong = np.flatnonzero((index < 0) | (index >= count))
    if len(wrong):
        problem = f"{source}: {element} {index[wrong[0]]} found, 0 to {count - 1} expected"
        raise InputError(problem, hint="the labels are of another mesh, or are counted from 1")
    twice = np.flatnonzero(np.bincount(index, minlength=count) > 1)
    if len(twice):
        raise InputError(f"{source}: {element} {twice[0]} has more than one label")
    codes = np.full(count, -1, np.int32)
    codes[index] = labels.codes
    return replace(labels, codes=codes)
