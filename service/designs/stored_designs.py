"""Designs of a stored front as machines and linkages."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ...model.errors import RunError
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.machine.varying_numbers import Varying
from ...objectives.tables.design_input import column_of_variable
from ...optimise.front.front import ParetoFront
from ...optimise.problem.problem import Problem, Variant
from ...optimise.problem.requirements import Range
from ...optimise.problem.table_columns import choice_field
from ..runs.result import Cell, ExactDesigns, Result, Row

_MILLIMETRES = {"crank_mm": 1e3, "rod_mm": 1e3, "offset_mm": 1e3}


@dataclass(frozen=True)
class StoredDesign:
    """Design of a stored front. values: crank, rod, offset, m, and each extra variable, SI.

    part: problem that it solves, with its choices applied. variant: index of these choices, counted from 0. allowed:
    deviations from requirements that somebody allows for it, by column.
    """

    part: Problem
    values: tuple[float, ...]
    variant: int = 0
    allowed: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def mechanism(self) -> Mechanism:
        """Machine with the extra variables of the design."""
        return self.part.mechanism.with_values(self.values[3:])

    @cached_property
    def linkage(self) -> Linkage:
        """Linkage on the branch of the machine."""
        crank, rod, offset = self.values[:3]
        return Linkage(crank, rod, offset, self.mechanism.branch)


def design_of_row(problem: Problem, row: Row) -> StoredDesign:
    """Return a design from its row in the table of a problem's front; its displayed dimensions are unchanged.

    Raises `RunError` for a row that does not belong to the problem.
    """
    values = _variable_values(row, _variable_factors(problem.mechanism))
    variant = _matching_variant(problem, row, values)
    return StoredDesign(problem.part(variant), values, variant)


def stored_design(problem: Problem, result: Result, number: int) -> StoredDesign:
    """Return a design of a result by its number from 1: exact if stored so, otherwise as by `design_of_row`."""
    if result.exact is None:
        return design_of_row(problem, result.designs[number - 1])
    variants, values = result.exact.variants, tuple(result.exact.dimensions[number - 1].tolist())
    variant = variants[number - 1] if variants else 0
    return StoredDesign(problem.part(variant), values, variant)


def front_of_result(problem: Problem, result: Result) -> ParetoFront:
    """Return a stored front with its problem; without `Result.exact`, the derivatives at the designs are unknown."""
    from .design_selection_options import minimised_values

    rows = [{name: math.nan if cell is None else cell for name, cell in row.items()} for row in result.designs]
    exact = result.exact or _reconstruct_designs(problem, result.designs)
    factors = np.array([problem.quantity(objective.quantity).unit.factor for objective in result.objectives])
    return ParetoFront(
        problem=problem,
        status="done" if rows else "infeasible",
        message=result.message,
        columns={name: np.array([row[name] for row in rows]) for name in (rows[0] if rows else ())},
        dimensions=exact.dimensions,
        values=minimised_values(result) / factors,
        goals=exact.goals,
        active=exact.active,
        hypervolume=result.hypervolume,
        history=(),
        evaluations=result.evaluations,
        seconds=result.seconds,
        seed=result.seed,
        variants=exact.variants,
    )


def _reconstruct_designs(problem: Problem, rows: Sequence[Row]) -> ExactDesigns:
    """Reconstruct the designs from their displayed rows: everything except derivatives, which stay empty."""
    sizes = _variable_factors(problem.mechanism)
    dimensions = [_variable_values(row, sizes) for row in rows]
    variants = [_matching_variant(problem, *row_and_values) for row_and_values in zip(rows, dimensions, strict=True)]
    nothing = np.zeros((0, 0))
    return ExactDesigns(
        np.array(dimensions).reshape(len(dimensions), len(sizes)),
        tuple(variants) if problem.variants else (),
        ((np.zeros(0), nothing),) * len(rows),
        (nothing,) * len(rows),
    )


def _matching_variant(problem: Problem, row: Row, values: Sequence[float]) -> int:
    """Return the index of the variant with a design's labels; if several match, the one with the nearest ranges."""
    if not problem.variants:
        return 0
    labels = tuple(_cell_of_column(row, choice_field(name)) for name in problem.choices)
    matching = [index for index, variant in enumerate(problem.variants) if variant.labels == labels]
    if not matching:
        raise _foreign_run_error(f"its job has nothing called {' with '.join(map(str, labels))}")
    return min(matching, key=lambda index: _distance_outside(problem.variants[index], values))


def _distance_outside(variant: Variant, values: Sequence[float]) -> float:
    """Return how far values lie outside the ranges of a variant, as a fraction of each range."""
    ranges: tuple[Range | Varying, ...] = (variant.crank, variant.rod, variant.offset, *variant.mechanism.varying)
    return max(
        max(bounds.lower - value, value - bounds.upper, 0.0) / max(abs(bounds.lower), abs(bounds.upper), 1e-300)
        for bounds, value in zip(ranges, values, strict=True)
    )


def _variable_factors(mechanism: Mechanism) -> dict[str, float]:
    """Return the columns of a design's variables, each with the factor from SI to its unit."""
    varying = (column_of_variable(item) for item in mechanism.varying)
    return {**_MILLIMETRES, **{key: unit.factor for key, unit in varying}}


def _variable_values(row: Row, factors: Mapping[str, float]) -> tuple[float, ...]:
    return tuple(_si_value(row, key, factor) for key, factor in factors.items())


def _si_value(row: Row, key: str, factor: float) -> float:
    """Return the number whose product with the factor is exactly the displayed value."""
    displayed = _cell_of_column(row, key)
    if not isinstance(displayed, float) or not math.isfinite(displayed):
        raise _foreign_run_error(f"its {key} is {displayed}")
    value = displayed / factor
    near = (value, math.nextafter(value, -math.inf), math.nextafter(value, math.inf))
    return next((item for item in near if factor * item == displayed), value)


def _cell_of_column(row: Mapping[str, Cell], key: str) -> Cell:
    if key not in row:
        raise _foreign_run_error(f"it has no column {key}")
    return row[key]


def _foreign_run_error(why: str) -> RunError:
    return RunError(f"a stored design must match its job; {why}; run the job again")
