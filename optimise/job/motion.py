"""Motion of the crank in a job file, [motion]: it turns through, or swings between two angles."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, cast

from pydantic import create_model

from ...model.errors import InputError, JobError
from ...model.swing.swing import Swing
from ...model.swing.words import Driver, Law
from ...objectives.kinds import ANGLE
from ...objectives.swing_geometry import SWING_TRANSMISSION_ANGLE
from ...objectives.tables.swinging import swing_facts
from ..problem.requirements import Constraint
from .values import Angle, AngleTolerance, Checked, Clearance, Part, PositiveTime, optional

_TURN, _SWING = "turn", "swing"
_MARGIN = ANGLE.metric.factor * (SWING_TRANSMISSION_ANGLE.floor or 0.0)


def _swing(
    kind: str,
    *,
    margin: float | None = None,
    actuator_tolerance: float = 0.0,
    driver: Driver = "crank",
    law: Law = "slow",
    duration: float | None = None,
    **ends: float,
) -> Swing | None:
    """Return the swing that a table states; None for a crank that turns through."""
    if kind == _TURN:
        given = [*ends, *(["duration"] if duration is not None else []), *(["margin"] if margin is not None else [])]
        given += ["actuator_tolerance"] if actuator_tolerance else []
        given += [f"driver {driver}"] if driver != "crank" else []
        given += [f"law {law}"] if law != "slow" else []
        if given:
            raise InputError(
                f"a crank that turns through has none of what a swing has; got {', '.join(given)}; "
                'write kind = "swing", or leave it out'
            )
        return None
    if set(ends) != {"from", "to"}:
        missing = " and ".join(sorted({"from", "to"} - set(ends)))
        raise InputError(
            f'a swing runs from one crank angle to another; got no {missing}; add for example from = "11 deg", '
            'to = "101 deg"'
        )
    return Swing(
        start=ends["from"],
        end=ends["to"],
        driver=driver,
        law=law,
        duration=duration,
        actuator_tolerance=actuator_tolerance,
    )


class _Motion(Checked[Swing | None]):
    """How the crank moves: it turns through, or it swings between two angles, forth and back."""

    makes: ClassVar = _swing

    @property
    def margin_asked(self) -> float | None:
        """Least transmission angle of the swing that the table asks for, rad."""
        return cast("float | None", getattr(self, "margin"))  # noqa: B009


_ENTRIES: dict[str, Any] = {
    "kind": (
        Literal["turn", "swing"],
        optional("turn: through, at the speed of [mechanism]; swing: between two angles", _SWING, default=_TURN),
    ),
    "from": (Angle | None, optional("crank angle at which the way forth starts", "11 deg")),
    "to": (Angle | None, optional("crank angle at which it ends; less than the first one is clockwise", "101 deg")),
    "driver": (
        Driver,
        optional(
            "what is driven: the crank by a torque, or the slider by a force along its line", "slider", default="crank"
        ),
    ),
    "law": (Law, optional("how the driver moves over time; slow is without inertia", "polynomial", default="slow")),
    "duration": (PositiveTime | None, optional("of one way, for a law other than slow", "30 s")),
    "actuator_tolerance": (
        Clearance,
        optional("how far the driven slider may be off: adds to the error of the crank", "1 mm", default=0.0),
    ),
    "margin": (
        AngleTolerance | None,
        optional(
            "from the dead points, or from opening: the least transmission angle of the driven side, "
            f"{_MARGIN:g} deg if left out; a min of constraints.{SWING_TRANSMISSION_ANGLE.name} says the same",
            "20 deg",
        ),
    ),
}
if TYPE_CHECKING:
    MotionPart: TypeAlias = _Motion
else:  # "from" is no name of a field in a class
    MotionPart = create_model("MotionPart", __base__=_Motion, __doc__=_Motion.__doc__, **_ENTRIES)


def require_swing_asked(swing: Swing | None, objectives: Part, constraints: Part) -> None:
    """Raise JobError if a job asks for a quantity of a swing that its motion does not have."""
    for table, part in (("objectives", objectives), ("constraints", constraints)):
        for of in swing_facts():
            if getattr(part, of.name) is None:
                continue
            if swing is None:
                raise JobError(
                    f"{table}.{of.name}: it is of a crank that swings; got one that turns through; add "
                    '[motion] kind = "swing" with from and to, or leave it out'
                )
            reason = of.unfit(swing)
            if reason is not None:
                raise JobError(f"{table}.{of.name}: {reason}")


def require_speed(swing: Swing | None, speed: float | None, varying: Iterable[str]) -> None:
    """Raise JobError for a crank that turns through at no speed, and for a swing with a varying one.

    varying: paths of the numbers that variables and options set.
    """
    if swing is None:
        if speed is None:
            raise JobError('mechanism.speed: is missing, but required; add for example speed = "300 rpm"')
        return
    for path in ("mechanism.speed", "mechanism.acceleration"):
        if path in varying:
            raise JobError(
                f"{path}: a swing has a motion of its own, that of [motion]; got it as a variable, or in an option; "
                "leave it out"
            )


def with_margin(constraints: tuple[Constraint, ...], margin: float | None) -> tuple[Constraint, ...]:
    """Return constraints with the margin of a swing. Raises JobError where both tables ask for one."""
    if margin is None:
        return constraints
    name = SWING_TRANSMISSION_ANGLE.name
    own = next((item for item in constraints if item.quantity == name), None)
    if own is not None and own.lower is not None:
        raise JobError(f"motion.margin: it is the min of constraints.{name}; got both; leave out one of the two")
    upper = None if own is None else own.upper
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
