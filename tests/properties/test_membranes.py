"""Helfrich's energy, reduced volume and area difference: closed forms, quadrature, exact meshes, invariances."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

import curvcli
from curvcli.curvatures.derived import derived
from curvcli.curvatures.quantity import Quantity
from curvcli.curvatures.registry import passes
from curvcli.errors import UsageError
from tests.helpers import meshes
from tests.helpers.columns import agree, same
from tests.helpers.meshes import Mesh

_ = curvcli.passes  # importing registers them
NAMES = tuple(meshes.ZOO)
# Evans and Fung 1972, for 300 mOsm: the radius, and the coefficients of the thickness, in micrometres.
RADIUS, THICKNESS = 3.91, (0.81, 7.83, -4.39)
C0 = [0.0, 0.4, -0.4]


def on_sphere(size: int, place: Callable[[Any, Any], tuple[Any, Any]]) -> Mesh:
    """A surface of revolution: a regular sphere, whose points at sine s and cosine c of the polar angle move to a
    radius and a height."""
    sphere = meshes.of_sample("icosphere", size=size)
    x, y, z = (sphere.points / np.linalg.norm(sphere.points, axis=1)[:, None]).T
    sine = np.hypot(x, y)
    radius, height = place(sine, z)
    stretch = np.divide(radius, sine, where=sine > 0, out=np.zeros_like(sine))
    return sphere.moved(np.stack([x * stretch, y * stretch, height], axis=1))


def red_cell(size: int) -> Mesh:
    a, b, c = THICKNESS
    return on_sphere(size, lambda s, z: (RADIUS * s, z / 2 * (a + b * s**2 + c * s**4)))


def columns_of(size: int) -> int:
    """Columns of a grid: twice as many at four times the size."""
    return round(math.sqrt(size) / 8) * 8


def spherocylinder(size: int, radius: float = 1.0, length: float = 2.0) -> Mesh:
    """A cylinder with hemispheres for ends, on a grid of near squares."""
    columns = columns_of(size)
    step = 2 * math.pi * radius / columns
    ends, middle = round(math.pi / 2 * radius / step), round(length / step)
    angle = np.linspace(math.pi / 2, 0, ends + 1)[1:]
    rho = np.concatenate([radius * np.cos(angle), np.full(middle - 1, radius), radius * np.cos(angle[::-1])])
    z = np.concatenate(
        [
            length / 2 + radius * np.sin(angle),
            np.linspace(length / 2, -length / 2, middle + 1)[1:-1],
            -length / 2 - radius * np.sin(angle[::-1]),
        ]
    )
    rows, turn = len(rho), 2 * math.pi * np.arange(columns) / columns
    ring = np.stack([np.outer(rho, np.cos(turn)), np.outer(rho, np.sin(turn)), np.outer(z, np.ones(columns))], axis=-1)
    top = length / 2 + radius
    points = np.concatenate([ring.reshape(-1, 3), [[0, 0, top], [0, 0, -top]]])
    at = np.arange(rows * columns).reshape(rows, columns)
    right = np.roll(at, -1, axis=1)
    squares = [at[:-1], at[1:], right[:-1]], [right[:-1], at[1:], right[1:]]
    faces = [np.stack([part.ravel() for part in three], axis=1) for three in squares]
    faces.append(np.stack([np.full(columns, len(points) - 2), at[0], right[0]], axis=1))
    faces.append(np.stack([np.full(columns, len(points) - 1), right[-1], at[-1]], axis=1))
    return meshes.mesh(points, np.concatenate(faces))


def integrals_of_red_cell(c0: float) -> dict[str, float]:
    """Area, volume, ∫H and ½∫(H − c₀)² by quadrature over the polar angle, with the derivatives written out."""
    a, b, c = THICKNESS

    def integral(of: Callable[..., float]) -> float:
        def integrand(t: float) -> float:
            s, u = math.sin(t), math.cos(t)
            p, p1, p2 = a + b * s**2 + c * s**4, 2 * b * s + 4 * c * s**3, 2 * b + 12 * c * s**2
            r, r1, r2 = RADIUS * s, RADIUS * u, -RADIUS * s
            z1, z2 = -s * p / 2 + u * u * p1 / 2, -u * p / 2 - 1.5 * s * u * p1 + u**3 * p2 / 2
            speed = math.hypot(r1, z1)
            bend = (r2 * z1 - z2 * r1) / speed**3 - z1 / (r * speed)
            return of(2 * math.pi * r * speed, bend, -math.pi * r * r * z1)

        return float(quad(integrand, 1e-9, math.pi - 1e-9, epsabs=1e-11, epsrel=1e-11, limit=400)[0])

    return {
        "area": integral(lambda area, H, volume: area),
        "volume": integral(lambda area, H, volume: volume),
        "H_theta": integral(lambda area, H, volume: area * H),
        "helfrich": integral(lambda area, H, volume: area * (H - c0) ** 2 / 2),
    }


def energy(mesh: Mesh, c0: float) -> float:
    return float(curvcli.analyze(mesh.surface(), "helfrich", spontaneous_curvature=c0).totals["helfrich"])


def sphere(size: int) -> Mesh:
    return meshes.of_sample("icosphere", size=size)


def clifford(size: int) -> Mesh:
    return meshes.of_sample("clifford_torus", size=size)


# A torus of radii 1 and 1/√2: ∫H² = 8π², ∫H = 4π²R, area = 4π²Rr.
CLOSED_FORMS: dict[str, tuple[Callable[[int], Mesh], Callable[[float, int], float]]] = {
    "sphere": (sphere, lambda c0, size: (2 - c0) ** 2 / 2 * 4 * math.pi),
    "clifford_torus": (
        clifford,
        lambda c0, size: 4 * math.pi**2 - c0 * 4 * math.pi**2 + c0**2 / 2 * 4 * math.pi**2 / math.sqrt(2),
    ),
    "spherocylinder": (
        spherocylinder,
        # The rings of vertices where H jumps from 1 to 2 have H = 3/2, over a step of the grid.
        lambda c0, size: 2 * math.pi * ((1 - c0) ** 2 + (2 - c0) ** 2) - math.pi**2 / columns_of(size),
    ),
    "red_cell": (red_cell, lambda c0, size: integrals_of_red_cell(c0)["helfrich"]),
}


@pytest.mark.parametrize("c0", C0)
@pytest.mark.parametrize("shape", CLOSED_FORMS)
def test_the_energy_converges_to_its_closed_form(shape: str, c0: float) -> None:
    """Within 0.1 % at about 10,000 vertices (0.2 % on the grids), and at second order."""
    make, exact = CLOSED_FORMS[shape]
    coarse, fine = (abs(energy(make(size), c0) / exact(c0, size) - 1) for size in (2562, 10242))
    assert fine <= (1e-3 if make in (sphere, red_cell) else 2e-3)
    assert coarse >= 3.4 * fine


def test_the_red_cell_by_quadrature() -> None:
    """Evans and Fung give 135 μm² and 94 μm³."""
    exact = integrals_of_red_cell(0.0)
    assert exact["area"] == pytest.approx(135, rel=0.01)
    assert exact["volume"] == pytest.approx(94, rel=0.01)
    totals = curvcli.analyze(red_cell(10242).surface(), "helfrich").totals
    for key, wanted in exact.items():
        assert totals[key] == pytest.approx(wanted, rel=1e-3), key
    radius = math.sqrt(exact["area"] / (4 * math.pi))
    assert totals["reduced_volume"] == pytest.approx(exact["volume"] / (4 / 3 * math.pi * radius**3), rel=1e-3)
    assert totals["reduced_area_difference"] == pytest.approx(exact["H_theta"] / (8 * math.pi * radius), rel=1e-3)


def test_an_open_cylinder_has_the_energy_of_its_inner_vertices() -> None:
    """H = 1/r at inner vertices, exactly in the limit of the facets; at c₀ = 1/r the energy vanishes."""
    surface = meshes.of_sample("cylinder", size=4000, radius=2.0).surface()
    inner = float(curvcli.passes.A(surface)[surface.interior].sum())
    for c0 in (0.0, 0.3, -0.3):
        total = curvcli.analyze(surface, "helfrich", spontaneous_curvature=c0).totals["helfrich"]
        assert total == pytest.approx((0.5 - c0) ** 2 / 2 * inner, rel=2e-3)
    flat = curvcli.analyze(surface, "helfrich", spontaneous_curvature=0.5).totals
    assert flat["helfrich"] < 1e-6 * inner
    assert flat["reduced_volume"] is flat["reduced_area_difference"] is None


@pytest.mark.parametrize("c0", [0.0, 0.75, -2.0])
def test_an_octahedron_exactly(c0: float) -> None:
    """Corners at distance 1: |H_p| = 4/√3, |A_vec| = 2/3, A_p = 2/√3, so that h = 2√3 and the energy is
    6 · ½(2√3 − c₀)² · 2/√3; twelve edges √2 long turn by π − arccos(−1/3)."""
    points = np.concatenate([np.eye(3), -np.eye(3)])
    faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    analysis = curvcli.analyze((points, np.array(faces)), "helfrich", spontaneous_curvature=c0)
    each = 0.5 * (2 * math.sqrt(3) - c0) ** 2 * 2 / math.sqrt(3)
    np.testing.assert_allclose(analysis.vertices["helfrich"], np.full(6, each), rtol=1e-14)
    assert analysis.totals["helfrich"] == pytest.approx(6 * each, rel=1e-14)
    area, bend = 4 * math.sqrt(3), 12 * math.sqrt(2) * (math.pi - math.acos(-1 / 3))
    radius = math.sqrt(area / (4 * math.pi))
    assert analysis.totals["reduced_volume"] == pytest.approx(4 / 3 / (4 / 3 * math.pi * radius**3), rel=1e-14)
    assert analysis.totals["reduced_area_difference"] == pytest.approx(bend / (8 * math.pi * radius), rel=1e-14)


def test_the_area_difference_is_that_of_parallel_surfaces() -> None:
    """Of a cube at distances ±D/2: its faces, quarter cylinders at its edges and an eighth of a sphere at its corners;
    inside, the difference is that of Steiner's polynomial."""
    a, D = 3.0, 0.5
    cube = meshes.of_sample("cube", edge=a).surface()
    totals = curvcli.analyze(cube, settings={"area_difference.thickness": D}).totals

    def parallel(t: float) -> float:
        return 6 * a**2 + 12 * a * math.pi / 2 * t + 4 * math.pi * t**2

    assert totals["area_difference"] == pytest.approx(parallel(D / 2) - parallel(-D / 2), rel=1e-14)
    assert "helfrich" not in totals


