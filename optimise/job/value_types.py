"""Types of the values in a job file: physical values, ranges and tolerances, converted to SI.

Each type states in the JSON Schema what it accepts, and can read what it writes: SI numbers are also valid in a job.
"""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Generic, Self, TypeVar, cast

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    create_model,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from ...model.errors import InputError
from ...model.machine.loads import load
from ...model.machine.mechanism import Tolerance
from ...objectives import kinds, units
from ...objectives.kinds import Kind
from ...objectives.units import Sign, plus_minus_ends, quote, to_si
from .named_files import SOURCE
from .value_grids import Grid, crossed_ends_remedy, grid_schema, read_grid, states_value_grid

SHORTEST = 1e-9
"""m; a shorter link has a mistaken unit."""


class Part(BaseModel):
    """A table of a job file: unknown keys raise an error, and nothing changes after reading."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


def required_entry(description: str, *examples: object, default: Any = ..., **rules: Any) -> Any:
    """Return a required entry of a table. rules: further arguments for pydantic's `Field`."""
    return Field(default, description=description, examples=list(examples), **rules)


def optional_entry(description: str, *examples: object, default: Any = None, **rules: Any) -> Any:
    """Return an optional entry of a table; if omitted, it is `default`."""
    return required_entry(description, *examples, default=default, **rules)


Source = Annotated[str, Field(max_length=2000)] | None
"""Type of the key for a file's summary."""


def summary_entry() -> Any:
    """Return the entry for the summary of a file whose content a table holds; the problem ignores it."""
    return optional_entry("data read from the file that contains the values", "motion.csv: 360 rows")


Made = TypeVar("Made")
Table = TypeVar("Table", bound=Part)


class Built(Part, Generic[Made]):
    """A table that states a part of the model, entry by entry; the model has the defaults.

    makes: builds the part from its values. renamed: the model's name for an entry if it differs.
    """

    makes: ClassVar[Callable[..., object]]
    renamed: ClassVar[Mapping[str, str]] = {}

    def build(self) -> Made:
        """Return the part of the model that the table states. Raises InputError for incompatible values."""
        names = [name for name in type(self).model_fields if name != SOURCE]
        arguments = {self.renamed.get(name, name): getattr(self, name) for name in names}
        parts = {name: part.build() if isinstance(part, Built) else part for name, part in arguments.items()}
        return cast(Made, type(self).makes(**{name: part for name, part in parts.items() if part is not None}))


class Checked(Built[Made], Generic[Made]):
    """A table with possibly incompatible values, so it is built when it is read."""

    @model_validator(mode="after")
    def _require_buildable(self) -> Self:
        self.build()
        return self


def with_entry_types(part: type[Table], **types: Any) -> type[Table]:
    """Return a table with other types for some of its entries."""
    fields: Any = {name: (new_type, part.model_fields[name]) for name, new_type in types.items()}
    return cast(type[Table], create_model(part.__name__, __base__=part, **fields))


PLAIN = "plain_number"
"""Validation context that finds numbers without a unit; also the type of its errors, with places and kinds."""


def flatten_values(value: object) -> list[object]:
    """Return the values in a list, or in a table of values and lists; a single value becomes a list."""
    items = list(value.values()) if isinstance(value, Mapping) else [value]
    return [entry for item in items for entry in (item if isinstance(item, list | tuple) else [item])]


def plain_numbers_in(value: object) -> list[float]:
    """Return the finite numbers without a unit in a value, a list, or a table of values. Zero needs no unit."""
    numbers = (x for x in flatten_values(value) if isinstance(x, int | float) and not isinstance(x, bool) and x)
    return [x for x in numbers if isinstance(x, int) or math.isfinite(x)]


def plus_minus_error(value: object, ends: Sequence[object], error: InputError) -> InputError:
    """Return the error for a range with invalid ends; `error` itself for a value without ends."""
    if ends[0] == value:
        return error
    rule = str(error).partition(";")[0]
    return InputError(
        f"{rule}; got {quote(value)}, which is {ends[0]} to {ends[1]}; "
        "correct its unit, its middle value or the part after +-"
    )


