"""Joint forces of many designs at given crank angles, in complex numbers, for custom quantities.

If loads or friction are piecewise, the real crank angle of the real design selects the piece, as in `cycle`.
"""

import math

import numpy as np
from numpy.typing import NDArray

from ..dynamics.segments import CycleWindow, Segment, find_segment_pieces, load_on_slider
from ..dynamics.torque import Forces
from ..dynamics.torque_with_friction import (
    friction_signs_in_segment,
    joint_forces_with_optional_friction,
    needs_friction_kernel,
    rotation_sense,
    torque_without_crank_loads,
)
from ..kernel.batches import run_in_chunks
from ..kernel.kernel import ComplexCube, ComplexTable, Row, rarely_used_kernel
from ..machine.design import DESIGN, LOAD_ROWS, derive_design, design_at
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import Loads, load_structure, raw_vector
from .signals import design_motion

ComplexArray = NDArray[np.complex128]

_ROWS = len(Forces._fields) + 1


@rarely_used_kernel
def _fill_forces(
    raw: Row, designs: ComplexTable, loads: Loads, angles: ComplexTable, out: ComplexCube, rubbing: bool
) -> None:
    watch = CycleWindow(0, 0.0, 1.0, False)
    rows = DESIGN + LOAD_ROWS * loads.kind.shape[0]
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    block = np.empty((rows, 1))
    stepped, curved = np.empty((raw.shape[0], 1), np.complex128), np.empty((rows, 1), np.complex128)
    for n in range(designs.shape[0]):
        for i in range(raw.shape[0]):
            stepped[i, 0] = complex(raw[i], 0.0)
        for v in range(3):
            stepped[v, 0] = designs[n, v]
        derive_design(stepped, loads.kind, loads.datum, curved)
        for i in range(rows):
            block[i, 0] = curved[i, 0].real
        d, z = design_at(block, 0), design_at(curved, 0)
        for k in range(angles.shape[1]):
            theta = angles[n, k].real
            sine, cosine = math.sin(theta), math.cos(theta)
            step = angles[n, k].imag
            s, c = complex(sine, cosine * step), complex(cosine, -sine * step)
            _, outward = find_segment_pieces(d, block, 0, theta, loads, watch, piece, shift)
            sides = friction_signs_in_segment(theta, d, Segment(block, loads, outward, piece, shift), rubbing)
            segment = Segment(curved, loads, outward, piece, shift)
            m = design_motion(s, c, z)
            load = load_on_slider(m, z, angles[n, k], segment)
            f = joint_forces_with_optional_friction(s, c, m, z, load, sides)
            out[n, 0, k] = torque_without_crank_loads(f.torque, angles[n, k], rotation_sense(d), segment)
            out[n, 1, k] = f.pivot_x
            out[n, 2, k] = f.pivot_y
            out[n, 3, k] = f.crank_pin_x
            out[n, 4, k] = f.crank_pin_y
            out[n, 5, k] = f.slider_pin_x
            out[n, 6, k] = f.slider_pin_y
            out[n, 7, k] = f.guide
            out[n, 8, k] = load


def complex_joint_forces(
    mechanism: Mechanism, designs: ComplexArray, angles: ComplexArray
) -> tuple[Forces, ComplexArray]:
    """Return the joint forces and the load on the slider, N outward, each (n, k).

    designs: (n, 3), crank, rod, offset, m, each rotating fully. angles: (n, k), rad. NaN where friction locks the
    linkage.
    """
    # Arrays of one type, so that one compiled kernel serves all.
    designs, angles = (np.require(array, np.complex128, ["C", "W"]) for array in (designs, angles))
    out = np.empty((len(angles), _ROWS, angles.shape[1]), np.complex128)
    raw, loads, rubbing = raw_vector(mechanism), load_structure(mechanism), needs_friction_kernel(mechanism)

    def work(begin: int, end: int) -> None:
        _fill_forces(raw, designs[begin:end], loads, angles[begin:end], out[begin:end], rubbing)

    run_in_chunks(len(designs), work, size=64)
    *forces, load = out.swapaxes(0, 1)
    return Forces(*forces), load