def test_the_energy_of_the_area_difference() -> None:
    """8π²α(Δa − Δa₀)² is ½απ(ΔA − ΔA₀)²/(area D²), whatever D."""
    D, ratio, preferred = 0.02, 1.4, 1.3
    settings = {
        "area_difference": {"thickness": D},
        "area_difference_energy": {"ratio": ratio, "preferred": preferred},
    }
    totals = curvcli.analyze(red_cell(642).surface(), "helfrich", settings=settings).totals
    preferred_difference = 8 * math.pi * math.sqrt(totals["area"] / (4 * math.pi)) * D * preferred
    gap = totals["area_difference"] - preferred_difference
    wanted = ratio / 2 * math.pi * gap**2 / (totals["area"] * D**2)
    assert totals["area_difference_energy"] == pytest.approx(wanted, rel=1e-12)
    turned = curvcli.analyze(red_cell(642).surface(), "helfrich", settings=settings, bending_rigidity="20kBT").totals
    assert turned["area_difference_energy"] == pytest.approx(20 * wanted, rel=1e-12)
    assert turned["area_difference"] == totals["area_difference"]


def test_each_closed_component_has_its_own() -> None:
    """A sphere, an inside-out sphere twice as large and an open cap: v = 1, −1 and null; null for all together."""
    ball = sphere(642)
    inside_out = meshes.reversed_faces(ball.moved(2 * ball.points + 5))
    both = meshes.joined(meshes.joined(ball, inside_out), meshes.cap())
    report = curvcli.analyze(both.surface(), "helfrich").report()
    volumes = [piece["totals"]["reduced_volume"] for piece in report["components"]]
    differences = [piece["totals"]["reduced_area_difference"] for piece in report["components"]]
    assert volumes[0] == pytest.approx(1, abs=2e-3)
    assert volumes[1] == pytest.approx(-volumes[0], rel=1e-12)
    assert differences[1] == pytest.approx(-differences[0], rel=1e-12)
    assert volumes[2] is differences[2] is None
    assert report["totals"]["reduced_volume"] is None


