"""Arrays of a GIFTI file: nibabel's parser, with the size of each array checked before it is decoded."""

from __future__ import annotations

import binascii
import math
import zlib
from dataclasses import dataclass, replace
from typing import Any
from xml.parsers.expat import ExpatError

import numpy as np
from nibabel.gifti.parse_gifti_fast import GiftiImageParser
from nibabel.gifti.util import array_index_order_codes, gifti_encoding_codes, gifti_endian_codes
from nibabel.nifti1 import data_type_codes, intent_codes
from nibabel.xmlutils import XmlParser
from numpy.typing import NDArray

from ....errors import InputError
from ....mesh.file import Labels
from ....support.words import escape_text, number_of
from ...content import free_inflation
from ...limits import check_faces
from ...text import drop_empty_lines, plain_lines, read_tokens, tidy

POSITIONS, TRIANGLES, LABELS = 1008, 1009, 1002
_WHITE = b" \t\r\n"
_MOST_ARRAYS, _MOST_DIMENSIONS = 100_000, 6
_ZLIB_OR_GZIP = zlib.MAX_WBITS | 32


@dataclass(frozen=True, eq=False)
class DataArray:
    """An array of a GIFTI file.

    intent: the code of NIfTI, such as POSITIONS. values: in the shape of the file. name: of its metadata, else of its
    intent. transformed: true for a matrix other than the identity.
    """

    intent: int
    values: NDArray[Any]
    name: str
    transformed: bool

    def flat(self) -> DataArray:
        """The same array in one dimension."""
        return replace(self, values=self.values.reshape(-1))


@dataclass(frozen=True, eq=False)
class Image:
    """Arrays in file order, and the table of labels: names and colours (n, 4), each from 0 to 1, by key."""

    arrays: tuple[DataArray, ...]
    names: dict[int, str]
    colors: dict[int, tuple[float, float, float]]

    def labels(self, array: DataArray) -> Labels:
        """An array of keys as labels; keys without an entry of the table are their own names."""
        keys, codes = np.unique(array.values, return_inverse=True)
        names = tuple(self.names.get(key) or str(key) for key in keys.tolist())
        colors = None
        if self.colors:
            rows = [self.colors.get(key, (0.5, 0.5, 0.5)) for key in keys.tolist()]
            colors = np.round(255 * np.clip(np.nan_to_num(rows), 0, 1)).astype(np.uint8)[:, :3]
        return Labels(codes.reshape(-1).astype(np.int32), names, colors)


def read_image(data: bytes, max_faces: int | None = None) -> Image:
    """Read all arrays of a GIFTI file.

    No other file is opened, and no entity is replaced. Time and memory are bounded by the size of the data.
    Errors: InputError for malformed XML, arrays in another file, and data that do not fit the size of their array.
    """
    parser = _Parser(data, max_faces)
    try:
        parser.read(data)
    except (InputError, MemoryError):
        raise
    except ExpatError as error:
        raise InputError(f"malformed XML: {error}") from None
    except Exception as error:
        # nibabel's parser raises exceptions of any type for elements at wrong places and unknown codes.
        raise InputError(f"damaged GIFTI: {type(error).__name__}: {escape_text(str(error))[:80]}") from None
    if parser.img is None:
        raise InputError("no element GIFTI found")
    arrays = tuple(parser.array(number, array) for number, array in enumerate(parser.img.darrays))
    table = {label.key: label for label in parser.img.labeltable.labels}
    channels = {key: (label.red, label.green, label.blue) for key, label in table.items()}
    colors = {key: color for key, color in channels.items() if None not in color}
    # The attribute is missing for an element without text.
    return Image(arrays, {key: escape_text(getattr(label, "label", "")) for key, label in table.items()}, colors)


