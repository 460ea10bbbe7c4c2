"""The outcome of `curvcli check` as workflow commands of GitHub Actions, which annotate the files of a change."""

from __future__ import annotations

import os

from ..printable import shown
from .check import CheckReport, sentence
from .check_text import summary

# A workflow command ends with its line; in properties the colon and the comma have a meaning too.
_DATA = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A"})
_PROPERTY = _DATA | str.maketrans({":": "%3A", ",": "%2C"})


def write_github(report: CheckReport) -> bytes:
    """One `::error` for each failure, and a line that sums up."""
    lines = []
    for mesh in report.meshes:
        for outcome in mesh.trouble:
            properties = {"title": f"curvcli {outcome.label}"}
            if mesh.path != "-":
                properties = {"file": os.path.normpath(mesh.path).replace(os.sep, "/"), **properties}
            named = ",".join(f"{key}={shown(value).translate(_PROPERTY)}" for key, value in properties.items())
            lines.append(f"::error {named}::{sentence(mesh, outcome).translate(_DATA)}")
    lines.append(f"curvcli: {summary(report)}")
    return ("\n".join(lines) + "\n").encode()
