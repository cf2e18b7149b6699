"""Columns for the numbers of a design in tables and JSON, with their units."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ...model.linkage.dimensions import DIMENSIONS
from ...model.machine.raw_numbers_of_designs import unit_of_number
from ...model.machine.varying_numbers import Varying
from ..kinds import KINDS, LENGTH, DisplayUnit


def column_of_variable(varying: Varying) -> tuple[str, DisplayUnit]:
    """Return the key of a variable in tables and JSON, and its unit there.

    The key is the name without a leading "mechanism", with underscores, and the unit: "mechanism.slider.mass" becomes
    slider_mass_kg, "load.1.force" load_1_force_N. A fraction of a dimension has no unit.
    """
    unit = next(kind.metric for kind in KINDS if kind.unit == unit_of_number(varying.paths[0]))
    name = re.sub("[^a-z0-9]+", "_", varying.name.removeprefix("mechanism.").lower()).strip("_")
    return name + unit.suffix, unit


def number_in_words(name: str) -> str:
    """Return the words for a number in a job from its name or key: "slider mass", "crank pin diameter"."""
    words = re.sub("[._]", " ", name.removeprefix("mechanism."))
    return re.sub("^sections pins (.+)", r"\1 diameter", words)


def columns_of_numbers(varying: Sequence[Varying]) -> dict[str, tuple[str, DisplayUnit]]:
    """Return key and unit for each number of a design by name: crank, rod, offset, and extra variables."""
    lengths = {name: (f"{name}{LENGTH.metric.suffix}", LENGTH.metric) for name in DIMENSIONS}
    return lengths | {item.name: column_of_variable(item) for item in varying}
