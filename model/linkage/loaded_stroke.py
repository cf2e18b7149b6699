"""Loaded stroke: the one in which the load on the slider does more work against the motion.

The work against a stroke is W = -integral of F dX, F the load and X the distance of the slider, both positive outward.
Springs and tables over position that act in both strokes are left out: what they take in one stroke they give back in
the other. So is viscous resistance, which the fast stroke always has more of. A constant force is not: a weight loads
the stroke in which it is lifted.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..machine.loads.angle_table import AngleTable
from ..machine.loads.load import Load
from ..machine.loads.position_table import PositionTable
from ..machine.loads.stroke_force import StrokeForce
from ..machine.mechanism import Mechanism
from .linkage import Linkage

Array = NDArray[np.float64]
MORE = 0.01
"""Of the greater work: strokes whose works differ by less are loaded alike."""
_STEPS = 256  # of a stroke, for tables: sums good to 1e-3


def loaded_stroke(mechanism: Mechanism, dimensions: Array) -> NDArray[np.str_]:
    """Return which stroke of designs (n, 3 + k) is the loaded one: "outward", "inward", or "equal" for neither.

    Designs as in `Quantity.evaluate`: crank, rod, offset, m, each turning fully, then the varying numbers.
    """
    dimensions = np.atleast_2d(np.asarray(dimensions, dtype=np.float64))
    if mechanism.varying:
        parts = [_work(mechanism.at(row[3:].tolist()), row[None, :3]) for row in dimensions]
        outward, inward = np.concatenate([np.zeros((2, 0)), *parts], axis=1)
    else:
        outward, inward = _work(mechanism, dimensions)
    most = np.maximum(outward, inward)
    apart = np.abs(outward - inward) > MORE * most
    named = np.where(outward > inward, "outward", "inward")
    return np.asarray(np.where((most > 0.0) & apart, named, "equal"))


def _work(mechanism: Mechanism, dimensions: Array) -> Array:
    """Return the work against the outward and against the inward stroke (2, n), J."""
    loads = [load for load in mechanism.loads if _tells(load)]
    linkage = Linkage(dimensions[:, 0], dimensions[:, 1], dimensions[:, 2], mechanism.branch)
    work = np.zeros((2, len(dimensions)))
    for load in loads:
        if isinstance(load, StrokeForce):
            work += np.outer([-load.outward, load.inward], np.atleast_1d(linkage.stroke))
    tables = [load for load in loads if not isinstance(load, StrokeForce)]
    if tables:
        for row, outward in enumerate((True, False)):
            angle, distance = _path(linkage, outward=outward, direction=mechanism.direction)
            force = sum(_force(load, angle, distance, outward=outward) for load in tables)
            work[row] -= np.sum(force * np.diff(distance, axis=1), axis=1)
    return work


def _tells(load: Load) -> bool:
    """Whether a load counts for what stroke is loaded."""
    if isinstance(load, PositionTable):
        return load.during != "cycle"
    return isinstance(load, StrokeForce | AngleTable)


def _path(linkage: Linkage, *, outward: bool, direction: float) -> tuple[Array, Array]:
    """Return mid-step crank angles (n, m) of a stroke, and outward distances (n, m + 1) at the step ends."""
    inner, outer = (np.atleast_1d(angle)[:, None] for angle in linkage.dead_centre_angles)
    begin, end = (inner, outer) if outward else (outer, inner)
    turn = direction * np.mod(direction * (end - begin), 2.0 * math.pi)
    edges = begin + turn * np.linspace(0.0, 1.0, _STEPS + 1)
    one = Linkage(linkage.crank[:, None], linkage.rod[:, None], linkage.offset[:, None], linkage.branch)
    return 0.5 * (edges[:, 1:] + edges[:, :-1]), linkage.sign * one.at(edges).slider_position


def _force(load: Load, angle: Array, distance: Array, *, outward: bool) -> Any:
    """Return a tabulated load, N outward, in the middle of each step of a stroke."""
    assert isinstance(load, PositionTable | AngleTable)
    if load.during == ("inward stroke" if outward else "outward stroke"):
        return 0.0
    if isinstance(load, AngleTable):
        return np.interp(angle, load.angles, load.forces, period=2.0 * math.pi)
    at = 0.5 * (distance[:, 1:] + distance[:, :-1])
    if load.datum == "inner dead centre":
        at = at - distance.min(axis=1, keepdims=True)
    elif load.datum == "outer dead centre":
        at = distance.max(axis=1, keepdims=True) - at
    return np.interp(at, load.positions, load.forces)
