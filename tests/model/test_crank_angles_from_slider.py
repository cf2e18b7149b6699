"""Every crank angle for a slider position: there and back, counted by a sweep, refused where there is none."""

from __future__ import annotations

import contextlib
import math
import re
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.crank_angles_from_slider import CrankSolution, slider_ranges
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch
from tests.model.cases import Array, linkage_of, random_designs

INNER, OUTER = (float(position) for position in Linkage(0.06, 0.23, 0.07).dead_centres)


def short_rods(count: int, *, seed: int) -> Array:
    """Return designs (n, 3) that assemble at some crank angle, but do not turn fully."""
    random = np.random.default_rng(seed)
    crank = random.uniform(0.02, 0.15, count)
    rod, offset = crank * random.uniform(0.1, 1.6, count), crank * random.uniform(-1.4, 1.4, count)
    kept = (rod < crank + np.abs(offset)) & (crank + rod > 1.02 * np.abs(offset))
    return np.stack([crank, rod, offset], axis=1)[kept]


def swept_positions(linkage: Linkage) -> list[Array]:
    """Return slider positions along each arc of crank angles at which one linkage can be assembled, ends included."""
    crank, rod, offset = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    low, high = ((offset + sign * rod) / crank for sign in (-1.0, 1.0))
    least, most = math.asin(max(low, -1.0)), math.asin(min(high, 1.0))
    arcs = [(least, math.pi - least if high >= 1.0 else most)]
    if low > -1.0 and high < 1.0:
        arcs.append((math.pi - most, math.pi - least))
    elif low <= -1.0 and high < 1.0:
        arcs = [(math.pi - most, 2.0 * math.pi + most)]
    elif low <= -1.0:
        arcs = [(0.0, 2.0 * math.pi)]
    found = []
    for begin, end in arcs:
        # Denser towards the ends, where the position goes with the root of the angle.
        theta = begin + (end - begin) * 0.5 * (1.0 - np.cos(np.linspace(0.0, math.pi, 20_001)))
        along = np.sqrt(np.maximum(rod**2 - (offset - crank * np.sin(theta)) ** 2, 0.0))
        found.append(crank * np.cos(theta) + linkage.sign * along)
    return found


def turned(one: float, other: float) -> float:
    return abs(math.remainder(one - other, 2.0 * math.pi))


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_every_solution_gives_the_slider_motion_back(branch: Branch) -> None:
    random = np.random.default_rng(34)
    for row in random_designs(300, seed=35, least_margin=0.01):
        linkage, crank = linkage_of(row, branch), row[0]
        theta, speed = random.uniform(0.0, 2.0 * math.pi), random.uniform(-40.0, 40.0)
        at = linkage.at(theta, speed=speed, acceleration=random.uniform(-900.0, 900.0))
        if abs(linkage.at(theta, speed=1.0).slider_velocity) < 0.05 * crank:
            continue  # towards a dead centre the crank speed is as uncertain as the angle
        found = linkage.from_slider(
            at.slider_position, velocity=at.slider_velocity, acceleration=at.slider_acceleration
        )
        assert [each.stroke for each in found] == ["outward", "inward"]
        assert min(turned(each.crank_angle, theta) for each in found) < 1e-10
        for each in found:
            assert each.speed is not None
            assert each.acceleration is not None
            assert 0.0 <= each.crank_angle < 2.0 * math.pi
            back = linkage.at(each.crank_angle, speed=each.speed, acceleration=each.acceleration)
            assert back.slider_position == pytest.approx(float(at.slider_position), rel=1e-9)
            assert back.slider_velocity == pytest.approx(float(at.slider_velocity), rel=1e-9)
            size = crank * (each.speed**2 + abs(each.acceleration))
            assert back.slider_acceleration == pytest.approx(float(at.slider_acceleration), rel=1e-9, abs=1e-9 * size)
            # The stroke is that of a crank that turns counter-clockwise.
            outward = linkage.sign * linkage.at(each.crank_angle, speed=1.0).slider_velocity > 0.0
            assert outward == (each.stroke == "outward")


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_as_many_solutions_as_a_dense_sweep_finds(branch: Branch) -> None:
    random, counts = np.random.default_rng(36), []
    for row in short_rods(400, seed=37):
        linkage, size = linkage_of(row, branch), row[0] + row[1]
        position = random.uniform(-1.0, 1.0) * size
        if min(abs(position - end) for ends in slider_ranges(linkage) for end in ends) < 1e-4 * size:
            continue  # the sweep may step over two solutions next to a dead centre
        crossings = sum(int(np.sum(np.diff(swept > position))) for swept in swept_positions(linkage))
        found: tuple[CrankSolution, ...] = ()
        with contextlib.suppress(AssemblyError):
            found = linkage.from_slider(position)
        assert len(found) == crossings
        for each in found:
            back = linkage.at(each.crank_angle).slider_position
            assert back == pytest.approx(position, rel=1e-9, abs=1e-9 * size)
        counts.append(crossings)
    assert min(counts.count(number) for number in (0, 1, 2)) > 20


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_the_reach_is_that_of_a_dense_sweep(branch: Branch) -> None:
    counts = []
    for row in np.concatenate([short_rods(200, seed=38), random_designs(50, seed=39)]):
        linkage = linkage_of(row, branch)
        expected = sorted((float(swept.min()), float(swept.max())) for swept in swept_positions(linkage))
        # A top between two of the 20,001 angles is missed by the square of their distance; an end of an arc, by the
        # root of the rounding of its angle.
        np.testing.assert_allclose(slider_ranges(linkage), expected, rtol=0, atol=1e-6 * (row[0] + row[1]))
        counts.append(len(expected))
    assert min(counts.count(1), counts.count(2)) > 20


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("ulps", [-3, 0, 3])
def test_a_dead_centre_has_one_solution_without_a_speed(branch: Branch, ulps: int) -> None:
    for row in random_designs(50, seed=40):
        linkage = linkage_of(row, branch)
        for position, angle in zip(linkage.dead_centres, linkage.dead_centre_angles, strict=True):
            near = float(position) + ulps * 2.2e-16 * (row[0] + row[1])
            curvature = float(linkage.at(angle, speed=1.0).slider_acceleration)
            for motion in ({}, {"velocity": 0.0}, {"velocity": 0.0, "acceleration": 30.0 * curvature}):
                (found,) = linkage.from_slider(near, **motion)
                assert turned(found.crank_angle, float(angle)) < 1e-9
                assert found == CrankSolution(found.crank_angle, None, None, None)


