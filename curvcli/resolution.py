"""Notices of columns whose scale is not that of the question: stars where a scale is asked for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from .declare import AT_SCALE, Quantity, passes
from .errors import Notice
from .settings import Scale

# Columns of stars name themselves after what they are; estimates after the curvature alone.
_STAR_ALONE = ("_density", "_signed")


def counterparts(quantity: Quantity) -> list[str]:
    """Estimates at a scale of the same curvature as a column of stars: `h_ring`, `h_corrected`, … for `h_signed`."""
    if passes.depends_on_scale(quantity.name) or quantity.on != "vertex":
        return []
    stem = quantity.name
    for ending in _STAR_ALONE:
        stem = stem.removesuffix(ending)
    alike = quantity.kind, quantity.length_exponent, quantity.vector
    return [
        other.name
        for other in passes.quantities("vertex")
        if other.name.startswith(f"{stem}_")
        and passes.depends_on_scale(other.name)
        and (other.kind, other.length_exponent, other.vector) == alike
    ]


def unscaled(chosen: Iterable[str], scales: tuple[Scale, ...]) -> Iterator[Notice]:
    """The notice of chosen columns to which the scale that was asked for does not apply, though others have one.

    A column beside which one of its estimates is chosen is meant as it is.
    """
    plain = {name.partition(AT_SCALE)[0] for name in chosen}
    found = {name: counterparts(passes.quantity(name)) for name in sorted(plain)} if scales else {}
    missed = {name: others for name, others in found.items() if others and plain.isdisjoint(others)}
    if missed:
        best = [
            next((other for other in others if other.endswith("_corrected")), others[0]) for others in missed.values()
        ]
        at = ", ".join(str(scale) for scale in scales)
        yield Notice.of(
            "not_at_scale",
            [],
            f"[column|columns] of single stars, not at the scale asked for ({at}): {', '.join(missed)}",
            f"-p {','.join(best)} [is|are] at that scale",
            len(missed),
        )
