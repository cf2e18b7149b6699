"""A machine over boxes of designs: its parameters, and the loads on slider and crank, gas forces included.

Also crank angles that depend on the design: for a slider position, and at a dead centre.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any, cast

import numpy as np

from ...model.arrays import Array, Mask
from ...model.dynamics.torque import load_without_pieces
from ...model.kinematics.geometry import inner_crank_angle, outer_crank_angle
from ...model.kinematics.position import motion
from ...model.machine.cylinders_and_turns import TURN
from ...model.machine.design import AREA, DESIGN, LOAD_ROWS, Design, derive_design, design_at
from ...model.machine.loads.cylinder import Cylinder
from ...model.machine.loads.engine import LimitedPressure
from ...model.machine.loads.load import Enters
from ...model.machine.loads.registry import force_of
from ...model.machine.mechanism import Mechanism
from ...model.machine.raw_machine_vector import Loads
from ...model.machine.raw_numbers_of_designs import nominal_raw_number, raw_numbers_by_slot
from .enclosure import UNIT, Enclosure, enclosure_of_ends, select_by_mask

_ON_END = 1e-7  # fraction of the stroke; a point closer than this to a dead centre is on it
_AT_REST = 1e-6  # relative to the crank: |x'| below it means a dead centre


def crank_pin_coefficients(d: Design, x: Any, side: Any) -> tuple[Any, Any]:
    """Return q and h for a slider position x; the crank pin is at q B + h B'.

    B is the slider pin, B' is B turned by 90 degrees, q = (r^2 + B^2 - l^2) / (2 B^2) and h^2 = r^2 / B^2 - q^2. side:
    the sign of h, 1 if the crank pin is left of the line from crank pivot to slider pin.
    """
    square = x * x + d.e * d.e
    q = (d.r * d.r + square - d.l * d.l) / (square * 2.0)
    return q, np.sqrt(d.r * d.r / square - q * q) * side


def crank_sine_and_cosine(d: Design, x: Any, side: Any) -> tuple[Any, Any]:
    """Return sine and cosine of the crank angle for the slider position x, see `crank_pin_coefficients`."""
    q, h = crank_pin_coefficients(d, x, side)
    return (q * d.e + h * x) / d.r, (q * x - h * d.e) / d.r


def crank_angle_near(
    d: Design, x: Enclosure, sine: Any, cosine: Any, side: Array, near: Array | None = None
) -> Enclosure:
    """Return the crank angle, rad, from its sine and cosine: theta = atan2(e, x) + side acos(...).

    near: angles (n, p) less than half a turn away, to which whole turns are added. NaN where the angle ranges over half
    a turn or more.
    """
    r, l, e, at = (number.centre for number in (d.r, d.l, d.e, x))
    size = np.hypot(at, e)
    middle = np.arctan2(e, at) + side * np.arccos(np.clip((r * r + size * size - l * l) / (2.0 * r * size), -1.0, 1.0))
    if near is not None:
        middle = middle + TURN * np.round((near - middle) / TURN)
    c, s = np.cos(middle), np.sin(middle)
    off = np.arcsin(sine * c - cosine * s)
    is_sure = (cosine * c + sine * s).least_and_greatest()[0] > 0.0
    return Enclosure(off.centre + middle, off.slopes, np.where(is_sure, off.rest, np.nan), off.empty)


def crank_at_stroke_fraction(
    d: Design, sine: Array, cosine: Array, middle: Array, start: float, end: float
) -> tuple[Enclosure, Enclosure]:
    """Return sine and cosine of the crank angle at the same fraction of the stroke as in the middle design."""
    r, l, e = (column[:, None] for column in middle[:, :3].T)
    at = motion(sine, cosine, r, l, e, d.branch)
    inner, outer = np.sqrt((l - r) ** 2 - e * e), np.sqrt((l + r) ** 2 - e * e)
    share = np.clip((at.x * d.branch - inner) / (outer - inner), start, end)
    side = np.where(at.x * r * sine >= e * r * cosine, 1.0, -1.0)
    x = (d.inner + (d.outer - d.inner) * np.clip(share, _ON_END, 1.0 - _ON_END)) * d.branch
    q, h = crank_pin_coefficients(d, x, side)
    on_inner, on_outer = share < _ON_END, share > 1.0 - _ON_END
    q = select_by_mask(on_inner, -d.r / (d.l - d.r), select_by_mask(on_outer, d.r / (d.l + d.r), q))
    h = select_by_mask(on_inner | on_outer, 0.0 * d.r, h)
    x = select_by_mask(on_inner, d.inner * d.branch, select_by_mask(on_outer, d.outer * d.branch, x))
    return (q * d.e + h * x) / d.r, (q * x - h * d.e) / d.r


def dead_centre_angle(d: Design, far: Mask) -> Enclosure:
    """Return the crank angle of the outer dead centre where `far`, otherwise of the inner one, rad."""
    outer, inner = outer_crank_angle(d.r, d.l, d.e), inner_crank_angle(d.r, d.l, d.e)
    angle = select_by_mask(far, outer, inner)
    return angle if d.branch > 0.0 else math.pi - angle


def track_dead_centre(
    d: Design, sine: Array, cosine: Array, angle: Array, middle: Array
) -> tuple[Mask, Enclosure, Enclosure, Any]:
    """Return a mask of middle designs at a dead centre, with sine, cosine and angle that follow the dead centre."""
    r, l, e = (column[:, None] for column in middle[:, :3].T)
    at = motion(sine, cosine, r, l, e, d.branch)
    on_dead_centre = np.abs(at.x_1) < _AT_REST * r
    far = at.x * d.branch > np.sqrt(l * l - e * e)  # sqrt(l^2 - e^2) lies between the dead centres
    q = select_by_mask(far, d.r / (d.l + d.r), -d.r / (d.l - d.r))
    x = select_by_mask(far, d.outer * d.branch, d.inner * d.branch)
    k = len(q.slopes)
    if not on_dead_centre.any():
        return on_dead_centre, enclosure_of_ends(sine, sine, k), enclosure_of_ends(cosine, cosine, k), angle
    followed = dead_centre_angle(d, far)
    followed = followed + TURN * np.round((angle - followed.centre) / TURN)
    return (
        on_dead_centre,
        select_by_mask(on_dead_centre, q * d.e / d.r, enclosure_of_ends(sine, sine, k)),
        select_by_mask(on_dead_centre, q * x / d.r, enclosure_of_ends(cosine, cosine, k)),
        select_by_mask(on_dead_centre, followed, enclosure_of_ends(angle, angle, k)),
    )


def gas_force(load: Cylinder, share: Enclosure, stroke: Enclosure, outward: Enclosure) -> Enclosure:
    """Return the force, N outward, for the piston's distance from its top as a fraction of the stroke.

    outward: its sign determines the stroke; where the sign is uncertain, the force spans both strokes.
    """
    sign = 1.0 if load.head == "inner dead centre" else -1.0
    low, high = outward.least_and_greatest()
    sides = [_pressure(load, share, stroke, expanding=(sign > 0.0) == way) for way in (True, False)]
    ends = [side.least_and_greatest() for side in sides]
    either_stroke = enclosure_of_ends(
        np.minimum(ends[0][0], ends[1][0]), np.maximum(ends[0][1], ends[1][1]), len(outward.slopes)
    )
    pressure = select_by_mask(low > 0.0, sides[0], select_by_mask(high < 0.0, sides[1], either_stroke))
    return (pressure - load.back_pressure) * (sign * load.area)


def _pressure(load: Cylinder, share: Enclosure, stroke: Enclosure, *, expanding: bool) -> Enclosure:
    """Return the pressure during one stroke, Pa; it falls with the distance from the top."""
    k = len(share.slopes)
    first, last = (np.clip(end, 0.0, 1.0) for end in share.least_and_greatest())
    if load.clearance_volume and load.compression_exponent:
        # It rises (expansion) or falls (compression) with the clearance, so the corners bound it.
        least, greatest = (
            load.clearance + load.clearance_volume / (load.area * end) for end in stroke.least_and_greatest()[::-1]
        )
        near, far = (greatest, least) if expanding else (least, greatest)
        return enclosure_of_ends(
            _pressure_at(load, last, far, expanding), _pressure_at(load, first, near, expanding), k
        )
    at_first, at_last = (_pressure_at(load, end, load.clearance, expanding) for end in (first, last))
    wide = last > first
    slope = np.where(wide, (at_last - at_first) / np.where(wide, last - first, 1.0), 0.0)
    n = load.expansion_exponent if expanding else load.compression_exponent
    lowest, highest = np.zeros_like(first), np.zeros_like(first)
    if n:
        ratio, c = load.high / load.low, load.clearance
        event = c * (ratio ** (1.0 / n) - 1.0) if expanding else (1.0 + c) * ratio ** (-1.0 / n) - c
        bent = np.minimum(first, event) if expanding else np.maximum(first, event)
        curved = first < event if expanding else last > event
        scale = load.high * c**n if expanding else load.low * (1.0 + c) ** n
        if expanding and isinstance(load, LimitedPressure):
            event = load.burning_share
            bent, curved, scale = np.maximum(first, event), last > event, load.high * (c + event) ** n
        with np.errstate(divide="ignore"):
            bend = np.where(curved, scale * n * (n + 1.0) / (c + bent) ** (n + 2.0), 0.0)
        # Chords of the two pieces meet at the event; each curve lies at most bend width^2 / 8 below its chord.
        off = _pressure_at(load, event, c, expanding) - (at_first + slope * (event - first))
        between_ends = (first < event) & (event < last)
        lowest = np.where(between_ends, np.minimum(off, 0.0), 0.0) - 0.125 * bend * (last - first) ** 2
        highest = np.where(between_ends, np.maximum(off, 0.0), 0.0)
    chord = (share - first) * slope + (at_first + 0.5 * (highest + lowest))
    most_of = UNIT * (load.high + np.abs(slope) * share.greatest_magnitude)
    return Enclosure(chord.centre, chord.slopes, chord.rest + 0.5 * (highest - lowest) + 8.0 * most_of, chord.empty)


def _pressure_at(load: Cylinder, share: Any, clearance: Any, expanding: bool) -> Array:
    """Return the pressure at a fraction of the stroke, for a clearance ratio."""
    if load.compression_exponent == 0.0:
        return np.asarray((load.low if expanding else load.high) + 0.0 * share)
    if expanding and isinstance(load, LimitedPressure):
        return np.asarray(load.pressure(share, 1.0, expanding=True))
    with np.errstate(divide="ignore", invalid="ignore"):
        if expanding:
            return np.asarray(
                np.fmax(load.low, load.high * (clearance / (clearance + share)) ** load.expansion_exponent)
            )
        ratio = (1.0 + clearance) / (clearance + share)
        return np.asarray(np.fmin(load.high, load.low * ratio**load.compression_exponent))


_TURN = 2.0 * np.pi
_derive = cast(Any, derive_design)

Numbers = Mapping[int, Enclosure]
"""Machine parameters that designs set, enclosed over boxes, by slot (`Raw`, `PINS`)."""


def parameters_over_boxes(mechanism: Mechanism, columns: list[Enclosure]) -> Numbers:
    """Return the machine parameters that designs set, from the columns (n, 1) of a design's own numbers."""
    design = np.empty((1, len(columns)), dtype=object)
    design[0, :] = columns
    return {slot: value[0] for slot, value in raw_numbers_by_slot(mechanism, design).items()}


