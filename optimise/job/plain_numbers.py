"""Numbers without a unit in a job, read in SI: their keys, and which of them probably mean another unit.

Numbers in the tables of a job have paths: `mechanism.slider.mass`, `load.1.force`.
"""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import reduce
from operator import getitem
from typing import Any

from pydantic import ValidationError

from ...model.linkage.dimensions import DIMENSIONS
from ...model.machine.loads.load import StrokePart
from ...model.machine.raw_numbers_of_designs import DRIVE, LEVER
from ...objectives.formula.formulas import ROOTS
from ...objectives.kinds import Kind
from ...objectives.registry import FACTS
from ...objectives.units import closest_word, quote
from ..problem.problem import Problem
from ..problem.question_registry import Change, Remark
from .crank_speed import SPEED_KEYS
from .mistake_messages import MOST, key_of_location, keys_of_location, toml_text
from .value_types import PLAIN, Part, Table, flatten_values, plain_numbers_in
from .variables import stated_variables, table_leaves


def with_value_at_path(job: Part | Mapping[str, Any], path: str, value: Any) -> dict[str, Any]:
    """Return a job, or its tables, with a value set at a path; parts along the path stay as read.

    Raises `LookupError` if the job states no number or text there.
    """
    root, *rest = path.split(".")
    if root not in ROOTS:
        raise LookupError(root)
    tables: dict[str, Any] = _replace_at(job, [root, *rest], value)
    return tables


def unknown_path_message(path: str, tables: Mapping[str, Any]) -> str:
    """Return the message for a path without a number, or for a crank speed under another key."""
    table, _, key = path.partition(".")
    entries = tables.get(table)
    speed_keys = (
        [speed_key for speed_key in SPEED_KEYS if speed_key in entries]
        if isinstance(entries, Mapping) and key in SPEED_KEYS
        else []
    )
    if table == "mechanism" and speed_keys:
        return (
            f"must name a number that the job gives; got {path}, but the job gives mechanism.{speed_keys[0]}; give "
            f"{key} in "
            f"[mechanism] in place of {speed_keys[0]}"
        )
    several = _not_one_value_message(path, tables)
    if several:
        return several
    is_known = path in LEVER or (table == "drive" and key in DRIVE)
    known_paths = [known_path for known_path, value in _walk_values(tables, "") if _is_settable_value(value)]
    near = None if is_known else closest_word(path, known_paths)
    hint = (
        f"did you mean {near}?"
        if near
        else f"give it in [{path.partition('.')[0]}] first, because single designs need it"
    )
    return f"must name a number that the job gives; got {path}; {hint}"


def _not_one_value_message(path: str, tables: Mapping[str, Any]) -> str:
    """Return the message for a path to a table, a list or a value in one; otherwise ""."""
    part, is_complete = _innermost_part(path, tables)
    if isinstance(part, list | tuple) and part and not any(isinstance(item, Mapping) for item in part):
        return (
            f"must name a single number; got {path}{',' if is_complete else ' from'} a list of {len(part)} values; the "
            "values in a list, such as the points of a table, cannot vary; solve a job for each list"
        )
    if is_complete and isinstance(part, Mapping):
        starts = set("+-.0123456789")  # of a number, or of a text that begins like one
        number = next((known for known, value in _walk_values(part, path) if str(value)[:1] in starts), None)
        named = f"; did you mean {number}?" if number else " without a number that can vary"
        return f"must name a number that the job gives; got {path}, a table{named}"
    return ""


def stated_values_of_part(part: Any) -> dict[str, Any]:
    """Return the values that a part of a job states, by key; nested parts stay as read."""
    return dict(part) if isinstance(part, Mapping) else {name: getattr(part, name) for name in part.model_fields_set}


def _innermost_part(path: str, tables: Mapping[str, Any]) -> tuple[Any, bool]:
    """Return the innermost part of a job along a path, and whether the path ends there."""
    part: Any = tables
    steps = path.split(".")
    for step in steps if steps[0] in ROOTS else ():
        inner = {str(n + 1): item for n, item in enumerate(part)} if isinstance(part, list | tuple) else part
        if not isinstance(inner, Mapping) or step not in inner:
            return part, False
        if not isinstance(part, Mapping) and not isinstance(inner[step], Mapping):
            return part, False
        part = inner[step]
    return part, steps[0] in ROOTS


def _replace_at(part: Any, steps: list[str], value: Any) -> Any:
    step, *rest = steps
    table: Any
    place: Any
    if isinstance(part, list | tuple):
        table, place = list(part), next((n for n in range(len(part)) if step == str(n + 1)), None)
        if place is None or not rest:
            raise LookupError(step)
    elif isinstance(part, Part | Mapping):
        table, place = stated_values_of_part(part), step
    else:
        raise LookupError(step)
    if rest:
        table[place] = _replace_at(table[place], rest, value)
    elif _is_settable_value(table[place]):
        table[place] = value
    else:
        raise LookupError(step)
    return table


