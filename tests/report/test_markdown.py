"""The report for pull requests."""

from __future__ import annotations

from dataclasses import replace
from html import escape
from pathlib import Path

import pytest
from markdown_it import MarkdownIt

import curvcli
from curvcli.api import Analysis
from curvcli.report.build import model
from curvcli.report.markdown import markdown
from curvcli.report.phrases import shell_quoted, verdict
from tests.helpers.meshes import Mesh, grid, of_sample
from tests.output.html.pages import HOSTILE, labelled


def tables(text: str) -> list[list[list[str]]]:
    """Every table as rows of cells; a pipe that is escaped belongs to its cell."""
    found: list[list[list[str]]] = []
    before = ""
    for line in text.splitlines():
        if line.startswith("|"):
            cells = [cell.strip() for cell in line.replace("\\|", "\0").strip("|").split("|")]
            if not before.startswith("|"):
                found.append([])
            found[-1].append([cell.replace("\0", "|") for cell in cells])
        before = line
    return found


def written(mesh: Mesh, passes: str = "core") -> tuple[Analysis, str]:
    analysis = curvcli.analyze(tuple(mesh), passes)
    return analysis, markdown(model(analysis), "curvcli analyze x.obj -o x.md")


@pytest.mark.parametrize("name", ["torus", "mobius", "book", "two_components"])
def test_the_verdict_the_checks_and_the_totals(name: str) -> None:
    analysis, text = written(of_sample(name), "paper")
    report = model(analysis)
    assert text.splitlines()[2].startswith(f"**pass** · {verdict(report)} · ")
    checks, topology, totals = tables(text)
    assert all(len({len(row) for row in table}) == 1 for table in (checks, topology, totals))
    shown = {row[1].strip("`"): row for row in checks[2:]}
    whole = {row.name: row for row in report.checks if row.scope == "whole"}
    assert shown.keys() == whole.keys()
    for key, row in whole.items():
        assert shown[key][0] == {"pass": "holds", "not_applicable": "does not apply"}[row.status]
        if row.status == "pass":
            assert float(shown[key][3]) == pytest.approx(row.residual, rel=5e-3)
            assert float(shown[key][4]) == pytest.approx(row.tolerance, rel=5e-3)
    assert dict(zip(topology[0], topology[2], strict=True))["χ"] == str(report.topology.euler_characteristic)
    assert [row[0].strip("`") for row in totals[2:]] == list(report.totals)
    for notice in analysis.notices:
        assert f"* **{notice.code}**: {notice.count:,} " in text
    assert text.rstrip().endswith("</sub>")
    assert "```sh\ncurvcli analyze x.obj -o x.md\n```" in text
    assert len(text) < 8000


def test_what_fails_comes_first() -> None:
    analysis = curvcli.analyze(tuple(of_sample("torus")))
    report = model(analysis)
    report.checks[3] = replace(report.checks[3], status="fail")
    text = markdown(report)
    assert text.splitlines()[2].startswith("**FAIL** · 1 identity fails, ")
    (checks, *_) = tables(text)
    assert checks[2][:2] == ["**fails**", f"`{report.checks[3].name}`"]
    assert "do not trust the columns they sum" in text
    assert "```" not in text


def test_names_from_the_file_are_text(tmp_path: Path) -> None:
    path = labelled(grid(), tmp_path / "a|b `c` <img src=x> @me #1.obj", HOSTILE)
    report = model(curvcli.analyze(str(path), regions="groups"))
    k = next(k for k, check in enumerate(report.checks) if check.scope.startswith("region"))
    report.checks[k] = replace(report.checks[k], status="fail", detail=HOSTILE)
    text = markdown(report, "curvcli analyze '```' x")
    assert text.splitlines()[0] == f"### curvcli: `` {path} ``"
    assert "````sh\ncurvcli analyze '```' x\n````" in text
    assert all(len({len(row) for row in table}) == 1 for table in tables(text))
    reader = MarkdownIt("commonmark").enable("table")
    every = [token for block in reader.parse(text) for token in (block, *(block.children or ()))]
    raw = {token.content.strip() for token in every if token.type in ("html_inline", "html_block")}
    folded = "<details><summary>Totals and conventions</summary>"
    assert raw <= {"<!-- -->", folded, "</details>", "<sub>", "</sub>"} | {t for t in raw if t.startswith("<sub>")}
    assert not [token for token in every if token.type in ("link_open", "image")]
    rendered = reader.render(text)
    assert f"<h3>curvcli: <code>{escape(str(path), quote=False)}</code></h3>" in rendered
    assert escape(HOSTILE) in rendered.replace("&quot;", '"').replace('"', "&quot;").replace("'", "&#x27;")


def test_a_command_reads_back_in_a_shell() -> None:
    import subprocess

    words = ["printf", "%s|", "a b", "it's", "tab\tand\nline", "back\\slash\n", "π", "$HOME", "", "\udcff"]
    line = shell_quoted(words)
    assert "\n" not in line
    done = subprocess.run(["bash", "-c", line], capture_output=True, check=True)
    expected = "".join(f"{word}|" for word in words[2:]).encode("utf-8", "surrogateescape")
    assert done.stdout == expected
