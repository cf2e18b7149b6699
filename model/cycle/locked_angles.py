"""Crank angles at which friction locks a linkage, and whether its loads can move it there (`self_locking`)."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..dynamics.torque import Balance, balance_before_pin_force
from ..kinematics.position import motion
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.design import DESIGN, LOAD_ROWS, Design, derive_design, design_at
from ..machine.links_and_joints import Friction
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import load_structure, raw_vector
from .cycle import cycle
from .self_locking import locking_margin

_SAMPLES = 256  # samples in about a quarter of the cycle


@dataclass(frozen=True)
class Verdict:
    """Whether friction locks a linkage. margin: rad, -inf if the pins alone lock it.

    locked: crank angles (from, to), rad, where it locks or may jam; the second is up to a turn ahead of the first.
    holds: fraction of the `locked` angles, 0 to 1, at which no torque drives the machine under its loads; at the others
    it may jam. None if it never locks.
    """

    margin: float
    locked: tuple[tuple[float, float], ...]
    holds: float | None

    @property
    def locks(self) -> bool:
        """Whether there are any locked angles."""
        return not self.margin > 0.0


def locking_verdict(mechanism: Mechanism, linkage: Linkage) -> Verdict:
    """Return whether friction locks one fully rotating linkage, and where."""
    linkage = require_single_rotating_linkage(mechanism, linkage)
    margin = float(locking_margin(mechanism.friction, np.array([_float_dimensions(linkage)]))[0][0])
    if margin > 0.0:
        return Verdict(margin, (), None)
    cuts = sorted({0.5 * np.pi, 1.5 * np.pi, *map(float, linkage.dead_centre_angles)})
    spans: list[tuple[float, float]] = []
    for a, b in pairwise([*cuts, cuts[0] + 2.0 * np.pi]):
        spans += _locked_spans(mechanism.friction, linkage, a, b)
    joined = _merge_spans(spans)
    inner_angles = np.concatenate([np.linspace(a, b, 66)[1:-1] for a, b in joined]) if joined else np.empty(0)
    if not len(inner_angles):
        return Verdict(margin, joined, None)
    states = locking_states(mechanism, linkage, inner_angles)
    return Verdict(margin, joined, float(np.mean(states == "locks")))


def locking_states(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> NDArray[np.str_]:
    """Return whether one linkage "drives", "locks" or "may jam" under its loads at each crank angle (n,), rad."""
    linkage = require_single_rotating_linkage(mechanism, linkage)
    angles = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    design = _derived_design(mechanism, linkage)
    loads = cycle(mechanism, linkage, angles).load
    states = []
    for theta, load, excess in zip(
        angles, loads, _margin_against_locking(mechanism.friction, linkage, angles), strict=True
    ):
        if excess > 0.0:
            states.append("drives")
        else:
            states.append("may jam" if _has_equilibrium_in_between(design, float(theta), float(load)) else "locks")
    return np.array(states, dtype=np.str_)


def _float_dimensions(linkage: Linkage) -> tuple[float, float, float]:
    return float(linkage.crank), float(linkage.rod), float(linkage.offset)


def _derived_design(mechanism: Mechanism, linkage: Linkage) -> Design:
    raw, loads = raw_vector(mechanism)[:, None], load_structure(mechanism)
    raw[:3, 0] = _float_dimensions(linkage)
    block = np.empty((DESIGN + LOAD_ROWS * len(loads.kind), 1))
    derive_design(raw, loads.kind, loads.datum, block)
    design: Design = design_at(block, 0)
    return design


def _margin_against_locking(friction: Friction, linkage: Linkage, theta: Any, probe: Any = None) -> Any:
    """Return |along| - |D| at crank angles, with the signs at the angles `probe` within the segment."""
    probe = theta if probe is None else probe
    arguments = (linkage.crank, linkage.rod, linkage.offset, linkage.sign)
    m, signs = (motion(np.sin(angle), np.cos(angle), *arguments) for angle in (theta, probe))
    q = np.sqrt(1.0 + friction.guide**2)
    pins = q * (
        friction.slider_pin.friction_circle_radius * np.sign(signs.rod_1) - friction.crank_pin.friction_circle_radius
    )
    return np.abs(m.l_cos) - np.abs(pins - friction.guide * m.l_sin * np.sign(signs.x_1))


def _locked_spans(friction: Friction, linkage: Linkage, a: float, b: float) -> list[tuple[float, float]]:
    """Return the spans within a segment where |D| >= |along|."""
    middle = a + 0.382 * (b - a)

    def excess(theta: Any) -> Any:
        return _margin_against_locking(friction, linkage, theta, middle)

    from scipy.optimize import brentq

    theta = a + (b - a) * 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, _SAMPLES)))
    values = excess(theta)
    edges = [a]
    for left, right, f, g in zip(theta[:-1], theta[1:], values[:-1], values[1:], strict=True):
        if f * g < 0.0:
            edges.append(float(brentq(excess, left, right, xtol=1e-14)))
    edges.append(b)
    return [(p, q) for p, q in pairwise(edges) if excess(0.5 * (p + q)) <= 0.0]


def _merge_spans(spans: list[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Return spans in ascending order, merging adjacent ones, also across the end of the turn."""
    joined: list[tuple[float, float]] = []
    for a, b in spans:
        if joined and a - joined[-1][1] < 1e-12:
            joined[-1] = (joined[-1][0], b)
        else:
            joined.append((a, b))
    if len(joined) > 1 and joined[0][0] + 2.0 * np.pi - joined[-1][1] < 1e-12:
        joined[-1] = (joined[-1][0], joined[0][1] + 2.0 * np.pi)
        del joined[0]
    return tuple(joined)


def _has_equilibrium_in_between(d: Design, theta: float, load: float) -> bool:
    """Return whether h crosses zero in between although both its ends have the same sign."""
    sine, cosine = np.sin(theta), np.cos(theta)
    m = motion(sine, cosine, d.r, d.l, d.e, d.branch)
    b: Balance = balance_before_pin_force(sine, cosine, m, d, load)
    turn = 1.0 if d.speed >= 0.0 else -1.0
    slide, swing = np.sign(m.x_1 * turn), np.sign(m.rod_1 * turn)
    weight = d.slider_mass * d.gravity_y

    def h(y: Any) -> Any:
        bx = b.pull + d.guide_friction * slide * np.abs(y + weight)
        pins = d.slider_pin_circle * swing * np.hypot(bx, y)
        pins = pins - d.crank_pin_circle * turn * np.hypot(bx + b.rod_x, y + b.rod_y)
        return m.l_cos * y - m.l_sin * bx + b.moment + pins

    size = abs(b.pull) + abs(weight) + abs(b.moment * m.per_l_cos) + np.hypot(b.rod_x, b.rod_y)
    if size == 0.0:
        return True  # no load acts: all forces are zero
    largest = 1e6 * size
    upward = 1.0 if h(largest) > 0.0 else -1.0
    steps = np.concatenate([[0.0], np.geomspace(1e-9 * size, largest, 400)])
    from scipy.optimize import minimize_scalar

    for side in (-1.0, 1.0):
        values = upward * h(-weight + side * steps)
        at = int(np.argmin(values))
        if values[at] <= 0.0:
            return True
        ends = steps[max(at - 1, 0)], steps[min(at + 1, len(steps) - 1)]
        if minimize_scalar(lambda u, s=side: upward * h(-weight + s * u), bounds=ends, method="bounded").fun <= 0.0:
            return True
    return False
