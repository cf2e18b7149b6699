"""Designs derived from raw numbers in advance, for kernels that follow one design at a time; compiled only once."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, IntArray
from ..kernel.arithmetic import STEP
from ..kernel.kernel import ComplexCube, Cube, Integers, Row, Table, kernel
from .design import DESIGN, LOAD_ROWS, derive_design
from .raw_machine_vector import Loads

_ONE, _NONE = np.zeros((1, 0)), np.zeros(0, np.int64)


@kernel
def _fill_derived_blocks(
    raw: Row, columns: Integers, designs: Table, kind: Integers, datum: Integers, blocks: Cube, steps: ComplexCube
) -> None:
    # Complex throughout: compiling the real formulas as well would double the time. Zeros, because loads do not fill
    # all
    # rows.
    stepped, block = np.empty((raw.shape[0], 1), np.complex128), np.zeros((blocks.shape[1], 1), np.complex128)
    count = steps.shape[0] // blocks.shape[0]
    for n in range(blocks.shape[0]):
        for i in range(raw.shape[0]):
            stepped[i, 0] = raw[i]
        for i in range(columns.shape[0]):
            stepped[columns[i], 0] = designs[n, i]
        for v in range(-1, count):
            unstepped = stepped[columns[max(v, 0)], 0] if count else 0j
            if v >= 0:
                stepped[columns[v], 0] = unstepped + complex(0.0, STEP)
            derive_design(stepped, kind, datum, block)
            if v >= 0:
                stepped[columns[v], 0] = unstepped
            for i in range(blocks.shape[1]):
                if v < 0:
                    blocks[n, i, 0] = block[i, 0].real
                else:
                    steps[n * count + v, i, 0] = block[i, 0]


def derived_blocks(
    raw: Array, loads: Loads, columns: IntArray = _NONE, designs: Array = _ONE, *, steps: bool = False
) -> tuple[Array, NDArray[Any]]:
    """Return blocks (n, DESIGN + LOAD_ROWS k, 1) from raw numbers (END + LOAD_SLOTS k,); designs (n, c) set `columns`.

    By default there is a single design that sets none. steps: whether to also return blocks (n c, DESIGN + LOAD_ROWS k,
    1) for an imaginary step in each column; otherwise there are none.
    """
    rows, n = DESIGN + LOAD_ROWS * len(loads.kind), len(designs)
    blocks = np.empty((n, rows, 1))
    stepped = np.empty((n * len(columns) if steps else 0, rows, 1), np.complex128)
    if n:
        _fill_derived_blocks(raw, columns, designs, loads.kind, loads.datum, blocks, stepped)
    return blocks, stepped
