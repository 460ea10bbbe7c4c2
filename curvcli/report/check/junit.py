"""Outcome of `curvcli check` as JUnit XML: a suite per mesh, a case per check."""

from __future__ import annotations

from io import BytesIO

import msgspec
from junitparser import Attr, Error, Failure, JUnitXml, Skipped, TestCase, TestSuite

from ...support.words import escape_text
from .model import ERROR, FAIL, NOT_APPLICABLE, CheckedMesh, CheckReport, Outcome, sentence


class Case(TestCase):
    """Test case with a file attribute, which GitLab and others show."""

    file = Attr()


def write_junit(report: CheckReport) -> bytes:
    """Write JUnit XML; checks that do not apply are skipped, a mesh that cannot be read is an error."""
    document = JUnitXml("curvcli check")
    for mesh in report.meshes:
        suite = TestSuite(escape_text(mesh.path))
        if not isinstance(report.configuration, msgspec.UnsetType):
            suite.add_property("curvcli.configuration", report.configuration.file)
            suite.add_property("curvcli.configuration.sets", report.configuration.settings)
        suite.add_testcases([_case(mesh, outcome) for outcome in mesh.outcomes])
        document.add_testsuite(suite)
    document.update_statistics()  # type: ignore[no-untyped-call]
    stream = BytesIO()
    document.write(stream, pretty=True)
    return stream.getvalue()


def _case(mesh: CheckedMesh, outcome: Outcome) -> Case:
    case = Case(escape_text(outcome.label), f"curvcli.{outcome.kind}")
    case.file = escape_text(mesh.path)
    kinds = {FAIL: Failure, ERROR: Error, NOT_APPLICABLE: Skipped}
    if outcome.status in kinds:
        result = kinds[outcome.status](escape_text(outcome.message), outcome.kind)
        result.text = sentence(mesh, outcome)
        case.result = [result]
    else:
        case.system_out = escape_text(outcome.message)
    return case
