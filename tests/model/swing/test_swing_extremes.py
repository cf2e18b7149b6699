"""Extremes of the curves of a swing, and what each tolerance adds to its error, against dense samples."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.machine.mechanism import Clearances, Tolerance, Tolerances
from slidercrank.model.swing.forces import swing_curves
from slidercrank.model.swing.request_and_summary import error_shares
from slidercrank.model.swing.swing_cycle import SwingCycle
from slidercrank.objectives.tables.sensitivity import sensitivity
from tests.model.swing.swings import random_swings

CURVES = ("slider_position", "slider_velocity", "drive", "crank_pin", "guide", "driven_angle")


@pytest.mark.parametrize("friction", [False, True])
def test_extremes_of_curves_are_those_of_dense_samples_of_both_ways(friction: bool) -> None:
    share, backs = np.linspace(0.0, 1.0, 4001), set()
    for mechanism, linkage, swing in random_swings(6, seed=83, friction=friction):
        over = SwingCycle(mechanism, linkage, swing)
        if over.first_lockable_point() is not None:
            continue
        ways = [swing_curves(mechanism, linkage, swing, share, back=back) for back in (False, True)]
        for name in CURVES:
            values = np.concatenate([getattr(way, name) for way in ways])
            span = float(np.ptp(values)) or 1.0
            least, most = over.range_of_curve(name)
            assert least.value <= values.min() + 1e-9 * span, name
            assert most.value >= values.max() - 1e-9 * span, name
            for at in (least, most):
                there = swing_curves(mechanism, linkage, swing, np.array([at.share]), back=at.back)
                assert getattr(there, name)[0] == pytest.approx(at.value, abs=1e-9 * span)
                assert there.crank_angle[0] == pytest.approx(at.crank_angle)
                backs.add(at.back)
    assert backs == {False, True}


def test_sources_add_up_to_the_error_of_the_driven_side() -> None:
    random = np.random.default_rng(5)
    for mechanism, linkage, swing in random_swings(20, seed=84):
        off = [Tolerance(absolute=float(value)) for value in random.uniform(0.0, 1e-3, 4)]
        gap = random.uniform(0.0, 1e-4, 4)
        gaps = Clearances(crank_pivot=gap[0], crank_pin=gap[1], slider_pin=gap[2], guide=gap[3])
        machine = replace(
            mechanism,
            tolerances=Tolerances(crank=off[0], rod=off[1], offset=off[2], crank_angle=off[3], clearances=gaps),
        )
        swing = replace(swing, actuator_tolerance=1e-3 if swing.driver == "slider" else 0.0)
        at = swing_curves(machine, linkage, swing, random.uniform(0.0, 1.0, 1))
        shares = error_shares(machine, linkage, swing, float(at.crank_angle[0]))
        assert sum(share.error for share in shares) == pytest.approx(float(at.driven_error[0]), rel=1e-12)
        names = [share.source for share in shares]
        assert ("actuator" in names, "crank angle" in names) == (swing.driver == "slider", swing.driver == "crank")


@pytest.mark.slow
def test_sensitivity_of_a_swing_is_the_slope_of_its_quantities() -> None:
    for mechanism, linkage, swing in random_swings(3, seed=85):
        at = np.array([float(linkage.crank), float(linkage.rod), float(linkage.offset)])
        rows = sensitivity(mechanism, at, swing).set_index("quantity")
        assert "stroke" not in rows.index
        for n, name in enumerate(("crank", "rod", "offset")):
            step = 1e-7 * at[1] * np.eye(3)[n]
            near = [sensitivity(mechanism, at + side * step, swing).set_index("quantity") for side in (-1.0, 1.0)]
            for quantity in ("actuator_travel", "swing_transmission_angle", "swing_energy"):
                value = rows.value[quantity]
                slope = (near[1].value[quantity] - near[0].value[quantity]) / (2e3 * step[n])
                assert rows[f"{name}_per_mm"][quantity] == pytest.approx(slope, rel=1e-4, abs=1e-6 * abs(value))
        assert all(math.isfinite(value) for value in rows.crank_per_mm.dropna())
