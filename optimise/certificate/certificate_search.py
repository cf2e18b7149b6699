"""Search for a proof: open boxes, the covering set of designs, and the bounds found so far."""

import itertools
import time
from collections.abc import Callable

import numpy as np
import pandas as pd

from ...model.arrays import Array, IntArray, sorted_unique
from ..problem.constraint_violation import FEASIBLE, minimised_values, restated_constraints
from ..problem.problem import Problem
from ..search.assemble_front import columns_of_designs, objective_ranges
from ..search.candidates import Candidates
from ..search.elimination import elimination_branches
from ..search.evaluation import Evaluator
from ..search.recorded_polish import polish_on_engine
from .box_bounds import Boxes
from .box_conditions import can_rule_out_boxes, sides_that_rule_out_no_boxes
from .branch_and_bound import Tree, bounding_threads
from .certificate import Certificate, Status, Step, certificate_message
from .covering_designs import choose_covering_designs, excess_over_designs, greedy_cover, hypervolume_gap_bound

_BATCH = 4096  # boxes halved per batch
_MOST = 4_000_000  # open boxes; memory for these is allocated
_POLISHED = 400  # added designs to polish; more would take longer than the proof
_STEPS = 8  # steps per polish: most of the improvement; the designs need not be stationary
_SHARE = 0.15  # fraction of the time that is reserved for polishing
_MOST_PAIRS = 50_000_000  # pairs of added design and corner to examine for a smaller set


def _exact_objectives(problem: Problem, dimensions: Array) -> Array:
    """Return the minimised objectives (n, m) for designs of one variant, exact over continuous crank angle."""
    columns = [
        minimised_values(wish, problem.quantity(wish.quantity).evaluate(problem.mechanism, dimensions).values)
        for wish in problem.objectives
    ]
    return np.stack(columns, axis=1)


