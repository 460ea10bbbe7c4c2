"""Labels in a .npy file: one number per face or vertex."""

from __future__ import annotations

import io
import math

import numpy as np

from .base import LabelFile

MAGIC = b"\x93NUMPY"


def read_array(data: bytes) -> LabelFile:
    """Read an array of numbers. Errors: ValueError for other content."""
    if not data.startswith(MAGIC):
        raise ValueError("is not a .npy file")
    stream = io.BytesIO(data)
    try:
        version = np.lib.format.read_magic(stream)
        header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, in_columns, dtype = header(stream)
        if dtype.hasobject:
            raise ValueError("objects")
        # The size of the data decides: a header that announces more is refused before memory is allocated.
        array = np.frombuffer(data, dtype, math.prod(shape), stream.tell())
        return LabelFile(array.reshape(shape, order="F" if in_columns else "C"))
    except MemoryError:
        raise
    except Exception as error:
        # numpy parses the header with Python's parser, and a damaged header raises any of its exceptions.
        raise ValueError(f"is a damaged .npy file ({error})") from None
