"""Contract of every run, for any content of the file."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import math
import shutil
import signal
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from unittest import mock

import jsonschema  # type: ignore[import-untyped]

from curvcli.commands.main import main
from tests.fuzz.cases import Case
from tests.fuzz.light import content, counts, topology


@dataclass(frozen=True)
class Ran:
    """Exit code and output of a run."""

    code: int
    out: bytes
    err: str


def in_process(words: list[str]) -> Ran:
    """Run curvcli here, from its entry point on."""
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True) for _ in range(2))
    argv = mock.patch.object(sys, "argv", ["curvcli", *words])
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    with argv, contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main()
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else -1
        finally:
            for number, handler in handlers.items():
                signal.signal(number, handler)
    return Ran(code, out.buffer.getvalue(), err.buffer.getvalue().decode())


def arguments(case: Case, folder: Path) -> list[str]:
    """Write the file into an empty folder; the words after `curvcli`. Outputs go to the folder `out` beside it."""
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "out").mkdir(parents=True)
    (folder / case.name).write_bytes(case.data)
    words = [case.command, str(folder / case.name), *case.options]
    for option, name in case.outputs:
        path = str(folder / "out" / name)
        words += [option, path if option == "-o" else f"{Path(name).stem}={path}"]
    return words if case.outputs else [*words, "--json"]


def kept(case: Case, folder: Path, run: Any = in_process) -> str:
    """Run a case and hold it against the contract; `read` or `refused`.

    Errors: AssertionError.
    """
    ran: Ran = run(arguments(case, folder))
    written = sorted(path.name for path in (folder / "out").iterdir())
    assert "Traceback" not in ran.err, ran.err
    if ran.code == 2 and "--regions" in case.options:
        assert "--regions" in ran.err
        ran = Ran(3, ran.out, ran.err.replace("curvcli: ", f"curvcli: {folder / case.name}: "))
    assert ran.code in (0, 1, 3), (ran.code, ran.err)
    if ran.code == 3:
        assert ran.err.startswith(f"curvcli: {folder / case.name}: "), ran.err
        assert ran.err.endswith("\n"), ran.err
        assert ran.err[:-1].isprintable(), ran.err
        assert len(ran.err) < 600 + len(str(folder)), ran.err
        assert (ran.out, written) == (b"", [])
        assert case.meant is None or _may_be_refused(case), ran.err
        return "refused"
    assert ran.err == ""
    assert written == sorted(name for _, name in case.outputs)
    report = _strict_json(ran.out) if not case.outputs else None
    if case.command == "curves":
        _finite_table(folder / "out" / "out.csv", None)
        return "read"
    if (folder / "out" / "out.json").exists():
        report = _strict_json((folder / "out" / "out.json").read_bytes())
    faces = _finite_table(folder / "out" / "faces.csv", None)
    if report is not None:
        _holds(case, report, ran.code)
        if faces is not None:
            found = topology((int(row["a"]), int(row["b"]), int(row["c"])) for row in faces)
            assert {key: report["topology"][key] for key in found} == found
    kind = report["input"]["format"] if report is not None else None
    rows = counts(content(case.data), kind)[0] if kind else None
    for name in ("out.csv", "out.tsv"):
        _finite_table(folder / "out" / name, rows)
    for name in ("edges.csv", "loops.csv", "components.csv"):
        _finite_table(folder / "out" / name, None)
    return "read"


def _may_be_refused(case: Case) -> bool:
    """A whole file is refused only for a limit, for having nothing but faces with repeated corners, or no curves."""
    assert case.meant is not None
    limited = any(option.startswith("--max") for option in case.options) or "--regions" in case.options
    welded = any(w in ("--weld", "1e-3") for w in case.options) or case.name.endswith("stl")
    flat = all(len(set(polygon)) < len(polygon) for polygon in case.meant.polygons)
    return limited or welded or flat or case.command == "curves"


def _strict_json(text: bytes) -> Any:
    def refuse(word: str) -> None:
        raise AssertionError(f"{word} in the JSON")

    return json.loads(text, parse_constant=refuse)


@cache
def _validator() -> Any:
    return jsonschema.Draft202012Validator(json.loads(in_process(["analyze", "--schema"]).out))


def _holds(case: Case, report: dict[str, Any], code: int) -> None:
    """The report is valid, agrees with itself and with a plain reading of the file, and raises no false alarm."""
    if len(case.data) % 5 == 0:
        _validator().validate(report)
    failed = [check for check in report["checks"] if check["status"] == "fail"]
    assert not failed, failed
    assert code == 0
    top, given = report["topology"], report["input"]
    assert top["euler_characteristic"] == top["vertices"] - top["edges"] + top["faces"]
    assert sum(piece["topology"]["faces"] for piece in report["components"]) == top["faces"] > 0
    assert sum(piece["topology"]["edges"] for piece in report["components"]) == top["edges"]
    merged = sum(warning["count"] for warning in report["warnings"] if warning["code"] == "welded_vertices")
    assert top["vertices"] + top["unreferenced_vertices"] + merged == given["vertices"]
    vertices, polygons = counts(content(case.data), given["format"])
    short = sum(warning["count"] for warning in report["warnings"] if warning["code"] == "short_faces")
    assert vertices in (None, given["vertices"])
    assert polygons is None or given["polygons"] == polygons - (short if given["format"] == "ply" else 0)


def _finite_table(path: Path, rows: int | None) -> list[dict[str, str]] | None:
    """The rows of a table, all of the same width, with nothing in them that is no finite number."""
    if not path.exists():
        return None
    text = path.read_bytes().decode()
    assert text.endswith("\n")
    found = list(csv.DictReader(io.StringIO(text), delimiter="\t" if path.suffix == ".tsv" else ",", strict=True))
    assert rows in (None, len(found))
    for row in found:
        assert None not in row
        assert None not in row.values()
        for cell in row.values():
            with contextlib.suppress(ValueError):
                assert math.isfinite(float(cell)), (path.name, row)
    return found
