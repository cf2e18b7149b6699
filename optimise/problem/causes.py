"""Causes that a quantity needs from its machines: without them it is not defined, or zero for every design."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.machine.mechanism import Mechanism
from ...objectives.quantity import Quantity


def undefined_because(quantity: Quantity, machines: Iterable[Mechanism]) -> str | None:
    """Return rule, value and remedy for a quantity that one of the machines does not define; None if all do.

    Nor is it defined where it only equals another quantity.
    """
    reasons = (quantity.lacks(m, "undefined") or quantity.lacks(m, "equal") for m in machines)
    return next(filter(None, reasons), None)


def zero_because(quantity: Quantity, machines: Iterable[Mechanism]) -> str | None:
    """Return rule, value and remedy for a quantity that is zero for all designs and machines; None otherwise."""
    reasons = [quantity.lacks(machine, "zero") for machine in machines]
    return reasons[0] if all(reasons) else None
