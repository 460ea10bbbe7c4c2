"""Delaunay's surfaces of revolution with constant mean curvature."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .curvature import facing, principal, revolved
from .facts import orientable
from .grids import revolve, split
from .model import Sample, demand, demand_positive


@sample(
    summary="an unduloid: a wavy tube of constant mean curvature, bulge to bulge",
    exact="H = 2/(neck + bulge) everywhere, kappas (1 +- neck bulge/r^2)/(neck + bulge); total curvature 0.",
)
def unduloid(*, size: int = 1500, neck: float = 0.4, bulge: float = 1.0, periods: int = 2) -> Sample:
    """Its smallest and largest radius; with both equal, a cylinder."""
    demand_positive(neck=neck)
    return _delaunay(size, neck, bulge, periods)


@sample(
    summary="a nodoid: a tube of constant mean curvature that loops through itself",
    exact="H = 2/(bulge - neck) everywhere, kappas (1 +- neck bulge/r^2)/(bulge - neck); total curvature 0.",
)
def nodoid(*, size: int = 1500, neck: float = 0.4, bulge: float = 1.0, periods: int = 1) -> Sample:
    """Its smallest and largest radius; immersed, not embedded."""
    demand_positive(neck=neck)
    demand(neck < bulge, f"neck must be less than bulge {bulge!r}, not {neck!r}")
    return _delaunay(size, -neck, bulge, periods)


def _delaunay(size: int, neck: float, bulge: float, periods: int) -> Sample:
    """From bulge to bulge; a negative neck makes the nodoid.

    r = bulge sqrt(1 - m sin^2 t), z = neck F(t|m) + bulge E(t|m), m = 1 - (neck/bulge)^2; arc length (neck + bulge) t.
    """
    from scipy.special import ellipe, ellipeinc, ellipkinc

    demand_positive(size=size, bulge=bulge, periods=periods)
    demand(abs(neck) <= bulge, f"neck must be at most bulge {bulge!r}, not {neck!r}")
    modulus = 1 - (neck / bulge) ** 2
    pace, turns = neck + bulge, math.pi * periods
    area = 4 * math.pi * bulge * pace * periods * float(ellipe(modulus))
    rows, columns = split(size, (pace * turns) ** 2 / area, least=2)
    t = np.linspace(0, turns, max(rows, 8 * periods + 1))
    radius = bulge * np.sqrt(1 - modulus * np.sin(t) ** 2)
    height = neck * ellipkinc(t, modulus) + bulge * ellipeinc(t, modulus)
    points, faces, row = revolve(radius, height, max(columns, 3))
    ratio = neck * bulge / radius[row] ** 2
    mean = 2 / pace
    # The profile's slopes (r', z') over its pace, at which it is run through.
    inward = np.sin(t) * np.cos(t) * modulus * bulge / np.sqrt(1 - modulus * np.sin(t) ** 2)
    along = (ratio + 1) * radius[row]
    exact = facing(principal((1 + ratio) / pace, (1 - ratio) / pace), revolved(points, along, inward[row]))
    exact |= {"h": np.full(len(row), abs(mean)), "h_signed": np.full(len(row), mean)}
    limit = {"area": area, "K": 0.0, "kappa_g": 0.0, "H_theta": mean * area, "willmore": mean**2 * area}
    return Sample(points, faces, exact, orientable(loops=2), limit)
