"""Outcome of `curvcli check` as a Code Quality report, which GitLab shows beside a merge request."""

from __future__ import annotations

import os
from typing import Any

import msgspec

from ...support.words import escape_text
from .model import ERROR, CheckedMesh, CheckReport, Outcome, fingerprint, sentence


def write_gitlab(report: CheckReport) -> bytes:
    """Write a list of the failures, each at the first line of its file; a mesh that cannot be read is a blocker."""
    entries = [_entry(mesh, outcome) for mesh in report.meshes for outcome in mesh.trouble]
    return msgspec.json.format(msgspec.json.encode(entries)) + b"\n"


def _entry(mesh: CheckedMesh, outcome: Outcome) -> dict[str, Any]:
    return {
        "description": sentence(mesh, outcome),
        "check_name": escape_text(outcome.name),
        "fingerprint": fingerprint(mesh, outcome),
        "severity": "blocker" if outcome.status == ERROR else "major",
        "location": {"path": escape_text(os.path.normpath(mesh.path)), "lines": {"begin": 1}},
    }
