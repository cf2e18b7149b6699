"""Curves whose sum over the cylinders of a crankshaft does not vanish for all dimensions."""

import cmath
import math
from collections.abc import Callable

from ..machine.arrangement import Arrangement
from ..machine.mechanism import Mechanism

_SAME = 1e-9  # rad, and fraction of a sum that counts as cancelled


def has_shaking_force(mechanism: Mechanism) -> bool:
    """Return whether a machine's cylinders leave a shaking force for some design."""
    arrangement = mechanism.arrangement
    return arrangement is None or is_unbalanced(arrangement, lambda k: cmath.exp(1j * arrangement.bank_angle(k)))


def has_rocking_couple(mechanism: Mechanism) -> bool:
    """Return whether the shaking forces of a machine's cylinders leave a rocking couple for some design."""
    arrangement = mechanism.arrangement
    if arrangement is None or not any(arrangement.places):
        return False
    return is_unbalanced(
        arrangement, lambda k: arrangement.shaft_position(k) * cmath.exp(1j * arrangement.bank_angle(k))
    )


def is_unbalanced(arrangement: Arrangement, weight: Callable[[int], complex]) -> bool:
    """Return whether contributions of cylinders with equal crank angles from their lines do not cancel.

    A curve of period 2 pi with every harmonic cancels only among cylinders with the same crank angle from their lines.
    """
    groups: list[tuple[float, list[complex]]] = []
    for k in range(len(arrangement.phases)):
        lead = arrangement.lead_over_slider_line(k)
        for group_lead, weights in groups:
            if abs(math.remainder(lead - group_lead, 2.0 * math.pi)) <= _SAME:
                weights.append(weight(k))
                break
        else:
            groups.append((lead, [weight(k)]))
    return any(abs(sum(weights)) > _SAME * sum(map(abs, weights)) for _, weights in groups)
