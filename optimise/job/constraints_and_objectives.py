"""Constraints and objectives in a job file: one optional key per quantity, with values in its dimension.

Besides the quantities, [constraints] may have the key `slow_stroke`, whose value is a word. Keys of both tables and
bounds may also be formulas.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple, Self, TypeAlias, cast

from pydantic import (
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetJsonSchemaHandler,
    ModelWrapValidatorHandler,
    SerializerFunctionWrapHandler,
    Tag,
    ValidationError,
    create_model,
    model_serializer,
    model_validator,
)
from pydantic_core import CoreSchema

from ...model.errors import InputError, JobError
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import SlowStroke
from ...objectives.formula.formulas import ROOTS, Formulas, is_formula
from ...objectives.kinds import RATIO, Kind
from ...objectives.registry import FACTS
from ...objectives.units import closest_word, plus_minus_ends, quote, quoted_if_unprintable
from ..problem.requirements import SENSES, Constraint, Objective, Word
from .mistake_messages import key_of_location, toml_text
from .value_grids import crossed_ends_remedy
from .value_types import Part, Physical, optional_entry, plus_minus_error, required_entry


class Bounds(Part):
    """Bounds of a quantity: min, max or both, or equals alone. The fields depend on its unit."""

    @model_validator(mode="wrap")
    @classmethod
    def _require_possible_bounds(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        if isinstance(data, Mapping) and set(data) == {"equals"} and (ends := plus_minus_ends(data["equals"])):
            try:
                bounds = handler(dict(zip(("min", "max"), ends, strict=True)))
            except ValidationError as error:
                refused = error.errors()[0].get("ctx", {}).get("error")
                raise (
                    plus_minus_error(data["equals"], ends, refused) if isinstance(refused, InputError) else error
                ) from None
        else:
            bounds = handler(data)
        lower, upper, equals = (getattr(bounds, name) for name in ("min", "max", "equals"))
        if lower is None and upper is None and equals is None:
            raise InputError("must have min, max or equals; got an empty table; add one of the three")
        if equals is not None and not (lower is None and upper is None):
            stated = data if isinstance(data, Mapping) else {"equals": equals, "min": lower, "max": upper}
            bounds_text = " and ".join(
                f"{word} {quote(stated[word])}" for word in ("equals", "min", "max") if word in stated
            )
            raise InputError(
                f"equals cannot be combined with min or max; got {bounds_text}; leave out equals or the other"
            )
        both_numbers = isinstance(lower, float) and isinstance(upper, float)  # a formula is still text
        if both_numbers and lower > upper:
            raise InputError(_crossed_bounds_text(data if isinstance(data, Mapping) else {"min": lower, "max": upper}))
        return bounds


def _crossed_bounds_text(bounds: Mapping[Any, object]) -> str:
    return (
        f"min must not exceed max; got min {quote(bounds['min'])} and max {quote(bounds['max'])}; "
        f"{crossed_ends_remedy(bounds['min'], bounds['max'])} or leave out one"
    )


class Target(Part):
    """A value to approach as closely as possible. The field depends on the quantity's unit."""


_NAMED = "[A-Za-z_]{3}"
"""Pattern of bounds that are formulas, which contain a name."""


@dataclass(frozen=True)
class _BoundMarker(Physical):
    """Marks a bound: a physical value, or a formula, which stays text until its names are known."""

    names: frozenset[str] = frozenset()

    def read(self, value: object) -> Any:
        if isinstance(value, str) and is_formula(value, self.names):
            return value
        return super().read(value)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        value_schema = super().__get_pydantic_json_schema__(schema, handler)
        annotations = {key: value_schema.pop(key) for key in ("description", "examples")}
        return {
            "anyOf": [*value_schema.get("anyOf", [value_schema]), {"type": "string", "pattern": _NAMED}],
            **annotations,
        }


class _FormulaBoundMarker(Physical):
    """Marks a bound on a formula, which is parsed once the formula's kind is known."""

    def read(self, value: object) -> Any:
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise InputError(f'must be a value with a unit, such as "1 mm", or a number in SI; got {quote(value)}')
        return value

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"type": "string"}, {"type": "number"}]}


_RAW = Annotated[Any, _FormulaBoundMarker(RATIO)]


class FormulaBounds(Bounds):
    """Bounds on a formula: values of its kind, or formulas."""

    min: _RAW | None = optional_entry("least", "1 mm")
    max: _RAW | None = optional_entry("greatest", "400 mm")
    equals: _RAW | None = optional_entry("exact value", "0 mm", "3.2 * offset")


class FormulaTarget(Target):
    """Target value for a formula."""

    target: _RAW = required_entry("to come near to", "2 mm")


WORDS: tuple[Word, ...] = ("min", "max", "equals")
SLOW_STROKE = "slow_stroke"
"""The requirement that is a single word."""
_SENSES = '"minimise", "maximise" or { target = value }'


