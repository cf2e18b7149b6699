"""Lengths from an exact travel or an exact angle of a swing: equalities to rounding, and every design is found."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.swing.closure import swings_without_dead_point
from slidercrank.model.swing.end_angles import greatest_pin_distance, swing_ends
from slidercrank.model.swing.swing import Swing
from slidercrank.model.swing.swing_types import Side
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Constraint, Objective, Range
from slidercrank.optimise.search.elimination import elimination_branches

WANTED = (Objective(quantity="swing_transmission_angle", sense="maximise"),)


def problem_of(of: str, branch: Branch, value: float, *, free: bool, rod: Range, swing: Swing) -> Problem:
    """Return a problem with one equality of a swing."""
    path = "start.angle" if of == "crank" else "start.place"
    item = Varying(name="motion.from", sets=((path, 1.0),), lower=swing.start - 0.2, upper=swing.start + 0.2)
    name = "actuator_travel" if of == "crank" else "swing_angle"
    return Problem(
        name="swing",
        mechanism=Mechanism(branch=branch, varying=(item,) if free else ()),
        crank=Range(lower=0.5, upper=1.5),
        rod=rod,
        offset=Range(lower=-0.8, upper=0.8),
        objectives=WANTED,
        constraints=(Constraint(quantity=name, lower=value, upper=value),),
        motion=replace(swing, follows=free),
    )


@pytest.mark.filterwarnings("ignore:lengths of designs must be in m")  # some of the sheet's own designs are as long
@pytest.mark.parametrize("of", ["crank", "slider"])
@pytest.mark.parametrize("free", [False, True])
def test_equalities_of_a_swing_hold_to_rounding_and_miss_no_design(of: str, free: bool) -> None:
    """Designs of a known travel or angle lie on a sheet, whose own designs have it to 1e-12."""
    random, met, found, targets = np.random.default_rng(31), 0, 0, set()
    for _ in range(24):
        branch: Branch = "open" if random.random() < 0.6 else "crossed"
        ways = random.choice([-1.0, 1.0])
        if of == "crank":
            start = random.uniform(-3.0, 3.0)
            swing = Swing(start=start, end=start + ways * random.uniform(0.3, 1.6), driver="slider")
        else:
            place = random.uniform(0.5, 2.5) * (1.0 if branch == "open" else -1.0)
            side: Side = "left" if random.random() < 0.5 else "right"
            swing = Swing(
                start=place,
                end=place + ways * random.uniform(0.2, 1.2),
                stated_for="slider",
                side=side,
                driver="slider",
            )
        fixed = random.random() < 0.3
        length = random.uniform(0.8, 3.0)
        rod = Range(lower=length, upper=length) if fixed else Range(lower=0.5, upper=3.0)
        name = "actuator_travel" if of == "crank" else "swing_angle"
        lower, upper = [0.5, rod.lower, -0.8], [1.5, rod.upper, 0.8]
        start_at = random.uniform(swing.start - 0.2, swing.start + 0.2, (400, 1))
        designs = np.concatenate([random.uniform(lower, upper, (400, 3)), *([start_at] if free else [])], axis=1)
        probe = problem_of(of, branch, 1.0, free=free, rod=rod, swing=swing)
        designs = designs[swings_without_dead_point(probe.mechanism, probe.motion or swing, designs)][:2]
        for design in designs:
            value = float(probe.evaluate(design, [name])[0])
            own = problem_of(of, branch, value, free=free, rod=rod, swing=swing)
            hits = 0
            for sheet in elimination_branches(own):
                assert sheet.eliminated == (name,)
                targets.add(sheet.steps[0].target)
                again = sheet.designs_at_points(sheet.points_of_designs(design[None]))
                hits += bool(np.allclose(again, design, rtol=1e-7, atol=1e-9))
                tried = sheet.designs_at_points(random.random((60, len(sheet.free))))
                tried = tried[np.isfinite(tried).all(axis=1)]
                tried = tried[swings_without_dead_point(own.mechanism, own.motion or swing, tried)]
                ends = swing_ends(own.mechanism, own.motion or swing, tried)
                tried = tried[
                    greatest_pin_distance(tried, [ends.start, ends.end]) < 0.995 * tried[:, 1]
                ]  # else it opens: no digits
                values = own.evaluate(tried, [name])[:, 0]
                true = np.abs(values / value - 1.0) < 1e-6  # others are of a spurious root, which the search refuses
                assert np.abs(values[true] / value - 1.0).max(initial=0.0) < 1e-12
                met += int(true.sum())
            assert hits >= 1, (swing, design)
            found += 1
    assert found >= 20
    assert met > 200
    assert targets >= ({"rod", "offset"} if of == "crank" else {"crank"})
