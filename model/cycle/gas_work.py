"""Work and volumes of the gas in a machine's cylinders over a cycle, in closed form.

With L the logarithm of the volume ratio of an expansion, p V^n = const does the work

    p_1 V_1 L f((n - 1) L),    f(x) = (1 - exp(-x)) / x,

which is p_1 V_1 L for n = 1; compression likewise with -(n - 1) L. While a valve is open, the work is pressure times
volume. Over a turn the back pressure does no work.

The indicator diagram has pressure and volume over the crank angle, and the valve events.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..dynamics.gas import compression_end_position, expansion_end_position
from ..dynamics.segments import crank_angle_at
from ..kernel.arithmetic import STEP
from ..kernel.batches import require_full_rotation
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.cylinders_and_turns import (
    cycle_turns,
    cylinder_count,
    half_of_cycle_at,
    machines_of_turns,
    shift_angles_into_half,
)
from ..machine.derived_designs import derived_blocks
from ..machine.design import AREA, DESIGN, LOAD_ROWS, Design
from ..machine.loads.compressor import Compressor
from ..machine.loads.cylinder import Cylinder
from ..machine.loads.engine import LimitedPressure
from ..machine.loads.load import Enters
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import raw_inputs_with_all_features
from ..machine.raw_numbers_of_designs import raw_machine_numbers

_INNER, _OUTER = Design._fields.index("inner"), Design._fields.index("outer")
_SERIES = 1e-4  # |x| below which f is computed from its series: x^4 / 120 is then below rounding


class GasCycle(NamedTuple):
    """Sums over the cylinders for n designs, each (n,), real or complex.

    swept, clearance: volumes, m^3. work: work of the gas on the pistons over a cycle of the machine, one turn or two,
    J. cycle_work: the same over one cycle of each cylinder, two turns for four strokes, J. delivers: for compressors
    only, intake volume divided by swept volume; zero or less where nothing is delivered. delivered: their intake volume
    per turn, m^3, excluding those that deliver nothing.
    """

    swept: Any
    clearance: Any
    work: Any
    cycle_work: Any
    delivers: Any
    delivered: Any

    def multiplied_by(self, count: int) -> GasCycle:
        """Return the combined sums of several machines."""
        return GasCycle(*(count * sum_of for sum_of in self))._replace(delivers=self.delivers)


def cylinder_loads(mechanism: Mechanism) -> tuple[tuple[int, Cylinder], ...]:
    """Return the cylinders among a machine's loads, each with its index first."""
    return tuple((k, load) for k, load in enumerate(mechanism.loads) if isinstance(load, Cylinder))


def compressors(mechanism: Mechanism) -> tuple[Compressor, ...]:
    """Return the compressors and pumps among a machine's loads."""
    return tuple(load for load in mechanism.loads if isinstance(load, Compressor))


def compressor_may_deliver_nothing(mechanism: Mechanism) -> bool:
    """Return whether the delivery of a compressor depends on the design; otherwise it has been checked beforehand."""
    gas = {k: load for k, load in cylinder_loads(mechanism.with_largest_variables) if isinstance(load, Compressor)}
    varied = {path.split(".")[1] for item in mechanism.varying for path in item.paths if path.startswith("loads.")}
    return any(str(k) in varied or load.clearance_volume > 0.0 for k, load in gas.items() if load.compression_exponent)


def evaluate_on_gas_cycle(
    mechanism: Mechanism, designs: Array, number: Callable[[GasCycle], Any], *, gradients: bool = False
) -> tuple[Array, Array | None]:
    """Return one number (n,) from the `GasCycle` for designs (n, 3 + k), and its derivatives (n, 3 + k).

    For several cylinders on one crankshaft, volumes and works are totals.
    """
    designs = require_full_rotation(designs)
    count = cylinder_count(mechanism)
    if count > 1:
        single = replace(mechanism, arrangement=None)
        return evaluate_on_gas_cycle(single, designs, lambda gas: number(gas.multiplied_by(count)), gradients=gradients)
    if cycle_turns(mechanism) > 1:
        sums, rates = _gas_cycle_of_two_turns(mechanism, designs, gradients=gradients)
        return np.asarray(number(sums), dtype=np.float64), None if rates is None else _derivatives_by_design(
            number, sums, rates
        )
    raw, loads = raw_inputs_with_all_features(mechanism)
    numbers = raw_machine_numbers(mechanism, designs, slot_count=len(raw), gradients=gradients)
    blocks, steps = derived_blocks(raw, loads, numbers.columns, numbers.values, steps=gradients)
    values = np.asarray(number(_sum_gas_cycles(mechanism, blocks[:, :, 0])), dtype=np.float64)
    if not gradients:
        return values, None
    slopes = number(_sum_gas_cycles(mechanism, steps[:, :, 0])).imag / STEP
    return values, numbers.gradients_by_design_numbers(slopes.reshape(len(designs), len(numbers.columns)))