def _is_settable_value(value: object) -> bool:
    return isinstance(value, int | float | str | StrokePart)


def _walk_values(data: Any, root: str) -> Iterator[tuple[str, Any]]:
    """Yield path and value of everything in a job that is not a table; list positions count from 1."""
    if isinstance(data, Mapping):
        for name, item in data.items():
            if root or name in ROOTS:
                yield from _walk_values(item, f"{root}.{name}" if root else str(name))
    elif isinstance(data, list | tuple):
        for place, item in enumerate(data):
            if isinstance(item, Mapping):
                yield from _walk_values(item, f"{root}.{place + 1}")
    else:
        yield root, data


def first_mistakes(sentences: list[str], tables: Mapping[str, Any]) -> list[str]:
    """Return at most `MOST` sentences: the first ones in the order of the keys that they begin with."""
    if len(sentences) <= MOST:
        return sentences
    order = {key: place for place, key in enumerate(_keys_in_order(tables, ()))}

    def place(sentence: str) -> float:
        key = sentence.partition(": ")[0]
        while key and key not in order:
            key = key_above(key)
        return order.get(key, math.inf)

    return sorted(sentences, key=place)[:MOST]


def key_above(key: str) -> str:
    """Return the key of the table or list that contains a key, "" at the top level of the file."""
    return re.sub(r"(\.| #)?[^.#]*$", "", key)


def _keys_in_order(part: Any, path: tuple[object, ...]) -> Iterator[str]:
    entries = part.items() if isinstance(part, Mapping) else enumerate(part) if isinstance(part, list) else ()
    for step, entry in entries:
        yield key_of_location((*path, step))
        yield from _keys_in_order(entry, (*path, step))


_LONGEST = 60  # maximum length of a value that a warning repeats


@dataclass(frozen=True)
class PlainNumbers:
    """A value of a job with numbers without a unit. key: its location. kind: kind of the numbers."""

    key: str
    value: Any
    kind: Kind

    @property
    def interpretation_text(self) -> str:
        """The first of the numbers with its interpretation."""
        number = plain_numbers_in(self.value)[0]
        return f"{self.key} = {number:g} is {number:g} {self.kind.unit}{self._in_usual_unit(number, ' = {}')}"

    @property
    def warning_text(self) -> str | None:
        """Warning for numbers of implausible size, or beside others with a unit; None for others."""
        numbers = plain_numbers_in(self.value)
        doubtful = [number for number in numbers if not self.kind.is_plausible(number)]
        mixed = any(isinstance(value, str) for value in flatten_values(self.value))
        if not numbers or not (doubtful or mixed):
            return None
        number = (doubtful or numbers)[0]
        text = toml_text(self.value)
        value_text = text if len(text) <= _LONGEST else quote(self.value)
        doubt = "mixes numbers with and without a unit" if mixed else "has no unit"
        doubt = f"{doubt} and is" if number == self.value else f"{doubt}: {number:g} is"
        read = f'"{number:g} {self.kind.unit}"'
        sentence = f"{self.key} = {value_text} {doubt} read as {read[1:-1]}{self._in_usual_unit(number, ' ({})')}"
        usual = f"{number:g} {self.kind.metric.symbol}"
        in_usual = self._list_with_unit(self.kind.metric.symbol, doubtful)
        if self.kind.believed is not None and abs(number) < self.kind.believed[0]:
            return f"{sentence}; write it with its unit"
        if usual == read[1:-1]:
            return Remark(f"{sentence}; write {read}", self._change_to_text(number, read[1:-1]))
        if in_usual is not None and len(text) <= _LONGEST:
            symbol, in_si = self.kind.metric.symbol, self._list_with_unit(self.kind.unit, doubtful)
            sentence = f"{sentence}; if you mean {symbol}, write {toml_text(in_usual)}, otherwise {toml_text(in_si)}"
            return Remark(sentence, Change(self.key, in_usual, f"Read as {symbol}"))
        sentence = f'{sentence}; if you mean {usual}, write "{usual}", otherwise {read}'
        return Remark(sentence, self._change_to_text(number, usual))

    def _change_to_text(self, number: float, text: str) -> Change | None:
        """Return the change that writes the number as text, if it is the value or one of its entries."""
        if self.value == number:
            return Change(self.key, text, f"Write {text}")
        if isinstance(self.value, list | tuple) and number in self.value:
            return Change(self.key, [text if entry == number else entry for entry in self.value], f"Write {text}")
        return None

    def _list_with_unit(self, unit: str, doubtful: list[float]) -> list[str | float] | None:
        """Return a list with a unit after each number except zero.

        None for other values, or if some numbers are plausible.
        """
        numbers = self.value if isinstance(self.value, list | tuple) else ()
        if len(numbers) < 2 or len(doubtful) + sum(number == 0 for number in numbers) < len(numbers):
            return None
        return [f"{number:g} {unit}" if number else number for number in numbers]

    def is_at_key(self, key: str) -> bool:
        """Return whether the value is at a key of the job, within it, or in a table that contains it."""
        return any(f"{inner}.".startswith(f"{outer}.") for inner, outer in ((self.key, key), (key, self.key)))

    def _in_usual_unit(self, number: float, form: str) -> str:
        """Return the number in the usual unit, in the given phrase; "" if that is the SI unit."""
        usual = self.kind.metric
        return form.format(f"{usual.factor * number:.6g} {usual.symbol}") if usual.symbol != self.kind.unit else ""


