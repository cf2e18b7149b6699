"""Refusals of loads on the crank where an analysis has no place for them."""

from __future__ import annotations

from ..errors import InputError
from .mechanism import Mechanism


def require_no_winding(mechanism: Mechanism) -> None:
    """Refuse a load that is another one after a turn of the crank."""
    for load in mechanism.fullest.loads:
        if load.winds:
            raise InputError(
                f"a spring on the crank winds up with every turn; got a crank that turns through, with a {load.size}; "
                'let the crank swing, [motion] kind = "swing", or give its torque over the crank angle'
            )


def require_no_crank_load(mechanism: Mechanism, subject: str) -> None:
    """Refuse loads on the crank where an analysis has those on the slider alone; subject: the analysis."""
    for load in mechanism.fullest.loads:
        if load.on_crank:
            raise InputError(f"{subject} takes loads on the slider; got {load.size}; leave that load out")
