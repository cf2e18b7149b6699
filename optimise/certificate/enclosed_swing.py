"""A quantity of a swing, enclosed over boxes of designs at selected points of the swing.

A curve's greatest value over the swing is at least its value at any one point; its least value is at most that value.
Slider travel and crank angle have closed forms with bounds on both sides.
"""

from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from ...model.arrays import Array
from ...model.dynamics.torque import add_crank_couple, balance_before_pin_force, forces_without_friction
from ...model.kernel.arithmetic import magnitude
from ...model.kinematics.position import Motion, motion
from ...model.machine.design import Design
from ...model.machine.mechanism import Mechanism
from ...model.machine.raw_machine_vector import raw_inputs_with_all_features
from ...model.machine.raw_numbers_of_designs import START
from ...model.signals.position_error import influences, worst_case
from ...model.signals.signals import design_motion
from ...model.swing.end_angles import swing_ends, swing_start_column
from ...model.swing.forces import frictionless_pin_force, pin_distance_from_crank_line
from ...model.swing.law import corner_times, law_code, travel_and_derivatives_at
from ...model.swing.peaks import peaks_of_negated_least_drive, swing_peaks
from ...model.swing.swing import Swing, slow_swing
from ...model.swing.swing_states import DRIVE, ERROR, POWER
from ...objectives.swing_quantity import ClosedFormSwingQuantity, SwingLeast, SwingPeak
from .enclosed_machine import BoxMachine, Numbers, crank_angle_near, crank_sine_and_cosine
from .enclosure import Enclosure, constant_like, join_parts, sign_of

_SIDE_STEP = 1e-9  # fraction of the time; moves to one side of a corner in the law, or of a step
_FARTHEST = 0.25


class _Ends(NamedTuple):
    """Crank angles, rad, and slider positions, m, of both ends, and the side of the crank pin."""

    angles: tuple[Enclosure, Enclosure]
    positions: tuple[Enclosure, Enclosure]
    side: Array


class _State(NamedTuple):
    """State at a point of the swing.

    driver_way: 1 if the driver's position increases. way: 1 if the crank turns counter-clockwise.
    """

    sine: Enclosure
    cosine: Enclosure
    angle: Enclosure
    m: Motion
    d: Design
    block: Any
    outward: Enclosure
    driver_way: Array
    way: Array


