"""A crank speed that repeats every turn, the mechanism's speed times a smooth function of the angle, and its time.

The speed of the mechanism is the mean over the crank angle. With w = speed p(theta), the crank's angular acceleration
is w dw/d(theta) = speed^2 p p'.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import legendre

from ..arrays import Array, Mask
from ..checks import require_all_finite, store_as_tuples
from ..errors import InputError
from ..quadrature import Samples, gauss_nodes_and_weights, legendre_fit_matrix, resolve_panels

_NODES = 20  # nodes in each panel
_TAIL = 2  # last coefficients of a series, which show whether it has converged
_CONVERGED = 1e-14  # relative size of the last coefficients of a converged series
_NOISE = 32.0 * np.finfo(np.float64).eps  # error of p; the error of 1 / p is p^-2 times this
_DEEPEST, _PANELS = 52, 200_000  # maximum halvings of a panel, and panels; then they are left as they are


@dataclass(frozen=True, eq=False)
class ElapsedTime:
    """Integral of 1 / p over the crank angle, rad: the time multiplied by the mean speed.

    Each panel of a turn has a Legendre series, refined until it converges to rounding. ends: panel ends (k + 1,), rad.
    series: coefficients (m, k) of the integral over each panel. up_to_ends: integral (k + 1,) up to each end.
    """

    ends: Array
    series: Array
    up_to_ends: Array

    @classmethod
    def integrate(cls, ratio: Callable[[Array], Array], ends: Array) -> ElapsedTime:
        """Integrate 1 / p for a ratio p > 0. ends: increasing crank angles in a turn, rad; p is analytic in between."""
        nodes, basis = gauss_nodes_and_weights(_NODES)[0], legendre_fit_matrix(_NODES).T

        def sample(low: Array, width: Array) -> Samples:
            values = 1.0 / ratio(low[:, None] + width[:, None] * nodes)
            coefficients = values @ basis
            tail = np.abs(coefficients[:, -_TAIL:]).sum(axis=1)
            rough: Mask = ~(tail <= _CONVERGED * coefficients[:, 0] + _NOISE * values.max(axis=1) ** 2)
            return rough, [0.5 * width[:, None] * coefficients]

        start, _, parts = resolve_panels(sample, ends[:-1], np.diff(ends), deepest=_DEEPEST, limit=_PANELS)
        order = np.argsort(start)
        integrals = legendre.legint(parts[order].T, lbnd=-1.0)
        series = np.asarray(integrals, dtype=np.float64)
        panel_integrals = np.asarray(legendre.legval(1.0, series), dtype=np.float64)
        panels = np.append(start[order], ends[-1])
        return cls(np.asarray(panels, dtype=np.float64), series, np.concatenate([[0.0], np.cumsum(panel_integrals)]))

    @property
    def elapsed_over_full_turn(self) -> float:
        """Integral over a turn."""
        return float(self.up_to_ends[-1])

    def elapsed_up_to(self, crank_angle: Array) -> Array:
        """Return the integral from the start of the first panel up to crank angles, rad, over any number of turns."""
        turns = np.floor((crank_angle - self.ends[0]) / _TURN)
        angle_in_turn = crank_angle - turns * _TURN
        panel = np.clip(np.searchsorted(self.ends, angle_in_turn, side="right") - 1, 0, len(self.ends) - 2)
        low, high = self.ends[panel], self.ends[panel + 1]
        x = np.clip(2.0 * (angle_in_turn - low) / (high - low) - 1.0, -1.0, 1.0)
        within_panel = legendre.legval(x, self.series[:, panel], tensor=False)
        return np.asarray(turns * self.elapsed_over_full_turn + self.up_to_ends[panel] + within_panel)


_RPM = 30.0 / math.pi
_TURN = 2.0 * math.pi
_MOST = 100  # harmonics
_LEAST = 4  # minimum number of points in a table
_SAMPLES = 64  # fraction of the highest harmonic's period
_CLOSED = 1e-9  # rad


@dataclass(frozen=True, kw_only=True)
class Harmonics:
    """A speed given by harmonics: p = 1 + sum over k = 1, 2, ... of a_k cos(k theta) + b_k sin(k theta).

    cosines, sines: a_k and b_k, fractions of the mean.
    """

    cosines: tuple[float, ...] = ()
    sines: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        store_as_tuples(self, "cosines", "sines")
        require_all_finite("harmonics of a speed", (*self.cosines, *self.sines))
        if not 1 <= max(len(self.cosines), len(self.sines)) <= _MOST:
            raise InputError(
                f"a speed profile must have 1 to {_MOST} harmonics; got {len(self.cosines)} cosines and "
                f"{len(self.sines)} sines; correct them, or leave out the profile"
            )
        theta = np.linspace(0.0, _TURN, _SAMPLES * max(len(self.cosines), len(self.sines)), endpoint=False)
        _require_positive(theta, self.speed_ratio(theta))

    @property
    def knots(self) -> tuple[float, ...]:
        """Crank angles at which the profile is not analytic: none."""
        return ()

    def speed_ratio(self, theta: Array) -> Array:
        """Return p at crank angles, rad, real or complex."""
        total = np.ones_like(theta)
        for k, (a, b) in enumerate(self.coefficient_pairs, start=1):
            total = total + a * np.cos(k * theta) + b * np.sin(k * theta)
        return np.asarray(total)

    def speed_ratio_slope(self, theta: Array) -> Array:
        """Return dp/d(theta)."""
        total = np.zeros_like(theta)
        for k, (a, b) in enumerate(self.coefficient_pairs, start=1):
            total = total + k * (b * np.cos(k * theta) - a * np.sin(k * theta))
        return np.asarray(total)

    def speed_ratio_curvature(self, theta: Array) -> Array:
        """Return the second derivative of p."""
        total = np.zeros_like(theta)
        for k, (a, b) in enumerate(self.coefficient_pairs, start=1):
            total = total - k**2 * (a * np.cos(k * theta) + b * np.sin(k * theta))
        return np.asarray(total)

    @cached_property
    def elapsed_time(self) -> ElapsedTime:
        """Elapsed time as a function of the crank angle."""
        return ElapsedTime.integrate(
            self.speed_ratio, np.linspace(0.0, _TURN, 1 + 4 * max(len(self.cosines), len(self.sines)))
        )

    @property
    def time_mean_over_angle_mean(self) -> float:
        """Mean speed over time divided by the mean over the crank angle."""
        return _TURN / self.elapsed_time.elapsed_over_full_turn

    @property
    def coefficient_pairs(self) -> list[tuple[float, float]]:
        """a_k and b_k of each harmonic."""
        count = max(len(self.cosines), len(self.sines))
        cosines, sines = (values + (0.0,) * (count - len(values)) for values in (self.cosines, self.sines))
        return list(zip(cosines, sines, strict=True))

    @property
    def description(self) -> str:
        """A short description of the profile."""
        count = len(self.coefficient_pairs)
        return f"{count} {'harmonic' if count == 1 else 'harmonics'} of the crank angle"


@dataclass(frozen=True, kw_only=True)
class SpeedTable:
    """p as the periodic cubic spline through speeds at crank angles, divided by its mean.

    angles: increasing, rad, spanning less than a turn. speeds: of one sign, in any unit.
    """

    angles: tuple[float, ...]
    speeds: tuple[float, ...]

    def __post_init__(self) -> None:
        store_as_tuples(self, "angles", "speeds")
        require_all_finite("a table of speeds", (*self.angles, *self.speeds), "throughout")
        if len(self.angles) != len(self.speeds) or len(self.angles) < _LEAST:
            raise InputError(
                f"a table of speeds needs as many speeds as crank angles, at least {_LEAST}; got "
                f"{len(self.angles)} crank angles and {len(self.speeds)} speeds; add what is missing"
            )
        for before, after in pairwise(self.angles):
            if after <= before:
                raise InputError(
                    f"crank angles of a table of speeds must increase; got {math.degrees(after):.6g} deg after "
                    f"{math.degrees(before):.6g} deg; sort the table and remove repeated points"
                )
        self._require_less_than_a_turn()
        for angle, speed in zip(self.angles, self.speeds, strict=True):
            if not speed * self.speeds[0] > 0.0:
                raise InputError(
                    "a speed over the crank angle must not be zero or change its sign, or the crank would stop; "
                    f"got {_RPM * speed:.6g} rpm at {math.degrees(angle):.6g} deg; correct it"
                )
        turns = self._spline.derivative().roots()  # gives NaN for an interval of constant speed
        ends = np.concatenate([turns[np.isfinite(turns)], self.angles])
        _require_positive(ends, self.speed_ratio(ends))

    def _require_less_than_a_turn(self) -> None:
        """Raise an error for a table that spans a turn or more."""
        span = self.angles[-1] - self.angles[0]
        if span >= _TURN - _CLOSED:
            step = self.speeds[-1] - self.speeds[0]
            remedy = "leave out the last point, which repeats the first"
            if span > _TURN + _CLOSED:
                remedy = "give one turn"
            elif step:
                remedy = (
                    f"its last point, one turn after the first, differs from it by {_RPM * step:.6g} rpm, so that "
                    "the profile does not close; make the two equal and leave out the last"
                )
            raise InputError(
                f"crank angles of a table of speeds must span less than 360 deg; got {math.degrees(span):.6g} deg; "
                + remedy
            )

    @cached_property
    def _spline(self) -> Any:
        from scipy.interpolate import CubicSpline

        closed = (*self.angles, self.angles[0] + _TURN), (*self.speeds, self.speeds[0])
        return CubicSpline(*closed, bc_type="periodic")

    @cached_property
    def mean_speed(self) -> float:
        """Mean speed over the crank angle."""
        return float(self._spline.integrate(self.angles[0], self.angles[0] + _TURN)) / _TURN

    @property
    def knots(self) -> tuple[float, ...]:
        """Crank angles at which the profile is not analytic."""
        return self.angles

    def speed_ratio(self, theta: Array) -> Array:
        """Return p at crank angles, rad."""
        return np.asarray(self._spline(theta) / self.mean_speed)

    def speed_ratio_slope(self, theta: Array) -> Array:
        """Return dp/d(theta)."""
        return np.asarray(self._spline(theta, 1) / self.mean_speed)

    def speed_ratio_curvature(self, theta: Array) -> Array:
        """Return the second derivative of p."""
        return np.asarray(self._spline(theta, 2) / self.mean_speed)

    @cached_property
    def elapsed_time(self) -> ElapsedTime:
        """Elapsed time as a function of the crank angle."""
        return ElapsedTime.integrate(self.speed_ratio, np.array([*self.angles, self.angles[0] + _TURN]))

    @property
    def time_mean_over_angle_mean(self) -> float:
        """Mean speed over time divided by the mean over the crank angle."""
        return _TURN / self.elapsed_time.elapsed_over_full_turn

    @property
    def spline_pieces(self) -> tuple[Array, Array]:
        """Knots (k + 1,) in a turn, rad, and the polynomials (4, k) of p between them, by descending powers."""
        return np.array(self._spline.x), np.ascontiguousarray(self._spline.c / self.mean_speed)

    @property
    def description(self) -> str:
        """A short description of the profile."""
        return f"table of {len(self.angles)} crank angles"


Profile = Harmonics | SpeedTable


def time_per_angle(profile: Profile, theta: Array) -> Array:
    """Return the time per crank angle divided by its mean over the turn.

    It is the weight in averages over time: dt = d(theta) / (speed p).
    """
    return np.asarray(profile.time_mean_over_angle_mean / profile.speed_ratio(theta))


def _require_positive(theta: Array, ratio: Array) -> None:
    least = int(np.argmin(ratio))
    if not ratio[least] > 0.0:
        raise InputError(
            "a speed over the crank angle must not be zero or change its sign, or the crank would stop; got "
            f"{100.0 * ratio[least]:.4g} % of the mean at {math.degrees(theta[least]) % 360.0:.4g} deg; reduce the "
            "harmonics, or add points to the table there"
        )
