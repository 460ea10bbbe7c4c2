"""Labels in a GIFTI file: an array of keys with its table (.label.gii), or of whole numbers (.shape.gii, .func.gii)."""

from __future__ import annotations

from ...errors import InputError
from ...support.words import escape_text, number_of
from ..registry import input_formats
from .base import LabelFile


def read_gifti_labels(data: bytes) -> LabelFile:
    """Read the only array of labels of a GIFTI file, or else its only array of values.

    Errors: MissingExtraError without nibabel; InputError for damaged files, and for several arrays.
    """
    input_formats()["gii"].require()
    from ..formats.gii.image import LABELS, POSITIONS, TRIANGLES, read_image

    image = read_image(data)
    arrays = [array for array in image.arrays if array.intent == LABELS]
    arrays = arrays or [array for array in image.arrays if array.intent not in (POSITIONS, TRIANGLES)]
    if len(arrays) != 1:
        listed = escape_text(", ".join(array.name for array in arrays[:8]))[:80]
        raise InputError(
            f"{number_of(len(arrays), 'array')} of labels found, one expected" + (f": {listed}" if listed else "")
        )
    (array,) = arrays
    if array.values.ndim == 2 and 1 in array.values.shape:
        array = array.flat()
    if array.values.ndim != 1:
        raise InputError(f"an array in the shape {array.values.shape} found, one label per vertex expected")
    if array.values.dtype.kind in "iu" and (array.intent == LABELS or image.names):
        return LabelFile(image.labels(array), "vertex")
    return LabelFile(array.values, "vertex")
