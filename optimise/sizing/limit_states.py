"""Limit states of sections, each a posynomial in width w (in the plane of motion) and depth d.

With pin centre distance L, density rho, and the joints' loads of `section_loads` (N axial, V moment at the root, F on
pins), the own mass of a bar of width w adds at most

    rod:    N'  = rho d (w L^2 phi_t^2 / 8 + pi w^2 a_along / 8),
            M'  = rho d (w kappa + w^3 a_across / 12 + pi w^4 phi_tt / 128),
    crank:  N'  = rho d (w_t^2 s1 + g (w L + pi w^2 / 8)),
            M'  = rho d (g s1 + alpha s2),   s1 = w L^2 / 2 + pi w^2 L / 8 + w^3 / 12,
            s2 = w L^3 / 3 + pi w^2 L^2 / 8 + w^3 L / 6 + pi w^4 / 128,

counting kappa between the rod's pins, the half-discs of its round ends beyond them, and the crank from its far end to
the pivot; s1 and s2 are the first and second moment of its area about the pivot. Axial force and moment peak at
different crank angles, and the half-discs' parts at yet others, so adding the peaks is conservative. With C =
(compression + N') and u = n C / P, P = pi^2 E d w^3 / (12 K^2 L^2), a moment in a compressed bar increases by at most
the factor

    sec(pi sqrt(u) / 2) <= 1 + (4 / pi) u z,   z >= 1 / (1 - u)   written as   1 / z + u <= 1

(Timoshenko and Gere, "Theory of Elastic Stability", 2nd ed., ch. 1: the end couples' secant, and the cantilever as half
of that bar, K = 2). Each of these is at most one:

    static stress   n / S_y (N / (w d) + 6 M (1 + (4 / pi) u z) / (d w^2))
    fatigue         n (sigma_a / S_e + sigma_m / S_m) of the same stresses: amplitudes sigma_a and means sigma_m of the
                    joints' loads, with the effects of own mass and compression as amplitude; S_m = S_u (Goodman) or S_y
                    (Soderberg): Shigley, "Mechanical Engineering Design", 9th ed., eq. 6-46 and 6-45
    buckling        n C / P in the plane, and the same with w and d exchanged out of it: Shigley eq. 4-43 with the end
                    condition C = 1 of pinned ends, also out of the plane, where pins are stiffer; 1/4 for the crank, a
                    cantilever
    net section     n K F / (S_y (w - D) d), in the programme n K F / (S_y w d) + D / w, at each pin of diameter D, with
                    the stress concentration K of the eye; in fatigue K (F_a / S_e + F_m / S_m) of the axial load, own
                    mass as amplitude
    bent eye        at the crank's pivot, at the bore and at the outer edge, with B = min(K, 2) and 1, C = K and 1 and
                    y = D and w: n (C N / ((w - D) d) + 6 B M y / (d (w^3 - D^3))) / S_y, written as
                    n (C N (w^2 + w D + D^2) + 6 B M y) / (S_y d w^3) + (D / w)^3; in fatigue likewise
    bearing         F / (D d p), the pressure on the projected area of each pin

To treat amplitudes as peaks is safe because S_e <= S_m: for a sum of stresses with amplitudes A and means m, the
amplitude is at most sum A and the peak at most sum A + sum m, and a / S_e + m / S_m = a (1/S_e - 1/S_m) + (a + m) /
S_m. Other reductions in strength of the finished bar belong in S_e (Shigley eq. 6-18). Not considered: shear, the shape
of the eyes beyond their net section, pin bending, friction, out-of-plane bending.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from ...model.machine.mechanism import Material, Mechanism
from ..problem.tolerance_costs import SectionLimits
from .section_loads import JointLoads, Range, Whip

AMPLIFICATION = "amplification"
"""The state that defines z; it is not a limit."""
_SWELL = 4.0 / math.pi
_NOTHING = 1e-12  # relative to the greatest load: counts as no load, but has a logarithm
_TINY = 1e-30


Above = Callable[[Any], Any]
"""Replaces an expression by a variable that is at least as large, which keeps a programme's expressions short."""


