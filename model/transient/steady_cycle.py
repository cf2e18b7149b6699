"""One cycle of steady running (one or two turns), solved as a boundary-value problem by collocation.

With the crank angle as the variable and E = w^2 / 2, the equation of motion

    dE / d(theta) = (T_motor - C - D w - J' E) / J,        E(theta + turn) = E(theta),

is regular even where the crank nearly stops. The turn is divided into panels at the breakpoints and more finely; on
each, dE is a polynomial through the Gauss-Legendre nodes (a Gauss method; Hairer, Norsett and Wanner, Solving Ordinary
Differential Equations I, 2nd ed. 1993, II.7). Newton's method is direct: each linearised panel maps one number, E at
its start, to E at its end, and the chained maps close the turn.

Where the crank nearly stops, the time per angle, 1 / sqrt(2 E), rises steeply. Panels are halved if their last Legendre
coefficients have not died out, neither at the nodes nor in the integral over the turn; the turn is then solved again.
The integral matters if a load changes over a tiny distance: the rounding error of the slider position then changes the
load considerably, and halving does not reduce it. With friction, panels also end where a guide force changes sides.
These angles depend on the motion, so the turn is solved again until they settle.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.polynomial import legendre

from ..arrays import Array, Mask
from ..dynamics.segments import crank_angle_from_crowded, crowded_from_crank_angle, crowding_parameter
from ..errors import InputError
from ..quadrature import DEGREE, FIT, INTEGRALS, INTEGRATED, NODES, WEIGHTS, last_coefficients_magnitude
from .crank_equation import TURN, Equation, Span, Terms
from .guide_force_changes import crank_angles_of_guide_side_changes

_PANELS = 40
_STEPS = 60
_EXACT = 1e-13
_RESOLVED = 1e-11  # maximum of the last coefficients on a resolved panel, relative to the maximum value
_NEGLIGIBLE = 1e-13  # error of one panel as a fraction of the integral over the turn: a smaller one is a rounding error
_MOST = 4_000  # panels that halving may add: each needs a few matrices of 2 kB
_HALVINGS = 24  # a panel of 1e-8 rad: a crank that becomes slower than 1e-8 of its maximum speed stops
_MOVES = 12  # maximum number of times that panels are moved to where guides change sides
_MOVED = 1e-9  # rad; a kink closer to a panel's end than its first node causes an error of the square of this

Torque = Callable[[Array], tuple[Array, Array]]
"""Torque on the crank, N m, and its derivative with respect to speed, N m s, at crank speeds, rad/s, of any shape."""
Guess = tuple[Array, Array, float]
"""E at the nodes, (panels, nodes), and at the panels' starts, (panels,); a torque added to the motor's, N m."""


@dataclass(frozen=True)
class Profile:
    """A solution: E, (panels, nodes), and at the panels' starts, (panels,); dE / d(theta) at the nodes.

    added: torque added to the motor's, N m. memory: fraction of a small change in E at the start that remains after a
    turn.
    """

    energy: Array
    start: Array
    rate: Array
    added: float
    memory: float


def _legendre_sum(series: Array, x: float) -> float:
    """Return the sum of a Legendre series by Clenshaw's recursion, like `legval` but faster, in plain numbers."""
    numbers: list[float] = series.tolist()
    before, last = numbers[-2:]
    for degree in range(len(numbers) - 1, 1, -1):
        share = (degree - 1) / degree
        before, last = numbers[degree - 2] - last * share, before + last * x * ((2 * degree - 1) / degree)
    return before + last * x


