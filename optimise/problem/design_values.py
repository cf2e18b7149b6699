"""Quantities of designs by name: of a machine alone, or with those that a problem adds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, overload

from numpy.typing import ArrayLike

from ...model.errors import InputError
from ...model.machine.mechanism import Mechanism
from ...objectives.quantity import Array, Quantity
from ...objectives.registry import quantity
from ...objectives.tables.evaluate import evaluate_quantities
from .causes import undefined_because


@overload
def evaluate(
    mechanism: Mechanism,
    designs: ArrayLike,
    quantities: Sequence[str],
    *,
    gradients: Literal[False] = False,
    own: Sequence[Quantity] = (),
) -> Array: ...
@overload
def evaluate(
    mechanism: Mechanism,
    designs: ArrayLike,
    quantities: Sequence[str],
    *,
    gradients: Literal[True],
    own: Sequence[Quantity] = (),
) -> tuple[Array, Array]: ...
def evaluate(
    mechanism: Mechanism,
    designs: ArrayLike,
    quantities: Sequence[str],
    *,
    gradients: bool = False,
    own: Sequence[Quantity] = (),
) -> Array | tuple[Array, Array]:
    """Return quantities (n, q) of designs (n, 3 + k), SI; with `gradients` the Jacobian too.

    A design is crank, rod, offset, m, and the values of the machine's k varying numbers. Any number of axes may come
    before the last: one design (3 + k,) gives (q,). quantities: names as in job files. own: quantities that may be
    named besides those of the product.

    The row of a design that does not turn fully, or that has NaN in it, is NaN. Where friction locks the linkage, what
    follows from forces is infinite. Raises `InputError` for an unknown name, for a quantity that the machine does not
    define (a position error without tolerances), and for the gradient of a function that has none.

    >>> from slidercrank import Mechanism, evaluate
    >>> evaluate(Mechanism(), [[0.04, 0.1, 0.02], [0.08, 0.1, 0.03]], ["stroke", "time_ratio"]).round(4)
    array([[0.082 , 1.1334],
           [   nan,    nan]])
    """
    if isinstance(quantities, str):
        raise InputError(f"quantities are a list of names; got {quantities!r}; write [{quantities!r}]")
    chosen = [quantity(name, own) for name in quantities]
    for item in chosen:
        reason = undefined_because(item, [mechanism])
        if reason:
            raise InputError(f"{item.name}: {reason}")
    values, jacobian = evaluate_quantities(mechanism, chosen, designs, gradients=gradients)
    return values if jacobian is None else (values, jacobian)
