"""Cases: surfaces under triangulations of several kinds, with noise."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.validation.surfaces import SURFACES, Make, Mesh, of_sample

# Squares eight times as long as wide; vertices on a cylinder, joined so that area and normals are wrong.
TRIANGULATIONS: dict[str, dict[str, Make]] = {
    **SURFACES,
    "torus": SURFACES["torus"] | {"anisotropic": of_sample("torus", aspect=8.0)},
    "cylinder": {
        "regular": of_sample("cylinder"),
        "anisotropic": of_sample("cylinder", aspect=8.0),
        "Schwarz lantern": of_sample("schwarz_lantern", folding=0.05),
    },
}
SIZES, QUICK_SIZES = (1000, 10_000, 100_000, 1_000_000), (1000, 4000)
NOISE, QUICK_NOISE = (0.0, 1e-4, 1e-3, 1e-2), (0.0, 1e-3)


@dataclass(frozen=True)
class Case:
    """A surface, how it is triangulated, the size asked for, and noise as a part of its largest extent."""

    surface: str
    triangulation: str
    size: int
    noise: float

    def mesh(self) -> Mesh:
        """The mesh; exact values stay those of the smooth surface at the vertices before they moved."""
        made = TRIANGULATIONS[self.surface][self.triangulation](self.size)
        if not self.noise:
            return made
        deviation = self.noise * float(np.ptp(made.points, axis=0).max())
        moved = np.random.default_rng(self.size).normal(scale=deviation, size=made.points.shape)
        return replace(made, points=made.points + moved)


def cases(sizes: Sequence[int], noise: Sequence[float], surfaces: Sequence[str]) -> Iterator[Case]:
    """Every surface in all of its triangulations; noise at the size nearest to 10,000 only, sizes without it."""
    middle = min(sizes, key=lambda size: abs(np.log(size / 1e4)))
    for surface in surfaces or TRIANGULATIONS:
        for triangulation in TRIANGULATIONS[surface]:
            yield from (Case(surface, triangulation, size, 0.0) for size in sizes)
            yield from (Case(surface, triangulation, middle, part) for part in noise if part)
