"""The shipped press presses: its tool resists the end of the slow stroke, and the drive gives the work."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.linkage.loaded_stroke import loaded_stroke
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.optimise.job import load_job
from slidercrank.optimise.problem.constraint_violation import greatest_violation
from tests.optimise.problems import RUNS

PRESS = load_job(Path(__file__).parents[2] / "runs/press.toml").part(0)
LENGTHS = (0.0263, 0.126, 0.059)


def test_the_tool_resists_the_last_millimetres_and_the_drive_gives_the_work() -> None:
    design = np.array([*LENGTHS, 0.046, 0.053, 0.025])
    curves = PRESS.analyse(design).cycle(720)
    left = float(Linkage(*LENGTHS).dead_centres[1]) - curves["slider_position_m"]
    outward = curves["slider_velocity_m_s"] > 1e-6
    tool = curves["load_N"].where(outward) + 80.0  # less the seals
    assert tool[outward & (left > 0.0121)].abs().max() < 1e-9
    full = tool[outward & (left > 0.0011) & (left < 0.0099)]
    assert len(full) > 20
    assert full.to_numpy() == pytest.approx(-20e3)
    assert (curves["load_N"][curves["slider_velocity_m_s"] < -1e-6] == 80.0).all()
    power, energy = PRESS.evaluate([design], ["mean_power", "delivered_work"])[0]
    assert power > 0.0
    # 20 kN over 9 mm, ramps of 20 and 17 kN at the mean, and 80 N of seals over 120 mm.
    assert abs(energy) == pytest.approx(20e3 * 9e-3 + 10e3 * 2e-3 + 17e3 * 1e-3 + 80.0 * 2.0 * stroke(), rel=1e-6)


def test_the_slow_stroke_is_the_loaded_one() -> None:
    design = np.array([[*LENGTHS, 0.046, 0.053, 0.025]])
    assert loaded_stroke(PRESS.mechanism, design).tolist() == ["outward"]
    assert PRESS.slow_stroke == "outward"


def test_a_press_slowed_while_it_presses_needs_a_stronger_gearmotor() -> None:
    """The torque is the same but lasts longer.

    Averaged over the crank angle, both stay within 118 N m, the limit of a 0.37 kW gearmotor.
    """
    design, share = np.array([[*LENGTHS, 0.046, 0.053, 0.025]]), 0.5 * math.sqrt(0.5)
    limit = replace(next(c for c in PRESS.constraints if c.quantity == "rms_torque"), upper=118.0)
    profile = Harmonics(cosines=(-share,), sines=(-share,))  # half the speed at 45 deg
    even = replace(PRESS, constraints=(limit,))  # strength is that at a constant speed
    slowed = replace(even, mechanism=replace(PRESS.mechanism, speed_profile=profile))
    curves = slowed.analyse(design[0]).cycle(20_000).iloc[:-1]
    theta, torque = curves["crank_angle_rad"].to_numpy(), curves["torque_Nm"].to_numpy()
    time = 1.0 / profile.speed_ratio(theta)
    over_time, over_angle = (math.sqrt(np.average(torque**2, weights=each)) for each in (time, np.ones(len(time))))
    found = slowed.evaluate(design, ["rms_torque"])[0, 0]
    assert found == pytest.approx(over_time, rel=1e-4)  # the load turns sharply between samples
    assert over_angle < 105.0
    assert found > 134.0
    assert greatest_violation(even, design, [limit])[0] == 0.0
    assert greatest_violation(slowed, design, [limit])[0] == pytest.approx(found / 118.0 - 1.0, rel=1e-9)


def stroke() -> float:
    return float(Linkage(*LENGTHS).stroke)


@pytest.mark.parametrize("variant", [7, -3, "GM 40", None])
def test_a_variant_that_is_none_is_refused(variant: Any) -> None:
    press = load_job(RUNS / "press.toml")
    with pytest.raises(InputError, match="a variant must be one of 0 to 1, see `variants`; got"):
        press.part(variant)
    assert press.part(-1) == press.parts()[1]
