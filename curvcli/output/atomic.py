"""Outputs that appear whole or not at all: checked before any work, written beside their place, renamed at the end."""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import stat
import sys
import unicodedata
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from types import TracebackType
from typing import BinaryIO

from ..errors import OutputError

STDOUT = "-"
_STREAM_NAMES = {"/dev/stdout": 1, "/dev/stderr": 2}
_STREAM_FOLDERS = ("/dev/fd/", "/proc/self/fd/")
# What link() says where hard links are unknown or not allowed; everything else is a real failure.
_NO_HARD_LINKS = {errno.EPERM, errno.EACCES, errno.EOPNOTSUPP, errno.ENOTSUP, errno.ENOSYS, errno.EMLINK, errno.EXDEV}


def shown(path: str) -> str:
    """The path as it can stand in a one-line message: escaped where it is not printable text."""
    return path if path.isprintable() else ascii(path)


@dataclass
class _Target:
    """One output: the name given, the file it stands for, and its temporary while there is one."""

    path: str
    final: str
    direct: bool
    temporary: str | None = None
    complete: bool = False


class Outputs:
    """All outputs of one run: `with Outputs(paths, force=False) as outputs, outputs.open(path) as stream: ...`.

    Entering checks every path before any work is done. Each regular file is written to a temporary in its own folder;
    only when all are complete are they renamed, one after the other. Whatever goes wrong before, an interruption
    included, removes the temporaries and leaves older files as they were. `-` is stdout; devices and FIFOs are written
    directly, links are followed.

    A closed pipe (BrokenPipeError) passes through as it is; outputs complete by then are kept, so `-` is best written
    last. Errors: OutputError for a path that exists (without `force`), cannot be written, or is named twice.
    """

    def __init__(self, paths: Iterable[str | os.PathLike[str]], force: bool = False):
        self._paths = [os.fspath(path) for path in paths]
        self._force = force
        self._targets: dict[str, _Target] = {}

    def __enter__(self) -> Outputs:
        for path in self._paths:
            with _explained(path):
                self._add(path)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        try:
            if error is None or isinstance(error, BrokenPipeError):
                self.commit()
        finally:
            for target in self._targets.values():
                if target.temporary is not None:
                    with contextlib.suppress(OSError):
                        os.unlink(target.temporary)
                    target.temporary = None

    @contextlib.contextmanager
    def open(self, path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
        """The binary stream of one of the outputs; leaving the block without an error makes it complete."""
        target = self._targets[os.fspath(path)]
        if target.complete or target.temporary is not None:
            raise ValueError(f"{target.path}: written already")
        with _explained(target.path):
            if not target.direct:
                yield from self._write_beside(target)
            elif _stream_number(target.final) == 1:
                yield from _write_stdout()
            else:
                with open(target.final, "wb") as stream:
                    yield stream
        target.complete = True

    def commit(self) -> None:
        """Give every complete output its name; a file that appeared meanwhile is replaced only with `force`."""
        for target in self._targets.values():
            if target.complete and target.temporary is not None:
                with _explained(target.path):
                    self._name(target.temporary, target)
                target.temporary = None

    def _add(self, path: str) -> None:
        final, direct = _resolve(path)
        target = _Target(path, final, direct)
        for other in self._targets.values():
            if _same_file(target, other):
                both = shown(path) if path == other.path else f"{shown(other.path)} and {shown(path)}"
                raise OutputError(f"{both}: two outputs on one file; give each a name of its own")
        if not direct:
            if os.path.lexists(final) and not self._force:
                raise OutputError(f"{shown(path)}: exists already; --force overwrites it")
            if not os.path.isdir(os.path.dirname(final)):
                raise OutputError(f"{shown(path)}: there is no folder {shown(os.path.dirname(final))}; make it first")
            _probe(final)
        self._targets[path] = target

    def _write_beside(self, target: _Target) -> Iterator[BinaryIO]:
        # Noted before it is made, so that an interruption in between cannot leave it behind.
        target.temporary = _beside(target.final)
        descriptor = os.open(target.temporary, os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
        with open(descriptor, "w+b") as stream:
            with contextlib.suppress(OSError):
                os.chmod(target.temporary, stat.S_IMODE(os.stat(target.final).st_mode) & 0o777)
            yield stream
            stream.flush()
            os.fsync(descriptor)

    def _name(self, temporary: str, target: _Target) -> None:
        if self._force:
            os.replace(temporary, target.final)
            return
        try:
            # link() fails where rename() would silently replace what another program wrote meanwhile.
            os.link(temporary, target.final)
        except FileExistsError:
            raise OutputError(f"{shown(target.path)}: appeared while it was computed; --force overwrites it") from None
        except OSError as error:
            if error.errno not in _NO_HARD_LINKS:
                raise
            if os.path.lexists(target.final):
                raise OutputError(
                    f"{shown(target.path)}: appeared while it was computed; --force overwrites it"
                ) from None
            os.replace(temporary, target.final)
        else:
            os.unlink(temporary)


@contextlib.contextmanager
def _explained(path: str) -> Iterator[None]:
    """Turn the system's refusal into one line that names the output; a closed pipe is no refusal."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise OutputError(f"{'stdout' if path == STDOUT else shown(path)}: cannot be written: {reason}") from error


def _resolve(path: str) -> tuple[str, bool]:
    """The file behind a name, and whether it is written directly: a stream, a device or a FIFO."""
    if path == STDOUT:
        return "/dev/stdout", True
    if not path or "\0" in path:
        raise OutputError(f"{path!r}: not a file name")
    if _stream_number(path) is not None:
        return path, True
    final = os.path.realpath(path)
    try:
        mode = os.stat(path).st_mode
    except FileNotFoundError:
        if path.endswith(("/", os.sep)):
            raise OutputError(f"{shown(path)}: names a folder; give a file name") from None
        return final, False
    if stat.S_ISDIR(mode):
        raise OutputError(f"{shown(path)}: is a folder; give a file name in it")
    return final, not stat.S_ISREG(mode)


def _stream_number(path: str) -> int | None:
    """The descriptor behind /dev/stdout, /dev/fd/N and their like, which must not be replaced by a file."""
    plain = os.path.normpath(path)
    for folder in _STREAM_FOLDERS:
        if plain.startswith(folder) and plain.removeprefix(folder).isdecimal():
            return int(plain.removeprefix(folder))
    return _STREAM_NAMES.get(plain)


def _beside(final: str) -> str:
    """A fresh hidden name in the same folder; short, so that a longest possible file name still has room for it."""
    return os.path.join(os.path.dirname(final), f".curvcli-{secrets.token_hex(8)}.part")


def _probe(final: str) -> None:
    """Make and remove a file in the folder: the one test of writability that holds for every user and file system."""
    probe = _beside(final)
    try:
        os.close(os.open(probe, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
    finally:
        with contextlib.suppress(OSError):
            os.unlink(probe)


def _same_file(one: _Target, two: _Target) -> bool:
    """Whether two names end at one file: equal, linked, or alike but for case where the file system ignores it."""
    if one.direct or two.direct:
        streams = _stream_number(one.final), _stream_number(two.final)
        if streams[0] is not None or streams[1] is not None:
            return streams[0] == streams[1]
        # Everything may be poured into /dev/null, which keeps nothing.
        return one.final == two.final and one.final != os.devnull
    if one.final == two.final:
        return True
    with contextlib.suppress(OSError):
        if os.path.samefile(one.final, two.final):
            return True
    return _folded(one.final) == _folded(two.final) and _ignores_case(os.path.dirname(one.final))


def _folded(path: str) -> str:
    return unicodedata.normalize("NFC", path).casefold()


def _ignores_case(folder: str) -> bool:
    probe = _beside(os.path.join(folder, "x"))
    try:
        os.close(os.open(probe, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        return os.path.exists(os.path.join(folder, os.path.basename(probe).upper()))
    finally:
        with contextlib.suppress(OSError):
            os.unlink(probe)


def _write_stdout() -> Iterator[BinaryIO]:
    if sys.stdout is None:
        raise OutputError("stdout: is closed")
    sys.stdout.flush()
    yield sys.stdout.buffer
    # Here, not at the end of the program, where a closed pipe or a full disk could no longer be told.
    sys.stdout.buffer.flush()
