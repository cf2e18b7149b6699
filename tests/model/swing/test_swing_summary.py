"""A swing in numbers: energy balance, peaks of dense sweeps, holding, the published support, refusals."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction, Pin, RigidLink
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.model.swing.forces import swing_curves
from slidercrank.model.swing.request_and_summary import summarise_swing
from slidercrank.model.swing.swing import Swing, dead_point_angles, require_swing, slow_swing
from slidercrank.model.swing.swing_types import Law
from tests.model.bodies import bodies
from tests.model.swing.swings import random_swings

TABLE = Path(__file__).parents[2] / "data" / "position_error_table1.csv"
COLUMN = Mechanism(
    crank=RigidLink(mass=180.0),
    rod=RigidLink(mass=220.0),
    slider_mass=400.0,
    gravity=(0.0, -9.81),
    tolerances=Tolerances(crank=Tolerance(fraction=1e-3), rod=Tolerance(fraction=1e-3)),
)
SUPPORT = Linkage(1.4, 1.8, -0.05)
OVER = Swing(start=math.radians(11.16), end=math.radians(101.16), driver="slider")


@pytest.mark.slow
def test_energy_of_the_drive_is_what_is_stored_and_done() -> None:
    """Potential energy of bodies and springs, work on a force and a table in closed form, change of kinetic energy."""
    random = np.random.default_rng(3)
    for drawn, linkage, swing in random_swings(120, seed=21):
        knots = np.sort(random.uniform(0.0, 0.5, 4))
        table = PositionTable(positions=tuple(knots.tolist()), forces=tuple(random.uniform(-300.0, 300.0, 4).tolist()))
        spring = Spring(stiffness=random.uniform(0.0, 2000.0), free_position=random.uniform(0.0, 0.3))
        force = float(random.uniform(-200.0, 200.0))
        loads = (StrokeForce(outward=force, inward=force), spring, table)
        machine = replace(drawn, loads=loads)
        own = require_swing(machine, linkage, swing)
        found = summarise_swing(machine, linkage, swing)
        ends = swing_curves(machine, own, swing, np.array([0.0, 1.0]))
        sizes = np.array([float(own.crank), float(own.rod), float(own.offset)])
        parts = bodies(machine, sizes)
        energy, scale = np.zeros(2), 0.0
        for i in (0, 1):
            theta, w = float(ends.crank_angle[i]), float(ends.crank_speed[i])
            for part in parts.values():
                h = 1e-30j
                x, y, turn = (complex(f(theta + h)) for f in (part.x, part.y, part.turn))
                energy[i] -= part.mass * (machine.gravity[0] * x.real + machine.gravity[1] * y.real)
                speeds = [value.imag / 1e-30 * w for value in (x, y, turn)]
                energy[i] += 0.5 * part.mass * (speeds[0] ** 2 + speeds[1] ** 2) + 0.5 * part.inertia * speeds[2] ** 2
            out = own.sign * float(ends.slider_position[i])
            energy[i] += 0.5 * spring.stiffness * (out - spring.free_position) ** 2 - force * out
            scale = max(scale, abs(energy[i]))
        a, b = (own.sign * float(x) for x in ends.slider_position)
        low, high = min(a, b), max(a, b)
        inner = knots[(knots > low) & (knots < high)]
        points = np.array([low, *inner, high])
        energy[1] -= math.copysign(1.0, b - a) * float(np.trapezoid(np.interp(points, knots, table.forces), points))
        wanted = energy[1] - energy[0]
        size = 1e-10 * (scale + 1.0)
        assert found.energy_forward == pytest.approx(wanted, rel=1e-10, abs=size)
        assert found.energy_back == pytest.approx(-wanted, rel=1e-10, abs=size)


@pytest.mark.slow
def test_peaks_are_those_of_a_dense_sweep() -> None:
    share = np.linspace(0.0, 1.0, 20_001)
    for machine, linkage, swing in random_swings(25, seed=22, friction=True):
        found = summarise_swing(machine, linkage, swing)
        own = require_swing(machine, linkage, swing)
        ways = [swing_curves(machine, own, swing, share, back=back) for back in (False, True)]
        drive = np.concatenate([np.abs(way.drive) for way in ways])
        if np.isnan(drive).any():
            assert found.locked is not None
            continue
        assert found.locked is None
        # Not less than the sweep, not far more (it misses the edges of jumps), and taken on where it is said to be.
        peak = found.peak_drive
        assert drive.max() * (1.0 - 1e-12) <= abs(peak.value) <= drive.max() * (1.0 + 1e-3)
        assert swing_curves(machine, own, swing, np.array([peak.share]), back=peak.back).drive[0] == peak.value
        angle = min(float(way.driven_angle.min()) for way in ways)
        assert found.least_transmission.value == pytest.approx(angle, abs=1e-7)
        if found.peak_power is not None:
            power = max(float(np.abs(way.power).max()) for way in ways)
            assert power * (1.0 - 1e-12) <= abs(found.peak_power.value) <= power * (1.0 + 1e-3)


def test_energy_with_every_load_is_that_of_a_fine_sum() -> None:
    """The trapezoidal rule on 100,000 steps, of loads from dead centres, in one stroke only, in cylinders."""
    share = np.linspace(0.0, 1.0, 100_001)
    cylinder = Compressor(bore=0.05, low=1e5, high=7e5, clearance=0.1, compression_exponent=1.3, expansion_exponent=1.2)
    for drawn, linkage, swing in random_swings(14, seed=24):
        turns = bool(linkage.rotates_fully)
        machine = replace(drawn, loads=(*drawn.loads, cylinder)) if turns else drawn
        found = summarise_swing(machine, linkage, swing)
        curves = swing_curves(machine, require_swing(machine, linkage, swing), swing, share)
        summed = float(np.trapezoid(curves.drive * curves.rate, share))
        size = float(np.abs(curves.drive * curves.rate).max())
        assert found.energy_forward == pytest.approx(summed, abs=2e-5 * size)


def test_friction_costs_the_energy_that_both_ways_do_not_give_back() -> None:
    for machine, linkage, swing in random_swings(25, seed=23, friction=True):
        still = replace(machine, loads=())
        found = summarise_swing(still, linkage, slow_swing(swing))
        if found.locked is not None:
            continue
        assert found.energy_forward + found.energy_back > 0.0
        free = summarise_swing(replace(still, friction=Friction()), linkage, slow_swing(swing))
        assert free.energy_forward + free.energy_back == pytest.approx(0.0, abs=1e-9 * abs(free.energy_forward) + 1e-12)
        assert free.stored == found.stored
        if found.efficiency is not None:
            assert 0.0 < found.efficiency < 1.0


def test_a_column_stands_where_the_publication_says() -> None:
    """Table 1 of Chetana and Vineeth Kumar, printed to 0.01 mm; the offset is the mirror image of theirs."""
    with TABLE.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    own = require_swing(COLUMN, SUPPORT, OVER)
    angles = np.radians([float(row["crank_angle_deg"]) for row in rows])
    printed = np.array([float(row["slider_position_mm"]) for row in rows])
    found = summarise_swing(COLUMN, SUPPORT, OVER)
    assert (1e3 * np.array(found.slider_positions)).tolist() == pytest.approx([printed[0], printed[-1]], abs=0.03)
    places = own.at(angles).slider_position
    share = (places - places[0]) / (places[-1] - places[0])
    curves = swing_curves(COLUMN, own, OVER, share)
    np.testing.assert_allclose(curves.crank_angle, angles, rtol=0, atol=1e-12)
    np.testing.assert_allclose(1e3 * curves.slider_position, printed, rtol=0, atol=0.03)


def test_a_weight_on_a_massless_linkage_is_held_by_the_law_of_cosines() -> None:
    """The slider's force on a crank that carries a weight at its end: P x' = m g r cos(theta)."""
    machine = Mechanism(crank=RigidLink(mass=50.0, centre=1.4), gravity=(0.0, -9.81))
    found = summarise_swing(machine, SUPPORT, OVER)
    for force, degrees in ((found.drive_start[0], 11.16), (found.drive_end[0], 101.16)):
        theta = math.radians(degrees)
        phi = math.asin((-0.05 - 1.4 * math.sin(theta)) / 1.8)
        slope = -1.4 * math.sin(theta - phi) / math.cos(phi)
        assert force == pytest.approx(50.0 * 9.81 * 1.4 * math.cos(theta) / slope, rel=1e-12)
    assert not found.holds
    held = summarise_swing(replace(machine, friction=Friction(guide=8.0)), SUPPORT, OVER)
    assert held.holds


def test_dead_points_are_where_the_slider_turns() -> None:
    random = np.random.default_rng(4)
    for _ in range(200):
        r, l = random.uniform(0.1, 1.0, 2)
        linkage = Linkage(r, l, random.uniform(-1.0, 1.0) * (r + l), "open" if random.random() < 0.5 else "crossed")
        found = dead_point_angles(linkage)
        assert found
        for angle in found:
            at = linkage.at(angle, speed=1.0)
            assert abs(float(at.slider_velocity)) < 1e-7
        if bool(linkage.rotates_fully):
            inner, outer = (float(x) for x in linkage.dead_centre_angles)
            known = sorted(math.remainder(a, 2.0 * math.pi) for a in (inner, outer))
            assert sorted(math.remainder(a, 2.0 * math.pi) for a in found) == pytest.approx(known, abs=1e-9)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"start": 1.0, "end": 1.0}, "less than a turn apart"),
        ({"start": 0.0, "end": 2.0 * math.pi}, "less than a turn apart"),
        ({"start": math.nan, "end": 1.0}, "finite"),
        ({"start": 0.0, "end": math.inf}, "finite"),
        ({"start": 0.0, "end": 1.0, "driver": "rod"}, "driver must be 'crank' or 'slider'"),
        ({"start": 0.0, "end": 1.0, "law": "fast"}, "law must be"),
        ({"start": 0.0, "end": 1.0, "law": "harmonic"}, "any other swing must have one"),
        ({"start": 0.0, "end": 1.0, "duration": 2.0}, "a slow swing must have no duration"),
        ({"start": 0.0, "end": 1.0, "law": "harmonic", "duration": 0.0}, "positive"),
        ({"start": 0.0, "end": 1.0, "law": "harmonic", "duration": 1e300}, "check the unit"),
        ({"start": 0.0, "end": 1.0, "law": "harmonic", "duration": 1e-155}, "check the unit"),
        ({"start": None, "end": 1.0}, "must consist of numbers"),
        ({"start": "1", "end": 1.0}, "must consist of numbers"),
        ({"start": 0.0, "end": 1.0, "actuator_tolerance": -1.0}, "zero or more"),
        ({"start": 0.0, "end": 1.0, "actuator_tolerance": 1e-3}, "needs a slider that drives"),
    ],
)
def test_swings_that_are_none_are_refused(given: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        Swing(**given)  # type: ignore[arg-type]


def test_swings_that_cannot_be_made_are_refused() -> None:
    short = Linkage(1.4, 1.0, 0.2)
    with pytest.raises(AssemblyError, match="close over the whole swing"):
        summarise_swing(COLUMN, short, replace(OVER, driver="crank"))
    with pytest.raises(InputError, match=r"dead point|dead points"):
        summarise_swing(COLUMN, SUPPORT, replace(OVER, start=-0.5))
    with pytest.raises(InputError, match="same branch"):
        summarise_swing(replace(COLUMN, branch="crossed"), SUPPORT, OVER)
    with pytest.raises(InputError, match="one linkage is possible at a time"):
        summarise_swing(COLUMN, Linkage([1.4, 1.5], 1.8, -0.05), OVER)
    spring = Spring(stiffness=100.0, datum="inner dead centre")
    with pytest.raises(InputError, match="measure it from the crank pivot"):
        summarise_swing(replace(COLUMN, loads=(spring,)), short, Swing(start=0.0, end=0.3))


@pytest.mark.parametrize("law", ["slow", "harmonic", "trapezoid", "constant"])
@pytest.mark.parametrize("near", [3.0, 0.3, 1e-2, 1e-4])
def test_energy_near_a_dead_point_is_that_of_the_potential(near: float, law: Law) -> None:
    """The slider's force grows as the inverse root of the way from the dead point; its work does not."""
    machine = Mechanism(crank=RigidLink(mass=2.0), rod=RigidLink(mass=3.0), slider_mass=4.0, gravity=(0.0, -9.81))
    linkage = Linkage(0.04, 0.1, 0.01)
    dead = min(dead_point_angles(linkage), key=abs)
    duration = None if law == "slow" else 40.0
    swing = Swing(start=dead + math.radians(near), end=math.radians(80.0), driver="slider", law=law, duration=duration)
    found = summarise_swing(machine, linkage, swing)
    heights = [
        sum(part.mass * float(part.y(angle)) for part in bodies(machine, np.array([0.04, 0.1, 0.01])).values())
        for angle in (swing.start, swing.end)
    ]
    wanted = 9.81 * (heights[1] - heights[0])
    assert found.stored == pytest.approx(wanted, rel=1e-8)
    if law != "constant":  # which moves at the ends
        assert found.energy_forward == pytest.approx(wanted, rel=1e-7)
        assert found.energy_back == pytest.approx(-wanted, rel=1e-7)
    assert found.efficiency == pytest.approx(1.0, abs=1e-9)


