"""Differences between the output folders of two commits, and their kinds."""

from __future__ import annotations

import csv
import io
import json
import math
import re
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

# Seconds are the one thing that equal runs do not share: in JSON, JUnit, pages and summaries.
_TIMES = re.compile(rb'"timings":\s*\{[^}]*\}|"(?:seconds|memory_mb)":\s*[0-9.e+-]+|(?<= )time(?:stamp)?="[^"]*"')


@dataclass(frozen=True)
class Kind:
    """A known kind of difference: what `old` matches becomes `new`, and lines that `drop` matches go on both sides.

    case, file: patterns of `SUBJECT/COMMAND` and of a file's name (`.stdout`, `.stderr` and `.exit` among them).
    """

    name: str
    case: str = "*"
    file: str = "*"
    old: str | None = None
    new: str = ""
    drop: str | None = None

    def applies(self, case: str, file: str) -> bool:
        """Test whether the kind can occur there."""
        return fnmatch(case, self.case) and fnmatch(file, self.file)

    def rewritten(self, text: str, is_old: bool) -> str:
        """The text of one side without differences of this kind."""
        if self.drop is not None:
            text = "".join(line for line in text.splitlines(keepends=True) if not re.search(self.drop, line))
        if self.old is not None and is_old:
            text = re.sub(self.old, self.new, text, flags=re.MULTILINE)
        return text


@dataclass(frozen=True)
class Difference:
    """A file of one command that differs. kinds: the known kinds that explain it completely; empty if none do."""

    case: str
    file: str
    old: str
    new: str
    kinds: tuple[str, ...] = ()

    @property
    def signature(self) -> tuple[str, str]:
        """The words that differ, without numbers, paths and names: differences of one kind share them."""
        lines = [re.sub(r"/\S+|'[^']*'|[-+]?\d[\d.e+-]*", "#", line).split() for line in (self.old, self.new)]
        for _ in range(2):  # without the words that both share at the end, then at the beginning
            lines = [line[::-1] for line in lines]
            shared = next((i for i, (a, b) in enumerate(zip(*lines, strict=False)) if a != b), min(map(len, lines)))
            lines = [line[shared:] for line in lines]
        return " ".join(lines[0])[:200], " ".join(lines[1])[:200]


def known_kinds(path: str | Path) -> list[Kind]:
    """The kinds of a TOML file, one table `[[kind]]` each."""
    return [Kind(**table) for table in tomllib.loads(Path(path).read_text())["kind"]]


def between(old: Path, new: Path, kinds: Iterable[Kind] = ()) -> Iterator[Difference]:
    """Every file that differs, or that one side alone has."""
    kinds = list(kinds)
    files = {path.relative_to(root) for root in (old, new) for path in root.rglob("*") if path.is_file()}
    for path in sorted(files):
        parts = path.parts
        case, file = "/".join(parts[:2]), "/".join(parts[2:])
        if not ((old / path).exists() and (new / path).exists()):
            is_there = "missing", "there"
            first, second = is_there if (new / path).exists() else is_there[::-1]
            yield Difference(case, file, first, second)
            continue
        texts = [_TIMES.sub(b"", (root / path).read_bytes().replace(str(root).encode(), b"")) for root in (old, new)]
        if texts[0] != texts[1]:
            yield difference(case, file, *texts, kinds)


def difference(case: str, file: str, old: bytes, new: bytes, kinds: Iterable[Kind]) -> Difference:
    """The first difference of two contents that no known kind explains, or their first difference and all kinds."""
    before, after = (readable(data, file) for data in (old, new))
    plain = first_line(before, after, file)
    applied = []
    for kind in kinds:
        if kind.applies(case, file):
            changed = kind.rewritten(before, True), kind.rewritten(after, False)
            if changed != (before, after):
                applied.append(kind.name)
                before, after = changed
    if before == after and applied:
        return Difference(case, file, *plain, tuple(applied))
    return Difference(case, file, *first_line(before, after, file))


def readable(data: bytes, file: str) -> str:
    """Text with one value a line where the file is JSON."""
    text = data.decode("utf-8", "replace")
    if file.endswith((".json", ".sarif")) or text.startswith("{"):
        try:
            return json.dumps(json.loads(re.sub(r",\s*(?=[,}])|(?<={),", "", text)), indent=1, ensure_ascii=False)
        except ValueError:
            pass
    return text


def first_line(old: str, new: str, file: str) -> tuple[str, str]:
    """The first lines that differ; for tables the columns, with the largest difference."""
    if file.endswith((".csv", ".tsv")) and (columns := _columns(old, new, "\t" if file.endswith(".tsv") else ",")):
        return columns
    before, after = old.split("\n"), new.split("\n")
    for one, other in zip(before, after, strict=False):
        if one != other:
            return one[:400], other[:400]
    return f"{len(before)} lines", f"{len(after)} lines"


def _columns(old: str, new: str, separator: str) -> tuple[str, str] | None:
    """Columns of one side, and columns that differ: rows, and the largest difference over the largest value."""
    tables = [list(csv.DictReader(io.StringIO(text), delimiter=separator)) for text in (old, new)]
    if len(tables[0]) != len(tables[1]) or not tables[0]:
        return None
    before, after = (list(table[0]) for table in tables)
    lost, gained = sorted(set(before) - set(after)), sorted(set(after) - set(before))
    found = [_column(name, [(row[name], other[name]) for row, other in zip(*tables, strict=True)]) for name in before
             if name in after]  # fmt: skip
    changed = "; ".join(filter(None, found))[:400]
    if lost or gained:
        return f"columns lost: {', '.join(lost) or 'none'}; {changed}", f"columns new: {', '.join(gained) or 'none'}"
    return changed or "the same values", "" if before == after else "columns in another order"


def _column(name: str, pairs: list[tuple[str, str]]) -> str:
    """Difference of one column; empty without one."""
    unequal = [pair for pair in pairs if pair[0] != pair[1]]
    if not unequal:
        return ""
    size = max((abs(x) for value, _ in pairs if (x := _number(value)) is not None), default=0.0) or 1.0
    gaps = [(_number(value), _number(other)) for value, other in unequal]
    words = next((pair for pair, gap in zip(unequal, gaps, strict=True) if None in gap), None)
    largest = max((abs(a - b) for a, b in gaps if a is not None and b is not None), default=math.nan) / size
    return f"{name}: {len(unequal)} rows, {largest:.1e}" + (f", {words}" if words else "")


def _number(text: str) -> float | None:
    try:
        return float(text)
    except (TypeError, ValueError):
        return None
