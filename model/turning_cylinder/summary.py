"""A lever and its turning cylinder over a swing, in numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .cylinder import Cylinder
from .forces import LeverCurves, LeverMachine, LeverSwing, lever_curves
from .lever import DimensionErrors, sizes_for_stroke

_SAMPLES, _ZOOMS, _ZOOMED = 721, 7, 41


@dataclass(frozen=True)
class LeverPoint:
    """A value with the lever angle, rad, and the length of the cylinder, m, where it occurs."""

    value: float
    lever_angle: float
    length: float


@dataclass(frozen=True, kw_only=True)
class LeverSummary:
    """A swing out and back, SI and radians; None for what does not follow from the given numbers.

    lengths: cylinder at start and end. single_stage: whether any single-stage cylinder has both, longest < 2 shortest.
    hold: push at rest at start and end, without friction of the seal. push, pull: greatest forces with it, over both
    ways and at rest at both ends; 0 where the cylinder never has to. energy_out, energy_back: work of the slow cylinder
    each way, J. power: greatest size, W. fitting_sizes: OB and OA with which the swing takes the whole stroke of the
    cylinder, at the same angles.
    """

    lengths: tuple[float, float]
    extension_ratio: float
    hold: tuple[float, float]
    push: LeverPoint
    pull: LeverPoint
    energy_out: float
    energy_back: float
    transmission: LeverPoint
    dead_point_margin: float
    pin: LeverPoint
    pivot: LeverPoint
    cylinder_pivot: LeverPoint
    angle_error: LeverPoint | None
    speed: LeverPoint | None
    power: LeverPoint | None
    pressures: tuple[float, float] | None
    flows: tuple[float, float] | None
    buckling_margin: LeverPoint | None
    time_ratio: float | None
    fitting_sizes: tuple[float, float] | None

    @property
    def single_stage(self) -> bool:
        """Whether a single-stage cylinder can have both lengths: its stroke is less than its closed length."""
        return self.extension_ratio < 2.0


def summarise(
    machine: LeverMachine, swing: LeverSwing, cylinder: Cylinder, errors: DimensionErrors | None = None
) -> LeverSummary:
    """Return the numbers of a swing; peaks are over the continuous lever angle, and rest at both ends.

    Raises the errors of `TurningCylinder.require_swing`, and of all that `Cylinder` requires.
    """
    sizes = machine.sizes
    sizes.require_swing(swing.start, swing.end)
    first, last = (float(sizes.length(angle)) for angle in (swing.start, swing.end))
    shortest, longest = sorted((first, last))
    fitting = _fitting_sizes(machine, swing, cylinder)
    cylinder.require_lengths(shortest, longest, _remedy(fitting))
    ends = _curves_at_rest(machine, swing)
    rub, travel = cylinder.seal_friction, longest - shortest
    push = _least_or_zero(machine, swing, lambda curves: -(curves.push + rub))
    pull = _least_or_zero(machine, swing, lambda curves: curves.push - rub)
    cylinder.require_pressure(push.value, pull.value)
    lift = machine.energy_to_lift(swing.start, swing.end)
    speed = None if swing.duration is None else _greatest(machine, swing, lambda curves: np.abs(curves.speed))

    def margin(curves: LeverCurves) -> Array:
        found = cylinder.buckling_margin(curves.length, curves.push + rub)
        return np.full_like(curves.length, np.inf) if found is None else found

    buckling = _least(machine, swing, margin) if cylinder.rod is not None and push.value > 0.0 else None
    if buckling is not None:
        cylinder.require_stiffness(buckling.value, buckling.length)
    return LeverSummary(
        lengths=(first, last),
        extension_ratio=longest / shortest,
        hold=(float(ends.push[0]), float(ends.push[1])),
        push=push,
        pull=pull,
        energy_out=lift + rub * travel,
        energy_back=rub * travel - lift,
        transmission=_least(machine, swing, lambda curves: curves.transmission),
        dead_point_margin=sizes.dead_point_margin(swing.start, swing.end),
        pin=_greatest(machine, swing, lambda curves: np.abs(curves.pin)),
        pivot=_greatest(machine, swing, lambda curves: np.abs(curves.pivot)),
        cylinder_pivot=_greatest(machine, swing, lambda curves: np.abs(curves.cylinder_pivot)),
        angle_error=None
        if errors is None or not any(errors)
        else _greatest(machine, swing, lambda curves: sizes.angle_error(curves.lever_angle, errors)),
        speed=speed,
        power=None
        if speed is None
        else _greatest(machine, swing, lambda curves: (np.abs(curves.push) + rub) * np.abs(curves.speed)),
        pressures=cylinder.pressures(push.value, pull.value),
        flows=None if speed is None or cylinder.areas is None else _flows(cylinder.areas, speed.value),
        buckling_margin=buckling,
        time_ratio=sizes.time_ratio,
        fitting_sizes=fitting,
    )


def _flows(areas: tuple[float, float], speed: float) -> tuple[float, float]:
    return areas[0] * speed, areas[1] * speed


def _fitting_sizes(machine: LeverMachine, swing: LeverSwing, cylinder: Cylinder) -> tuple[float, float] | None:
    if cylinder.closed_length is None or cylinder.stroke is None:
        return None
    sizes, lengths = machine.sizes, (cylinder.closed_length, cylinder.closed_length + cylinder.stroke)
    short, long = sorted((swing.start, swing.end), key=sizes.length)
    fitting = sizes_for_stroke(lengths, (sizes.relative_angle(short), sizes.relative_angle(long)), sizes.offset)
    if fitting is None or sizes.crank < sizes.frame:
        return fitting
    return fitting[1], fitting[0]


def _remedy(fitting: tuple[float, float] | None) -> str:
    if fitting is None:
        return "choose another cylinder, or move a pivot"
    crank, frame = (f"{1e3 * size:.6g} mm" for size in fitting)
    return f"choose another cylinder, or a crank of {crank} and a frame of {frame}, which take its whole stroke"


def _greatest(machine: LeverMachine, swing: LeverSwing, curve: Callable[[LeverCurves], Array]) -> LeverPoint:
    least = _least(machine, swing, lambda curves: -curve(curves))
    return LeverPoint(-least.value, least.lever_angle, least.length)


def _least_or_zero(machine: LeverMachine, swing: LeverSwing, curve: Callable[[LeverCurves], Array]) -> LeverPoint:
    """Return the size of the least value of a curve if it is negative, otherwise zero."""
    least = _least(machine, swing, curve)
    return LeverPoint(max(-least.value, 0.0), least.lever_angle, least.length)


def _least(machine: LeverMachine, swing: LeverSwing, curve: Callable[[LeverCurves], Array]) -> LeverPoint:
    """Return the least value of a curve: of samples, then of finer ones around it, or at rest.

    A law that starts with a jump of speed or acceleration has other forces at its ends than the cylinder that holds.
    """
    share = np.linspace(0.0, 1.0, _SAMPLES)
    for _ in range(_ZOOMS + 1):
        curves = lever_curves(machine, swing, share)
        values = curve(curves)
        best = int(np.argmin(values))
        share = np.linspace(share[max(best - 1, 0)], share[min(best + 1, len(share) - 1)], _ZOOMED)
    moving = LeverPoint(float(values[best]), float(curves.lever_angle[best]), float(curves.length[best]))
    rest = _curves_at_rest(machine, swing)
    points = map(LeverPoint, curve(rest).tolist(), rest.lever_angle.tolist(), rest.length.tolist())
    return min(moving, *points, key=lambda point: point.value)


def _curves_at_rest(machine: LeverMachine, swing: LeverSwing) -> LeverCurves:
    """Return the curves of a cylinder that holds the lever at start and end."""
    return lever_curves(machine, LeverSwing(swing.start, swing.end), np.array([0.0, 1.0]))
