"""Report of a map between two surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from .._version import __version__
from ..analysis.configuration import Configured, configured
from ..checks.base import Check
from ..errors import Notice
from ..support.arrays import or_none
from .model import Input, as_dict, input_of

if TYPE_CHECKING:
    from ..analysis.maps import SurfaceMap


class Range(msgspec.Struct):
    """Smallest and largest value of a column, null if it has none, and the number of nulls."""

    min: float | None
    max: float | None
    nulls: int


class Turned(msgspec.Struct):
    """Number of faces that keep the side of most of their patch, are turned over, or are neither: see `orientation`."""

    kept: int
    turned_over: int
    undefined: int


class Harmonic(msgspec.Struct):
    """The largest |∇_p E(f)| off the boundary, its vertex, and the bound on its rounding."""

    residual_max: float | None
    vertex: int | None
    rounding: float | None


class MapReport(msgspec.Struct):
    """The report of `curvcli compare --map`; what is undefined is null.

    seams: edges along which a texture is cut, null for a map to another mesh.
    """

    schema_version: int
    curvcli: str
    source: Input
    image: Input
    seams: int | None
    totals: dict[str, float | None]
    sigma_1: Range
    sigma_2: Range
    nonconformality: Range
    area_distortion: Range
    orientation: Turned
    harmonic: Harmonic
    checks: list[Check]
    warnings: list[Notice]
    configuration: Configured = msgspec.UNSET


def model(f: SurfaceMap) -> MapReport:
    """Build the report of a map."""
    residual, vertex, rounding = f.harmonic
    notices = [*f.source.notices, *f.image.notices, *f.notices]
    image = input_of(f.image.file, f.image.n_vertices, f.image.n_faces)
    if f.image_name is not None:
        image.path = f.image_name
    return MapReport(
        schema_version=1,
        curvcli=__version__,
        source=input_of(f.source.file, f.source_vertices, f.source.n_faces),
        image=image,
        seams=f.seams,
        totals={name: or_none(value) for name, value in f.totals.items()},
        sigma_1=_range(f.sigma_1),
        sigma_2=_range(f.sigma_2),
        nonconformality=_range(f.nonconformality),
        area_distortion=_range(f.area_distortion),
        orientation=_turned(f.orientation),
        harmonic=Harmonic(or_none(residual), vertex, or_none(rounding)),
        checks=f.checks,
        warnings=notices,
        configuration=configured(f.configuration),
    )


def build(f: SurfaceMap) -> dict[str, Any]:
    """Build the report of a map as plain Python values."""
    return as_dict(model(f))


def _turned(sign: np.typing.NDArray[np.float64]) -> Turned:
    return Turned(*(int(np.count_nonzero(mask)) for mask in (sign > 0, sign < 0, np.isnan(sign))))


def _range(values: np.typing.NDArray[np.float64]) -> Range:
    known = values[~np.isnan(values)]
    nulls = len(values) - len(known)
    return Range(float(known.min()), float(known.max()), nulls) if len(known) else Range(None, None, nulls)
