"""Lengths that give a swing its exact travel, or its exact crank angle, in closed form.

A pin at a rod's length from two points lies on their perpendicular bisector. For the travel S between two crank angles,
the slider pin at the start is as far from the crank pin there as from the crank pin at the end moved back by S. For the
angle between two slider positions, the crank pin at the start is as far from the slider pin there as from the slider
pin at the end turned back by the angle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...model.swing.end_angles import swing_start_column
from ...objectives.swing_geometry import ACTUATOR_TRAVEL, SWING_ANGLE
from ..problem.problem import Problem
from .elimination_rule import Rule


@dataclass(frozen=True)
class SwingRule(Rule):
    """A rule of a swing. solve: its formula. root: index of its solution among `roots`."""

    solve: Callable[..., Any]
    roots: int
    root: int = 0

    def formula(self, *known: Any) -> Any:
        """Return the target computed from the sources."""
        return self.solve(self.root, *self.values, *known)

    @property
    def solutions(self) -> tuple[Rule, ...]:
        """Return the rule for each of its roots."""
        return tuple(replace(self, root=root) for root in range(self.roots))


def swing_rules(problem: Problem, required: Mapping[str, float], sign: float) -> Iterator[Rule]:
    """Yield the rules for the equalities of a swing. required: their values. sign: sign of the offset."""
    motion = problem.motion
    if motion is None:
        return
    column = swing_start_column(problem.mechanism)
    free = () if column is None else (problem.mechanism.varying[column - 3].name,)
    swing_values = (sign, motion.start, motion.end, float(motion.follows))
    travel, angle = ACTUATOR_TRAVEL.name, SWING_ANGLE.name
    if motion.stated_for == "crank" and travel in required:
        numbers = (required[travel], *swing_values)
        yield SwingRule(travel, "rod", ("crank", "offset", *free), numbers, _rod_from_travel, 2)
        yield SwingRule(travel, "offset", ("crank", "rod", *free), numbers, _offset_from_travel, 4)
    if motion.stated_for == "slider" and angle in required:
        numbers = (required[angle], *swing_values)
        yield SwingRule(angle, "crank", ("rod", "offset", *free), numbers, _crank_from_swing_angle, 4)
        yield SwingRule(angle, "rod", ("crank", "offset", *free), numbers, _rod_from_swing_angle, 4)


def _swing_ends(start: float, end: float, follows: float, free: tuple[Any, ...]) -> tuple[Any, Any]:
    first = free[0] if free else start
    return first, first + (end - start) if follows else end


def _root_signs(root: int) -> tuple[float, float]:
    """Return the two signs that a root stands for: of the direction, and of the solution."""
    return (1.0, -1.0)[root % 2], (1.0, -1.0)[root // 2]


def _crank_pins(root: int, travel: float, ends: tuple[Any, Any], r: Any) -> tuple[Any, Any, Any, Any]:
    """Return the crank pin at the start, and at the end moved back by the travel."""
    first, last = ends
    way = _root_signs(root)[0]
    return r * np.cos(first), r * np.sin(first), r * np.cos(last) - way * travel, r * np.sin(last)


def _rod_from_travel(
    root: int, travel: float, sign: float, start: float, end: float, follows: float, r: Any, a: Any, *free: Any
) -> Any:
    x_0, y_0, x_1, y_1 = _crank_pins(root, travel, _swing_ends(start, end, follows, free), r)
    e = sign * a
    x = 0.5 * (x_1 + x_0) + 0.5 * (y_1 - y_0) * (y_1 + y_0 - 2.0 * e) / (x_1 - x_0)
    return np.sqrt((x_0 - x) ** 2 + (y_0 - e) ** 2)


def _offset_from_travel(
    root: int, travel: float, sign: float, start: float, end: float, follows: float, r: Any, l: Any, *free: Any
) -> Any:
    x_0, y_0, x_1, y_1 = _crank_pins(root, travel, _swing_ends(start, end, follows, free), r)
    square = (x_1 - x_0) ** 2 + (y_1 - y_0) ** 2
    away = _root_signs(root)[1] * np.sqrt(l * l / square - 0.25)
    return sign * (0.5 * (y_0 + y_1) + away * (x_1 - x_0))


def _bisector_of_slider_pins(root: int, angle: float, ends: tuple[Any, Any], e: Any) -> tuple[Any, Any, Any, Any]:
    """Return a point and the direction of the bisector between the slider pin's start and its turned-back end."""
    first, last = ends
    turn = _root_signs(root)[0] * angle
    cosine, sine = np.cos(turn), np.sin(turn)
    x_1, y_1 = cosine * last + sine * e, cosine * e - sine * last
    return 0.5 * (first + x_1), 0.5 * (e + y_1), e - y_1, x_1 - first


def _crank_from_swing_angle(
    root: int, angle: float, sign: float, start: float, end: float, follows: float, l: Any, a: Any, *free: Any
) -> Any:
    x, y, u, v = _bisector_of_slider_pins(root, angle, _swing_ends(start, end, follows, free), sign * a)
    away = _root_signs(root)[1] * np.sqrt(l * l / (u * u + v * v) - 0.25)
    return np.sqrt((x + away * u) ** 2 + (y + away * v) ** 2)


def _rod_from_swing_angle(
    root: int, angle: float, sign: float, start: float, end: float, follows: float, r: Any, a: Any, *free: Any
) -> Any:
    x, y, u, v = _bisector_of_slider_pins(root, angle, _swing_ends(start, end, follows, free), sign * a)
    square = u * u + v * v
    projection = (x * u + y * v) / square
    away = -projection + _root_signs(root)[1] * np.sqrt(projection * projection + (r * r - x * x - y * y) / square)
    return np.sqrt(square * (away * away + 0.25))
