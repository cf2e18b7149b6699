"""Formulas over the columns of stored designs, for conditions and sorting."""

import math
import re
from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from ...model.errors import InputError
from ...objectives.formula.dimensional_analysis import kind_of_formula
from ...objectives.formula.expression import Name, Node, Slopes, evaluate_in_algebra, formula_text, names_in
from ...objectives.formula.formulas import Units
from ...objectives.formula.parser import parse
from ...objectives.formula.quantity import column_key_of_formula
from ...objectives.kinds import Kind, name_unit_and_factor_of_key
from ...objectives.quantity import Array, Values
from ...objectives.units import kind_of_any_unit
from ..runs.result import Row
from .columns import Column, find_column


@dataclass(frozen=True)
class RowFormula:
    """Formula over columns. node: parsed formula. columns: columns of its names. kind: kind of its value."""

    text: str
    node: Node
    columns: tuple[tuple[str, Column], ...]
    kind: Kind

    def evaluate(self, row: Row) -> float:
        """Return its value at a design, SI; NaN if undefined, for example by a division by zero."""
        leaves = {name: Values(_si_values(row, column), None) for name, column in self.columns}
        with np.errstate(all="ignore"):
            value = float(evaluate_in_algebra(self.node, Slopes(leaves, 1, 0, False)).values[0])
        endless = any(np.isinf(leaf.values[0]) for leaf in leaves.values())
        return value if endless or not math.isinf(value) else math.nan


def find_formula(text: str, keys: Collection[str]) -> Column | RowFormula:
    """Return the existing column that a formula names, or the formula to compute.

    Raises `InputError`, with rule, value and remedy, for an invalid formula and for names that are not columns.
    """
    node = parse(text, Units(frozenset(name_unit_and_factor_of_key(key)[0] for key in keys)))
    written = formula_text(node)
    for key in keys:
        if name_unit_and_factor_of_key(key)[0] == column_key_of_formula(written) or key == column_key_of_formula(
            written
        ):
            stored_column = find_column(key, keys)
            # It was referred to without its unit.
            return replace(stored_column, plain=None if stored_column.unit else 1.0)
    columns = {name: _column_of_name(name, keys) for name in names_in(node)}
    if not columns:
        raise InputError(
            f"a formula must contain a quantity or a column; got {written}, which is the same for every design; write "
            'it like "offset - crank"'
        )
    if isinstance(node, Name):
        return columns[node.name]
    kinds = {name: kind_of_any_unit(column.unit) for name, column in columns.items()}
    return RowFormula(written, node, tuple(columns.items()), kind_of_formula(node, kinds))


def _column_of_name(name: str, keys: Collection[str]) -> Column:
    """Return the column for a name in a formula; an extra variable may also be named by its path."""
    if "." not in name:
        return find_column(name, keys)
    plain = re.sub("[^a-z0-9]+", "_", name.removeprefix("mechanism.").lower()).strip("_")
    if plain not in {name_unit_and_factor_of_key(key)[0] for key in keys}:
        raise InputError(f"there is no column {name!r}: only variables have one; leave it out")
    return find_column(plain, keys)


def _si_values(row: Row, column: Column) -> Array:
    cell = row[column.key]
    if isinstance(cell, str):
        raise InputError(f"a formula may only contain numbers; got {column.key}, a column of words; leave it out")
    return np.array([math.nan if cell is None else float(cell) / column.factor])
