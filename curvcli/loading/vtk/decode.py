"""Values of the arrays of VTK XML files: text, base64 or raw bytes, compressed or not."""

from __future__ import annotations

import binascii
import lzma
import re
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError, MissingExtraError
from ...support.words import number_of
from ..text import plain_lines, read_tokens, tidy
from .document import XmlElement

TYPES = {
    "Int8": "i1",
    "UInt8": "u1",
    "Int16": "i2",
    "UInt16": "u2",
    "Int32": "i4",
    "UInt32": "u4",
    "Int64": "i8",
    "UInt64": "u8",
    "Float32": "f4",
    "Float64": "f8",
}
_LZMA_MEMORY = 1 << 27
_INTEGER = re.compile(rb"[+-]?\d{1,20}")


@dataclass
class Decoder:
    """Decoder of the arrays of one file.

    order: `<` or `>`. header: type of the numbers of bytes before binary data. inflate: decompresses a block to a known
    size; None without compression. appended: position of the appended data. base64: their encoding. limit: the most
    bytes to which compressed arrays may expand, which falls as they do.
    """

    data: bytes
    order: str
    header: np.dtype[Any]
    inflate: Callable[[memoryview | bytes, int], bytes] | None
    appended: int
    base64: bool
    limit: int

    def numbers(self, array: XmlElement, count: int, *, kept: bool = True) -> NDArray[Any]:
        """The numbers of an array, `count` of them. kept: in memory of their own, not that of the file.

        Errors: InputError for an unknown type, another number of values, or damaged data.
        """
        name, kind = array.attributes.get("Name", ""), array.attributes.get("type", "")
        try:
            if kind == "Bit":
                return self._bits(array, count)
            if kind not in TYPES:
                raise InputError(f"type `{kind[:40]}` found, one of {', '.join(TYPES)} expected")
            dtype = np.dtype(self.order + TYPES[kind])
            if array.attributes.get("format", "ascii") == "ascii":
                return numbers_of_text(self._text(array), np.dtype(TYPES[kind]), count)
            values = np.frombuffer(self._bytes(array, count * dtype.itemsize), dtype)
            return values.astype(dtype.newbyteorder("=")) if kept else values
        except InputError as error:
            error.place = error.place or (f"array `{name[:80]}`" if name else "array without a name")
            raise

    def words(self, array: XmlElement, count: int) -> list[str]:
        """The words of an array of text, each of which ends with a zero byte."""
        if array.attributes.get("format", "ascii") == "ascii":
            tokens = self._text(array).split()
            codes = numbers_of_text(b" ".join(tokens), np.dtype(np.int32), len(tokens))
            data = (codes & 255).astype(np.uint8).tobytes()
        else:
            data = bytes(self._bytes(array, None))
        texts = data.split(b"\0")[:-1]
        if len(texts) != count:
            name = array.attributes.get("Name", "")
            problem = f"{number_of(len(texts), 'text')} found, {count} expected"
            raise InputError(problem, place=f"array `{name[:80]}`")
        return [text.decode("utf-8", "backslashreplace") for text in texts]

    def _bits(self, array: XmlElement, count: int) -> NDArray[np.uint8]:
        if array.attributes.get("format", "ascii") == "ascii":
            return numbers_of_text(self._text(array), np.dtype(np.uint8), count)
        return np.unpackbits(np.frombuffer(self._bytes(array, -(-count // 8)), np.uint8), count=count)

    def _text(self, array: XmlElement) -> bytes:
        return b" ".join(self.data[piece] for piece in array.text)

    def _bytes(self, array: XmlElement, expected: int | None) -> memoryview | bytes:
        source = self._source(array)
        size = self.header.itemsize
        (first,) = np.frombuffer(source.take(size), self.header).tolist()
        if self.inflate is None:
            _compare(first, expected)
            return source.take(first)
        if not first:
            _compare(0, expected)
            return b""
        if first * size > source.left:
            raise InputError(f"{first} compressed blocks announced, more than the file can hold")
        block, last, *sizes = np.frombuffer(source.take((2 + first) * size), self.header).tolist()
        total = first * block if not last else (first - 1) * block + last
        _compare(total, expected)
        if total > self.limit:
            raise InputError(
                f"compressed data that expand to {total} bytes found, at most {self.limit} allowed",
                hint="--max-bytes sets the limit",
            )
        self.limit -= total
        packed = memoryview(source.take(sum(sizes)))
        blocks, at = [], 0
        for k, length in enumerate(sizes):
            blocks.append(self.inflate(packed[at : at + length], last if last and k == first - 1 else block))
            at += length
        return b"".join(blocks)

    def _source(self, array: XmlElement) -> _Raw | _Base64:
        form = array.attributes.get("format", "ascii")
        if form == "binary":
            return _Base64(b"".join(self._text(array).split()), 0)
        if form != "appended":
            raise InputError(f"format `{form[:40]}` found, ascii, binary or appended expected")
        offset = array.attributes.get("offset", "")
        if self.appended < 0:
            raise InputError("appended data announced, none found", hint="the file was cut off")
        if not (offset.isascii() and offset.isdigit() and len(offset) < 19):
            raise InputError(f"offset `{offset[:40]}` found, a whole number expected")
        at = self.appended + int(offset)
        if at > len(self.data):
            raise InputError(f"offset {offset} found, {len(self.data) - self.appended} bytes of appended data")
        return _Base64(self.data, at) if self.base64 else _Raw(self.data, at)


def _compare(size: int, expected: int | None) -> None:
    if expected is not None and size != expected:
        raise InputError(f"{number_of(size, 'byte')} announced, {expected} expected by the counts")


class _Raw:
    """Bytes as they stand, one piece after the other."""

    def __init__(self, data: bytes, at: int) -> None:
        self.data, self.at = data, at

    @property
    def left(self) -> int:
        """Number of bytes until the end."""
        return len(self.data) - self.at

    def take(self, count: int) -> memoryview:
        """The next bytes."""
        if count > self.left:
            raise InputError(f"{number_of(count, 'byte')} announced, {self.left} found", hint="the file was cut off")
        self.at += count
        return memoryview(self.data)[self.at - count : self.at]


class _Base64:
    """Bytes encoded as base64, one piece after the other; a piece may end with its own padding or go on."""

    def __init__(self, data: bytes, at: int) -> None:
        self.data, self.at, self.rest = data, at, b""

    @property
    def left(self) -> int:
        """The most bytes that the text until the end can hold."""
        return len(self.rest) + (len(self.data) - self.at) * 3 // 4

    def take(self, count: int) -> bytes:
        """The next bytes."""
        if count > self.left:
            raise InputError(f"{number_of(count, 'byte')} announced, {self.left} found", hint="the file was cut off")
        more = max(count - len(self.rest), 0)
        text = self.data[self.at : self.at + 4 * -(-more // 3)]
        try:
            decoded = self.rest + binascii.a2b_base64(text, strict_mode=True)
        except binascii.Error as error:
            raise InputError(f"no base64 data found: {error}") from None
        if len(decoded) < count:
            raise InputError(f"{number_of(count, 'byte')} announced, {len(decoded)} found", hint="the file was cut off")
        self.at += len(text)
        self.rest = decoded[count:]
        return decoded[:count]


def inflater(compressor: str) -> Callable[[memoryview | bytes, int], bytes]:
    """The function that decompresses a block to a known size.

    Errors: InputError for an unknown compressor, MissingExtraError for one whose library is not installed.
    """
    if compressor == "vtkLZ4DataCompressor":
        return _lz4()
    known = {"vtkZLibDataCompressor": _zlib, "vtkLZMADataCompressor": _lzma}
    if compressor not in known:
        raise InputError(f"compressor `{compressor[:40]}` found, {', '.join(known)} or vtkLZ4DataCompressor expected")
    return known[compressor]


def _zlib(block: memoryview | bytes, size: int) -> bytes:
    inflater = zlib.decompressobj()
    try:
        data = inflater.decompress(block, size + 1)
    except zlib.error as error:
        raise InputError(f"damaged zlib data found ({error})") from None
    return _whole(data, size)


def _lzma(block: memoryview | bytes, size: int) -> bytes:
    try:
        data = lzma.LZMADecompressor(memlimit=_LZMA_MEMORY).decompress(block, size + 1)
    except lzma.LZMAError as error:
        raise InputError(f"damaged LZMA data found ({error})") from None
    return _whole(data, size)


def _lz4() -> Callable[[memoryview | bytes, int], bytes]:
    try:
        from lz4.block import LZ4BlockError, decompress
    except ImportError:
        raise MissingExtraError("arrays compressed by LZ4 need lz4: `pip install 'curvcli[formats]'`") from None

    def inflate(block: memoryview | bytes, size: int) -> bytes:
        try:
            return _whole(decompress(bytes(block), uncompressed_size=size), size)
        except LZ4BlockError as error:
            raise InputError(f"damaged LZ4 data found ({error})") from None

    return inflate


def _whole(data: bytes, size: int) -> bytes:
    if len(data) != size:
        raise InputError(f"compressed block of {'more' if len(data) > size else len(data)} bytes, {size} expected")
    return data


def numbers_of_text(text: bytes, dtype: np.dtype[Any], count: int | None) -> NDArray[Any]:
    """Numbers of a text. Decimal fractions stay doubles, as in all text formats."""
    whole = dtype.kind != "f"
    text = tidy(plain_lines(text)[:-1].replace(b"\n", b" ") + b"\n")
    if text == b"\n":
        numbers = np.empty(0, dtype if whole else np.float64)
    else:
        numbers, known = read_tokens(text, np.int32 if whole else np.float64)
        if not known.all():
            numbers = _long(text, known, dtype)
        if whole:
            numbers = _typed(numbers, dtype)
    if count is not None and len(numbers) != count:
        raise InputError(f"{number_of(len(numbers), 'value')} found, {count} expected by the counts")
    return numbers


def _long(text: bytes, known: NDArray[np.bool_], dtype: np.dtype[Any]) -> NDArray[Any]:
    """WholeNumbers that do not fit 32 bits. Errors: InputError for a word that is no number of the type."""
    tokens = text.split()
    wrong = np.flatnonzero(~known).tolist()
    limits = np.iinfo(dtype) if dtype.kind != "f" else None
    for k in wrong:
        if limits is None or not _INTEGER.fullmatch(tokens[k]) or not limits.min <= int(tokens[k]) <= limits.max:
            word = tokens[k][:40].decode("utf-8", "backslashreplace")
            raise InputError(f"`{word}` found, a number of type {dtype.name} expected")
    return np.array([int(token) for token in tokens], dtype)


def _typed(numbers: NDArray[Any], dtype: np.dtype[Any]) -> NDArray[Any]:
    typed = numbers.astype(dtype, copy=False)
    wrong = np.flatnonzero(typed != numbers)
    if len(wrong):
        raise InputError(f"`{numbers[wrong[0]]}` found, a number of type {dtype.name} expected")
    return typed
