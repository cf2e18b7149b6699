"""The geometric programme of section sizing, stated once for one machine and solved again with other loads."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...model.errors import InputError
from ...model.extras import required
from ...model.linkage.linkage import Linkage
from ...model.machine.links import Bar
from ...model.machine.mechanism import Mechanism
from ..front.stationarity import Array
from .limit_states import Above, crank_loads, joint_terms, limit_states, rod_loads, same
from .section_limits import Material, SectionLimits
from .section_loads import Whip, joint_loads

_STEP = 1e-4  # relative, for central differences of the loads: error 1e-8 of them
_EXACT = 1e-11  # of the solver
_SLACK = 200.0  # percent of mass that one percent of overload counts as; far above any sensitivity


@dataclass(frozen=True)
class Task:
    """One machine with its limits; sizes are logarithms of the four widths and depths."""

    mechanism: Mechanism
    linkage: Linkage
    material: Material
    limits: SectionLimits
    whip: Whip

    def bars(self, sizes: Array) -> tuple[Bar, Bar]:
        """Return crank and rod."""
        w, d, v, e = np.exp(sizes).tolist()
        density = self.material.density
        return Bar(width=w, depth=d, density=density), Bar(width=v, depth=e, density=density)

    def states(self, sizes: Array) -> dict[str, float]:
        """Return the limit states of sizes with their own loads."""
        return self.limit_states(np.exp(sizes).tolist(), [None, None], self.terms(sizes))

    def terms(self, sizes: Array) -> dict[str, float]:
        """Return the joints' loads of these sizes."""
        crank, rod = self.bars(sizes)
        joints = joint_loads(replace(self.mechanism, crank=crank, rod=rod), self.linkage)
        return joint_terms(joints, self.material, self.limits)

    def powers(self, sizes: Array) -> Array:
        """Return the slopes (n, 4) of the loads' logarithms by the sizes."""
        ends = [
            [self.terms(sizes + side * _STEP * np.eye(len(sizes))[row]) for side in (1.0, -1.0)]
            for row in range(len(sizes))
        ]
        return np.array([[math.log(up[name] / down[name]) / (2.0 * _STEP) for up, down in ends] for name in ends[0][0]])

    def limit_states(self, x: list[Any], z: list[Any], joints: dict[str, Any], above: Above = same) -> dict[str, Any]:
        """Return the limit states of widths and depths x, amplifications z and joint loads, by bar and name."""
        crank, rod = float(self.linkage.crank), float(self.linkage.rod)
        of_crank = crank_loads(x[0], x[1], crank, joints, self.mechanism, self.material, self.limits)
        of_rod = rod_loads(x[2], x[3], rod, joints, self.whip, self.material, self.limits)
        found: dict[str, Any] = {}
        for part, w, d, own, length, held, loads in (
            ("crank", x[0], x[1], z[0], crank, 2.0, of_crank),
            ("rod", x[2], x[3], z[1], rod, 1.0, of_rod),
        ):
            states = limit_states(w, d, own, length, held, loads.each(above), self.material, self.limits, above)
            found |= {f"{part}: {name}": state for name, state in states.items()}
        return found

    def mass(self, x: list[Any]) -> Any:
        """Return the mass of both bars of widths and depths, see `links.Bar`."""
        (w, d, v, e), crank, rod = x, float(self.linkage.crank), float(self.linkage.rod)
        of_crank = crank * d * w + 0.25 * math.pi * d * w**2
        of_rod = rod * e * v + 0.25 * math.pi * e * v**2
        return self.material.density * (of_crank + of_rod)


class SectionProgramme:
    """Least mass under the limit states, loads being monomials of the sizes: F x1^a1 x2^a2 x3^a3 x4^a4."""

    def __init__(self, task: Task, loads: list[str]) -> None:
        """State the programme for the loads of these names."""
        cp = required("cvxpy", "sections of least mass need")

        self.loads, self.powers = cp.Parameter(len(loads), pos=True), cp.Parameter((len(loads), 4))
        self.low, self.high = cp.Parameter(4, pos=True), cp.Parameter(4, pos=True)
        self.sizes, z, over = cp.Variable(4, pos=True), cp.Variable(2, pos=True), cp.Variable(pos=True)
        monomials = cp.multiply(self.loads, cp.gmatmul(self.powers, self.sizes))
        bounds: list[Any] = []

        def above(expression: Any) -> Any:
            """Return a variable no less than an expression: at the optimum equal where it counts."""
            bound = cp.Variable(pos=True)
            bounds.append(expression <= bound)
            return bound

        x = [self.sizes[row] for row in range(4)]
        states = task.limit_states(
            x, [z[0], z[1]], {name: above(monomials[row]) for row, name in enumerate(loads)}, above
        )
        self.held = {
            name: state <= (1.0 if name.endswith(("width", "depth")) else over) for name, state in states.items()
        }
        self.programme = cp.Problem(
            cp.Minimize(task.mass(x) * over**_SLACK),
            [*self.held.values(), *bounds, over >= 1.0, self.sizes >= self.low, self.sizes <= self.high],
        )

    def solve(self, sizes: Array, loads: Array, powers: Array, radius: float) -> tuple[Array, dict[str, float]]:
        """Return sizes of least mass within a radius of these, and by how many percent one percent less strict saves.

        sizes: (4,), logarithms, where the loads (n,) have the slopes powers (n, 4).
        """
        cp = required("cvxpy", "sections of least mass need")

        self.loads.value, self.powers.value = loads * np.exp(-powers @ sizes), powers
        self.low.value, self.high.value = np.exp(sizes - radius), np.exp(sizes + radius)
        # The objective's value, which nothing asks for, may overflow where the loads are far beyond the ranges.
        with warnings.catch_warnings(), np.errstate(over="ignore"):
            warnings.simplefilter("ignore", UserWarning)  # "may be inaccurate": the iteration goes on until it settles
            self.programme.solve(gp=True, solver=cp.CLARABEL, tol_gap_abs=_EXACT, tol_gap_rel=_EXACT, tol_feas=_EXACT)
        if self.programme.status not in (cp.OPTIMAL, cp.OPTIMAL_INACCURATE):
            raise InputError(
                f"the sections could not be sized: the solver ended as {self.programme.status}; check loads and limits"
            )
        duals = {name: max(0.0, float(constraint.dual_value)) for name, constraint in self.held.items()}
        return np.log(np.asarray(self.sizes.value, dtype=np.float64)), duals
