"""Loads on the crank and the rod over the cycle, from joints and own mass. Frictionless pins, rigid links.

Joint forces come from the inverse dynamics of the whole machine with these sections, so they increase with the
sections. The rod's moment comes from its own mass alone (inertia whip and weight), because pins without friction carry
none. For end accelerations a, b across the rod (less gravity), the load per length of a uniform bar with mass m' per
length is linear, and the moment of the bar on two supports at the fraction x of its length L is

    M(x) = -m' L^2 / 6 (a x (1 - x)(2 - x) + b x (1 - x)(1 + x))

(a uniform and a triangular load on a simple beam, superposed).
"""

from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array
from ...model.cycle.cycle import breakpoints, cycle
from ...model.linkage.linkage import Linkage
from ...model.machine.cylinders_and_turns import cycle_turns
from ...model.machine.mechanism import Mechanism
from ...model.signals.peaks import find_peaks
from ...model.signals.signals import Signal

_ANGLES = 2880  # samples per turn: a peak of the n-th harmonic is low by (n pi / 2880)^2 / 2 = 6e-7 n^2
_STATIONS = 257  # stations along the rod: the moment between two is higher by 8e-6 of it
_ASIDE = 1e-9  # rad, to both sides of a jump


@dataclass(frozen=True)
class Range:
    """Range of a quantity over the cycle, SI: its least and greatest value."""

    least: float
    greatest: float

    @property
    def amplitude(self) -> float:
        """Half the range."""
        return 0.5 * (self.greatest - self.least)

    @property
    def mean(self) -> float:
        """Magnitude of the middle of the range."""
        return 0.5 * abs(self.greatest + self.least)

    @property
    def greatest_magnitude(self) -> float:
        """The greatest size."""
        return max(self.greatest, -self.least, 0.0)


@dataclass(frozen=True)
class JointLoads:
    """Loads from the joints on the links, N and N m, tension positive.

    rod, crank: axial force. bending: moment at the pivot from the crank pin's force, in the crank. crank_pivot,
    crank_pin, slider_pin: greatest forces on the pins.
    """

    rod: Range
    crank: Range
    bending: Range
    crank_pivot: float
    crank_pin: float
    slider_pin: float


@dataclass(frozen=True)
class Whip:
    """Greatest accelerations of the rod over the cycle, less gravity, as they act on its own mass.

    moment: |M| / m' between the pins, m^3/s^2. across, along: accelerations of the pin centres, m/s^2. turning: angular
    acceleration, rad/s^2. spinning: square of the angular speed, 1/s^2.
    """

    moment: float
    lateral: float
    axial: float
    turning: float
    spinning: float


def joint_loads(mechanism: Mechanism, linkage: Linkage) -> JointLoads:
    """Return the joints' loads on the links; pin forces are exact to machine precision, the others sampled."""
    cuts = breakpoints(mechanism, linkage)
    even = np.arange(_ANGLES * cycle_turns(mechanism)) * (2.0 * np.pi / _ANGLES)
    angles = np.concatenate([even, cuts - _ASIDE, cuts + _ASIDE])
    curves = cycle(mechanism, linkage, angles)
    motion = linkage.at(angles)
    pin = np.stack([curves.crank_pin_x, curves.crank_pin_y])  # force of the crank on the rod
    end = np.stack([curves.slider_pin_x, curves.slider_pin_y])  # force of the rod on the slider
    rod = np.stack([np.cos(motion.rod_angle), np.sin(motion.rod_angle)])
    crank = np.stack([np.cos(angles), np.sin(angles)])
    across = np.stack([-crank[1], crank[0]])
    axial = -np.concatenate([(pin * rod).sum(axis=0), (end * rod).sum(axis=0)])
    dimensions = np.array([[linkage.crank, linkage.rod, linkage.offset]], dtype=np.float64)
    pivot, crank_pin, slider_pin = (
        float(find_peaks(mechanism, signal, dimensions, limit=1).values[0, 0])
        for signal in (Signal.PIVOT_FORCE, Signal.CRANK_PIN_FORCE, Signal.SLIDER_PIN_FORCE)
    )
    return JointLoads(
        rod=_range_of(axial),
        crank=_range_of(-(pin * crank).sum(axis=0)),
        bending=_range_of(-float(linkage.crank) * (pin * across).sum(axis=0)),
        crank_pivot=pivot,
        crank_pin=crank_pin,
        slider_pin=slider_pin,
    )


def greatest_rod_accelerations(mechanism: Mechanism, linkage: Linkage) -> Whip:
    """Return the greatest accelerations of the rod; they do not depend on any mass."""
    angles = np.arange(_ANGLES) * (2.0 * np.pi / _ANGLES)
    motion = linkage.at(angles, speed=mechanism.speed, acceleration=mechanism.acceleration)
    axis = np.stack([np.cos(motion.rod_angle), np.sin(motion.rod_angle)], axis=-1)
    normal = np.stack([-axis[:, 1], axis[:, 0]], axis=-1)
    ends = []
    for place in (0.0, float(linkage.rod)):
        point = linkage.rod_point(angles, along=place, speed=mechanism.speed, acceleration=mechanism.acceleration)
        ends.append(point.acceleration - np.asarray(mechanism.gravity))
    lateral = np.stack([(end * normal).sum(axis=1) for end in ends])
    axial = np.stack([(end * axis).sum(axis=1) for end in ends])
    share = np.linspace(0.0, 1.0, _STATIONS)
    shapes = np.stack([share * (1.0 - share) * (2.0 - share), share * (1.0 - share) * (1.0 + share)])
    return Whip(
        moment=float(np.abs(lateral.T @ shapes).max() * float(linkage.rod) ** 2 / 6.0),
        lateral=float(np.abs(lateral).max()),
        axial=float(np.abs(axial).max()),
        turning=float(np.abs(motion.rod_acceleration).max()),
        spinning=float((motion.rod_velocity**2).max()),
    )


def _range_of(values: Array) -> Range:
    return Range(float(values.min()), float(values.max()))
