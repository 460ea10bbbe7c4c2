"""The public names: one list in docs/python.md, equal to what the modules export and to what the page documents."""

from __future__ import annotations

import importlib
import re

import pytest

from tests.docs.pages import text

PAGE = text("docs/python.md")
ROW = re.compile(r"^\| `(curvcli[\w.]*)` \| (.*) \|$", re.MULTILINE)
PUBLIC = {module: tuple(re.findall(r"`(\w+)`", names)) for module, names in ROW.findall(PAGE)}


@pytest.mark.parametrize("module", PUBLIC)
def test_every_public_name_can_be_imported(module: str) -> None:
    loaded = importlib.import_module(module)
    assert [name for name in PUBLIC[module] if not hasattr(loaded, name)] == []


@pytest.mark.parametrize("module", ["curvcli", "curvcli.declare", "curvcli.curves", "curvcli.samples"])
def test_modules_export_the_public_names(module: str) -> None:
    assert set(importlib.import_module(module).__all__) == set(PUBLIC[module])


def test_every_class_of_errors_is_public() -> None:
    errors = importlib.import_module("curvcli.errors")
    classes = {
        name for name, value in vars(errors).items() if isinstance(value, type) and value.__module__ == errors.__name__
    }
    assert classes == set(PUBLIC["curvcli.errors"])


def test_the_page_documents_public_names_and_no_others() -> None:
    """A directive names an object, or a module with its members. Three names and the aliases of arrays have prose."""
    documented = set()
    for path, options in re.findall(r"^::: ([\w.]+)\n((?: +.*\n)*)", PAGE, re.MULTILINE):
        members = re.search(r"members: \[([^\]]*)\]", options)
        if path in PUBLIC:
            assert members, path
            documented |= {(path, name.strip()) for name in members[1].split(",")}
        else:
            documented.add(tuple(path.rsplit(".", 1)))
    in_prose = {("curvcli", name) for name in ("passes", "errors", "__version__")}
    in_prose |= {("curvcli.declare", name) for name in ("Column", "VectorColumn", "Counts", "Flags", "Codes")}
    assert documented | in_prose == {(module, name) for module, names in PUBLIC.items() for name in names}
    for _, name in in_prose:
        assert f"`{name}`" in PAGE


def test_compatibility_refers_to_the_list() -> None:
    page = text("docs/compatibility.md")
    assert "(python.md#public-names)" in page
    named = set(re.findall(r"`(curvcli\.[\w.]+)`", page)) - {"curvcli.passes"}  # the group of entry points
    assert named <= set(PUBLIC)
