"""Curves in a job's files: values over crank angle, time or slider position, recognised by their units.

A heading has its unit in brackets or at its end: "force (N)", "force [N]", "force_N", "force in N". Columns whose
heading begins with # are ignored. Rows may descend, begin at any angle, wrap from 360 deg to 0 deg, and repeat the
first one at the end.
"""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...model.arrays import Array
from ...model.errors import InputError
from ...objectives.kinds import ANGLE, TIME, Kind
from ...objectives.units import (
    letters_and_digits,
    quote,
    unit_in_heading,
    value_of_one_si_unit_in,
    without_word_in,
)
from .text_table import TableFile

_BRACKETS = re.compile(r"[\[(]([^\])]*)[\])]")
# A record that ends closer to whole turns, relative to a turn, ends with them, unless half its last step is less.
_CLOSE = 1e-3
_TURNS = {"deg": 360.0}  # exactly
SHARE = 5e-4
"""Greatest change in a thinned curve, relative to its range."""
MOST_POINTS = 1000
"""Number of points up to which a curve is not thinned."""


class Head(NamedTuple):
    """A table column: position, heading, kind of values, and unit as jobs write it."""

    place: int
    text: str
    kind: Kind
    unit: str


@dataclass(frozen=True)
class Curve:
    """Values over arguments, both in the units of their headings.

    notes: how the file was read and converted, in words.
    """

    name: str
    argument_head: Head
    value_head: Head
    arguments: Array
    values: Array
    notes: tuple[str, ...]

    @property
    def full_turn_in_angle_unit(self) -> float:
        """A full turn of the crank in the unit of its angle."""
        return _TURNS.get(self.argument_head.unit, 2.0 * math.pi * value_of_one_si_unit_in(self.argument_head.unit))

    @property
    def turn_count(self) -> float:
        """Number of turns from the first to the last point."""
        return float(self.arguments[-1] - self.arguments[0]) / self.full_turn_in_angle_unit

    def argument_and_value_texts(self) -> tuple[list[str], list[str]]:
        """Return arguments and values as a job has them."""
        columns = ((self.argument_head.unit, self.arguments), (self.value_head.unit, self.values))
        places, values = ([f"{number!r} {unit}" for number in numbers.tolist()] for unit, numbers in columns)
        return places, values

    def summary_text(self, file: str) -> str:
        """Return a summary of the content read from a file."""
        return f"{file}: {'; '.join(self.notes)}"


def curve_of_table(table: TableFile, argument_kinds: Sequence[Kind], value_kinds: Sequence[Kind]) -> Curve:
    """Return the curve from a table's columns whose units have some kinds. Raises `InputError` for none or several."""
    kinds = (*argument_kinds, *value_kinds)
    heads = [head for place, text in enumerate(table.heads) if (head := _read_heading(place, text, kinds)) is not None]
    if not heads and len(table.heads) == 2:
        columns = list(zip(table.heads, (argument_kinds, value_kinds), strict=True))
        likely = [
            next((kind for kind in kinds if _heading_names_kind(text, kind)), kinds[0]) for text, kinds in columns
        ]
        example = ",".join(f"{text} ({kind.metric.symbol})" for text, kind in zip(table.heads, likely, strict=True))
        raise InputError(
            f"{table.name}: the columns have no units; got {', '.join(map(quote, table.heads))}; write, for example, "
            f"{quote(example)}"
        )
    angles = [head for head in heads if head.kind is ANGLE and ANGLE in argument_kinds]
    x = _heading_of_kind(
        table,
        [head for head in heads if head.kind in argument_kinds and not (angles and head.kind is TIME)],
        argument_kinds,
    )
    y = _heading_of_kind(table, [head for head in heads if head.kind in value_kinds and head is not x], value_kinds)
    for head in (x, y):
        _require_heading_of_kind(table, head, kinds)
    arguments, values = table.number_columns([x.place, y.place])
    again = np.flatnonzero((np.diff(arguments) == 0.0) & (np.diff(values) == 0.0))
    arguments, values = np.delete(arguments, again + 1), np.delete(values, again + 1)
    if len(arguments) < 2:
        raise InputError(f"{table.name} must have at least two points; got {len(arguments)}; add rows")
    curve = Curve(table.name, x, y, arguments, values, (table.summary_text([x.place, y.place]),))
    return _in_rising_order(curve, table) if x.kind is not TIME else curve


def _read_heading(place: int, text: str, kinds: Sequence[Kind]) -> Head | None:
    """Return the meaning of a heading by its unit; None if it has no unit of these kinds.

    If several units fit, the name decides.
    """
    if text.startswith("#"):
        return None
    meanings = [
        (kind, unit)
        for text_unit in _units_in(text)
        for kind in kinds
        if (unit := unit_in_heading(text_unit, kind)) is not None
    ]
    named = [meaning for meaning in meanings if _heading_names_kind(text, meaning[0])]
    return Head(place, text, *(named or meanings)[0]) if meanings else None


