"""Names, parameters and refusals."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from curvcli import samples
from curvcli.errors import UsageError
from curvcli.samples import get, names, specs
from curvcli.samples.catalogue import FAMILIES


def test_every_sample_says_what_it_is() -> None:
    for spec in specs():
        assert spec.summary
        assert not spec.summary.endswith(".")
        assert spec.exact.endswith(".")
        made = spec()
        assert (made.name, made.description) == (spec.name, spec.exact)
        assert all(parameter.kind in (int, float, bool) for parameter in spec.parameters)
        assert all(type(parameter.default) is parameter.kind for parameter in spec.parameters)


def test_every_module_with_samples_is_a_family() -> None:
    folder = Path(samples.__file__).parent
    assert {path.stem for path in folder.glob("*.py") if "\n@sample(" in path.read_text("utf-8")} == set(FAMILIES)


def test_a_spelling_is_forgiven_and_a_wrong_name_answered_with_the_nearest() -> None:
    assert get("UV-Sphere").name == "uv_sphere"
    with pytest.raises(UsageError, match=r"icosfere.*icosphere"):
        get("icosfere")
    with pytest.raises(UsageError, match="no sample named 'zzz'; `curvcli sample` lists them"):
        get("zzz")
    assert len(set(names())) == len(names()) >= 40


def test_the_catalogue_is_found_without_numpy() -> None:
    code = "import sys, curvcli.samples; sys.exit('numpy' in sys.modules)"
    root = Path(samples.__file__).parents[2]
    assert subprocess.run([sys.executable, "-c", code], cwd=root, check=False).returncode == 0


def test_parameters_are_read_by_their_kind() -> None:
    spec = get("torus")
    assert spec.parse({"size": " 400 ", "tube": "0.25", "seed": "3"}) == {"size": 400, "tube": 0.25, "seed": 3}
    assert len(spec(**spec.parse({"size": "400"})).points) == pytest.approx(400, rel=0.2)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"size": "2.5"}, "size must be a whole number, not '2.5'"),
        ({"tube": "thin"}, "tube must be a number, not 'thin'"),
        ({"tubes": "1"}, "torus has no parameter 'tubes'; nearest: tube"),
    ],
)
def test_settings_that_do_not_fit(settings: dict[str, str], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        get("torus").parse(settings)


@pytest.mark.parametrize("value", [0, -1, float("nan"), float("inf")])
@pytest.mark.parametrize("name", names())
def test_no_parameter_takes_nonsense(name: str, value: float) -> None:
    for parameter in get(name).parameters:
        if parameter.name in {"seed", "jitter"} and value == 0:
            continue
        with pytest.raises(UsageError, match=parameter.name):
            get(name)(**{parameter.name: value})


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("torus", {"tube": 1.0}),
        ("torus", {"jitter": 0.5}),
        ("annulus", {"hole": 1.0}),
        ("cap", {"angle": 180.0}),
        ("unduloid", {"neck": 1.5}),
        ("nodoid", {"neck": 1.0}),
        ("enneper", {"reach": 1.8}),
        ("scherk", {"reach": 1.6}),
        ("pseudosphere", {"start": 3.0}),
        ("mobius", {"width": 2.0}),
        ("klein_bottle", {"width": 2.0}),
        ("trefoil_tube", {"tube": 0.6}),
        ("book", {"pages": 2}),
        ("cyclide", {"distance": 1.7}),
        ("irregular_sphere", {"size": 9}),
        ("irregular_torus", {"size": 99}),
        ("cube", {"size": 100}),
    ],
)
def test_shapes_that_cannot_be(name: str, values: dict[str, float]) -> None:
    with pytest.raises(UsageError):
        get(name)(**values)


def test_a_scale_must_be_positive() -> None:
    with pytest.raises(UsageError, match="scale"):
        get("cube")().scaled(0.0)
