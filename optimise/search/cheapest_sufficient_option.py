"""The least sufficient option of a catalogue for a design: the cheapest gearmotor that meets its demands."""

import numpy as np

from ...model.arrays import Array, IntArray, Mask, sorted_unique
from ...model.errors import InputError
from ...objectives.quantity import Quantity
from ..front.front import Columns
from ..problem.constraint_violation import FEASIBLE, constraints_with_floors, relative_violation
from ..problem.problem import Problem, Variant
from ..problem.table_columns import note_field, sufficient_amount_field, sufficient_option_field

_SAME = 1e-9  # relative tolerance for a dimension that an option sets


def cheapest_sufficient_options(problem: Problem, variants: IntArray, dimensions: Array) -> Columns:
    """Return the least option (n,) of each catalogue that meets all requirements, all else equal, and its row.

    variants: (n,), variant of each design. dimensions: (n, 3 + v). An option that changes other numbers of a design,
    such as a mass, may change its quantities; it must then meet every requirement.
    """
    columns: Columns = {}
    for place in problem.catalogues:
        name = problem.choices[place]
        least_variants: list[Variant | None] = [None] * len(dimensions)
        for variant in sorted_unique(variants).tolist():
            labels = problem.variants[variant].labels
            rows = np.flatnonzero(variants == variant)
            serving, left = _Serving(problem, dimensions[rows]), np.ones(len(rows), np.bool_)
            for option in sorted(
                _variants_with_another_option(problem, labels, place),
                key=lambda variant_found: variant_found.ranks[place],
            ):
                served = left if option.labels == labels else left & serving(option)
                for row in rows[served].tolist():
                    least_variants[row] = option
                left = left & ~served
                if not left.any():
                    break
        columns[sufficient_option_field(name)] = np.array(
            [variant_found.labels[place] if variant_found else "" for variant_found in least_variants]
        )
        for amount in problem.amounts(name):
            values = [
                dict(variant_found.amounts).get(amount.name, np.nan) if variant_found else np.nan
                for variant_found in least_variants
            ]
            columns[sufficient_amount_field(name, amount)] = amount.unit.factor * np.array(values)
        for head in problem.heads(name):
            columns[note_field(f"least {name}", head)] = np.array(
                [variant_found.note(name, head) if variant_found else "" for variant_found in least_variants]
            )
    return columns


def _variants_with_another_option(problem: Problem, labels: tuple[str, ...], place: int) -> list[Variant]:
    """Return the combinations that differ from `labels` at most in the choice at `place`."""

    def without_place(all_labels: tuple[str, ...]) -> tuple[str, ...]:
        return all_labels[:place] + all_labels[place + 1 :]

    return [variant for variant in problem.catalogue if without_place(variant.labels) == without_place(labels)]


class _Serving:
    """Designs that meet all requirements with another option; quantities that options share are computed once."""

    def __init__(self, problem: Problem, dimensions: Array) -> None:
        self.problem, self.dimensions = problem, dimensions
        self._known: dict[
            tuple[int, int], tuple[Quantity, Array]
        ] = {}  # stored with the quantity, so that its id is not reused

    def __call__(self, option: Variant) -> Mask:
        """Return the designs for which an option suffices."""
        designs = self.dimensions
        served = np.ones(len(designs), np.bool_)
        try:
            part = self.problem.with_variant(option)
        except InputError:  # its limits exclude every design
            return ~served
        for column, ends in enumerate((option.crank, option.rod, option.offset)):
            tolerance = _SAME * max(abs(ends.lower), abs(ends.upper))
            served &= (designs[:, column] >= ends.lower - tolerance) & (designs[:, column] <= ends.upper + tolerance)
        side = part.slow_side()
        if side is not None:
            served &= side * designs[:, 2] > 0.0
        for constraint in constraints_with_floors(part):
            quantity = part.quantity(constraint.quantity)
            key = id(option.mechanism), id(quantity)
            if key not in self._known:
                self._known[key] = quantity, quantity.evaluate(part.mechanism, designs).values
            served &= relative_violation(constraint, self._known[key][1]) <= FEASIBLE
        return served
