"""One-at-a-time variation: the slider's motion over the cycle with one dimension changed, and the nominal motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..errors import InputError
from .linkage import Linkage
from .linkage_values import Kinematics

Dimension = Literal["crank", "rod", "offset"]


@dataclass(frozen=True)
class Variation:
    """Motion with one dimension at another value, m. Arrays of `motion` are (m,), like those of `Variations`."""

    dimension: Dimension
    value: float
    motion: Kinematics


@dataclass(frozen=True)
class Variations:
    """The nominal motion and the motions with one dimension changed, at crank angles (m,), rad."""

    crank_angle: Array
    linkage: Linkage
    nominal: Kinematics
    varied: tuple[Variation, ...]


def motion_variations(
    linkage: Linkage,
    changes: Sequence[tuple[Dimension, float]],
    crank_angle: ArrayLike,
    *,
    speed: float = 1.0,
    acceleration: float = 0.0,
) -> Variations:
    """Return one linkage's slider motion, nominal and with each single change: a dimension and its other value, m.

    speed, acceleration: crank speed and acceleration, rad/s and rad/s^2; at speed 1, velocity is per rad of crank
    angle. Raises `AssemblyError` where a changed linkage cannot be assembled at some of the crank angles.

    >>> found = vary(Linkage(0.14, 0.31, 0.06), [("crank", 0.15)], [0.0])
    >>> round(float(found.varied[0].motion.slider_position[0] - found.meant.slider_position[0]), 9)
    0.01
    """
    if np.ndim(linkage.rotates_fully):
        raise InputError(f"exactly one linkage is needed; got an array of shape {np.shape(linkage.rotates_fully)}")
    angles = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    dimensions = {"crank": float(linkage.crank), "rod": float(linkage.rod), "offset": float(linkage.offset)}
    varied = []
    for name, value in changes:
        if name not in dimensions:
            raise InputError(f"a dimension must be one of {', '.join(get_args(Dimension))}; got {name!r}")
        if not math.isfinite(value):
            raise InputError(f"the changed value of the {name} must be finite; got {value}")
        changed = dimensions | {name: float(value)}
        changed_linkage = Linkage(changed["crank"], changed["rod"], changed["offset"], linkage.branch)
        varied.append(Variation(name, float(value), changed_linkage.at(angles, speed=speed, acceleration=acceleration)))
    return Variations(angles, linkage, linkage.at(angles, speed=speed, acceleration=acceleration), tuple(varied))