class Search:
    """Branch and bound: open boxes, the covering set of designs, and the bounds found so far."""

    def __init__(
        self,
        problem: Problem,
        dimensions: Array,
        variants: IntArray,
        epsilon: float,
        seconds: float,
        cancelled: Callable[[], bool] | None,
    ) -> None:
        """Prepare the bounds; raise `InputError` for objectives that cannot be bounded."""
        self.start = time.perf_counter()
        self.problem, self.epsilon, self.seconds = problem, epsilon, seconds
        self.cancelled = cancelled
        values = np.empty((len(dimensions), len(problem.objectives)))
        for variant in sorted_unique(variants).tolist():
            rows = variants == variant
            values[rows] = _exact_objectives(problem.part(variant), dimensions[rows])
        self.span, self.ideal = objective_ranges(problem, values), values.min(axis=0)
        self.front = self._scale_objectives(values)
        self.designs = self.front
        self.evaluators = [Evaluator(problem, branch) for branch in elimination_branches(problem)]
        self.tree = Tree.of_branches([Boxes(evaluator, self.span) for evaluator in self.evaluators])
        m = len(problem.objectives)
        self.added = Candidates.empty(m)  # values scaled
        self.needy = [np.zeros((0, m))]  # corners of closed boxes that the front alone does not cover
        self.closed_excess = 0.0  # largest excess of closed boxes over the set and over the front alone
        self.closed_by_front = 0.0
        self.gap, self.hole = 0.0, np.full(dimensions.shape[1], np.nan)
        self.stopped = False

    def _scale_objectives(self, values: Array) -> Array:
        return np.asarray((values - self.ideal) / self.span)

    # ---- the search -----------------------------------------------------------------------------------------------

    def run(self, progress: Callable[[Step], None] | None) -> None:
        """Halve boxes until all are closed or the budget runs out."""
        with bounding_threads() as threads:
            for index in range(len(self.evaluators)):
                self._process_boxes(index, *self.tree.initial_boxes(index), threads)
            while True:
                self._report_step(progress)
                rows = self.tree.rows_of_largest_excess(_BATCH)
                if not len(rows) or self._should_stop():
                    break
                for index, lower, upper in self.tree.split_boxes(self._close_covered_boxes(rows)):
                    self._process_boxes(index, lower, upper, threads)
        if len(self.tree):  # check all designs against all open boxes
            self._close_covered_boxes(np.arange(len(self.tree)))

    def _should_stop(self) -> bool:
        self.stopped = self.stopped or (self.cancelled is not None and self.cancelled())
        late = time.perf_counter() - self.start > self.seconds * (1.0 - _SHARE)
        return self.stopped or late or len(self.tree) > _MOST

    def _close_covered_boxes(self, rows: IntArray) -> IntArray:
        """Close the boxes that designs added since their opening cover; return the others."""
        tree = self.tree
        tree.excess[rows] = excess_over_designs(
            tree.corner[rows],
            self.designs,
            earlier_excess=tree.excess[rows],
            first=tree.counted_designs[rows],
            enough=self.epsilon,
        )
        tree.counted_designs[rows] = len(self.designs)
        covered = tree.excess[rows] <= self.epsilon
        self._record_closed_corners(tree.corner[rows[covered]], tree.excess[rows[covered]])
        is_open = np.ones(len(tree), dtype=bool)
        is_open[rows[covered]] = False
        if covered.any():
            tree.keep_boxes(is_open)
        return np.asarray(np.cumsum(is_open)[rows[~covered]] - 1)

    def _process_boxes(self, index: int, lower: Array, upper: Array, threads: object) -> None:
        """Bound boxes of a branch, close those that can be closed, and open the rest."""
        boxes = self.tree.bound_boxes(index, lower, upper, threads)  # type: ignore[arg-type]
        corner = self._scale_objectives(boxes.corner)
        gaps = excess_over_designs(corner, self.designs, enough=self.epsilon)
        wanting = np.flatnonzero(gaps > self.epsilon)
        if len(wanting):
            gaps[wanting] = self._add_covering_designs(index, boxes.trial[wanting], corner[wanting], gaps[wanting])
        covered = gaps <= self.epsilon
        self._record_closed_corners(corner[covered], gaps[covered])
        self.tree.add_boxes(index, boxes[~covered], corner[~covered], gaps[~covered], len(self.designs))

    def _add_covering_designs(self, index: int, trial: Array, corner: Array, gaps: Array) -> Array:
        """Add designs that cover the corner of their box where no other does; return the excess of each corner."""
        evaluator = self.evaluators[index]
        dimensions, values, violation = evaluator.screen_designs_objectives_violation(trial)
        good = np.flatnonzero(violation <= FEASIBLE)
        if not len(good):
            return gaps
        scaled = self._scale_objectives(values[good])
        lead = excess_over_designs(scaled, self.front)
        farthest = int(np.argmax(lead))
        if lead[farthest] > self.gap:
            self._remember_farthest_design(index, dimensions[good[farthest]])
        rows = good[choose_covering_designs(corner[good], scaled, self.epsilon)]
        if not len(rows):
            return gaps
        fresh = self._scaled_exact_objectives(index, dimensions[rows])
        additions = Candidates(np.full(len(rows), index), trial[rows], fresh, np.ones(len(rows), np.bool_))
        self.added = self.added.join(additions)
        self.designs = np.concatenate([self.designs, fresh])
        return excess_over_designs(corner, fresh, earlier_excess=gaps, enough=self.epsilon)

    def _scaled_exact_objectives(self, index: int, dimensions: Array) -> Array:
        return self._scale_objectives(_exact_objectives(self.evaluators[index].problem, dimensions))

    def _remember_farthest_design(self, index: int, design: Array) -> None:
        """Store the design of a branch that lies farthest beyond the front so far."""
        lead = float(excess_over_designs(self._scaled_exact_objectives(index, design[None]), self.front)[0])
        if lead > self.gap:
            self.gap, self.hole = lead, design

    def _record_closed_corners(self, corner: Array, gaps: Array) -> None:
        if not len(corner):
            return
        self.closed_excess = max(self.closed_excess, float(gaps.max()))
        alone = excess_over_designs(corner, self.front, enough=self.epsilon)
        self.closed_by_front = max(self.closed_by_front, float(alone.max()))
        self.needy.append(corner[alone > self.epsilon])

    def _report_step(self, progress: Callable[[Step], None] | None) -> None:
        if progress is not None:
            tree = self.tree
            progress(
                Step(self._proven_epsilon(), tree.bounded, len(tree), len(self.added), time.perf_counter() - self.start)
            )

    def _proven_epsilon(self) -> float:
        return max(self.closed_excess, float(self.tree.excess.max(initial=0.0)))

    # ---- the result -----------------------------------------------------------------------------------------------

    def build_certificate(self) -> Certificate:
        """Return the certificate so far, with its added designs polished and reduced to as few as possible."""
        tree, proven = self.tree, self._proven_epsilon()
        needy = np.concatenate(self.needy)
        self._drop_redundant_designs(needy)
        self._polish_added_designs()
        self._drop_redundant_designs(needy)
        self.designs = np.concatenate([self.front, self.added.values])
        dimensions = self.added.dimensions(self.evaluators)
        leads = excess_over_designs(self.added.values, self.front)
        if len(leads) and leads.max() > self.gap:
            farthest = int(np.argmax(leads))
            self._remember_farthest_design(int(self.added.branch[farthest]), dimensions[farthest])
        # If an added design covers a point, the front covers it to within the sum of both excesses.
        least = max(self.closed_by_front, float(excess_over_designs(tree.corner, self.front).max(initial=0.0)))
        delivered = max(min(least, proven + float(leads.max(initial=0.0))), self.gap)
        status: Status = "cancelled" if self.stopped else "out of budget"
        if proven <= self.epsilon:
            status = "proven"
        open_range = self._worst_open_box() if len(tree) else None
        return Certificate(
            status=status,
            requested=self.epsilon,
            epsilon=proven,
            delivered=delivered,
            gap=self.gap,
            hole=self.hole if self.gap > 0.0 else None,
            hypervolume_gap=hypervolume_gap_bound(
                self.front, self.designs, proven, np.concatenate([needy, tree.corner])
            ),
            span=self.span,
            added=dimensions,
            added_values=self.added.values * self.span + self.ideal,
            table=self._table_of_designs(dimensions) if len(dimensions) else pd.DataFrame(),
            boxes=tree.bounded,
            open=len(tree),
            remaining=tree.open_fraction(),
            worst_open_box=open_range,
            notes=self._notes(),
            seconds=time.perf_counter() - self.start,
            message=certificate_message(
                status, self.epsilon, proven, delivered, self.gap, len(self.front), len(dimensions)
            ),
        )

    def _table_of_designs(self, dimensions: Array) -> pd.DataFrame:
        variants = np.array([evaluator.branch.variant for evaluator in self.evaluators], dtype=np.int64)
        return pd.DataFrame(columns_of_designs(self.problem, variants[self.added.branch], dimensions))

    def _notes(self) -> tuple[str, ...]:
        notes = []
        constraints = ((part, item) for part in self.problem.parts() for item in restated_constraints(part))
        for part, constraint in constraints:
            title = part.quantity(constraint.quantity).title
            if not can_rule_out_boxes(part, constraint):
                notes.append(f"the bounds ignore the requirement on {title}")
                continue
            notes += [
                f"the bounds ignore the {word} of {title}" for word in sides_that_rule_out_no_boxes(part, constraint)
            ]
        return tuple(dict.fromkeys(notes))

    def _drop_redundant_designs(self, needy: Array) -> None:
        """Drop added designs whose corners other designs cover."""
        if not len(self.tree) and len(self.added) * len(needy) <= _MOST_PAIRS:
            self.added = self.added[greedy_cover(needy, self.added.values, self.epsilon)]

    def _polish_added_designs(self) -> None:
        """Move added designs onto the front if no objective worsens, so that they still cover the same points."""
        if len(self.added) > _POLISHED:
            return
        for index, evaluator in enumerate(self.evaluators):
            added = np.flatnonzero(self.added.branch == index)
            for begin in range(0, len(added), 32):
                rows = added[begin : begin + 32]
                if time.perf_counter() - self.start > self.seconds or self.stopped:
                    return
                k = evaluator.dimension
                part = polish_on_engine(evaluator, self.added.u[rows][:, :k], self.span, iterations=_STEPS)
                fresh = self._scaled_exact_objectives(index, evaluator.branch.designs_at_points(part.u))
                better = (part.violation <= FEASIBLE) & (fresh <= self.added.values[rows]).all(axis=1)
                self.added.u[rows[better], :k] = part.u[better]
                self.added.values[rows[better]] = fresh[better]

    def _worst_open_box(self) -> Array:
        tree = self.tree
        row = int(np.argmax(tree.excess))
        evaluator = self.evaluators[int(tree.branch[row])]
        k = evaluator.dimension
        low, high = tree.lower[row, :k], tree.upper[row, :k]
        corners = np.array(list(itertools.product((0.0, 1.0), repeat=k))).reshape(2**k, k)
        corner_designs = evaluator.branch.designs_at_points(low + (high - low) * corners)
        return np.stack([corner_designs.min(axis=0), corner_designs.max(axis=0)], axis=1)
