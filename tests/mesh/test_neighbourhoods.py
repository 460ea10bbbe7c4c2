"""Neighbourhoods by rings and by radius, the scales that name them, and the measures summed over them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.errors import UsageError
from curvcli.mesh.neighbourhoods import mean_edge_length, neighbourhoods, radius_of, sizes, sums
from curvcli.mesh.scale import EstimatorSettings, Scale, options_of, parse_radius, parse_scales, rings
from curvcli.mesh.surface import Surface
from tests.helpers import irregular, meshes

Mask = NDArray[np.bool_]


def dense(surface: Surface, scale: Scale) -> Mask:
    """(V, V): whether each vertex is near each other one."""
    return np.concatenate([rows.toarray() for _, rows in neighbourhoods(surface, scale)])


def by_hand(surface: Surface, scale: Scale) -> Mask:
    """The same by walking from vertex to vertex."""
    around: list[set[int]] = [set() for _ in range(surface.n_vertices)]
    for face in surface.faces.tolist():
        for vertex in face:
            around[vertex] |= set(face)
    found = np.zeros((surface.n_vertices,) * 2, bool)
    steps = int(scale.size) if scale.kind == "rings" else surface.n_vertices
    for p in np.flatnonzero(surface.referenced).tolist():
        distance = np.linalg.norm(surface.points - surface.points[p], axis=1)
        near = distance <= (np.inf if scale.kind == "rings" else radius_of(surface, scale))
        reached = {p}
        for _ in range(steps):
            more = {q for one in reached for q in around[one] if near[q]} - reached
            reached |= more
            if not more:
                break
        found[p, list(reached)] = True
    return found


@pytest.mark.parametrize("scale", [rings(1), rings(2), rings(4), Scale("edges", 1.7), Scale("length", 1.1)], ids=str)
@pytest.mark.parametrize("name", ["torus", "grid", "cap", "book", "pinched", "two_bodies", "soup", "with_flat_face"])
def test_neighbourhoods_match_a_walk_by_hand(name: str, scale: Scale) -> None:
    surface = meshes.zoo(name).surface()
    np.testing.assert_array_equal(dense(surface, scale), by_hand(surface, scale))


def test_a_sheet_that_passes_near_is_not_mixed_in() -> None:
    """Two planes a tenth of an edge apart, and a strip folded over: near in space is not near on the surface."""
    flat = meshes.grid(6).points * [1, 1, 0]
    sheet = meshes.grid(6).moved(flat)
    both = meshes.joined(sheet, sheet.moved(flat + np.array([0, 0, 0.1]))).surface()
    found = dense(both, Scale("length", 2.0))
    half = both.n_vertices // 2
    assert not found[:half, half:].any()
    assert found[:half, :half].sum(axis=1).min() >= 4


def test_blocks_cover_all_vertices_and_a_vertex_of_huge_degree_is_left_out() -> None:
    fan = meshes.fan(9_000)
    surface = fan.surface()
    assert sizes(surface, rings(1)).tolist()[:2] == [9_001, 4]
    assert sizes(surface, rings(2))[0] == 0
    found = curvcli.analyze((fan.points, fan.faces), "K_ring,K_corrected")
    assert np.isnan(found.vertices["K_ring"]).all()
    covered = [k for block, _ in neighbourhoods(surface, rings(2)) for k in range(block.start, block.stop)]
    assert covered == list(range(surface.n_vertices))


def test_sums_are_sums() -> None:
    surface = meshes.torus().surface()
    data = np.random.default_rng(0).normal(size=(surface.n_vertices, 3))
    np.testing.assert_allclose(sums(surface, rings(2), data), dense(surface, rings(2)) @ data, rtol=1e-12, atol=1e-12)


def test_radii_count_in_mean_edge_lengths() -> None:
    surface = meshes.torus().surface()
    edges = surface.edges
    lengths = np.linalg.norm(surface.points[edges.a] - surface.points[edges.b], axis=1)
    assert mean_edge_length(surface) == pytest.approx(lengths.mean(), rel=1e-13)
    assert radius_of(surface, Scale("edges", 3)) == pytest.approx(3 * lengths.mean(), rel=1e-13)
    tiny = Surface(surface.points * 2.0**-300, surface.faces)
    np.testing.assert_array_equal(sizes(tiny, Scale("length", 0.5 * 2.0**-300)), sizes(surface, Scale("length", 0.5)))


@pytest.mark.parametrize(
    ("text", "scale"),
    [
        ("3e", Scale("edges", 3)),
        ("2.5E", Scale("edges", 2.5)),
        ("3e5", Scale("length", 3e5)),
        (".1", Scale("length", 0.1)),
    ],
)
def test_a_radius_is_a_length_or_a_number_of_edges(text: str, scale: Scale) -> None:
    assert parse_radius(text) == scale


def test_names_of_scales_read_back() -> None:
    scales = parse_scales("1,3,3", "2e,1e-3,0.1e,1e22")
    assert [scale.name for scale in scales] == ["1rings", "3rings", "2e", "r0.001", "0.1e", "r1e+22"]
    given = options_of(",".join(scale.name for scale in scales))
    assert parse_scales(given["rings"], given["radius"]) == scales
    assert parse_scales([1, 3, 3], ["2e", 1e-3, "0.1e", 1e22]) == scales
    assert parse_scales(np.int64(3), np.float64(0.5)) == parse_scales("3", "0.5")


@pytest.mark.parametrize("text", ["", "e", "-1", "0", "nan", "inf", "1x", "0e"])
def test_what_is_no_length_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="expected a positive length"):
        parse_radius(text)


@pytest.mark.parametrize("text", ["0", "-1", "1.5", "101", "x", ""])
def test_what_is_no_number_of_rings_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="expected a whole number from 1 to 100"):
        parse_scales(text, None)


# ---------------------------------------------------------------------------- averaged measures


@pytest.mark.parametrize("scale", [{"rings": 1}, {"rings": 3}, {"radius": "2.2e"}])
@pytest.mark.parametrize("name", ["torus", "cap", "with_flat_face", "two_bodies"])
def test_averaged_measures_are_the_measures_summed_and_divided(name: str, scale: dict[str, int | str]) -> None:
    surface = meshes.zoo(name).surface()
    found = curvcli.analyze(surface, "K,A,H_vec,A_vec,K_ring,h_ring", **scale)  # type: ignore[arg-type]
    K, A, H, N = (found.vertices[key] for key in ("K", "A", "H_vec", "A_vec"))
    settings = EstimatorSettings(parse_scales(scale.get("rings"), scale.get("radius")))
    near = by_hand(surface, settings.scale)
    used = surface.interior & np.isfinite(K) & np.isfinite(H[:, 0])
    for p in range(surface.n_vertices):
        ring = near[p] & used
        if not surface.interior[p] or not ring.any():
            assert np.isnan(found.vertices["K_ring"][p])
            continue
        force, normal = H[ring].sum(axis=0), N[ring].sum(axis=0)
        assert found.vertices["K_ring"][p] == pytest.approx(K[ring].sum() / A[ring].sum(), rel=1e-9, abs=1e-12)
        h = -np.sign(force @ normal) * np.linalg.norm(force) / np.linalg.norm(normal)
        assert found.vertices["h_ring"][p] == pytest.approx(h, rel=1e-9, abs=1e-9)


def test_the_whole_sphere_as_one_neighbourhood() -> None:
    """Its measure is 4π, exactly."""
    known = irregular.sphere(300)
    found = curvcli.analyze((known.points, known.faces), "K_ring", rings=40)
    area = found.totals["area"]
    np.testing.assert_allclose(found.vertices["K_ring"], 4 * np.pi / area, rtol=1e-12)  # type: ignore[operator]


def test_principal_curvatures_of_a_tube() -> None:
    known = irregular.torus(10_000, regular=True)
    found = curvcli.analyze((known.points, known.faces), "kappa_1_ring,kappa_2_ring,h_ring", rings=1)
    assert irregular.error(found.vertices["kappa_1_ring"], np.full(len(known.K), 1 / 0.7)) < 0.01
    assert irregular.error(found.vertices["kappa_2_ring"], known.H - 1 / 0.7) < 0.03
    assert irregular.error(found.vertices["h_ring"], known.H) < 0.005


def test_the_measures_themselves_do_not_change() -> None:
    given = meshes.torus()
    plain, wide = (curvcli.analyze((given.points, given.faces), "core", rings=r) for r in (None, 5))
    for name in plain.vertices:
        np.testing.assert_array_equal(plain.vertices[name], wide.vertices[name])
    assert plain.conventions.scale is None


def test_threads_and_blocks_change_no_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ["K_corrected", "kappa_1_corrected", "K_fit", "dir_1_fit", "K_ring", "h_ring"]
    given = meshes.torus()

    def found(threads: str, rows: int) -> list[bytes]:
        monkeypatch.setenv("OMP_NUM_THREADS", threads)
        monkeypatch.setattr("curvcli.mesh.neighbourhoods._ROWS_PER_BLOCK", rows)
        analysis = curvcli.analyze(given.surface(), names, rings=2)
        return [analysis.column(name).tobytes() for name in names]

    whole = found("1", 1 << 16)
    for threads, rows in (("2", 1 << 16), ("1", 16), ("2", 16)):
        assert found(threads, rows) == whole
