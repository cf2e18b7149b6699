"""Conditions on boxes of designs: which boxes can meet them, in which part, and a point likely to meet them.

Some quantities cannot be bounded over boxes; `boundable_quantities` says why.
"""

from typing import TypeGuard

import numpy as np

from ...model.arrays import Array
from ...model.swing.swing_states import ERROR
from ...objectives.bar_pieces import BarPeak
from ...objectives.closed_form import ClosedFormQuantity
from ...objectives.cycle_peak import CyclePeak
from ...objectives.quantity import Quantity
from ...objectives.swing_quantity import ClosedFormSwingQuantity, SwingLeast, SwingPeak
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..problem.requirements import Constraint, Objective, Sense
from .enclosed_machine import unboundable_load_reason
from .enclosure import INFLATION, Enclosure


def unbounded_reason(problem: Problem, objective: Objective) -> str:
    """Return why an objective cannot be bounded over a box; empty if it can.

    Bounds exist for quantities with `formulas`, and for the travel and angle of a swing. Machines without friction also
    have lower bounds on peaks over the cycle or swing, and upper bounds on the least values of a swing.
    """
    reasons = (_unbounded_reason_in_part(part, objective) for part in problem.parts())
    return next(filter(None, reasons), "")


def _unbounded_reason_in_part(problem: Problem, objective: Objective) -> str:
    quantity, mechanism = problem.quantity(objective.quantity), problem.mechanism
    if mechanism.lever is not None:
        return f"{quantity.title} has no bound over a range of designs of a lever or an arm"
    if quantity.formulas(mechanism) or is_swing_form(quantity):
        return ""
    if not isinstance(quantity, BarPeak | CyclePeak | SwingPeak | SwingLeast | ClosedFormSwingQuantity):
        profile = " with a speed profile" if isinstance(quantity, ClosedFormQuantity) else ""
        return f"{quantity.title}{profile} has no bound over a range of designs"
    has_forces = _depends_on_forces(quantity)
    if has_forces and mechanism.friction.acts and not (isinstance(quantity, SwingPeak) and quantity.free):
        return f"{quantity.title} has no bound over a range of designs with friction"
    if has_forces and (load := unboundable_load_reason(mechanism)):
        return f"{quantity.title} has no bound over a range of designs: {load}"
    least = isinstance(quantity, SwingLeast | ClosedFormSwingQuantity) or (
        isinstance(quantity, BarPeak) and quantity.least
    )
    if objective.sense != ("maximise" if least else "minimise"):
        side, sense = ("an upper", "maximised") if least else ("a lower", "minimised")
        return f"{quantity.title} only has {side} bound, so it can only be certified if it is {sense}"
    return ""


def is_swing_form(quantity: Quantity) -> TypeGuard[ClosedFormSwingQuantity]:
    """Whether a quantity has a closed form in the two ends of a swing."""
    return isinstance(quantity, ClosedFormSwingQuantity) and quantity.measure != "angle"


def _depends_on_forces(quantity: Quantity) -> bool:
    if isinstance(quantity, CyclePeak):
        return quantity.signal.needs_forces
    return isinstance(quantity, BarPeak | SwingLeast) or (isinstance(quantity, SwingPeak) and quantity.state != ERROR)


def can_rule_out_boxes(problem: Problem, constraint: Constraint) -> bool:
    """Whether a constraint helps to rule out boxes; other constraints are still met by every design that is counted."""
    stated = [bound for bound in (constraint.lower, constraint.upper) if bound is not None]
    return len(sides_that_rule_out_no_boxes(problem, constraint)) < len(stated)


def sides_that_rule_out_no_boxes(problem: Problem, constraint: Constraint) -> list[str]:
    """Describe the sides of a constraint that do not rule out boxes."""
    sides: tuple[tuple[str, float | None, Sense], ...] = (
        ("minimum", constraint.lower, "maximise"),
        ("maximum", constraint.upper, "minimise"),
    )
    return [
        word
        for word, bound, sense in sides
        if bound is not None and unbounded_reason(problem, Objective(quantity=constraint.quantity, sense=sense))
    ]


_INSIDE = 1e-9  # relative distance of a trial design from the limits
_ROUNDS = 3  # attempts to move it into the box's feasible part


