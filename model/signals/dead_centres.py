"""Drive torque at the dead centres: a peak of the torque's curve may be a kink there."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..dynamics.torque import forces
from ..kernel.batches import in_chunks, turning
from ..kernel.kernel import Integers, Row, Table, kernel
from ..kinematics.geometry import inner_crank_angle, outer_crank_angle
from ..machine.design import DESIGN, derive_design, design_at
from ..machine.mechanism import Mechanism
from ..machine.numbers import numbers_of
from ..machine.raw import load_structure, raw_vector
from .signals import design_motion

Array = NDArray[np.float64]


@kernel
def _torques(
    raw: Row, columns: Integers, designs: Table, load_kind: Integers, load_datum: Integers, crossed: bool, out: Table
) -> None:
    own, block = np.empty((raw.shape[0], 1)), np.empty((DESIGN + 2 * load_kind.shape[0], 1))
    for n in range(designs.shape[0]):
        derive_design(raw, columns, designs[n], load_kind, load_datum, own, block)
        d = design_at(block, 0)
        for k in range(2):
            angle = inner_crank_angle(d.r, d.l, d.e) if k == 0 else outer_crank_angle(d.r, d.l, d.e)
            angle = math.pi - angle if crossed else angle
            sine, cosine = math.sin(angle), math.cos(angle)
            out[n, k] = forces(sine, cosine, design_motion(sine, cosine, d), d, 0.0).torque


def torque_at_dead_centres(mechanism: Mechanism, designs: Array) -> Array:
    """Return the drive torque (n, 2), N m, at inner and outer dead centre of designs (n, 3 + k).

    The slider stands there, so loads along the stroke take no torque: one that changes with the stroke makes a kink of
    the curve and no jump. Without friction. Raises `AssemblyError` for designs that do not turn fully.
    """
    designs = turning(designs)
    raw, loads = raw_vector(mechanism.fullest), load_structure(mechanism)
    numbers = numbers_of(mechanism, designs, room=len(raw), gradients=False)
    found, values = np.empty((len(designs), 2)), np.ascontiguousarray(numbers.values)
    crossed = mechanism.branch == "crossed"

    def work(begin: int, end: int) -> None:
        _torques(raw, numbers.columns, values[begin:end], loads.kind, loads.datum, crossed, found[begin:end])

    in_chunks(len(designs), work, size=4096)
    return found