def _check_sense(value: object) -> object:
    """Reject a value that is neither a known word nor a table."""
    if isinstance(value, str):
        if value in SENSES and value != "target":
            return SENSES[value]
        near = closest_word(value, ("minimise", "maximise"))
        hint = f'; did you mean "{near}"?' if near else ""
        raise InputError(f"must be {_SENSES}; got {quote(value)}{hint}")
    if not isinstance(value, Mapping | Target):
        raise InputError(f"must be {_SENSES}; got {quote(value)}")
    return value


_KEY = "(formulas)"
"""Key of formulas within a table, in brackets, so that messages omit it."""
_PATTERN = rf"[^A-Za-z0-9_]|^({'|'.join(DIMENSIONS)})$"
_IS_FORMULA = re.compile(_PATTERN)


def _formulas_to_key_pattern(schema: dict[str, Any]) -> None:
    """Convert a table's formulas to a key pattern in its JSON Schema."""
    inner = schema["properties"].pop(_KEY)
    schema["patternProperties"] = {_PATTERN: inner["additionalProperties"]}


def _rejoin_dotted_key(path: str, value: object) -> tuple[str, object]:
    """Return the first path of a key that dots split into tables, and its value."""
    while isinstance(value, Mapping) and value and not {*WORDS, "target"} & set(value):
        key, value = next(iter(value.items()))
        path = f"{path}.{key}"
    return path, value