def unchanged_expression(expression: Any) -> Any:
    """Return the expression."""
    return expression


@dataclass(frozen=True)
class BarLoads:
    """Loads on one bar, as numbers or posynomials in the sections. N, N m, and Pa^-1 N for fatigue.

    axial, compression, moment: peaks. fatigue_axial, fatigue_moment: amplitude / S_e + mean / S_m. The bar's own mass
    is included. pins: force and diameter by name. bent_eye: name of the pin whose eye carries the moment, or "" if
    there is none.
    """

    axial: Any
    compression: Any
    moment: Any
    fatigue_axial: Any
    fatigue_moment: Any
    pins: dict[str, tuple[Any, float]]
    bent_eye: str = ""

    def map_loads(self, above: Above) -> BarLoads:
        """Return the same loads with `above` applied to each that own mass increases."""
        return replace(
            self, **{name: above(load) for name, load in vars(self).items() if name not in ("pins", "bent_eye")}
        )


def limit_states(
    w: Any,
    d: Any,
    z: Any,
    buckling_length: float,
    loads: BarLoads,
    material: Material,
    limits: SectionLimits,
    above: Above = unchanged_expression,
) -> dict[str, Any]:
    """Return the utilisation of each limit state (1 is the limit), by name.

    buckling_length: in the plane, m. z: amplification. cvxpy expressions give posynomials. Numbers, with z None, give
    numbers: z is then at its minimum, infinite if the bar buckles, and for an eye the stress in its net section counts,
    for which a posynomial gives only the limit.
    """
    exact = z is None

    def eye_utilisation(stress: Any, hole: Any) -> Any:
        """Return the utilisation of an eye by the stress without its hole, and the fraction that the hole removes."""
        return stress / (1.0 - hole) if exact and hole < 1.0 else stress + hole

    static = limits.static_safety / material.yield_strength
    euler = 12.0 * buckling_length**2 / (math.pi**2 * material.elasticity) * loads.compression
    u = above(limits.static_safety * euler / (d * w**3))
    if z is None:
        z = 1.0 / (1.0 - u) if u < 1.0 else math.inf
    swell = above(_SWELL * u * z * loads.moment)
    fatigue = loads.fatigue_axial / (w * d) + 6.0 * (loads.fatigue_moment + swell / material.endurance) / (d * w**2)
    states = {
        AMPLIFICATION: 1.0 / z + u,
        "static stress": static * (loads.axial / (w * d) + 6.0 * (loads.moment + swell) / (d * w**2)),
        "fatigue": limits.fatigue_safety * fatigue,
        "buckling in the plane": limits.buckling_safety * euler / (d * w**3),
        "buckling out of the plane": limits.buckling_safety * euler / (w * d**3),
    }
    raised = limits.eye_concentration
    for name, (force, diameter) in loads.pins.items():
        states[f"net section at the {name}"] = eye_utilisation(static * raised * force / (w * d), diameter / w)
        tired = limits.fatigue_safety * raised * loads.fatigue_axial
        states[f"fatigue of the eye at the {name}"] = eye_utilisation(tired / (w * d), diameter / w)
        states[f"bearing at the {name}"] = force / (diameter * d * material.bearing_pressure)
    if loads.bent_eye:
        diameter = loads.pins[loads.bent_eye][1]
        rest = above(w**2 + diameter * w + diameter**2)
        moment, tiring = loads.moment + swell, loads.fatigue_moment + swell / material.endurance
        for edge, pulled, bent, lever in (("bore", raised, min(raised, 2.0), diameter), ("edge", 1.0, 1.0, w)):
            for kind, n, axial, turned in (
                ("", static, loads.axial, moment),
                ("fatigue of the ", limits.fatigue_safety, loads.fatigue_axial, tiring),
            ):
                stress = n * (pulled * axial * rest + 6.0 * bent * turned * lever) / (d * w**3)
                states[f"{kind}{edge} of the eye at the {loads.bent_eye}"] = eye_utilisation(
                    stress, (diameter / w) ** 3
                )
    states["least width"], states["greatest width"] = limits.width[0] / w, w / limits.width[1]
    states["least depth"], states["greatest depth"] = limits.depth[0] / d, d / limits.depth[1]
    return states


