"""The layout of the package: few entries at the top, imports without a cycle, libraries in their places."""

from __future__ import annotations

import ast
import re
from collections import Counter
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "curvcli"
NAMED = (ast.Name, ast.Attribute)

# Third-party packages that only some folders import.
PLACES = {
    "rich": ("report/terminal", "commands"),
    "click": ("commands", "__main__.py"),
    "polars": ("loading", "output", "batch/summary.py", "analysis/columns.py"),
    "trimesh": ("loading", "output/meshes/glb.py", "mesh/exports.py"),
}


def module_of(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


SOURCES = {module_of(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def imports(module: str) -> set[str]:
    """Modules that a module names in an import, at its top, within functions or for annotations."""
    path = SOURCES[module]
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            source = ".".join([*above, *([node.module] if node.module else [])])
            found |= {f"{source}.{name.name}" if f"{source}.{name.name}" in SOURCES else source for name in node.names}
    return found


def test_imports_have_no_cycle() -> None:
    """`static_order` raises CycleError with the modules of a cycle."""
    graph = {module: {name for name in imports(module) if name in SOURCES and name != module} for module in SOURCES}
    for module in graph:
        # A package that its own modules import things from would be loaded before them.
        graph[module] = {name for name in graph[module] if not module.startswith(f"{name}.")}
    assert len(list(TopologicalSorter(graph).static_order())) == len(SOURCES)


def test_the_top_has_few_entries() -> None:
    rooms = {path.name for path in PACKAGE.iterdir() if not path.name.startswith("_")} - {"py.typed"}
    assert len(rooms) <= 15, rooms


@pytest.mark.parametrize("library", PLACES)
def test_a_library_has_its_place(library: str) -> None:
    users = {
        SOURCES[module].relative_to(PACKAGE).as_posix()
        for module in SOURCES
        if any(name == library or name.startswith(f"{library}.") for name in imports(module))
    }
    assert users
    assert not [user for user in users if not user.startswith(PLACES[library])]


def names_in(path: Path) -> set[str]:
    """Every name and attribute in a module."""
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    return {node.attr if isinstance(node, ast.Attribute) else node.id for node in nodes if isinstance(node, NAMED)}


def test_commands_print_by_one_function() -> None:
    """`talk` writes to stdout and stderr; `main` ends a line of the terminal and prints the help of no arguments."""
    commands = (PACKAGE / "commands").rglob("*.py")
    assert {path.name for path in commands if "echo" in names_in(path)} == {"talk.py", "main.py"}


def test_one_cache() -> None:
    """Beside `cached_property`: of objects in `support/cache`, of bounded size for neighbourhoods."""
    users = {path.relative_to(PACKAGE).as_posix() for path in SOURCES.values() if "WeakKeyDictionary" in names_in(path)}
    assert users == {"support/cache.py", "mesh/neighbourhoods.py"}
    assert not [module for module, path in SOURCES.items() if "lru_cache" in names_in(path)]


def classes_in(path: Path) -> list[str]:
    """Classes of a module and the types it gives a name to, without leading underscores."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    assigned = [node for node in body if isinstance(node, ast.Assign) and not is_type_variable(node.value)]
    types = [name.id for node in assigned for name in node.targets if isinstance(name, ast.Name)]
    names = [node.name for node in body if isinstance(node, ast.ClassDef)] + [name for name in types if is_type(name)]
    return [name.lstrip("_") for name in names]


def is_type(name: str) -> bool:
    return re.match("_?[A-Z][a-z]", name) is not None


def is_type_variable(value: ast.expr) -> bool:
    return isinstance(value, ast.Call) and "TypeVar" in ast.unparse(value.func)


def test_a_class_name_stands_once() -> None:
    count = Counter(name for path in SOURCES.values() for name in classes_in(path))
    assert [name for name, number in count.items() if number > 1] == []
    assert count["Report"] == 1
