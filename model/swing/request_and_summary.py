"""A swing in numbers: drive, holding forces, energies, transmission angle and error at the driven side.

Sources of the error at the driven side for a crank angle in a swing.

A request may leave out values, which are taken from the machine's job.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_linkage, require_slider
from ..machine.links_and_joints import Friction
from ..machine.mechanism import Mechanism, Start
from ..tolerance.error_distributions import SOURCES, limits_of_sources
from .swing import Swing, require_swing, slow_swing, swing_between_crank_angles, with_start_set_by_machine
from .swing_cycle import SwingCycle, SwingPoint
from .swing_types import Driver, Law, Side

_ANGLES, _POSITIONS = ("start", "end"), ("slider_start", "slider_end")


@dataclass(frozen=True, kw_only=True)
class SwingRequest:
    """Requested ends and law of a swing; None keeps the job's value.

    start, end: crank angles, rad. slider_start, slider_end: m.

    side, driver, law, duration (s), actuator_tolerance (m): as in `Swing`.
    """

    start: float | None = None
    end: float | None = None
    slider_start: float | None = None
    slider_end: float | None = None
    side: Side | None = None
    driver: Driver | None = None
    law: Law | None = None
    duration: float | None = None
    actuator_tolerance: float | None = None


def resolve_swing(
    mechanism: Mechanism, motion: Swing | None, request: SwingRequest, field_names: Mapping[str, str] | None = None
) -> tuple[Mechanism, Swing]:
    """Return the requested swing, and the machine without its own start.

    motion: the job's swing, from the start that the machine of one design has; None if it has none. By default the
    crank drives, slowly. A start requested alone moves the end along if the job states the angle or the travel.
    field_names: names of the fields of `SwingRequest` in messages, if they differ from Python's.

    Raises `InputError` for ends of two kinds, missing ends, and a tabulated motion if the job has no table.
    """
    names = {name: (field_names or {}).get(name, name) for name in SwingRequest.__dataclass_fields__}
    motion = None if motion is None else with_start_set_by_machine(mechanism, motion)
    fields: dict[str, Any] = {
        **_requested_ends(request, motion, names),
        **{
            name: getattr(request, name)
            for name in ("side", "driver", "law", "duration", "actuator_tolerance")
            if getattr(request, name) is not None
        },
    }
    if request.law == "table" and (motion is None or not motion.points):
        raise InputError(
            f"a tabulated motion law must be in a job; got {names['law']} table; write its points as law_times and "
            f"law_shares in the job's [motion], and leave {names['law']} out"
        )
    if request.law == "slow":
        fields.setdefault("duration", None)
    if request.law not in (None, "table"):
        fields.setdefault("points", ())
    if request.driver == "crank":
        fields.setdefault("actuator_tolerance", 0.0)
    if motion is not None and fields.get("stated_for", motion.stated_for) == motion.stated_for:
        swing = replace(motion, **fields)
    else:
        motion_fields = ("driver", "law", "duration", "points", "actuator_tolerance")
        swing = _swing_from_request_alone(
            ({} if motion is None else {name: getattr(motion, name) for name in motion_fields}) | fields, names
        )
    return replace(mechanism, start=Start()), replace(swing, follows=False)


def _requested_ends(request: SwingRequest, motion: Swing | None, names: Mapping[str, str]) -> dict[str, Any]:
    """Return the requested start and end, and whether they refer to the crank or the slider."""
    stated = {name: getattr(request, name) for name in (*_ANGLES, *_POSITIONS) if getattr(request, name) is not None}
    if not stated:
        return {}
    stated_for = "crank" if next(iter(stated)) in _ANGLES else "slider"
    fields = _ANGLES if stated_for == "crank" else _POSITIONS
    if any(name not in fields for name in stated):
        raise InputError(
            "a swing must run between two crank angles or between two slider positions; got "
            f"{', '.join(names[name] for name in stated)}; give only one of these pairs"
        )
    ends = {end: stated[name] for end, name in zip(_ANGLES, fields, strict=True) if name in stated}
    if motion is not None and motion.follows and motion.stated_for == stated_for and "end" not in ends:
        ends["end"] = ends["start"] + (motion.end - motion.start)
    return ends | {"stated_for": stated_for}


def _swing_from_request_alone(fields: dict[str, Any], names: Mapping[str, str]) -> Swing:
    slider = fields.get("stated_for") == "slider"
    for name, key in zip(_ANGLES, _POSITIONS if slider else _ANGLES, strict=True):
        if name not in fields:
            raise InputError(
                f"a swing must run from one {'slider position' if slider else 'crank angle'} to another; got no "
                f"{names[key]}; give both, or use a job with [motion]"
            )
    return Swing(**fields)


@dataclass(frozen=True)
class ErrorShare:
    """A source of an error. limit: its tolerance, m, or rad for the crank angle. error: its contribution, m or rad."""

    source: str
    limit: float
    error: float


def error_shares(mechanism: Mechanism, linkage: Linkage, swing: Swing, crank_angle: float) -> tuple[ErrorShare, ...]:
    """Return each source's contribution to the worst case at the driven side, for a crank angle, rad.

    If the crank drives: |dx/di| T_i for the slider position. If the slider drives: the same divided by |x'| for the
    crank angle, with the actuator among the sources. Sources without tolerance are left out.
    """
    require_slider(mechanism)
    checked = require_single_linkage(mechanism, linkage)
    i, source_limits = checked.error_influences(crank_angle), limits_of_sources(mechanism, checked)
    crank, rod, offset, turn = (abs(float(share)) for share in (i.crank, i.rod, i.offset, i.crank_angle))
    rates = (crank, rod, offset, turn, rod, rod, rod, offset)
    shares = [
        ErrorShare(name, float(limit), rate * float(limit))
        for name, limit, rate in zip(SOURCES, source_limits, rates, strict=True)
    ]
    if swing.driver == "slider":
        shares = [share for share in shares if share.source != "crank angle"]
        shares.append(ErrorShare("actuator", swing.actuator_tolerance, swing.actuator_tolerance))
        shares = [ErrorShare(share.source, share.limit, share.error / turn) for share in shares]
    return tuple(share for share in shares if share.limit)


@dataclass(frozen=True)
class SwingSummary:
    """One linkage over a swing, SI and radians.

    driver_ends: crank angles or slider positions. swing_angle, travel: magnitudes of the motion of crank and slider.
    peak_drive: maximum magnitude of the driver's torque or force, in either stroke. drive_start, drive_end: drive at
    each end on the forward and on the return stroke, without inertia. With negligible friction, both hold the linkage
    at rest; with friction, any force between them does. holds: whether friction alone holds the linkage at rest
    throughout the swing. energy_forward, energy_back: energy from the driver on the forward and return strokes, J.
    stored: energy in the slow forward stroke without friction, J. efficiency: energy without friction divided by energy
    with friction, on the slow forward stroke, otherwise the slow return stroke; None if neither is driven. peak_power:
    W, None for a slow swing. least_transmission: minimum transmission angle at the driven side.
    position_error: maximum over the swing, None without tolerances. If friction may lock the linkage, `locked` is the
    first such place, and peaks and energies are NaN.
    """

    swing: Swing
    linkage: Linkage
    crank_angles: tuple[float, float]
    slider_positions: tuple[float, float]
    peak_drive: SwingPoint
    drive_start: tuple[float, float]
    drive_end: tuple[float, float]
    holds: bool
    energy_forward: float
    energy_back: float
    stored: float
    efficiency: float | None
    peak_power: SwingPoint | None
    least_transmission: SwingPoint
    position_error: SwingPoint | None
    locked: SwingPoint | None

    @property
    def swing_angle(self) -> float:
        """Crank rotation in one stroke."""
        return abs(self.crank_angles[1] - self.crank_angles[0])

    @property
    def travel(self) -> float:
        """Distance between the slider positions at both ends; if the crank drives, the slider may pass them."""
        return abs(self.slider_positions[1] - self.slider_positions[0])


def summarise_swing(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> SwingSummary:
    """Return the numbers for a swing. Peaks are over the continuous crank angle; energies are integrals between kinks.

    Raises the errors of `require_swing`.
    """
    checked = require_swing(mechanism, linkage, swing)
    swing = swing_between_crank_angles(mechanism, checked, swing)
    cycle = SwingCycle(mechanism, checked, swing)
    ends = np.array([0.0, 1.0])
    slow = SwingCycle(mechanism, checked, slow_swing(swing))
    still = slow.curves(ends), slow.curves(ends, back=True)
    free = SwingCycle(replace(mechanism, friction=Friction()), checked, slow.swing)
    locked = cycle.first_lockable_point()
    peak = cycle.greatest_magnitude("drive")
    power = None if swing.duration is None else cycle.greatest_magnitude("power")
    if locked is not None:  # near that place the drive grows without bound
        peak, power = locked, None if power is None else locked
    tolerances = mechanism.tolerances.are_stated or swing.actuator_tolerance > 0.0
    return SwingSummary(
        swing=swing,
        linkage=checked,
        crank_angles=(swing.start, swing.end),
        slider_positions=(float(still[0].slider_position[0]), float(still[0].slider_position[1])),
        peak_drive=peak,
        drive_start=(float(still[0].drive[0]), float(still[1].drive[1])),
        drive_end=(float(still[0].drive[1]), float(still[1].drive[0])),
        holds=slow.is_held_by_friction(),
        energy_forward=cycle.driver_work(back=False),
        energy_back=cycle.driver_work(back=True),
        stored=free.driver_work(back=False),
        efficiency=None if locked else _drive_efficiency(slow, free),
        peak_power=power,
        least_transmission=cycle.minimum_of_curve("driven_angle"),
        position_error=cycle.greatest_magnitude("driven_error") if tolerances else None,
        locked=locked,
    )


def _drive_efficiency(slow: SwingCycle, free: SwingCycle) -> float | None:
    """Return the energy without friction divided by that with friction, for the first driven stroke."""
    for back in (False, True):
        least, spent = free.driver_work(back=back), slow.driver_work(back=back)
        if least > 0.0 and spent > 0.0:
            return least / spent
    return None