class SwingBoxes:
    """A swing over boxes of designs, without friction. slow: without inertia."""

    def __init__(self, mechanism: Mechanism, swing: Swing, *, slow: bool = False) -> None:
        self.mechanism, self.swing = mechanism, slow_swing(swing) if slow else swing
        self.machine = BoxMachine(mechanism, *raw_inputs_with_all_features(mechanism))
        self.varies = swing_start_column(mechanism) is not None
        self.slider = swing.driver == "slider"
        self.per_time = 0.0 if self.swing.duration is None else 1.0 / self.swing.duration
        loads = mechanism.with_largest_variables.loads
        self.needs_angle = any(load.on_crank or load.has_knots_in_sense_of_rotation for load in loads)
        self.steps = any(load.has_steps for load in loads)
        self.corners = corner_times(self.swing.law, self.swing.law_pieces)

    def swing_ends(self, numbers: Numbers, d: Design) -> _Ends:
        """Return both ends of the swing."""
        swing = self.swing
        first = numbers[START[swing.stated_for]] if self.varies else constant_like(swing.start, d.r)
        last = first + (swing.end - swing.start) if swing.follows else constant_like(swing.end, d.r)
        if swing.stated_for == "slider":
            side = constant_like(1.0 if swing.side == "left" else -1.0, d.r).centre
            first_angle, last_angle = (
                crank_angle_near(d, x, *crank_sine_and_cosine(d, x, side), side) for x in (first, last)
            )
            return _Ends((first_angle, last_angle), (first, last), side)
        positions = [design_motion(angle.sin(), angle.cos(), d).x for angle in (first, last)]
        middle = 0.5 * (first + last)
        sine, cosine = middle.sin(), middle.cos()
        return _Ends(
            (first, last),
            (positions[0], positions[1]),
            sign_of(pin_distance_from_crank_line(sine, cosine, design_motion(sine, cosine, d))),
        )

    def state_at_time(self, numbers: Numbers, share: Array, probe: Array, back: Array) -> _State:
        """Return the state at fractions of the time (n, p); NaN where some designs in a box have no state.

        probe: fractions on the same side of a corner in the law. back: 1 on the return stroke.
        """
        direction = 1.0 - 2.0 * back
        way, way_1, way_2, _ = travel_and_derivatives_at(law_code(self.swing.law), self.swing.law_pieces, share, probe)
        return self.state_at_travel(
            numbers, np.where(back > 0.5, 1.0 - way, way), direction, direction * way_1, direction * way_2
        )

    def state_at_travel(
        self, numbers: Numbers, way: Array, direction: Any = 1.0, way_1: Any = 0.0, way_2: Any = 0.0
    ) -> _State:
        """Return the state at fractions of the travel (n, p), with derivatives with respect to the fraction of time."""
        d, block = self.machine.derived_design(numbers)
        ends = self.swing_ends(numbers, d)
        first, last = ends.positions if self.slider else ends.angles
        travel = last - first
        place = first + travel * way
        if self.slider:
            sine, cosine = crank_sine_and_cosine(d, place, ends.side)
            angle = crank_angle_near(
                d, place, sine, cosine, ends.side, 0.5 * (ends.angles[0].centre + ends.angles[1].centre)
            )
        else:
            sine, cosine, angle = place.sin(), place.cos(), place
        m = design_motion(sine, cosine, d)
        speed, rise = travel * (way_1 * self.per_time), travel * (way_2 * self.per_time**2)
        if self.slider:
            speed = speed / m.x_1
            rise = (rise - m.x_2 * speed * speed) / m.x_1
        d = d._replace(speed=speed, acceleration=rise) if self.per_time else d._replace(speed=0.0, acceleration=0.0)
        driver_way = sign_of(travel) * direction
        outward = m.x_1 * (driver_way * d.branch)
        turning = driver_way
        if self.slider:
            outward = constant_like(driver_way * d.branch, place)
            turning = driver_way * sign_of(m.x_1) if self.needs_angle else driver_way
        return _State(sine, cosine, angle, m, d, block, outward, driver_way, turning)

    def drive_torque_or_force(self, at: _State) -> Enclosure:
        """Return the torque on the crank, N m, or the force on the slider, N, without friction."""
        load = self.machine.slider_load(at.m, at.d, at.block, at.angle, at.outward)
        on_crank = self.machine.crank_torque_of_loads(at.m, at.d, at.block, at.angle, at.outward, at.way)
        if not self.slider:
            torque: Enclosure = forces_without_friction(at.sine, at.cosine, at.m, at.d, load).torque - on_crank
            return torque
        b = add_crank_couple(balance_before_pin_force(at.sine, at.cosine, at.m, at.d, load), 0.0 - on_crank)
        force: Enclosure = b.pull - frictionless_pin_force(at.sine, at.cosine, at.m, at.d, b)[0]
        return force

    def position_error(self, at: _State) -> Enclosure:
        """Return the error on the driven side, m at the slider or rad at the crank."""
        i = influences(at.sine, at.cosine, at.m, at.d.l)
        error: Enclosure
        if not self.slider:
            error = worst_case(i, at.d)
            return error
        off: Enclosure = magnitude(i.crank) * at.d.crank_error + magnitude(i.rod) * at.d.rod_error
        off = off + magnitude(i.offset) * at.d.offset_error + self.swing.actuator_tolerance
        error = off / magnitude(at.m.x_1)
        return error

    def transmission_angle(self, numbers: Numbers, way: Array) -> Enclosure:
        """Return the transmission angle on the driven side at fractions of the travel (n, p), rad."""
        at = self.state_at_travel(numbers, way)
        sine = magnitude(pin_distance_from_crank_line(at.sine, at.cosine, at.m) if self.slider else at.m.l_sin) / at.d.l
        angle: Enclosure = np.arcsin(sine)
        return angle if self.slider else 0.5 * np.pi - angle

    def closure_violation(self, numbers: Numbers) -> Enclosure:
        """Return |e - r sin(theta)| / l - 1 at both ends (n, 2), below zero where the linkage closes."""
        d, _ = self.machine.derived_design(numbers)
        ends = self.swing_ends(numbers, d)
        opening: Enclosure = reduce(
            join_parts, (magnitude(d.e - d.r * angle.sin()) / d.l - 1.0 for angle in ends.angles)
        )
        return opening


