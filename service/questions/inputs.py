"""Inputs of questions: declared once, parsed identically in every interface."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, get_args, get_origin

from ...model.errors import InputError, number_in_si_and_usual_unit, warn_user
from ...objectives.kinds import DisplayUnit, Kind
from ...objectives.units import Sign, quote


@dataclass(frozen=True)
class Input:
    """Input of a question.

    name: parameter of the question's `numbers`, which has its default. kind: kind of the value, which is in SI there;
    None for a word. title: label of its field in a form. help: help text of the option, with the default in brackets.
    usual: default as typed, "" if there is none. option: command-line option, without dashes, if it differs from the
    name. sign: required sign of the value. below: exclusive upper bound, in SI. drawn: whether the figure accepts it
    too. example: example as typed. words: `Literal` with the allowed words. loose: whether words may be capitalised,
    with - or _ for spaces. required: whether it is mandatory.
    """

    name: str
    kind: Kind | None = None
    title: str = ""
    help: str = ""
    usual: str = ""
    option: str = ""
    sign: Sign = "any"
    upper_limit: float | None = None
    drawn: bool = True
    example: str = ""
    words: Any = None
    loose: bool = False
    required: bool = False

    @property
    def unit(self) -> DisplayUnit:
        """Unit in the API, where numbers are metric."""
        return DisplayUnit("", "") if self.kind is None else self.kind.metric

    @property
    def key(self) -> str:
        """Name in the API, which ends with the unit."""
        return self.name + self.unit.suffix

    @property
    def flag(self) -> str:
        """Command-line option with its dashes."""
        return f"--{(self.option or self.name).replace('_', '-')}"

    @property
    def default(self) -> float:
        """Default in SI."""
        return float(self.read(self.usual, self.name))

    @property
    def schema(self) -> dict[str, Any]:
        """JSON Schema of an agent's value: text with a unit, or a word."""
        return {"type": "string", **({"enum": list(get_args(self.words))} if self.words else {})}

    @property
    def remark(self) -> str:
        """Help text with the default or an example."""
        typed = self.usual or self.example
        quoted = f'"{typed}"' if self.unit.symbol else typed
        return f"{self.help}  [{'default' if self.usual else 'example'}: {quoted}]" if typed else self.help

    def read(self, raw: object, word: str) -> Any:
        """Return the SI value of a text with a unit or of a number; words are unchanged.

        word: name of the input in the interface, with which error messages begin. Raises `InputError`; warns about a
        number that is only plausible in another unit.
        """
        from ...model.machine.loads.load import require_word
        from ..designs.selection import parse_value

        if self.kind is None:
            if self.loose and isinstance(raw, str):
                raw = raw.strip().casefold().replace("-", " ").replace("_", " ")
            require_word(word, raw, self.words)
            return raw
        kind = replace(self.kind, example=self.usual or self.example or self.kind.example)
        value = parse_value(word, raw, kind, sign=self.sign)
        if not isinstance(raw, str) and kind.believed is not None and abs(value) > kind.believed[1]:
            doubt = number_in_si_and_usual_unit(f"{word} =", value, kind.unit, self.unit.symbol, self.unit.factor)
            warn_user(f"inputs of questions must be in SI: {doubt}", through_callers=True)
        if self.upper_limit is not None and value >= self.upper_limit:
            limit = f"{self.unit.factor * self.upper_limit:g} {self.unit.symbol}".rstrip()
            raise InputError(f"{word} must be less than {limit}; got {quote(raw)}; write it like {self.usual}")
        return value

    def with_unit(self, number: float | str) -> str:
        """Return a number from the API as text with its unit; words are unchanged."""
        return number if isinstance(number, str) else f"{number!r} {self.unit.symbol}"


def read_inputs(
    inputs: Sequence[Input], raw_values: Mapping[str, object], question: str, words: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """Return the SI values of inputs given by name; None counts as omitted.

    words: the interface's names for them, if different. Raises `InputError` for an unknown input or a missing required
    one.
    """
    labels = {item.name: item.name for item in inputs} | dict(words or {})
    by_name = {item.name: item for item in inputs}
    for name in raw_values:
        if name not in by_name:
            rule = f"{question} may only be given {', '.join(by_name)}" if by_name else f"{question} has no inputs"
            raise InputError(f"{rule}; got {name}; leave {name} out")
    values = {name: by_name[name].read(value, labels[name]) for name, value in raw_values.items() if value is not None}
    for item in inputs:
        if item.required and item.name not in values:
            raise InputError(f"{question} needs {labels[item.name]}; got none; give it like {item.example}")
    return values


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
    text_of_name: dict[str, str] = {}
    for text in texts:
        name, equals, value = (piece.strip() for piece in str(text).rpartition("="))
        if not (equals and name and value):
            raise InputError(f"{word} must be {form}; got {quote(text)}; write it like {example}")
        if name in text_of_name:
            raise InputError(f"{word} may give each name only once; got {name} twice; leave out one")
        text_of_name[name] = value
    return text_of_name