def rod_loads(
    w: Any, d: Any, length: float, joints: dict[str, Any], whip: Whip, material: Material, limits: SectionLimits
) -> BarLoads:
    """Return the loads on the rod, including its own mass."""
    rho, fatigue = material.density, 1.0 / material.endurance
    axial = (
        rho * d * (_above_zero(whip.spinning * length**2 / 8.0) * w + _above_zero(math.pi / 8.0 * whip.axial) * w**2)
    )
    moment = (
        rho
        * d
        * (
            _above_zero(whip.moment) * w
            + _above_zero(whip.lateral / 12.0) * w**3
            + _above_zero(math.pi / 128.0 * whip.turning) * w**4
        )
    )
    return BarLoads(
        axial=joints["rod"] + axial,
        compression=joints["rod compression"] + axial,
        moment=moment,
        fatigue_axial=joints["rod fatigue"] + fatigue * axial,
        fatigue_moment=fatigue * moment,
        pins={
            "crank pin": (joints["crank pin"], limits.crank_pin),
            "slider pin": (joints["slider pin"], limits.slider_pin),
        },
    )


def crank_loads(
    w: Any,
    d: Any,
    length: float,
    joints: dict[str, Any],
    mechanism: Mechanism,
    material: Material,
    limits: SectionLimits,
) -> BarLoads:
    """Return the loads on the crank at the pivot, including its own mass."""
    rho, fatigue, pull = material.density, 1.0 / material.endurance, math.hypot(*mechanism.gravity)
    first = length**2 / 2.0 * w + math.pi * length / 8.0 * w**2 + w**3 / 12.0
    second = length**3 / 3.0 * w + math.pi * length**2 / 8.0 * w**2 + length / 6.0 * w**3 + math.pi / 128.0 * w**4
    axial = (
        rho * d * (_above_zero(mechanism.speed**2) * first + _above_zero(pull) * (length * w + math.pi / 8.0 * w**2))
    )
    moment = rho * d * (_above_zero(pull) * first + _above_zero(abs(mechanism.acceleration)) * second)
    return BarLoads(
        axial=joints["crank"] + axial,
        compression=joints["crank compression"] + axial,
        moment=joints["bending"] + moment,
        fatigue_axial=joints["crank fatigue"] + fatigue * axial,
        fatigue_moment=joints["bending fatigue"] + fatigue * moment,
        pins={
            "pivot": (joints["crank pivot"], limits.crank_pivot),
            "crank pin": (joints["crank pin"], limits.crank_pin),
        },
        bent_eye="pivot",
    )


def joint_load_terms(joints: JointLoads, material: Material, limits: SectionLimits) -> dict[str, float]:
    """Return the joints' loads as terms of the limit states, all positive: N, N m, and those divided by Pa."""
    mean = material.ultimate_strength if limits.criterion == "goodman" else material.yield_strength

    def fatigue(load: Range) -> float:
        return load.amplitude / material.endurance + load.mean / mean

    terms = {
        "rod": joints.rod.greatest_magnitude,
        "rod compression": max(0.0, -joints.rod.least),
        "rod fatigue": fatigue(joints.rod),
        "crank": joints.crank.greatest_magnitude,
        "crank compression": max(0.0, -joints.crank.least),
        "crank fatigue": fatigue(joints.crank),
        "bending": joints.bending.greatest_magnitude,
        "bending fatigue": fatigue(joints.bending),
        "crank pivot": joints.crank_pivot,
        "crank pin": joints.crank_pin,
        "slider pin": joints.slider_pin,
    }
    least = _NOTHING * max(terms.values())
    floors = {name: least / material.endurance if name.endswith("fatigue") else least for name in terms}
    return {name: _above_zero(max(value, floors[name])) for name, value in terms.items()}


def _above_zero(value: float) -> float:
    """Return a coefficient that a posynomial may have: above zero."""
    return max(value, _TINY)
