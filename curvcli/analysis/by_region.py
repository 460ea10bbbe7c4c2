"""Parameters of passes that differ from region to region, as one value for each face."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..curvatures.quantity import AT_SCALE
from ..curvatures.registry import passes
from ..curvatures.setting_values import OTHERS, SettingValue, find_setting, regions_of
from ..errors import LackingError
from ..loading.labels import Regions
from ..mesh.scale import EstimatorSettings
from ..support.arrays import Mask
from ..support.words import suggestion


def settings_by_region(
    settings: EstimatorSettings, values: Mapping[str, SettingValue], regions: Regions | None
) -> EstimatorSettings:
    """The settings with the parameters that have values by region; faces of other regions and of none get the value
    without a region, or the default.

    Errors: LackingError for a region that the mesh has not, with the nearest.
    """
    if regions is None:
        return settings
    for name, region in regions_of(values):
        if region not in regions.names:
            way_out = suggestion(region, regions.names)
            raise LackingError(f"{name} has a value for region {region!r}, which the mesh has not{way_out}")
    of_faces = {}
    for name, value in values.items():
        if isinstance(value, dict):
            others = value.get(OTHERS, find_setting(name)[1].default)
            each = np.array([*(value.get(region, others) for region in regions.names), others])
            of_faces[name] = each[regions.face]
    return replace(settings, values={**settings.values, **of_faces})


def splits_faces(name: str, settings: EstimatorSettings) -> bool:
    """True for a measure whose pass splits it over the faces, where one of its settings differs between them."""
    owner = passes.provider(name.partition(AT_SCALE)[0])
    values = (settings.values.get(each.key(owner.name), 0.0) for each in owner.settings)
    return owner.of_faces is not None and any(np.ndim(value) for value in values)


def is_odd(name: str, settings: EstimatorSettings) -> bool:
    """True for a measure with a setting that changes sign with the orientation and is not 0 everywhere."""
    owner = passes.provider(name.partition(AT_SCALE)[0])
    odd = (settings.values.get(each.key(owner.name), each.default) for each in owner.settings if each.parity == "odd")
    return any(bool(np.any(value)) for value in odd)


def settings_of_faces(settings: EstimatorSettings, mask: Mask) -> EstimatorSettings:
    """The settings of the surface of some faces."""
    values = {name: value[mask] if np.ndim(value) else value for name, value in settings.values.items()}
    return replace(settings, values=values)
