"""Pages of the documentation generated from the code, by `python -m docs.pages docs`."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from curvcli.report.advice import markdown as advice
from curvcli.report.quantities import page as quantities

from .checks import page as checks
from .command_line import page as command_line
from .keys import page as schemas
from .suffixes import hook, inputs, outputs
from .tables import page_part as columns

# Whole pages by their name in docs/.
PAGES: dict[str, Callable[[], str]] = {
    "quantities.md": quantities,
    "checks.md": checks,
    "command-line.md": command_line,
    "schemas.md": schemas,
}

# Parts of pages: what stands between `<!-- made: NAME -->` and `<!-- end -->`.
PARTS: dict[str, Callable[[], str]] = {
    "inputs": inputs,
    "outputs": outputs,
    "columns": columns,
    "advice": advice,
}

# Beside docs/.
HOOKS = ".pre-commit-hooks.yaml"

_PART = re.compile(r"(<!-- made: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def current(name: str, text: str) -> str:
    """A page generated from the code, or `text` with its generated parts replaced."""
    if name == HOOKS:
        return hook(text)
    if name in PAGES:
        return PAGES[name]()
    return _PART.sub(lambda found: f"{found[1]}{PARTS[found[2]]()}{found[3]}", text)


def renew(folder: Path) -> list[str]:
    """Generate the pages of a folder; return the names of changed pages."""
    changed = []
    for path in sorted({*folder.glob("**/*.md"), *(folder / name for name in PAGES), folder.parent / HOOKS}):
        text = path.read_text(encoding="utf-8") if path.exists() else ""
        new = current(HOOKS if path.name == HOOKS else path.relative_to(folder).as_posix(), text)
        if new != text:
            path.write_text(new, encoding="utf-8")
            changed.append(str(path))
    return changed
