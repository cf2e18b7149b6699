"""What a topic is asked with besides its design: declared once, read from the words of every door."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ...model.errors import InputError
from ...objectives.kinds import Kind


@dataclass(frozen=True)
class Input:
    """A value that a topic is asked with.

    name: the parameter of the topic's `numbers`, which has its default. kind: of the value, in SI there. title: before
    the field of a form. help: of the option, with the default in brackets. usual: the default, as it is typed, "" if
    there is none. option: of the command line, without dashes, if it is not the name. positive: whether it must be.
    below: what it must be less than, in SI. drawn: whether the topic's figure takes it too.
    """

    name: str
    kind: Kind
    title: str
    help: str
    usual: str = ""
    option: str = ""
    positive: bool = False
    below: float | None = None
    drawn: bool = True

    @property
    def key(self) -> str:
        """Name in the API, whose numbers are metric: its unit is its end."""
        return self.name + self.kind.metric.suffix

    @property
    def flag(self) -> str:
        """Option of the command line, with its dashes."""
        return f"--{(self.option or self.name).replace('_', '-')}"

    @property
    def default(self) -> float:
        """The default in SI."""
        return self.read(self.usual, self.name)

    @property
    def remark(self) -> str:
        """The help with the default."""
        usual = f'"{self.usual}"' if self.kind.unit else self.usual
        return f"{self.help}  [default: {usual}]" if self.usual else self.help

    def read(self, given: object, word: str) -> float:
        """Return the value in SI of a text with its unit, or of a number in SI.

        word: what the door calls the input. Raises `InputError` that begins with it.
        """
        from ...objectives.units import shown, to_si
        from ..designs.selection import value_of

        sign: Any = "positive" if self.positive else "any"
        if isinstance(given, str):
            value = value_of(word, given, self.kind, sign=sign)
        else:
            try:
                value = to_si(given, self.kind, sign=sign)
            except InputError as error:
                raise InputError(f"{word} {error}") from None
        if self.below is not None and value >= self.below:
            limit = f"{self.kind.metric.factor * self.below:g} {self.kind.metric.symbol}".rstrip()
            raise InputError(f"{word} must be less than {limit}; got {shown(given)}; write it like {self.usual}")
        return value


def read_inputs(inputs: Sequence[Input], given: Mapping[str, object], topic: str) -> dict[str, float]:
    """Return the values, in SI, of the inputs that are given by name; None is not given.

    Raises `InputError` for one that the topic does not have.
    """
    known = {one.name: one for one in inputs}
    for name in given:
        if name not in known:
            rule = f"{topic} is asked with {', '.join(known)}" if known else f"{topic} is asked with nothing else"
            raise InputError(f"{rule}; got {name}; leave {name} out")
    return {name: known[name].read(value, name) for name, value in given.items() if value is not None}
