"""Dimensions in closed form for the exact lengths of a lever's cylinder, or an arm's exact swing or time ratio.

With the angles psi at both ends, L^2 + e^2 = r^2 + f^2 - 2 r f cos(psi) is quadratic in the lever r and the frame f.
The least length is at the end with the greater cosine. Two requirements give both lengths, hence r f and r^2 + f^2.
"""

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...objectives.lever_geometry import (
    CYLINDER_TRAVEL,
    EXTENSION_RATIO,
    GREATEST_CYLINDER_LENGTH,
    LEAST_CYLINDER_LENGTH,
)
from ...objectives.lever_turn import ARM_SWING, ARM_TIME_RATIO
from ..problem.problem import Problem
from .linear_rules import Rule

_LEAST, _GREATEST = LEAST_CYLINDER_LENGTH.name, GREATEST_CYLINDER_LENGTH.name
_TRAVEL, _RATIO = CYLINDER_TRAVEL.name, EXTENSION_RATIO.name
_TIMES, _SWING = ARM_TIME_RATIO.name, ARM_SWING.name
_ANGLES = ("lever.frame_angle", "lever.pin_angle", "start.angle")


@dataclass(frozen=True)
class LeverRule(Rule):
    """A rule of a lever's swing. angles: frame angle, pin angle, start and end, rad. follows: whether the end follows.

    free: indices of the angles that are the last sources. root: index of its solution.
    """

    angles: tuple[float, float, float, float]
    follows: bool
    free: tuple[int, ...]
    root: int = 0

    @property
    def solutions(self) -> tuple[Rule, ...]:
        """The rule for each of its roots; an offset has one."""
        return (self,) if self.target == "offset" else tuple(replace(self, root=root) for root in range(2))

    def formula(self, *known: Any) -> Any:
        """Return the target for the sources."""
        lengths = len(known) - len(self.free)
        near, far = self._cosines_at_extreme_lengths(known[lengths:])
        side = (1.0, -1.0)[self.root]
        if "+" in self.origin:
            (offset,) = known[:lengths]
            first, last = self.values
            product = 0.5 * (last * last - first * first) / (near - far)
            total = first * first + offset * offset + 2.0 * product * near
            return np.sqrt(0.5 * (total + side * np.sqrt(total * total - 4.0 * product * product)))
        (wanted,), (first, second) = self.values, known[:lengths]
        if self.target == "offset":
            cosine = near if self.origin == _LEAST else far
            return np.sqrt(first * first + second * second - 2.0 * first * second * cosine - wanted * wanted)
        link, offset = first, second
        if self.origin == _RATIO:
            square = wanted * wanted
            half, rest = link * (far - square * near) / (1.0 - square), link * link - offset * offset
        else:
            half = link * (near if self.origin == _LEAST else far)
            rest = link * link - offset * offset - wanted * wanted
        return half + side * np.sqrt(half * half - rest)

    def _cosines_at_extreme_lengths(self, free: tuple[Any, ...]) -> tuple[Any, Any]:
        """Return the cosines of psi at the least and at the greatest length."""
        angles: list[Any] = list(self.angles)
        for place, angle in zip(self.free, free, strict=True):
            angles[place] = angle
        frame, pin, start, end = angles
        if self.follows:
            end = start + (self.angles[3] - self.angles[2])
        first, last = np.cos(start + pin - frame), np.cos(end + pin - frame)
        is_first = np.real(first) > np.real(last)
        return np.where(is_first, first, last), np.where(is_first, last, first)


@dataclass(frozen=True)
class ArmRule(Rule):
    """Exact swing a or time ratio Q of an arm: a = pi (Q - 1) / (Q + 1).

    With m the lesser and M the greater of crank and frame, m^2 = sin(a/2)^2 (M^2 - e^2 / cos(a/2)^2). lesser: whether
    the target is m.
    """

    lesser: bool = True

    @property
    def solutions(self) -> tuple[Rule, ...]:
        """The rule for an arm that swings and, for a time ratio, that rotates."""
        if self.origin == _SWING:
            return (replace(self, lesser=self.target == "crank"),)
        return tuple(replace(self, lesser=lesser) for lesser in (True, False))

    def formula(self, link: Any, offset: Any) -> Any:
        """Return the target for the other link and the offset."""
        (wanted,) = self.values
        half = 0.5 * (wanted if self.origin == _SWING else np.pi * (wanted - 1.0) / (wanted + 1.0))
        sine, across = np.sin(half), offset / np.cos(half)
        if self.lesser:
            return sine * np.sqrt(link * link - across * across)
        return np.sqrt(link * link / (sine * sine) + across * across)


def lever_rules(problem: Problem, required: Mapping[str, float]) -> Iterator[Rule]:
    """Yield the rules for the equalities of a lever's swing. required: their values."""
    motion, lever = problem.motion, problem.mechanism.nominal.lever
    if motion is None or lever is None:
        return
    turn = (0.0, 0.0, 0.0, np.pi), False, ()
    varying = {} if motion.of_full_turn else {item.sets: item.name for item in problem.mechanism.varying}
    if any(path in _ANGLES and ((path, 1.0),) not in varying for sets in varying for path, _ in sets):
        return  # an angle that is not a variable itself
    free = tuple(place for place, path in enumerate(_ANGLES) if ((path, 1.0),) in varying)
    names = tuple(varying[(_ANGLES[place], 1.0),] for place in free)
    angles = lever.frame_angle, lever.pin_angle, motion.start, motion.end
    swing = turn if motion.of_full_turn else (angles, motion.follows, free)
    for origin in (_TIMES, _SWING):
        if origin in required and motion.of_full_turn:
            yield ArmRule(origin, "crank", ("rod", "offset"), (required[origin],))
            yield ArmRule(origin, "rod", ("crank", "offset"), (required[origin],))
    for origin in (_LEAST, _GREATEST, _RATIO):
        if origin in required:
            values = (required[origin],)
            yield LeverRule(origin, "rod", ("crank", "offset", *names), values, *swing)
            yield LeverRule(origin, "crank", ("rod", "offset", *names), values, *swing)
            if origin != _RATIO:
                yield LeverRule(origin, "offset", ("crank", "rod", *names), values, *swing)
    for pair in itertools.combinations((_LEAST, _GREATEST, _RATIO, _TRAVEL), 2):
        if all(name in required for name in pair):
            lengths = _extreme_cylinder_lengths({name: required[name] for name in pair})
            yield LeverRule("+".join(pair), "crank", ("offset", *names), lengths, *swing)


def _extreme_cylinder_lengths(required: Mapping[str, float]) -> tuple[float, float]:
    """Return the least and the greatest length, m, from two requirements."""
    least, greatest = required.get(_LEAST), required.get(_GREATEST)
    ratio, travel = required.get(_RATIO), required.get(_TRAVEL)
    if least is None:
        if greatest is None:
            assert ratio is not None
            assert travel is not None
            least = travel / (ratio - 1.0)
        else:
            least = greatest / ratio if ratio is not None else greatest - (travel or 0.0)
    if greatest is None:
        greatest = least * ratio if ratio is not None else least + (travel or 0.0)
    return least, greatest
