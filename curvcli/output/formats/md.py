"""Reports for pull requests, in Markdown."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO

from ..registry import DocumentFormat, register

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ..appearance import Appearance


def write(stream: BinaryIO, analysis: Result, appearance: Appearance, command: str | None) -> list[str]:
    """Write the report in UTF-8."""
    from ...report.build import model
    from ...report.markdown import markdown

    stream.write(markdown(model(analysis), command).encode("utf-8"))
    return []


register(
    DocumentFormat(suffix=".md", kind="page", description="report for pull requests, Markdown", place=2, write=write)
)
