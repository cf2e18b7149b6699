"""Result of an optimisation: the Pareto front, its quality, and how it was found."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array, Mask
from ...model.checks import is_number
from ...model.errors import InputError, warn_user
from ...model.machine.loads.load import require_word
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import System, metric_unit_in
from ...objectives.quantity import Quantity
from ...objectives.registry import QUANTITIES
from ...objectives.tables.evaluate_quantities import violations_of_allowables
from ..problem.problem import Problem
from ..problem.question_registry import question_about, subject_of_question
from ..problem.requirements import Objective
from ..problem.table_columns import sufficient_option_field
from .choose_design import Normalisation, Priority, knee_row, lexicographic, scale_by_range, topsis
from .front_picture import scatter_figure, scatter_svg
from .nonnegative_least_squares import nonnegative_least_squares
from .progress import DiscreteSearch, Progress
from .rounded_design import Rounded
from .rounding import ranges_or_sizes, readings_of_unitless_misses, round_design
from .rounding_search import Stage
from .saved_front import column_ranges, front_fields, write_front
from .stationarity import STATIONARY, optimality_multipliers

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

Columns = dict[str, NDArray[Any]]
_NOTHING = 1e-7  # relative to ranges: smaller gains, and smaller losses per gain, are rounding
_LEAST = 1e-4  # relative to a range: smallest step and smallest cost worth reporting
_UNMET = 1e-7  # residual above which there is no solution, for rows of size one
Status = Literal["done", "cancelled", "infeasible"]


@dataclass(frozen=True, eq=False)
class ParetoFront:
    """The Pareto front of a problem and the evidence for it.

    columns: columns (n,) of the table of designs: all quantities under their JSON names with units, then
    `slack_<field>` for every constraint (distance to the nearer bound in the quantity's display unit; zero where
    active), `residual` (stationarity) and `status` ("stationary" or "best found"). Sorted by the first objective, best
    first. dimensions: (n, 3 + v) crank, rod, offset, m, and the exact values of the extra variables, SI.
    variants: index of each design's variant in the problem; empty if there are no choices.
    values: (n, m) minimised objectives (maximised ones negated, targets as distances), SI. goals: for each design,
    objective index and gradient of every active piece; active: gradients of its active constraints; both with respect
    to the free unknowns scaled to the unit box. hypervolume: dominated fraction of the box between the front's ideal
    and 1.1 times nadir, see `hypervolume.py`. history: rounds, with hypervolumes in the same box. versions: versions of
    this software and its numerical libraries. discrete: extent of the search among discrete values; None if there are
    none.
    """

    problem: Problem
    status: Status
    message: str
    columns: Columns
    dimensions: Array
    values: Array
    goals: tuple[tuple[Array, Array], ...]
    active: tuple[Array, ...]
    hypervolume: float
    history: tuple[Progress, ...]
    evaluations: int
    seconds: float
    seed: int
    versions: dict[str, str] = field(default_factory=dict)
    variants: tuple[int, ...] = ()
    discrete: DiscreteSearch | None = None

    @cached_property
    def designs(self) -> pd.DataFrame:
        """The designs as a pandas DataFrame, one row per design."""
        import pandas as pd

        return pd.DataFrame(self.columns)

    def __len__(self) -> int:
        return len(self.values)

    def __repr__(self) -> str:
        count = f"{len(self)} design" + ("" if len(self) == 1 else "s")
        return f"ParetoFront({self.problem.name!r}: {self.status}, {count}; {'; '.join(self._labels())})"

    def _repr_html_(self) -> str:
        """HTML table of the first designs and a plot, for notebooks."""
        if not len(self):
            return f"<p>{escape(self.problem.name)}: {escape(self.message)}</p>"
        columns = [quantity.field for quantity in self._quantities]
        sizes = [name for name in ("crank_mm", "rod_mm", "offset_mm") if name in self.columns]
        table = self.designs[list(dict.fromkeys([*columns, *sizes]))].to_html(max_rows=8, float_format="{:.5g}".format)
        return f"<div><p>{escape(repr(self))}</p>{scatter_svg(self._objective_columns(), self._labels())}{table}</div>"

    def plot(self) -> Figure:
        """Return a matplotlib figure of every objective against the first. Raises `InputError` for an empty front."""
        if not len(self):
            raise InputError(f"a figure needs designs; this front is empty: {self.message}")
        return scatter_figure(self._objective_columns(), self._labels(), self.problem.name)

    def _labels(self) -> list[str]:
        return [f"{item.title}, {item.unit.symbol}".removesuffix(", ") for item in self._quantities]

    def _objective_columns(self) -> Array:
        return np.stack([self.columns[quantity.field] for quantity in self._quantities], axis=1)

    @property
    def _quantities(self) -> list[Quantity]:
        return [self.problem.quantity(objective.quantity) for objective in self.objectives]

    @property
    def objectives(self) -> tuple[Objective, ...]:
        """The problem's objectives."""
        return self.problem.objectives

    def part(self, row: int) -> Problem:
        """Return the problem that a design solves, with its choices made.

        Raises `InputError` for a row that is not in the front.
        """
        try:
            is_row = 0 <= operator.index(row) < len(self)
        except TypeError:
            is_row = False
        if not is_row:
            has = f"rows 0 to {len(self) - 1}" if len(self) else "no design"
            raise InputError(f"a row must be one of the front's {has}; got {row!r}")
        return self.problem.part(self.variants[row] if self.variants else 0)

    def mechanism(self, row: int) -> Mechanism:
        """Return a design's machine, with its choices made and its extra variables set."""
        return self.part(row).mechanism.with_values(self.dimensions[row, 3:].tolist())

    def ask(self, question: str, row: int | None = None, /, **inputs: object) -> dict[str, Any]:
        """Answer a question about the front, or about the design in a row, as `Problem.ask` does.

        "certify", "wish", "like" and "round" are questions about a front, as are the commands of these names:
        `front.ask("certify", epsilon=0.02)`, `front.ask("wish", at={"peak_torque": "110 N m"})`. The row is the design
        to which "improve" and "keep" refer, or the one to round: `front.ask("round", 3, to="0.5 mm")`. All other
        questions are about a design: `front.ask("press", front.knee())`. Raises `InputError` for an unknown question,
        row or input, and for anything that the front lacks.
        """
        if row is None or subject_of_question(question) == "front":
            record: dict[str, Any] = question_about("front", question).answer_of(self, row, inputs)
            return record
        return self.part(row).ask(question, self.dimensions[row], **inputs)

    def save(self, file: str | PathLike[str]) -> None:
        """Write the front as JSON, without its problem. Raises `OSError`."""
        write_front(vars(self), Path(file))

    @classmethod
    def load(cls, file: str | PathLike[str], problem: Problem) -> ParetoFront:
        """Return a front that `save` wrote, unchanged to the last bit. problem: the problem that the front solves.

        Raises `InputError` for any other file, and for a front of another problem.
        """
        return cls(**front_fields(Path(file), problem))

    @property
    def violated(self) -> dict[str, Array]:
        """Excess (n,) of each design over an allowable value, SI, by quantity; see `Analysis.violated`.

        Zero for a design within the allowable value; quantities that no design exceeds are omitted.
        """
        variants = np.array(self.variants or [0] * len(self))
        excess_by_name: dict[str, Array] = {}
        for variant in dict.fromkeys(variants.tolist()):
            rows = variants == variant

            def values_of(name: str, rows: Mask = rows) -> Array | None:
                quantity = QUANTITIES[name]
                return (
                    self.columns[quantity.field][rows] / quantity.unit.factor
                    if quantity.field in self.columns
                    else None
                )

            for name, excess in violations_of_allowables(self.problem.part(variant).mechanism, values_of).items():
                excess_by_name.setdefault(name, np.zeros(len(self)))[rows] = excess
        return excess_by_name

    def extremes(self) -> dict[str, int]:
        """Return the row of the best design for each objective; ties go to the better in the other objectives."""
        scaled = scale_by_range(self.values, size=self._objective_targets)
        best = {}
        for index, objective in enumerate(self.objectives):
            least = np.flatnonzero(scaled[:, index] <= scaled[:, index].min() + 1e-9)
            best[objective.quantity] = int(least[np.argmin(scaled[least].sum(axis=1))])
        return best

    def knee(self) -> int:
        """Return the row nearest to the ideal point, with every objective scaled by its range over the front."""
        return knee_row(self.values, size=self._objective_targets)

    def topsis(self, weights: Mapping[str, float], *, normalisation: Normalisation = "range") -> int:
        """Return the row chosen by weights for the objectives, see `choose_design.closeness`.

        Omitted ones have no weight.

        `front.topsis({"peak_torque": 2.0, "transmission_angle": 1.0})`. Raises `InputError` for other names.
        """
        columns = {self.column_of(name): weight for name, weight in weights.items()}
        for name, weight in weights.items():
            if not is_number(weight):
                raise InputError(f"the weight of {name} must be a number; got {weight!r}; write it like 2.0")
        shares = [columns.get(column, 0.0) for column in range(len(self.objectives))]
        return topsis(self.values, shares, normalisation=normalisation, size=self._objective_targets)

    def lexicographic(self, *priorities: Priority | str) -> int:
        """Return the row that remains when objectives decide in turn; see `choose_design.lexicographic`.

        `front.lexicographic(Priority(quantity="peak_torque", share=0.1), "transmission_angle")`: among the designs
        whose torque exceeds the least by at most a tenth of its range, the one with the best transmission angle. A name
        alone means zero share.
        """
        order = [Priority(quantity=item) if isinstance(item, str) else item for item in priorities]
        for item in order:
            if not isinstance(item, Priority):
                raise InputError(f"a ranking may only contain names and Priority(...); got {item!r}; name an objective")
        ranking = [(self.column_of(item.quantity), item.absolute, item.share) for item in order]
        return lexicographic(self.values, ranking, size=self._objective_targets)

    @property
    def _objective_targets(self) -> list[float]:
        """The objectives' targets, SI, 0 if an objective has none: the scale for rounding distances from them."""
        return [abs(objective.target or 0.0) for objective in self.objectives]

    def column_of(self, name: str) -> int:
        """Return the column of an objective in `values`. Raises `InputError` for any other name."""
        names = [objective.quantity for objective in self.objectives]
        plain = ["".join(item.split()) for item in names]  # spaces in a formula do not matter
        if "".join(str(name).split()) not in plain:
            raise InputError(f"pick must name one of the objectives {', '.join(names)}; got {name!r}")
        return plain.index("".join(str(name).split()))

    def pick(self, best: str, **bounds: tuple[float | None, float | None]) -> int:
        """Return the row that is best in an objective among the designs within bounds.

        best: name of an objective. bounds: column = (least, greatest) in the table's units, None if unbounded:
        `front.pick("peak_torque", least_transmission_angle_deg=(40, None))`. A quantity or formula may replace a
        column, with its bounds in SI: `**{"2 * crank + rod": (None, 0.4)}`. Raises `InputError` if no design qualifies.
        """
        objective = self.column_of(best)
        if not len(self):
            raise InputError(f"a pick needs a front with designs; this one is empty: {self.message}")
        keep, ranges = np.ones(len(self), dtype=bool), []
        for column, ends in bounds.items():
            least, greatest = least_and_greatest_of_bounds(column, ends)
            values = self.columns[column] if column in self.columns else self._evaluate(column)
            if values.dtype.kind not in "fiu":
                raise InputError(f"bounds may only be on numbers; got {column}, a column of words; see front.designs")
            if least is not None:
                keep &= values >= least
            if greatest is not None:
                keep &= values <= greatest
            ranges.append(f"{column} is {values.min():.6g} to {values.max():.6g}")
        if not keep.any():
            raise InputError(f"no design on the front is within {bounds}, whose {' and '.join(ranges)}; widen a bound")
        rows = np.flatnonzero(keep)
        return int(rows[np.argmin(self.values[rows, objective])])

    def _evaluate(self, name: str) -> Array:
        """Return the values of a quantity or formula for all designs, SI."""
        values = np.full(len(self), np.nan)
        variants = np.array(self.variants or [0] * len(self))
        for variant in set(variants.tolist()):
            rows = np.flatnonzero(variants == variant)
            try:
                values[rows] = self.problem.part(variant).evaluate(self.dimensions[rows], [name])[:, 0]
            except InputError:
                if not name.isidentifier():
                    raise
                raise InputError(f"the table has no column {name!r}; see front.designs.columns") from None
        return values

    def rounded(
        self,
        row: int,
        to: float | Mapping[str, float],
        *,
        count: int = 5,
        allow: Mapping[str, float | str] | None = None,
        progress: Callable[[Stage], None] | None = None,
    ) -> Rounded:
        """Return the best designs with round numbers near a design that meet every requirement, with their losses.

        to: one step for crank, rod and offset, m, or steps by name, SI: `front.rounded(3, {"crank": 5e-4, "rod":
        1e-3})`.
        allow: allowed deviations of requirements, by quantity, SI or as text: `{"stroke": "0.1 mm"}`. If no rounded
        design within 32 steps meets all requirements, the nearest are returned and `is_met` is False; `misses` gives
        the amounts.
        progress: called several times a second; an exception from it ends the search. See `Rounded` and
        `rounding.rounding`. Warns if an allowed deviation without a unit is more than a tenth of the required value.
        """
        for doubt in readings_of_unitless_misses(self.part(row), allow or {}):
            warn_user(f"allowed deviations are in SI: {doubt}")
        for stage in self.rounding(row, to, count=count, allow=allow):
            if isinstance(stage, Rounded):
                return stage
            if progress is not None:
                progress(stage)
        raise AssertionError("the search ends with its answer")

    def rounding(
        self,
        row: int,
        to: float | Mapping[str, float],
        *,
        count: int = 5,
        allow: Mapping[str, float | str] | None = None,
    ) -> Generator[Stage | Rounded, None, None]:
        """Yield the stage of the search for `rounded` several times a second, finally its answer.

        Closing it ends the search.
        """
        part, design = self.part(row), self.dimensions[row]
        labels = self.problem.variants[self.variants[row]].labels if self.variants else ()
        stay = []
        for name, label in zip(self.problem.choices, labels, strict=True):
            least = self.columns[key][row] if (key := sufficient_option_field(name)) in self.columns else label
            also = (
                f"; the smallest one that suffices for the given design is {least}" if least not in ("", label) else ""
            )
            stay.append(f"{name} stays {label}{also}")
        span = ranges_or_sizes(self.values, self.values[row], self._objective_targets)
        yield (yield from round_design(part, design, span, to, count=count, allow=allow, notes=stay))

    def rates(self, row: int) -> Array:
        """Return the trade-off rates (m, m) at a design: `[a, b]` is objective a's loss per unit gained in b.

        Rates are first order, in display units, along the cheapest direction that gains one unit of b. The cheapest
        direction has the least sum of losses, each scaled by its range over the front, and keeps the active
        constraints. Losses are zero or more. Column b is NaN where b cannot gain, where no design on the front is
        better in it, and for an amount that depends only on a choice.
        """
        self.part(row)  # raises an error for an unknown row
        owner, slopes = self.goals[row]
        m, k = len(self.objectives), slopes.shape[1]
        units = np.array([quantity.unit.factor for quantity in self._quantities])
        ranges = column_ranges(self.values, size=self._objective_targets)
        spans = units * np.where(ranges > 0.0, ranges, 1.0)
        left = self.values[row] - self.values.min(axis=0)
        slopes = slopes * (units / spans)[owner.astype(int)][:, None]
        residual, shares, pushes = optimality_multipliers(slopes, self.active[row]) if k else (np.inf, 0.0, 0.0)
        if residual <= STATIONARY:
            # Along the remaining slopes, all objectives would gain slightly without limit, so the design counts as
            # exactly stationary.
            slopes = slopes - (shares @ slopes + pushes @ self.active[row])
        rates = np.full((m, m), np.nan)
        for b in range(m):
            gains = k and left[b] > _NOTHING * ranges[b] and (owner == b).any()
            losses = _losses_of_cheapest_gain(slopes, owner, self.active[row], b, m) if gains else None
            if losses is not None:
                rates[:, b] = np.where(losses > _NOTHING, losses, 0.0) * spans / spans[b]
                rates[b, b] = np.nan
        return rates

    def trade_offs(self, row: int, system: System = "metric") -> list[str]:
        """Describe the trade-off rates at a design: "1 deg more transmission angle costs 0.8 N m ...".

        Steps and costs stay within the front: no gain beyond its best design, and no loss beyond its worst. The text
        says if an objective has nothing left to gain; an objective that is equal in all designs is omitted. system:
        system of the display units.
        """
        require_word("system", system, System)
        rates, ranges = self.rates(row), column_ranges(self.values, size=self._objective_targets)
        units = np.array([quantity.unit.factor for quantity in self._quantities])
        better = (self.values[row] - self.values.min(axis=0)) * units
        worse = (self.values.max(axis=0) - self.values[row]) * units
        sentences = []
        for b, gain in enumerate(self.objectives):
            payers = [a for a in range(len(self.objectives)) if rates[a, b] > 0.0]
            span = ranges[b] * units[b]
            if span == 0.0:
                continue
            if better[b] <= _NOTHING * span:
                sentences.append(self._nothing_to_gain_text(gain))
            elif payers:
                largest = min(0.1 * span, better[b], *(worse[a] / rates[a, b] for a in payers))
                if largest > _LEAST * span:
                    factor = self._display_unit(gain, system)[1]
                    step = 10.0 ** np.floor(np.log10(largest * factor)) / factor  # round in the display unit
                    costs = [
                        self._change_text(self.objectives[a], step * rates[a, b], system, gain=False)
                        for a in payers
                        if step * rates[a, b] > _LEAST * ranges[a] * units[a]
                    ]
                    cost = " and ".join(costs) or "almost nothing"
                    sentences.append(f"{self._change_text(gain, step, system, gain=True)} costs {cost}")
        return sentences

    def _nothing_to_gain_text(self, objective: Objective) -> str:
        """Say that no design on the front is better in an objective."""
        title = self.problem.quantity(objective.quantity).title
        if objective.sense == "target":
            return f"no design on the front is nearer to the target of {title}"
        return f"no design on the front has {'more' if objective.sense == 'maximise' else 'less'} {title}"

    def _display_unit(self, objective: Objective, system: System) -> tuple[str, float]:
        """Return an objective's display unit in a unit system, and its metric unit expressed in that unit."""
        return metric_unit_in(self.problem.quantity(objective.quantity).unit.symbol, system)

    def _change_text(self, objective: Objective, amount: float, system: System, *, gain: bool) -> str:
        """Describe a change in an objective; the change is given in the metric unit."""
        quantity = self.problem.quantity(objective.quantity)
        unit, factor = self._display_unit(objective, system)
        size = f"{np.format_float_positional(float(f'{amount * factor:.3g}'), trim='-')} {unit}".strip()
        if objective.sense == "target":
            return f"{quantity.title} {size} {'nearer to' if gain else 'farther from'} its target"
        is_more = (objective.sense == "maximise") == gain
        return f"{size} {'more' if is_more else 'less'} {quantity.title}"


