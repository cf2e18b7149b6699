"""Column of a varying number of a machine in tables and JSON, and its unit there."""

from __future__ import annotations

import re

from ...model.machine.numbers import unit_of
from ...model.machine.varying import Varying
from ..kinds import KINDS, Face


def varying_column(varying: Varying) -> tuple[str, Face]:
    """Return the key of a varying number in tables and JSON, and the unit there.

    The key is the name without a leading "mechanism", with underscores, and the unit: "mechanism.slider.mass" becomes
    slider_mass_kg, "load.1.force" load_1_force_N. A share of a dimension has no unit.
    """
    unit = next(kind.metric for kind in KINDS if kind.unit == unit_of(varying.paths[0]))
    name = re.sub("[^a-z0-9]+", "_", varying.name.removeprefix("mechanism.").lower()).strip("_")
    return name + unit.suffix, unit
