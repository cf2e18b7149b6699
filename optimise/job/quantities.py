"""Constraints and objectives in a job file: one optional key for each quantity, its values in the unit's dimension.

Beside the quantities [constraints] has `slow_stroke`, a word.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Self, TypeAlias, cast

from pydantic import (
    BeforeValidator,
    Discriminator,
    ModelWrapValidatorHandler,
    Tag,
    create_model,
    model_validator,
)

from ...model.errors import InputError
from ...model.linkage.linkage import SlowStroke
from ...objectives.kinds import Kind
from ...objectives.registry import FACTS
from ..problem.requirements import SENSES, Constraint, Objective
from .units import closest, shown
from .values import Part, Physical, optional, required


class Bounds(Part):
    """Bounds of a quantity: min, max or both, or equals alone. The fields follow from its unit."""

    @model_validator(mode="wrap")
    @classmethod
    def _possible(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        bounds = handler(data)
        lower, upper, equals = (getattr(bounds, name) for name in ("min", "max", "equals"))
        if lower is None and upper is None and equals is None:
            raise InputError("must say min, max or equals; got an empty table; add one of the three")
        if equals is not None and not (lower is None and upper is None):
            raise InputError("must have either equals, or min and max; got both; leave out one of the two")
        if lower is not None and upper is not None and lower > upper:
            given = data if isinstance(data, Mapping) else {"min": lower, "max": upper}
            raise InputError(
                f"min must not exceed max; got min {shown(given['min'])} and max "
                f"{shown(given['max'])}, which no design can meet; swap the two or leave out one"
            )
        return bounds


class Target(Part):
    """A value to come near to. The field follows from the unit of the quantity."""


SLOW_STROKE = "slow_stroke"
"""The requirement that is a word."""
_WANTED = '"minimise", "maximise" or { target = value }'


def _sense(value: object) -> object:
    """Refuse what is neither a known word nor a table."""
    if isinstance(value, str):
        if value in SENSES and value != "target":
            return SENSES[value]
        near = closest(value, ("minimise", "maximise"))
        meant = f'; did you mean "{near}"?' if near else ""
        raise InputError(f"must be {_WANTED}; got {shown(value)}{meant}")
    if not isinstance(value, Mapping | Target):
        raise InputError(f"must be {_WANTED}; got {shown(value)}")
    return value


def _form(value: object) -> str:
    return "(word)" if isinstance(value, str) else "(target)"


class Stated(NamedTuple):
    """Facts of a quantity that the tables of a job have: title, kind and a usual value."""

    title: str
    kind: Kind
    example: str | float


def tables(own: Mapping[str, Stated]) -> tuple[type[Part], type[Part]]:
    """Return the tables [constraints] and [objectives]: one optional key for each quantity.

    own: quantities that a job has besides those that every job has.
    """
    limits: dict[str, Any] = {}
    wishes: dict[str, Any] = {}
    made: dict[Kind, tuple[Any, Any]] = {}
    known = {name: Stated(of.title, of.kind, of.usual) for name, of in FACTS.items()}
    for name, (title, kind, example) in (known | dict(own)).items():
        if kind not in made:
            made[kind] = _forms(kind)
        bounds, wish = made[kind]
        limits[name] = (bounds | None, optional(title, {"min": example}))
        wishes[name] = (wish | None, optional(title, "minimise", {"target": example}))
    slow = optional("which stroke is the slow one; the offset and the sense of rotation follow it", "outward")
    limits[SLOW_STROKE] = (SlowStroke | None, slow)
    constraints = create_model("Constraints", __base__=Part, **cast(Any, limits))
    objectives = create_model("Objectives", __base__=Part, **cast(Any, wishes))
    return constraints, objectives


def _forms(kind: Kind) -> tuple[Any, Any]:
    """Return the types of the bounds and of the objective of a quantity of one kind."""
    value = Annotated[float, Physical(kind)]
    name = kind.plain.title().replace(" ", "")
    example = [kind.example if kind.unit else float(kind.example)]
    help_of = {"min": "least", "max": "greatest", "equals": "exact value"}
    limits: Any = {word: (value | None, optional(text, *example)) for word, text in help_of.items()}
    bounds = create_model(f"{name}Bounds", __base__=Bounds, **limits)
    wanted: Any = {"target": (value, required("to come near to", *example))}
    target = create_model(f"{name}Target", __base__=Target, **wanted)
    words = Literal["minimise", "maximise", "minimize", "maximize"]
    wish = Annotated[
        Annotated[words, Tag("(word)")] | Annotated[target, Tag("(target)")],
        Discriminator(_form),
        BeforeValidator(_sense),
    ]
    return bounds, wish


if TYPE_CHECKING:  # a type checker cannot follow fields that are made from the list of quantities
    ConstraintsPart: TypeAlias = Part
    ObjectivesPart: TypeAlias = Part
else:
    ConstraintsPart, ObjectivesPart = tables({})


def constraints_of(part: ConstraintsPart) -> Iterator[Constraint]:
    """Return the constraints of a job as the problem has them."""
    for name in type(part).model_fields:
        bounds = getattr(part, name) if name != SLOW_STROKE else None
        if bounds is not None and bounds.equals is not None:
            yield Constraint(quantity=name, lower=bounds.equals, upper=bounds.equals)
        elif bounds is not None:
            yield Constraint(quantity=name, lower=bounds.min, upper=bounds.max)


def slow_stroke_of(part: ConstraintsPart) -> SlowStroke | None:
    """Return which stroke a job wants to be the slow one."""
    return cast(SlowStroke | None, getattr(part, SLOW_STROKE))


def objectives_of(part: ObjectivesPart) -> Iterator[Objective]:
    """Return the objectives of a job as the problem has them."""
    for name in type(part).model_fields:
        wish = getattr(part, name)
        if isinstance(wish, Target):
            yield Objective(quantity=name, sense="target", target=cast(Any, wish).target)
        elif wish is not None:
            yield Objective(quantity=name, sense=wish)
