"""Motion of the crank in a job file, [motion]: it rotates fully, or swings between two angles."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, TypeAlias, cast

from pydantic import Field, create_model

from ...model.errors import InputError, JobError
from ...model.machine.mechanism import Mechanism, Start
from ...model.machine.varying_numbers import Varying
from ...model.swing.swing import Swing
from ...model.swing.swing_types import Driver, Law, Side, Stated
from ...objectives.kinds import ANGLE
from ...objectives.lever_geometry import LEVER_TRANSMISSION_ANGLE
from ...objectives.machine_needs import SPEED
from ...objectives.quantity import Quantity
from ...objectives.swing_quantities import SWING_TRANSMISSION_ANGLE
from ...objectives.tables.swing_columns import reason_undefined_for_swing, swing_quantity_facts
from ..problem.requirements import Constraint
from .crank_speed import SPEED_KEYS, CrankSpeedPart
from .value_types import Angle, Checked, Clearance, Length, Part, PositiveTime, optional_entry

_TURN, _SWING = "turn", "swing"
_MARGIN = ANGLE.metric.factor * (SWING_TRANSMISSION_ANGLE.floor or 0.0)


def _swing_of_table(
    kind: str,
    *,
    margin: float | None = None,
    actuator_tolerance: float = 0.0,
    driver: Driver = "crank",
    law: Law = "slow",
    duration: float | None = None,
    law_times: tuple[float, ...] = (),
    law_shares: tuple[float, ...] = (),
    crank_side: Side = "left",
    **ends: float,
) -> Swing | None:
    """Return the swing that a table states; None for a crank that rotates fully."""
    if kind == _TURN:
        swing_keys = [
            *ends,
            *(["duration"] if duration is not None else []),
            *(["margin"] if margin is not None else []),
        ]
        swing_keys += ["actuator_tolerance"] if actuator_tolerance else []
        swing_keys += [f"driver {driver}"] if driver != "crank" else []
        swing_keys += [f"law {law}"] if law != "slow" else []
        swing_keys += ["law_times or law_shares"] if law_times or law_shares else []
        swing_keys += [f"crank_side {crank_side}"] if crank_side != "left" else []
        if swing_keys:
            raise InputError(
                f"keys of a swing must not be given for a rotating crank; got {', '.join(swing_keys)}; "
                'write kind = "swing", or leave them out'
            )
        return None
    end_kind = _swing_end_kind(set(ends))
    start, span = ends[_STARTS[end_kind]], ends.get(_SPANS[end_kind])
    if end_kind == "crank" and crank_side != "left":
        raise InputError(
            f"crank_side may only be given with slider positions; got {crank_side} with crank angles; leave it out"
        )
    return Swing(
        start=start,
        end=ends[_ENDS[end_kind]] if span is None else start + span,
        driver=driver,
        law=law,
        duration=duration,
        actuator_tolerance=actuator_tolerance,
        stated_for=end_kind,
        side=crank_side,
        follows=span is not None,
        points=_law_points(law, law_times, law_shares),
    )


def _law_points(law: Law, times: tuple[float, ...], shares: tuple[float, ...]) -> tuple[tuple[float, float], ...]:
    """Return the points of a law that is stated as a table. Raises `InputError` for lists of different lengths."""
    if law == "table" and not times:
        raise InputError(
            "a tabulated motion law needs fractions of the time and of the travel; got no law_times; for example, "
            "add law_times = [0, 0.3, 0.7, 1], law_shares = [0, 0.2, 0.8, 1]"
        )
    if len(times) != len(shares):
        raise InputError(
            f"law_times and law_shares must have the same number of values; got {len(times)} and {len(shares)}; give "
            "a fraction of the travel for each fraction of the time"
        )
    return tuple(zip(times, shares, strict=True))


_STARTS: dict[Stated, str] = {"crank": "from", "slider": "slider_from"}
_ENDS: dict[Stated, str] = {"crank": "to", "slider": "slider_to"}
_SPANS: dict[Stated, str] = {"crank": "swing", "slider": "slider_travel"}


def _swing_end_kind(keys: set[str]) -> Stated:
    """Return the kind of a swing's ends.

    Raises `InputError` unless there are a start and an end, or a start and a span.
    """
    stated_kinds = [end_kind for end_kind in _STARTS if keys & {_STARTS[end_kind], _ENDS[end_kind], _SPANS[end_kind]}]
    if len(stated_kinds) > 1:
        raise InputError(
            f"a swing must be given by two crank angles or by two slider positions; got {', '.join(sorted(keys))}; "
            "leave out those of one kind"
        )
    end_kind = stated_kinds[0] if stated_kinds else "crank"
    if _STARTS[end_kind] not in keys or len(keys) < 2:
        missing = [name for name in (_STARTS[end_kind], _ENDS[end_kind]) if name not in keys]
        missing = missing if _SPANS[end_kind] not in keys else [_STARTS[end_kind]]
        raise InputError(
            f"a swing needs two {_PLACES[end_kind]}s, a start and an end; {' and '.join(missing)} is missing; for "
            f"example, add {_EXAMPLES[end_kind]}"
        )
    if len(keys) > 2:
        raise InputError(
            f"{_ENDS[end_kind]} is where {_SPANS[end_kind]} leads from {_STARTS[end_kind]}; got all three; leave out "
            "one of the first two"
        )
    return end_kind


_PLACES: dict[Stated, str] = {"crank": "crank angle", "slider": "slider position"}
_EXAMPLES: dict[Stated, str] = {
    "crank": 'from = "11 deg", to = "101 deg"',
    "slider": 'slider_from = "3.1 m", slider_to = "0.8 m"',
}


class _Motion(Checked[Swing | None]):
    """Motion of the crank: it rotates fully, or it swings back and forth between two angles."""

    makes: ClassVar = _swing_of_table

    @property
    def start_ranges(self) -> Start:
        """Ranges of the swing's start, if designs choose it."""
        keys = _STARTS["crank"], _STARTS["slider"]
        return Start(angle=getattr(self, keys[0]), place=getattr(self, keys[1]))

    @property
    def required_transmission_angle(self) -> float | None:
        """Minimum transmission angle of the swing that the table requires, rad."""
        return cast("float | None", getattr(self, "margin"))  # noqa: B009


