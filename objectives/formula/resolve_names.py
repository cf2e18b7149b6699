"""Names of quantities, or formulas, as accepted by Python functions and commands."""

from collections.abc import Collection, Mapping, Sequence

from ...model.linkage.dimensions import DIMENSIONS
from ...model.machine.mechanism import Mechanism
from ..quantity import Quantity
from ..registry import QUANTITIES, quantity
from .formulas import Ends, Formulas


def resolve_quantities(
    names: Sequence[str],
    mechanism: Mechanism,
    custom: Collection[Quantity] = (),
    *,
    ranges: Mapping[str, Ends] | None = None,
    turning: bool = True,
) -> list[Quantity]:
    """Return the quantities for names and formulas.

    custom: a problem's quantities besides the built-in ones. ranges: ranges of the dimensions; a formula that may
    divide by zero within them is refused. Without ranges, such a formula has no value where its divisor is zero.
    turning: whether the crank must rotate fully. Raises `InputError` with the closest names, or with the error in a
    formula.
    """
    formulas: Formulas | None = None
    quantities = []
    for name in names:
        if is_formula_or_number_name(name, mechanism, custom):
            formulas = formulas or Formulas(custom, mechanism, ranges, {}, turning=turning)
            quantities.append(formulas.quantity_of_text(name, f"the formula {' '.join(name[:60].split())}"))
        else:
            quantities.append(quantity(name, custom))
    return quantities


def is_formula_or_number_name(name: object, mechanism: Mechanism, custom: Collection[Quantity] = ()) -> bool:
    """Return whether a text is a formula, a dimension or a variable rather than the name of a quantity."""
    if not isinstance(name, str) or name in QUANTITIES or any(quantity.name == name for quantity in custom):
        return False
    return name in DIMENSIONS or any(item.name == name for item in mechanism.varying) or not name.isidentifier()
