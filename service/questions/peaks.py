"""Peaks of one design over the cycle, as topics report them."""

import math
from typing import NamedTuple

import numpy as np

from ...model.arrays import Array
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.signals.first_peak import first_peaks
from ...model.signals.signals import Signal


class Peak(NamedTuple):
    """Maximum magnitude of a signal, SI, and its crank angle, deg; NaN if undetermined."""

    value: float
    degrees: float


def lengths_row(linkage: Linkage) -> Array:
    """Return crank, rod and offset, m, as a table with one design (1, 3)."""
    return np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])


def peak(mechanism: Mechanism, signal: Signal, linkage: Linkage) -> Peak:
    """Return the peak of a signal over the cycle; the first of equal peaks (`first_peaks`)."""
    values, angles = first_peaks(mechanism, signal, lengths_row(linkage))
    return Peak(float(values[0]), math.degrees(float(angles[0])))
