"""Widths and depths of the crank and the rod for least mass, by geometric programming coupled to the dynamics.

Mass and limit states (`limit_states`) are posynomials in the four section sizes once the joints' loads are known; the
loads in turn grow with the masses. Each iteration computes the loads of the current sections from the dynamics of the
whole machine, with their slopes by differences, replaces the loads by monomials with the same value and slope, F
(w/w0)^a (d/d0)^b ..., and solves the geometric programme. At the fixed point, its optimum is also one of the coupled
problem, not only of the problem with frozen loads (S. Boyd, S.-J. Kim, L. Vandenberghe and A. Hassibi, "A tutorial on
geometric programming", Optimization and Engineering 8, 2007, sec. 9). Each programme is convex after the change of
variables and solved to its global optimum; the coupled problem is not convex, and its optimum is in general local.
"""

import math
import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...model.arrays import Array
from ...model.errors import InfeasibleError, InputError
from ...model.linkage.linkage import Linkage
from ...model.linkage.require_single_linkage import require_single_rotating_linkage
from ...model.machine.cylinders_and_turns import require_single_cylinder_at_constant_speed
from ...model.machine.links_and_joints import Bar, require_frictionless
from ...model.machine.mechanism import Material, Mechanism
from ...model.optional_packages import import_extra
from ..problem.tolerance_costs import SectionLimits
from .limit_states import (
    AMPLIFICATION,
    Above,
    crank_loads,
    joint_load_terms,
    limit_states,
    rod_loads,
    unchanged_expression,
)
from .section_loads import Whip, greatest_rod_accelerations, joint_loads

_ITERATIONS = 60
_CONVERGED = 1e-8  # relative change of the sections at which the iteration ends
_RADIUS = 1.0  # limit on the change of the sections' logarithms in one iteration
_ANYWHERE = 50.0
_OVER = 1e-6  # negligible overload
_ROUNDS, _ROUNDING = 20, 1e-9  # rounds of widening eyes; remaining overload
_STEP = 1e-4  # relative step for central differences of the loads, with a relative error of 1e-8
_EXACT = 1e-11  # of the solver
_SLACK = 200.0  # percent of mass that one percent of overload counts as; far above any sensitivity


@dataclass(frozen=True)
class Sections:
    """Sections of least mass.

    crank, rod: bars of the material. mass: mass of both, kg. utilisation: utilisation of each limit state, at most one,
    by names like "rod: fatigue". sensitivity: percent of mass saved per percent increase of that limit, to first order,
    including the dynamics; zero where a limit is not active. iterations: geometric programmes solved. change: the last
    relative change of the sections.
    """

    crank: Bar
    rod: Bar
    mass: float
    utilisation: dict[str, float]
    sensitivity: dict[str, float]
    iterations: int
    change: float

    @property
    def is_converged(self) -> bool:
        """Whether sections and dynamics agree."""
        return self.change <= 1e-6


