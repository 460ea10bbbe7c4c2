"""Reports in JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO

from ..registry import DocumentFormat, register

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ..appearance import Appearance


def write(stream: BinaryIO, analysis: Result, appearance: Appearance, command: str | None) -> list[str]:
    """Write the model of the report."""
    from ...report.build import model
    from ...report.model import encode

    stream.write(encode(model(analysis)))
    return []


register(DocumentFormat(suffix=".json", kind="report", description="report, JSON", place=1, write=write))
