"""Readers of stored reports."""

from __future__ import annotations

from typing import Any

import msgspec

from ...errors import InputError
from ...loading.content import open_regular, read_limited
from ..model import Report, as_dict

SCHEMA_VERSION = 1
_HINT = "`curvcli analyze MESH -o REPORT.json` writes one"


def read_report(path: str, *, max_bytes: int | None = None) -> dict[str, Any]:
    """Read a report of `curvcli analyze` as plain Python values.

    Errors: InputError for a file that is missing, no JSON, no report, or of an unknown schema_version.
    """
    try:
        with open_regular(path, max_bytes) as file:
            return decode(read_limited(file, max_bytes, "a report"))
    except InputError as error:
        error.path = path
        raise


def decode(data: bytes) -> dict[str, Any]:
    """Decode a report from its JSON text.

    Errors: InputError.
    """
    try:
        tree = msgspec.json.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"no JSON: {error}", hint=_HINT) from None
    if isinstance(tree, list):
        raise InputError(f"a list of {len(tree)} reports found, one report expected", hint=_HINT)
    if not isinstance(tree, dict) or not {"schema_version", "topology", "checks"} <= tree.keys():
        raise InputError("JSON, but no report of `curvcli analyze`", hint=_HINT)
    version = tree["schema_version"]
    if version != SCHEMA_VERSION:
        newer = isinstance(version, int) and not isinstance(version, bool) and version > SCHEMA_VERSION
        hint = "a newer curvcli wrote it; update curvcli, or write the report again" if newer else _HINT
        raise InputError(f"schema_version {version!r} found, {SCHEMA_VERSION} expected", hint=hint)
    try:
        return as_dict(msgspec.convert(tree, Report))
    except msgspec.ValidationError as error:
        raise InputError(f"a damaged report: {error}", hint=_HINT) from None
