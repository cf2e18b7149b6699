"""A formula as a quantity: composed from the values, gradients and pieces of the quantities that it names."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ...model.linkage.dimensions import DIMENSIONS
from ...model.machine.mechanism import Mechanism
from ...model.machine.raw_numbers_of_designs import require_design_columns
from ...model.machine.varying_numbers import Varying, number_at_path
from ..machine_needs import Consequence
from ..quantity import Array, Pieces, Quantity, Values
from .expression import (
    Call,
    Linear,
    Name,
    Node,
    Slopes,
    evaluate_in_algebra,
    linear_form_of_node,
    linear_form_of_unknown,
)
from .kinks import Kinks, TwoSided, pieces_from_above_and_below, pieces_of_formula, single_smooth_piece

_GOLDEN = 0.6180339887498949  # parts' labels are added with incommensurate factors, so that they hardly ever coincide
_LONGEST_KEY = 60
_WORDS = {"+": "plus", "-": "minus", "*": "times", "/": "per", "**": "to_the"}


@dataclass(frozen=True, kw_only=True)
class FormulaQuantity(Quantity):
    """A formula as a quantity. name: its text, or its name in the job.

    expression: the formula. parts: quantities that it names. dimensions: its names among crank, rod and offset.
    varying: other numbers that it names; one that does not vary has the machine's value. signs: 1 for dimensions and
    numbers that are never negative within the problem's ranges, -1 for those that are never positive.
    """

    expression: Node
    parts: tuple[Quantity, ...] = ()
    dimensions: tuple[str, ...] = ()
    varying: tuple[Varying, ...] = ()
    signs: tuple[tuple[str, int], ...] = ()

    @property
    def has_gradient(self) -> bool:
        """Whether all its parts are differentiable."""
        return all(part.has_gradient for part in self.parts)

    @property
    def has_signed_offset(self) -> bool:
        """Whether it depends on the offset other than through abs(offset)."""

        def bare(node: Node) -> bool:
            if isinstance(node, Call):
                inner = node.arguments[0]
                sized = node.function == "abs" and isinstance(inner, Name) and inner.name == "offset"
                return not sized and any(map(bare, node.arguments))
            return isinstance(node, Name) and node.name == "offset"

        return bare(self.expression)

    @property
    def depends_only_on_dimensions(self) -> bool:
        """Whether it depends on crank, rod and offset alone."""
        return all(part.depends_only_on_dimensions for part in self.parts) and not self.varying

    @property
    def is_constant(self) -> bool:
        """Whether it is the same for all designs of one machine: it contains only numbers and amounts."""
        return all(part.is_constant for part in self.parts) and not self.dimensions and not self.varying

    @property
    def component_quantities(self) -> tuple[Quantity, ...]:
        """The quantities that it names."""
        return self.parts

    def with_parts(self, parts: tuple[Quantity, ...]) -> FormulaQuantity:
        """Return the formula with its parts replaced by others with the same names."""
        return replace(self, parts=parts)

    def unmet_need(self, mechanism: Mechanism, without: Consequence) -> str | None:
        """Return why a machine does not define it: a part's unmet need; None if all needs are met."""
        if without == "zero":  # even if a part is zero, other terms may remain
            return None
        reasons = ((part.name, part.unmet_need(mechanism, without)) for part in self.parts)
        return next((f"{name}: {reason}" for name, reason in reasons if reason), None)

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the formula for designs (n, 3 + k); see `Quantity`."""
        require_design_columns(mechanism, dimensions)
        part_values = {part.name: part.evaluate(mechanism, dimensions, gradients=gradients) for part in self.parts}
        return self.combine_parts(part_values, mechanism, dimensions, gradients=gradients)

    def combine_parts(
        self, part_values: Mapping[str, Values], mechanism: Mechanism, dimensions: Array, *, gradients: bool = False
    ) -> Values:
        """Return the formula for designs (n, 3 + k).

        part_values: values of its parts by name, including gradients if these are requested.
        """
        n, d = dimensions.shape
        leaves = dict(part_values)
        for name, values, place in self._values_of_numbers(mechanism, dimensions):
            leaves[name] = Values(values, _unit_gradient(n, d, place) if gradients else None)
        with np.errstate(all="ignore"):
            return evaluate_in_algebra(self.expression, Slopes(leaves, n, d, gradients))

    @property
    def is_smooth(self) -> bool:
        """Whether it has no kinks: its parts are smooth, and abs() applies only to an offset with known sign."""

        def has_kink(node: Node) -> bool:
            if not isinstance(node, Call):
                return False
            if node.function == "abs" and node.arguments[0] == Name("offset"):
                return dict(self.signs).get("offset", 0) == 0
            return node.function in ("abs", "min", "max") or any(map(has_kink, node.arguments))

        return not has_kink(self.expression) and all(
            part.is_smooth if isinstance(part, FormulaQuantity) else type(part).pieces is Quantity.pieces
            for part in self.parts
        )

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the formula as the maximum of smooth pieces; see `Quantity`."""
        if self.is_smooth:
            return super().pieces(mechanism, dimensions)
        require_design_columns(mechanism, dimensions)
        n, d = dimensions.shape
        leaves: dict[str, TwoSided] = {}
        for place, part in enumerate(self.parts):
            leaves[part.name] = pieces_from_above_and_below(
                part.pieces(mechanism, dimensions), 1.0 + _GOLDEN * place, 0 if part.signed else 1
            )
        for name, values, column in self._values_of_numbers(mechanism, dimensions):
            piece = single_smooth_piece(values, _unit_gradient(n, d, column))
            leaves[name] = TwoSided(piece, piece, dict(self.signs).get(name, 0))
        with np.errstate(all="ignore"):
            return pieces_of_formula(evaluate_in_algebra(self.expression, Kinks(leaves, n, d)))

    def _values_of_numbers(self, mechanism: Mechanism, designs: Array) -> Iterator[tuple[str, Array, int | None]]:
        """Yield the name, values (n,) and column of each dimension and variable; a fixed number has no column."""
        for name in self.dimensions:
            place = DIMENSIONS.index(name)
            yield name, designs[:, place].astype(np.float64), place
        places = {item.name: 3 + place for place, item in enumerate(mechanism.varying)}
        for item in self.varying:
            if item.name in places:
                place = places[item.name]
                yield item.name, designs[:, place].astype(np.float64), place
            else:
                path, factor = item.sets[0]
                number = number_at_path(mechanism, path)
                yield item.name, np.full(len(designs), math.nan if number is None else number / factor), None