def _losses_of_cheapest_gain(slopes: Array, owner: Array, active: Array, b: int, m: int) -> Array | None:
    """Return the losses (m,) for the cheapest direction in which objective b gains one unit; None if there is none.

    Solves a linear programme, min c x subject to G x <= h with some x >= 0, by its optimality conditions with
    multipliers y:

        G x + s = h,   G' y + c = t,   c x + h y = 0,   s, y >= 0,   t >= 0 where x >= 0, else t = 0.
    """
    k = slopes.shape[1]
    pays = np.where(owner == b, 0.0, 1.0)[:, None] * (owner[:, None] == np.arange(m))
    rows = np.concatenate([np.column_stack([slopes, -pays]), np.pad(active, ((0, 0), (0, m)))])
    limits = np.concatenate([np.where(owner == b, -1.0, 0.0), np.zeros(len(active))])
    size = np.maximum(np.abs(rows).max(axis=1, initial=0.0), 1e-300)
    rows, limits = rows / size[:, None], limits / size
    cost = np.concatenate([np.zeros(k), np.ones(m)])
    # A move is the difference of two non-negative moves.
    r, split = len(rows), np.hstack([np.eye(k + m), -np.eye(k + m)[:, :k]])
    matrix = np.block(
        [
            [rows @ split, np.eye(r), np.zeros((r, r)), np.zeros((r, m))],
            [np.zeros((k + m, 2 * k + m + r)), rows.T, np.eye(k + m)[:, k:] * -1.0],
            [(cost @ split)[None], np.zeros((1, r)), limits[None], np.zeros((1, m))],
        ]
    )
    target = np.concatenate([limits, -cost, [0.0]])
    solution = nonnegative_least_squares(matrix, target)
    if solution is None or np.abs(matrix @ solution - target).max() > _UNMET:
        return None
    return solution[k : k + m]


def least_and_greatest_of_bounds(name: str, ends: object) -> tuple[float | None, float | None]:
    """Return the least and greatest value for a name, None if unbounded.

    Raises `InputError` unless `ends` is such a pair.
    """
    bounds = tuple(ends) if isinstance(ends, tuple | list) else ()
    if len(bounds) != 2 or not all(end is None or (is_number(end) and not math.isnan(end)) for end in bounds):
        raise InputError(
            f"bounds of {name} must be (least, greatest), numbers or None; got {ends!r}; for example, write (1.0, None)"
        )
    return bounds


def require_front(front: object, caller: str) -> None:
    """Raise `InputError` unless the argument is a front. caller: name of the function that was called."""
    if not isinstance(front, ParetoFront):
        raise InputError(f"{caller} needs a front; got {type(front).__name__}; solve(problem) returns one")