class _Parser(GiftiImageParser):  # type: ignore[misc]
    """nibabel's parser with decoding of our own, which trusts no size; entities are refused."""

    HANDLER_NAMES = [*XmlParser.HANDLER_NAMES, "StartDoctypeDeclHandler", "SkippedEntityHandler"]  # noqa: RUF012

    def __init__(self, data: bytes, max_faces: int | None) -> None:
        super().__init__(buffer_size=1 << 20)
        self.left = free_inflation(len(data))
        self.max_faces = max_faces

    def read(self, data: bytes) -> None:
        """Parse all data in one call: by pieces, expat would scan a long attribute or comment again for each."""
        parser = self._create_parser()
        for name in self.HANDLER_NAMES:
            setattr(parser, name, getattr(self, name))
        parser.Parse(data, True)

    def StartDoctypeDeclHandler(self, _name: str, _system: str, _public: str, has_declarations: int) -> None:
        # Entities grow exponentially, and expat's time is quadratic in the number of default attributes.
        if has_declarations:
            raise InputError("declarations of entities or elements in the DOCTYPE found, none expected")

    def SkippedEntityHandler(self, name: str, _is_parameter: bool) -> None:
        raise InputError(f"the entity `{escape_text(name)[:40]}` found, which has no value")

    def StartElementHandler(self, name: str, attrs: dict[str, str]) -> None:
        if name == "DataArray":
            if len(self.img.darrays) == _MOST_ARRAYS:
                raise InputError(f"more than {_MOST_ARRAYS} data arrays found")
            place = f"data array {len(self.img.darrays)}"
            if attrs.get("Encoding") == "ExternalFileBinary":
                hint = "`mris_convert` or nibabel write all arrays into one file"
                raise InputError("data in another file found, which is not opened", place=place, hint=hint)
            dimensions = attrs.get("Dimensionality", "0")
            if not (dimensions.isdecimal() and int(dimensions[:9]) <= _MOST_DIMENSIONS):
                expected = f"0 to {_MOST_DIMENSIONS} expected"
                raise InputError(f"`{escape_text(dimensions)[:40]}` dimensions found, {expected}", place=place)
        super().StartElementHandler(name, attrs)

    def EndElementHandler(self, name: str) -> None:
        if name == "GIFTI" and (announced := getattr(self, "expected_numDA", self.img.numDA)) != self.img.numDA:
            raise InputError(f"{number_of(announced, 'data array')} announced, {self.img.numDA} found")
        super().EndElementHandler(name)

    def flush_chardata(self) -> None:
        if self.write_to in ("Data", "MatrixData", "DataSpace", "TransformedSpace"):
            text = "".join(self._char_blocks or ())
            self._char_blocks: list[str] | None = None
            if self.write_to == "Data":
                self._add(text)
            elif self.write_to == "MatrixData" and text.strip():
                self.coordsys.xform = np.array([float(word) for word in text.split()]).reshape(4, 4)
            return
        super().flush_chardata()

    def _add(self, text: str) -> None:
        place = f"data array {len(self.img.darrays) - 1}"
        if self.fsm_state[-1:] != ["DataArray"] or (self.da.data is not None and text.strip()):
            raise InputError("Data outside an array of its own found", place=place)
        if self.da.data is None:
            try:
                self.da.data = self._decoded(text)
            except InputError as error:
                error.place = place
                raise

    def _decoded(self, text: str) -> NDArray[Any]:
        shape = tuple(self.da.dims)
        kind = np.dtype(data_type_codes.dtype[self.da.datatype])
        if kind.kind not in "iuf" or min(shape, default=0) < 0:
            raise InputError(f"an array of {kind} in the shape {shape} found, numbers expected")
        if self.da.intent == TRIANGLES and shape:
            check_faces(shape[0], self.max_faces)
        count = math.prod(shape)
        encoding = gifti_encoding_codes.specs[self.da.encoding]
        order = array_index_order_codes.npcode[self.da.ind_ord]
        if encoding == "ASCII":
            numbers = _from_text(text, kind, count)
            if order == "F" and _in_rows(text, shape):
                order = "C"
        elif encoding in ("Base64Binary", "GZipBase64Binary"):
            data = _from_base64(text)
            if encoding != "Base64Binary":
                data = self._inflated(data, count * kind.itemsize)
            if len(data) != count * kind.itemsize:
                raise _other_size(f"{len(data)} bytes", shape, kind)
            numbers = np.frombuffer(data, kind.newbyteorder(gifti_endian_codes.byteorder[self.da.endian]))
        else:
            raise InputError(f"data in the encoding `{encoding}` found, ASCII or base64 expected")
        return numbers.reshape(shape, order=order)

    def _inflated(self, data: bytes, size: int) -> bytes:
        if size > self.left:
            raise InputError(f"{size} bytes announced, more than {number_of(len(data), 'byte')} of zlib data may hold")
        self.left -= size
        inflater = zlib.decompressobj(_ZLIB_OR_GZIP)
        try:
            result = inflater.decompress(data, size + 1)
            rest = inflater.decompress(inflater.unconsumed_tail, 1)
        except zlib.error as error:
            raise InputError(f"damaged zlib data found ({error})") from None
        if len(result) == size and not rest and not inflater.eof:
            raise InputError("zlib data that end early found")
        return result + rest

    def array(self, number: int, array: Any) -> DataArray:
        """An array after the end of the file. Errors: InputError for one without data."""
        if array.data is None:
            raise InputError("no data found", place=f"data array {number}")
        name = (array.meta or {}).get("Name") or intent_codes.niistring[array.intent].removeprefix(
            "NIFTI_INTENT_"
        ).lower()
        matrix = None if array.coordsys is None else array.coordsys.xform
        transformed = matrix is not None and not np.array_equal(matrix, np.eye(4))
        # Programs name an array after the path of the file it came from.
        return DataArray(array.intent, array.data, name.replace("\\", "/").rpartition("/")[2] or name, transformed)


