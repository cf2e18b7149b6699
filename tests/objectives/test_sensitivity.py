"""The table of sensitivities."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pandas as pd
import pytest

from slidercrank.model.errors import AssemblyError
from slidercrank.model.linkage.dimensions import DIMENSIONS
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.objectives.tables.sensitivity import sensitivity
from tests.model.cases import MACHINES, SMOOTH, TOLERANCES, random_designs

DESIGNS = random_designs(5, seed=41, least_margin=0.1)


def shown(machine: Mechanism, design: np.ndarray) -> dict[str, float]:
    """Return every quantity by name as tables show it, and the dead centres from the linkage itself."""
    row = analyse(machine, design).iloc[0]
    values = {name: float(row[quantity.field]) for name, quantity in QUANTITIES.items()}
    linkage = Linkage(design[0], design[1], design[2], machine.branch)
    inner, outer = linkage.dead_centres
    values |= {"inner_dead_centre_position": 1e3 * float(inner), "outer_dead_centre_position": 1e3 * float(outer)}
    values |= {name: float(row[f"{name}_deg"]) for name in ("inner_dead_centre", "outer_dead_centre")}
    return values


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_derivatives_are_those_of_differences_of_the_table_of_numbers(machine: Mechanism) -> None:
    for design in DESIGNS:
        table = sensitivity(machine, design).set_index("quantity")
        here = shown(machine, design)
        assert set(table.index) == set(here)
        for n, dimension in enumerate(DIMENSIONS):
            step = np.zeros(3)
            step[n] = 1e-7
            low, high = shown(machine, design - step), shown(machine, design + step)
            row: Any  # of numbers; the other types that a table may hold take mypy seconds
            for name, row in table.iterrows():
                if math.isnan(here[str(name)]):  # not defined
                    assert math.isnan(row["value"])
                    assert math.isnan(row[f"{dimension}_per_mm"])
                    continue
                assert row["value"] == pytest.approx(here[str(name)], rel=1e-11)
                around = [high[str(name)], low[str(name)]]
                if name in ("inner_dead_centre", "outer_dead_centre"):
                    around = list(np.degrees(np.unwrap(np.radians(around))))
                slope = (around[0] - around[1]) / 2e-4
                size = max(abs(row[f"{each}_per_mm"]) for each in DIMENSIONS)
                # Differences over 1e-4 mm of values known to 1e-13.
                assert row[f"{dimension}_per_mm"] == pytest.approx(
                    slope, rel=1e-5, abs=1e-5 * size + 1e-8 * abs(row["value"])
                )


def test_scaling_law_ties_the_percentages_together() -> None:
    """A ratio or an angle does not change when all dimensions grow by one percent. A length grows by one percent."""
    for design in DESIGNS:
        table = sensitivity(SMOOTH, design).set_index("quantity")
        totals = table[[f"{name}_percent" for name in DIMENSIONS]].sum(axis=1)
        expected = {"time_ratio": 0.0, "transmission_angle": 0.0, "rod_to_crank": 0.0, "rod_to_offset": 0.0}
        expected |= {"stroke": 1.0, "footprint": 2.0, "inner_dead_centre_position": 1.0, "peak_slider_speed": 1.0}
        for name, degree in expected.items():
            assert totals[name] == pytest.approx(degree, abs=1e-8), name


def test_change_for_the_tolerance_is_the_derivative_times_the_tolerance() -> None:
    design = DESIGNS[0]
    table = sensitivity(SMOOTH, design)
    for dimension, length in zip(DIMENSIONS, design, strict=True):
        tolerance = getattr(TOLERANCES, dimension)
        expected = 1e3 * (tolerance.absolute + tolerance.fraction * abs(length))
        np.testing.assert_allclose(table[f"{dimension}_tolerance"], table[f"{dimension}_per_mm"] * expected, rtol=1e-12)


def test_what_is_not_defined_is_nan() -> None:
    table = sensitivity(Mechanism(speed=1.0), np.array([0.04, 0.2, 0.0])).set_index("quantity")
    assert table["offset_percent"].isna().all()
    assert math.isinf(table.loc["rod_to_offset", "value"])  # type: ignore[arg-type]
    assert pd.isna(table.loc["rod_to_offset", [f"{name}_per_mm" for name in DIMENSIONS]]).all()
    assert table["crank_percent"].isna()["peak_torque"]  # zero without masses and loads
    assert table.loc["stroke", "crank_per_mm"] == pytest.approx(2.0, rel=1e-12)
    assert table.loc["inner_dead_centre", "crank_per_mm"] == 0.0


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_dead_centres_move_as_their_closed_forms(branch: Branch) -> None:
    r, l, e = 0.04, 0.2, 0.03
    sign = 1.0 if branch == "open" else -1.0
    table = sensitivity(Mechanism(speed=1.0, branch=branch), np.array([r, l, e])).set_index("quantity")
    outer = math.sqrt((l + r) ** 2 - e * e)
    row = table.loc["outer_dead_centre_position"]
    assert row["offset_per_mm"] == pytest.approx(-sign * e / outer, rel=1e-13)
    assert row["rod_per_mm"] == pytest.approx(sign * (l + r) / outer, rel=1e-13)
    turn = math.degrees(1.0 / outer) * 1e-3
    assert table.loc["outer_dead_centre", "offset_per_mm"] == pytest.approx(sign * turn, rel=1e-13)


def test_linkage_that_does_not_turn_is_refused() -> None:
    with pytest.raises(AssemblyError, match="for full rotation"):
        sensitivity(SMOOTH, np.array([0.25, 0.3, 0.1]))


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_both_sides_of_a_kink_are_those_of_one_sided_differences(machine: Mechanism) -> None:
    random = np.random.default_rng(43)
    for _ in range(3):
        crank = random.uniform(0.03, 0.08)
        design = np.array([crank, crank * random.uniform(1.5, 5.0), 0.0])
        for plain in (machine, dataclasses.replace(machine, acceleration=0.0, gravity=(0.0, 0.0), loads=())):
            table = sensitivity(plain, design).set_index("quantity")
            for name, quantity in QUANTITIES.items():
                row: Any = table.loc[name]
                if not math.isfinite(row["value"]):
                    continue

                # Three-point one-sided differences over 1e-3 mm: off by its square.
                steps = np.outer([0.0, 1.0, 2.0, -1.0, -2.0], [0.0, 0.0, 1e-6])
                value, *around = quantity.unit.factor * quantity.evaluate(plain, design + steps).values
                above = (-3.0 * value + 4.0 * around[0] - around[1]) / 2e-3
                below = (3.0 * value - 4.0 * around[2] + around[3]) / 2e-3
                size = abs(row["value"]) / (1e3 * crank)
                assert row["offset_per_mm"] == pytest.approx(above, rel=1e-5, abs=1e-5 * size), name
                assert row["offset_per_mm_below"] == pytest.approx(below, rel=1e-5, abs=1e-5 * size), name


def test_an_in_line_linkage_has_more_torque_with_an_offset_of_either_sign() -> None:
    machine = Mechanism(speed=10.0 * math.pi, slider_mass=1.0)
    table = sensitivity(machine, np.array([0.05, 0.16, 0.0])).set_index("quantity")
    torque = table.loc["peak_torque"]
    assert torque["offset_per_mm"] > 0.006
    assert torque["offset_per_mm_below"] == pytest.approx(-torque["offset_per_mm"], rel=1e-9)
    # What is rounding is zero, not -23.5 %.
    for name in ("mean_torque", "mean_power"):
        row = table.loc[name]
        assert row["value"] == 0.0
        assert all(row[f"{each}_per_mm{side}"] == 0.0 for each in DIMENSIONS for side in ("", "_below"))
    assert table.loc["rms_torque", "offset_per_mm"] == 0.0
    assert table.loc["stroke", "offset_per_mm"] == 0.0


def test_percentages_of_a_negative_offset_are_of_its_size() -> None:
    machine = Mechanism(speed=10.0 * math.pi, slider_mass=1.0)
    one, other = (sensitivity(machine, np.array([0.05, 0.16, e])).set_index("quantity") for e in (0.01, -0.01))
    for side in ("", "_below"):
        found = one.loc["peak_torque", f"offset_percent{side}"]
        assert other.loc["peak_torque", f"offset_percent{side}"] == pytest.approx(found, rel=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_what_vanishes_without_offset_grows_on_either_side_of_it(seed: int) -> None:
    random = np.random.default_rng(seed)
    crank, rod = random.uniform(0.02, 0.08), random.uniform(0.15, 0.4)
    machine = Mechanism(speed=random.uniform(10.0, 60.0), slider_mass=random.uniform(0.5, 3.0))
    rows = sensitivity(machine, np.array([crank, rod, 0.0])).set_index("quantity")
    small = 1e-6
    for name in ("peak_shaking_moment", "rms_shaking_moment"):
        row = rows.loc[name]
        below, above = (
            float(QUANTITIES[name].evaluate(machine, np.array([[crank, rod, offset]])).values[0])
            for offset in (-small, small)
        )
        assert row["offset_per_mm"] == pytest.approx(above / small * 1e-3, rel=1e-6)
        assert row["offset_per_mm_below"] == pytest.approx(-below / small * 1e-3, rel=1e-6)
        assert row["offset_per_mm"] > 0.0 > row["offset_per_mm_below"]
        assert row["crank_per_mm"] == row["rod_per_mm"] == row["crank_per_mm_below"] == row["rod_per_mm_below"] == 0.0