def _gas_cycle_of_two_turns(
    mechanism: Mechanism, designs: Array, *, gradients: bool
) -> tuple[GasCycle, GasCycle | None]:
    """Return the sums over a cycle of two turns, each (n,), and their derivatives, each (n, 3 + k)."""
    four = [load.cycle_turns > 1 for load in mechanism.loads]
    sums, slopes = [], []
    for half in machines_of_turns(mechanism):
        raw, loads = raw_inputs_with_all_features(half)
        numbers = raw_machine_numbers(half, designs, slot_count=len(raw), gradients=gradients)
        blocks, steps = derived_blocks(raw, loads, numbers.columns, numbers.values, steps=gradients)
        sums.append(_sum_gas_cycles(half, blocks[:, :, 0], four))
        if gradients:
            shape = len(designs), len(numbers.columns)
            parts = _sum_gas_cycles(half, steps[:, :, 0], four)
            slopes.append(
                GasCycle(*(numbers.gradients_by_design_numbers(part.imag.reshape(shape) / STEP) for part in parts))
            )
    return _sum_of_turns(*sums), _sum_of_turns(*slopes) if gradients else None


def _sum_of_turns(first: GasCycle, second: GasCycle) -> GasCycle:
    """Return the sums over both turns."""
    return first._replace(work=first.work + second.work, cycle_work=first.cycle_work + second.cycle_work)


def _derivatives_by_design(number: Callable[[GasCycle], Any], values: GasCycle, slopes: GasCycle) -> Array:
    stepped = (value[:, None] + 1j * STEP * slope for value, slope in zip(values, slopes, strict=True))
    return np.asarray(number(GasCycle(*stepped)).imag / STEP)


def _sum_gas_cycles(mechanism: Mechanism, blocks: Any, four: Sequence[bool] = ()) -> GasCycle:
    """Return the sums for derived blocks (n, rows).

    four: for one of two turns, which loads have a cycle of two turns.
    """
    swept = clearance = work = cycles = intake = pumped = delivered = 0.0 * blocks[:, 0]
    stroke = blocks[:, _OUTER] - blocks[:, _INNER]
    for k, load in cylinder_loads(mechanism):
        q = DESIGN + LOAD_ROWS * k + AREA
        area, h, low, high, compression, expansion = (blocks[:, q + i] for i in range(6))
        if load.compression_exponent == 0.0:
            gained, spent, share = low * stroke, high * stroke, 1.0 + 0.0 * stroke
        else:
            gained, spent, share = _stroke_works_and_intake_fraction(stroke, h, low, high, compression, expansion)
        if load.enters is Enters.BURNING_CYLINDER:
            burnt = blocks[:, q + 7]
            widens = np.log((h + stroke) / (h + burnt))
            gained = high * (burnt + (h + burnt) * widens * _mean_of_exponential_decay((expansion - 1.0) * widens))
        swept, clearance, work = swept + area * stroke, clearance + area * h, work + area * (gained - spent)
        cycles = cycles + area * (gained - spent) * (0.5 if four and not four[k] else 1.0)
        if isinstance(load, Compressor):
            pumped, intake = pumped + area * stroke, intake + area * stroke * share
            delivered = delivered + np.where(share.real > 0.0, area * stroke * share, 0.0)
    delivers = intake / pumped if compressors(mechanism) else intake
    return GasCycle(swept, clearance, work, cycles, delivers, delivered)


def _stroke_works_and_intake_fraction(
    stroke: Any, h: Any, low: Any, high: Any, compression: Any, expansion: Any
) -> Any:
    """Return the work of expansion and of compression per piston area, J/m^2, and the intake fraction of the stroke."""
    expanded, compressed = (
        expansion_end_position(h, high / low, expansion),
        compression_end_position(stroke, h, high / low, compression),
    )
    with np.errstate(divide="ignore", invalid="ignore"):  # without clearance the gas is expanded from the start
        full_stroke, ratio = np.log((h + stroke) / h), np.log(high / low)
    opens, delivers = expanded.real < stroke.real, compressed.real > 0.0
    down = np.where(opens, ratio / expansion, full_stroke)
    up = np.where(delivers, ratio / compression, full_stroke)
    gained = high * h * np.where(h.real > 0.0, down * _mean_of_exponential_decay((expansion - 1.0) * down), 0.0)
    gained = gained + np.where(opens, low * (stroke - expanded), 0.0)
    spent = low * (h + stroke) * up * _mean_of_exponential_decay(-(compression - 1.0) * up)
    spent = spent + np.where(delivers, high * compressed, 0.0)
    share = 1.0 - expanded / stroke
    stuck = compressed / stroke
    return gained, spent, np.where(delivers | (share.real < stuck.real), share, stuck)