_Shares = Annotated[tuple[Annotated[float, Field(ge=0.0, le=1.0)], ...], Field(max_length=200)]
_ENTRIES: dict[str, Any] = {
    "kind": (
        Literal["turn", "swing"],
        optional_entry(
            "turn: full rotation at the speed in [mechanism]; swing: between two angles", _SWING, default=_TURN
        ),
    ),
    "from": (Angle | None, optional_entry("crank angle at the start of the forward stroke", "11 deg")),
    "to": (
        Angle | None,
        optional_entry("crank angle at its end; smaller than at the start means clockwise", "101 deg"),
    ),
    "swing": (Angle | None, optional_entry("instead of to: angle of the swing; below 0 means clockwise", "90 deg")),
    "slider_from": (
        Length | None,
        optional_entry("instead of crank angles: slider position at the start of the forward stroke", "3.1 m"),
    ),
    "slider_to": (Length | None, optional_entry("slider position at its end", "0.8 m")),
    "slider_travel": (
        Length | None,
        optional_entry("instead of slider_to: travel; below 0 means towards -x", "-2.3 m"),
    ),
    "crank_side": (
        Side,
        optional_entry(
            "with slider positions: the side of the crank pin, looking along the line from crank pivot to slider pin",
            "right",
            default="left",
        ),
    ),
    "driver": (
        Driver,
        optional_entry(
            "driven body: the crank by a torque, or the slider by a force along its line", "slider", default="crank"
        ),
    ),
    "law": (Law, optional_entry("motion law of the driver; slow ignores inertia", "polynomial", default="slow")),
    "duration": (PositiveTime | None, optional_entry("of one stroke, for a law other than slow", "30 s")),
    "law_times": (
        _Shares,
        optional_entry("for the law table: fractions of the time of one stroke", [0, 0.3, 0.7, 1], default=()),
    ),
    "law_shares": (
        _Shares,
        optional_entry("for the law table: fractions of the travel at these times", [0, 0.2, 0.8, 1], default=()),
    ),
    "actuator_tolerance": (
        Clearance,
        optional_entry(
            "position tolerance of the driven slider; adds to the error of the crank angle", "1 mm", default=0.0
        ),
    ),
    "margin": (
        Angle | None,
        optional_entry(
            "least transmission angle of the driven side, the distance from dead points and from opening; default "
            f"{_MARGIN:g} deg; same as a min of constraints.{SWING_TRANSMISSION_ANGLE.name}",
            "20 deg",
        ),
    ),
}
if TYPE_CHECKING:
    MotionPart: TypeAlias = _Motion
else:  # a class cannot have a field named "from"
    MotionPart = create_model("MotionPart", __base__=_Motion, __doc__=_Motion.__doc__, **_ENTRIES)


def require_swing_motion(swing: Swing | None, objectives: Part, constraints: Part) -> None:
    """Raise JobError if a job requires a quantity of a swing that its motion does not have."""
    for table, part in (("objectives", objectives), ("constraints", constraints)):
        for quantity in swing_quantity_facts():
            reason = (
                reason_undefined_for_swing(quantity.name, swing) if getattr(part, quantity.name) is not None else None
            )
            if reason is not None:
                raise JobError(f"{table}.{quantity.name}: {reason}")


