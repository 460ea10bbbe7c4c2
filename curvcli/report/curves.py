"""Report of curves as JSON: a row per curve, the identities along them, and notices."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import msgspec
import numpy as np

from .._version import __version__
from ..analysis.configuration import Configured
from ..checks.base import Check
from ..curves.identities import Identity
from ..curves.measure import CurveMeasures
from ..errors import Notice
from ..mesh.file import Labels
from ..support.arrays import or_none
from .model import Input, input_of, vector

NullableVector = list[float | None] | None

# Up to this many curves, identities are listed curve by curve; beyond, one line each and those that fail.
LISTED_CURVES = 100


class CurveRow(msgspec.Struct):
    """One curve; what is undefined is null. Angles in radians, writhe in turns, lengths in the file's unit.

    kind: `boundary` (the surface on its left) or `polyline`. unknotted: true where the total curvature, at most 4π,
    proves that the curve is no knot if it does not cross itself; null proves nothing. tangent_change: T(q) − T(p).
    signed_total and turning_number: of plane closed curves. holonomy ≡ 2π · writhe (mod 2π). Boundary curves only:
    component, sum_kappa_g, sum_kappa_n, force Σ η|e|, torque Σ m × η|e|, twist of the surface along the curve, and
    linking, how often the curve links itself pushed off along ν. writhe_error and linking_error bound the rounding
    errors, in turns: writhe and linking are null where theirs exceeds ¼.
    """

    curve: int
    kind: str
    component: int | None
    closed: bool
    vertices: int
    length: float | None
    total_curvature: float | None
    total_sin2: float | None
    total_tan2: float | None
    unknotted: bool | None
    plane: bool
    signed_total: float | None
    turning_number: int | None
    total_torsion: float | None
    tangent_change: NullableVector
    vector_area: NullableVector
    holonomy: float | None
    writhe: float | None
    writhe_error: float | None
    sum_kappa_g: float | None
    sum_kappa_n: float | None
    twist: float | None
    linking: int | None
    linking_error: float | None
    force: NullableVector
    torque: NullableVector
    repeated_points: int


class LinkRow(msgspec.Struct):
    """Pair of closed curves and their linking number; null where they touch or the double sum was refused."""

    a: int
    b: int
    linking: int | None
    linking_error: float | None


class CurveReport(msgspec.Struct):
    """The report of `curvcli curves`.

    links: of up to 100 closed curves every pair; of more, those whose boxes meet: all others have linking number 0.
    """

    schema_version: int
    curvcli: str
    input: Input
    conventions: dict[str, str | int | None]
    curves: list[CurveRow]
    links: list[LinkRow]
    checks: list[Check]
    warnings: list[Notice]
    configuration: Configured = msgspec.UNSET


def model(measures: CurveMeasures, *, weld: str = "none", unit: str | None = None) -> CurveReport:
    """Build the report of a set of curves."""
    file = measures.curve_set.file
    return CurveReport(
        schema_version=1,
        curvcli=__version__,
        input=input_of(file, file.xyz.shape[1] if file else 0, 0),
        conventions={"weld": weld, "unit": unit, "max_writhe": measures.max_writhe},
        curves=rows(measures),
        links=[LinkRow(*row) for row in zip(*map(_values, measures.links_table().values()), strict=True)],
        checks=[row for identity in measures.identities for row in _checks(identity)],
        warnings=measures.notices,
    )


def rows(measures: CurveMeasures) -> list[CurveRow]:
    """One row per curve."""
    columns = {key: _values(column) for key, column in measures.totals.items()}
    for stem in ("tangent_change", "vector_area", "force", "torque"):
        columns[stem] = [vector(each) for each in zip(*(columns[f"{stem}_{axis}"] for axis in "xyz"), strict=True)]
    ordered = [columns[key] for key in CurveRow.__struct_fields__]
    return [CurveRow(*row) for row in zip(*ordered, strict=True)]


def _values(column: Any) -> list[Any]:
    """Column as plain values, None where undefined."""
    if isinstance(column, Labels):
        return [column.names[code] for code in column.codes.tolist()]
    if column.dtype.kind != "f":
        listed: list[Any] = column.tolist()
        return listed
    return [or_none(value) for value in column.tolist()]


def _checks(identity: Identity) -> list[Check]:
    """One row per curve, or of very many curves those that fail and one for the rest."""
    passed = identity.residual <= identity.tolerance  # NaN fails
    reason = np.full(len(passed), -1)
    for number, (mask, _) in enumerate(identity.excluded):
        reason[mask & (reason < 0)] = number
    selected = np.arange(len(passed))
    if len(passed) > LISTED_CURVES:
        selected = np.flatnonzero(~passed & (reason < 0))
    listed = [_check(identity, int(c), bool(passed[c]), int(reason[c])) for c in selected]
    if len(passed) > LISTED_CURVES and not listed:
        listed = [_summary(identity, reason)]
    return listed


def _check(identity: Identity, curve: int, passed: bool, reason: int) -> Check:
    scope = f"curve {curve}"
    if reason >= 0:
        return Check(identity.name, scope, "not_applicable", None, None, None, None, identity.excluded[reason][1])
    value, expected, residual, tolerance = (
        or_none(float(side[curve]))
        for side in (identity.value, identity.expected, identity.residual, identity.tolerance)
    )
    status = "pass" if passed else "fail"
    return Check(identity.name, scope, status, value, expected, residual, tolerance, identity.detail)


def _summary(identity: Identity, reason: np.ndarray[Any, Any]) -> Check:
    tested = np.flatnonzero(reason < 0)
    if not len(tested):
        why = identity.excluded[int(reason[0])][1]
        return Check(identity.name, "curves", "not_applicable", None, None, None, None, why)
    closest = int(tested[(identity.residual / identity.tolerance)[tested].argmax()])
    row = _check(identity, closest, True, -1)
    detail = f"{len(tested):,} of {len(reason):,} curves pass, the others are not applicable; {row.scope} is closest"
    return replace(row, scope="curves", detail=detail)
