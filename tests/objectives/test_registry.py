"""Quantities by name."""

from __future__ import annotations

import pickle
import re
from dataclasses import replace

import pytest

from slidercrank.model.errors import InputError
from slidercrank.objectives.cycle_peak import CycleAverage
from slidercrank.objectives.registry import FACTS, QUANTITIES, quantity

# Names in job files are promises: they never change.
NAMES = {
    *("time_ratio", "peak_torque", "transmission_angle", "position_error"),
    *("peak_torque_outward", "peak_torque_inward", "rms_torque", "mean_torque", "position_error_rss"),
    *("stroke", "rod_to_offset", "rod_to_crank", "footprint"),
    *("peak_pivot_force", "peak_crank_pin_force", "peak_slider_pin_force", "peak_guide_force"),
    *("peak_slider_speed", "peak_slider_acceleration"),
    *("self_locking_margin", "peak_power", "mean_power", "peak_reflected_inertia"),
    *("peak_shaking_force", "rms_shaking_force", "peak_shaking_moment", "rms_shaking_moment"),
    "peak_rocking_couple",
    *("efficiency", "energy_per_cycle", "friction_loss", "envelope_length", "envelope_height"),
    *("crank_angle_ratio", "outward_stroke_time", "inward_stroke_time", "outward_to_inward_time_ratio"),
    "inward_to_outward_time_ratio",
    *("pv_pivot", "pv_crank_pin", "pv_slider_pin", "wear_pivot", "wear_crank_pin", "wear_slider_pin"),
}


def test_every_promised_quantity_is_there() -> None:
    assert set(QUANTITIES) >= NAMES


def test_quantity_is_found_by_its_name() -> None:
    for name in NAMES:
        assert quantity(name).name == name


def test_misspelt_quantity_is_answered_with_the_nearest() -> None:
    with pytest.raises(InputError, match="no quantity is called 'peek_torque'; did you mean peak_torque"):
        quantity("peek_torque")


def test_unknown_quantity_is_answered_with_all() -> None:
    with pytest.raises(InputError, match="no quantity is called 3; choose"):
        quantity(3)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="no quantity is called 'xyz'; choose from time_ratio, peak_torque, "):
        quantity("xyz")


def test_a_quantity_of_the_product_is_itself_where_another_process_takes_it_up() -> None:
    assert all(pickle.loads(pickle.dumps(of)) is of for of in FACTS.values())


def test_a_changed_quantity_keeps_its_change_where_another_process_takes_it_up() -> None:
    for fact in FACTS.values():
        taken = pickle.loads(pickle.dumps(replace(fact, title="another title")))
        assert (taken.title, taken.sentence, taken.needs) == ("another title", fact.sentence, fact.needs)


def test_every_average_says_over_what_it_is_taken() -> None:
    """Heating and shaking average over time, work over the crank angle. Mean effective pressure is work per volume."""
    told = {name for name, each in QUANTITIES.items() if isinstance(each, CycleAverage) or "mean of" in each.formula}
    told |= {name for name in QUANTITIES if name.startswith(("mean_", "rms_"))}
    for name in told - {"mean_effective_pressure", "delivered_work"}:
        found = QUANTITIES[name]
        (over,) = (over for over in ("over time", "over the crank angle") if over in found.title)
        of_angle = isinstance(found, CycleAverage) and found.statistic == "mean" and not found.times_speed
        assert over == ("over the crank angle" if of_angle else "over time") or name in (
            "torque_fluctuation",
            "mean_inertia_ratio",
        )
        assert over in re.sub("over the time of a (cycle|turn)", "over time", found.sentence), name
        assert over in found.formula, name
