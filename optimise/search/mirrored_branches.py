"""Branches that are mirror images of each other: searching one of the two is enough.

Mirrored about the slider's direction and run backwards, a machine with offset e becomes one with offset -e that rotates
in the same direction. Accelerations and all functions of position alone are the same in both; velocities change sign.
So the two are equal unless one of these distinguishes them: gravity across the slider line, a load or friction that
depends on the motion, several cylinders, a speed profile, or a requested quantity.
"""

from collections.abc import Hashable

import numpy as np

from ...model.arrays import Array
from ...model.machine.cylinders_and_turns import has_cylinders_or_speed_profile
from ...objectives.formula.quantity import FormulaQuantity
from ...objectives.quantity import Quantity
from ...objectives.registry import QUANTITIES
from ..problem.constraint_violation import constraints_with_floors
from ..problem.problem import Problem
from .elimination import EliminationBranch
from .sampling import random_generator

_TRIED = 512  # random designs; those that rotate fully count
_COMPARED = 8
_EQUAL = 1e-8  # relative accuracy of a peak near locking
_STREAM = 4000  # of the seed


def drop_mirrored_branches(problem: Problem, branches: tuple[EliminationBranch, ...]) -> tuple[EliminationBranch, ...]:
    """Return the branches without those whose designs are mirror images of another branch's designs.

    Of two branches with the same range, the one with positive offsets stays; otherwise the one with the wider range.
    """
    parts = problem.parts()
    groups: dict[Hashable, list[EliminationBranch]] = {}
    for branch in branches:
        part = parts[branch.variant]
        labels = problem.variants[branch.variant].labels if problem.variants else ()
        key = (labels, part.mechanism, part.crank, part.rod, part.constraints)
        groups.setdefault(key, []).append(branch)
    twins: set[int] = set()
    for group in groups.values():
        pairs = [
            pair
            for first in group
            for second in group
            if (pair := _wider_and_narrower(first, second)) and first.sign < second.sign
        ]
        if pairs and not _depends_on_offset_sign(parts[pairs[0][0].variant], [branch for branch, _ in pairs]):
            twins |= {id(twin) for _, twin in pairs}
    return tuple(branch for branch in branches if id(branch) not in twins)


def _wider_and_narrower(
    one: EliminationBranch, other: EliminationBranch
) -> tuple[EliminationBranch, EliminationBranch] | None:
    """Return two branches of opposite sign; the first one's range of |offset| includes the other's."""
    if one.sign == other.sign:
        return None
    first, second = (one, other) if one.sign > 0.0 else (other, one)
    for wide, narrow in ((first, second), (second, first)):
        ends, inner = wide.bounds["offset"], narrow.bounds["offset"]
        if ends.lower <= inner.lower and inner.upper <= ends.upper:
            return wide, narrow
    return None


def _depends_on_offset_sign(part: Problem, branches: list[EliminationBranch]) -> bool:
    """Whether gravity, a load, friction, or any value of random designs differs between the offsets e and -e."""
    machine = part.mechanism.with_largest_variables
    if (
        any(map(_may_distinguish_mirror_images, part.own))
        or machine.gravity[1]
        or machine.acceleration
        or machine.friction.acts
    ):
        return True
    if has_cylinders_or_speed_profile(part.mechanism):
        return True
    if not all(load.is_conservative for load in machine.loads):
        return True  # a difference at only some crank angles would show in only some designs
    designs = np.concatenate([_random_designs(part, branch) for branch in branches])
    if not len(designs):
        return True
    mirrored = designs * np.where(np.arange(designs.shape[1]) == 2, -1.0, 1.0)
    names = {item.quantity for item in part.objectives} | {item.quantity for item in constraints_with_floors(part)}
    return any(
        not np.allclose(
            part.quantity(name).evaluate(part.mechanism, designs).values,
            part.quantity(name).evaluate(part.mechanism, mirrored).values,
            rtol=_EQUAL,
            atol=0.0,
            equal_nan=True,
        )
        for name in sorted(names)
    )


def _may_distinguish_mirror_images(quantity: Quantity) -> bool:
    """Whether a quantity may distinguish offsets e and -e where random designs do not.

    Every custom quantity of a job may distinguish them, except formulas without the offset's sign.
    """
    if quantity.is_constant:
        return False
    if isinstance(quantity, FormulaQuantity):
        return quantity.has_signed_offset or any(map(_may_distinguish_mirror_images, quantity.parts))
    return QUANTITIES.get(quantity.name) != quantity


def _random_designs(part: Problem, branch: EliminationBranch) -> Array:
    """Return random, fully rotating designs (n, 3 + v) within a branch's ranges, regardless of requirements."""
    ends = [branch.bounds[name] for name in branch.names]
    lower, upper = (np.array([getattr(item, end) for item in ends]) for end in ("lower", "upper"))
    designs = lower + (upper - lower) * random_generator(part.settings.seed, _STREAM).random((_TRIED, len(ends)))
    return np.asarray(designs[designs[:, 1] > designs[:, 0] + designs[:, 2]][:_COMPARED])
