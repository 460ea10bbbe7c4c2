"""Outputs of `analyze` that show all meshes of a run: histograms whose name has no `{stem}`."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..output.registry import DocumentFormat, format_of

if TYPE_CHECKING:
    from ..analysis.result import Result
    from ..output.appearance import Appearance
    from ..output.atomic import Outputs
    from ..output.distributions import MeshSamples


class SharedOutputs:
    """Pictures and tables of the histograms of several meshes, collected mesh by mesh and written at the end.

    The columns of the histograms and their areas stay in memory, nothing else of a mesh does.
    Errors: UsageError for more meshes than have colours of their own.
    """

    def __init__(self, meshes: Sequence[str], outputs: Sequence[str], tables: Sequence[tuple[str, str]]) -> None:
        from ..output.pictures.histogram import MOST_MESHES

        several = len(meshes) > 1
        self.pictures = [path for path in outputs if several and _is_shared(path)]
        self.tables = [path for kind, path in tables if several and kind == "histogram" and _has_no_stem(path)]
        names = [os.path.basename(mesh) for mesh in meshes]
        twice = Counter(names)
        self.names = [mesh if twice[name] > 1 else name for mesh, name in zip(meshes, names, strict=True)]
        self._collected: list[MeshSamples] = []
        if self.pictures and len(meshes) > MOST_MESHES:
            raise UsageError(
                f"{self.pictures[0]}: {len(meshes)} meshes in one picture, which has {MOST_MESHES} colours; put "
                "{stem} into its name for a picture of each, or use --table histogram=PATH"
            )

    @property
    def paths(self) -> list[str]:
        """Paths of all outputs."""
        return [*self.pictures, *self.tables]

    def collect(self, analysis: Result, appearance: Appearance, number: int) -> None:
        """Keep the columns of one mesh."""
        from ..output.distributions import samples_of

        if self.paths:
            self._collected.append(samples_of(analysis, appearance, self.names[number]))

    def write(self, outputs: Outputs, appearance: Appearance) -> list[str]:
        """Write the outputs, unless no mesh could be read; a line for each column of a picture, with its range."""
        from ..output.distributions import several
        from ..output.tables.histogram import histogram_table
        from ..output.tables.write import write_table

        if not self._collected:
            return []
        samples, lines = several(self._collected), []
        for path in self.pictures:
            output_format = format_of(path)
            assert isinstance(output_format, DocumentFormat)
            assert output_format.several is not None
            with outputs.open(path) as stream:
                lines += [f"{path}: {line}" for line in output_format.several(stream, samples, appearance)]
        for path in self.tables:
            with outputs.open(path) as stream:
                suffix = format_of(path, kinds=["table"]).suffix
                write_table(stream, histogram_table(samples, appearance), suffix, precision=appearance.precision)
        return lines


def _has_no_stem(path: str) -> bool:
    return path != "-" and "{stem}" not in path


def _is_shared(path: str) -> bool:
    if not _has_no_stem(path):
        return False
    output_format = format_of(path)
    return isinstance(output_format, DocumentFormat) and output_format.several is not None
