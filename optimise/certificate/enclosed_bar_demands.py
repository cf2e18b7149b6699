"""Load-to-resistance ratios of bars and pins, enclosed over boxes of designs.

The greatest stress over the cycle is at least the stress at one point and angle. The greatest force on a pin is at
least its force at one angle. So stresses and pressures have lower bounds, and safety factors have upper bounds. The
point is a fraction of the bar's length, so it moves with the design. Where the section may vanish in a box, a safety
factor uses max(section, 0): a design without a section has no positive safety factor.
"""

from collections.abc import Callable
from functools import reduce
from itertools import product
from typing import Any

import numpy as np

from ...model.arrays import Array
from ...model.dynamics.torque import Forces
from ...model.kernel.arithmetic import magnitude
from ...model.kinematics.position import Motion
from ...model.machine.cylinders_and_turns import machines_of_turns, single_cylinder_machine
from ...model.machine.design import Design
from ...model.machine.mechanism import Mechanism
from ...model.machine.raw_machine_vector import Raw
from ...model.signals.signals import Signal
from ...model.strength.section_forces import ROD, stress_at_length_fraction, stress_coefficients_of_link
from ...model.strength.stress_cycle import stress_peaks
from ...model.strength.stress_locations import Eye, StressLocation, eye_stress_factor_formulas
from ...objectives.bar_pieces import FORCE, BarPeak, Criteria, SectionLoad
from .enclosed_cycle_curve import CycleCurve, machines_with_separate_peaks
from .enclosed_machine import Numbers, parameter_lookup
from .enclosure import Enclosure, join_parts


class StressCurve(CycleCurve):
    """Greatest p sigma - q sigma at a location over the cycle of a single crank; `stress_cycle` defines it.

    In a cycle of two turns, the stress at a crank angle counts in both: it is part of the cycle in either.
    """

    default_position = (1.0, 1.0, np.pi / 2.0, np.pi / 2.0)

    def __init__(self, mechanism: Mechanism, location: StressLocation, criteria: Criteria) -> None:
        super().__init__(mechanism, Signal.CRANK_PIN_FORCE)
        self.location, self.criteria = location, criteria
        self._curves = [CycleCurve(turn, Signal.CRANK_PIN_FORCE) for turn in machines_of_turns(mechanism)]

    def peak_positions(self, designs: Array) -> Array:
        """Return each design's critical point (n, 4): fraction of the length, side, and both crank angles, rad."""
        (peaks,) = stress_peaks(self.mechanism, (self.location,), designs, np.array(self.criteria), limit=1)
        return np.where(np.isfinite(peaks.places[:, 0]), peaks.places[:, 0], self.default_position)

    def enclose(self, numbers: Numbers, positions: Array, middle: Array) -> Enclosure:
        """Return the value (n, p) of each criterion at critical points (n, 4); see `CycleCurve.enclose`."""
        share, side, first, second = (positions[:, column : column + 1] for column in range(4))

        def stress_component(f: Forces, sine: Any, cosine: Any, m: Motion, d: Design) -> tuple[Any, Any]:
            return self._stress((sine, cosine, m, d, f), parameter_lookup(self.mechanism, numbers), share, side), 0.0

        def stresses(angles: Array) -> list[Enclosure]:
            return [
                stress
                for curve in self._curves
                for at in curve.angles_around_load_steps(numbers, angles, middle)
                for stress, _ in curve.sum_over_cylinders(numbers, at, middle, stress_component)
            ]

        highs = stresses(first) if any(p for p, _ in self.criteria) else []
        lows = stresses(second) if any(q for _, q in self.criteria) else []
        values: list[Enclosure] = []
        for p, q in self.criteria:
            if p and q:
                values += [high * p - low * q for high, low in product(highs, lows)]
            else:  # each criterion has its own angle; the point's other angle is not at a peak
                values += [high * p for high in highs] if p else [-low * q for low in lows]
        return reduce(join_parts, values)

    def _stress(
        self, state: tuple[Any, Any, Any, Any, Any], number: Callable[[int], Any], share: Array, side: Array
    ) -> Any:
        """Return the stress at the location; in an eye, times w - D.

        state: arguments of `stress_coefficients_of_link` up to forces.
        """
        location = self.location
        slot = Raw.ROD_WIDTH if location.part == ROD else Raw.CRANK_WIDTH
        c = stress_coefficients_of_link(location.part, *state, 0.0, (number(slot), number(slot + 1), number(slot + 2)))
        if not isinstance(location, Eye):
            return stress_at_length_fraction(c, side if location.bent else 0.0, share)
        axial, bending = eye_stress_factor_formulas(self.mechanism, location)
        end = 1.0 if location.far else 0.0
        stress = stress_at_length_fraction(c, 0.0, end) * axial(number)
        if location.bent:
            stress = (
                stress
                + stress_at_length_fraction(c._replace(n0=0.0, n1=0.0, n2=0.0), 1.0, end) * bending(number) * side
            )
        return stress


class DemandCurve:
    """One load demand: the greatest scale peak / section or, with `least`, the least scale section / peak."""

    def __init__(self, peak: CycleCurve, demand: SectionLoad, *, least: bool) -> None:
        self.peak, self.demand, self.least, self.default_position = peak, demand, least, peak.default_position

    def peak_positions(self, designs: Array) -> Array:
        """Return the position of each design's peak."""
        return self.peak.peak_positions(designs)

    def enclose(self, numbers: Numbers, positions: Array, middle: Array) -> Enclosure:
        """Return the value (n, p) at peak positions; NaN where the peak may not be positive."""
        peak, (_, section, scale, _) = self.peak.enclose(numbers, positions, middle), self.demand
        size: Any = 1.0 if section is None else section(parameter_lookup(self.peak.mechanism, numbers))
        value: Enclosure
        if self.least:
            size = 0.5 * (size + magnitude(size))
            rest = np.where(peak.least_and_greatest()[0] > 0.0, peak.rest, np.nan)
            value = size * scale / Enclosure(peak.centre, peak.slopes, rest, peak.empty)
        else:
            value = peak * scale / size
        return value


def demand_curves(mechanism: Mechanism, quantity: BarPeak) -> list[DemandCurve]:
    """Return the curves whose greatest or least value is the quantity."""
    single = single_cylinder_machine(mechanism)
    curves: list[DemandCurve] = []
    for demand in quantity.section_loads(mechanism):
        peaks: list[CycleCurve]
        if isinstance(demand.peak, str):
            signal = FORCE[demand.peak]
            peaks = [CycleCurve(machine, signal) for machine in machines_with_separate_peaks(mechanism, signal)]
        else:
            peaks = [StressCurve(single, demand.peak, quantity.criteria(mechanism))]
        curves += [DemandCurve(peak, demand, least=quantity.least) for peak in peaks]
    return curves