def require_constant_swing_speed(varying: Iterable[str]) -> None:
    """Raise JobError for a swing with a varying crank speed. varying: paths set by variables and options."""
    for path in (*(f"mechanism.{key}" for key in (*SPEED_KEYS, "direction")), "mechanism.acceleration"):
        if path in varying:
            raise JobError(
                f"{path}: a swing is set by [motion] instead; got it as a variable or in an option; leave it out"
            )


def require_crank_speed(
    mechanism: CrankSpeedPart, machine: Mechanism, quantities: Iterable[Quantity], slow_stroke: bool
) -> None:
    """Raise JobError if a fully rotating crank has no speed but a requirement or objective depends on it.

    quantities: those in objectives and constraints. slow_stroke: whether the job states the slow stroke.
    """
    if mechanism.speed_keys:
        return
    dependent_keys = [key for key in ("direction", "acceleration", "speed_profile") if getattr(mechanism, key)]
    dependents = [*dependent_keys, *(["slow_stroke"] if slow_stroke else [])]
    lacking = ((quantity, quantity.undefined_because([machine])) for quantity in quantities)
    dependents += [
        quantity.name
        for quantity, why in lacking
        if (SPEED.missing in why if why else quantity.depends_on_speed(machine))
    ][:1]
    if dependents:
        raise JobError(
            "mechanism.speed: is missing, but required unless cycle_time or strokes_per_minute is given; "
            f"{dependents[0]} "
            'depends on it; for example, add speed = "300 rpm"'
        )


def require_only_start_varies(varying: Mapping[str, bool]) -> None:
    """Raise JobError if a number of [motion] other than the start varies.

    varying: paths, and whether they are chosen.
    """
    free = {f"motion.{name}" for name in _STARTS.values()}
    for path, chosen in varying.items():
        if path.startswith("motion.") and path not in free:
            raise JobError(
                f"{path}: only the start of a swing may vary; got {path.removeprefix('motion.')} as a variable; give "
                "it in [motion] only; for several values solve a job for each, and compare them with `slidercrank "
                "compare`"
            )
        if path.startswith("motion.") and chosen:
            raise JobError(
                f"{path}: the start of a swing must vary over a range; got a choice; write its least and greatest "
                "value, with swing or slider_travel in [motion] if the end moves with it"
            )


def require_starts_on_one_side_of_end(motion: Swing | None, varying: tuple[Varying, ...]) -> None:
    """Raise JobError if starts may lie on both sides of a fixed end, because the best swing would vanish."""
    if motion is None or motion.follows:
        return
    name = _STARTS[motion.stated_for]
    factor, unit = (ANGLE.metric.factor, "deg") if motion.stated_for == "crank" else (1e3, "mm")
    for item in varying:
        if item.name == f"motion.{name}" and item.lower <= motion.end <= item.upper:
            raise JobError(
                f"motion.{name}: starts must lie on one side of the end of the swing, where the swing vanishes; "
                f"got {factor * item.lower:.6g} to {factor * item.upper:.6g} {unit} with an end at "
                f"{factor * motion.end:.6g} {unit}; narrow the range, or give {_SPANS[motion.stated_for]} instead "
                f"of {_ENDS[motion.stated_for]}"
            )


def with_swing_margin(
    constraints: tuple[Constraint, ...], margin: float | None, swing: Swing | None
) -> tuple[Constraint, ...]:
    """Return constraints with a swing's margin. Raises JobError if both tables require one."""
    if margin is None:
        return constraints
    of_lever = swing is not None and swing.of_lever
    name = (LEVER_TRANSMISSION_ANGLE if of_lever else SWING_TRANSMISSION_ANGLE).name
    constraint = next((item for item in constraints if item.quantity == name), None)
    if constraint is not None and constraint.lower is not None:
        raise JobError(f"motion.margin: same as the min of constraints.{name}; got both; leave out one of the two")
    upper = None if constraint is None else constraint.upper
    if upper is not None and margin > upper:
        raise JobError(
            f"motion.margin: must not exceed constraints.{name}, which is at most "
            f"{ANGLE.metric.factor * upper:.6g} deg; got {ANGLE.metric.factor * margin:.6g} deg; lower it"
        )
    if not 0.0 < margin < 0.5 * math.pi:
        raise JobError(
            f"motion.margin: must be more than 0 and less than 90 deg; got {ANGLE.metric.factor * margin:.6g} deg; "
            "20 to 40 deg are usual"
        )
    rest = tuple(item for item in constraints if item.quantity != name)
    return (*rest, Constraint(quantity=name, lower=margin, upper=upper))
