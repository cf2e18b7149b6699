"""Curves that the cylinders of a crankshaft leave together, whatever its dimensions."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable

from ..machine.arrangement import Arrangement
from ..machine.mechanism import Mechanism

_SAME = 1e-9  # rad, and share of a sum that has cancelled


def has_shaking_force(mechanism: Mechanism) -> bool:
    """Return whether the shaking forces of a machine's cylinders leave something for some design."""
    arrangement = mechanism.arrangement
    return arrangement is None or is_unbalanced(arrangement, lambda k: cmath.exp(1j * arrangement.bank(k)))


def has_rocking_couple(mechanism: Mechanism) -> bool:
    """Return whether the shaking forces of a machine's cylinders leave a couple for some design."""
    arrangement = mechanism.arrangement
    if arrangement is None or not any(arrangement.places):
        return False
    return is_unbalanced(arrangement, lambda k: arrangement.place(k) * cmath.exp(1j * arrangement.bank(k)))


def is_unbalanced(arrangement: Arrangement, share: Callable[[int], complex]) -> bool:
    """Return whether shares add up to something over the cylinders that stand alike.

    A curve of period 2 pi with every harmonic cancels only among cylinders with the same crank angle from their lines.
    """
    groups: list[tuple[float, list[complex]]] = []
    for k in range(len(arrangement.phases)):
        lead = arrangement.lead(k)
        for at, shares in groups:
            if abs(math.remainder(lead - at, 2.0 * math.pi)) <= _SAME:
                shares.append(share(k))
                break
        else:
            groups.append((lead, [share(k)]))
    return any(abs(sum(shares)) > _SAME * sum(map(abs, shares)) for _, shares in groups)