def read_and_note_plain_numbers(
    job: type[Table], data: Mapping[str, Any], values: Mapping[str, Any] | None = None
) -> tuple[Table, list[PlainNumbers]]:
    """Return the tables of a job as read, and its numbers without a unit except ratios and counts.

    values: replacements for numbers of the job, by path, in the report. Raises `ValidationError`.
    """
    read, placed_numbers = _tables_with_numbers_lacking_unit(job, data)
    read = job.model_validate(data) if read is None else read
    placed = {path: PlainNumbers(key, value, kind) for path, key, value, kind in placed_numbers}
    for path in values or ():
        placed.pop(path, None)
    stated = [(path, path, value) for path, value in (values or {}).items()]
    varying = [item for item in (*stated, *_varying_values(data)) if plain_numbers_in(item[2])]
    if not varying:
        return read, list(placed.values())
    tried: Mapping[str, Any] = data
    for _, path, value in varying:
        try:
            tried = _with_number_at(tried, path, plain_numbers_in(value)[0])
        except LookupError:  # a word in the table, such as the name of a series
            continue
    kinds = {path: kind for path, _, _, kind in _tables_with_numbers_lacking_unit(job, tried)[1]}
    further = [PlainNumbers(key, value, kinds[path]) for key, path, value in varying if path in kinds]
    return read, [*placed.values(), *further]


def numbers_without_unit(job: type[Part], data: Mapping[str, Any]) -> list[PlainNumbers]:
    """Return the numbers without a unit in the tables of a job that may be invalid."""
    return [PlainNumbers(key, value, kind) for _, key, value, kind in _tables_with_numbers_lacking_unit(job, data)[1]]


def formula_bounds_without_unit(problem: Problem, data: Mapping[str, Any]) -> Iterator[PlainNumbers]:
    """Yield formulas' bounds and targets without a unit; their kinds come from the job's problem."""
    for table in ("constraints", "objectives"):
        for name, bounds in data.get(table, {}).items():
            if name not in FACTS and isinstance(bounds, Mapping):
                kind = problem.quantity(name).kind
                for word, value in bounds.items():
                    if plain_numbers_in(value) and kind.unit and not kind.amount:
                        yield PlainNumbers(key_of_location([table, name, word]), value, kind)


def _tables_with_numbers_lacking_unit(
    job: type[Table], data: Mapping[str, Any]
) -> tuple[Table | None, list[tuple[str, str, Any, Kind]]]:
    """Return the tables as read if none of a valid job's numbers lacks a unit, otherwise None; and those numbers.

    For each number with its own entry: dotted path, key, value and kind.
    """
    placed = []
    try:
        return job.model_validate(data, context=PLAIN), []
    except ValidationError as error:
        for details in error.errors(include_url=False):
            if details["type"] == PLAIN:
                keys = keys_of_location(details["loc"])
                keys = keys[:-1] if isinstance(keys[-1], int) else keys  # report a list as a whole
                value = reduce(getitem, keys, data)
                path = ".".join(str(key + 1) if isinstance(key, int) else key for key in keys)
                placed.append((path.removeprefix("variables."), key_of_location(keys), value, details["ctx"]["kind"]))
    return None, placed


def _varying_values(data: Mapping[str, Any]) -> Iterator[tuple[str, str, Any]]:
    """Yield key, path and value for numbers that variables and options set elsewhere in the job."""
    for path, value in stated_variables(data).items():
        yield f"variables.{path}", path, value
    for part in data.get("choice", ()):
        for option in part.get("option", ()):
            for path, value in table_leaves(option.get("values", {}), ""):
                yield f"choice {quote(part['name'])}, option {quote(option['name'])}: {path}", path, value


def _with_number_at(data: Mapping[str, Any], path: str, number: float) -> dict[str, Any]:
    if path in DIMENSIONS:
        return {**data, "variables": {**data["variables"], path: number}}
    return with_value_at_path(data, path, number)