def _units_in(text: str) -> list[str]:
    """Return possible units in a heading, likeliest first: text in brackets, then words at its end."""
    words = re.split(r"[\s_,:]+|\s/\s", _BRACKETS.sub("", text).strip())
    endings = [" ".join(words[n:]) for n in range(1, len(words))]
    units = [*_BRACKETS.findall(text)[::-1], *sorted(endings, key=lambda ending: ending.startswith("in "))]
    return [without_word_in(unit) for unit in units]


def _heading_names_kind(text: str, kind: Kind) -> bool:
    return kind.name_without_article.split()[-1] in text.casefold()


def _require_heading_of_kind(table: TableFile, head: Head, kinds: Sequence[Kind]) -> None:
    """Raise `InputError` for a heading whose name contradicts its unit."""
    named = [kind for kind in kinds if _heading_names_kind(head.text, kind)]
    if named and head.kind not in named:
        raise InputError(
            f"{table.name}, column {quote(head.text)}: must have the unit of {named[0].name}, as its name says; got "
            f"{head.unit}, which is {head.kind.name}; correct the unit or the name"
        )


def _heading_remedy(heads: Sequence[str], kinds: Sequence[Kind]) -> str:
    """Return the remedy for headings without a unit: correct a misspelt one, or add one."""
    words = {letters_and_digits(unit).casefold(): unit for kind in kinds for unit in (*kind.typed, kind.metric.symbol)}
    words |= {"grad": ANGLE.metric.symbol} if ANGLE in kinds else {}
    for unit in (unit for head in heads if not head.startswith("#") for unit in _units_in(head)):
        if intended_unit := words.get(letters_and_digits(unit).casefold()):
            return f"the unit {quote(unit)} is not known; write {intended_unit}"
    return "name the unit"


def _heading_of_kind(table: TableFile, heads: list[Head], kinds: Sequence[Kind]) -> Head:
    """Return the only column, or, among several of one kind, the only one that names the kind."""
    named = [head for head in heads if _heading_names_kind(head.text, head.kind)]
    candidates = named if len(named) == 1 and len({head.kind for head in heads}) == 1 else heads
    if len(candidates) == 1:
        return candidates[0]
    choice = " or ".join(f"{kind.name} ({kind.metric.symbol})" for kind in kinds)
    rule = f"{table.name} must have one column of {choice}"
    if not candidates:
        raise InputError(
            f"{rule}, with its unit in brackets or at the end of its name; got "
            f"{', '.join(map(quote, table.heads[:6]))}; " + _heading_remedy(table.heads, kinds)
        )
    raise InputError(
        f"{rule}; got {' and '.join(quote(head.text) for head in candidates[:3])}; let the names of the others begin "
        "with #"
    )


def _in_rising_order(curve: Curve, table: TableFile) -> Curve:
    """Return a curve with ascending arguments: reversed if they descend, continued over full turns if they restart."""
    at, values, notes = curve.arguments, curve.values, curve.notes
    steps = np.diff(at)
    if (steps < 0.0).sum() > (steps > 0.0).sum():
        at, values, notes = at[::-1], values[::-1], (*notes, "sorted upwards")
    if curve.argument_head.kind is ANGLE:
        wraps = np.concatenate([[0], np.cumsum(np.diff(at) < -0.5 * curve.full_turn_in_angle_unit)])
        if wraps[-1]:
            at, notes = at + curve.full_turn_in_angle_unit * wraps, (*notes, "angles continue beyond one turn")
    wrong = np.flatnonzero(np.diff(at) < 0.0)
    if len(wrong):
        n = int(wrong[0])
        raise InputError(
            f"{table.name}: {quote(curve.argument_head.text)} must increase; got {at[n + 1]:g} after {at[n]:g}; sort "
            "the rows, and keep only one stroke if the position moves back and forth"
        )
    return replace(curve, arguments=at, values=values, notes=notes)


def convert_time_to_angle(curve: Curve, speed: float) -> Curve:
    """Return a curve over time as a curve over crank angle at constant speed, rad/s; any other curve unchanged."""
    if curve.argument_head.kind is not TIME:
        return curve
    wrong = np.flatnonzero(np.diff(curve.arguments) < 0.0)
    if len(wrong):
        raise InputError(
            f"{curve.name}: times must increase; got {curve.arguments[wrong[0] + 1]:g} later; sort the rows"
        )
    turns = curve.arguments / value_of_one_si_unit_in(curve.argument_head.unit) * speed / (2.0 * math.pi)
    notes = (*curve.notes, f"times are crank angles at {speed * 30.0 / math.pi:.6g} rpm")
    order = slice(None, None, -1 if speed < 0.0 else 1)
    head = curve.argument_head._replace(kind=ANGLE, unit="deg")
    return replace(curve, argument_head=head, arguments=360.0 * turns[order], values=curve.values[order], notes=notes)


