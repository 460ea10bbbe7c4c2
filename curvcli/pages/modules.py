"""The modules of the package with the first sentence of each."""

from __future__ import annotations

import ast
from pathlib import Path

_PACKAGE = Path(__file__).parent.parent


def page_part() -> str:
    """Modules and folders of the package as a table."""
    rows = []
    for path in sorted(_PACKAGE.iterdir()):
        source = path / "__init__.py" if path.is_dir() else path
        if source.suffix != ".py" or not source.exists() or path.name in ("__init__.py", "_version.py"):
            continue
        told = ast.get_docstring(ast.parse(source.read_text(encoding="utf-8"))) or ""
        first = " ".join(told.split("\n\n")[0].split())
        rows.append(f"| `{path.name}{'/' if path.is_dir() else ''}` | {first.replace('|', chr(92) + '|')} |")
    return "\n".join(["| module | what it is |", "|---|---|", *rows]) + "\n"
