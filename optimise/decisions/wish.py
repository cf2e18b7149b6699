"""A design from aspiration levels: the Pareto-optimal one nearest to desired values, from a new solve.

Objectives f_i are as minimised, measured from the front's ideal z* and divided by their range over the front. Desired
values z_i and classes, see `wishes`, define an augmented achievement scalarising function,

    min over designs   max( f_i - z_i  for a desired value,   f_i - z*_i  to improve ) + rho sum_i f_i
    subject to   f_i <= the design's value  to improve or to keep,   f_i <= the value that it may worsen to,

and all requirements of the problem (A. P. Wierzbicki, "The use of reference objectives in multiobjective optimization",
Lecture Notes in Economics and Mathematical Systems 177, 1980; Miettinen and Mäkelä, see `wishes`). If every wish can be
met, all are exceeded (the function is negative); otherwise the conflicting ones are relaxed by the same fraction of
their ranges. A small multiple rho of the sum makes every minimiser Pareto-optimal, whether the wishes can be met or
not.

The polish solves it on every branch of the problem (sign of the offset, choices). It starts from distinct designs on
the front that are nearest to the desired values. Their lengths are tried on all other branches as well. If they end in
different optima, more designs are tried. The answer is never worse than the best design on the front, and exact within
its valley; only more starts can show that no other valley is deeper.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.errors import InputError
from ..front.front import ParetoFront, require_front
from ..front.rounding import ranges_or_sizes
from ..methods.registry import require_gradients
from ..methods.scalar_objective import SUM, Achievement, Form
from ..problem.constraint_violation import FEASIBLE
from ..search.assemble_front import assemble_front, empty_front
from ..search.candidates import Candidates, FrontCandidates
from ..search.elimination import elimination_branches
from ..search.evaluation import Evaluator
from ..search.mirrored_branches import drop_mirrored_branches
from ..search.polish import polish_designs
from ..search.sample_and_zoom import BANDS, Run
from ..search.sampling import distant_rows
from .wishes import Wish, Wished, minimised_aim, outcomes_of, read_wishes

_NEAREST, _MORE = 3, 6  # starts per branch, and further ones if the first end in different optima
_BRANCHES, _FINAL = 12, 2  # branches to try, best first, at first from one start each; then the best of these
_WORSE = 0.5  # relative to the ranges: a branch is skipped if its best start is worse than the best of all by more
_DIFFER = 1e-9  # relative to the ranges: optima farther apart are different
_OUTSIDE = 10.0  # merit added to a start above a ceiling, or outside the requirements


class Wishes:
    """Starts for wishes on a front, prepared once for many wishes.

    Raises `InputError` for a front without designs or with one objective, and for a quantity without a gradient.
    """

    def __init__(self, front: ParetoFront) -> None:
        require_front(front, "a wish")
        if len(front.objectives) < 2:
            raise InputError(
                f"a wish needs at least two objectives; got one, {front.objectives[0].quantity}, whose best design "
                "is the front"
            )
        if not len(front):
            raise InputError(f"a wish needs a front with designs; this one is empty: {front.message}")
        require_gradients(front.problem, "a wish")
        self.front = front
        self.ideal = front.values.min(axis=0)
        sizes = [abs(objective.target or 0.0) for objective in front.objectives]
        self.span = ranges_or_sizes(front.values, self.ideal, sizes)
        self._branches = drop_mirrored_branches(front.problem, elimination_branches(front.problem))
        self._starts = self._starting_designs()

    def design_nearest_to_wishes(self, texts: Mapping[str, object], *, row: int | None = None) -> Wished:
        """Return the design nearest to the wishes; see `wish`."""
        front = self.front
        if row is not None:
            front.part(row)  # raises an error for an unknown row
            row = int(row) % len(front)
        wishes = read_wishes(front, texts, row)
        form, aims = self._achievement_form(wishes, row)
        evaluators = self._evaluators()
        best = self._solve(form, evaluators)
        run = Run(front.problem, 1)
        if best is None:
            message = self._no_design_message(wishes)
            nothing = empty_front(front.problem, evaluators, run, "infeasible", message)
            return Wished(found=nothing, row=row, wishes=wishes, value=np.nan, outcomes=(), message=message)
        index, u, value = best
        finished = FrontCandidates.without_designs(self.span)
        finished.add_feasible(index, polish_designs(evaluators[index], u[None], self.span, iterations=0))
        front_of_wish = assemble_front(front.problem, evaluators, finished, run)
        outcomes = outcomes_of(front, wishes, aims, row, front_of_wish)
        return Wished(found=front_of_wish, row=row, wishes=wishes, value=value, outcomes=outcomes)

    def _evaluators(self) -> list[Evaluator]:
        return [Evaluator(self.front.problem, branch) for branch in self._branches]

    def _starting_designs(self) -> Candidates:
        """Return the front's designs on their own branches, and their numbers on all other branches."""
        front, parts = self.front, []
        variants = np.array(front.variants or np.zeros(len(front)), dtype=np.int64)
        for index, evaluator in enumerate(self._evaluators()):
            branch = evaluator.branch
            on_branch = (variants == branch.variant) & (np.sign(front.dimensions[:, 2]) != -branch.sign)
            u = branch.points_of_designs(front.dimensions)
            if on_branch.any():
                feasible = np.ones(int(on_branch.sum()), np.bool_)
                parts.append(Candidates(np.full(len(feasible), index), u[on_branch], front.values[on_branch], feasible))
            elsewhere = np.unique(u[~on_branch], axis=0)
            if len(elsewhere):
                _, values, violation = evaluator.screen_designs_objectives_violation(elsewhere, band=BANDS[-1])
                usable = np.isfinite(values).all(axis=1) & evaluator.can_evaluate(elsewhere)
                rest = (
                    np.full(int(usable.sum()), index),
                    elsewhere[usable],
                    values[usable],
                    violation[usable] <= FEASIBLE,
                )
                parts.append(Candidates(*rest))
        return parts[0].join(*parts[1:])

    def _achievement_form(self, wishes: Sequence[Wish], row: int | None) -> tuple[Form, list[float | None]]:
        """Return the achievement function, and the desired values as minimised, SI."""
        m = len(wishes)
        weights, reference, ceilings = np.zeros(m), np.zeros(m), np.full(m, np.inf)
        reference_values = None if row is None else self._scale_objectives(self.front.values[row])
        aims: list[float | None] = [None] * m
        for column, wish in enumerate(wishes):
            if wish.value is not None:
                aims[column] = aim = minimised_aim(self.front, column, wish)
                scaled = (aim - self.ideal[column]) / self.span[column]
                if wish.kind == "value":
                    weights[column], reference[column] = 1.0, scaled
                else:
                    ceilings[column] = scaled
            elif wish.kind != "free" and reference_values is not None:
                ceilings[column] = reference_values[column]
                weights[column] = float(wish.kind == "improve")
        return Form(weights, reference, ceilings, SUM), aims

    def _scale_objectives(self, values: Array) -> Array:
        return np.asarray((values - self.ideal) / self.span)

    def _solve(self, form: Form, evaluators: list[Evaluator]) -> tuple[int, Array, float] | None:
        """Return branch, point (k,) and value of the achievement function at its minimiser.

        None if no start leads to a design.
        """
        scaled = self._scale_objectives(self._starts.values)
        excess = np.maximum(scaled - form.ceilings, 0.0).max(axis=1)
        free = replace(form, ceilings=np.full(len(form.weights), np.inf))
        merits = free.form_value(scaled) + _OUTSIDE * (excess + ~self._starts.is_feasible)
        branch, tried = self._starts.branch, np.zeros(len(merits), np.bool_)
        ends: list[tuple[float, int, Array]] = []  # the best first
        chosen = self._promising_branches(merits)
        for count in (_NEAREST, _MORE) if len(chosen) == 1 else (1, _NEAREST, _MORE):
            for index in chosen:
                untried = np.flatnonzero((branch == index) & ~tried)
                rows = untried[distant_rows(merits[untried], self._starts.u[untried], branch[untried], count)]
                tried[rows] = True
                ends += self._descend_from_starts(form, evaluators[index], index, rows)
            ends.sort(key=lambda end: end[0])
            order = list(dict.fromkeys(index for _, index, _ in ends))
            same = [value for value, index, _ in ends if index == order[0]] if ends else []
            if len(same) > 1 and same[-1] - same[0] <= _DIFFER:
                break
            chosen = order[:_FINAL] or chosen
        if not ends:
            return None
        value, index, u = ends[0]
        return index, u, value

    def _promising_branches(self, merits: Array) -> list[int]:
        """Return the branches to try, best first."""
        merit_by_branch = {
            index: float(merits[self._starts.branch == index].min()) for index in set(self._starts.branch.tolist())
        }
        order = sorted(merit_by_branch, key=lambda index: (merit_by_branch[index], index))
        return [index for index in order if merit_by_branch[index] <= merit_by_branch[order[0]] + _WORSE][:_BRANCHES]

    def _descend_from_starts(
        self, form: Form, evaluator: Evaluator, index: int, rows: IntArray
    ) -> list[tuple[float, int, Array]]:
        """Return the feasible end points of the starts on a branch, with the achievement function's value there."""
        if not len(rows):
            return []
        start = self._starts.u[rows][:, : evaluator.dimension]
        achievement = Achievement(evaluator, form, self.ideal, self.span)
        polished_starts = polish_designs(achievement, start, np.ones(1 + len(self.span)), hold=False)
        good = (polished_starts.violation <= FEASIBLE) & np.isfinite(polished_starts.values).all(axis=1)
        return [
            (float(polished_starts.values[at].sum()), index, polished_starts.u[at])
            for at in np.flatnonzero(good).tolist()
        ]

    def _no_design_message(self, wishes: Sequence[Wish]) -> str:
        """Say that no design stays within the allowed values, and give the front's best values."""
        phrases = []
        for column, wish in enumerate(wishes):
            if wish.kind == "limit":
                quantity = self.front.problem.quantity(self.front.objectives[column].quantity)
                best = self.front.columns[quantity.field][int(np.argmin(self.front.values[:, column]))]
                allowed = f"{(wish.value or 0.0) * quantity.unit.factor:.4g} {quantity.unit.symbol}".rstrip()
                has = f"{best:.4g} {quantity.unit.symbol}".rstrip()
                phrases.append(f"{quantity.title} {allowed} or better, but the best on the front is {has}")
        return f"no design was found with {' and '.join(phrases)}; allow more"


def wish(front: ParetoFront, wishes: Mapping[str, object], *, row: int | None = None) -> Wished:
    """Return the Pareto-optimal design nearest to desired values for a front's objectives, from a new solve.

    wishes: by objective, a desired value, "110 N m" or a number in SI, which is not a bound; or a class. Classes:
    "improve" on a design on the front; "keep" its value or better; "may worsen to 120 N m", which is a bound; or
    "free", the default. row: row of the design to which classes refer.

    `wish(front, {"peak_torque": "110 N m", "transmission_angle": "45 deg"})`. For many wishes on one front, `Wishes` is
    faster. Raises `InputError` for contradictory wishes, and for a front without designs or with one objective.
    """
    return Wishes(front).design_nearest_to_wishes(wishes, row=row)
