"""Stresses in crank and rod, along the bars and in their eyes, and safety against yield, fatigue and buckling."""

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ..model.kernel.arithmetic import magnitude
from ..model.machine.mechanism import Mechanism
from ..model.strength.stress_cycle import stress_peaks
from ..model.strength.stress_locations import Eye, LinkBody, StressLocation
from .bar_pieces import (
    LINKS,
    NEAR,
    STATIC,
    BarPeak,
    Criteria,
    SectionLoad,
    critical_eye_edges,
    material_and_pins,
    net_section_formula,
    net_width_formula,
)
from .kinds import PRESSURE, RATIO
from .machine_needs import A_BAR, CRANK_BAR, EVEN_SPEED, LOADED, ROD_BAR, STRENGTH
from .quantity import Array, Formula

CRANK = "crank"


class LinkStress(BarPeak):
    """Maximum stress along the links and in the net sections of their eyes, or the yield strength divided by it."""

    def stress_locations(self, mechanism: Mechanism) -> tuple[StressLocation, ...]:
        """Return the stress maxima for both links, even if only one is requested."""
        return tuple(location for _, location in _links_and_locations(mechanism))

    def section_loads(self, mechanism: Mechanism) -> list[SectionLoad]:
        """Return the stress along bars and in the pivot's eye, and the force on all eyes; see `BarPeak`."""
        strength, bars = material_and_pins(mechanism), self.links_with_bars(mechanism)
        limit = strength.material.yield_strength if self.least else 1.0
        raised = strength.eye_concentration
        pivot = CRANK, LINKS[CRANK].far
        bent = [
            SectionLoad(location, net_width_formula(location), limit, pivot)
            if isinstance(location, Eye)
            else SectionLoad(location, None, limit)
            for name, location in _links_and_locations(mechanism)
            if name in bars
        ]
        return bent + [
            SectionLoad(pin, net_section_formula(name, pin), limit / raised if self.least else raised, (name, pin))
            for name in bars
            for pin in (NEAR, LINKS[name].far)
        ]


def greatest_eye_stresses(mechanism: Mechanism, design: Array) -> dict[str, dict[str, tuple[float, float]]]:
    """Return the maximum stress, Pa, and its crank angle, rad, in the eyes of each bar, by pin.

    design: (1, 3 + k).

    The angle is NaN if the stress is not finite.
    """
    stresses_by_link: dict[str, dict[str, tuple[float, float]]] = {}
    quantity = replace(ROD_STRESS, links=tuple(LINKS))
    for demand, part in zip(
        quantity.section_loads(mechanism), quantity.pieces_by_part(mechanism, design, 1, False), strict=True
    ):
        if demand.eye is None:
            continue
        name, pin = demand.eye
        value = float(part.values[0, 0])
        # A force is labelled with its crank angle.
        angle = (
            _angle_of_greatest_stress(mechanism, demand.peak, design)
            if isinstance(demand.peak, Eye)
            else float(part.labels[0, 0])
        )
        stress = (value, angle if math.isfinite(value) else math.nan)
        eyes = stresses_by_link.setdefault(name, {})
        eyes[pin] = max(eyes.get(pin, stress), stress, key=lambda one: one[0])
    return stresses_by_link


def _angle_of_greatest_stress(mechanism: Mechanism, place: StressLocation, design: Array) -> float:
    """Return the crank angle of the maximum stress at a location, in tension or compression."""
    ends = []
    for column, criterion in enumerate(STATIC):
        (peak,) = stress_peaks(mechanism, (place,), design, np.array([criterion]), limit=1)
        ends.append((float(peak.values[0, 0]), float(peak.places[0, 0, 2 + column])))
    return max(ends)[1]


def _links_and_locations(mechanism: Mechanism) -> list[tuple[str, StressLocation]]:
    """Return links and locations with stress over a whole section: along the bars, and in the eye at the pivot."""
    bars, pivot = STATIC_SAFETY.links_with_bars(mechanism), LINKS[CRANK].far
    bodies: list[tuple[str, StressLocation]] = [(name, LinkBody(LINKS[name].part)) for name in bars]
    return bodies + [(CRANK, eye) for eye in (critical_eye_edges(CRANK, pivot) if CRANK in bars else [])]


class FatigueSafety(BarPeak):
    """Minimum of 1 / (amplitude / S_e + mean / S_m) over all points of the bars and their eyes."""

    def criteria(self, mechanism: Mechanism) -> Criteria:
        """Return the criteria for amplitude and mean as maximum and minimum stress, and for the amplitude alone."""
        strength = material_and_pins(mechanism)
        worn, steady = 0.5 / strength.material.endurance, 0.5 / strength.mean_stress_reference_strength
        return ((worn + steady, worn - steady), (worn, worn))

    def section_loads(self, mechanism: Mechanism) -> list[SectionLoad]:
        """Return the stress in each bar and in each eye; see `BarPeak`."""
        bars = self.links_with_bars(mechanism)
        eyes = [eye for name in bars for pin in (NEAR, LINKS[name].far) for eye in critical_eye_edges(name, pin)]
        bodies = [SectionLoad(LinkBody(LINKS[name].part), None) for name in bars]
        return [*bodies, *(SectionLoad(eye, net_width_formula(eye)) for eye in eyes)]