def _mean_of_exponential_decay(x: Any) -> Any:
    """Return (1 - exp(-x)) / x, exact to rounding even near zero."""
    near = np.abs(x.real) < _SERIES
    safe = np.where(near, 1.0, x)
    return np.where(near, 1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0)), -np.expm1(-safe) / safe)


_BEFORE = 5e-10  # shift to an earlier crank angle, rad: less than the width at which figures mark jumps


@dataclass(frozen=True)
class Indicator:
    """Volume, m^3, and pressure, Pa, of the gas in a cylinder at crank angles, rad, each (n,)."""

    crank_angle: Array
    volume: Array
    pressure: Array


def indicator_diagram(mechanism: Mechanism, linkage: Linkage, load: Cylinder, crank_angle: ArrayLike) -> Indicator:
    """Return volume and pressure in one of a machine's cylinders; at a dead centre, the pressure just before it."""
    linkage = require_single_rotating_linkage(mechanism, linkage)
    theta = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    stroke, sign, top = _stroke_and_piston_top(linkage, load)
    z = np.clip(sign * (linkage.sign * linkage.at(theta).slider_position - top), 0.0, stroke)
    # The motion just before: at a dead centre, that of the stroke ending there.
    before = linkage.at(theta - _BEFORE * mechanism.direction, speed=mechanism.direction).slider_velocity
    away = sign * linkage.sign * before > 0.0
    pressure = _pressure_at(load, z, stroke, away)
    if load.cycle_turns > 1:
        turn = half_of_cycle_at(mechanism, *linkage.dead_centre_angles, theta - _BEFORE * mechanism.direction)
        parts = [load.load_on_turn(number) for number in (1, 2)]
        first, second = (_pressure_at(part, z, stroke, away) for part in parts if isinstance(part, Cylinder))
        pressure = np.where(turn == 0, first, second)
    return Indicator(theta, load.clearance * load.area * stroke + load.clearance_volume + load.area * z, pressure)


def _pressure_at(load: Cylinder, z: Array, stroke: float, away: Any) -> Array:
    return np.asarray(
        np.where(away, load.pressure(z, stroke, expanding=True), load.pressure(z, stroke, expanding=False))
    )


def valve_events(mechanism: Mechanism, linkage: Linkage, load: Cylinder) -> tuple[float | None, float | None]:
    """Return the crank angles, rad in [0, 2 pi), at which expansion and compression end.

    None if there is no such event.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    stroke = _stroke_and_piston_top(linkage, load)[0]
    if load.compression_exponent == 0.0 or isinstance(load, LimitedPressure):
        return None, None
    h, ratio = load.clearance * stroke + load.clearance_volume / load.area, load.high / load.low
    events = (
        expansion_end_position(h, ratio, load.expansion_exponent),
        compression_end_position(stroke, h, ratio, load.compression_exponent),
    )
    ends = [
        _crank_angle_at_piston_distance(mechanism, linkage, load, float(z), away=away)
        for z, away in zip(events, (True, False), strict=True)
    ]
    return ends[0], ends[1]


def burning_end_angle(mechanism: Mechanism, linkage: Linkage, load: Cylinder) -> float | None:
    """Return the crank angle at which burning at peak pressure ends, rad in [0, 4 pi).

    None if there is no such phase.
    """
    if not isinstance(load, LimitedPressure):
        return None
    linkage = require_single_rotating_linkage(mechanism, linkage)
    angle = _crank_angle_at_piston_distance(
        mechanism, linkage, load, load.burning_share * _stroke_and_piston_top(linkage, load)[0], away=True
    )
    if angle is None or load.cycle_turns == 1:
        return angle
    return float(shift_angles_into_half(mechanism, *linkage.dead_centre_angles, np.array(angle), 0))


def _crank_angle_at_piston_distance(
    mechanism: Mechanism, linkage: Linkage, load: Cylinder, z: float, *, away: bool
) -> float | None:
    """Return the crank angle at which the piston is z from its top position, rad in [0, 2 pi).

    away: whether the piston moves away from its top position. None if z is out of reach.
    """
    stroke, sign, top = _stroke_and_piston_top(linkage, load)
    outward = away == (sign > 0.0)
    second = outward == (mechanism.direction < 0.0)
    x = linkage.sign * (top + sign * z)
    angle = crank_angle_at(x, float(linkage.crank), float(linkage.rod), float(linkage.offset), second)
    return angle % (2.0 * math.pi) if 0.0 < z < stroke else None


def _stroke_and_piston_top(linkage: Linkage, load: Cylinder) -> tuple[float, float, float]:
    """Return the stroke, the direction in which the piston leaves its top, and the top's distance from the pivot.

    The direction is 1 for outward.
    """
    inner, outer = (linkage.sign * float(linkage.at(angle).slider_position) for angle in linkage.dead_centre_angles)
    return outer - inner, *((-1.0, outer) if load.head == "outer dead centre" else (1.0, inner))
