"""Crank counterweight and rod balance for least shaking, as a second-order cone programme.

    minimise  |F| + |M| / arm,   |.| the peak or the root mean square over the cycle,

over the counterweight's moment c (within `most`) and the balance mass on the rod. F and M are affine in them
(`shaking_rows`), so |F(theta)| <= tau is a second-order cone at every crank angle, and the root mean square is the norm
of an affine vector. Peaks are over the continuum of angles. The programme is first solved with a few angles; then the
exact peaks of its solution (`model.signals.peaks`, no grid) are added, until none is higher than those included.

The balance mass on the rod may be any body within a distance R of the crank pin. Mass m, first moment b and inertia I
belong to such a body if and only if

    |b|^2 <= m I   (Cauchy and Schwarz)   and   I <= R^2 m,

again a convex cone. Its mass acts like a counterweight towards the crank pin, which c can cancel. Among all solutions
with the same forces, the result is the one with the least added mass.

Known limits: without slider mass, or with a rod balance that puts the centre of rod and slider at the crank pin, the
force vanishes (R. S. Berkof and G. G. Lowen, "A new method for completely force balancing simple linkages", J.
Engineering for Industry 91, 1969); for a long rod without offset, c is the rotating mass and half the reciprocating
one.
"""

import math
import warnings
from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array
from ...model.cycle.multi_cylinder import ShakingCurves, shaking_curves
from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.linkage.require_single_linkage import require_single_rotating_linkage
from ...model.machine.cylinders_and_turns import require_single_cylinder_at_constant_speed
from ...model.machine.loads.load import require_word
from ...model.machine.mechanism import Mechanism
from ...model.optional_packages import import_extra
from ...model.signals.averages import signal_averages
from ...model.signals.first_peak import first_peaks
from ...model.signals.peaks import find_peaks
from ...model.signals.signals import Signal
from .input_words import Measure
from .shaking_rows import first_moment_of_moving_parts, rms_shaking_rows, shaking_rows, with_balance_masses

ROUNDS = 60
_START = 24  # crank angles per turn in the first round
_EXCESS = 1e-10  # relative to the original shaking: excess of a peak over those in the programme that is allowed


@dataclass(frozen=True, kw_only=True)
class RodSpace:
    """Space for a balance mass on the rod: within `radius` of the crank pin, m; at most `mass`, kg."""

    radius: float
    mass: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.radius) and self.radius > 0.0):
            raise InputError(
                f"the space for the rod balance must have a positive, finite radius; got {self.radius:g} m"
            )
        if not (math.isfinite(self.mass) and self.mass > 0.0):
            raise InputError(f"the greatest mass of the rod balance must be positive and finite; got {self.mass:g} kg")


@dataclass(frozen=True)
class Shaking:
    """Peaks and root mean squares over time: force, N, and moment about the crank pivot, N m; peak angles, rad."""

    peak_force: float
    peak_force_angle: float
    rms_force: float
    peak_moment: float
    peak_moment_angle: float
    rms_moment: float


@dataclass(frozen=True)
class RodBalance:
    """Balance added to the rod: mass, kg, first moment along and across it, kg m, and inertia, kg m^2.

    First moment and inertia are about the crank pin. The mass centre is at moment / mass.
    """

    mass: float
    moment_along: float
    moment_across: float
    inertia: float


@dataclass(frozen=True)
class Balance:
    """The best balance.

    moment, angle: moment of the counterweight, kg m, and its angle from the crank's direction, rad. radius: radius of
    the counterweight in `balanced`, m; mass: mass at that radius, kg. rod: rod balance; None unless requested.
    original: mechanism before; balanced: mechanism after. objective: the minimised value, N. bound: its lower bound
    from the cone programme, accurate to about 1e-9 of the original shaking. saving: decrease per kg m by which `most`
    is raised. rounds: rounds of the exchange. converged: False if it ended with peaks still rising.
    """

    moment: float
    angle: float
    radius: float
    rod: RodBalance | None
    linkage: Linkage
    original: Mechanism
    balanced: Mechanism
    shaking_before: Shaking
    shaking_after: Shaking
    objective: float
    bound: float
    saving: float
    rounds: int
    converged: bool

    @property
    def mass(self) -> float:
        """Mass of the counterweight at `radius`, kg."""
        return self.moment / self.radius

    def shaking_before_and_after(self, crank_angle: Array) -> tuple[ShakingCurves, ShakingCurves]:
        """Return the shaking before and after at crank angles (n,), rad; force_y over force_x is the hodograph."""
        before, after = (shaking_curves(each, self.linkage, crank_angle) for each in (self.original, self.balanced))
        return before, after


