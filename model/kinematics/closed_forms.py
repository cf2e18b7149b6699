"""Quantities with closed-form formulas, for many designs together, with exact gradients."""

from enum import IntEnum
from typing import Any

import numpy as np

from ..arrays import Array
from ..kernel.arithmetic import STEP, analytic, inverse, magnitude
from ..kernel.batches import run_in_chunks
from ..kernel.kernel import Row, Table, kernel
from .geometry import is_in_line, least_transmission_angle, outer_dead_centre, stroke, time_ratio


class ClosedForm(IntEnum):
    """Closed-form quantities: time ratio, minimum transmission angle (rad), stroke (m), ratios, footprints (m^2)."""

    TIME_RATIO = 0
    TRANSMISSION_ANGLE = 1
    STROKE = 2
    ROD_TO_OFFSET = 3
    ROD_TO_CRANK = 4
    FOOTPRINT_OF_CRANK = 5
    FOOTPRINT_OF_OFFSET = 6


_LANES = 16  # designs per loop
_TIME_RATIO, _TRANSMISSION, _STROKE, _ROD_TO_OFFSET, _ROD_TO_CRANK, _OF_CRANK, _ = map(int, ClosedForm)


@analytic
def closed_form_value(kind: Any, r: Any, l: Any, e: Any) -> Any:
    """Return one quantity of a fully rotating linkage.

    Footprint: area of the rectangle around the pin centres over the cycle, (x_out + r) (r + max(r, |e|)), as two smooth
    pieces. Rod to offset: l / |e|, infinite without offset.
    """
    a = magnitude(e)
    if kind == _TIME_RATIO:
        return time_ratio(r, l, a)
    if kind == _TRANSMISSION:
        return least_transmission_angle(r, l, a)
    if kind == _STROKE:
        return stroke(r, l, a)
    if kind == _ROD_TO_OFFSET:
        return l * inverse(a)
    if kind == _ROD_TO_CRANK:
        return l * inverse(r)
    if kind == _OF_CRANK:
        return (outer_dead_centre(r, l, a) + r) * (r + r)
    return (outer_dead_centre(r, l, a) + r) * (r + a)


@analytic
def _fill_closed_forms(kind: Any, work: Any, slopes: Any) -> None:
    """Fill value and, if requested, slopes (rows 3 to 6) for designs (rows 0 to 2)."""
    for j in range(_LANES):
        work[3, j] = closed_form_value(kind, work[0, j], work[1, j], work[2, j])
    for j in range(_LANES if slopes else 0):
        r, l, e = work[0, j], work[1, j], work[2, j]
        work[4, j] = closed_form_value(kind, complex(r, STEP), complex(l, 0.0), complex(e, 0.0)).imag / STEP
        work[5, j] = closed_form_value(kind, complex(r, 0.0), complex(l, STEP), complex(e, 0.0)).imag / STEP
        work[6, j] = closed_form_value(kind, complex(r, 0.0), complex(l, 0.0), complex(e, STEP)).imag / STEP


@kernel
def _fill_values_and_gradients(kind: int, designs: Table, values: Row, gradients: Table) -> None:
    n, slopes = designs.shape[0], gradients.shape[0] > 0
    work = np.empty((7, _LANES))
    for begin in range(0, n, _LANES):
        for j in range(_LANES):
            for i in range(3):
                work[i, j] = designs[min(begin + j, n - 1), i]
        # One loop per kind: a branch inside the loop would prevent vector instructions.
        if kind == _TIME_RATIO:
            _fill_closed_forms(_TIME_RATIO, work, slopes)
        elif kind == _TRANSMISSION:
            _fill_closed_forms(_TRANSMISSION, work, slopes)
        else:
            _fill_closed_forms(kind, work, slopes)
        last = min(_LANES, n - begin)
        for j in range(last):
            values[begin + j] = work[3, j]
        for j in range(last if slopes else 0):
            for i in range(3):
                gradients[begin + j, i] = work[4 + i, j]


def evaluate_closed_form(kind: ClosedForm, designs: Array, *, gradients: bool = False) -> tuple[Array, Array | None]:
    """Return values (n,) and gradients (n, 3) for designs (n, 3): crank, rod, offset, m."""
    designs = np.ascontiguousarray(designs, dtype=np.float64)
    n = len(designs)
    values = np.empty(n)
    slopes = np.empty((n if gradients else 0, 3))

    def work(begin: int, end: int) -> None:
        _fill_values_and_gradients(
            int(kind), designs[begin:end], values[begin:end], slopes[begin:end] if gradients else slopes
        )

    run_in_chunks(n, work, size=4096)
    if kind == ClosedForm.ROD_TO_OFFSET:
        values[is_in_line(designs[:, 1], designs[:, 2])] = np.inf
    return values, slopes if gradients else None
