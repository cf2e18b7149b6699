"""The quantities that closed formulas give, for many designs at once, with exact gradients."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..kernel.arithmetic import STEP, analytic, inverse, magnitude
from ..kernel.batches import in_chunks
from ..kernel.kernel import Row, Table, kernel
from .geometry import least_transmission_angle, outer_dead_centre, stroke, time_ratio
from .in_line import in_line

Array = NDArray[np.float64]


class ClosedForm(IntEnum):
    """Quantities of closed form: time ratio, least transmission angle (rad), stroke (m), ratios, footprints (m^2)."""

    TIME_RATIO = 0
    TRANSMISSION_ANGLE = 1
    STROKE = 2
    ROD_TO_OFFSET = 3
    ROD_TO_CRANK = 4
    FOOTPRINT_OF_CRANK = 5
    FOOTPRINT_OF_OFFSET = 6


_TIME_RATIO, _TRANSMISSION, _STROKE, _ROD_TO_OFFSET, _ROD_TO_CRANK, _OF_CRANK = range(6)


@analytic
def closed_form(kind: Any, r: Any, l: Any, e: Any) -> Any:
    """Return one quantity of a linkage that turns fully.

    Footprint: area of the rectangle around the pin centres over the cycle, (x_out + r) (r + max(r, |e|)), as its two
    smooth pieces. Rod to offset: l / |e|, infinite without offset.
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


@kernel
def _evaluate(kind: int, designs: Table, values: Row, gradients: Table) -> None:
    for n in range(designs.shape[0]):
        r, l, e = designs[n, 0], designs[n, 1], designs[n, 2]
        values[n] = closed_form(kind, r, l, e)
        if gradients.shape[0]:
            gradients[n, 0] = closed_form(kind, complex(r, STEP), complex(l, 0.0), complex(e, 0.0)).imag / STEP
            gradients[n, 1] = closed_form(kind, complex(r, 0.0), complex(l, STEP), complex(e, 0.0)).imag / STEP
            gradients[n, 2] = closed_form(kind, complex(r, 0.0), complex(l, 0.0), complex(e, STEP)).imag / STEP


def evaluate_closed_form(kind: ClosedForm, designs: Array, *, gradients: bool = False) -> tuple[Array, Array | None]:
    """Return values (n,) and gradients (n, 3) for designs (n, 3): crank, rod, offset, m."""
    designs = np.ascontiguousarray(designs, dtype=np.float64)
    n = len(designs)
    values = np.empty(n)
    slopes = np.empty((n if gradients else 0, 3))

    def work(begin: int, end: int) -> None:
        _evaluate(int(kind), designs[begin:end], values[begin:end], slopes[begin:end] if gradients else slopes)

    in_chunks(n, work, size=4096)
    if kind == ClosedForm.ROD_TO_OFFSET:
        values[in_line(designs[:, 1], designs[:, 2])] = np.inf
    return values, slopes if gradients else None