def _unit_gradient(n: int, d: int, place: int | None) -> Array:
    return np.tile(np.arange(d) == place, (n, 1)).astype(np.float64)


def linear_equation_of(formula: FormulaQuantity, value: float) -> Linear | None:
    """Return the linear equation that sets a formula equal to a value.

    None if the formula is not linear in dimensions and numbers.

    A quotient of two linear formulas gives one, too.
    """
    definitions, node = _linear_forms_by_name(formula), formula.expression
    if isinstance(node, Call) and node.function == "/":
        numerator, denominator = (linear_form_of_node(item, definitions) for item in node.arguments)
        return (
            None
            if numerator is None or denominator is None
            else numerator.plus_multiple_of(denominator, -Fraction(value))
        )
    equation = linear_form_of_node(node, definitions)
    return None if equation is None else equation.plus_multiple_of(Linear((), Fraction(value)), Fraction(-1))


def _linear_forms_by_name(formula: FormulaQuantity) -> dict[str, Linear | None]:
    """Return the linear formulas that a formula names, by name."""
    definitions: dict[str, Linear | None] = {name: linear_form_of_unknown(name) for name in formula.dimensions}
    definitions |= {item.name: linear_form_of_unknown(item.name) for item in formula.varying}
    for part in formula.parts:
        if isinstance(part, FormulaQuantity):
            definitions[part.name] = linear_form_of_node(part.expression, _linear_forms_by_name(part))
    return definitions


def linear_form(formula: FormulaQuantity) -> Linear | None:
    """Return a formula as linear in dimensions, numbers and the quantities that it names; None if it is not linear."""
    definitions = _linear_forms_by_name(formula)
    for part in formula.parts:
        definitions[part.name] = (
            linear_form(part) if isinstance(part, FormulaQuantity) else linear_form_of_unknown(part.name)
        )
    return linear_form_of_node(formula.expression, definitions)


def basic_quantities(quantities: Iterable[Quantity]) -> tuple[Quantity, ...]:
    """Return the basic quantities: the quantities themselves, or the parts of formulas, without repetition."""

    def leaf_items(quantities: Iterable[Quantity]) -> Iterator[tuple[str, Quantity]]:
        for item in quantities:
            if isinstance(item, FormulaQuantity):
                yield from leaf_items(item.parts)
            else:
                yield item.name, item

    return tuple(dict(leaf_items(quantities)).values())


def values_with_formulas(
    quantities: Sequence[Quantity],
    leaf_values: Mapping[str, Values],
    mechanism: Mechanism,
    dimensions: Array,
    *,
    gradients: bool = False,
) -> list[Values]:
    """Return the values of quantities, combined as formulas require.

    leaf_values: values of the `basic_quantities`, by name.
    """
    values = dict(leaf_values)

    def value(item: Quantity) -> Values:
        if item.name not in values and isinstance(item, FormulaQuantity):
            part_values = {part.name: value(part) for part in item.parts}
            values[item.name] = item.combine_parts(part_values, mechanism, dimensions, gradients=gradients)
        return values[item.name]

    return [value(item) for item in quantities]


def column_key_of_formula(text: str) -> str:
    """Return the first part of a formula's column name: "offset_minus_crank"."""
    spaced = re.sub(r"\*\*|(?<=[\w)]) [-+*/] (?=.)", lambda sign: f" {_WORDS[sign[0].strip()]} ", text)
    key = re.sub("[^a-z0-9]+", "_", spaced.lower().replace("-", " minus ")).strip("_")
    plain = not re.search(r"\(|[A-Za-z_]\w*\.", text) and len(key) <= _LONGEST_KEY
    if not plain:  # different formulas may give the same text
        from hashlib import blake2b

        key = f"{key[:_LONGEST_KEY].rstrip('_')}_{blake2b(text.encode(), digest_size=3).hexdigest()}"
    return key if key[:1].isalpha() else f"formula_{key}"
