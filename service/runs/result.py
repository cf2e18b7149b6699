"""Result of a run, in the form that tables, CSV and JSON share."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ...model.errors import InfeasibleError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...model.arrays import Array
    from ...optimise.front.front import ParetoFront
    from ...optimise.problem.problem import Problem

Cell = float | str | None
Row = dict[str, Cell]
_FORMULA = ("=", "+", "-", "@", "\t", "\r")  # start of a cell that spreadsheets evaluate (OWASP, CSV injection)


@dataclass(frozen=True, kw_only=True)
class StoredObjective:
    """Objective. column: its key in the designs. target: in `unit`, if the sense is "target"."""

    quantity: str
    sense: str
    column: str
    title: str
    unit: str
    target: float | None = None

    def minimised_value(self, row: Row) -> float:
        """Return a number that is smaller for a better design."""
        value = row[self.column]
        if not isinstance(value, float | int) or math.isnan(value):
            return math.inf
        if self.target is not None:
            return abs(value - self.target)
        return -value if self.sense == "maximise" else value


@dataclass(frozen=True)
class ExactDesigns:
    """Designs of a front as the search left them: dimensions and derivatives, SI; fields as in `ParetoFront`.

    dimensions: (n, 3 + v). variants: (n,), empty if there are no choices. goals: for each design, objective index (p,)
    and gradient (p, f) of every active piece. active: gradients (a, f) of its active constraints.
    """

    dimensions: Array
    variants: tuple[int, ...]
    goals: tuple[tuple[Array, Array], ...]
    active: tuple[Array, ...]

    def __post_init__(self) -> None:
        """Raise ValueError if the parts differ in length."""
        count = len(self.dimensions)
        if not count == len(self.goals) == len(self.active) or len(self.variants) not in (0, count):
            raise ValueError(f"dimensions of {count} designs, slopes of {len(self.goals)}, {len(self.active)}")

    def select(self, rows: Sequence[int]) -> ExactDesigns:
        """Return the data of selected designs, in the given order."""
        return ExactDesigns(
            self.dimensions[list(rows)],
            tuple(self.variants[row] for row in rows) if self.variants else (),
            tuple(self.goals[row] for row in rows),
            tuple(self.active[row] for row in rows),
        )


@dataclass(frozen=True, kw_only=True)
class Result:
    """Result of a run.

    run: its folder. status: "done", "cancelled" or "infeasible". designs: best in the first objective first.
    extremes: position in `designs` of the best design in each objective. knee: position of the knee; None without
    designs. trade_offs: trade-offs at the knee, in words. warnings: warnings about possibly unintended input. violated:
    per column, the excess of each design over an allowable value, zero if it is met. exact: the designs as the search
    left them; None for a run read from its files or from a store of an early version. discrete: how designs with
    discrete values were found, see `discrete_record`; None if there are no such values.
    """

    run: str
    name: str
    status: str
    message: str
    objectives: tuple[StoredObjective, ...]
    designs: list[Row]
    hypervolume: float
    evaluations: int
    seconds: float
    seed: int
    extremes: dict[str, int]
    knee: int | None
    trade_offs: list[str]
    warnings: tuple[str, ...] = ()
    violated: Mapping[str, Sequence[float]] = field(default_factory=dict)
    discrete: Mapping[str, Any] | None = None
    exact: ExactDesigns | None = field(default=None, repr=False, compare=False)

    @property
    def strokes_differ(self) -> bool:
        """Whether one stroke of a design carries more load than the other, so that the slow stroke matters."""
        return any(row.get("loaded_stroke", "equal") != "equal" for row in self.designs)

    def record(self, columns: Sequence[str] | None = None) -> dict[str, Any]:
        """Return the result for JSON: null for undefined values, "inf" and "-inf" for infinite ones.

        columns: columns of the designs; None for all.
        """
        left_out = ("exact",) if self.discrete else ("exact", "discrete")
        fields = {name: json_ready(value) for name, value in vars(self).items() if name not in left_out}
        if columns is not None:
            fields["designs"] = [{name: row[name] for name in columns} for row in fields["designs"]]
        objectives = [objective_record(objectives) for objectives in self.objectives]
        return fields | {"objectives": objectives, "strokes_differ": self.strokes_differ}


def stored_objectives(problem: Problem) -> list[StoredObjective]:
    """Return the objectives of a problem, in display units."""
    objectives = []
    for objective in problem.objectives:
        quantity = problem.quantity(objective.quantity)
        target = None if objective.target is None else objective.target * quantity.unit.factor
        names = {
            "quantity": quantity.name,
            "column": quantity.field,
            "title": quantity.title,
            "unit": quantity.unit.symbol,
        }
        objectives.append(StoredObjective(**names, sense=objective.sense, target=target))
    return objectives


def result_of(front: ParetoFront, run: str) -> Result:
    """Return the result of a run from its front."""
    from ...optimise.problem.contradictory_problems import idle_constraint_warnings
    from ...optimise.search.driving_load_warnings import front_driving_load_warnings
    from ...optimise.search.stroke_warnings import front_stroke_warnings

    has_designs = len(front) > 0
    several = has_designs and len(front.objectives) > 1
    return Result(
        run=run,
        name=front.problem.name,
        status=front.status,
        message=front.message,
        objectives=tuple(stored_objectives(front.problem)),
        designs=rows_of_columns(front.columns),
        hypervolume=float(front.hypervolume),
        evaluations=int(front.evaluations),
        seconds=float(front.seconds),
        seed=int(front.seed),
        extremes={name: int(row) for name, row in front.extremes().items()} if has_designs else {},
        knee=int(front.knee()) if has_designs else None,
        trade_offs=front.trade_offs(front.knee()) if several else [],
        warnings=(
            *front.problem.warnings,
            *front_driving_load_warnings(front),
            *front_stroke_warnings(front),
            *idle_constraint_warnings(front.problem),
        ),
        violated=_violated_columns(front),
        discrete=discrete_record(front),
        exact=ExactDesigns(front.dimensions, front.variants, front.goals, front.active),
    )


def _violated_columns(front: ParetoFront) -> dict[str, list[float]]:
    """Return the excess of designs over allowable values, by column."""
    excess_by_quantity = ((front.problem.quantity(name), excess) for name, excess in front.violated.items())
    return {
        quantity.field: [quantity.unit.factor * float(amount) for amount in excess]
        for quantity, excess in excess_by_quantity
    }


def infeasible_result(error: InfeasibleError, run: str = "") -> Result:
    """Return the result for an input known to be infeasible before a search. run: its folder, "" if none."""
    from ...optimise.problem.problem import Problem

    problem = error.problem if isinstance(error.problem, Problem) else None
    return Result(
        run=run,
        name="" if problem is None else problem.name,
        status="infeasible",
        message=str(error),
        objectives=() if problem is None else tuple(stored_objectives(problem)),
        designs=[],
        hypervolume=0.0,
        evaluations=0,
        seconds=0.0,
        seed=0 if problem is None else int(problem.settings.seed),
        extremes={},
        knee=None,
        trade_offs=[],
    )


def discrete_record(front: ParetoFront) -> dict[str, Any] | None:
    """Return how designs with discrete values were found, and the best of each objective with continuous values."""
    summary = front.discrete
    if summary is None:
        return None
    best: dict[str, float] = {}
    for objective, value in zip(front.objectives, summary.continuous, strict=False):
        quantity = front.problem.quantity(objective.quantity)
        best_value = -value if objective.sense == "maximise" else value
        best[f"off_target_{quantity.field}" if objective.sense == "target" else quantity.field] = (
            best_value * quantity.unit.factor
        )
    return {
        "how": summary.extent_text,
        "combinations": summary.combinations,
        "judged": summary.judged,
        "values": dict(summary.rules),
        "continuous_best": best,
    }


def rows_of_columns(columns: Mapping[Any, Sequence[Any] | NDArray[Any]]) -> list[Row]:
    """Return the rows of a table given by columns, with plain Python numbers and strings."""
    keys = [str(key) for key in columns]
    cells = zip(*columns.values(), strict=True)
    return [dict(zip(keys, map(_cell_of, row), strict=True)) for row in cells]


def _cell_of(value: Any) -> Cell:
    if value is None or isinstance(value, str):
        return None if value is None else str(value)
    return float(value)


def objective_record(objective: StoredObjective) -> dict[str, Any]:
    """Return an objective as in JSON."""
    return {name: value for name, value in vars(objective).items() if value is not None}


def json_ready(value: Any, *, gaps: bool = False) -> Any:
    """Convert a value to JSON: None for undefined numbers, "inf" and "-inf" for infinities.

    CSV files use the same words. gaps: None for infinities too, for drawings.
    """
    if isinstance(value, float):
        if math.isfinite(value):
            return value
        return None if gaps or math.isnan(value) else repr(value)
    if isinstance(value, Mapping):
        return {key: json_ready(item, gaps=gaps) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [json_ready(item, gaps=gaps) for item in value]
    return value


def row_from_json(row: Mapping[str, Any]) -> Row:
    """Return a design from `json_ready` with its infinite numbers restored; words of choices stay words."""
    return {
        key: float(cell) if cell in ("inf", "-inf") and not key.startswith("choice_") else cell
        for key, cell in row.items()
    }


def json_text(value: Any) -> str:
    """Return strict JSON with numbers at full precision; in ASCII, so that no terminal garbles it."""
    return json.dumps(json_ready(value), indent=2, allow_nan=False) + "\n"


def curves_csv(rows: Iterable[Row]) -> str:
    """Return curves as CSV; see `csv_text`. Fourteen digits hide the rounding errors of angles such as 3 deg."""
    return csv_text(
        {key: float(f"{cell:.14g}") if isinstance(cell, float) else cell for key, cell in row.items()} for row in rows
    )


def csv_text(rows: Iterable[Row], *, spreadsheet: bool = False) -> str:
    """Return the rows as CSV (RFC 4180 with plain line ends): JSON keys as header, numbers at full precision.

    Infinity is written as inf; undefined values stay empty. spreadsheet: put an apostrophe before text that a
    spreadsheet would read as a formula; such a cell cannot be read back unchanged.
    """
    rows = list(rows)
    out = io.StringIO()
    if rows:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow([_text_without_formula(key) for key in rows[0]] if spreadsheet else rows[0])
        for row in rows:
            # The writer writes every number as repr does, and None as nothing; only NaN differs from itself.
            cells = ["" if cell != cell else cell for cell in row.values()]
            if spreadsheet:
                cells = [_text_without_formula(cell) if isinstance(cell, str) else cell for cell in cells]
            writer.writerow(cells)
    return out.getvalue()


def _text_without_formula(text: str) -> str:
    return f"'{text}" if text.startswith(_FORMULA) else text


def rows_from_csv(text: str) -> list[Row]:
    """Return the rows that `csv_text` wrote. Raises ValueError if lines differ in length."""
    lines = list(csv.reader(io.StringIO(text), strict=True))
    if not lines:
        return []
    header, *body = lines
    return [{key: _read_cell(cell) for key, cell in zip(header, line, strict=True)} for line in body]


def _read_cell(text: str) -> Cell:
    try:
        return float(text) if text else math.nan
    except ValueError:
        return text
