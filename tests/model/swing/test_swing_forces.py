"""Forces over a swing: against virtual work, and against the nine equations of the three bodies."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction, Pin, RigidLink
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.model.swing.forces import SwingCurves, swing_curves
from slidercrank.model.swing.swing import Swing, require_swing
from tests.model.bodies import bodies
from tests.model.cases import Array
from tests.model.contour import motion_in_time
from tests.model.swing.swings import random_swings
from tests.model.virtual_work import crank_torque, drive_torque, outward_motion, path, slider_load

SHARES = np.array([0.0, 0.07, 0.31, 0.5, 0.88, 1.0])
SLOW = 1e-200
pytestmark = pytest.mark.filterwarnings("ignore:invalid value encountered in sqrt")  # dead centres that are not there


def moving(machine: Mechanism, curves: SwingCurves, i: int, way: float) -> Mechanism:
    """Return the machine with the crank's speed and acceleration at one of the curves' angles."""
    speed = float(curves.crank_speed[i])
    return replace(machine, speed=speed or way * SLOW, acceleration=float(curves.crank_acceleration[i]))


@pytest.mark.parametrize("back", [False, True])
def test_the_drive_at_rest_is_the_limit_of_that_on_the_way(back: bool) -> None:
    """Loads and friction that oppose the motion do so to the very ends, of tables of the motion too."""
    at, beside = np.array([0.0, 1.0]), np.array([1e-9, 1.0 - 1e-9])
    for machine, linkage, swing in random_swings(100, seed=6, friction=True):
        own = require_swing(machine, linkage, swing)
        found, near = (swing_curves(machine, own, swing, share, back=back).drive for share in (at, beside))
        assert found == pytest.approx(near, rel=1e-6, abs=1e-6 * float(np.nanmax(np.abs(near))), nan_ok=True)


@pytest.mark.parametrize("back", [False, True])
def test_the_drive_does_the_virtual_work(back: bool) -> None:
    """On 300 machines, each at six places: T from energies, and P = T / x'."""
    seen = set()
    for machine, linkage, swing in random_swings(300, seed=5):
        own = require_swing(machine, linkage, swing)
        found = swing_curves(machine, own, swing, SHARES, back=back)
        way = swing.forward_direction * (-1.0 if back else 1.0)
        design = np.array([float(linkage.crank), float(linkage.rod), float(linkage.offset)])
        sign = 1.0 if machine.branch == "open" else -1.0
        for i, theta in enumerate(found.crank_angle):
            at = moving(machine, found, i, way)
            torque = float(drive_torque(at, design, theta))
            motion = path(design, theta, sign)
            wanted = torque if swing.driver == "crank" else torque / float(motion.x_1)
            size = max(float(np.abs(found.drive).max()), abs(float(found.pivot_x[i])))
            if swing.driver == "crank" and abs(float(motion.x_1)) < 1e-9:
                continue  # at a dead centre the stroke is luck
            assert found.drive[i] == pytest.approx(wanted, rel=1e-9, abs=1e-9 * size)
            seen.add((swing.driver, machine.branch, swing.law, bool(linkage.rotates_fully)))
    assert len(seen) >= 46  # of 48: drivers, branches, laws, turning through or not


