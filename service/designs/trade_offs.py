"""Trade-off rates at any design of a stored front, from its derivatives, recomputed if not stored."""

from dataclasses import replace

import numpy as np

from ...model.arrays import Array
from ...model.errors import InputError
from ...objectives.kinds import System
from ...optimise.front.front import ParetoFront
from ...optimise.search.elimination import EliminationBranch, elimination_branches
from .stored_designs import StoredDesign

_NEAR = 1e-9  # relative accuracy to which a point of the unit box must reproduce the design


def trade_offs_of(front: ParetoFront, row: int, design: StoredDesign, system: System = "metric") -> list[str]:
    """Return sentences on the cost of each objective in terms of the others at a design.

    Its active constraints are held. front: front from `front_of_result`. row: row of the design in it. system: unit
    system of the sentences.

    Raises `InputError` if there are no such rates: a single objective, an objective without gradient, or a design that
    does not meet its constraints.
    """
    from ...optimise.front.hypervolume import ideal_and_range
    from ...optimise.search.evaluation import Evaluator
    from ...optimise.search.polish import polish_designs

    if len(front.objectives) < 2:
        raise InputError("trade-offs need at least two objectives; got one; add another to the job")
    lacking = design.part.without_gradient()
    if lacking:
        raise InputError(
            f'trade-off rates need the gradient of every quantity; got {", ".join(lacking)} with gradient = "none"; '
            'set gradient = "finite differences"'
        )
    if front.goals[row][1].size and design.values == tuple(front.dimensions[row].tolist()):
        return front.trade_offs(row, system)
    values = np.array(design.values)
    for branch in elimination_branches(design.part):
        point = _unit_box_point(branch, values)
        if point is None:
            continue
        span = ideal_and_range(front.values)[1]
        polished = polish_designs(Evaluator(design.part, branch), point[None], span, iterations=0)
        owner, slopes = polished.goals[0]
        nothing = (np.zeros(0), np.zeros((0, 0)))
        goals, active = [nothing] * len(front), [nothing[1]] * len(front)
        goals[row], active[row] = (owner, slopes * span[owner.astype(int)][:, None]), polished.active[0]
        return replace(front, goals=tuple(goals), active=tuple(active)).trade_offs(row, system)
    raise InputError(
        "trade-off rates need a design that meets the rules of its job; this one does not; run the job again"
    )


def _unit_box_point(branch: EliminationBranch, values: Array) -> Array | None:
    """Return the point of the unit box for a design, or None if no point of the branch gives it."""
    if values[2] * branch.sign < 0.0:
        return None
    sizes = np.abs(values)
    unknowns = np.concatenate([sizes[:3], values[3:]])
    free = np.array([unknowns[branch.names.index(name)] for name in branch.free])
    point = np.clip((free - branch.lower) / (branch.upper - branch.lower), 0.0, 1.0)
    scale = np.concatenate([np.full(3, sizes[:3].max()), sizes[3:]])
    near = np.abs(branch.designs_at_points(point)[0] - values) <= _NEAR * scale
    return np.asarray(point) if near.all() else None