def test_efficiency_is_of_friction_alone() -> None:
    """Loads that differ between the ways and moving ends do not count; none where nothing is driven."""
    column = replace(COLUMN, loads=(StrokeForce(outward=100.0, inward=600.0),))
    for machine in (COLUMN, column):
        for law, duration in (("slow", None), ("constant", 0.5), ("harmonic", 1.0)):
            swing = replace(OVER, law=law, duration=duration)  # type: ignore[arg-type]
            assert summarise_swing(machine, SUPPORT, swing).efficiency == pytest.approx(1.0, abs=1e-9)
            rubbed = summarise_swing(replace(machine, friction=Friction(guide=0.1)), SUPPORT, swing).efficiency
            assert rubbed is not None
            assert 0.5 < rubbed < 1.0
    even = Mechanism(crank=RigidLink(mass=1.0, centre=0.5), gravity=(0.0, -9.81))
    for driver in ("crank", "slider"):
        swing = Swing(start=math.radians(10.0), end=math.radians(170.0), driver=driver)
        found = summarise_swing(even, Linkage(0.5, 1.5), swing)
        assert found.stored == found.energy_forward == 0.0
        assert found.efficiency is None


def test_a_place_that_may_lock_leaves_peaks_undefined() -> None:
    pin = Pin(radius=0.02, coefficient=0.5)
    machine = replace(COLUMN, friction=Friction(crank_pivot=pin, crank_pin=pin))
    linkage = Linkage(0.1, 0.3)
    found = summarise_swing(machine, linkage, Swing(start=math.radians(2.0), end=math.radians(60.0), driver="slider"))
    assert found.locked is not None
    bend = math.sin(found.locked.crank_angle + math.asin(0.1 * math.sin(found.locked.crank_angle) / 0.3))
    assert found.locked.share == 0.0
    assert bend < 0.3
    assert math.isnan(found.peak_drive.value)
    assert math.isnan(found.energy_forward)
    assert found.efficiency is None
    later = summarise_swing(machine, linkage, Swing(start=math.radians(60.0), end=math.radians(2.0), driver="slider"))
    assert later.locked is not None
    theta = later.locked.crank_angle
    edge = math.asin(math.sin(theta + math.asin(0.1 * math.sin(theta) / 0.3)))
    assert edge == pytest.approx(math.asin(0.01 / 0.3) + math.asin(0.02 / 0.1), abs=1e-9)


