"""Stress in the crank or rod of one design over the cycle and along the bar, for a figure."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..machine.cylinders_and_turns import TURN, machines_of_turns
from ..machine.mechanism import Mechanism
from ..signals.two_turn_peaks import angles_within_both_turns
from .section_forces import CRANK, Stress, stress_at_length_fraction
from .stress_points import WIDE, stress_field_of

_STATIONS = 61


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
    machines = machines_of_turns(mechanism)
    angles, begins, stresses = [], [], []
    for turn, machine in enumerate(machines):
        field = stress_field_of(machine, design)
        samples = field.samples
        middle = np.mean(field.segment_end_angles(np.zeros_like(samples.segment), samples.segment), axis=0)
        shift = 0.0 * middle
        if len(machines) > 1:  # a segment lies within one turn of the cycle
            shift = angles_within_both_turns(mechanism, design, middle[None], turn)[0] - middle
        angles.append(np.mod(samples.theta + shift, len(machines) * TURN))
        begins.append(samples.theta < middle)
        stresses.append(samples.stress)
    # At a jump, the segment that ends there comes first.
    order = np.lexsort((np.concatenate(begins), np.concatenate(angles)))
    base = WIDE * (part == CRANK)
    shares = np.linspace(0.0, 1.0, _STATIONS)
    stress = Stress(*np.concatenate(stresses)[order, base : base + 7].T)
    both_sides = [stress_at_length_fraction(stress, side, shares[:, None]) for side in (1.0, -1.0)]
    return BarStress(np.concatenate(angles)[order], shares, np.array(both_sides))