class BucklingSafety(BarPeak):
    """Critical stress divided by the maximum compression: minimum over bars and planes."""

    def criteria(self, mechanism: Mechanism) -> Criteria:
        """Return the criterion for maximum compression."""
        return ((0.0, 1.0),)

    def stress_locations(self, mechanism: Mechanism) -> tuple[StressLocation, ...]:
        """Return each bar as a location, which both planes share."""
        return tuple(LinkBody(LINKS[name].part, bent=False) for name in self.links_with_bars(mechanism))

    def section_loads(self, mechanism: Mechanism) -> list[SectionLoad]:
        """Return the compression of each bar for buckling in the plane of motion and out of it; see `BarPeak`."""
        material = material_and_pins(mechanism).material
        return [
            SectionLoad(
                LinkBody(own.part, bent=False),
                critical_stress_formula(
                    own.length, side, own.end_condition, material.elasticity, material.yield_strength
                ),
            )
            for own in (LINKS[name] for name in self.links_with_bars(mechanism))
            for side in (own.width, own.depth)
        ]


def critical_stress_formula(
    length: int, side: int, end_condition: float, elasticity: float, strength: float
) -> Formula:
    """Return the formula for the mean stress at which a bar with rectangular section buckles, Pa.

    With the slenderness s = L sqrt(12) / side and s_1 = sqrt(2 pi^2 C E / S_y): Euler's C pi^2 E / s^2 above s_1,
    Johnson's parabola S_y - (S_y s / 2 pi)^2 / (C E) up to it; values and slopes match there, at S_y / 2. Hence it is C
    pi^2 E / max(s, s_1)^2 plus the rise of the parabola from s_1 to min(s, s_1). length, side: slots of the raw
    numbers. end_condition: the end condition C.
    """
    euler = end_condition * math.pi**2 * elasticity
    limit = 2.0 * euler / strength

    def formula(number: Any) -> Any:
        square = (number(length) * math.sqrt(12.0) / number(side)) ** 2
        beyond = 0.5 * (square - limit + magnitude(square - limit))
        return euler / (limit + beyond) + (strength**2 / (4.0 * euler)) * (limit + beyond - square)

    return formula


_SOURCE = "Shigley, Mechanical Engineering Design, 9th ed., sec. 3-10 and 3-13; section forces derived there"
_stress = partial(
    LinkStress,
    kind=PRESSURE,
    source=_SOURCE,
    example="120 MPa",
)
ROD_STRESS = _stress(
    name="rod_stress",
    links=("rod",),
    place=440,
    sentence=(
        "The greatest stress in the rod over a turn, of either sign: from axial force and bending by inertia and "
        "weight along the rod, and in the net section of both eyes."
    ),
    advice="A wider rod reduces it until the rod's own inertia increases the bending.",
    formula="max of |N / (w d) +- 6 M / (d w^2)| and K F / ((w - D) d) over place and crank angle",
    picture="rod",
    needs=(STRENGTH, EVEN_SPEED, ROD_BAR, LOADED),
)
CRANK_STRESS = replace(
    ROD_STRESS,
    name="crank_stress",
    title="crank stress",
    links=("crank",),
    place=442,
    sentence=(
        "The greatest stress in the crank over a turn, of either sign: from axial force and bending by the crank "
        "pin force along the crank, and in the net section of both eyes. The eye at the pivot also carries the "
        "torque, through a key or tight fit."
    ),
    advice="With a large torque, the eye at the pivot governs: widen the crank, or use a thinner shaft.",
    formula=(
        "max of |N / (w d) +- 6 M / (d w^2)|, K F / ((w - D) d), and at the pivot |N / ((w - D) d) +- 6 w M / "
        "(d (w^3 - D^3))| and |K N / ((w - D) d) +- min(K, 2) 6 D M / (d (w^3 - D^3))| over place and crank angle"
    ),
    picture="crank",
    needs=(STRENGTH, EVEN_SPEED, CRANK_BAR, LOADED),
)
STATIC_SAFETY = LinkStress(
    name="static_safety",
    kind=RATIO,
    least=True,
    place=444,
    sentence="The yield strength divided by the greatest stress in the links given by their sections.",
    advice="1.5 to 3 are usual, more if the loads are uncertain. It is negative if a pin is wider than its bar.",
    formula="S_y / max(crank stress, rod stress)",
    source=_SOURCE,
    picture="rod",
    example=2.0,
    better="high",
    allowed_by="yield strength of the material",
    signed=True,
    needs=(STRENGTH, EVEN_SPEED, A_BAR, LOADED),
)
FATIGUE_SAFETY = FatigueSafety(
    name="fatigue_safety",
    kind=RATIO,
    least=True,
    place=446,
    sentence=(
        "The factor by which all stresses could grow before the worst point of crank and rod fails by fatigue. "
        "Amplitude and mean are those of the stress at this point over the cycle, with the stress concentration in "
        "the eyes."
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
    needs=(STRENGTH, EVEN_SPEED, A_BAR, LOADED),
)
BUCKLING_SAFETY = BucklingSafety(
    name="buckling_safety",
    kind=RATIO,
    least=True,
    place=448,
    sentence=(
        "The buckling load of a bar divided by its greatest compression, in the plane of motion and out of it: "
        "Euler's load for a slender bar, Johnson's for a short one. It is infinite if no bar is compressed."
    ),
    advice="3 or more is usual. A rod with a square section is equally safe in both planes.",
    formula=(
        "P_cr / max(-N): C pi^2 E I / L^2 or Johnson's parabola; C = 1 for the rod in both planes, 1/4 for the crank"
    ),
    source="Shigley, Mechanical Engineering Design, 9th ed., sec. 4-12 and 4-13, table 4-2",
    picture="rod",
    example=3.0,
    better="high",
    allowed_by="load at which the bar buckles",
    endless="crank and rod are never compressed",
    needs=(STRENGTH, EVEN_SPEED, A_BAR, LOADED),
)