def test_a_region_that_is_closed_has_them_too() -> None:
    ball = sphere(162)
    both = meshes.joined(ball, ball.moved(ball.points + 5))
    label = (np.arange(len(both.faces)) >= len(ball.faces)).astype(int)
    label[-1] = 2
    analysis = curvcli.analyze(both.surface(), "helfrich", regions=label, spontaneous_curvature={"1": 0.5})
    first, second, third = (region["totals"] for region in analysis.report()["regions"])
    assert first["reduced_volume"] == pytest.approx(1, abs=0.02)
    assert second["reduced_volume"] is third["reduced_volume"] is None
    assert second["helfrich"] < first["helfrich"]


# ---------------------------------------------------------------------- invariances, by what settings declare


CONFIGURABLE = [name for name, each in passes.items() if each.settings]
VALUE = 0.375


def values(name: str, factor: float = 1.0, reverse: bool = False) -> dict[str, float]:
    """A value for each number that a pass can be set to, as its declaration says that it changes."""
    return {
        each.name: VALUE * factor**each.length_exponent * (-1 if reverse and each.parity == "odd" else 1)
        for each in passes[name].settings
        if each.kind == "float"
    }


def columns(name: str, mesh: Mesh, **given: float) -> dict[str, Any]:
    found = curvcli.passes[name](mesh.surface(), **given)
    return found if isinstance(found, dict) else {name: found}


