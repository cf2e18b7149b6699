"""Gas force in a cylinder, enclosed over boxes of designs."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...model.arrays import Array
from ...model.machine.loads.cylinder import Cylinder
from ...model.machine.loads.engine import LimitedPressure
from .enclosure import UNIT, Enclosure, enclosure_of_ends, select_by_mask


def gas_force(load: Cylinder, share: Enclosure, stroke: Enclosure, outward: Enclosure) -> Enclosure:
    """Return the force, N outward, for the piston's distance from its top as a fraction of the stroke.

    outward: its sign determines the stroke; where the sign is uncertain, the force spans both strokes.
    """
    sign = 1.0 if load.head == "inner dead centre" else -1.0
    low, high = outward.ends()
    sides = [_pressure(load, share, stroke, expanding=(sign > 0.0) == way) for way in (True, False)]
    ends = [side.ends() for side in sides]
    either_stroke = enclosure_of_ends(
        np.minimum(ends[0][0], ends[1][0]), np.maximum(ends[0][1], ends[1][1]), len(outward.slopes)
    )
    pressure = select_by_mask(low > 0.0, sides[0], select_by_mask(high < 0.0, sides[1], either_stroke))
    return (pressure - load.back_pressure) * (sign * load.area)


def _pressure(load: Cylinder, share: Enclosure, stroke: Enclosure, *, expanding: bool) -> Enclosure:
    """Return the pressure during one stroke, Pa; it falls with the distance from the top."""
    k = len(share.slopes)
    first, last = (np.clip(end, 0.0, 1.0) for end in share.ends())
    if load.clearance_volume and load.compression_exponent:
        # It rises (expansion) or falls (compression) with the clearance, so the corners bound it.
        least, greatest = (load.clearance + load.clearance_volume / (load.area * end) for end in stroke.ends()[::-1])
        near, far = (greatest, least) if expanding else (least, greatest)
        return enclosure_of_ends(
            _pressure_at(load, last, far, expanding), _pressure_at(load, first, near, expanding), k
        )
    at_first, at_last = (_pressure_at(load, end, load.clearance, expanding) for end in (first, last))
    wide = last > first
    slope = np.where(wide, (at_last - at_first) / np.where(wide, last - first, 1.0), 0.0)
    n = load.expansion_exponent if expanding else load.compression_exponent
    lowest, highest = np.zeros_like(first), np.zeros_like(first)
    if n:
        ratio, c = load.high / load.low, load.clearance
        event = c * (ratio ** (1.0 / n) - 1.0) if expanding else (1.0 + c) * ratio ** (-1.0 / n) - c
        bent = np.minimum(first, event) if expanding else np.maximum(first, event)
        curved = first < event if expanding else last > event
        scale = load.high * c**n if expanding else load.low * (1.0 + c) ** n
        if expanding and isinstance(load, LimitedPressure):
            event = load.burning_share
            bent, curved, scale = np.maximum(first, event), last > event, load.high * (c + event) ** n
        with np.errstate(divide="ignore"):
            bend = np.where(curved, scale * n * (n + 1.0) / (c + bent) ** (n + 2.0), 0.0)
        # Chords of the two pieces meet at the event; each curve lies at most bend width^2 / 8 below its chord.
        off = _pressure_at(load, event, c, expanding) - (at_first + slope * (event - first))
        between_ends = (first < event) & (event < last)
        lowest = np.where(between_ends, np.minimum(off, 0.0), 0.0) - 0.125 * bend * (last - first) ** 2
        highest = np.where(between_ends, np.maximum(off, 0.0), 0.0)
    chord = (share - first) * slope + (at_first + 0.5 * (highest + lowest))
    most_of = UNIT * (load.high + np.abs(slope) * share.greatest_magnitude)
    return Enclosure(chord.centre, chord.slopes, chord.rest + 0.5 * (highest - lowest) + 8.0 * most_of, chord.empty)


def _pressure_at(load: Cylinder, share: Any, clearance: Any, expanding: bool) -> Array:
    """Return the pressure at a fraction of the stroke, for a clearance ratio."""
    if load.compression_exponent == 0.0:
        return np.asarray((load.low if expanding else load.high) + 0.0 * share)
    if expanding and isinstance(load, LimitedPressure):
        return np.asarray(load.pressure(share, 1.0, expanding=True))
    with np.errstate(divide="ignore", invalid="ignore"):
        if expanding:
            return np.asarray(
                np.fmax(load.low, load.high * (clearance / (clearance + share)) ** load.expansion_exponent)
            )
        ratio = (1.0 + clearance) / (clearance + share)
        return np.asarray(np.fmin(load.high, load.low * ratio**load.compression_exponent))
