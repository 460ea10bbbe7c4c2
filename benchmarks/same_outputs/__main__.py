"""`python -m benchmarks.same_outputs OLD NEW`: run every command at two commits and compare the bytes."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Sequence
from fnmatch import fnmatch
from pathlib import Path

import click

from ..harness import ROOT
from .commands import Case, of_mesh, of_samples, once
from .differences import Difference, between, known_kinds

SUFFIXES = (".obj", ".ply", ".stl", ".off", ".gz")
_ENVIRONMENT = {"OPENBLAS_NUM_THREADS": "1", "COLUMNS": "120", "NO_COLOR": "1"}


@click.command()
@click.argument("old")
@click.argument("new", default="HEAD")
@click.option("--meshes", "folders", type=click.Path(exists=True, file_okay=False), multiple=True,
              help="Folder of meshes; repeatable.")  # fmt: skip
@click.option("--samples", default="*", show_default=True, help="Names of samples to run, as a pattern; '' for none.")
@click.option("--only", default="*", show_default=True, help="Names of commands to run, as a pattern.")
@click.option("--known", type=click.Path(exists=True, dir_okay=False), help="TOML file of known kinds of differences.")
@click.option("--keep", type=click.Path(file_okay=False), help="Folder that keeps inputs and outputs.")
@click.option("--again", is_flag=True, help="Compare the outputs in --keep again, without a run.")
@click.option("--details", type=click.Path(dir_okay=False), help="File with a line for every difference.")
def main(
    old: str,
    new: str,
    folders: tuple[str, ...],
    samples: str,
    only: str,
    known: str | None,
    keep: str | None,
    again: bool,
    details: str | None,
) -> None:
    """Compare all outputs of two commits: files, stdout, stderr and exit codes, without seconds.

    Every command runs on all samples of OLD and on the meshes of the folders. Exits with 1 if a difference is of no
    known kind.
    """
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(keep or temporary).absolute()
        if not again:
            folder.mkdir(parents=True, exist_ok=True)
            run_both([old, new], folder, [str(Path(each).resolve()) for each in folders], samples, only)
        cases = sum(1 for _ in folder.joinpath("old").glob("*/*"))
        found = list(between(folder / "old", folder / "new", known_kinds(known) if known else ()))
    if details:
        Path(details).write_text("".join(f"{each}\n" for each in found))
    report(found, cases)
    sys.exit(any(not each.kinds for each in found))


def run_both(commits: Sequence[str], folder: Path, folders: list[str], samples: str, only: str) -> None:
    """Check both commits out beside each other, make the inputs at the first one, run all commands at both."""
    trees = [folder / "trees" / name for name in ("old", "new")]
    try:
        for commit, tree in zip(commits, trees, strict=True):
            _git("worktree", "add", "--detach", "--force", str(tree), commit)
        runner = shutil.copy(Path(__file__).with_name("run.py"), folder / "trees" / "run.py")
        meshes = _subjects(folders)
        names = _names(trees[0], samples)
        inputs = folder / "inputs"
        inputs.mkdir()
        _start(runner, trees[0], {"samples": names, "meshes": meshes}, inputs).wait()
        cases = [case for case in plan(names, meshes, folders, inputs) if fnmatch(case.name, only)]
        running = [
            _start(runner, tree, {"cases": cases}, folder / name)
            for tree, name in zip(trees, ("old", "new"), strict=True)
        ]
        failed = [process.wait() for process in running]
        if any(failed):
            raise click.ClickException(f"the runners ended with {failed}")
    finally:
        for tree in trees:
            _git("worktree", "remove", "--force", str(tree), check=False)


def plan(names: list[str], meshes: dict[str, str], folders: list[str], inputs: Path) -> list[Case]:
    """Every command line, in order."""
    cases = [*of_samples(names), *once(folders)]
    for subject, mesh in {**{name: str(inputs / f"{name}.ply") for name in names}, **meshes}.items():
        file = inputs / "moved" / f"{subject}.obj"
        moved, labels = (str(file), str(file.with_suffix(".txt"))) if file.exists() else (None, None)
        cases += of_mesh(subject, mesh, moved, labels)
    return cases


def report(found: list[Difference], cases: int) -> None:
    """Print the number of differences of each kind, known ones first, and one example of each."""
    counts = Counter(name for each in found for name in each.kinds)
    click.echo(
        f"{cases:,} command lines; {len(found):,} files differ, {sum(not each.kinds for each in found):,} of them"
    )
    click.echo("in no known way\n")
    for name, count in counts.most_common():
        click.echo(f"{count:6}  {name}")
    alike: dict[tuple[str, str], list[Difference]] = defaultdict(list)
    for each in found:
        if not each.kinds:
            alike[each.signature].append(each)
    for group in sorted(alike.values(), key=len, reverse=True):
        first = group[0]
        click.echo(f"\n{len(group):6}  {first.case} {first.file}\n        - {first.old}\n        + {first.new}")


def _subjects(folders: list[str]) -> dict[str, str]:
    """Paths of meshes by the name of the subject: the number of the folder and the path in it."""
    return {
        f"{number}-{'-'.join(path.relative_to(folder).parts)}": str(path)
        for number, folder in enumerate(folders)
        for path in sorted(Path(folder).rglob("*"))
        if path.suffix.lower() in SUFFIXES
    }


def _names(tree: Path, pattern: str) -> list[str]:
    listed = "from curvcli.samples.catalogue import names; print(*names())"
    done = subprocess.run(
        [sys.executable, "-P", "-c", listed], env=_environment(tree), capture_output=True, text=True, check=True
    )
    return [name for name in done.stdout.split() if fnmatch(name, pattern)]


def _start(runner: str | Path, tree: Path, work: dict[str, object], folder: Path) -> subprocess.Popen[bytes]:
    file = folder.with_suffix(".plan.json")
    file.write_text(json.dumps(work))
    return subprocess.Popen([sys.executable, "-P", str(runner), str(file), str(folder)], env=_environment(tree))


def _environment(tree: Path) -> dict[str, str]:
    seed = "0" if tree.name == "old" else "1"  # an order of a set that reaches an output is a difference
    return {**os.environ, **_ENVIRONMENT, "PYTHONPATH": str(tree), "PYTHONHASHSEED": seed}


def _git(*words: str, check: bool = True) -> None:
    subprocess.run(["git", *words], cwd=ROOT, check=check, capture_output=True)


if __name__ == "__main__":
    main()
