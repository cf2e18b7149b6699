"""Loaded stroke: the stroke in which the load on the slider does more work against the motion.

The work against a stroke is W = -integral of F dX, with F the load and X the distance of the slider, both positive
outward. Springs and tables over position that act in both strokes are left out, because they return in one stroke what
they absorb in the other. Viscous resistance is also left out, as it is always greater in the faster stroke. A constant
force counts: a weight loads the stroke in which it is lifted.
"""

import math

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..machine.loads.load import Passage
from ..machine.mechanism import Mechanism
from .linkage import Linkage

MORE = 0.01
"""Fraction of the greater work: strokes whose works differ by less are equally loaded."""
_STEPS = 256  # steps per stroke, which make sums accurate to 1e-3


def loaded_stroke(mechanism: Mechanism, dimensions: Array) -> NDArray[np.str_]:
    """Return the loaded stroke of designs (n, 3 + k): "outward", "inward", or "equal" for neither.

    Designs as in `Quantity.evaluate`: crank, rod, offset, m, each rotating fully, then the variables.
    """
    dimensions = np.atleast_2d(np.asarray(dimensions, dtype=np.float64))
    if mechanism.varying:
        parts = [_work_against_strokes(mechanism.with_values(row[3:].tolist()), row[None, :3]) for row in dimensions]
        outward, inward = np.concatenate([np.zeros((2, 0)), *parts], axis=1)
    else:
        outward, inward = _work_against_strokes(mechanism, dimensions)
    greater = np.maximum(outward, inward)
    differs = np.abs(outward - inward) > MORE * greater
    named = np.where(outward > inward, "outward", "inward")
    return np.asarray(np.where((greater > 0.0) & differs, named, "equal"))


def _work_against_strokes(mechanism: Mechanism, dimensions: Array) -> Array:
    """Return the work against the outward and the inward stroke (2, n), J."""
    linkage = Linkage(dimensions[:, 0], dimensions[:, 1], dimensions[:, 2], mechanism.branch)
    work = np.zeros((2, len(dimensions)))
    for row, outward in enumerate((True, False)):
        passage = _passage_of_stroke(linkage, outward=outward, direction=mechanism.direction)
        for load in mechanism.loads:
            work[row] -= load.work_deciding_loaded_stroke(passage)
    return work


def _passage_of_stroke(linkage: Linkage, *, outward: bool, direction: float) -> Passage:
    inner, outer = (np.atleast_1d(angle)[:, None] for angle in linkage.dead_centre_angles)
    begin, end = (inner, outer) if outward else (outer, inner)
    turn = direction * np.mod(direction * (end - begin), 2.0 * math.pi)
    edges = begin + turn * np.linspace(0.0, 1.0, _STEPS + 1)
    column_linkage = Linkage(linkage.crank[:, None], linkage.rod[:, None], linkage.offset[:, None], linkage.branch)
    return Passage(
        outward, 0.5 * (edges[:, 1:] + edges[:, :-1]), linkage.sign * column_linkage.at(edges).slider_position
    )
