"""Locations of meshes: local paths, and URLs that fsspec lists and reads."""

from __future__ import annotations

import hashlib
import io
import os
import re
import stat
import sys
from typing import Any, cast
from urllib.parse import unquote, urlsplit

from ..errors import InputError, MissingExtraError, NoMatchError, UsageError
from ..loading.content import open_regular, read_limited, read_stream
from ..support.words import escape_text
from .walk import files_of, is_wild, spellings

_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+://")
_NOT_FOUND = 404


def is_url(place: str) -> bool:
    """True if fsspec must read it."""
    return bool(_SCHEME.match(place))


def absolute(path: str) -> str:
    """Absolute path.

    Errors: InputError for a relative path if the working folder has been removed.
    """
    try:
        return os.path.abspath(path)
    except OSError as error:
        raise InputError(
            f"the working folder was removed ({error.strerror})", path=escape_text(path), hint="name the whole path"
        ) from None


def local(place: str) -> str:
    """Path of a `file://` or `local://` URL; other text is unchanged."""
    if not place.lower().startswith(("file://", "local://")):
        return place
    from urllib.request import url2pathname

    return url2pathname(urlsplit(place).path)


def root_of(pattern: str) -> tuple[str, ...]:
    """Folder down to the first wildcard, as parts; outputs mirror the tree below it."""
    folders = parts_of(pattern)[:-1]
    if os.path.lexists(pattern):
        return folders
    return folders[: next((place for place, part in enumerate(folders) if is_wild(part)), len(folders))]


def parts_of(place: str) -> tuple[str, ...]:
    """Parts of an absolute path or URL, each usable as the name of a folder."""
    if is_url(place):
        url = urlsplit(place)
        segments = (url.scheme, url.netloc, *unquote(url.path).split("/"))
        return tuple(escape_text(part).replace(os.sep, "_") for part in segments if part not in ("", ".", ".."))
    drive, rest = os.path.splitdrive(absolute(place))
    return (drive.strip(":\\/").replace("\\", "_"), *(part for part in rest.split(os.sep) if part))


def expand(pattern: str) -> list[str]:
    """Files that match a pattern, sorted: one of exactly that name, or all that match.

    Errors: NoMatchError without a match; InputError for a URL that cannot be listed, UsageError for an unknown kind of
    URL, MissingExtraError without the package that reads it.
    """
    paths = _expand_url(pattern) if is_url(pattern) else _expand_path(pattern)
    if not paths:
        hint = f"; {pattern.rstrip(os.sep)}/**/* names the files in this folder" if os.path.isdir(pattern) else ""
        raise NoMatchError(f"{escape_text(pattern)}: no file matches{hint}")
    return paths


def _expand_path(pattern: str) -> list[str]:
    if os.path.lexists(pattern):
        return [] if os.path.isdir(pattern) else [pattern]
    return files_of(pattern)


def _expand_url(pattern: str) -> list[str]:
    if not re.search(r"[*[]", pattern):  # a question mark begins a query
        return [pattern]
    files, path = _file_system(pattern)
    try:
        # Listings over HTTP have no types: a name that ends in a slash is a folder.
        folder, slash, last = path.rpartition("/")
        paths = [f"{folder}{slash}{spelling}" for spelling in spellings(last)]
        names = {str(name) for spelt in paths for name in files.glob(spelt)}
        files_found = [name for name in names if not name.endswith("/")]
        return sorted(str(files.unstrip_protocol(name)) for name in files_found if _is_file(files, name))
    except Exception as error:
        raise InputError(f"cannot be listed ({_reason(error)})", path=escape_text(pattern)) from error


def _is_file(files: Any, name: str) -> bool:
    return "http" in files.protocol or bool(files.isfile(name))


def read_url(place: str, max_bytes: int | None) -> bytes:
    """Bytes behind a URL.

    Errors: InputError for a URL that cannot be read, MissingExtraError without the package that reads it.
    """
    files, path = _file_system(place)
    try:
        with files.open(path, "rb") as stream:
            return read_limited(stream, max_bytes)
    except InputError:
        raise
    except Exception as error:
        # fsspec raises FileNotFoundError for a silent server too; the cause distinguishes them.
        if isinstance(error, FileNotFoundError):
            cause = error.__cause__
            if cause is None or isinstance(cause, FileNotFoundError) or getattr(cause, "status", None) == _NOT_FOUND:
                raise InputError("no such file") from None
            raise InputError(f"the file cannot be read ({_reason(cause)})") from None
        raise InputError(f"the file cannot be read ({_reason(error)})") from None


def _file_system(place: str) -> tuple[Any, str]:
    if "::" in place:
        raise UsageError(f"{escape_text(place)}: URLs within URLs are not read; unpack the archive first")
    try:
        from fsspec.core import url_to_fs

        opened: tuple[Any, str] = url_to_fs(place)
    except ImportError as error:
        install = "pip install 'curvcli[remote]'"
        raise MissingExtraError(f"{escape_text(place)}: {_reason(error)}; `{install}` reads http and s3") from None
    except Exception as error:
        raise UsageError(f"{escape_text(place)}: {_reason(error)}") from None
    return opened


def _reason(error: BaseException) -> str:
    return escape_text(" ".join((str(error) or type(error).__name__).split()))


def listed(source: str) -> list[str]:
    """Names in a list, one per line or, as from `find -print0`, ended by zero bytes; `-` is stdin.

    Errors: InputError for a list that cannot be read.
    """
    if source == "-":
        text = read_stream(sys.stdin.buffer)
    else:
        try:
            with open(source, "rb") as stream:
                text = stream.read()
        except OSError as error:
            reason = error.strerror or str(error)
            raise InputError(f"the list cannot be read ({reason})", path=escape_text(source)) from None
    names = text.split(b"\0") if b"\0" in text else text.splitlines()
    return [os.fsdecode(name) for name in names if name.strip()]


def length_of(path: str) -> int | None:
    """Length of a regular file in bytes, None without one."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    return status.st_size if stat.S_ISREG(status.st_mode) else None


def hash_of(path: str) -> str | None:
    """SHA-256 of a regular file, None without a readable one."""
    try:
        with open_regular(path, None) as file:
            return hashlib.file_digest(cast("io.BufferedReader", file), "sha256").hexdigest()
    except (InputError, OSError, MemoryError):
        return None
