"""Pages that add something name every field of its declaration."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest

from curvcli.checks.base import check
from curvcli.checks.requirements.base import requirement
from curvcli.curvatures.quantity import FlagNotice, Quantity
from curvcli.loading.registry import InputFormat, ParserOptions
from curvcli.output.registry import DocumentFormat, MeshFormat, OverlayFormat, TableFormat
from tests.docs.pages import text


def named(declaration: Any) -> set[str]:
    """Fields of a class, or keywords of a decorator."""
    if hasattr(declaration, "__dataclass_fields__"):
        return {field.name for field in fields(declaration)}
    if hasattr(declaration, "_fields"):
        return set(declaration._fields)
    return set(declaration.__kwdefaults__)


@pytest.mark.parametrize(
    ("page", "declaration"),
    [
        ("docs/add-a-pass.md", Quantity),
        ("docs/add-a-pass.md", FlagNotice),
        ("docs/add-a-format.md", InputFormat),
        ("docs/add-a-format.md", ParserOptions),
        *(("docs/add-an-output-format.md", each) for each in (TableFormat, MeshFormat, OverlayFormat, DocumentFormat)),
        ("docs/add-a-check.md", check),
        ("docs/add-a-check.md", requirement),
    ],
)
def test_a_page_names_every_field(page: str, declaration: Any) -> None:
    content = text(page)
    assert named(declaration)
    assert [
        name for name in sorted(named(declaration)) if f"`{name}`" not in content and f"`{name}=" not in content
    ] == []
