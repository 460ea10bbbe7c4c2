"""Parts of a 3MF package: the models in its ZIP archive, as XML without what could refer elsewhere."""

from __future__ import annotations

import io
import re
import zipfile
import zlib

from ....errors import InputError
from ...content import free_inflation, too_large

_TARGET = re.compile(
    rb"""<(?:[\w.-]+:)?Relationship\s(?=[^<>]*/3dmodel["'])[^<>]*?\bTarget\s*=\s*["'](/?[^"'<>]+)["']""",
)
_SILENT = re.compile(rb"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?(?!xml[\s?]).*?\?>", re.DOTALL)
_ENCODING = re.compile(rb"""<\?xml[^>]*?\bencoding\s*=\s*["']([^"']*)["']""")
_EXPECTED = "a package with the model 3D/3dmodel.model expected"


class Package:
    """The parts of an archive by name, in any case. Errors: InputError for damaged or too large parts."""

    def __init__(self, data: bytes) -> None:
        self._left = self._limit = free_inflation(len(data))
        try:
            self._archive = zipfile.ZipFile(io.BytesIO(data))
            self._names = {name.lower().lstrip("/"): name for name in self._archive.namelist()}
        except (zipfile.BadZipFile, ValueError, OSError, NotImplementedError) as error:
            raise InputError(f"damaged ZIP archive found ({str(error)[:100]}); {_EXPECTED}") from None

    def root(self) -> str:
        """The name of the model that the package begins with."""
        if "_rels/.rels" in self._names and (target := _TARGET.search(self._read("_rels/.rels"))):
            name = target[1].decode("utf-8", "replace")
            if name.lower().lstrip("/") in self._names:
                return name
        name = next((name for name in self._names if name.endswith("3dmodel.model")), None)
        if name is None:
            raise InputError(f"a ZIP archive without a model found, {_EXPECTED}")
        return name

    def model(self, name: str) -> bytes:
        """The XML of a model, without comments.

        Errors: InputError for a part that does not exist, a document type, or another encoding than UTF-8.
        """
        data = self._read(name)
        encoding = _ENCODING.match(data.removeprefix(b"\xef\xbb\xbf"))
        if (encoding and encoding[1].lower() not in (b"utf-8", b"utf8", b"us-ascii", b"ascii")) or b"\0" in data[:64]:
            raise InputError("an encoding other than UTF-8 found, UTF-8 expected", place=name[:80])
        data = _SILENT.sub(b"", data) if b"<!" in data or data.count(b"<?") > 1 else data
        if b"<!" in data:
            raise InputError("a document type found, which 3MF forbids", place=name[:80])
        return data

    def _read(self, name: str) -> bytes:
        key = name.lower().lstrip("/")
        if key not in self._names:
            raise InputError(f"no part `{name[:80]}` found in the package")
        info = self._archive.getinfo(self._names[key])
        self._left -= info.file_size
        if self._left < 0:
            raise too_large(f"a package that inflates to more than {self._limit} bytes", self._limit)
        try:
            return self._archive.read(info)
        except (zipfile.BadZipFile, zlib.error, EOFError, OSError, RuntimeError, ValueError) as error:
            raise InputError(f"damaged or encrypted data found ({str(error)[:100]})", place=name[:80]) from None
        except Exception as error:  # lzma.LZMAError, and other errors of decompressors
            raise InputError(f"damaged data found ({str(error)[:100]})", place=name[:80]) from None
