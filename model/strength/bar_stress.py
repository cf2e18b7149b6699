"""Stress in the crank or rod of one design over the cycle and along the bar, for a figure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..machine.mechanism import Mechanism
from ..machine.two_turn_machine import cycle_turns, machines_of_both_turns
from .section_forces import CRANK, Stress, stress_at_length_fraction
from .stress_points import WIDE, stress_field_of

_STATIONS = 61
_TURN = 2.0 * np.pi


@dataclass(frozen=True)
class BarStress:
    """Stress at both faces of a bar. If friction locks the design, the angles are empty.

    theta: (s,), rad, over a cycle. shares: fractions of the length from the crank pin, (k,). stress: (2, k, s), Pa,
    tension positive; the first face is that where bending adds to tension.
    """

    theta: Array
    shares: Array
    stress: Array

    @property
    def envelope(self) -> tuple[Array, Array]:
        """Minimum and maximum stress over the cycle at every location, (k,)."""
        return self.stress.min(axis=(0, 2)), self.stress.max(axis=(0, 2))

    @property
    def index_of_largest_stress(self) -> int:
        """Index of the location with the stress of largest magnitude."""
        return int(np.abs(self.stress).max(axis=(0, 2)).argmax())


def bar_stress(mechanism: Mechanism, part: int, design: Array) -> BarStress:
    """Return the stress along a link, `ROD` or `CRANK`, of one design (1, 3 + k). The link must be a `Bar`."""
    if cycle_turns(mechanism) > 1:
        first, second = (bar_stress(half, part, design) for half in machines_of_both_turns(mechanism))
        theta = np.concatenate([first.theta, second.theta + _TURN])
        return BarStress(theta, first.shares, np.concatenate([first.stress, second.stress], axis=2))
    samples = stress_field_of(mechanism, design).samples
    base = WIDE * (part == CRANK)
    shares = np.linspace(0.0, 1.0, _STATIONS)
    stress = Stress(*samples.stress[:, base : base + 7].T)
    both_sides = [stress_at_length_fraction(stress, side, shares[:, None]) for side in (1.0, -1.0)]
    # Samples cover a turn from the first breakpoint; those beyond a whole turn come first, keeping their order at
    # jumps.
    turned = int(np.searchsorted(samples.theta, _TURN))
    theta = np.roll(np.where(samples.theta < _TURN, samples.theta, samples.theta - _TURN), -turned)
    return BarStress(theta, shares, np.roll(np.array(both_sides), -turned, axis=2))
