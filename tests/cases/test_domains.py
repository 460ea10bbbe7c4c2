"""The shared case of a membrane in domains: shares add up to its known energies, statistics are those of the table."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import curvcli
from tests.helpers.shared import SHARED, needs_shared

pytestmark = needs_shared


def test_shares_of_the_domains_of_a_sphere() -> None:
    assert SHARED is not None
    path = Path(SHARED) / "cases" / "sphere_domains.ply"
    analysis = curvcli.analyze(path, "paper", regions="domain", stat="count,mean,area_mean,std")
    report = analysis.report()
    shares = [region["shares"] for region in report["regions"]]
    assert sum(share["willmore"] for share in shares) == pytest.approx(50.428, abs=5e-4)
    assert sum(share["H_theta"] for share in shares) == pytest.approx(25.093, abs=5e-4)
    whole = report["totals"]["willmore"]
    for share in shares:  # ∫(H − 2)² of each domain
        assert (share["willmore"] - 4 * share["H_theta"] + 4 * share["area"]) / whole >= 0
    assert [check["status"] for check in report["checks"] if check["name"] == "partition"] == ["pass"]
    assert analysis.regions is not None
    h, area = analysis.vertices["h_signed"], analysis.vertices["A"]
    for number, region in enumerate(report["regions"]):
        border = analysis.surface.faces[analysis.regions.face != number].ravel()
        inside = np.setdiff1d(analysis.surface.faces[analysis.regions.face == number].ravel(), border)
        x, weight = h[inside], area[inside]
        expected = {"count": len(x), "mean": x.mean(), "area_mean": np.average(x, weights=weight), "std": x.std()}
        assert region["columns"]["h_signed"] == pytest.approx(expected, rel=1e-10)
