"""The moving bodies of a machine as mass points with an inertia, their positions analytic functions of crank angle."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from slidercrank.model.machine.mechanism import Mechanism
from tests.model.cases import Array
from tests.model.virtual_work import body


@dataclass(frozen=True)
class MassPoint:
    """A body: mass, inertia, mass centre as complex x and y of a complex angle, and its own angle."""

    mass: float
    inertia: float
    x: Any
    y: Any
    turn: Any


def bodies(machine: Mechanism, design: Array) -> dict[str, MassPoint]:
    """Return crank, counterweight, rod and slider; positions run on complex crank angles."""
    r, l, e = design
    sign = 1.0 if machine.branch == "open" else -1.0
    crank, rod, weight = body(machine.crank, r), body(machine.rod, l), machine.counterweight

    def phi(theta: Any) -> Any:
        angle = np.arcsin((e - r * np.sin(theta)) / l)
        return angle if sign > 0.0 else math.pi - angle

    def on(start: float, along: float, across: float, angle: Any) -> tuple[Any, Any]:
        return (
            lambda t: start * np.cos(t) + along * np.cos(angle(t)) - across * np.sin(angle(t)),
            lambda t: start * np.sin(t) + along * np.sin(angle(t)) + across * np.cos(angle(t)),
        )

    def theta_itself(theta: Any) -> Any:
        return theta

    arm, lead = weight.radius, weight.angle
    return {
        "crank": MassPoint(crank.mass, crank.inertia, *on(0.0, crank.along, crank.across, theta_itself), theta_itself),
        "weight": MassPoint(
            weight.mass,
            weight.inertia,
            *on(0.0, arm * math.cos(lead), arm * math.sin(lead), theta_itself),
            theta_itself,
        ),
        "rod": MassPoint(rod.mass, rod.inertia, *on(r, rod.along, rod.across, phi), phi),
        "slider": MassPoint(machine.slider_mass, 0.0, *on(r, l, 0.0, phi), theta_itself),
    }
