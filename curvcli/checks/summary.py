"""Summary of a check over very many groups."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .base import Check, EvaluatedCheck


def summarise_checks(evaluated: EvaluatedCheck, scope: str) -> list[Check]:
    """Keep the failed checks of very many groups, or summarise all in one line where none fails."""
    applies = ~evaluated.excluded
    failed = np.flatnonzero(applies & ~evaluated.passed)
    if len(failed) or not len(applies):
        return [evaluated.check(group) for group in failed.tolist()]
    passed = np.flatnonzero(applies & evaluated.in_range)
    if not len(passed):
        return [Check(evaluated.name, scope, "not_applicable", None, None, None, None, evaluated.check(0).detail)]
    residual, tolerance = (side[passed] for side in evaluated.shown[2:])
    strain = np.divide(residual, tolerance, out=np.zeros(len(passed)), where=tolerance > 0)
    worst = evaluated.check(int(passed[np.argmax(strain)]))
    count = f"{len(passed)} of {len(applies)} {scope} pass, the others are not applicable"
    detail = f"{count}; {worst.scope} is the closest call"
    return [replace(worst, scope=scope, detail=detail)]
