"""Wishes for a front's objectives: values, or classes relative to one of its designs.

A value, "110 N m", is an aspiration level, not a bound: the design comes as close as possible. The classes are those of
NIMBUS (K. Miettinen and M. M. Mäkelä, "Synchronous approach in interactive multiobjective optimization", Eur. J. Oper.
Res. 170(3), 2006): an objective must improve on the design's value, must not be worse, may worsen to a given value, or
is free. Objectives that are not named are free.

The answer has the design, and the desired and reached value of each objective in words.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, cast

import numpy as np

from ...model.errors import InputError
from ...objectives.kinds import System, metric_unit_in
from ...objectives.quantity import Quantity
from ...objectives.swing_quantity import SwingQuantity
from ...objectives.units import quote, to_si
from ..front.front import ParetoFront
from ..problem.constraint_violation import minimised_values
from ..problem.requirements import Objective

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
            f"no wish was given; give one of {', '.join(names)} a value, or let it improve on a design on the front"
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


_ROUNDING = 1e-9
"""Relative to an objective's range: smaller differences do not count."""


@dataclass(frozen=True, kw_only=True)
class ObjectiveOutcome:
    """One objective of the design that answers a wish.

    objective: the objective. quantity: its quantity. kind: kind of the wish. wished, reached, before: desired or
    allowed value, value reached by the new design, and value of the design to which classes refer, SI; None if there is
    none.
    short: shortfall from the desired or allowed value, in the objective as minimised, SI; negative if the design is
    better; None if there is no such value. changed: the same difference from the value before. range_: range of the
    objective over the front.
    """

    objective: Objective
    quantity: Quantity
    kind: Kind
    wished: float | None
    reached: float
    before: float | None
    short: float | None
    changed: float | None
    range_: float

    @property
    def is_met(self) -> bool:
        """Whether the new design reaches the desired value, or stays within the allowed one."""
        return self.short is None or self.short <= _ROUNDING * self.range_

    @property
    def gained(self) -> bool:
        """Whether the new design is better than the previous one."""
        return self.changed is not None and self.changed < -_ROUNDING * self.range_

    def text(self, system: System = "metric") -> str:
        """Describe wish and outcome: "peak torque 109.2 N m instead of the desired 110 N m"."""
        reached = f"{self.quantity.title} {self._value_text(self.reached, system)}"
        if self.kind == "value":
            return reached + self._wish_comparison_text(system)
        if self.kind == "limit":
            worst = {"minimise": "most", "maximise": "least", "target": "worst"}[self.objective.sense]
            return f"{reached}, at {worst} {self._value_text(cast(float, self.wished), system)} allowed"
        if self.kind == "free" and self.changed is None:
            return f"{reached}, free"
        free = ", free" if self.kind == "free" else ""
        changed = cast(float, self.changed)
        if abs(changed) <= _ROUNDING * self.range_:
            return f"{reached}, as before{free}"
        direction = "worse" if changed > 0.0 else "better"
        return f"{reached}, {self._difference_text(changed, system)} {direction} than before{free}"

    def _wish_comparison_text(self, system: System) -> str:
        short, wished = cast(float, self.short), self._value_text(cast(float, self.wished), system)
        if abs(short) <= _ROUNDING * self.range_:
            is_target = self.objective.sense == "target"
            return f", as near to its target as the desired {wished}" if is_target else ", as desired"
        amount = self._difference_text(short, system)
        if self.objective.sense == "target":
            target = self._value_text(cast(float, self.objective.target), system)
            far = f"{amount} {'farther from' if short > 0.0 else 'nearer to'} its target of {target} than"
            return f", {far} the desired {wished}"
        if short < 0.0:
            return f", {amount} better than the desired {wished}"
        return f" instead of the desired {wished}: it must be relaxed by {amount}"

    def _value_text(self, value: float, system: System) -> str:
        unit, factor = metric_unit_in(self.quantity.unit.symbol, system)
        return f"{value * self.quantity.unit.factor * factor:.4g} {unit}".rstrip()

    def _difference_text(self, value: float, system: System) -> str:
        unit, factor = metric_unit_in(self.quantity.unit.symbol, system)
        return f"{abs(value) * self.quantity.unit.factor * factor:.3g} {unit}".rstrip()


@dataclass(frozen=True, kw_only=True)
class Wished:
    """The answer to wishes for the objectives of a front.

    found: the design, as a separate front with all columns of a front's table, its stationarity residual and trade-off
    rates; empty if no design stays within the allowed values. row: row of the design to which classes refer. wishes:
    wish for each objective. value: the achievement function at the design, as `wish` defines it; NaN if there is no
    design. outcomes: outcome of each objective; empty if there is no design. message: reason for a missing design, or
    empty.
    """

    found: ParetoFront
    row: int | None
    wishes: tuple[Wish, ...]
    value: float
    outcomes: tuple[ObjectiveOutcome, ...]
    message: str = ""

    def __len__(self) -> int:
        return len(self.found)

    def __repr__(self) -> str:
        return f"Wished({self.found.problem.name!r}: {'; '.join(self.sentences())})"

    @property
    def possible(self) -> bool:
        """Whether the design fulfils every wish."""
        return bool(self.outcomes) and all(outcome.is_met for outcome in self.outcomes)

    def sentences(self, system: System = "metric") -> list[str]:
        """Say whether the wishes can be met, then describe wish and outcome for each objective."""
        if not self.outcomes:
            return [self.message]
        return [self._first_sentence(), *(outcome.text(system) for outcome in self.outcomes)]

    def _first_sentence(self) -> str:
        wished = [outcome for outcome in self.outcomes if outcome.kind == "value"]
        if not wished:
            if any(outcome.kind == "improve" and outcome.gained for outcome in self.outcomes):
                return "the objectives to improve are improved as far as the others allow"
            return "nothing improves while the other objectives stay as required"
        if not self.possible:
            verdict = (
                "no design reaches the desired value" if len(wished) == 1 else "no design reaches all desired values"
            )
            return f"{verdict}; this one is nearest"
        if all(cast(float, outcome.short) < -_ROUNDING * outcome.range_ for outcome in wished):
            return "the wish can be met and exceeded" + (" in every objective" if len(wished) > 1 else "")
        return "the wish can be met"


def outcomes_of(
    front: ParetoFront, wishes: Sequence[Wish], aims: Sequence[float | None], row: int | None, found: ParetoFront
) -> tuple[ObjectiveOutcome, ...]:
    """Return the outcome for each objective.

    aims: desired values as minimised, SI. found: the design, as a separate front.
    """
    return tuple(
        ObjectiveOutcome(
            objective=objective,
            quantity=(of := front.problem.quantity(objective.quantity)),
            kind=wishes[column].kind,
            wished=wishes[column].value,
            reached=float(found.columns[of.field][0]) / of.unit.factor,
            before=None if row is None else float(front.columns[of.field][row]) / of.unit.factor,
            short=None if (aim := aims[column]) is None else float(found.values[0, column] - aim),
            changed=None if row is None else float(found.values[0, column] - front.values[row, column]),
            range_=float(np.ptp(front.values[:, column])) or float(abs(found.values[0, column])),
        )
        for column, objective in enumerate(front.objectives)
    )
