"""Pictures of `curvcli batch` over all of its meshes: plots, and the common range of colours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .talk import say

if TYPE_CHECKING:
    from ..batch.batch import Batch
    from ..batch.model import BatchItem, BatchSettings, Engine, Row
    from ..batch.series import Plot


def with_common_ranges(
    items: Sequence[BatchItem], settings: BatchSettings, engine: Engine, known: dict[str, Row], quiet: bool
) -> BatchSettings:
    """Settings with the common range of every shown column, after a first pass over the meshes."""
    from ..batch import ranges
    from ..batch.batch import content_hash
    from .progress import phase

    with phase("choosing the common range", quiet):
        hashes = {item.path: content_hash(item) or "" for item in items if item.path in known}
        return ranges.with_common_ranges(items, settings, engine, known, hashes)


def planned_plots(texts: tuple[str, ...], folder: str, items: Sequence[BatchItem], long: bool) -> list[Plot]:
    """Plots of `--plot`. Errors: UsageError; MissingExtraError without the library that draws."""
    if not texts:
        return []
    from ..batch.series import parse_plots
    from ..curvatures.catalogue import load_passes
    from ..output.pictures.options import require_pictures

    require_pictures(surface=False)
    load_passes()
    return parse_plots(texts, folder, items, long)


def draw_plots(plots: list[Plot], batch: Batch) -> None:
    """Draw the plots of the ended meshes."""
    if plots and batch.rows:
        from ..batch.series import write_plots

        for line in write_plots(batch.folder, plots, batch.rows):
            say(line)
