"""Force transmission: how much of the force in the slider pin acts along the slider line, least over the cycle."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..model.machine.mechanism import Mechanism
from ..model.signals.peaks import find_peaks
from ..model.signals.signals import Signal
from .kinds import RATIO
from .needs import LOADED
from .quantity import Array, Group, Pieces, Quantity, Values

_ROUNDING = 1e-13  # of a sine that is one: there the force along the line passes through zero


@dataclass(frozen=True, kw_only=True)
class ForceTransmission(Quantity):
    """The least of |B_x| / |B| over the cycle, B being the force in the slider pin, x along the slider line.

    B is what the rod gives to the slider. Without mass of the rod and without friction of the pins it acts along the
    rod, and the quantity is the sine of the least transmission angle. With either it does not: where B_x passes
    through zero, as inertia makes it do, and B_y does not, the quantity is 0. Angles without force count as 1. It is
    sqrt(1 - s^2) of the greatest sine s = |B_y| / |B|, exact over continuous crank angle; -inf where friction locks.
    """

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        found = find_peaks(mechanism, Signal.SLIDER_PIN_SINE, dimensions, gradients=gradients, kept=1)
        values, slopes = _cosines(found.values, found.gradients)
        return Values(values[:, 0], None if slopes is None else slopes[:, 0])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the least of smooth pieces; see `Quantity`."""
        found = find_peaks(mechanism, Signal.SLIDER_PIN_SINE, dimensions, gradients=True)
        values, slopes = _cosines(found.values, found.gradients)
        assert slopes is not None
        return Pieces(values, slopes, found.angles, least=True)


def _cosines(sines: Array, gradients: Array | None) -> tuple[Array, Array | None]:
    """Return cosines and their gradients for sines (n, k): inf for absent ones, -inf where friction locks."""
    known = np.isfinite(sines)
    inside = known & (sines < 1.0 - _ROUNDING)
    cosines = np.where(inside, np.sqrt(1.0 - np.where(inside, sines, 0.0) ** 2), np.where(known, 0.0, -sines))
    if gradients is None:
        return cosines, None
    slope = -np.where(inside, sines, 0.0) / np.where(inside, cosines, 1.0)
    return cosines, slope[:, :, None] * np.where(inside[:, :, None], gradients, 0.0)


FORCE_TRANSMISSION = ForceTransmission(
    name="force_transmission",
    title="force transmission, least",
    kind=RATIO,
    place=300,
    group=Group.PROPORTIONS,
    sentence=(
        "The least share, over a turn, of the force between rod and slider that acts along the slider line; the rest "
        "only presses the slider against its guide."
    ),
    advice="1 is ideal. Inertia that turns the force round within the turn makes it 0.",
    formula="min |B_x| / |B|, B the force in the slider pin; sin(mu_min) for a rod without mass, without friction",
    section="8. Dynamics",
    picture="slider pin force",
    example=0.5,
    better="high",
    needs=(replace(LOADED, without="undefined"),),
)