def parameter_lookup(mechanism: Mechanism, numbers: Numbers) -> Callable[[int], Any]:
    """Return a function from slot to machine parameter, enclosed over boxes if designs set it."""
    return lambda slot: numbers[slot] if slot in numbers else nominal_raw_number(mechanism, slot)


def unboundable_load_reason(mechanism: Mechanism) -> str:
    """Return why a machine's loads have no bound over a range of designs; empty if they do."""
    for item in mechanism.varying:
        for path in item.paths:
            part, _, place = path.partition(".")
            if part == "loads" and isinstance(mechanism.loads[int(place.split(".")[0])], Cylinder):
                return f"the cycle of a cylinder has no bound over a range of {item.name}"
    return ""


class BoxMachine:
    """Parameters and loads of a machine over boxes of designs, without friction. raw, loads: as for a signal."""

    def __init__(self, mechanism: Mechanism, raw: Array, loads: Loads) -> None:
        self.mechanism, self.raw, self.loads = mechanism, raw, loads

    def derived_design(self, numbers: Numbers) -> tuple[Design, Any]:
        """Return the derived design, and its parameter block for the loads."""
        raw = self.raw.astype(object)[:, None]
        for slot, value in numbers.items():
            if slot < len(raw):
                raw[slot, 0] = value
        block = np.empty((DESIGN + LOAD_ROWS * len(self.loads.kind), 1), dtype=object)
        _derive(raw, self.loads.kind, self.loads.datum, block)
        return design_at(block, 0), block

    def slider_load(self, m: Any, d: Design, block: Any, theta: Array | Enclosure, outward: Enclosure) -> Any:
        """Return the load on the slider, N outward. outward: has the sign of the slider's outward velocity."""
        load: Any = load_without_pieces(m, d, select_by_stroke(outward, d.outward_force, d.inward_force))
        way = select_by_stroke(outward, 1.0, -1.0)
        for k, code in enumerate(self.loads.kind.tolist()):
            row = DESIGN + LOAD_ROWS * k
            if code >= Enters.FORMULA:
                velocity = m.x_1 * d.branch * d.speed
                load = load + force_of(code, m.x * d.branch, velocity, way, block[row, 0], block[row + 1, 0])
            elif code in (Enters.CYLINDER, Enters.BURNING_CYLINDER):
                stroke = d.outer - d.inner
                z = (m.x * d.branch - block[row + 1, 0]) * block[row, 0]
                load = load + gas_force(cast(Cylinder, self.mechanism.loads[k]), z / stroke, stroke, outward)
            if self.loads.start[k] < self.loads.start[k + 1] and not self.loads.factor[k, 2]:
                load = load + self._table_force(k, m, d, block, theta, outward)
        return load

    def crank_torque_of_loads(
        self, m: Any, d: Design, block: Any, theta: Array | Enclosure, outward: Enclosure, way: float | Array
    ) -> Any:
        """Return the loads' torque on the crank, N m. way: 1 if the crank turns counter-clockwise, -1 if clockwise."""
        torque: Any = 0.0
        for k, load in enumerate(self.mechanism.loads):
            if load.on_crank and self.loads.kind[k] == Enters.CRANK_TORQUE:
                constant, resisting, stiffness, free = block[DESIGN + LOAD_ROWS * k + AREA :, 0][:4]
                torque = torque + constant - way * resisting
                if isinstance(stiffness, Enclosure) or stiffness:
                    torque = torque - stiffness * (theta - free)
            elif load.on_crank:
                torque = torque + self._table_force(k, m, d, block, theta, outward)
        return torque

    def _table_force(
        self, k: int, m: Any, d: Design, block: Any, theta: Array | Enclosure, outward: Enclosure
    ) -> Enclosure | Any:
        part = slice(self.loads.start[k], self.loads.start[k + 1])
        at, force = self.loads.knots[part], self.loads.force[part]
        factor = self.loads.factor[k, 2] or select_by_stroke(outward, *self.loads.factor[k, :2].tolist())
        if self.loads.kind[k] != Enters.ANGLE_TABLE:
            row = DESIGN + LOAD_ROWS * k
            return factor * interpolate_force((m.x * d.branch - block[row + 1, 0]) * block[row, 0], at, force)
        if self.loads.datum[k] == 0 and not isinstance(theta, Enclosure):
            return factor * np.interp(theta - _TURN * np.floor((theta - at[0]) / _TURN), at, force)
        counted = theta - block[DESIGN + LOAD_ROWS * k + 1, 0] if self.loads.datum[k] else theta
        centre = counted.centre if isinstance(counted, Enclosure) else counted
        turns = counted - _TURN * np.floor((centre - at[0]) / _TURN)
        # One turn before and one after, because a box may extend beyond the ends of the table. Where the table steps at
        # its seam, the end of one turn and the start of the next are the two sides of the step.
        at = np.concatenate([at - _TURN, at, at + _TURN])
        return factor * interpolate_force(turns, at, np.tile(force, 3))


