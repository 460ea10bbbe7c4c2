"""Results of `curvcli check` as data: one outcome per mesh and check; every format is written from it."""

from __future__ import annotations

import hashlib

import msgspec

from ..._version import __version__
from ...analysis.configuration import Configuration, Configured, configured
from ...errors import Notice
from ...support.arrays import Value
from ...support.words import escape_text
from ..model import encode

# Values of `kind` and `status`.
IDENTITY, REQUIREMENT, ASSERTION, INPUT = "identity", "requirement", "assertion", "input"
PASS, FAIL, NOT_APPLICABLE, ERROR = "pass", "fail", "not_applicable", "error"


class FaultPlace(msgspec.Struct):
    """An element at fault: `vertex 5`, `edge 2-7` or `face 3`, and a point of it in the unit of the file."""

    element: str
    position: list[float | None]


class Outcome(msgspec.Struct):
    """One check on one scope of one mesh.

    kind: `identity`, `requirement`, `assertion`, or `input` for a mesh that could not be checked. status: `pass`,
    `fail`, `not_applicable` or `error`. message: the meaning of a pass, the cause of a failure, or the reason
    for neither. value, expected, residual, tolerance: of identities, as in the report of analyze; of assertions the
    statistic and the number it is compared with. elements: number of elements at fault, as far as they are known.
    places: the first of them.
    """

    name: str
    kind: str
    scope: str
    status: str
    message: str
    value: Value = None
    expected: Value = None
    residual: float | None = None
    tolerance: float | None = None
    elements: int = 0
    places: list[FaultPlace] = []

    @property
    def label(self) -> str:
        """Name, with the scope if that is not the whole mesh."""
        return self.name if self.scope == "whole" else f"{self.name} ({self.scope})"


class CheckedMesh(msgspec.Struct):
    """One mesh with its outcomes; without sha256 and conventions where it could not be read."""

    path: str
    sha256: str | None
    status: str
    exit_code: int
    conventions: dict[str, str | None] | None
    outcomes: list[Outcome]
    warnings: list[Notice]

    def count(self, status: str) -> int:
        """Number of outcomes of a status."""
        return sum(outcome.status == status for outcome in self.outcomes)

    @property
    def trouble(self) -> list[Outcome]:
        """Outcomes that failed or could not be computed."""
        return [outcome for outcome in self.outcomes if outcome.status in (FAIL, ERROR)]


class Rule(msgspec.Struct):
    """One check of every mesh: its name, its kind, and the meaning of a pass."""

    name: str
    kind: str
    statement: str


class CheckReport(msgspec.Struct):
    """All meshes of one call."""

    schema_version: int
    curvcli: str
    rules: list[Rule]
    meshes: list[CheckedMesh]
    exit_code: int
    configuration: Configured = msgspec.UNSET


def report_of(
    rules: list[Rule], meshes: list[CheckedMesh], exit_code: int, configuration: Configuration | None = None
) -> CheckReport:
    """Build the report of one call."""
    return CheckReport(1, __version__, rules, meshes, exit_code, configured(configuration))


def failed_input(path: str, message: str, exit_code: int) -> CheckedMesh:
    """Result for a mesh that could not be checked."""
    outcome = Outcome("input", INPUT, "whole", ERROR, escape_text(message))
    return CheckedMesh(path, None, ERROR, exit_code, None, [outcome], [])


def sentence(mesh: CheckedMesh, outcome: Outcome) -> str:
    """One outcome in one line."""
    on = "" if outcome.scope == "whole" else f" on {outcome.scope}"
    match outcome.status:
        case "error":
            said = outcome.message
        case "fail":
            said = f"{outcome.name} fails{on}: {outcome.message}"
        case "not_applicable":
            said = f"{outcome.name} does not apply{on}: {outcome.message}"
        case _:
            said = f"{outcome.name} passes{on}: {outcome.message}"
    return f"{escape_text(mesh.path)}: {escape_text(said)}"


def fingerprint(mesh: CheckedMesh, outcome: Outcome) -> str:
    """Name of a failure that stays the same from run to run: a hash of the path, the check and its scope."""
    identity = "\0".join((mesh.path, outcome.label)).encode("utf-8", "surrogateescape")
    return hashlib.sha256(identity).hexdigest()


def write_json(report: CheckReport) -> bytes:
    """Write the report as JSON; bytes of a path that are not text are escaped."""
    meshes = [msgspec.structs.replace(mesh, path=escape_text(mesh.path)) for mesh in report.meshes]
    return encode(msgspec.to_builtins(msgspec.structs.replace(report, meshes=meshes)))