def test_a_dashpot_holds_nothing_and_takes_nothing_slowly() -> None:
    found = summarise_swing(Mechanism(loads=(Viscous(coefficient=100.0),)), SUPPORT, OVER)
    assert not found.holds
    assert (found.peak_drive.value, found.drive_start, found.stored, found.efficiency) == (0.0, (0.0, 0.0), 0.0, None)
    moved = summarise_swing(
        Mechanism(loads=(Viscous(coefficient=100.0),)), SUPPORT, replace(OVER, law="harmonic", duration=1.0)
    )
    assert moved.energy_forward > 0.0
    assert not moved.holds


def test_crank_and_rod_on_each_other_are_refused() -> None:
    folded = Linkage(0.06, 0.06)
    asked = Swing(start=math.radians(100.0), end=math.radians(150.0), driver="slider")
    with pytest.raises(InputError, match="both folded"):
        summarise_swing(COLUMN, folded, asked)
    other = summarise_swing(COLUMN, folded, replace(asked, start=math.radians(20.0), end=math.radians(70.0)))
    assert math.isfinite(other.peak_drive.value)


@pytest.mark.parametrize("driver", ["crank", "slider"])
def test_a_linkage_that_weighs_nothing_takes_nothing(driver: str) -> None:
    found = summarise_swing(Mechanism(), SUPPORT, replace(OVER, driver=driver))  # type: ignore[arg-type]
    assert found.peak_drive.value == 0.0
    assert found.energy_forward == found.stored == 0.0
    assert found.efficiency is None
    assert found.position_error is None
    assert found.peak_power is None