def interpolate_force(x: Enclosure, at: Array, force: Array) -> Enclosure:
    """Return the table's force over an enclosed position: the chord, and the greatest distance of the knots from it."""
    low, high = x.least_and_greatest()
    first, last = np.interp(low, at, force), np.interp(high, at, force)
    wide = high > low
    slope = np.where(wide, (last - first) / np.where(wide, high - low, 1.0), 0.0)
    highest, lowest = np.zeros_like(low), np.zeros_like(low)
    for knot, value in zip(at, force, strict=True):
        off = np.where((low < knot) & (knot < high), value - (first + slope * (knot - low)), 0.0)
        highest, lowest = np.maximum(highest, off), np.minimum(lowest, off)
    chord = (x - low) * slope + (first + 0.5 * (highest + lowest))
    rounding = UNIT * (np.abs(force).max() + np.abs(slope) * x.greatest_magnitude)
    return Enclosure(chord.centre, chord.slopes, chord.rest + 0.5 * (highest - lowest) + 4.0 * rounding, chord.empty)


def select_by_stroke(outward: Enclosure, out: Any, back: Any) -> Enclosure:
    """Return one number for the outward stroke, another for the inward one, and both where the stroke is uncertain."""
    low, high = outward.least_and_greatest()
    k = len(outward.slopes)
    if not isinstance(out, Enclosure) and not isinstance(back, Enclosure):
        least = np.where(low > 0.0, out, np.where(high < 0.0, back, min(out, back)))
        greatest = np.where(low > 0.0, out, np.where(high < 0.0, back, max(out, back)))
        return enclosure_of_ends(least, greatest, k)
    sides = [0.0 * outward + side for side in (out, back)]
    (least, greatest), (back_least, back_greatest) = (side.least_and_greatest() for side in sides)
    either = enclosure_of_ends(np.minimum(least, back_least), np.maximum(greatest, back_greatest), k)
    return select_by_mask(low > 0.0, sides[0], select_by_mask(high < 0.0, sides[1], either))
