"""Types of the answers of questions, from which JSON Schemas follow: keys, their kinds, and why a value is null.

An answer is what the function `numbers` of a question returns: a `Record`, a typed dictionary that mypy checks, or,
where its keys follow from data, a dictionary with `Keys`. The unit of a number is the end of its key.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, NotRequired

from typing_extensions import TypedDict

from ...objectives.keys import split_unit
from ...objectives.kinds import Kind

_Handler = Callable[[Any], dict[str, Any]]


@dataclass(frozen=True)
class Note:
    """Description of a value in a schema, such as why it is null."""

    text: str

    def __get_pydantic_json_schema__(self, core: Any, handler: _Handler) -> dict[str, Any]:
        return {**handler(core), "description": self.text}


@dataclass(frozen=True)
class _Boundless:
    def __get_pydantic_json_schema__(self, core: Any, handler: _Handler) -> dict[str, Any]:
        return {"anyOf": [handler(core), {"enum": ["inf", "-inf"]}]}


PossiblyInfinite = Annotated[float | None, _Boundless()]
"""A number that may be infinite: JSON has "inf" and "-inf" for that."""
PeakAngle = Annotated[float | None, Note("null where the curve is constant or not determined")]
NullIfLocked = Annotated[float | None, Note("null where friction locks or may jam the linkage")]


class Record(TypedDict):
    """A record of JSON that has no other keys. A text below a key describes it."""


def _title(key: str, _: object = None) -> str:
    """Return the title of a key: "peak torque, N m"."""
    numerator, per, denominator = key.partition("_per_")
    name, unit, _factor = split_unit(numerator)
    words = [name.replace("_", " "), *([f"per {denominator.replace('_', ' ')}"] if per else [])]
    if unit:
        words[0] += f", {unit}"
    return " ".join(words)


_CLOSED = {"extra": "forbid", "use_attribute_docstrings": True, "field_title_generator": _title}
Record.__pydantic_config__ = _CLOSED  # type: ignore[attr-defined]


@dataclass(frozen=True)
class Keys:
    """Keys of a record that follow from data.

    types: by key, `NotRequired` where the record need not have it. text: describes the record. count: of the keys that
    a record has, if that is known.
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
    """Return keys of numbers, each name with the unit of one of some kinds."""
    return {f"{name}{kind.metric.suffix}": NotRequired[NullIfLocked] for name in names for kind in kinds}


@dataclass(frozen=True)
class AnswerSchema:
    """Schema of a record of JSON that answers one of some questions, in metric or in inch units.

    types: gives those of the answers. names: of the answers in a metric record that has some of them beside others;
    without, the record is one of them.
    """

    types: Callable[[], list[Any]]
    names: Iterable[str] = ()

    def __get_pydantic_json_schema__(self, core: Any, handler: _Handler) -> dict[str, Any]:
        from pydantic import TypeAdapter

        cores = [{"type": "list", "items_schema": TypeAdapter(type_).core_schema} for type_ in self.types()]
        answers = [handler(type_)["items"] for type_ in cores]  # what is in a list is described once, and referred to
        if self.names:
            return {**handler(core), "properties": dict(zip(self.names, answers, strict=True))}
        inches = {"type": "object", "description": "in inch units: the same with keys that end in those"}
        return {"anyOf": [*answers, inches]}


def schema_of(type_: Any) -> dict[str, Any]:
    """Return the JSON Schema of a metric answer."""
    from pydantic import TypeAdapter

    return TypeAdapter(type_).json_schema(mode="serialization")