def quantities(name: str) -> dict[str, Quantity]:
    return {quantity.name: quantity for quantity in passes[name].provides}


@pytest.mark.parametrize("factor", [1e9, 1e-9, 2.0**-60, 2.0**300])
@pytest.mark.parametrize("name", CONFIGURABLE)
def test_a_setting_scales_with_the_mesh(name: str, factor: float) -> None:
    for kind in NAMES:
        mesh = meshes.zoo(kind)
        found = columns(name, mesh.moved(mesh.points * factor), **values(name, factor))
        for key, plain in columns(name, mesh, **values(name)).items():
            quantity = quantities(name)[key]
            agree(quantity, found[key], plain * factor**quantity.length_exponent, length=factor)


@pytest.mark.parametrize("name", CONFIGURABLE)
def test_reversing_all_faces_reverses_a_setting(name: str) -> None:
    """helfrich with c₀ is helfrich of the reversed surface with −c₀; with the same c₀ it is another energy."""
    for kind in NAMES:
        mesh = meshes.zoo(kind)
        found = columns(name, meshes.reversed_faces(mesh), **values(name, reverse=True))
        for key, plain in columns(name, mesh, **values(name)).items():
            quantity = quantities(name)[key]
            agree(quantity, found[key], -plain if quantity.parity == "odd" else plain)
    ball = sphere(162)
    assert energy(meshes.reversed_faces(ball), VALUE) > 1.5 * energy(ball, VALUE)


@pytest.mark.parametrize("kind", NAMES)
def test_without_spontaneous_curvature_it_is_half_of_willmore(kind: str) -> None:
    """Bit for bit and null for null, also where the surface has no orientation."""
    surface = meshes.zoo(kind).surface()
    helfrich = passes["helfrich"].provides[0]
    same(helfrich, curvcli.passes["helfrich"](surface), curvcli.passes.willmore(surface) / 2)


@pytest.mark.parametrize("kind", NAMES)
def test_with_one_it_is_null_where_the_sign_is(kind: str) -> None:
    surface = meshes.zoo(kind).surface()
    h, area = (curvcli.passes[name](surface) for name in ("h_signed", "A"))
    np.testing.assert_allclose(curvcli.passes["helfrich"](surface, c0=VALUE), (h - VALUE) ** 2 * area / 2, rtol=1e-14)


@pytest.mark.parametrize("kind", ["mobius", "klein_bottle"])
def test_a_total_without_orientation_is_null_not_zero(kind: str) -> None:
    surface = meshes.zoo(kind).surface()
    label = np.arange(surface.n_faces) % 2
    for c0 in (VALUE, {"1": VALUE}):
        analysis = curvcli.analyze(surface, "helfrich", regions=label, spontaneous_curvature=c0)
        assert analysis.totals["helfrich"] is None
        assert {region["shares"]["helfrich"] for region in analysis.report()["regions"]} == {None}
    plain = curvcli.analyze(surface, "helfrich,willmore").totals
    assert plain["helfrich"] == pytest.approx(plain["willmore"] / 2, rel=1e-14)


def test_derived_totals_change_as_declared() -> None:
    """Scaled by 3 and reversed, with settings that change as they declare."""
    mesh = red_cell(642)

    def totals(factor: float, reverse: bool) -> dict[str, Any]:
        settings = {
            f"{name}.{each.name}": 1.25 * factor**each.length_exponent * (-1 if reverse and each.parity == "odd" else 1)
            for name, total in derived.items()
            for each in total.settings
        }
        moved = mesh.moved(mesh.points * factor)
        moved = meshes.reversed_faces(moved) if reverse else moved
        return dict(curvcli.analyze(moved.surface(), "helfrich", settings=settings).totals)

    plain = totals(1.0, False)
    for factor, reverse in ((3.0, False), (1.0, True), (1e-9, True)):
        found = totals(factor, reverse)
        for name, total in derived.items():
            sign = -1 if reverse and total.parity == "odd" else 1
            assert found[name] == pytest.approx(sign * plain[name] * factor**total.length_exponent, rel=1e-11), name