def size_sections(mechanism: Mechanism, linkage: Linkage, material: Material, limits: SectionLimits) -> Sections:
    """Return the sections of the crank and the rod with the least mass that carry a machine's loads.

    They replace those of the mechanism. Raises `InfeasibleError`, naming the limit that fails, if no section
    within the ranges carries the loads; also raises it for arrays of linkages, and for friction, which would bend the
    bars at their pins.
    """
    require_frictionless(mechanism.friction, "section sizing")
    require_single_cylinder_at_constant_speed(replace(mechanism, arrangement=None), "section sizing")
    linkage = require_single_rotating_linkage(mechanism, linkage)
    task = _Task(mechanism, linkage, material, limits, greatest_rod_accelerations(mechanism, linkage))
    sizes = np.log([limits.width[0], limits.depth[0]] * 2)
    programme = _Programme(task, list(task.joint_load_terms(sizes)))
    radius, before = _ANYWHERE, math.inf
    for iteration in range(_ITERATIONS):
        count = iteration + 1
        # The first programme only finds the order of magnitude, because slopes at the least sections are misleading.
        loads = np.array(list(task.joint_load_terms(sizes).values()))
        powers = task.load_exponents(sizes) if iteration else np.zeros((len(loads), 4))
        new, sensitivity = programme.solve(sizes, loads, powers, radius)
        change = float(np.abs(new - sizes).max())
        sizes = new
        if iteration > 0 and change <= _CONVERGED:
            break
        if iteration == 0:
            radius = _RADIUS
        elif change > 0.7 * before:
            radius = 0.5 * min(radius, change)  # two crank angles alternate as the worst
        before = change if iteration else math.inf
    sizes = task.widen_eyes(sizes)
    states = {
        name: state for name, state in task.limit_states_of_sizes(sizes).items() if not name.endswith(AMPLIFICATION)
    }
    # If a bar buckles, its stress is infinite; the buckling limit shows the extent.
    worst = max((name for name, state in states.items() if state < math.inf), key=lambda name: states[name])
    if states[worst] > 1.0 + _OVER:
        raise InfeasibleError(
            f"no section within the ranges carries the loads; {worst} reaches at best {100.0 * states[worst]:.4g} % "
            "of the permissible value; widen the ranges of width and depth, reduce the speed, or choose a stronger "
            "material"
        )
    crank, rod = task.crank_and_rod_bars(sizes)
    return Sections(
        crank=crank,
        rod=rod,
        mass=crank.mass(float(linkage.crank)) + rod.mass(float(linkage.rod)),
        utilisation=states,
        sensitivity={name: sensitivity[name] for name in states},
        iterations=count,
        change=change,
    )


@dataclass(frozen=True)
class _Task:
    """One machine with its limits; sizes are logarithms of the four widths and depths."""

    mechanism: Mechanism
    linkage: Linkage
    material: Material
    limits: SectionLimits
    whip: Whip

    def crank_and_rod_bars(self, sizes: Array) -> tuple[Bar, Bar]:
        """Return the crank and the rod."""
        w, d, v, e = np.exp(sizes).tolist()
        density = self.material.density
        return Bar(width=w, depth=d, density=density), Bar(width=v, depth=e, density=density)

    def limit_states_of_sizes(self, sizes: Array) -> dict[str, float]:
        """Return the limit states of sizes with their own loads."""
        return self.limit_states(np.exp(sizes).tolist(), [None, None], self.joint_load_terms(sizes))

    def joint_load_terms(self, sizes: Array) -> dict[str, float]:
        """Return the terms of the joint loads for these sizes."""
        crank, rod = self.crank_and_rod_bars(sizes)
        joints = joint_loads(replace(self.mechanism, crank=crank, rod=rod), self.linkage)
        return joint_load_terms(joints, self.material, self.limits)

    def load_exponents(self, sizes: Array) -> Array:
        """Return the slopes (n, 4) of the loads' logarithms by the sizes."""
        ends = [
            [self.joint_load_terms(sizes + side * _STEP * np.eye(len(sizes))[row]) for side in (1.0, -1.0)]
            for row in range(len(sizes))
        ]
        return np.array([[math.log(up[name] / down[name]) / (2.0 * _STEP) for up, down in ends] for name in ends[0][0]])

    def widen_eyes(self, sizes: Array) -> Array:
        """Return sizes whose eyes carry their loads to rounding.

        The solver's error is relative to the width, which is large compared with a net section of a few micrometres.
        """
        holes = {
            "pivot": self.limits.crank_pivot,
            "crank pin": self.limits.crank_pin,
            "slider pin": self.limits.slider_pin,
        }
        widths = np.exp(sizes)
        for _ in range(_ROUNDS):
            wider = widths.copy()
            for name, state in self.limit_states_of_sizes(np.log(widths)).items():
                kind, _, pin = name.partition(" at the ")
                width, hole = 2 * kind.startswith("rod"), holes.get(pin, 0.0)
                if pin and "bearing" not in kind and 1.0 + _ROUNDING < state < math.inf and widths[width] > hole:
                    wider[width] = max(wider[width], hole + state * (widths[width] - hole))
            wider = np.minimum(wider, [self.limits.width[1], math.inf] * 2)
            if (wider == widths).all():
                break
            widths = wider
        return np.log(widths)

    def limit_states(
        self, x: list[Any], z: list[Any], joints: dict[str, Any], above: Above = unchanged_expression
    ) -> dict[str, Any]:
        """Return the limit states of widths and depths x, amplifications z and joint loads, by bar and name."""
        crank, rod = float(self.linkage.crank), float(self.linkage.rod)
        of_crank = crank_loads(x[0], x[1], crank, joints, self.mechanism, self.material, self.limits)
        of_rod = rod_loads(x[2], x[3], rod, joints, self.whip, self.material, self.limits)
        found: dict[str, Any] = {}
        for part, w, d, bar, buckling_length, loads in (
            ("crank", x[0], x[1], z[0], 2.0 * crank, of_crank),
            ("rod", x[2], x[3], z[1], rod, of_rod),
        ):
            states = limit_states(w, d, bar, buckling_length, loads.map_loads(above), self.material, self.limits, above)
            found |= {f"{part}: {name}": state for name, state in states.items()}
        return found

    def mass(self, x: list[Any]) -> Any:
        """Return the mass of both bars from their widths and depths, see `Bar`."""
        (w, d, v, e), crank, rod = x, float(self.linkage.crank), float(self.linkage.rod)
        of_crank = crank * d * w + 0.25 * math.pi * d * w**2
        of_rod = rod * e * v + 0.25 * math.pi * e * v**2
        return self.material.density * (of_crank + of_rod)


