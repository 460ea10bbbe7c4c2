"""Options that set parameters of passes and the unit of energies."""

from __future__ import annotations

from typing import Any

import click

from .options import together

setting = together(
    click.option(
        "--set",
        "parameters",
        metavar="PASS.NAME=VALUE",
        multiple=True,
        help="Set a parameter of a pass, such as helfrich.c0=0.5, and compute its columns; PASS.NAME=REGION=VALUE for "
        "one region; repeatable. `curvcli passes PASS` lists the parameters.",
    ),
    click.option(
        "--spontaneous-curvature",
        metavar="C0|REGION=C0",
        multiple=True,
        help="Spontaneous curvature of helfrich, the energy (h_signed - C0)\u00b2/2 per area, in the unit of the file; "
        "repeatable, with a value for each region. Adds helfrich.",
    ),
    click.option(
        "--bending-rigidity",
        metavar="NUMBERkBT|NUMBERJ",
        help="Bending rigidity, such as 20kBT or 8e-20J, that energies are multiplied by; adds helfrich.  [default: "
        "energies in units of it]",
    ),
)


def merge_settings(options: dict[str, Any]) -> None:
    """Replace the options of `setting` by `parameters` and `bending_rigidity` as an analysis takes them.

    Errors: UsageError for an unknown name or a value of another type.
    """
    from ..analysis.rigidity import parse_rigidity
    from ..curvatures.setting_values import parse_settings, with_spontaneous_curvature

    given = with_spontaneous_curvature(options.pop("parameters"), options.pop("spontaneous_curvature"))
    options["parameters"] = parse_settings(given)
    if options["bending_rigidity"] is not None:
        options["bending_rigidity"] = str(parse_rigidity(options["bending_rigidity"]))