class SwingCurve:
    """A quantity of a swing over boxes of designs: greatest or, with `least`, least value of a state."""

    def __init__(self, mechanism: Mechanism, quantity: SwingPeak | SwingLeast | ClosedFormSwingQuantity) -> None:
        assert quantity.swing is not None
        self.least = not isinstance(quantity, SwingPeak)
        self.quantity = quantity
        self.at_ends = isinstance(quantity, SwingPeak) and quantity.state is None
        self.boxes = SwingBoxes(mechanism, quantity.swing, slow=self.at_ends or isinstance(quantity, SwingLeast))

    @property
    def default_position(self) -> tuple[float, ...]:
        """Position for boxes whose middle design does not swing."""
        return self._position_range[:1]

    @property
    def _position_range(self) -> tuple[float, float]:
        """First and last position; see `enclose`."""
        if isinstance(self.quantity, SwingLeast):
            return float(self.quantity.back), 1.0 + self.quantity.back
        return 0.0, 2.0 if isinstance(self.quantity, SwingPeak) else 1.0

    def peak_positions(self, designs: Array) -> Array:
        """Return each design's position (n, 1) of the greatest value or, with `least`, of the least one.

        See `enclose`.
        """
        mechanism, swing, quantity = self.boxes.mechanism, self.quantity.swing, self.quantity
        assert swing is not None
        if isinstance(quantity, ClosedFormSwingQuantity):
            return _least_transmission_angle_position(mechanism, swing, designs)[:, None]
        if isinstance(quantity, SwingLeast):
            found = peaks_of_negated_least_drive(mechanism, swing, designs, back=quantity.back, limit=1).places
        elif quantity.state is None:
            return np.full((len(designs), 1), self.default_position)
        else:
            found = swing_peaks(mechanism, swing, quantity.state, designs, limit=1).places
        return np.where(np.isfinite(found), np.clip(found, *self._position_range), self.default_position)

    def enclose(self, numbers: Numbers, positions: Array, middle: Array) -> Enclosure:
        """Return the quantity's curve (n, p) at positions (n, 1), and at both ends.

        A position is a fraction of the time, plus 1 on the return stroke; for an angle, a fraction of the travel.
        """
        at, (first, last) = positions, self._position_range
        columns = [at, np.full_like(at, first), np.full_like(at, last)]
        if last - first > 1.0:
            columns += [np.full_like(at, 1.0), np.full_like(at, 1.0 + _SIDE_STEP)]
        if self.boxes.steps and not self.at_ends:
            # A peak at a step moves with the design: beside it, all designs in the box are on one side of the step.
            width: Any = sum(
                np.ptp(numbers[slot].least_and_greatest(), axis=0) / numbers[slot].greatest_magnitude for slot in (0, 1)
            )
            away = np.minimum(4.0 * width, _FARTHEST)
            columns += [np.clip(at - away, first, last), np.clip(at + away, first, last)]
        return self._enclose_at(numbers, np.concatenate(columns, axis=1))

    def _enclose_at(self, numbers: Numbers, positions: Array) -> Enclosure:
        boxes, quantity = self.boxes, self.quantity
        if isinstance(quantity, ClosedFormSwingQuantity):
            return boxes.transmission_angle(numbers, positions)
        back = (
            np.where(positions > 1.0, 1.0, 0.0)
            if isinstance(quantity, SwingPeak)
            else np.full_like(positions, float(quantity.back))
        )
        share = positions - back
        probes = [share - _SIDE_STEP, share + _SIDE_STEP] if boxes.corners else [share]
        return reduce(
            join_parts,
            (
                self._value_of_quantity(boxes.state_at_time(numbers, share, np.clip(probe, 0.0, 1.0), back))
                for probe in probes
            ),
        )

    def _value_of_quantity(self, at: _State) -> Enclosure:
        state = self.quantity.state if isinstance(self.quantity, SwingPeak) else None
        if state == ERROR:
            return self.boxes.position_error(at)
        value: Enclosure = self.boxes.drive_torque_or_force(at)
        if isinstance(self.quantity, SwingLeast):
            return value * at.driver_way
        assert state in (POWER, DRIVE, None)
        if state == POWER:
            value = value * (at.m.x_1 * at.d.speed if self.boxes.slider else at.d.speed)
        return value.magnitude()


def _least_transmission_angle_position(mechanism: Mechanism, swing: Swing, designs: Array) -> Array:
    """Return the fraction of the travel (n,) at the transmission angle's minimum between the ends, 0 if none."""
    ends = swing_ends(mechanism, swing, designs)
    r, l, e = designs[:, :3].T
    if swing.driver == "slider":  # where crank and rod have the same angular velocity
        first, last = (motion(np.sin(at), np.cos(at), r, l, e, mechanism.sign).x for at in (ends.start, ends.end))
        found = -first / (last - first)
    else:  # where the crank is normal to the slider line, first on the side away from it
        angles = [ends.wrap_into_swing(angle) for angle in (0.5 * np.pi, 1.5 * np.pi)]
        far, near = np.where(e >= 0.0, angles[::-1], angles)
        found = (np.where(np.isnan(far), near, far) - ends.start) / (ends.end - ends.start)
    return np.where((found >= 0.0) & (found <= 1.0), found, 0.0)


def bounds_of_closed_form(mechanism: Mechanism, quantity: ClosedFormSwingQuantity, numbers: Numbers) -> Enclosure:
    """Return lower and upper bounds on the slider's travel, m, or the crank's angle, rad."""
    assert quantity.swing is not None
    boxes = SwingBoxes(mechanism, quantity.swing, slow=True)
    ends = boxes.swing_ends(numbers, boxes.machine.derived_design(numbers)[0])
    first, last = ends.positions if quantity.measure == "travel" else ends.angles
    size: Enclosure = magnitude(last - first)
    return size
