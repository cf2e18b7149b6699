"""Safety of crank and rod as bars against fatigue and against buckling."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..model.machine.mechanism import Mechanism
from ..model.machine.numbers import formula_of_numbers
from ..model.strength.stress_locations import LinkBody, StressLocation
from .bars import LINKS, NEAR, Formula, OfBars, Part, eyes_of, strength_of, stress_divisor, stresses
from .kinds import RATIO
from .machine_needs import A_BAR, EVEN_SPEED, LOADED, ONE_TURN, STRENGTH
from .quantity import Array

_COMPRESSION = ((0.0, 1.0),)


class FatigueSafety(OfBars):
    """Least 1 / (amplitude / S_e + mean / S_m) over all points of the bars and their eyes."""

    def parts(self, mechanism: Mechanism, designs: Array, piece_count: int, gradients: bool) -> Sequence[Part]:
        """Return the safety of each bar and of each eye; see `OfBars`."""
        strength = strength_of(mechanism)
        worn, steady = 0.5 / strength.material.endurance, 0.5 / strength.steady
        # Of amplitude and mean in terms of greatest and least stress; and of the amplitude alone.
        criteria = ((worn + steady, worn - steady), (worn, worn))
        bars = self.bars(mechanism)
        eyes = [eye for name in bars for pin in (NEAR, LINKS[name].far) for eye in eyes_of(name, pin)]
        places: tuple[StressLocation, ...] = (*(LinkBody(LINKS[name].part) for name in bars), *eyes)
        peak_stresses = stresses(mechanism, designs, places, criteria, piece_count, gradients)
        return [
            part.dividing(stress_divisor(mechanism, designs, place, gradients))
            for place, part in zip(places, peak_stresses, strict=True)
        ]


class BucklingSafety(OfBars):
    """Critical stress divided by the greatest compression, least value over bars and planes."""

    def parts(self, mechanism: Mechanism, designs: Array, piece_count: int, gradients: bool) -> Sequence[Part]:
        """Return the safety of each bar in the plane of motion and out of it; see `OfBars`."""
        material = strength_of(mechanism).material
        safeties = []
        bars = [LINKS[name] for name in self.bars(mechanism)]
        places = tuple(LinkBody(own.part, bent=False) for own in bars)
        squeezed = stresses(mechanism, designs, places, _COMPRESSION, piece_count, gradients)
        for own, pressed in zip(bars, squeezed, strict=True):
            for side in (own.width, own.depth):
                critical = critical_stress(
                    own.length, side, own.end_condition, material.elasticity, material.yield_strength
                )
                safeties.append(pressed.dividing(formula_of_numbers(mechanism, designs, critical, gradients=gradients)))
        return safeties


def critical_stress(length: int, side: int, end_condition: float, elasticity: float, strength: float) -> Formula:
    """Return the formula of the mean stress at which a bar of rectangular section buckles, Pa.

    With the slenderness s = L sqrt(12) / side: Euler's C pi^2 E / s^2 beyond s_1 = sqrt(2 pi^2 C E / S_y), Johnson's
    parabola S_y - (S_y s / 2 pi)^2 / (C E) up to it; value and slope agree there, at S_y / 2. length, side: slots of
    the raw numbers. end_condition: the end condition C.
    """
    limit = math.sqrt(2.0 * math.pi**2 * end_condition * elasticity / strength)

    def formula(number: Any) -> Any:
        slender = number(length) * math.sqrt(12.0) / number(side)
        euler = end_condition * math.pi**2 * elasticity / slender**2
        johnson = strength - (strength * slender / (2.0 * math.pi)) ** 2 / (end_condition * elasticity)
        return np.where(np.real(slender) > limit, euler, johnson)

    return formula


FATIGUE_SAFETY = FatigueSafety(
    name="fatigue_safety",
    kind=RATIO,
    least=True,
    place=446,
    sentence=(
        "The factor by which all stresses could grow before the worst point of crank and rod fails by fatigue. "
        "Amplitude and mean are those of the stress at this point over a turn, with the stress concentration in the "
        "eyes."
    ),
    advice=(
        "1.3 to 2 are usual. The endurance strength is that of the finished bar, but without the stress "
        "concentration, which eye_concentration already includes."
    ),
    formula="1 / max(sigma_a / S_e + max(sigma_m, 0) / S_u) over place; S_y in place of S_u with Soderberg's criterion",
    source="Shigley, Mechanical Engineering Design, 9th ed., eq. 6-46 (Goodman) and 6-45 (Soderberg)",
    picture="rod",
    example=1.5,
    better="high",
    allowed_by="fatigue strength of the material",
    needs=(STRENGTH, EVEN_SPEED, ONE_TURN, A_BAR, LOADED),
)
BUCKLING_SAFETY = BucklingSafety(
    name="buckling_safety",
    kind=RATIO,
    least=True,
    place=448,
    sentence=(
        "The load at which a bar buckles over its greatest compression, in the plane of motion and out of it: "
        "Euler's for a slender bar, Johnson's for a short one. Infinite where nothing is compressed."
    ),
    advice="3 and more are usual. A rod of square section is as safe in both planes.",
    formula="P_cr / max(-N): C pi^2 E I / L^2 or Johnson's parabola; C = 1 of the rod in both planes, 1/4 of the crank",
    source="Shigley, Mechanical Engineering Design, 9th ed., sec. 4-12 and 4-13, table 4-2",
    picture="rod",
    example=3.0,
    better="high",
    allowed_by="load at which the bar buckles",
    endless="crank and rod are never compressed",
    needs=(STRENGTH, EVEN_SPEED, A_BAR, LOADED),
)