class Limits:
    """Conditions `enclosure <= FEASIBLE` on n boxes, added one by one, and which boxes may meet them."""

    def __init__(self, n: int, k: int) -> None:
        self.alive = np.ones(n, dtype=bool)
        self.rows: list[tuple[Array, Array, Array]] = []  # centre (n,), slopes (k, n), rest (n,)
        self.k = k

    def require_nonpositive(self, value: Enclosure) -> None:
        """Require each part of a number (n, p) to be defined and at most `FEASIBLE` somewhere in the box."""
        if value.empty is not None:
            self.alive &= ~value.empty.any(axis=1)
        self.alive &= ~(value.least_and_greatest()[0] > FEASIBLE).any(axis=1)
        for part in range(value.centre.shape[1]):
            is_finite = np.isfinite(value.greatest_magnitude[:, part])
            self.rows.append(
                (
                    np.where(is_finite, value.centre[:, part], -np.inf),
                    np.where(is_finite, value.slopes[:, :, part], 0.0),
                    np.where(is_finite, value.rest[:, part], 0.0),
                )
            )

    def add_constraint(
        self, constraint: Constraint, value: Enclosure, least: Array | None, greatest: Array | None
    ) -> None:
        """Require a constraint on the greatest part of a quantity. least, greatest: further bounds on it."""
        upper, lower = constraint.upper, constraint.lower
        if upper is not None:
            scale = abs(upper) or 1.0
            self.require_nonpositive((value - upper) * (1.0 / scale))
            if least is not None:
                self.alive &= ~(least - upper > FEASIBLE * scale)
        if lower is not None:
            scale = abs(lower) or 1.0
            if value.centre.shape[1] == 1:
                self.require_nonpositive((lower - value) * (1.0 / scale))
            if greatest is not None:
                self.alive &= ~(lower - greatest > FEASIBLE * scale)

    def add_curve_constraint(self, constraint: Constraint, value: Enclosure) -> None:
        """Require an upper bound on every part of a maximum, or a lower bound on every part of a minimum."""
        if constraint.lower is None:
            self.add_constraint(constraint, value, None, None)
        else:
            self.require_nonpositive((constraint.lower - value) * (1.0 / (abs(constraint.lower) or 1.0)))

    def contracted_ranges(self) -> tuple[Array, Array]:
        """Return low and high (k, n), the part of [-1, 1]^k that holds all feasible designs."""
        low, high = -np.ones((self.k, len(self.alive))), np.ones((self.k, len(self.alive)))
        for centre, slopes, rest in self.rows:
            # centre + slopes . d - rest <= FEASIBLE, with all other coordinates at their best.
            best = np.minimum(slopes * low, slopes * high)
            slack = FEASIBLE - centre + rest + INFLATION * (np.abs(centre) + np.abs(slopes).sum(axis=0))
            for i in range(self.k):
                slope = slopes[i]
                limit = (slack - best.sum(axis=0) + best[i]) / np.where(slope == 0.0, np.nan, slope)
                limit = np.where(np.isfinite(limit), limit, np.where(slope < 0.0, -np.inf, np.inf))
                high[i] = np.where(slope > 0.0, np.minimum(high[i], limit + INFLATION), high[i])
                low[i] = np.where(slope < 0.0, np.maximum(low[i], limit - INFLATION), low[i])
        self.alive &= (low <= high).all(axis=0)
        return np.minimum(low, 1.0), np.maximum(high, -1.0)

    def trial_points(self, low: Array, high: Array) -> Array:
        """Return points (k, n) moved from the middle across the conditions that fail there, one after another."""
        d = 0.5 * (low + high)
        for _ in range(_ROUNDS):
            for centre, slopes, rest in self.rows:
                violation = centre + (slopes * d).sum(axis=0) + rest + _INSIDE
                steep = (slopes * slopes).sum(axis=0)
                step = np.where((violation > 0.0) & (steep > 0.0), violation / np.where(steep > 0.0, steep, 1.0), 0.0)
                d = np.clip(d - step * slopes, low, high)
        return d

    def width_effects(self, low: Array, high: Array) -> Array:
        """Return the effect of the width along each axis on the conditions that are not certain to hold, (n, k)."""
        widest = np.zeros((len(self.alive), self.k))
        for centre, slopes, rest in self.rows:
            open_ = centre + np.maximum(slopes * low, slopes * high).sum(axis=0) + rest > 0.0
            widest = np.fmax(widest, (np.abs(slopes) * (high - low) * open_).T)
        return widest