class _ValueMarker:
    """Marks a value that `read` converts to SI. kind: kind of numbers without a unit."""

    kind: Kind

    def read(self, value: object) -> object:
        raise NotImplementedError

    def _validate(self, value: object, info: core_schema.ValidationInfo) -> object:
        """Read a value; in the validation context `PLAIN`, raise an error for one with numbers without a unit."""
        plain = info.context == PLAIN and self.kind.unit and not self.kind.amount and plain_numbers_in(value)
        try:
            result_in_si = self.read(value)
        except InputError:
            if not plain:
                raise
        if plain:
            raise PydanticCustomError(PLAIN, "has no unit", {"kind": self.kind})
        return result_in_si

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self._validate)


@dataclass(frozen=True)
class Physical(_ValueMarker):
    """Marks a number as a physical value of a kind, read by `to_si`."""

    kind: Kind
    sign: Sign = "any"

    def read(self, value: object) -> float:
        """Return the value in SI; raises InputError."""
        return to_si(value, self.kind, sign=self.sign)

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return physical_value_schema(self.kind, self.sign)


@dataclass(frozen=True)
class ProperFraction(Physical):
    """Marks a number of at most 1, which people may state in percent. example: replaces the kind's example."""

    example: str = "0.9"

    def read(self, value: object) -> float:
        """Return the number; raises InputError."""
        percentage = re.fullmatch(r"\s*(\d+(?:\.\d+)?)\s*%\s*", value, re.ASCII) if isinstance(value, str) else None
        if percentage is not None and 0.0 < float(percentage[1]) <= 100.0:
            written = f"{float(percentage[1]) / 100.0:g}"
            raise InputError(f"must be a fraction of at most 1; got {quote(value)}; write {written}")
        return to_si(value, replace(self.kind, example=self.example), sign=self.sign)


class GasPressure(Physical):
    """Marks the absolute pressure of a gas: a value below vacuum is usually a gauge pressure."""

    def read(self, value: object) -> float:
        """Return the pressure, Pa; raises InputError."""
        pressure = to_si(value, self.kind)
        if pressure < 0.0 or (pressure == 0.0 and self.sign == "positive"):
            rule = "above vacuum, 0" if self.sign == "positive" else "at or above vacuum, 0"
            raise InputError(
                f"an absolute pressure must be {rule}; got {quote(value)}; add the ambient pressure, about 1.01325 "
                "bar, to a gauge pressure"
            )
        return pressure


@dataclass(frozen=True, kw_only=True)
class PhysicalWithin(Physical):
    """Marks a physical value between limits, SI; a value beyond them has the wrong unit.

    rule, hint: for the error message.
    """

    rule: str
    hint: str
    least: float
    greatest: float

    def read(self, value: object) -> float:
        """Return the value in SI; raises InputError."""
        number = super().read(value)
        if not self.least <= number <= self.greatest:
            raise InputError(f"must be {self.rule}; got {quote(value)}; {self.hint}")
        return number

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        value_schema = super().__get_pydantic_json_schema__(schema, handler)
        number = {"type": "number", "minimum": self.least, "maximum": self.greatest}
        if "anyOf" not in value_schema:  # for kinds without a unit, text is not allowed
            return {key: subschema for key, subschema in value_schema.items() if key != "exclusiveMinimum"} | number
        return value_schema | {
            "anyOf": [number if subschema.get("type") == "number" else subschema for subschema in value_schema["anyOf"]]
        }


@dataclass(frozen=True)
class Limited:
    """Marks a number between limits, also in the schema.

    greater_than: an excluded limit. rule, hint: for the error message.
    """

    rule: str
    hint: str
    least: float | None = None
    greater_than: float | None = None
    greatest: float | None = None

    def require_within_limits(self, value: float) -> float:
        """Return a value within the limits; raises InputError."""
        low = (self.least is not None and value < self.least) or (
            self.greater_than is not None and value <= self.greater_than
        )
        if low or (self.greatest is not None and value > self.greatest):
            raise InputError(f"must be {self.rule}; got {value:g}; {self.hint}")
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self.require_within_limits, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        value_schema: dict[str, Any] = handler(schema)
        limits = {"minimum": self.least, "exclusiveMinimum": self.greater_than, "maximum": self.greatest}
        stated = {word: limit for word, limit in limits.items() if limit is not None}
        lower = {"minimum", "exclusiveMinimum"}
        return {key: rule for key, rule in value_schema.items() if not (key in lower and lower & set(stated))} | stated


