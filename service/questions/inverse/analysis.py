"""Crank angles that put the slider of a design at a position: the JSON record, in metric units.

For a swinging crank only angles within its swing count.
"""

import math
from dataclasses import replace
from typing import Annotated

from ....model.errors import AssemblyError
from ....model.linkage.crank_angles_from_slider import CrankSolution
from ....model.linkage.inverse_kinematics import Solution as Stroke
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Branch, Mechanism
from ....model.swing.swing import Swing, dead_point_angles, require_swing, swing_between_crank_angles
from ....objectives.kinds import ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, name_and_kind_of_key
from ...render.blocks import Block, Table, column, joined, sentence, value_from_record, words
from ..record_types import Note, Record

_NEAR = 1e-9  # rad beyond an end of a swing that count as rounding
UNDEFINED = "at a dead centre the slider is at rest at any crank speed: crank speed and acceleration are undefined"
"""Reason why a given slider velocity does not determine the crank speed."""


Given = Annotated[float | None, Note("as it was given; null if it was not")]
Rate = Annotated[float | None, Note("null if the slider's rate is not given or a dead centre leaves it undefined")]


class Solution(Record):
    """Crank angle for the slider position, with the crank rates that produce the given slider rates."""

    crank_angle_deg: float
    stroke: Annotated[Stroke | None, Note("for a crank that turns counter-clockwise; null at a dead centre")]
    crank_speed_rpm: Rate
    crank_acceleration_rad_s2: Rate


class CrankAngles(Record):
    """Every crank angle at which the slider of a linkage is at a given position."""

    crank_mm: float
    rod_mm: float
    offset_mm: float
    branch: Branch
    slider_position_mm: float
    slider_velocity_m_s: Given
    slider_acceleration_m_s2: Given
    solutions: list[Solution]
    note: str
    """Reasons for undefined or omitted values, or empty."""


_GIVEN = ("slider_position_mm", "slider_velocity_m_s", "slider_acceleration_m_s2")


def numbers(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    swing: Swing | None,
    words: object = None,
    slider_position: float,
    slider_velocity: float | None = None,
    slider_acceleration: float | None = None,
) -> CrankAngles:
    """Return dimensions, slider motion and every solution with keys that carry their units, and a note.

    The slider's position, m, velocity, m/s, and acceleration, m/s^2, are along +x. For a swinging crank only angles
    within its swing count. null: values not requested, and values undefined at a dead centre, which the note explains.
    Raises the errors of `Linkage.from_slider` and `require_swing`, and `AssemblyError` for a position beyond the swing.
    """
    every = linkage.from_slider(slider_position, velocity=slider_velocity, acceleration=slider_acceleration)
    solutions, notes = every, []
    if swing is not None:
        swinging = require_swing(mechanism, linkage, swing)
        swing = swing_between_crank_angles(mechanism, swinging, swing)
        solutions = _solutions_in_swing(every, swing)
        ends = f"from {_degrees(swing.start)} to {_degrees(swing.end)} deg"
        if not solutions:
            reversals = (
                angle for dead in dead_point_angles(swinging) for angle in swing.equal_angles_within_swing(dead)
            )
            angles = (swing.start, swing.end, *reversals)
            places = sorted(1e3 * float(swinging.at(angle).slider_position) for angle in angles)
            raise AssemblyError(
                f"the position must be between {places[0]:.9g} and {places[-1]:.9g} mm, the slider's travel while the "
                f"crank swings {ends}; got {1e3 * slider_position:.9g} mm; choose one in this range"
            )
        if len(solutions) < len(every):
            omission = (
                "one other crank angle for this position lies" if len(every) - len(solutions) == 1 else "others lie"
            )
            notes.append(f"{omission} outside the swing {ends}")
    if slider_velocity is not None and any(solution.speed is None for solution in solutions):
        notes.append(UNDEFINED)
    return {
        "crank_mm": 1e3 * float(linkage.crank),
        "rod_mm": 1e3 * float(linkage.rod),
        "offset_mm": 1e3 * float(linkage.offset),
        "branch": linkage.branch,
        "slider_position_mm": 1e3 * slider_position,
        "slider_velocity_m_s": slider_velocity,
        "slider_acceleration_m_s2": slider_acceleration,
        "solutions": [
            {
                "crank_angle_deg": ANGLE.metric.factor * solution.crank_angle,
                "stroke": solution.stroke,
                "crank_speed_rpm": None if solution.speed is None else ANGULAR_SPEED.metric.factor * solution.speed,
                "crank_acceleration_rad_s2": solution.acceleration,
            }
            for solution in solutions
        ],
        "note": "; ".join(notes),
    }


def _solutions_in_swing(solutions: tuple[CrankSolution, ...], swing: Swing) -> tuple[CrankSolution, ...]:
    """Return the solutions within a swing between crank angles, with angles in its range."""
    within_swing = []
    for solution in solutions:
        angles = [
            at for near in (0.0, _NEAR, -_NEAR) for at in swing.equal_angles_within_swing(solution.crank_angle + near)
        ]
        within_swing += [replace(solution, crank_angle=angles[0])] if angles else []
    return tuple(sorted(within_swing, key=lambda solution: solution.crank_angle))


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.6g}"


def blocks(record: CrankAngles) -> list[Block]:
    """Return the slider's motion and the crank angles, in human-readable form."""
    motion = {key: value_from_record(record, key) for key in _GIVEN}
    motion_texts = [
        words(f"{name_and_kind_of_key(key)[0].removeprefix('slider_')} {{value}}", value=value)
        for key, value in motion.items()
        if value.number is not None
    ]
    rate_columns = [
        (key, column(title, kind))
        for key, title, kind, slider_key in (
            ("crank_speed_rpm", "crank speed", ANGULAR_SPEED, "slider_velocity_m_s"),
            ("crank_acceleration_rad_s2", "crank acceleration", ANGULAR_ACCELERATION, "slider_acceleration_m_s2"),
        )
        if motion[slider_key].number is not None
    ]
    rows = []
    for solution in record["solutions"]:
        rates = (value_from_record(solution, key) for key, _ in rate_columns)
        rows.append((value_from_record(solution, "crank_angle_deg"), solution["stroke"] or "dead centre", *rates))
    heads = (column("crank angle", ANGLE), column("stroke (counter-clockwise)", left=True))
    return [
        sentence("slider: {given}", given=joined(motion_texts)),
        Table((*heads, *(head for _, head in rate_columns)), tuple(rows), ruled=True),
    ]