class PeriodicTurn:
    """Terms of the equation of motion at the nodes of a cycle, in passing order.

    angle: (panels, nodes). width: angle turned in each panel, (panels,), negative clockwise. low: start of each panel.
    cuts: additional crank angles at which panels end, rad; contacts: angles where a guide changes sides, ascending.
    spans: the parts of the cycle, each with its panels.
    """

    def __init__(
        self,
        equation: Equation,
        dimensions: tuple[float, float, float],
        cuts: tuple[float, ...] = (),
        contacts: tuple[float, ...] = (),
    ) -> None:
        self.equation, self.dimensions, self.cuts, self.contacts = equation, dimensions, cuts, contacts
        self.way = equation.direction
        kappa = crowding_parameter(*dimensions) if equation.crowds else 1.0
        low, width, angle, terms = [], [], [], []
        self.spans: list[tuple[Span, slice]] = []
        passed = 0
        for stretch in equation.spans_in_passing_order(self.way):
            first, last = crowded_from_crank_angle(stretch.low, kappa), crowded_from_crank_angle(stretch.high, kappa)
            count = max(2, math.ceil(_PANELS * (last - first) / TURN))
            ends = np.array([crank_angle_from_crowded(tau, kappa) for tau in np.linspace(first, last, count + 1)])
            ends[0], ends[-1] = stretch.low, stretch.high
            ends = np.union1d(ends, [cut for cut in cuts if stretch.low < cut < stretch.high])
            for contact in contacts:
                if np.abs(ends - contact).min() > _MOVED and stretch.low < contact < stretch.high:
                    ends = np.union1d(ends, contact)
            ends = ends if self.way > 0.0 else ends[::-1]
            at = ends[:-1, None] + np.diff(ends)[:, None] * NODES
            low.append(ends[:-1])
            width.append(np.diff(ends))
            angle.append(at)
            terms.append(stretch.terms_at(at.ravel()))
            self.spans.append((stretch, slice(passed, passed + len(at))))
            passed += len(at)
        self.low, self.width, self.angle = np.concatenate(low), np.concatenate(width), np.concatenate(angle)
        columns = zip(*((t.inertia, t.spin, t.static, t.drag, t.load, t.square) for t in terms), strict=True)
        self.terms = Terms(*(np.concatenate(column).reshape(self.angle.shape) for column in columns))

    def mean(self, values: Array) -> float:
        """Return the mean over the crank angle of values at the nodes."""
        return float(np.abs(self.width) @ (values @ WEIGHTS)) / self.equation.period

    def running_integral(self, values: Array) -> tuple[Array, Array]:
        """Return the integral over the crank angle from the start of the turn: at the panels' starts and the nodes."""
        panels = self.width * (values @ WEIGHTS)
        starts = np.concatenate([[0.0], np.cumsum(panels)[:-1]])
        return starts, starts[:, None] + self.width[:, None] * (values @ INTEGRALS.T)

    def zero_crossings(self, values: Array) -> list[tuple[int, float, bool]]:
        """Return where values at the nodes cross zero: panel, position from 0 to 1, and whether they rise."""
        from scipy.optimize import brentq

        first, last = self.panel_edge_values(values).T
        at, known = np.concatenate([[-1.0], 2.0 * NODES - 1.0, [1.0]]), np.column_stack([first, values, last])
        found = []
        for p, i in np.argwhere(known[:, :-1] * known[:, 1:] < 0.0).tolist():
            x = brentq(partial(_legendre_sum, FIT @ values[p]), at[i], at[i + 1], xtol=1e-15)
            found.append((p, 0.5 * (1.0 + float(x)), bool(known[p, i] < 0.0)))
        return found

    def panel_edge_values(self, values: Array) -> Array:
        """Return values at the nodes extrapolated to start and end of each panel, (panels, 2)."""
        edges: Array = values @ FIT.T @ legendre.legvander([-1.0, 1.0], DEGREE).T
        return edges

    def value_and_integral(self, values: Array, panel: int, place: float) -> tuple[float, float]:
        """Return values within a panel, at a position from 0 to 1, and their integral from its start."""
        series, x = FIT @ values[panel], 2.0 * float(place) - 1.0
        integral = float(self.width[panel]) * _legendre_sum(INTEGRATED @ series, x)
        return _legendre_sum(series, x), integral

    def energy_slope_and_derivative(self, energy: Array, motor: Torque, inertia: float) -> tuple[Array, Array]:
        """Return dE / d(theta) and its derivative with respect to E."""
        t, speed = self.terms, self.way * np.sqrt(2.0 * energy)
        torque, slope = motor(speed)
        total = t.inertia + inertia
        return (torque - t.required_torque(speed, 0.0)) / total, (
            (slope - t.drag) / speed - 2.0 * (t.spin + t.square)
        ) / total

    def energy_slope_and_derivatives(
        self, energy: Array, motor: Torque, inertia: float, added: float
    ) -> tuple[Array, Array, Array]:
        """Return dE / d(theta) with the torque `added`, N m, and its derivatives with respect to both."""
        rate, by_energy = self.energy_slope_and_derivative(energy, motor, inertia)
        by_torque = 1.0 / (self.terms.inertia + inertia)
        rate = rate + added * by_torque
        if self.equation.rubs:
            speed = self.way * np.sqrt(2.0 * energy)
            torque, slope = motor(speed)
            for span, panels in self.spans:
                angles, speeds, torques, guess = (
                    values[panels].ravel() for values in (self.angle, speed, torque + added, rate)
                )
                accelerations, state = span.solve_acceleration(angles, speeds, torques, inertia, guess, by_speed=True)
                share = 1.0 / (state.by_acceleration + inertia)
                by_speed = (slope[panels].ravel() - state.by_speed) * share
                for column, values in ((rate, accelerations), (by_torque, share), (by_energy, by_speed / speeds)):
                    column[panels] = values.reshape(column[panels].shape)
        return rate, by_energy, by_torque

    @property
    def depends_on_speed(self) -> bool:
        """Whether a load, or friction, depends on the motion of the crank."""
        return self.equation.rubs or self.terms.depends_on_speed

    def friction_torque(self, speed: Array, rate: Array | float) -> Array:
        """Return the torque at the nodes, N m, that friction adds at speeds, rad/s, and accelerations, rad/s^2."""
        torque = np.zeros(self.angle.shape)
        if not self.equation.rubs:
            return torque
        speed, rate = np.broadcast_to(speed, torque.shape), np.broadcast_to(rate, torque.shape)
        for span, panels in self.spans:
            state = span.friction_state(*(values[panels].ravel() for values in (self.angle, speed, rate)))
            torque[panels] = state.torque.reshape(torque[panels].shape)
        frictionless: Array = self.terms.required_torque(speed, rate)
        return torque - frictionless

    def with_panels_at_contact_changes(self, speed: float) -> PeriodicTurn:
        """Return the turn with panels that end where guides change sides at a constant speed.

        speed: its magnitude, rad/s.
        """
        energy, start, rate = self.constant_speed_guess(speed)
        return (
            self.panels_moved_to_contact_changes(energy, start, np.full(energy.shape, rate))
            if self.equation.rubs
            else None
        ) or self

    def constant_speed_guess(self, speed: float) -> Guess:
        """Return the first guess: a constant speed of this magnitude, rad/s."""
        return np.full(self.angle.shape, 0.5 * speed**2), np.full(len(self.width), 0.5 * speed**2), 0.0

    def solve_on_fine_panels(
        self,
        motor: Torque,
        inertia: float,
        guess: Callable[[PeriodicTurn], Guess | None],
        *,
        mean_speed: float | None = None,
    ) -> tuple[PeriodicTurn, Profile] | None:
        """Return the periodic turn on sufficiently fine panels; None if no turn without a stop is found.

        guess: start of Newton's method for a turn; None ends the search. Other arguments: see `solve`. Raises
        `InputError` if the motion is still not resolved after halving has added `_MOST` panels.
        """
        turn, moves = self, _MOVES if self.equation.rubs else 0
        for _ in range(_HALVINGS + moves):
            first = guess(turn)
            profile = None if first is None else turn.solve(motor, inertia, first, mean_speed=mean_speed)
            if profile is None:
                return None
            if (
                moves
                and (moved := turn.panels_moved_to_contact_changes(profile.energy, profile.start, profile.rate))
                is not None
            ):
                turn, moves = moved, moves - 1
                continue
            rough = turn._unresolved_panels(1.0 / np.sqrt(profile.energy)) | turn._unresolved_panels(profile.rate)
            if not rough.any():
                return turn, profile
            if len(turn.width) + rough.sum() > len(self.width) + _MOST:
                at = math.degrees(float(turn.low[rough][0])) % math.degrees(turn.equation.period)
                raise InputError(
                    f"steady running needs a motion smooth enough to resolve; got one that {len(turn.width):,} "
                    f"panels do not resolve, for example at a crank angle of {at:.6g} deg; smooth the load there, "
                    "or add a flywheel"
                )
            turn = turn.cut_at_angles(turn.low[rough] + 0.5 * turn.width[rough])
        return None

    def cut_at_angles(self, angles: Array) -> PeriodicTurn:
        """Return the same turn with panels that also end at additional crank angles, (n,), rad."""
        cuts = (*self.cuts, *(float(angle) for angle in angles))
        return PeriodicTurn(self.equation, self.dimensions, cuts, self.contacts)

    def panels_moved_to_contact_changes(self, energy: Array, start: Array, rate: Array) -> PeriodicTurn | None:
        """Return the turn with panels that end where guides change sides during a motion; None if they already do.

        energy, rate: E and its derivative at the nodes. start: E at the panels' starts.
        """
        contacts_found: list[float] = []
        ends = self.low + self.width
        for span, panels in self.spans:

            def motion(angle: float, panels: slice = panels) -> tuple[float, float]:
                p = panels.start + int(np.searchsorted(self.way * ends[panels][:-1], self.way * angle))
                value, gain = self.value_and_integral(rate, p, (angle - self.low[p]) / self.width[p])
                return self.way * math.sqrt(2.0 * (start[p] + gain)), value

            edges = float(self.low[panels.start]), float(ends[panels.stop - 1])
            (first, first_rate), (last, last_rate) = map(motion, edges)
            speeds = np.concatenate([[first], self.way * np.sqrt(2.0 * energy[panels].ravel()), [last]])
            rates = np.concatenate([[first_rate], rate[panels].ravel(), [last_rate]])
            angles = np.concatenate([edges[:1], self.angle[panels].ravel(), edges[1:]])
            contacts_found += crank_angles_of_guide_side_changes(span, motion, angles, speeds, rates)
        contacts_found.sort()
        contacts_before = self.contacts
        if (
            len(contacts_found) == len(contacts_before)
            and np.abs(np.subtract(contacts_found, contacts_before)).max(initial=0.0) < _MOVED
        ):
            return None
        return PeriodicTurn(self.equation, self.dimensions, self.cuts, tuple(contacts_found))

    def _unresolved_panels(self, values: Array) -> Mask:
        """Return the panels (panels,) on which neither the values nor their integral are resolved."""
        tail, size, width = last_coefficients_magnitude(values), np.abs(values), np.abs(self.width)
        negligible = tail * width <= _NEGLIGIBLE * float(width @ (size @ WEIGHTS))
        return np.asarray(~((tail <= _RESOLVED * size.max()) | negligible))

    def solve(self, motor: Torque, inertia: float, guess: Guess, *, mean_speed: float | None = None) -> Profile | None:
        """Return the periodic turn; None if no turn without a stop is found.

        inertia: inertia of the drive, kg m^2. guess: start of Newton's method. mean_speed: desired 2 pi / period,
        rad/s; if given, a constant torque is added to reach it.
        """
        energy, start, added = guess
        last = math.inf
        for _ in range(_STEPS):
            rate, by_energy, by_torque = self.energy_slope_and_derivatives(energy, motor, inertia, added)
            system = np.eye(DEGREE + 1) - self.width[:, None, None] * INTEGRALS * by_energy[:, None, :]
            integrals = self.width[:, None] * (np.stack([rate, by_torque]) @ INTEGRALS.T)
            sides = np.stack([start[:, None] + integrals[0] - energy, np.ones(energy.shape), integrals[1]], axis=-1)
            moved = np.linalg.solve(system, sides)  # E at the nodes: residual, by E at the start, by the torque
            passed = self.width[:, None] * np.einsum("n,pn,pnk->pk", WEIGHTS, by_energy, moved)
            jump = start + self.width * (rate @ WEIGHTS) - np.roll(start, -1) + passed[:, 0]
            chain = _energy_changes_at_panel_starts(
                jump, 1.0 + passed[:, 1], passed[:, 2] + self.width * (by_torque @ WEIGHTS)
            )
            (offset, by_start, by_added), memory = chain[-1], chain[-1][1]
            if mean_speed is None:
                change, torque_change = (offset / (1.0 - by_start) if by_start != 1.0 else math.inf), 0.0
            else:
                flow = np.abs(self.width)[:, None] * WEIGHTS * (2.0 * energy) ** -1.5
                maps = chain[:-1]
                nodes = moved[..., 0] + moved[..., 1] * maps[:, 0, None], moved[..., 1] * maps[:, 1, None]
                by_torque_too = moved[..., 2] + moved[..., 1] * maps[:, 2, None]
                period = float(np.sum(np.abs(self.width)[:, None] * WEIGHTS / np.sqrt(2.0 * energy)))
                matrix = [[1.0 - by_start, -by_added], [np.sum(flow * nodes[1]), np.sum(flow * by_torque_too)]]
                side = [offset, period - self.equation.period / abs(mean_speed) - np.sum(flow * nodes[0])]
                change, torque_change = (float(value) for value in np.linalg.solve(matrix, side))
            if not (math.isfinite(change) and math.isfinite(torque_change)):
                return None
            starts = chain[:-1, 0] + chain[:-1, 1] * change + chain[:-1, 2] * torque_change
            step = moved[..., 0] + moved[..., 1] * starts[:, None] + moved[..., 2] * torque_change
            share = min(1.0, 0.9 / max(float((-step / energy).max()), float((-starts / start).max()), 1e-300))
            energy, start, added = energy + share * step, start + share * starts, added + share * torque_change
            size = float(np.abs(step).max() / energy.max())
            if share == 1.0 and size < 1e-8 and (size < _EXACT or size >= 0.5 * last):
                rate = self.energy_slope_and_derivatives(energy, motor, inertia, added)[0]
                return Profile(energy, start, rate, added, float(memory))
            last = size
        return None


def _energy_changes_at_panel_starts(jump: Array, growth: Array, torque: Array) -> Array:
    """Return the change in E at each panel's start and at the end, (panels + 1, 3).

    Its constant part, its part due to the change at the first start, and its part due to the added torque.
    """
    chain = np.empty((len(jump) + 1, 3))
    chain[0] = 0.0, 1.0, 0.0
    for p in range(len(jump)):
        chain[p + 1] = growth[p] * chain[p]
        chain[p + 1, 0] += jump[p]
        chain[p + 1, 2] += torque[p]
    return chain