def balances(machine: Mechanism, linkage: Linkage, found: SwingCurves, i: int, way: float, driver: str) -> Array:
    """Return the sums of forces and moments on crank, rod and slider, over the size of the forces."""
    at, theta = moving(machine, found, i, way), float(found.crank_angle[i])
    design = np.array([float(linkage.crank), float(linkage.rod), float(linkage.offset)])
    sign = 1.0 if machine.branch == "open" else -1.0
    parts = {}
    still = abs(at.speed) <= SLOW  # then it moves by its acceleration alone
    speed, rise = (1.0, 0.0) if still else (at.speed, at.acceleration)
    for name, part in bodies(machine, design).items():
        x, y, turn = (
            motion_in_time(f, theta, speed=speed, acceleration=rise, reach=0.15) for f in (part.x, part.y, part.turn)
        )
        rise_x, rise_y, spin = (each[1] * at.acceleration if still else each[2] for each in (x, y, turn))
        fx, fy = part.mass * (rise_x - machine.gravity[0]), part.mass * (rise_y - machine.gravity[1])
        parts[name] = (fx, fy, x[0] * fy - y[0] * fx + part.inertia * spin)
    (cx, cy, cm), (wx, wy, wm), (rx, ry, rm), (sx, sy, _) = (parts[n] for n in ("crank", "weight", "rod", "slider"))
    motion = path(design, theta, sign)
    r, _, e = design
    kx, ky, at_b = r * math.cos(theta), r * math.sin(theta), float(motion.x)
    px, py, ax, ay = (float(getattr(found, n)[i]) for n in ("pivot_x", "pivot_y", "crank_pin_x", "crank_pin_y"))
    bx, by, guide = (float(getattr(found, n)[i]) for n in ("slider_pin_x", "slider_pin_y", "guide"))
    drive = float(found.drive[i])
    torque, push = (drive, 0.0) if driver == "crank" else (0.0, drive)
    f = machine.friction
    on_rod_at_a = -f.crank_pin.friction_circle_radius * math.hypot(ax, ay) * np.sign((motion.rod_1 - 1.0) * at.speed)
    on_rod_at_b = -f.slider_pin.friction_circle_radius * math.hypot(bx, by) * np.sign(motion.rod_1 * at.speed)
    on_crank = -f.crank_pivot.friction_circle_radius * math.hypot(px, py) * np.sign(at.speed)
    rub = -f.guide * abs(guide) * np.sign(motion.x_1 * at.speed)
    load = sign * float(slider_load(at, design, theta, motion))
    size = max(map(abs, (px, py, ax, ay, bx, by, guide, drive, 1e-3)))
    return (
        np.array(
            [
                px - ax - cx - wx,
                py - ay - cy - wy,
                (torque + float(crank_torque(at, theta)) - (kx * ay - ky * ax) + on_crank - on_rod_at_a - cm - wm) / r,
                ax - bx - rx,
                ay - by - ry,
                ((kx * ay - ky * ax) - (at_b * by - e * bx) + on_rod_at_a + on_rod_at_b - rm) / r,
                bx + load + push + rub - sx,
                by + guide - sy,
            ]
        )
        / size
    )


@pytest.mark.parametrize("friction", [False, True])
@pytest.mark.parametrize("back", [False, True])
def test_forces_balance_every_body(friction: bool, back: bool) -> None:
    """No joint force is eliminated here, and accelerations are contour integrals of positions."""
    drivers = set()
    for machine, linkage, swing in random_swings(75, seed=6, friction=friction):
        own = require_swing(machine, linkage, swing)
        found = swing_curves(machine, own, swing, SHARES[1:-1], back=back)
        way = swing.forward_direction * (-1.0 if back else 1.0)
        if np.isnan(found.drive).any():
            assert friction
            continue
        drivers.add(swing.driver)
        for i in range(len(found.crank_angle)):
            assert np.abs(balances(machine, own, found, i, way, swing.driver)).max() < 1e-8
    assert drivers == {"crank", "slider"}


def test_driving_the_slider_undoes_driving_the_crank() -> None:
    """The crank driven as the slider turned it moves the slider as it was driven; the power is the same."""
    for machine, linkage, swing in random_swings(150, seed=7, driver="slider"):
        own = require_swing(machine, linkage, swing)
        found = swing_curves(machine, own, swing, SHARES)
        for i, theta in enumerate(found.crank_angle):
            at = own.at(theta, speed=found.crank_speed[i], acceleration=found.crank_acceleration[i])
            scale = abs(swing.end - swing.start) * float(own.crank) / (swing.duration or 1.0)
            assert float(at.slider_position) == pytest.approx(found.slider_position[i], abs=1e-13)
            assert float(at.slider_velocity) == pytest.approx(found.slider_velocity[i], abs=1e-10 * scale)
            torque = float(
                drive_torque(
                    moving(machine, found, i, swing.forward_direction),
                    np.array([float(own.crank), float(own.rod), float(own.offset)]),
                    theta,
                )
            )
            power = torque * float(found.crank_speed[i])
            assert found.power[i] == pytest.approx(power, rel=1e-9, abs=1e-9 * (1.0 + np.abs(found.power).max()))