class _Programme:
    """Geometric programme of one machine for least mass within the limits, built once and solved for different loads.

    Loads are monomials in the sizes: F x1^a1 x2^a2 x3^a3 x4^a4.
    """

    def __init__(self, task: _Task, loads: list[str]) -> None:
        cp = import_extra("cvxpy", "sizing sections needs")

        self.loads, self.powers = cp.Parameter(len(loads), pos=True), cp.Parameter((len(loads), 4))
        self.low, self.high = cp.Parameter(4, pos=True), cp.Parameter(4, pos=True)
        self.sizes, z, over = cp.Variable(4, pos=True), cp.Variable(2, pos=True), cp.Variable(pos=True)
        monomials = cp.multiply(self.loads, cp.gmatmul(self.powers, self.sizes))
        bounds: list[Any] = []

        def upper_bound_variable(expression: Any) -> Any:
            """Return a variable no less than an expression, and equal to it at the optimum where it matters."""
            bound = cp.Variable(pos=True)
            bounds.append(expression <= bound)
            return bound

        x = [self.sizes[row] for row in range(4)]
        states = task.limit_states(
            x,
            [z[0], z[1]],
            {name: upper_bound_variable(monomials[row]) for row, name in enumerate(loads)},
            upper_bound_variable,
        )
        self.held = {
            name: state <= (1.0 if name.endswith(("width", "depth")) else over) for name, state in states.items()
        }
        self.programme = cp.Problem(
            cp.Minimize(task.mass(x) * over**_SLACK),
            [*self.held.values(), *bounds, over >= 1.0, self.sizes >= self.low, self.sizes <= self.high],
        )

    def solve(self, sizes: Array, loads: Array, powers: Array, radius: float) -> tuple[Array, dict[str, float]]:
        """Return sizes of least mass within a radius of these, and the percent saved per percent of relaxed limit.

        sizes: (4,), logarithms, at which the loads (n,) have the slopes `powers` (n, 4).
        """
        cp = import_extra("cvxpy", "sizing sections needs")

        self.loads.value, self.powers.value = loads * np.exp(-powers @ sizes), powers
        self.low.value, self.high.value = np.exp(sizes - radius), np.exp(sizes + radius)
        # The objective's value is not used, and may overflow if the loads are far beyond the ranges.
        with warnings.catch_warnings(), np.errstate(over="ignore"):
            # It warns that the answer "may be inaccurate", but the iteration continues until it settles.
            warnings.simplefilter("ignore", UserWarning)
            self.programme.solve(gp=True, solver=cp.CLARABEL, tol_gap_abs=_EXACT, tol_gap_rel=_EXACT, tol_feas=_EXACT)
        if self.programme.status not in (cp.OPTIMAL, cp.OPTIMAL_INACCURATE):
            raise InputError(
                f"the sections could not be sized: the solver ended with status {self.programme.status}; check loads "
                "and limits"
            )
        duals = {name: max(0.0, float(constraint.dual_value)) for name, constraint in self.held.items()}
        return np.log(np.asarray(self.sizes.value, dtype=np.float64)), duals