def _from_text(text: str, kind: np.dtype[Any], count: int) -> NDArray[Any]:
    if kind.kind != "f" and "/" in text:
        raise InputError("`/` found, a whole number expected")
    numbers, known = np.empty(0, kind), np.empty(0, np.bool_)
    if text.strip():
        data = drop_empty_lines(tidy(plain_lines(text.encode())))[0]
        numbers, known = read_tokens(data, np.float64 if kind.kind == "f" else np.int32)
    wrong = np.flatnonzero(~known)
    if len(wrong):
        word = escape_text(text.split()[wrong[0]])[:40]
        raise InputError(f"`{word}` found, a number of type {kind} expected")
    if len(numbers) != count:
        raise InputError(f"{number_of(len(numbers), 'number')} found, {count} expected")
    with np.errstate(over="ignore"):
        return numbers.astype(kind)


def _in_rows(text: str, shape: tuple[int, ...]) -> bool:
    """Test for a line of text per row: nibabel writes and reads rows so, although it says column-major order."""
    lines = [line for line in text.splitlines() if line.strip()] if len(shape) == 2 else []
    return len(lines) == shape[0] and len(lines[0].split()) == shape[1] if lines else False


def _from_base64(text: str) -> bytes:
    try:
        data = text.encode("ascii").strip()
        # Line breaks are rare, and removing them takes a fifth of the time of reading.
        data = data.translate(None, _WHITE) if any(byte in data for byte in (b"\n", b" ", b"\r", b"\t")) else data
        return binascii.a2b_base64(data, strict_mode=True)
    except ValueError as error:
        raise InputError(f"malformed base64 data found ({escape_text(str(error))[:60]})") from None


def _other_size(size: str, shape: tuple[int, ...], kind: np.dtype[Any]) -> InputError:
    return InputError(f"{size} found, {math.prod(shape) * kind.itemsize} expected for {kind} in the shape {shape}")