def best_balance(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    measure: Measure = "peak",
    arm: float | None = None,
    radius: float | None = None,
    greatest_moment: float | None = None,
    rod: RodSpace | None = None,
) -> Balance:
    """Return the counterweight, which replaces the mechanism's own, and the rod balance for least shaking of a linkage.

    arm: lever arm, m; the shaking moment counts as moment / arm, and is ignored if None. It needs a rod balance,
    because no counterweight changes it. radius: radius of the counterweight, m; by default, that of the mechanism's
    counterweight, or the crank. greatest_moment: greatest moment of the counterweight, kg m. rod: space for a rod
    balance; None if there is none. Raises `InputError` if the crank is at rest or accelerates, or if no moving part has
    a mass.
    """
    require_word("measure", measure, Measure)
    require_single_cylinder_at_constant_speed(mechanism, "the balance of a counterweight")
    linkage = require_single_rotating_linkage(mechanism, linkage)
    for name, value in (("arm", arm), ("radius", radius), ("greatest_moment", greatest_moment)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} must be positive and finite; got {value:g}")
    if mechanism.acceleration or not mechanism.speed:
        raise InputError(
            f"balancing needs a constant crank speed; got {mechanism.speed:g} rad/s with an acceleration of "
            f"{mechanism.acceleration:g} rad/s^2; set a speed and no acceleration"
        )
    if arm is not None and rod is None:
        raise InputError(
            f"the counterweight does not affect the shaking moment about the crank pivot; got an arm of {arm:g} m "
            "without a rod balance; add space on the rod, or leave out the arm"
        )
    if not first_moment_of_moving_parts(mechanism, linkage) > 0.0:
        raise InputError("balancing needs masses; crank, rod and slider have none; give at least one")
    return _Programme(mechanism, linkage, measure, arm, greatest_moment, rod).solve(
        radius or mechanism.counterweight.radius or float(linkage.crank)
    )


