"""Outcome of `curvcli check` as workflow commands of GitHub Actions, which annotate the files of a change."""

from __future__ import annotations

import os

from ...analysis.configuration import sentence
from ...support.words import escape_text
from ..terminal.check import summary
from .lines import all_failures, warning, warnings
from .model import CheckReport

# A workflow command ends at the end of its line; in properties, colon and comma are special too.
_DATA = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A"})
_PROPERTY = _DATA | str.maketrans({":": "%3A", ",": "%2C"})


def write_github(report: CheckReport) -> bytes:
    """Write an `::error` for each failure, the first of each check and a count of the others; a `::warning` for each
    warning that the text report shows; a `::notice` of a configuration file that the verdict depends on; a summary."""
    failed, others = all_failures(report.meshes)
    lines = [
        _command("error", f"curvcli {failure.outcome.label}", failure.text, failure.mesh.path) for failure in failed
    ]
    if others:
        lines.append(_command("error", "curvcli", others))
    shown_warnings, _ = warnings(report.meshes)
    lines += [
        _command("warning", f"curvcli {remark.code}", warning(mesh, remark), mesh.path)
        for mesh, remark in shown_warnings
    ]
    if configuration := sentence(report.configuration):
        lines.append(_command("notice", "curvcli configuration", configuration))
    lines.append(f"curvcli: {summary(report)}")
    return ("\n".join(lines) + "\n").encode()


def _command(kind: str, title: str, message: str, path: str = "-") -> str:
    """One workflow command, at a file unless the mesh is a stream."""
    properties = {"title": title}
    if path != "-":
        properties = {"file": os.path.normpath(path).replace(os.sep, "/"), **properties}
    named = ",".join(f"{key}={escape_text(value).translate(_PROPERTY)}" for key, value in properties.items())
    return f"::{kind} {named}::{message.translate(_DATA)}"
