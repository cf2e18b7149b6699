"""Inputs with a plain type instead of a physical kind: numbers, texts, texts by name."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, get_origin

from ...model.errors import InputError
from .inputs import Input


@dataclass(frozen=True, kw_only=True)
class PlainInput(Input):
    """Input with a plain type instead of a physical kind.

    type: a number, `str`, a `list` of texts, or a `dict` of texts by name, typed as "name=text" on the command line.
    least: minimum of a number. limits: limits in services, as named by `pydantic.Field`. served: default in services,
    if different. form: form of a text with a name, "REQUIREMENT=AMOUNT". metavar: placeholder of the option. sent:
    example in a body.
    """

    type: Any = float
    least: float | None = None
    limits: Mapping[str, Any] = field(default_factory=dict)
    served: str = ""
    form: str = ""
    metavar: str | None = None
    sent: Any = None

    @property
    def value(self) -> Any:
        """The default; None for texts."""
        return self.type(self.usual) if self.usual else None

    @property
    def served_value(self) -> Any:
        """Default in services."""
        return self.type(self.served) if self.served else self.value

    @property
    def schema(self) -> dict[str, Any]:
        """JSON Schema of an agent's value."""
        return dict(self._adapter.json_schema())

    @property
    def _adapter(self) -> Any:
        from pydantic import Field, TypeAdapter

        kind: Any = self.type if self.least is None else Annotated[self.type, Field(ge=self.least)]
        return TypeAdapter(kind)

    def with_unit(self, number: Any) -> Any:
        """Return a value from the API unchanged: it has no unit."""
        return number

    def read(self, raw: object, word: str) -> Any:
        """Return the number, the texts, or the texts by name.

        Raises `InputError`, whose message begins with the word.
        """
        from pydantic import ValidationError

        from ...objectives.units import quote
        from ...optimise.job.mistake_messages import broken_rule

        form = get_origin(self.type)
        value: Any = [raw] if isinstance(raw, str) and form in (list, dict) else raw
        value = list(value) if isinstance(value, tuple) else value
        if form is dict and isinstance(value, list):
            value = texts_by_name(value, word, self.form, self.example)
        try:
            return self._adapter.validate_python(value, strict=True)
        except ValidationError as error:
            rule, received = broken_rule(error.errors(include_url=False)[0]), quote(raw)
            raise InputError(f"{word} {rule}; got {received}; write it like {self.usual or self.example}") from None


def texts_by_name(texts: Sequence[object], word: str, form: str, example: str) -> dict[str, str]:
    """Return texts such as "stroke=0.1 mm" by their names. word: first word of messages.

    Raises `InputError` for a text in any other form, and for a repeated name.
    """
    from ...objectives.units import quote

    text_of_name: dict[str, str] = {}
    for text in texts:
        name, equals, value = (piece.strip() for piece in str(text).rpartition("="))
        if not (equals and name and value):
            raise InputError(f"{word} must be {form}; got {quote(text)}; write it like {example}")
        if name in text_of_name:
            raise InputError(f"{word} may give each name only once; got {name} twice; leave out one")
        text_of_name[name] = value
    return text_of_name
