"""The gallery: the page is what the script makes, and the pictures are small and look as they do now."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from tests.docs.pages import ROOT, text
from tests.helpers.images import decoded, difference_hash, opengl

__all__ = ["opengl"]


@pytest.fixture(scope="module")
def gallery() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_gallery", ROOT / "docs" / "make_gallery.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    import sys

    sys.modules["make_gallery"] = module
    spec.loader.exec_module(module)
    return module


def test_every_picture_is_there_and_small(gallery: ModuleType) -> None:
    wanted = {name for entry in gallery.ENTRIES for name in entry.pictures}
    assert {path.name for path in (ROOT / "docs" / "gallery").iterdir()} == wanted
    for name in wanted:
        assert (ROOT / "docs" / "gallery" / name).stat().st_size <= 150_000, name


def test_the_page_shows_the_commands(gallery: ModuleType) -> None:
    page = text("docs/gallery.md")
    for entry in gallery.ENTRIES:
        for command in entry.commands:
            assert f"\ncurvcli {command}\n" in page
        for name in entry.pictures:
            assert f"(gallery/{name})" in page


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("stem", ["torus", "book"])
def test_the_commands_still_make_the_picture(gallery: ModuleType, tmp_path: Path, stem: str) -> None:
    (entry,) = [entry for entry in gallery.ENTRIES if entry.stem == stem]
    gallery.make(tmp_path, entry)
    assert gallery.section(entry, gallery.totals(tmp_path, entry)) in text("docs/gallery.md")
    for name in entry.pictures:
        made, kept = (decoded((folder / name).read_bytes()) for folder in (tmp_path, ROOT / "docs" / "gallery"))
        assert made[0].shape == kept[0].shape
        assert made[1]["Description"] == kept[1]["Description"]
        assert np.mean(difference_hash(made[0]) != difference_hash(kept[0])) < 0.03
