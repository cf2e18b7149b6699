"""Rounded neighbours of a design: the steps as people write them, the answer as JSON has it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.keys import key_in, metric_key, split_unit
from ...objectives.kinds import LENGTH, SMALL_LENGTH, Kind, System, shown_in
from ...objectives.units import shown
from .selection import value_of
from .shown_units import record_in

if TYPE_CHECKING:
    from ...optimise.front.rounded import Rounded
    from ...optimise.problem.problem import Problem

_EXAMPLE = '"0.5 mm" or "rod=1 mm"'
_ALLOWED_EXAMPLE = '"stroke=0.1 mm"'


def steps_of(to: Sequence[str], part: Problem, *, key: str) -> dict[str, float]:
    """Return the steps by name, SI, of texts such as "0.5 mm", for all lengths, and "rod=1 mm".

    key: what gives them, for messages. Raises `InputError`.
    """
    from ...model.machine.numbers import unit_of
    from ...objectives.tables.varying_column import varying_column
    from ...objectives.units import kind_of

    kinds = dict.fromkeys(DIMENSIONS, LENGTH)
    names = {name: name for name in DIMENSIONS} | {f"{name}_mm": name for name in DIMENSIONS}
    for item in part.mechanism.varying:
        column = varying_column(item)[0]
        kinds[item.name] = kind_of(unit_of(item.paths[0]))
        names |= {item.name: item.name, column: item.name, split_unit(column)[0]: item.name}
    found: dict[str, float] = {}
    for text in to:
        name, equals, value = (piece.strip() for piece in text.rpartition("="))
        name = metric_key(name)
        if not value:
            raise InputError(f"{key} is a step, or a name, = and a step; got {shown(text)}; write it like {_EXAMPLE}")
        if equals and name not in names:
            raise InputError(f"{key} is for {', '.join(kinds)}; got {name!r}; name one of them, like {_EXAMPLE}")
        one = names[name] if equals else ""
        if one in found:
            raise InputError(f"{key} gives each step once; got {one or 'that of all lengths'} twice; leave out one")
        found[one] = _step(value, kinds[one] if one else LENGTH, key)
    every = found.pop("", None)
    return (dict.fromkeys(DIMENSIONS, every) if every is not None else {}) | found


def allowed_of(allow: Sequence[str], *, key: str) -> dict[str, float | str]:
    """Return how far requirements may be missed, by quantity, of texts such as "stroke=0.1 mm".

    key: what gives them, for messages. Raises `InputError`.
    """
    found: dict[str, float | str] = {}
    for text in allow:
        name, equals, value = (piece.strip() for piece in text.rpartition("="))
        name = metric_key(name)
        if not (equals and name and value):
            raise InputError(
                f"{key} is a requirement, =, and by how much it may be missed; got {shown(text)}; write it like "
                f"{_ALLOWED_EXAMPLE}"
            )
        if name in found:
            raise InputError(f"{key} gives each requirement once; got {name} twice; leave out one")
        found[name] = value
    return found


def _step(text: str, kind: Kind, key: str) -> float:
    """Return a step, SI, read as in a job."""
    from ...optimise.job.grids import step_of

    small = SMALL_LENGTH if kind is LENGTH else kind
    return step_of(text, lambda given: value_of(key, str(given), small, sign="positive"))


def rounded_record(found: Rounded) -> dict[str, Any]:
    """Return the answer as JSON has it, metric."""
    from ...optimise.front.rounded import written

    part = found.problem
    given: dict[str, Any] = {
        column: factor * value
        for (column, factor), value in zip(found.names.values(), found.given.tolist(), strict=True)
    }
    for wanted, value in zip(part.objectives, found.before.tolist(), strict=True):
        of = part.quantity(wanted.quantity)
        given[of.field] = value * of.unit.factor
    allowed = {part.quantity(name): value for name, value in found.allowed.items()}
    rows = [
        {name: values[row].item() for name, values in found.columns.items()}
        | {
            "tightest": found.tightest(row),
            "missed": found.missed(row),
            "misses": [dict(vars(miss)) for miss in found.misses(row)],
        }
        for row in range(len(found))
    ]
    return {
        "met": found.met,
        "message": found.message,
        "steps": {found.names[name][0]: found.names[name][1] * step for name, step in found.steps.items()},
        "allowed": {of.field: written(value * of.unit.factor) for of, value in allowed.items()},
        "within_steps": found.reach,
        "judged": found.judged,
        "kept": found.kept,
        "given": given,
        "designs": rows,
        "notes": list(found.notes),
    }


def rounded_record_in(units: System, record: dict[str, Any], found: Rounded) -> dict[str, Any]:
    """Return the answer in a system of units, its round numbers as they are written there."""
    from ...optimise.front.rounded import written

    told: dict[str, Any] = record_in(record, units) | {"message": found.message_in(units)}
    keys = [key_in(found.names[name][0], units)[0] for name in found.steps]
    for row in (told["steps"], *told["designs"]):
        row.update({key: written(row[key]) for key in keys})
    told["allowed"] = {key: written(value) for key, value in told["allowed"].items()}
    for miss in (miss for row in told["designs"] for miss in row["misses"]):
        miss["unit"], factor = shown_in(miss["unit"], units)
        miss.update(amount=factor * miss["amount"], allowed=written(factor * miss["allowed"]))
    return told