def first_cycle_and_turn_count(curve: Curve, turns: int | None) -> tuple[Curve, int]:
    """Return a crank-angle curve's first cycle, and its number of turns: the given one, otherwise one or two.

    A record that ends close to whole turns ends with them. Raises `InputError` for a record between one turn and two.
    """
    near = (
        min(_CLOSE, 0.5 * float(curve.arguments[-1] - curve.arguments[-2]) / curve.full_turn_in_angle_unit)
        if len(curve.arguments) > 1
        else 0.0
    )
    full_turns = round(curve.turn_count)
    if full_turns >= 1 and 0.0 < abs(curve.turn_count - full_turns) <= near:
        at = curve.arguments[0] + (curve.arguments - curve.arguments[0]) * (full_turns / curve.turn_count)
        at[-1] = curve.arguments[0] + full_turns * curve.full_turn_in_angle_unit
        curve = replace(curve, arguments=at)
    if turns is None:
        turns = 1 if curve.turn_count <= 1.0 else 2
        step = float(np.median(np.diff(curve.arguments))) / curve.full_turn_in_angle_unit
        if turns == 2 and not max(1.5, 2.0 - 2.0 * step) <= curve.turn_count <= 2.0:
            raise InputError(
                f"{curve.name} must cover one or two turns unless the job gives the cycle; got "
                f"{curve.turn_count:.4g} turns; "
                'give cycle = "360 deg" or "720 deg"; the first cycle in the file is used'
            )
        if turns == 2:
            curve = replace(curve, notes=(*curve.notes, "two turns, a cycle of 720 deg"))
    if curve.turn_count > turns:
        in_cycle = curve.arguments < curve.arguments[0] + (turns - near) * curve.full_turn_in_angle_unit
        notes = (*curve.notes, f"the first cycle of {curve.turn_count / turns:.4g}")
        curve = replace(curve, arguments=curve.arguments[in_cycle], values=curve.values[in_cycle], notes=notes)
    return curve, turns


def drop_closing_point(curve: Curve) -> Curve:
    """Return a curve over one turn without a last point that repeats the first.

    Raises `InputError` if the two differ by more than a thousandth of the curve's range, or if two points have the same
    argument.
    """
    twice = np.flatnonzero(np.diff(curve.arguments) == 0.0)
    if len(twice):
        at = f"{curve.arguments[twice[0]]:g} {curve.argument_head.unit}"
        raise InputError(
            f"{curve.name}: {quote(curve.argument_head.text)} must increase; got {at} twice; leave out one of the two"
        )
    curve, _ = first_cycle_and_turn_count(curve, 1)
    if curve.turn_count < 1.0:
        return curve
    first, last = curve.values[0], curve.values[-1]
    if abs(last - first) > _CLOSE * np.ptp(curve.values):
        raise InputError(
            f"{curve.name}: the last row is one turn after the first and must have the same value; got {first:g} and "
            f"{last:g} {curve.value_head.unit}; correct one of them, or leave out the last row"
        )
    notes = (*curve.notes, "the last row repeats the first and is ignored")
    return replace(curve, arguments=curve.arguments[:-1], values=curve.values[:-1], notes=notes)


def reduce_curve_points(curve: Curve) -> Curve:
    """Return a curve of more than `MOST_POINTS` points without those that straight lines can replace; steps stay.

    No value of the curve changes by more than `SHARE` of its range: Ramer, Computer Graphics and Image Processing 1
    (1972) 244, with the deviation measured along the values, where it is greatest at an omitted point.
    """
    if len(curve.arguments) <= MOST_POINTS:
        return curve
    bound = SHARE * float(np.ptp(curve.values))
    is_needed = np.zeros(len(curve.arguments), dtype=bool)
    ends = [0, *(np.flatnonzero(np.diff(curve.arguments) == 0.0) + 1).tolist(), len(curve.arguments)]
    open_spans = [(a, b - 1) for a, b in pairwise(ends)]
    while open_spans:
        a, b = open_spans.pop()
        is_needed[[a, b]] = True
        if b - a < 2:
            continue
        x, y = curve.arguments[a : b + 1], curve.values[a : b + 1]
        off = np.abs(y[0] + (y[-1] - y[0]) * ((x - x[0]) / (x[-1] - x[0])) - y)
        far = int(np.argmax(off[1:-1])) + 1
        if off[far] > bound:
            open_spans += [(a, a + far), (a + far, b)]
    count = int(is_needed.sum())
    share = f"{bound:.3g} {curve.value_head.unit}, {100.0 * SHARE:g} % of its range"
    note = f"{count:,} points kept; no value changes by more than {share}"
    return replace(
        curve, arguments=curve.arguments[is_needed], values=curve.values[is_needed], notes=(*curve.notes, note)
    )
