"""How a varying number of a machine is called in tables and JSON, and its unit there."""

from __future__ import annotations

import math
import re

from ..model.machine.numbers import unit_of
from ..model.machine.varying import Varying
from .quantity import Unit

# How a number in an SI unit is shown: the end of its key, its unit there.
_SHOWN = {
    "m": ("_mm", Unit("mm", 1e3)),
    "rad": ("_deg", Unit("deg", 180.0 / math.pi)),
    "rad/s": ("_rpm", Unit("rpm", 30.0 / math.pi)),
    "rad/s^2": ("_rad_s2", Unit("rad/s^2", 1.0)),
    "kg": ("_kg", Unit("kg", 1.0)),
    "kg m^2": ("_kg_m2", Unit("kg m^2", 1.0)),
    "kg/m^3": ("_kg_m3", Unit("kg/m^3", 1.0)),
    "m/s^2": ("_m_s2", Unit("m/s^2", 1.0)),
    "N": ("_N", Unit("N", 1.0)),
    "N/m": ("_N_per_m", Unit("N/m", 1.0)),
    "N s/m": ("_Ns_per_m", Unit("N s/m", 1.0)),
    "": ("", Unit("", 1.0)),
}


def varying_column(varying: Varying) -> tuple[str, Unit]:
    """Return the key of a varying number in tables and JSON, and the unit there.

    The key is the name without a leading "mechanism", with underscores, and the unit: "mechanism.slider.mass" becomes
    slider_mass_kg, "load.1.force" load_1_force_N. A share of a dimension has no unit.
    """
    end, unit = _SHOWN[unit_of(varying.paths[0])]
    name = re.sub("[^a-z0-9]+", "_", varying.name.removeprefix("mechanism.").lower()).strip("_")
    return name + end, unit