class _Table(Part):
    """A table whose keys are quantities or formulas. named: formulas with a name in the job."""

    model_config = ConfigDict(json_schema_extra=_formulas_to_key_pattern)
    named: ClassVar[frozenset[str]] = frozenset()

    @model_validator(mode="before")
    @classmethod
    def _split_formulas(cls, data: Any) -> Any:
        """Move formulas to a separate table."""
        if not isinstance(data, Mapping):
            return data
        for key in (key for key in ROOTS if isinstance(data.get(key), Mapping)):
            path, value = _rejoin_dotted_key(key, data[key])
            raise InputError(
                f"a key with dots must be in quotes, like a formula; got "
                f"{quoted_if_unprintable(path)} without; write it as {toml_text(path)} = {toml_text(value)}"
            )
        keys = [key for key in data if isinstance(key, str) and cls._is_formula(key)]
        rest = {key: value for key, value in data.items() if key not in keys}
        return rest | {_KEY: {key: data[key] for key in keys}} if keys else data

    @model_serializer(mode="wrap")
    def _serialise_with_formulas(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Return the table as in a job file, with formulas among the other keys."""
        data: dict[str, Any] = handler(self)
        formulas: dict[str, Any] = data.pop("formulas", data.pop(_KEY, {}))
        return data | formulas

    @classmethod
    def _is_formula(cls, key: str) -> bool:
        is_key = key in cls.model_fields or key == _KEY
        return key in cls.named or (not is_key and _IS_FORMULA.search(key) is not None)


class Stated(NamedTuple):
    """Facts about a quantity for the tables of a job: title, kind, usual value and usual bound."""

    title: str
    kind: Kind
    example: str | float
    bound: Literal["min", "max"] = "min"


def constraint_and_objective_tables(
    custom_facts: Mapping[str, Stated], named: Iterable[str] = ()
) -> tuple[type[Part], type[Part]]:
    """Return the tables [constraints] and [objectives], with one optional key per quantity.

    custom_facts: a job's quantities besides those that every job has. named: its formulas with a name.
    """
    limits: dict[str, Any] = {}
    wishes: dict[str, Any] = {}
    forms: dict[Kind, tuple[Any, Any]] = {}
    names = frozenset((*custom_facts, *named))
    product_facts = {
        name: Stated(fact.title, fact.kind, fact.usual_value, "max" if fact.better == "low" else "min")
        for name, fact in FACTS.items()
    }
    for name, (title, kind, example, bound) in (product_facts | dict(custom_facts)).items():
        if kind not in forms:
            forms[kind] = _bound_and_objective_types(kind, names)
        bounds, wish = forms[kind]
        limits[name] = (bounds | None, optional_entry(title, {bound: example}))
        wishes[name] = (wish | None, optional_entry(title, "minimise", {"target": example}))
    slow = optional_entry("the slow stroke; determines offset and direction of rotation", "outward")
    limits[SLOW_STROKE] = (SlowStroke | None, slow)
    limits["formulas"] = (dict[str, FormulaBounds], Field(default={}, alias=_KEY))
    several: Any = dict
    wishes["formulas"] = (several[str, _target_type(FormulaTarget)], Field(default={}, alias=_KEY))
    constraints = create_model("Constraints", __base__=_Table, **cast(Any, limits))
    objectives = create_model("Objectives", __base__=_Table, **cast(Any, wishes))
    for table in (constraints, objectives):
        table.named = frozenset(named)
    return constraints, objectives


def _bound_and_objective_types(kind: Kind, names: frozenset[str]) -> tuple[Any, Any]:
    """Return the types of the bounds and of the objective for quantities of one kind.

    names: names for formulas in bounds.
    """
    value, bound = Annotated[float, Physical(kind)], Annotated[Any, _BoundMarker(kind, names=names)]
    name = kind.name_without_article.title().replace(" ", "")
    example = [kind.example if kind.unit else float(kind.example)]
    help_of = {"min": "least", "max": "greatest", "equals": "exact value"}
    limits: Any = {word: (bound | None, optional_entry(text, *example)) for word, text in help_of.items()}
    bounds = create_model(f"{name}Bounds", __base__=Bounds, **limits)
    target_field: Any = {"target": (value, required_entry("to come near to", *example))}
    target = create_model(f"{name}Target", __base__=Target, **target_field)
    return bounds, _target_type(target)


def _target_type(target: type[Target]) -> Any:
    """Return the type of an objective whose target has a given type."""
    words = Literal["minimise", "maximise", "minimize", "maximize"]
    return Annotated[
        Annotated[words, Tag("(word)")] | Annotated[target, Tag("(target)")],
        Discriminator(lambda value: "(word)" if isinstance(value, str) else "(target)"),
        BeforeValidator(_check_sense),
    ]


if TYPE_CHECKING:  # type checkers cannot follow fields that are created from the list of quantities
    ConstraintsPart: TypeAlias = Part
    ObjectivesPart: TypeAlias = Part
else:
    ConstraintsPart, ObjectivesPart = constraint_and_objective_tables({})


def constraints_of(
    part: ConstraintsPart, formulas: Formulas | None = None, key: str = "constraints."
) -> Iterator[Constraint]:
    """Return a job's constraints for the problem. formulas: those of the job; None if its tables have none.

    key: their key, for messages. Raises JobError for an invalid formula, and for bounds that exclude every value.
    """
    for name, bounds in _table_entries(part):
        if name == SLOW_STROKE:
            continue
        stated_bounds = {word: value for word in WORDS if (value := getattr(bounds, word)) is not None}
        if all(isinstance(value, float) for value in stated_bounds.values()) and name in FACTS:
            yield Constraint(quantity=name, **_lower_and_upper_of_bounds(stated_bounds))
        elif formulas is not None:
            yield from _bounds_of_formula(f"{key}{key_of_location([name])}", name, stated_bounds, formulas)


def _bounds_of_formula(key: str, name: str, bounds: Mapping[Word, object], formulas: Formulas) -> Iterator[Constraint]:
    """Yield the constraints on a formula, or on a quantity bounded by formulas; those on one quantity are merged."""
    of = formulas.quantity_of_text(name, key)
    merged_bounds: dict[str, dict[Word, float]] = {}
    for word, value in bounds.items():
        bounded, bound = formulas.quantity_and_bound(of, value, f"{key}.{word}")
        merged_bounds.setdefault(bounded.name, {})[word] = bound
    for quantity, ends in merged_bounds.items():
        if "min" in ends and "max" in ends and ends["min"] > ends["max"]:
            raise JobError(f"{key}: {_crossed_bounds_text(bounds)}")
        yield Constraint(quantity=quantity, **_lower_and_upper_of_bounds(ends))


def _lower_and_upper_of_bounds(bounds: Mapping[Word, Any]) -> dict[str, float | None]:
    equals = bounds.get("equals")
    return {"lower": bounds.get("min", equals), "upper": bounds.get("max", equals)}


def _table_entries(part: Part) -> Iterator[tuple[str, Any]]:
    """Yield name and value of a table's entries: quantities, then formulas."""
    for name in type(part).model_fields:
        value = getattr(part, name)
        if name == "formulas":
            yield from value.items()
        elif value is not None:
            yield name, value


def slow_stroke_of(part: ConstraintsPart) -> SlowStroke | None:
    """Return which stroke the job requires to be the slow one."""
    return cast(SlowStroke | None, getattr(part, SLOW_STROKE))


def objectives_of(part: ObjectivesPart, formulas: Formulas) -> Iterator[Objective]:
    """Return a job's objectives in the form that the problem uses. Raises JobError for an invalid formula."""
    for name, wish in _table_entries(part):
        key = f"objectives.{key_of_location([name])}"
        of = formulas.quantity_of_text(name, key)
        if isinstance(wish, Target):
            target = cast(Any, wish).target
            if isinstance(wish, FormulaTarget):
                of, target = formulas.quantity_and_bound(of, target, f"{key}.target")
            yield Objective(quantity=of.name, sense="target", target=target)
        else:
            yield Objective(quantity=of.name, sense=wish)