@pytest.mark.parametrize("c0", [1e200, -1e308])
def test_an_energy_beyond_doubles_is_refused(c0: float) -> None:
    surface = meshes.icosphere().surface()
    with pytest.raises(UsageError, match="beyond the range of doubles"):
        curvcli.passes["helfrich"](surface, c0=c0)
    with pytest.raises(UsageError, match="beyond the range of doubles"):
        curvcli.analyze(surface, regions=np.arange(surface.n_faces) % 2, spontaneous_curvature={"1": c0})


@pytest.mark.parametrize("kind", NAMES)
def test_shares_of_regions_with_their_own_value_add_up(kind: str) -> None:
    """Each face has its part of a star with its own c₀, however the regions lie; so on a whole surface of one c₀."""
    surface = meshes.zoo(kind).surface()
    label = np.random.default_rng(5).integers(-1, 3, surface.n_faces)
    label[0] = 0
    names = [str(name) for name in np.unique(label[label >= 0])]
    c0 = dict(zip(names, (0.0, 0.75, -1e3), strict=False))
    analysis = curvcli.analyze(surface, "helfrich", regions=label, spontaneous_curvature=c0)
    (check,) = (check for check in analysis.checks if check.name == "partition")
    assert check.status in ("pass", "not_applicable"), check
    area, h = curvcli.passes.area_of_face(surface), curvcli.passes.h_signed(surface)
    own = np.array([c0.get(str(name), 0.0) for name in label])
    each = 0.5 * (h[surface.faces] - own[:, None]) ** 2 * area[:, None] / 3
    if surface.orientable:
        wanted = np.nansum(each)
        assert analysis.totals["helfrich"] == pytest.approx(wanted, rel=1e-12)
        shares = {region["name"]: region["shares"]["helfrich"] for region in analysis.report()["regions"]}
        for name in names:
            assert shares[name] == pytest.approx(np.nansum(each[label == int(name)]), rel=1e-12, abs=1e-12 * wanted)


def test_shares_are_in_the_unit_of_the_rigidity() -> None:
    ball = sphere(162).surface()
    label = np.arange(ball.n_faces) % 2
    plain, turned = (
        [region["shares"] for region in curvcli.analyze(ball, "helfrich", regions=label, **more).report()["regions"]]
        for more in ({}, {"bending_rigidity": "20kBT"})  # type: ignore[arg-type]
    )
    for one, other in zip(plain, turned, strict=True):
        assert other["helfrich"] == pytest.approx(20 * one["helfrich"], rel=1e-15)
        assert other["area"] == one["area"]


def test_the_corrected_energy_averages_noise_out() -> None:
    """A red cell whose vertices are off by a twentieth of an edge; one c₀ sets both energies."""
    mesh = red_cell(2562)
    edge = math.sqrt(134.1 / 2562)
    rough = mesh.moved(mesh.points + 0.05 * edge * np.random.default_rng(1).standard_normal(mesh.points.shape))
    analysis = curvcli.analyze(rough, "helfrich,helfrich_corrected", radius="5e", spontaneous_curvature=-0.4)
    exact = integrals_of_red_cell(-0.4)["helfrich"]
    assert analysis.totals["helfrich"] > 1.5 * exact
    assert analysis.totals["helfrich_corrected"] == pytest.approx(exact, rel=0.1)
    (notice,) = (one for one in analysis.notices if one.code == "rough_energy")
    assert "helfrich = " in notice.message
    (hint,) = (one.hint for one in curvcli.analyze(rough, "helfrich").notices if one.code == "rough_energy")
    assert "-p helfrich_corrected at a --radius" in str(hint)


@pytest.mark.parametrize("kind", ["torus", "two_bodies", "book"])
def test_shares_at_several_scales_have_their_own_value_too(kind: str) -> None:
    surface = meshes.zoo(kind).surface()
    label = np.arange(surface.n_faces) % 2
    analysis = curvcli.analyze(
        surface, "helfrich_corrected", radius="2e,3e", regions=label, spontaneous_curvature={"1": 0.5}
    )
    (check,) = (check for check in analysis.checks if check.name == "partition")
    assert check.status == "pass"
    totals, regions = analysis.totals, analysis.report()["regions"]
    for key in ("helfrich_corrected_2e", "helfrich_corrected_3e"):
        shares = [region["shares"][key] for region in regions]
        if totals[key] is None:
            assert shares == [None, None]
            continue
        assert sum(shares) == pytest.approx(totals[key], rel=1e-12)
        assert shares[0] != pytest.approx(shares[1], rel=0.01)
