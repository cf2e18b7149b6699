"""Swings by places of the slider and by a free start, against the same ones by two crank angles."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.kinematics.position import motion
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.swing.forces import pin_distance_from_crank_line
from slidercrank.model.swing.law import law_spline_pieces, travel_speed_acceleration
from slidercrank.model.swing.request_and_summary import summarise_swing
from slidercrank.model.swing.swing import Swing, swing_between_crank_angles
from slidercrank.objectives.tables.swing_columns import swing_quantities
from tests.model.cases import Array
from tests.model.swing.swings import Case, random_points, random_swings
from tests.objectives.richardson import derivatives

TOLERANCES = Tolerances(crank=Tolerance(fraction=1e-3), rod=Tolerance(absolute=2e-4))


def by_places(case: Case) -> Case | None:
    """Return the swing stated by slider positions; None where its ends are on two sides of a dead point."""
    machine, linkage, swing = case
    theta = np.array([swing.start, swing.end])
    sine, cosine = np.sin(theta), np.cos(theta)
    m = motion(sine, cosine, linkage.crank, linkage.rod, linkage.offset, linkage.sign)
    side = np.sign(pin_distance_from_crank_line(sine, cosine, m))
    middle = 0.5 * (swing.start + swing.end)
    if side[0] != side[1] or abs(m.x[1] - m.x[0]) < 1e-3 or abs(middle) > 1.5:
        return None
    first, last = m.x.tolist()
    return (
        machine,
        linkage,
        replace(swing, start=first, end=last, stated_for="slider", side="left" if side[0] > 0 else "right"),
    )


def cases(count: int, seed: int) -> list[tuple[Case, Case]]:
    """Return swings by angles and by places, loads counted from the crank pivot."""
    found = []
    for case in random_swings(6 * count, seed=seed):
        if any(getattr(load, "datum", "").endswith("dead centre") for load in case[0].loads):
            continue
        other = by_places(case)
        if other is not None:
            machine = replace(case[0], tolerances=TOLERANCES)
            found.append(((machine, *case[1:]), (machine, *other[1:])))
    assert len(found) >= count
    return found[:count]


def design_of(linkage: Linkage) -> Array:
    return np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])


def test_places_of_the_slider_state_the_same_swing() -> None:
    """Both drivers, both sides, both branches; whole turns of the crank do not count."""
    seen = set()
    for (machine, linkage, angles), (_, _, places) in cases(30, seed=21):
        made = swing_between_crank_angles(machine, linkage, places)
        off = [math.remainder(a - b, 2.0 * math.pi) for a, b in ((made.start, angles.start), (made.end, angles.end))]
        assert np.abs(off).max() < 1e-9
        if abs(made.start - angles.start) > 1.0:
            continue  # a spring on the crank counts turns
        found, wanted = summarise_swing(machine, linkage, places), summarise_swing(machine, linkage, angles)
        assert found.peak_drive.value == pytest.approx(wanted.peak_drive.value, rel=1e-7)
        assert found.energy_forward == pytest.approx(wanted.energy_forward, rel=1e-7, abs=1e-7)
        assert found.travel == pytest.approx(abs(places.end - places.start), rel=1e-12)
        seen.add((places.driver, places.side, machine.branch))
    assert len(seen) >= 6


@pytest.mark.slow
@pytest.mark.parametrize("of", ["slider", "crank"])
def test_quantities_and_slopes_of_many_designs(of: str) -> None:
    """Against single designs, and extrapolated differences: the ends move with the lengths, or with a free start."""
    misses, names = [], set()
    for (machine, linkage, angles), (_, _, places) in cases(8, seed=22):
        swing = places if of == "slider" else replace(angles, follows=True)
        path = "start.place" if of == "slider" else "start.angle"
        item = Varying(name="motion.from", sets=((path, 1.0),), lower=swing.start - 0.1, upper=swing.start + 0.1)
        free = replace(machine, varying=(item,))
        design = design_of(linkage)
        wide = np.concatenate([design, [[swing.start]]], axis=1)
        one = summarise_swing(machine, linkage, swing)
        for quantity in swing_quantities(swing):
            if quantity.unmet_need(machine, "equal"):
                continue
            value = quantity.evaluate(machine, design).values[0]
            assert quantity.evaluate(free, wide).values[0] == pytest.approx(value, rel=1e-12)
            if quantity.name == "swing_angle":
                assert value == pytest.approx(one.swing_angle, rel=1e-12)
            if quantity.name.startswith("peak_actuator_") and "power" not in quantity.name:
                assert value == pytest.approx(abs(one.peak_drive.value), rel=1e-9)

            def function(displaced: Array, _: object, quantity: object = quantity, free: Mechanism = free) -> Array:
                return quantity.evaluate(free, displaced).values  # type: ignore[attr-defined, no-any-return]

            steps = np.array([[*([1e-3 * float(linkage.crank)] * 3), 1e-3]]) * (0.3 if of == "slider" else 1.0)
            expected, _ = derivatives(function, wide, steps)
            found = quantity.evaluate(free, wide, gradients=True)
            assert found.gradients is not None
            if not np.isfinite(expected).all():
                continue
            size = np.abs(expected).max() + 1e-9
            misses.append((float(np.abs(found.gradients - expected).max() / size), quantity.name, swing.driver))
            narrow = quantity.evaluate(machine, design, gradients=True).gradients
            assert narrow == pytest.approx(found.gradients[:, :3], rel=1e-9, abs=1e-12 * size)
            names.add(quantity.name)
    misses.sort()
    assert misses[-1][0] < 1e-6, misses[-3:]
    assert len(names) >= 9


def test_places_that_no_linkage_reaches_are_refused() -> None:
    machine, linkage = Mechanism(), Linkage(0.1, 0.3, 0.02)
    for start, end, words in ((0.25, 0.45, "between 200 and 400 mm"), (-0.35, 0.3, "crossed branch there")):
        with pytest.raises(AssemblyError, match=words):
            summarise_swing(machine, linkage, Swing(start=start, end=end, stated_for="slider"))
    with pytest.raises(InputError, match="two different slider positions"):
        Swing(start=0.3, end=0.3, stated_for="slider")


def test_a_table_of_motion_is_the_complete_cubic_spline() -> None:
    random = np.random.default_rng(5)
    for _ in range(20):
        points = random_points(random)
        t, s = np.array(points).T
        peer, share = CubicSpline(t, s, bc_type="clamped"), np.linspace(0.0, 1.0, 301)
        for order, found in enumerate(travel_speed_acceleration("table", share, law_spline_pieces(points))):
            assert found == pytest.approx(peer(share, order), abs=1e-11)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (((0.0, 0.0), (1.0, 1.0)), "at least three points"),
        (((0.0, 0.0), (0.5, 0.6), (0.4, 0.8), (1.0, 1.0)), "with increasing times"),
        (((0.0, 0.0), (0.4, 0.98), (0.5, 0.99), (1.0, 1.0)), "must not reverse"),
        (((0.0, 0.0), (0.4, 0.5), (0.9, 1.0)), "end with 1, 1"),
    ],
)
def test_tables_of_motion_that_are_none_are_refused(points: tuple[tuple[float, float], ...], words: str) -> None:
    with pytest.raises(InputError, match=words):
        Swing(start=0.0, end=1.0, law="table", duration=1.0, points=points)
