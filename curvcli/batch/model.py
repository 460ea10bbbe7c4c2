"""Data of a batch: an item (one mesh), the settings of its analysis, and the row of its result."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Literal

import msgspec

from .._version import __version__
from ..analysis.configuration import Configuration
from ..output.appearance import Appearance

# Files that the batch itself writes into its folder.
MANIFEST, CSV, PARQUET = "manifest.jsonl", "summary.csv", "summary.parquet"
STATISTICS = ("statistics.csv", "statistics.parquet")
OWN = (MANIFEST, CSV, PARQUET, *STATISTICS)

Status = Literal["ok", "failed_checks", "error", "timeout", "out_of_memory", "crashed"]


class BatchItem(msgspec.Struct, frozen=True):
    """One mesh of the plan.

    path: as given, fit for one line. place: an absolute path or a URL. outputs: pairs of a table's kind
    (empty for outputs of `analyze -o`) and an absolute path. content: bytes that no other process can read.
    """

    path: str
    place: str
    outputs: tuple[tuple[str, str], ...] = ()
    content: bytes | None = None


class BatchSettings(msgspec.Struct, frozen=True, kw_only=True):
    """Settings that determine the results and outputs of each mesh.

    options: fields of the `Request` by name; those that are not there have their defaults. long: whether rows have
    statistics. common: whether they have the ranges of colours. command: as typed; pages show it, and nothing else
    depends on it. configuration: the file that set some of this, as named in reports.
    """

    passes: tuple[str, ...]
    save: tuple[str, ...] = ()
    options: dict[str, Any] = {}
    input_format: str | None = None
    max_faces: int | None = None
    max_bytes: int | None = None
    appearance: Appearance = Appearance()
    long: bool = False
    common: bool = False
    command: str | None = None
    configuration: Configuration | None = None

    def ranges_digest(self) -> str:
        """Hash of the settings that the range of a single mesh follows from."""
        own = dataclasses.replace(self.appearance, ranges=())
        return msgspec.structs.replace(self, appearance=own).digest()

    def digest(self) -> str:
        """Hash by which a later run recognises the same settings; plug-ins count with their versions."""
        from importlib.metadata import entry_points

        plug_ins = [(entry.name, entry.dist and entry.dist.version) for entry in entry_points(group="curvcli.passes")]
        which = msgspec.to_builtins([msgspec.structs.replace(self, command=None, configuration=None), sorted(plug_ins)])
        return hashlib.sha256(json.dumps(which).encode("ascii")).hexdigest()  # not UTF-8, which some labels are not


class Limits(msgspec.Struct, frozen=True):
    """Limits for one mesh: seconds, and bytes beyond the program's own memory."""

    seconds: float | None = None
    memory: int | None = None


class Written(msgspec.Struct, frozen=True):
    """Completed output: its path below the folder of the batch, its length, its SHA-256."""

    path: str
    bytes: int
    sha256: str


class RowStatistics(msgspec.Struct):
    """Numbers of the whole surface or of one region of a mesh, by column and statistic."""

    region: str | None
    columns: dict[str, dict[str, int | float | None]]


class Row(msgspec.Struct, kw_only=True):
    """One line of the manifest: the result of one mesh. The summary leaves out values that differ from run to run.

    statistics: with --long, the whole and then each region. ranges: with --range common, the ends of the colours of
    each column of this mesh alone, and the hash of the options that they follow from.
    """

    path: str
    sha256: str | None = None
    options: str = ""
    version: str = __version__
    status: Status = "ok"
    exit_code: int = 0
    error: str | None = None
    seconds: float = 0.0
    memory: int | None = None
    outputs: list[Written] = []
    topology: dict[str, Any] = {}
    totals: dict[str, Any] = {}
    checks: dict[str, Any] = {}
    statistics: list[RowStatistics] = []
    ranges: dict[str, tuple[float, float]] = {}
    ranges_options: str = ""


Engine = Callable[[Sequence[BatchItem], BatchSettings], Iterator[Row]]
"""Function that runs items and yields their rows as they end."""
