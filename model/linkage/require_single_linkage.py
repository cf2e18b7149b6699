"""Validation of the single linkage that an analysis of a mechanism covers."""

import numpy as np

from ..errors import InputError
from ..machine.loads.crank_torque import require_loads_repeating_each_turn
from ..machine.mechanism import Mechanism
from .linkage import Linkage

SEE_DESIGNS = "see quantities with `slidercrank front RUN --design 1` and curves with `slidercrank export`"
"""Remedy for an analysis of a slider-crank that got another machine."""


def require_single_rotating_linkage(mechanism: Mechanism, linkage: Linkage) -> Linkage:
    """Return one fully rotating linkage, with dimensions as floats.

    Raises `InputError` for an array of linkages, for a linkage on another branch than the mechanism's, and for a spring
    on a fully rotating crank; `AssemblyError` for one that does not rotate fully.
    """
    require_slider(mechanism)
    linkage.require_full_rotation()
    require_loads_repeating_each_turn(mechanism)
    return require_single_linkage(mechanism, linkage)


def require_single_linkage(mechanism: Mechanism, linkage: Linkage) -> Linkage:
    """Return one linkage that need not rotate fully, with dimensions as floats.

    Raises `InputError` as `require_single_rotating_linkage` does.
    """
    if np.ndim(linkage.rotates_fully):
        raise InputError(
            f"only one linkage is possible at a time; got an array of shape {np.shape(linkage.rotates_fully)}; "
            "loop over it"
        )
    if linkage.branch != mechanism.branch:
        raise InputError(
            f"linkage and mechanism must be on the same branch; got {linkage.branch} and {mechanism.branch}; "
            "set branch in both"
        )
    return Linkage(float(linkage.crank), float(linkage.rod), float(linkage.offset), linkage.branch)


def require_slider(mechanism: Mechanism) -> None:
    """Raise `InputError` for a lever moved by a cylinder that turns, for an analysis of a slider-crank."""
    if mechanism.lever is not None:
        raise InputError(
            'this needs a crank with rod and slider; got inversion = "turning cylinder", which has neither; '
            f"{SEE_DESIGNS}"
        )
