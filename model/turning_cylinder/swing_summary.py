"""A lever and its turning cylinder over a swing, in numbers."""

from dataclasses import dataclass, replace

import numpy as np

from ..machine.lever_cylinder import Cylinder
from ..machine.mounting import Mounting
from .curve_peaks import LeverBatch, lever_peaks, table_of_numbers
from .cylinder_and_pin_forces import LeverCurves, LeverMachine, LeverSwing, lever_curves, numbers_of_machine
from .lever_geometry import DimensionErrors, crank_and_frame_for_stroke

_CURVES = (
    *("push", "pull", "pin", "pivot", "cylinder_pivot"),
    *("angle_error", "speed", "push_power", "pull_power"),
)


@dataclass(frozen=True)
class LeverPoint:
    """A value with the lever angle, rad, and the length of the cylinder, m, where it occurs."""

    value: float
    lever_angle: float
    length: float


@dataclass(frozen=True, kw_only=True)
class LeverSummary:
    """A swing out and back, SI and radians; None for values that do not follow from the given numbers.

    lengths: cylinder at start and end. hold: push at rest at start and end, without friction of the seal. push, pull:
    greatest forces with it, over both ways and at rest at both ends; 0 where the cylinder never pushes or pulls.
    energy_out, energy_back: work of the slow cylinder each way, J. power: greatest magnitude, W. fitting_sizes: OB and
    OA with which the swing takes the whole stroke of the cylinder, at the same angles.
    """

    lengths: tuple[float, float]
    mounting: Mounting
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
    def suits_single_stage_cylinder(self) -> bool:
        """Whether a single-stage cylinder can have both lengths: its stroke is less than its closed length.

        With a trunnion, this need not hold.
        """
        return self.mounting == "trunnion" or self.extension_ratio < 2.0


def summarise_swing(
    machine: LeverMachine, swing: LeverSwing, cylinder: Cylinder, errors: DimensionErrors | None = None
) -> LeverSummary:
    """Return the numbers of a swing; peaks are over the continuous lever angle, and rest at both ends.

    Raises the errors of `TurningCylinder.require_swing`, and those of the checks in `Cylinder`.
    """
    sizes = machine.sizes
    sizes.require_swing(swing.start, swing.end)
    cylinder.require_sizes_to_agree(cylinder)
    first, last = (float(sizes.cylinder_length(angle)) for angle in (swing.start, swing.end))
    shortest, longest = sorted((first, last))
    fitting = _fitting_sizes(machine, swing, cylinder)
    cylinder.require_lengths(shortest, longest, _remedy_text(fitting))
    rub, travel = cylinder.seal_friction, longest - shortest
    rest = lever_curves(machine, LeverSwing(swing.start, swing.end), np.array([0.0, 1.0]))
    greatest = _greatest_points(machine, swing, cylinder, errors)
    push, pull = (replace(point, value=max(point.value, 0.0)) for point in (greatest["push"], greatest["pull"]))
    cylinder.require_pressure(push.value, pull.value)
    lift = machine.energy_to_lift(swing.start, swing.end)
    speed = None if swing.duration is None else greatest["speed"]
    power = max(greatest["push_power"], greatest["pull_power"], key=lambda point: point.value)
    buckling = None
    if cylinder.rod is not None and push.value > 0.0:
        share = greatest["buckling_share"]
        buckling = LeverPoint(1.0 / share.value, share.lever_angle, share.length)
        cylinder.require_no_buckling(buckling.value, buckling.length)
    return LeverSummary(
        lengths=(first, last),
        mounting=cylinder.mounting,
        extension_ratio=longest / shortest,
        hold=(float(rest.push[0]), float(rest.push[1])),
        push=push,
        pull=pull,
        energy_out=lift + rub * travel,
        energy_back=rub * travel - lift,
        transmission=_least_transmission(rest),
        dead_point_margin=sizes.dead_point_margin(swing.start, swing.end),
        pin=greatest["pin"],
        pivot=greatest["pivot"],
        cylinder_pivot=greatest["cylinder_pivot"],
        angle_error=greatest["angle_error"] if errors is not None and any(errors) else None,
        speed=speed,
        power=None if speed is None else power,
        pressures=cylinder.pressures(push.value, pull.value),
        flows=None
        if speed is None or cylinder.areas is None
        else (cylinder.areas[0] * speed.value, cylinder.areas[1] * speed.value),
        buckling_margin=buckling,
        time_ratio=sizes.time_ratio_of_full_turn,
        fitting_sizes=fitting,
    )


def _fitting_sizes(machine: LeverMachine, swing: LeverSwing, cylinder: Cylinder) -> tuple[float, float] | None:
    sizes, known = machine.sizes, cylinder.closed_length_and_stroke(0.0)
    if known is None or cylinder.stroke is None:
        return None
    lengths = known[0], sum(known)
    short, long = sorted((swing.start, swing.end), key=sizes.cylinder_length)
    fitting = crank_and_frame_for_stroke(
        lengths, (sizes.angle_from_frame_to_crank(short), sizes.angle_from_frame_to_crank(long)), sizes.offset
    )
    if fitting is None or sizes.crank < sizes.frame:
        return fitting
    return fitting[1], fitting[0]


def _remedy_text(fitting: tuple[float, float] | None) -> str:
    if fitting is None:
        return "choose another cylinder, or move a pivot"
    crank, frame = (f"{1e3 * size:.6g} mm" for size in fitting)
    return f"choose another cylinder, or a crank of {crank} and a frame of {frame}, which use its whole stroke"


def _greatest_points(
    machine: LeverMachine, swing: LeverSwing, cylinder: Cylinder, errors: DimensionErrors | None
) -> dict[str, LeverPoint]:
    """Return where each curve is greatest, from one search."""
    table = table_of_numbers(numbers_of_machine(machine, swing, cylinder, errors), 1)
    names = _CURVES if cylinder.rod is None else (*_CURVES, "buckling_share")
    peaks = lever_peaks(LeverBatch(table, swing.law), names)
    values, places = (part.reshape(len(names), -1) for part in (peaks.values, peaks.places))
    best = values.argmax(axis=1)[:, None]
    value, place = (np.take_along_axis(part, best, axis=1)[:, 0] for part in (values, places))
    at = lever_curves(machine, swing, np.where(place < 2.0, place, place - 2.0))
    points = map(LeverPoint, value.tolist(), at.lever_angle.tolist(), at.length.tolist())
    return dict(zip(names, points, strict=True))


def _least_transmission(ends: LeverCurves) -> LeverPoint:
    """Return the least transmission angle, which is at an end: its sine has no minimum between dead points."""
    least = int(np.argmin(ends.transmission))
    return LeverPoint(float(ends.transmission[least]), float(ends.lever_angle[least]), float(ends.length[least]))