def test_the_ends_are_where_they_are_asked() -> None:
    for machine, linkage, swing in random_swings(100, seed=8):
        own = require_swing(machine, linkage, swing)
        for back, ends in ((False, (swing.start, swing.end)), (True, (swing.end, swing.start))):
            found = swing_curves(machine, own, swing, np.array([0.0, 1.0]), back=back)
            np.testing.assert_allclose(found.crank_angle, ends, rtol=0, atol=1e-13)


def test_friction_locks_a_crank_whose_rod_passes_within_the_friction_circles() -> None:
    """The rod's line passes the pivot at r sin(theta - phi), near a dead point less than both circles."""
    pin = Pin(radius=0.02, coefficient=0.5)
    machine = Mechanism(
        crank=RigidLink(mass=1.0), gravity=(0.0, -9.81), friction=Friction(crank_pivot=pin, crank_pin=pin)
    )
    linkage, share = Linkage(0.1, 0.3), np.linspace(0.0, 1.0, 61)
    swing = Swing(start=math.radians(2.0), end=math.radians(60.0), driver="slider")
    found = swing_curves(machine, require_swing(machine, linkage, swing), swing, share)
    locked = np.isnan(found.drive)
    bend = found.driven_angle
    assert np.array_equal(locked, bend <= math.asin(0.01 / 0.3) + math.asin(0.02 / 0.1))
    assert 0 < locked.sum() < 61
    assert (0.1 * np.sin(bend[~locked])).min() > 0.02  # no lever below both circles is let pass


def test_position_error_of_the_column_is_that_of_the_dimensions_moved() -> None:
    """Central differences of the crank angle at a held slider, by each dimension; the worst case adds their sizes."""
    given = Tolerances(crank=Tolerance(absolute=1e-4), rod=Tolerance(fraction=1e-3), offset=Tolerance(absolute=2e-4))
    for bare, linkage, swing in random_swings(60, seed=9, driver="slider"):
        machine = replace(bare, tolerances=given)
        swing = replace(swing, actuator_tolerance=3e-4)
        own = require_swing(machine, linkage, swing)
        found = swing_curves(machine, own, swing, np.array([0.3]))
        sizes = [float(own.crank), float(own.rod), float(own.offset)]
        steps = [1e-4, 1e-3 * sizes[1], 2e-4]
        x, theta = float(found.slider_position[0]), float(found.crank_angle[0])
        total = 0.0
        for k, limit in enumerate(steps):
            h = 1e-6
            moved = []
            for side in (h, -h):
                dims = list(sizes)
                dims[k] += side
                near = [s.crank_angle for s in Linkage(dims[0], dims[1], dims[2], own.branch).from_slider(x)]
                moved.append(min(near, key=lambda a: abs(math.remainder(a - theta, 2.0 * math.pi))))
            total += abs(math.remainder(moved[0] - moved[1], 2.0 * math.pi)) / (2.0 * h) * limit
        at = path(np.array(sizes), theta, own.sign)
        total += 3e-4 / abs(float(at.x_1))
        assert found.driven_error[0] == pytest.approx(total, rel=1e-5)


def test_outward_and_inward_are_told_by_the_way() -> None:
    machine, linkage, swing = random_swings(1, seed=10)[0]
    own = require_swing(machine, linkage, swing)
    forth, back = (swing_curves(machine, own, swing, np.array([0.4]), back=back) for back in (False, True))
    for curves, way in ((forth, swing.forward_direction), (back, -swing.forward_direction)):
        at = moving(machine, curves, 0, way)
        sizes = np.array([float(own.crank), float(own.rod), float(own.offset)])
        _, _, outward = outward_motion(at, path(sizes, curves.crank_angle[0], own.sign))
        velocity = curves.slider_velocity[0] or way * float(path(sizes, curves.crank_angle[0], own.sign).x_1)
        assert outward == (own.sign * velocity > 0.0)
