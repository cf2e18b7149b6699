"""Widths and depths of crank and rod for least mass, by geometric programming coupled to the dynamics.

Mass and limit states (`limit_states`) are posynomials of the four section sizes once the joints' loads are known; the
loads in turn grow with the masses. Each iteration computes the loads of the present sections from the dynamics of the
whole machine, with their slopes by differences, puts in their place the monomials that agree in value and slope,
F (w/w0)^a (d/d0)^b ..., and solves the geometric programme. At the fixed point its optimum is one of the coupled
problem too, not only of the problem with the loads frozen (S. Boyd, S.-J. Kim, L. Vandenberghe and A. Hassibi, "A
tutorial on geometric programming", Optimization and Engineering 8, 2007, sec. 9). Each programme is convex after the
change of variables and solved to its global optimum; the coupled problem is not, its optimum is local in general.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.linkage.single import single
from ...model.machine.friction import require_frictionless
from ...model.machine.links import Bar
from ...model.machine.mechanism import Mechanism
from .limit_states import AMPLIFICATION
from .section_limits import Material, SectionLimits
from .section_loads import whip_of
from .section_programme import SectionProgramme, Task

_ITERATIONS = 60
_SETTLED = 1e-8  # relative change of the sections that ends the iteration
_RADIUS = 1.0  # of the logarithms of the sections, in one iteration
_ANYWHERE = 50.0
_OVER = 1e-6  # overload that counts as none


@dataclass(frozen=True)
class Sections:
    """Sections of least mass.

    crank, rod: as bars of the material. mass: of both, kg. utilisation: of each limit state, at most one, by names like
    "rod: fatigue". sensitivity: percent of mass that one percent more of that limit saves, to first order, the dynamics
    included; zero where a limit is not active. iterations: geometric programmes solved. change: the last relative
    change of the sections.
    """

    crank: Bar
    rod: Bar
    mass: float
    utilisation: dict[str, float]
    sensitivity: dict[str, float]
    iterations: int
    change: float

    @property
    def settled(self) -> bool:
        """Whether sections and dynamics agree."""
        return self.change <= 1e-6


def size_sections(mechanism: Mechanism, linkage: Linkage, material: Material, limits: SectionLimits) -> Sections:
    """Return the sections of crank and rod with the least mass that carry a machine's loads.

    They replace what the mechanism has as crank and rod. Raises `InputError` where no section within the ranges
    carries the loads, naming what fails, for arrays of linkages, and for friction, which would bend the bars at their
    pins.
    """
    require_frictionless(mechanism.friction, "section sizing")
    linkage = single(mechanism, linkage)
    task = Task(mechanism, linkage, material, limits, whip_of(mechanism, linkage))
    sizes = np.log([limits.width[0], limits.depth[0]] * 2)
    programme = SectionProgramme(task, list(task.terms(sizes)))
    radius, before = _ANYWHERE, math.inf
    for iteration in range(_ITERATIONS):
        count = iteration + 1
        # The first programme only finds the order of magnitude: slopes at the least sections lead nowhere.
        loads = np.array(list(task.terms(sizes).values()))
        powers = task.powers(sizes) if iteration else np.zeros((len(loads), 4))
        new, sensitivity = programme.solve(sizes, loads, powers, radius)
        change = float(np.abs(new - sizes).max())
        sizes = new
        if iteration > 0 and change <= _SETTLED:
            break
        if iteration == 0:
            radius = _RADIUS
        elif change > 0.7 * before:
            radius = 0.5 * min(radius, change)  # two crank angles take turns as the worst
        before = change if iteration else math.inf
    states = {name: state for name, state in task.states(sizes).items() if not name.endswith(AMPLIFICATION)}
    # Where a bar buckles its stress is infinite; what says by how much is the buckling.
    worst = max((name for name, state in states.items() if state < math.inf), key=lambda name: states[name])
    if states[worst] > 1.0 + _OVER:
        raise InputError(
            f"no section within the ranges carries the loads; got {worst} at {100.0 * states[worst]:.4g} % of what is "
            "permitted at best; widen the ranges of width and depth, slow the machine down or take a stronger material"
        )
    crank, rod = task.bars(sizes)
    return Sections(
        crank=crank,
        rod=rod,
        mass=crank.mass(float(linkage.crank)) + rod.mass(float(linkage.rod)),
        utilisation=states,
        sensitivity={name: sensitivity[name] for name in states},
        iterations=count,
        change=change,
    )
