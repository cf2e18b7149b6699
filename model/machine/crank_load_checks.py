"""Checks for analyses that do not support loads on the crank."""

from __future__ import annotations

from ..errors import InputError
from .mechanism import Mechanism


def require_loads_repeating_each_turn(mechanism: Mechanism) -> None:
    """Raise an error for a load that does not repeat after one crank turn."""
    for load in mechanism.with_largest_variables.loads:
        if load.differs_after_a_turn:
            raise InputError(
                "a spring on the crank would wind up with every turn; got a crank that rotates fully with a "
                f'{load.magnitude_text}; let the crank swing, [motion] kind = "swing", or give its torque over the '
                "crank angle"
            )


def require_no_crank_load(mechanism: Mechanism, subject: str) -> None:
    """Raise an error for loads on the crank if an analysis supports only loads on the slider. subject: the analysis."""
    for load in mechanism.with_largest_variables.loads:
        if load.on_crank:
            raise InputError(
                f"{subject} only takes loads on the slider; got {load.magnitude_text}; leave that load out"
            )