def physical_value_schema(kind: Kind, sign: Sign = "any") -> dict[str, Any]:
    """Return the JSON Schema of a physical value: a number in SI, or a string with a unit."""
    number: dict[str, Any] = {"type": "number"}
    if sign == "any":
        number["minimum"] = -kind.limit
    else:
        number["exclusiveMinimum" if sign == "positive" else "minimum"] = 0
    number["maximum"] = kind.limit
    if not kind.unit:
        return {**number, "description": kind.name, "examples": [float(kind.example)]}
    text = f"{kind.name}, as a number and a unit in a string, or as a number in {kind.unit}"
    string = {"type": "string", "pattern": units.PATTERN}
    return {"anyOf": [string, number], "description": text, "examples": [kind.example]}


@dataclass(frozen=True)
class Choices:
    """Lengths, m, from which one is selected; ascending."""

    choices: tuple[float, ...]


_ENDS = re.compile(r"\s*([\d.]*\d)\s*([a-zµ]*)\s*(?:-|–|—|,|;|\.{2,}|…|to|bis)\s*([\d.]*\d)\s*([a-zµ]+)\s*")
"""A range within a single text."""


@dataclass(frozen=True)
class RangeOf(_ValueMarker):
    """Marks a range of a length: [lower, upper], one value, { choices = [...] }, or a table of values."""

    sign: Sign = "any"
    kind = kinds.LENGTH

    def read(self, value: object) -> tuple[float, float] | Choices | Grid:
        """Return the lower and upper end, m, or the possible values; raises InputError."""
        if isinstance(value, Choices | Grid):
            return value
        if isinstance(value, Mapping) and states_value_grid(value):
            return read_grid(value, self._read_length)
        if isinstance(value, Mapping) and set(value) == {"choices"}:
            return self._read_choices(value["choices"])
        ends = value if isinstance(value, list | tuple) else plus_minus_ends(value) or (value, value)
        text = value[0] if isinstance(value, list | tuple) and len(value) == 1 else value
        if isinstance(text, str) and (two := _ENDS.fullmatch(text)):
            write = f'["{two[1]} {two[2] or two[4]}", "{two[3]} {two[4]}"]'
            raise InputError(f"each end of a range must be a separate string; got {quote(value)}; write {write}")
        if len(ends) != 2:
            write = 'write it like ["20 mm", "200 mm"]'
            if len(ends) == 3:
                keys = (f"{key} = {quote(end)}" for key, end in zip(("min", "max", "step"), ends, strict=True))
                write = f"for a range with steps write {{ {', '.join(keys)} }}"
            raise InputError(f"must be one value or a range [lower, upper]; got {quote(value)}; {write}")
        try:
            lower, upper = (self._read_length(end) for end in ends)
        except InputError as error:
            raise (error if isinstance(value, list | tuple) else plus_minus_error(value, ends, error)) from None
        if lower > upper:
            raise InputError(
                f"must run from its lower to its upper end; got {quote(ends[0])} to {quote(ends[1])}, an empty range; "
                f"{crossed_ends_remedy(*ends)}"
            )
        return lower, upper

    def _read_length(self, value: object) -> float:
        length = to_si(value, kinds.LENGTH, sign=self.sign)
        if self.sign == "positive" and length < SHORTEST:
            raise InputError(f"must be at least {SHORTEST:g} m; got {quote(value)}; check the unit")
        return length

    def _read_choices(self, values: object) -> Choices:
        if not isinstance(values, list | tuple) or len(values) < 2:
            raise InputError(f'choices must be at least two lengths, like ["100 mm", "125 mm"]; got {quote(values)}')
        lengths = sorted(self._read_length(value) for value in values)
        if len(set(lengths)) < len(lengths):
            raise InputError(f"choices must differ; got {quote(values)}; leave out the second")
        return Choices(tuple(lengths))

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        entryschemas = physical_value_schema(kinds.LENGTH, self.sign)["anyOf"]
        if self.sign == "positive":
            number = {key: rule for key, rule in entryschemas[1].items() if key != "exclusiveMinimum"} | {
                "minimum": SHORTEST
            }
            entryschemas = [entryschemas[0], number]
        pair = {"type": "array", "items": {"anyOf": entryschemas}, "minItems": 2, "maxItems": 2}
        choices = {
            "type": "object",
            "properties": {"choices": {"type": "array", "items": {"anyOf": entryschemas}, "minItems": 2}},
            "required": ["choices"],
            "additionalProperties": False,
        }
        return {
            "anyOf": [pair, *entryschemas, choices, *grid_schema(entryschemas)],
            "examples": [["20 mm", "200 mm"], "140 mm"],
        }


