"""Fresh processes, taken in turn, so that whatever else the machine does falls on all of them alike."""

from __future__ import annotations

import json
import os
import random
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Table

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CONSOLE = Console(highlight=False)
if not CONSOLE.is_terminal:
    CONSOLE.width = 120

# A case that needs longer than this is reported as failed.
LIMIT_SECONDS = 300.0

Measured = dict[str, float]


@dataclass(frozen=True)
class Case:
    """A command to be timed. environment: variables set for it, beside the present ones.

    outputs: files that it makes; they are removed before, and what earlier commands wrote is on the disk by then, so
    that nobody pays for the files of another.
    """

    command: Sequence[str]
    environment: Mapping[str, str] = field(default_factory=dict)
    outputs: Sequence[str] = ()


@dataclass
class Results:
    """Measurements of each case in each round, and the reasons of cases that could not run."""

    rounds: dict[str, list[Measured]]
    failures: dict[str, str]

    def median(self, name: str, key: str = "seconds") -> float | None:
        """Median over the rounds; None for a case that failed or does not measure this."""
        values = [measured[key] for measured in self.rounds.get(name, []) if key in measured]
        return statistics.median(values) if values else None

    def ratio(self, name: str, to: str, key: str = "seconds") -> float | None:
        """Median over the rounds of the quotient of two cases of the same round."""
        pairs = zip(self.rounds.get(name, []), self.rounds.get(to, []), strict=False)
        quotients = [one[key] / other[key] for one, other in pairs if key in one and other.get(key)]
        return statistics.median(quotients) if quotients else None


def python(*arguments: str) -> list[str]:
    """A command of this interpreter."""
    return [sys.executable, *arguments]


def run(case: Case) -> Measured | str:
    """Run a case in a process of its own: `wall` and whatever it prints as JSON on its last line, or why it failed."""
    paths = [ROOT, os.environ.get("PYTHONPATH", "")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths)), **case.environment}
    for output in case.outputs:
        Path(output).unlink(missing_ok=True)
    if case.outputs and hasattr(os, "sync"):
        os.sync()
    begin = time.perf_counter()
    try:
        done = subprocess.run(case.command, capture_output=True, text=True, timeout=LIMIT_SECONDS, env=environment)
    except subprocess.TimeoutExpired:
        return f"longer than {LIMIT_SECONDS:.0f} s"
    wall = time.perf_counter() - begin
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        return said[-1][:200]
    last = (done.stdout.strip().splitlines() or [""])[-1]
    told: Measured = json.loads(last) if last.startswith("{") else {}
    return {"wall": wall, **told}


def interleaved(cases: Mapping[str, Case], repeats: int, what: str, warm_up: bool = False) -> Results:
    """Run the cases one after the other, round after round; a case that fails is not tried again.

    Every round has another order, the same in every run: who comes after a case that has just given back much memory
    touches it faster, and that must not always be the same one.
    """
    results = Results({name: [] for name in cases}, {})
    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    progress = Progress(*columns, console=Console(stderr=True), transient=True)
    with progress:
        task = progress.add_task(what)
        for round_ in range(-1 if warm_up else 0, repeats):
            for name, case in random.Random(round_).sample(list(cases.items()), len(cases)):
                if name in results.failures:
                    continue
                progress.update(task, description=f"{what}: round {round_ + 1} of {repeats}, {name}")
                measured = run(case)
                if isinstance(measured, str):
                    results.failures[name] = measured
                elif round_ >= 0:
                    results.rounds[name].append(measured)
    return results


def report(measured: Mapping[str, object]) -> None:
    """Print the measurement of a case, from its process, and exit."""
    sys.stdout.flush()
    print("\n" + json.dumps(measured), flush=True)
    os._exit(0)  # what a library does when it is torn down is not part of the measurement


Column = tuple[str, Callable[[str], str]]


def show(title: str, results: Results, columns: Sequence[Column]) -> None:
    """Print a table with a row for each case that ran, and the reasons of the others."""
    table = Table(title=escape(title), title_justify="left", pad_edge=False)
    table.add_column("")
    for header, _ in columns:
        table.add_column(header, justify="right")
    for name in results.rounds:
        if name not in results.failures:
            table.add_row(escape(name), *(cell(name) for _, cell in columns))
    CONSOLE.print(table)
    for name, reason in results.failures.items():
        CONSOLE.print(f"[yellow]{escape(name)} could not run:[/yellow] {escape(reason)}")
    CONSOLE.print()


def seconds(value: float | None) -> str:
    """A time for a table."""
    return "" if value is None else f"{value:.3f} s"


def times(value: float | None) -> str:
    """A ratio for a table."""
    return "" if value is None else f"{value:.2f} ×"