def test_beside_a_dead_centre_there_are_two_solutions() -> None:
    linkage = Linkage(0.04, 0.064, 0.02)
    inner, outer = (float(position) for position in linkage.dead_centres)
    for position in (inner + 1e-12, outer - 1e-12):
        one, other = linkage.from_slider(position)
        assert 1e-6 < turned(one.crank_angle, other.crank_angle) < 1e-4
    for position in (inner - 1e-12, outer + 1e-12):
        with pytest.raises(AssemblyError, match="must be within reach"):
            linkage.from_slider(position)


def test_a_crank_longer_than_the_rod_has_its_folded_dead_centre_on_the_far_side() -> None:
    linkage = Linkage(0.1, 0.06, 0.01)
    (near, far) = slider_ranges(linkage)
    folded = -math.sqrt(0.04**2 - 0.01**2)
    assert near[1] == pytest.approx(folded, rel=1e-14)
    assert far[1] == pytest.approx(math.sqrt(0.16**2 - 0.01**2), rel=1e-14)
    (found,) = linkage.from_slider(folded, velocity=0.0)
    assert found.stroke is None
    assert linkage.at(found.crank_angle).slider_position == pytest.approx(folded, rel=1e-13)
    with pytest.raises(AssemblyError, match=r"of the open branch, -\S+ mm to -38\.\d+ mm or \S+ mm to 159\.\d+ mm"):
        linkage.from_slider(0.0)


@pytest.mark.parametrize(
    ("motion", "error", "words"),
    [
        ({"position": 0.3}, AssemblyError, "open branch, 154.919334 mm to 281.424945 mm; got 300 mm with crank 60 mm"),
        ({"position": -0.24}, AssemblyError, "move the position within reach, or change a length"),
        ({"position": math.nan}, InputError, "slider position must be finite; got nan"),
        ({"position": 0.24, "velocity": math.inf}, InputError, "slider velocity must be finite; got inf"),
        ({"position": [0.24, 0.25]}, InputError, "slider position must be one number"),
        ({"position": 0.24 + 1e-30j}, InputError, "slider position must be real"),
        ({"position": 0.24, "velocity": 1e300}, InputError, "give a smaller one"),
        ({"position": 0.24, "acceleration": 3.0}, InputError, "got acceleration 3 m/s^2 alone; add the velocity"),
        ({"position": OUTER, "velocity": -1.0}, InputError, "velocity must be 0 at the dead centre, position 281.42"),
        ({"position": OUTER, "velocity": 0.0, "acceleration": 1.0}, InputError, "acceleration must be negative or 0"),
        ({"position": INNER, "velocity": 0.0, "acceleration": -1.0}, InputError, "acceleration must be positive or 0"),
    ],
)
def test_a_slider_motion_that_no_crank_gives_is_refused(motion: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=re.escape(words)):
        Linkage(0.06, 0.23, 0.07).from_slider(**motion)


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_the_ends_of_the_reach_as_a_refusal_tells_them_are_in_reach(branch: Branch) -> None:
    for row in np.concatenate([short_rods(100, seed=43), random_designs(50, seed=44)]):
        linkage = linkage_of(row, branch)
        with pytest.raises(AssemblyError, match="must be within reach") as refused:
            linkage.from_slider(2.0 * (row[0] + row[1]))
        told = re.findall(r"(-?[\d.e-]+) mm", str(refused.value).partition("; got")[0])
        assert len(told) == 2 * len(slider_ranges(linkage))
        for end in told:
            assert linkage.from_slider(float(end) / 1e3)


def test_what_has_no_single_answer_is_refused() -> None:
    with pytest.raises(
        AssemblyError, match="leaves the crank angle undetermined; got position 0 mm with rod = crank = 50"
    ):
        Linkage(0.05, 0.05).from_slider(0.0)
    with pytest.raises(InputError, match=r"one linkage at a time; got an array of shape \(2,\)"):
        Linkage(0.05, [0.2, 0.3]).from_slider(0.2)
    with pytest.raises(InputError, match="got complex ones"):
        Linkage(0.05 + 1e-30j, 0.2).from_slider(0.2)


def test_rates_that_are_not_asked_for_are_none() -> None:
    linkage = Linkage(0.06, 0.23, 0.07)
    assert [(each.speed, each.acceleration) for each in linkage.from_slider(0.24)] == [(None, None)] * 2
    for each in linkage.from_slider(0.24, velocity=0.0):
        assert (each.speed, each.acceleration) == (0.0, None)
        assert math.copysign(1.0, each.speed or 0.0) == 1.0  # not -0