_FIT = replace(kinds.LENGTH, believed=(1e-8, 1e-2))
"""Tolerances and clearances, which are smaller than links."""


class ToleranceOf(_ValueMarker):
    """Marks a value as the tolerance of a length: "0.05 mm", or a fraction of the length, "0.1 %"."""

    kind = _FIT

    @staticmethod
    def fraction_of_length(value: object) -> float | None:
        """Return the fraction that a string such as "0.1 %" states; None if it is not a percentage."""
        if not (isinstance(value, str) and value.rstrip().endswith("%")):
            return None
        try:
            percent = to_si(value.rstrip()[:-1], kinds.RATIO)
        except InputError:
            percent = -1.0
        if not 0.0 <= percent < 100.0:
            raise InputError(
                f"a percentage of the dimension must be from 0 % to below 100 %; got {quote(value)}; write it like "
                '"0.1 %"'
            )
        return percent / 100.0

    @classmethod
    def read(cls, value: object) -> float | str:
        """Return the tolerance in m, or the percentage unchanged; raises InputError."""
        if cls.fraction_of_length(value) is not None:
            return str(value)
        return to_si(value, kinds.LENGTH, sign="zero or more")

    @classmethod
    def build(cls, value: float | str) -> Tolerance:
        """Return the tolerance in the form that the model uses."""
        if isinstance(value, str):
            return Tolerance(fraction=cls.fraction_of_length(value) or 0.0)
        return Tolerance(absolute=value)

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        share = {"type": "string", "pattern": r"^\s*[0-9.eE+-]+\s*%\s*$"}
        either = [*physical_value_schema(kinds.LENGTH, "zero or more")["anyOf"], share]
        return {"anyOf": either, "examples": ["0.05 mm", "0.1 %"]}


class PartOfStroke(_ValueMarker):
    """Marks a value as a part of a stroke: "first 20 mm", "last 60 mm" or "whole stroke"."""

    kind = kinds.LENGTH
    _text: ClassVar = re.compile(r"\s*(?:the\s+)?(first|last|whole)\s+(.*?)\s*", re.IGNORECASE)

    def read(self, value: object) -> load.StrokePart:
        """Return the part with its length in m; raises InputError."""
        if isinstance(value, load.StrokePart):
            return value
        match = self._text.fullmatch(value) if isinstance(value, str) else None
        part = match[1].lower() if match else ""
        if not match or (part == "whole" and f"{part} {match[2].lower()}" != "whole stroke"):
            raise InputError(
                f'must be "first" or "last" and a length, or "whole stroke"; got {quote(value)}; write it like '
                '"last 60 mm"'
            )
        if part == "whole":
            return load.StrokePart()
        kind = replace(self.kind, example=f"{part} 60 mm")
        length = to_si(match[2], kind, sign="positive", plain=False)
        return load.StrokePart("first" if part == "first" else "last", length)

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        written = core_schema.plain_serializer_function_ser_schema(repr)
        return core_schema.with_info_plain_validator_function(self._validate, serialization=written)

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        pattern = r"^\s*([Tt]he\s+)?([Ww]hole\s+stroke|([Ff]irst|[Ll]ast)\s+.*\d.*)\s*$"
        return {"type": "string", "pattern": pattern, "examples": ["last 60 mm"]}


