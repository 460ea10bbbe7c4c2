"""Batch from its plan to its summary, on any engine."""

from __future__ import annotations

import glob
import hashlib
import os
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass

import msgspec

from .._version import __version__
from ..errors import FAILED_CHECK, INTERNAL, OK, OUTPUT
from ..support.words import escape_text
from .locations import hash_of, is_url, length_of, read_url
from .manifest import Manifest
from .model import STATISTICS, BatchItem, BatchSettings, Engine, Row
from .statistics import write_statistics
from .summary import write_summary

_WRITTEN = ("ok", "failed_checks")
_AGAIN = ("timeout", "crashed", "out_of_memory")


@dataclass
class Batch:
    """The meshes of a plan: `todo` after a resume, `work`, and once it is finished `rows` in the order of the plan.

    strict: a failed check gives exit code 1 to its mesh.
    """

    items: Sequence[BatchItem]
    settings: BatchSettings
    folder: str
    manifest: Manifest
    strict: bool = False

    def __post_init__(self) -> None:
        self._options = self.settings.digest()
        self._paths = {item.path: item for item in self.items}
        self._kept: dict[str, Row] = {}
        self.rows: list[Row] = []
        _sweep(self.items)

    def todo(self) -> list[BatchItem]:
        """Meshes that are not done, or changed, or whose outputs differ from those written."""
        with ThreadPoolExecutor() as pool:
            done = list(pool.map(self._done, self.items))
        for item, row in zip(self.items, done, strict=True):
            if row is not None:
                self._kept[item.path] = self._coded(row)
        return [item for item, row in zip(self.items, done, strict=True) if row is None]

    def work(self, engine: Engine, todo: Sequence[BatchItem]) -> Iterator[Row]:
        """Run the meshes; every row is on the disk before it is yielded."""
        for row in engine(todo, self.settings):
            row.options = self._options
            if self.settings.common:
                row.ranges_options = self.settings.ranges_digest()
            if row.status in _WRITTEN:
                names = self._shown(self._paths[row.path])
                row.outputs = [
                    msgspec.structs.replace(output, path=name) for name, output in zip(names, row.outputs, strict=True)
                ]
            row = self._coded(row)
            self.manifest.append(row)
            yield row

    def finish(self) -> None:
        """Write the summary of the ended meshes, and remove unfinished outputs; no worker may be running."""
        _sweep(self.items)
        ended = self._kept | self.manifest.added()
        self.rows = [ended[item.path] for item in self.items if item.path in ended]
        write_summary(self.folder, self.rows)
        if self.settings.long:
            write_statistics(self.folder, self.rows)
        else:
            _remove(os.path.join(self.folder, name) for name in STATISTICS)

    def _done(self, item: BatchItem) -> Row | None:
        """Row of an earlier run if nothing has changed; errors that may be temporary are tried again."""
        row = self.manifest.rows.get(item.path)
        if row is None or (row.options, row.version) != (self._options, __version__):
            return None
        if row.status in _AGAIN or row.exit_code in (OUTPUT, INTERNAL) or row.sha256 is None:
            return None
        if row.status in _WRITTEN and not self._whole(row, item):
            return None
        return row if row.sha256 == content_hash(item) else None

    def _whole(self, row: Row, item: BatchItem) -> bool:
        """True if every output is unchanged, byte for byte; lengths are compared first."""
        if [output.path for output in row.outputs] != self._shown(item):
            return False
        pairs = [(output, path) for output, (_, path) in zip(row.outputs, item.outputs, strict=True)]
        lengths = all(length_of(path) == output.bytes for output, path in pairs)
        return lengths and all(hash_of(path) == output.sha256 for output, path in pairs)

    def _coded(self, row: Row) -> Row:
        failed = FAILED_CHECK if self.strict else OK
        code = failed if row.status == "failed_checks" else row.exit_code
        return msgspec.structs.replace(row, exit_code=code)

    def _shown(self, item: BatchItem) -> list[str]:
        return [escape_text(os.path.relpath(path, self.folder)).replace(os.sep, "/") for _, path in item.outputs]


def content_hash(item: BatchItem) -> str | None:
    """SHA-256 of the content of a mesh, None if it cannot be read."""
    if item.content is not None:
        return hashlib.sha256(item.content).hexdigest()
    if is_url(item.place):
        with suppress(Exception):
            return hashlib.sha256(read_url(item.place, None)).hexdigest()
        return None
    return hash_of(item.place)


def _sweep(items: Sequence[BatchItem]) -> None:
    """Remove half-written outputs of a killed run; the lock on the manifest excludes other writers."""
    for folder in {os.path.dirname(path) for item in items for _, path in item.outputs}:
        _remove(glob.glob(os.path.join(glob.escape(folder), ".curvcli-*.part")))


def _remove(paths: Iterable[str]) -> None:
    for path in paths:
        with suppress(OSError):
            os.unlink(path)
