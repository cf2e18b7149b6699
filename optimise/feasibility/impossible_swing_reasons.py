"""Reasons why no design within the ranges makes the required swing."""

import math
from dataclasses import replace

import numpy as np

from ...model.arrays import Array
from ...model.errors import InfeasibleError
from ...model.machine.mechanism import Mechanism
from ...model.swing.closure import closes_over_swing, swings_without_dead_point
from ...model.swing.end_angles import swing_start_column
from ...model.swing.swing import Swing
from ...model.swing.swing_batch import can_swing_despite_friction
from ...objectives.tables.evaluate_quantities import designs_that_can_move
from ..problem.problem import Problem
from ..search.elimination import EliminationBranch, elimination_branches
from ..search.sampling import first_samples

_SAMPLES = 4096
_HALVINGS = 10  # bisections of the friction fraction, for three digits


def require_swinging(problem: Problem) -> None:
    """Raise `InfeasibleError` if no design in a large sample makes the required swing, or if friction locks it."""
    message = no_swing_reason(problem)
    if message:
        raise InfeasibleError(f"motion: {message}")


def no_swing_reason(problem: Problem) -> str:
    """Return why no design within the ranges swings as required, in words; "" if one in a large sample does."""
    motion = problem.motion
    assert motion is not None
    if motion.of_lever:
        return _no_lever_swing_reason(problem, motion)
    closing = passing = 0
    stuck: list[tuple[Mechanism, Array]] = []
    for index, branch in enumerate(elimination_branches(problem)):
        machine, designs = problem.part(branch.variant).mechanism, _sample_designs(problem, branch, index)
        closing += int(closes_over_swing(machine, motion, designs).sum())
        passing += int(swings_without_dead_point(machine, motion, designs).sum())
        able = designs[designs_that_can_move(machine, motion, designs)]
        if can_swing_despite_friction(machine, motion, able).any():
            return ""
        stuck.append((machine, able))
    factor, unit = (180.0 / math.pi, "deg") if motion.stated_for == "crank" else (1e3, "mm of the slider")
    movement = f"the swing from {factor * motion.start:.6g} to {factor * motion.end:.6g} {unit}"
    if any(
        swing_start_column(problem.part(branch.variant).mechanism) is not None
        for branch in elimination_branches(problem)
    ):
        movement = f"the swing by {factor * (motion.end - motion.start):.6g} {unit}" if motion.follows else "the swing"
    if not closing and motion.stated_for == "slider":
        return (
            f"no design within the ranges reaches {movement} with the crank pin on the {motion.side} of the line to "
            "the slider pin: at both ends the slider's distance from the crank pivot must be between |rod - crank| "
            "and rod + crank; change the ranges, the positions, crank_side or the branch"
        )
    if not closing:
        return (
            f"no design within the ranges can be assembled throughout {movement}, which needs rod > |offset - "
            "crank sin(crank angle)|; allow a longer rod or an offset nearer to the crank pin, or reduce the swing"
        )
    if not passing:
        return (
            f"every design within the ranges that can be assembled throughout {movement} passes a dead point, where "
            "crank and rod are in line and the slider cannot drive the crank; stay on one side of it, change the "
            "ranges, or drive the crank"
        )
    return (
        f"friction may lock every design within the ranges that can make {movement}; "
        f"{_excessive_friction_text(stuck, motion)}reduce the friction, lengthen the rod, or drive the other end"
    )


def _sample_designs(problem: Problem, branch: EliminationBranch, index: int) -> Array:
    """Return designs (n, 3 + k) of a branch, whatever they can do."""
    designs = branch.designs_at_points(first_samples(_SAMPLES, len(branch.free), problem.settings.seed, index))
    return np.asarray(designs[np.isfinite(designs).all(axis=1)])


def _no_lever_swing_reason(problem: Problem, motion: Swing) -> str:
    """Return the reason why no lever within the ranges makes the required swing; "" if one in a sample does."""
    for index, branch in enumerate(elimination_branches(problem)):
        machine = problem.part(branch.variant).mechanism
        if designs_that_can_move(machine, motion, _sample_designs(problem, branch, index)).any():
            return ""
    if motion.of_full_turn:
        return (
            "in no design within the ranges does the crank rotate fully: |offset| must be less than |frame - crank|, "
            "the rod being the frame; change the ranges, or reduce the offset"
        )
    start, end = (f"{180.0 / math.pi * angle:.6g}" for angle in (motion.start, motion.end))
    return (
        f"no design within the ranges swings the lever from {start} to {end} deg: the two pivots and the pin must "
        "not be in line at any point of the swing, and the offset must be less than the distance from the cylinder's "
        "pivot to the pin; change frame_angle or the ranges, or reduce the swing"
    )


def _excessive_friction_text(stuck: list[tuple[Mechanism, Array]], motion: Swing) -> str:
    """Describe the fraction of friction at which a locked machine first moves; "" if the friction varies."""
    if any(path.startswith("friction.") for machine, _ in stuck for item in machine.varying for path in item.paths):
        return ""
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        share = 0.5 * (low + high)
        runs = any(
            can_swing_despite_friction(_with_friction_share(machine, share), motion, able).any()
            for machine, able in stuck
        )
        low, high = (share, high) if runs else (low, share)
    return f"the first designs can move with {low:.2g} of its coefficients; "


def _with_friction_share(machine: Mechanism, share: float) -> Mechanism:
    """Return a machine with its friction coefficients multiplied by a fraction."""
    friction = machine.friction
    pins = {
        name: replace(pin, coefficient=share * pin.coefficient)
        for name, pin in (
            ("crank_pivot", friction.crank_pivot),
            ("crank_pin", friction.crank_pin),
            ("slider_pin", friction.slider_pin),
        )
    }
    return replace(machine, friction=replace(friction, guide=share * friction.guide, **pins))