@dataclass
class _Programme:
    """The programme in the moments of `shaking_rows.NAMES`, each divided by its `unit`."""

    mechanism: Mechanism
    linkage: Linkage
    measure: Measure
    arm: float | None
    greatest_moment: float | None
    rod: RodSpace | None

    def __post_init__(self) -> None:
        moment = first_moment_of_moving_parts(self.mechanism, self.linkage)
        mass, arm_radius = moment / float(self.linkage.crank), 1.0 if self.rod is None else self.rod.radius
        self.unit = np.array([moment, moment, mass, mass * arm_radius, mass * arm_radius, mass * arm_radius**2])
        self.force = moment * self.mechanism.speed**2  # of the same order as the forces, N
        self.count = 2 if self.rod is None else 6

    def solve(self, radius: float) -> Balance:
        """Return the balance with the counterweight at a radius, m."""
        angles = np.linspace(0.0, 2.0 * math.pi, _START, endpoint=False)
        for count in range(1, ROUNDS + 1):
            x, bound, saving = self._solve_cone_programme(angles)
            after = with_balance_masses(self.mechanism, self.linkage, x, radius)
            fresh = self._angles_of_higher_peaks(x, angles, after) if self.measure == "peak" else np.empty(0)
            if not len(fresh) or count == ROUNDS:
                break
            angles = np.concatenate([angles, fresh])
        before, shaken = (shaking_peaks_and_means(each, self.linkage) for each in (self.mechanism, after))
        force, moment = (getattr(shaken, f"{self.measure}_{name}") for name in ("force", "moment"))
        return Balance(
            math.hypot(x[0], x[1]),
            math.atan2(x[1], x[0]),
            radius,
            None if self.rod is None else RodBalance(*(float(value) for value in x[2:])),
            self.linkage,
            self.mechanism,
            after,
            before,
            shaken,
            force + (moment / self.arm if self.arm else 0.0),
            bound,
            saving,
            count,
            not len(fresh),
        )

    def _solve_cone_programme(self, angles: Array) -> tuple[Array, float, float]:
        """Return x (6,), the least objective, N, for peaks at only these angles, and the price of `most`, N/(kg m)."""
        cp = import_extra("cvxpy", "balancing a counterweight needs")
        z = cp.Variable(self.count)
        goals, rules = [], []
        peaks = self.measure == "peak"
        design = self.mechanism, self.linkage
        force, moment = shaking_rows(*design, angles) if peaks else rms_shaking_rows(*design)
        for table, size in ((force, self.force), *([(moment, self.force * self.arm)] if self.arm else [])):
            first, others = table[..., 0] / size, table[..., 1 : 1 + self.count] * self.unit[: self.count] / size
            if not peaks:
                goals.append(cp.norm(first + others @ z))
                continue
            goals.append(cp.Variable())
            if table.ndim == 3:
                parts = cp.vstack([first[axis] + others[axis] @ z for axis in range(2)])
                rules.append(cp.norm(parts, axis=0) <= goals[-1])
            else:
                rules.append(cp.abs(first + others @ z) <= goals[-1])
        held = [] if self.greatest_moment is None else [cp.norm(z[:2]) <= self.greatest_moment / self.unit[0]]
        rules += held
        if self.rod is not None:
            rules += [cp.quad_over_lin(z[3:5], z[2]) <= z[5], z[5] <= z[2], z[2] <= self.rod.mass / self.unit[2]]
        problem = cp.Problem(cp.Minimize(sum(goals)), rules)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # the peaks show the effect of an inaccurate answer
            problem.solve(solver=cp.CLARABEL, tol_gap_abs=1e-11, tol_gap_rel=1e-11, tol_feas=1e-11)
        if z.value is None:
            raise InputError(f"the cone solver found no balance ({problem.status}); masses must be of comparable size")
        x = np.zeros(6)
        x[: self.count] = z.value * self.unit[: self.count]
        tight = self.greatest_moment is not None and math.hypot(x[0], x[1]) > self.greatest_moment * (1.0 - 1e-6)
        price = held[0].dual_value * self.force / self.unit[0] if tight else 0.0
        return self._with_lightest_rod_balance(self._clip_to_bounds(x)), float(problem.value * self.force), float(price)

    def _clip_to_bounds(self, x: Array) -> Array:
        """Return x moved within its bounds, which the solver's rounding may have left."""
        if self.greatest_moment is not None:
            x[:2] *= min(1.0, self.greatest_moment / max(math.hypot(x[0], x[1]), 1e-300))
        if self.rod is not None:
            mass = min(float(x[2]), self.rod.mass) if x[2] > 1e-9 * self.rod.mass else 0.0
            inertia = min(max(float(x[5]), 0.0), mass * self.rod.radius**2)
            x[3:5] *= min(1.0, math.sqrt(mass * inertia) / max(math.hypot(x[3], x[4]), 1e-300))
            x[2], x[5] = mass, inertia
        return x

    def _with_lightest_rod_balance(self, x: Array) -> Array:
        """Return the answer with equal forces, and an equal moment if it counts, that adds least mass to the rod."""
        if self.rod is None:
            return x
        first, arm_radius = math.hypot(x[3], x[4]), self.rod.radius
        inertia = first * arm_radius if self.arm is None else max(0.0, float(x[5]))
        mass = max(inertia / arm_radius**2, first**2 / inertia) if inertia else 0.0
        light = np.array([x[0] + (x[2] - mass) * float(self.linkage.crank), x[1], mass, x[3], x[4], inertia])
        return light if self.greatest_moment is None or math.hypot(light[0], light[1]) <= self.greatest_moment else x

    def _angles_of_higher_peaks(self, x: Array, angles: Array, after: Mechanism) -> Array:
        """Return the crank angles of exact peaks that exceed all those at the programme's angles."""
        force, moment = (table @ np.array([1.0, *x]) for table in shaking_rows(self.mechanism, self.linkage, angles))
        fresh = []
        for kind, size, unit in (
            (Signal.SHAKING_FORCE, np.hypot(*force), self.force),
            *([(Signal.SHAKING_MOMENT, np.abs(moment), self.force * self.arm)] if self.arm else []),
        ):
            found = find_peaks(after, kind, _design_row(self.linkage))
            fresh.append(found.angles[0, found.values[0] > size.max() + _EXCESS * unit])
        return np.concatenate(fresh)


def shaking_peaks_and_means(mechanism: Mechanism, linkage: Linkage) -> Shaking:
    """Return peaks and root mean squares of a linkage's shaking force and moment."""
    numbers: list[float] = []
    for kind in (Signal.SHAKING_FORCE, Signal.SHAKING_MOMENT):
        peaks, angles = first_peaks(mechanism, kind, _design_row(linkage))
        mean = signal_averages(mechanism, kind, _design_row(linkage))
        numbers += [float(peaks[0]), float(angles[0]), float(mean.rms[0])]
    return Shaking(*numbers)


def _design_row(linkage: Linkage) -> Array:
    return np.array([[linkage.crank, linkage.rod, linkage.offset]], dtype=np.float64)
