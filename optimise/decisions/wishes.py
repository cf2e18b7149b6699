"""Wishes for a front's objectives: values, or classes relative to one of its designs.

A value, "110 N m", is an aspiration level, not a bound: the design comes as close as possible. The classes are those of
NIMBUS (K. Miettinen and M. M. Mäkelä, "Synchronous approach in interactive multiobjective optimization", Eur. J. Oper.
Res. 170(3), 2006): an objective must improve on the design's value, must not be worse, may worsen to a given value, or
is free. Objectives that are not named are free.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...model.errors import InputError
from ...objectives.swing_quantity import SwingQuantity
from ...objectives.units import quote, to_si
from ..front.front import ParetoFront
from ..problem.constraint_violation import minimised_values

Kind = Literal["value", "improve", "keep", "limit", "free"]
_LIMIT = re.compile(r"(?:may\s+)?worsen\s+to\s+(.+)", re.IGNORECASE)
_NUMBER = re.compile(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?", re.IGNORECASE)
_VALUE = tuple("+-.0123456789")  # how one begins
_WORDS = 'a value such as "{example}", "improve", "keep", "may worsen to {example}" or "free"'


@dataclass(frozen=True)
class Wish:
    """A wish for one objective.

    value: its quantity's desired value, or the one it may worsen to, SI; otherwise None.
    """

    kind: Kind
    value: float | None = None


FREE = Wish("free")


def read_wishes(front: ParetoFront, texts: Mapping[str, object], row: int | None) -> tuple[Wish, ...]:
    """Return the wish for each objective, in order.

    texts: by objective, a number in SI, "110 N m", "improve", "keep", "may worsen to 120 N m" or "free". row: row of
    the design to which improve, keep and worsen refer. Raises `InputError` for an unknown objective, a value in another
    unit, and empty or contradictory wishes.
    """
    if not isinstance(texts, Mapping):
        raise InputError(
            f"wishes must be a dict by objective; got {texts!r}; write them like {{'peak_torque': '110 N m'}}"
        )
    wishes_by_column = dict.fromkeys(range(len(front.objectives)), FREE)
    for name, text in texts.items():
        column = _objective_index(front, name)
        if wishes_by_column[column] is not FREE:
            raise InputError(
                f"an objective may have only one wish; got two for {front.objectives[column].quantity}; leave out one"
            )
        wish = _read_wish(front, column, text)
        wishes_by_column[column] = Wish("free") if wish.kind == "free" else wish
    wishes = tuple(wishes_by_column.values())
    _require_consistent_wishes(front, wishes, row)
    return wishes


def _objective_index(front: ParetoFront, name: object) -> int:
    try:
        return front.column_of(str(name))
    except InputError:
        names = ", ".join(objective.quantity for objective in front.objectives)
        raise InputError(f"a wish must name one of the objectives {names}; got {name!r}; name one of them") from None


def _read_wish(front: ParetoFront, column: int, text_or_value: object) -> Wish:
    quantity = front.problem.quantity(front.objectives[column].quantity)
    text = " ".join(text_or_value.split()) if isinstance(text_or_value, str) else ""
    for word in ("improve", "keep", "free"):
        if text.lower() == word:
            return Wish(word)
    limit = _LIMIT.fullmatch(text)
    kind, value = quantity.kind, limit[1] if limit else text_or_value
    if kind.unit and isinstance(value, str) and _NUMBER.fullmatch(value.strip()):
        raise InputError(
            f"the wish for {quantity.name} must be {kind.name} with its unit; got {quote(value)}; write it like "
            f'"{kind.example}"'
        )
    try:
        value = to_si(value, kind, plain=not isinstance(text_or_value, str))
    except InputError as error:
        words = "" if text[:1] in _VALUE else f"; a wish must be {_WORDS.format(example=kind.example)}"
        raise InputError(f"the wish for {quantity.name} {error}{words}") from None
    # A swing may exceed the domain that full rotation imposes.
    turning = front.problem.motion is None or isinstance(quantity, SwingQuantity)
    # This catches degrees without a unit, or a ratio in percent.
    if turning and quantity.domain is not None and value > quantity.domain.upper:
        value_text = f"{value * quantity.unit.factor:.6g} {quantity.unit.symbol}".rstrip()
        raise InputError(
            f"the wish for {quantity.name}: {quantity.domain.rule}; got {value_text}; {quantity.domain.remedy}"
        )
    return Wish("limit" if limit else "value", value)


def _require_consistent_wishes(front: ParetoFront, wishes: tuple[Wish, ...], row: int | None) -> None:
    """Raise `InputError` for empty wishes, or for wishes that no design can meet."""
    kinds = [wish.kind for wish in wishes]
    names = [objective.quantity for objective in front.objectives]
    if "value" not in kinds and "improve" not in kinds:
        raise InputError(
            f"no wish was given; give one of {', '.join(names)} a value, or let it improve on a design of the front"
        )
    relative = [name for name, kind in zip(names, kinds, strict=True) if kind in ("improve", "keep")]
    if row is None:
        if relative:
            raise InputError(
                f"{relative[0]}: improve and keep need a reference design; got none; name one of the front"
            )
        return
    if len(relative) == len(names):
        raise InputError(
            f"design {row + 1} is Pareto-optimal: nothing can improve unless another objective is freed or allowed to "
            "worsen; got improve or keep for every objective; free one, or let it worsen to a value"
        )
    for column, wish in enumerate(wishes):
        quantity = front.problem.quantity(names[column])
        reference = front.values[row, column]
        if wish.kind == "limit" and minimised_aim(front, column, wish) < reference - 1e-9 * abs(reference):
            raise InputError(
                f"{names[column]} may worsen to a value worse than that of design {row + 1}; got "
                f"{wish.value * quantity.unit.factor:.6g} {quantity.unit.symbol}".rstrip()  # type: ignore[operator]
                + ", which is better; write only the value to wish for it"
            )


def minimised_aim(front: ParetoFront, column: int, wish: Wish) -> float:
    """Return a wish's value as minimised, SI: negated if maximised, or the distance from a target."""
    assert wish.value is not None
    return float(minimised_values(front.objectives[column], np.array([wish.value]))[0])
