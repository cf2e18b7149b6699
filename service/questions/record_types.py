"""Types of the answers to questions, from which JSON Schemas follow: keys, their kinds, reasons for null.

The function `numbers` of a question returns the answer as a `Record`, a typed dictionary that mypy checks. If its keys
follow from data, the answer is a dictionary with `Keys`. The key of a number ends with its unit.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, NotRequired

from typing_extensions import TypedDict

from ...objectives.kinds import Kind, name_unit_and_factor_of_key

_Handler = Callable[[Any], dict[str, Any]]


@dataclass(frozen=True)
class Note:
    """Description of a value in a schema, for example why it is null."""

    text: str

    def __get_pydantic_json_schema__(self, core: Any, handler: _Handler) -> dict[str, Any]:
        return {**handler(core), "description": self.text}


@dataclass(frozen=True)
class _Boundless:
    def __get_pydantic_json_schema__(self, core: Any, handler: _Handler) -> dict[str, Any]:
        return {"anyOf": [handler(core), {"enum": ["inf", "-inf"]}]}


PossiblyInfinite = Annotated[float | None, _Boundless()]
"""A number that may be infinite: JSON uses "inf" and "-inf" for that."""
PeakAngle = Annotated[float | None, Note("null where the curve is constant or not determined")]
NullIfLocked = Annotated[float | None, Note("null where friction locks or may jam the linkage")]


class Record(TypedDict):
    """JSON record that allows no other keys. A string below a key describes it."""


class ShakingNumbers(Record):
    """Shaking by inertia; root mean squares are over time."""

    peak_shaking_force_N: float
    peak_shaking_force_angle_deg: PeakAngle
    rms_shaking_force_N: float
    peak_shaking_moment_Nm: Annotated[float, Note("Moment about the crank pivot.")]
    peak_shaking_moment_angle_deg: PeakAngle
    rms_shaking_moment_Nm: float


def _title_with_unit(key: str, _: object = None) -> str:
    """Return the title of a key: "peak torque, N m"."""
    numerator, per, denominator = key.partition("_per_")
    name, unit, _factor = name_unit_and_factor_of_key(numerator)
    words = [name.replace("_", " "), *([f"per {denominator.replace('_', ' ')}"] if per else [])]
    if unit:
        words[0] += f", {unit}"
    return " ".join(words)


_CLOSED = {"extra": "forbid", "use_attribute_docstrings": True, "field_title_generator": _title_with_unit}
Record.__pydantic_config__ = _CLOSED  # type: ignore[attr-defined]


@dataclass(frozen=True)
class Keys:
    """Keys of a record that follow from data.

    types: types by key, `NotRequired` for optional keys. text: description of the record. count: number of keys in a
    record, if known.
    """

    name: str
    text: str
    types: Mapping[str, Any]
    count: int | None = None

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        typed: Any = TypedDict
        record = typed(self.name, dict(self.types))
        number = {} if self.count is None else {"minProperties": self.count, "maxProperties": self.count}
        record.__doc__ = self.text
        record.__pydantic_config__ = {**_CLOSED, "use_attribute_docstrings": False, "json_schema_extra": number}
        return handler.generate_schema(record)


def keys_of_kinds(names: Iterable[str], kinds: Iterable[Kind]) -> dict[str, Any]:
    """Return number keys that combine each name with the unit of each kind."""
    return {f"{name}{kind.metric.suffix}": NotRequired[NullIfLocked] for name in names for kind in kinds}


@dataclass(frozen=True)
class RecordSchema:
    """Schema of a JSON record that answers one of several questions, in metric or inch units.

    types: function that returns the types of the answers. names: keys of the answers in a metric record that has other
    keys too; without names, the record is a single answer.
    """

    types: Callable[[], list[Any]]
    names: Iterable[str] = ()

    def __get_pydantic_json_schema__(self, core: Any, handler: _Handler) -> dict[str, Any]:
        from pydantic import TypeAdapter

        cores = [{"type": "list", "items_schema": TypeAdapter(type_).core_schema} for type_ in self.types()]
        answers = [handler(type_)["items"] for type_ in cores]  # list items are described once, and referenced
        if self.names:
            return {**handler(core), "properties": dict(zip(self.names, answers, strict=True))}
        inches = {"type": "object", "description": "in inch units: the same with other key endings"}
        return {"anyOf": [*answers, inches]}


def schema_of(type_: Any) -> dict[str, Any]:
    """Return the JSON Schema of a metric answer."""
    from pydantic import TypeAdapter

    return TypeAdapter(type_).json_schema(mode="serialization")