Length = Annotated[float, Physical(kinds.LENGTH)]
PositiveLength = Annotated[float, Physical(kinds.LENGTH, "positive")]
Radius = Annotated[float, Physical(kinds.LENGTH, "zero or more")]
Clearance = Annotated[float, Physical(_FIT, "zero or more")]
PositiveClearance = Annotated[float, Physical(_FIT, "positive")]
Angle = Annotated[float, Physical(kinds.ANGLE)]
AngleTolerance = Annotated[float, Physical(replace(kinds.ANGLE, believed=(0.0, 0.01)), "zero or more")]
"""A plain number of 0.01 rad = 0.57 deg or more was probably meant in degrees."""
AngularSpeed = Annotated[float, Physical(kinds.ANGULAR_SPEED)]
PositiveAngularSpeed = Annotated[float, Physical(kinds.ANGULAR_SPEED, "positive")]
AngularAcceleration = Annotated[float, Physical(kinds.ANGULAR_ACCELERATION)]
Mass = Annotated[float, Physical(kinds.MASS, "zero or more")]
Inertia = Annotated[float, Physical(kinds.INERTIA, "zero or more")]
Density = Annotated[float, Physical(kinds.DENSITY, "positive")]
Gravity = Annotated[float, Physical(kinds.ACCELERATION, "zero or more")]
PositiveTime = Annotated[float, Physical(kinds.TIME, "positive")]
Force = Annotated[float, Physical(kinds.FORCE)]
NonNegativeForce = Annotated[float, Physical(kinds.FORCE, "zero or more")]
Resistance = Annotated[float, Physical(kinds.FORCE, "positive")]
Stiffness = Annotated[float, Physical(kinds.STIFFNESS, "positive")]
AngularStiffness = Annotated[float, Physical(kinds.ANGULAR_STIFFNESS, "positive")]
Damping = Annotated[float, Physical(kinds.DAMPING, "positive")]
QuadraticDamping = Annotated[float, Physical(kinds.QUADRATIC_DAMPING, "positive")]
Torque = Annotated[float, Physical(kinds.TORQUE)]
PositiveTorque = Annotated[float, Physical(kinds.TORQUE, "positive")]
DrivingTorque = Annotated[float, Physical(kinds.TORQUE, "zero or more")]
Loss = Annotated[float, Physical(kinds.POWER, "zero or more")]
Pressure = Annotated[float, Physical(kinds.PRESSURE, "positive")]
WearCoefficient = Annotated[float, Physical(kinds.WEAR, "positive")]
AbsolutePressure = Annotated[float, GasPressure(kinds.PRESSURE, "positive")]
LeastPressure = Annotated[float, GasPressure(kinds.PRESSURE, "zero or more")]
HeatPerVolume = Annotated[float, Physical(kinds.HEAT_PER_VOLUME, "zero or more")]
Volume = Annotated[float, Physical(kinds.VOLUME, "zero or more")]
Number = Annotated[float, Physical(kinds.RATIO)]
Fraction = Annotated[float, Physical(kinds.RATIO, "zero or more")]
PositiveRatio = Annotated[float, Physical(kinds.RATIO, "positive")]
GasExponent = Annotated[
    PositiveRatio, Limited("from 0.2 to 10", "1 is isothermal, 1.4 adiabatic air", least=0.2, greatest=10.0)
]
CompressionRatio = Annotated[PositiveRatio, Limited("above 1", "6 to 20 are usual", greater_than=1.0)]
HeatCapacityRatio = Annotated[PositiveRatio, Limited("above 1", "1.4 is cold air, 1.3 burnt gas", greater_than=1.0)]
Efficiency = Annotated[
    float,
    ProperFraction(kinds.RATIO, "positive"),
    Limited("at most 1", "0.9 to 0.98 are usual; write 90 % as 0.9", greatest=1.0),
]
Recovery = Annotated[
    float,
    ProperFraction(kinds.RATIO, "zero or more", "0.8"),
    Limited("at most 1", "it is a fraction; write 80 % as 0.8", greatest=1.0),
]
PositiveRange = Annotated[tuple[float, float] | Choices | Grid, RangeOf("positive")]
AnyRange = Annotated[tuple[float, float] | Choices | Grid, RangeOf()]
LengthTolerance = Annotated[float | str, ToleranceOf()]
StrokePart = Annotated[load.StrokePart, PartOfStroke()]
