"""The best phase and shift of a wanted motion against a search that knows nothing of the method."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.kinematics.target_motion import Freedom, Measure, TargetMotion, fit_target_motion
from slidercrank.model.linkage.linkage import Linkage
from tests.model.cases import Array, random_designs

DESIGNS = random_designs(40, seed=21)
ANGLES = np.sort(np.random.default_rng(2).uniform(0.0, 6.2, 24))
WANTED = 0.2 + 0.05 * np.cos(ANGLES - 0.3) + 0.01 * np.cos(2.0 * ANGLES)
# No linkage's motion: the points scatter, so that many of them compete for the greatest deviation.
WANTED = WANTED + 0.004 * np.random.default_rng(3).normal(size=24)


def target(phase: Freedom = "fixed", shift: Freedom = "fixed", positions: Array = WANTED) -> TargetMotion:
    return TargetMotion(crank_angles=tuple(ANGLES), positions=tuple(positions), phase=phase, shift=shift)


def measured(design: Array, branch: float, phase: Array, shift: Freedom, measure: Measure) -> Array:
    """Return the deviation at phases (p,), with the shift by its textbook formula."""
    crank, rod, offset = design
    theta = ANGLES + phase[:, None]
    distance = branch * crank * np.cos(theta) + np.sqrt(rod**2 - (offset - crank * np.sin(theta)) ** 2)
    d = distance - WANTED
    if measure == "rms":
        d = d - d.mean(axis=1)[:, None] if shift == "free" else d
        found: Array = np.sqrt(np.mean(d * d, axis=1))
        return found
    return np.asarray(0.5 * np.ptp(d, axis=1) if shift == "free" else np.abs(d).max(axis=1))


@pytest.mark.parametrize("branch", [1.0, -1.0])
@pytest.mark.parametrize("shift", ["fixed", "free"])
@pytest.mark.parametrize("measure", ["greatest", "rms"])
def test_no_phase_of_a_dense_scan_is_better(branch: float, shift: Freedom, measure: Measure) -> None:
    found = fit_target_motion(target("free", shift), branch, measure, DESIGNS)
    phases = np.linspace(-np.pi, np.pi, 4001)
    for n, design in enumerate(DESIGNS):
        scanned = measured(design, branch, phases, shift, measure)
        assert found.values[n] <= scanned.min() * (1.0 + 1e-12)
        # The scan misses the best phase by up to 8e-4 rad, across which a slider moves by a thousandth of its stroke.
        assert found.values[n] >= scanned.min() - 8e-4 * np.abs(np.diff(scanned)).max() / (phases[1] - phases[0])
        at = measured(design, branch, found.phase[n : n + 1], shift, measure)[0]
        assert found.values[n] == pytest.approx(at, rel=1e-12)


@pytest.mark.parametrize("measure", ["greatest", "rms"])
def test_fixed_phase_and_shift_are_none(measure: Measure) -> None:
    found = fit_target_motion(target(), 1.0, measure, DESIGNS)
    assert np.all(found.phase == 0.0)
    assert np.all(found.shift == 0.0)
    for n, design in enumerate(DESIGNS):
        at = measured(design, 1.0, np.zeros(1), "fixed", measure)[0]
        assert found.values[n] == pytest.approx(at, rel=1e-13)


@pytest.mark.parametrize("measure", ["greatest", "rms"])
def test_motion_of_a_linkage_turned_and_moved_is_recognised(measure: Measure) -> None:
    for crank, rod, offset in DESIGNS[:10]:
        linkage = Linkage(crank, rod, offset)
        positions = linkage.at(ANGLES + 0.7).slider_position - 0.03
        found = fit_target_motion(target("free", "free", positions), 1.0, measure, np.array([[crank, rod, offset]]))
        assert found.values[0] < 1e-14
        assert math.remainder(found.phase[0] - 0.7, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-7)
        assert found.shift[0] == pytest.approx(-0.03, abs=1e-8)


def test_crossed_branch_counts_distances_outward() -> None:
    crank, rod, offset = DESIGNS[0]
    positions = -Linkage(crank, rod, offset, "crossed").at(ANGLES).slider_position
    assert fit_target_motion(target(positions=positions), -1.0, "greatest", DESIGNS[:1]).values[0] < 1e-15


def test_freedom_never_makes_it_worse() -> None:
    measures: tuple[Measure, ...] = ("greatest", "rms")
    for measure in measures:
        fixed = fit_target_motion(target(), 1.0, measure, DESIGNS).values
        turned = fit_target_motion(target(phase="free"), 1.0, measure, DESIGNS).values
        moved = fit_target_motion(target(shift="free"), 1.0, measure, DESIGNS).values
        both = fit_target_motion(target("free", "free"), 1.0, measure, DESIGNS).values
        slack = 1.0 + 1e-12
        assert np.all(turned <= fixed * slack)
        assert np.all(moved <= fixed * slack)
        assert np.all(both <= np.minimum(turned, moved) * slack)


@pytest.mark.parametrize(
    ("angles", "positions", "message"),
    [
        ((0.0, 1.0, 2.0), (1.0, 2.0), "as many positions as crank angles"),
        ((0.0, 1.0), (1.0, 2.0), "at least three"),
        ((0.0, 1.0, math.nan), (1.0, 2.0, 3.0), "finite throughout"),
        ((0.0, 2.0, 1.0), (1.0, 2.0, 3.0), "must increase; got 1 after 2"),
        ((0.0, 1.0, 6.3), (1.0, 2.0, 3.0), "less than one turn, 360 deg; got 360.963 deg"),
    ],
)
def test_points_that_make_no_motion_are_refused(
    angles: tuple[float, ...], positions: tuple[float, ...], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        TargetMotion(crank_angles=angles, positions=positions)


def test_wrong_words_and_linkages_that_do_not_turn_are_refused() -> None:
    with pytest.raises(InputError, match="phase of a target motion must be 'fixed' or 'free'; got 'loose'"):
        target("loose")  # type: ignore[arg-type]
    with pytest.raises(AssemblyError, match="for full rotation"):
        fit_target_motion(target(), 1.0, "rms", np.array([[0.1, 0.1, 0.05]]))
