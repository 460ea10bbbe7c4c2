"""Hook of mkdocs: generate pages from the installed code, plug-ins included."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent.parent))

from docs.pages import current


def on_page_read_source(page: Any, config: Any) -> str:
    """The text of a page before Markdown is read."""
    path = Path(page.file.abs_src_path)
    return current(page.file.src_uri, path.read_text(encoding="utf-8"))
