"""Robust problems: objectives and constraints within tolerances, and the nominal problem of a robust one."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from ...model.errors import InputError
from ...model.tolerance.error_distributions import Shape
from ...objectives.robust.quantity import SAMPLES, Case, RobustQuantity, Side, require_robust_options_in_range
from .problem import Problem
from .requirements import Constraint, Objective, merge_constraints


@dataclass(frozen=True, kw_only=True)
class Robust:
    """Robustness of objectives and constraints, see `RobustQuantity`.

    quantities: names of the robust ones; None for all except equalities and targets, which stay nominal, and position
    errors.
    """

    kind: Case = "percentile"
    order: int = 2
    share: float = 0.99
    samples: int = SAMPLES
    shape: Shape = "normal"
    quantities: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        require_robust_options_in_range(self.kind, self.order, self.share, self.samples, self.shape)


def robust_problem(problem: Problem, plan: Robust) -> Problem:
    """Return a problem whose objectives and constraints are robust, under separate names.

    A quantity that is minimised or has a maximum is taken at its high side; one that is maximised or has a minimum, at
    its low side: peak_torque becomes peak_torque_robust. A quantity needed at both sides becomes two, _robust_low and
    _robust_high. Equalities stay nominal: drawn dimensions meet them, but no machine with errors can. So do targets.
    Each requirement is robust separately: 99 % of the machines meet each one, not all of them together. The problem's
    seed determines the sample. Limits of a choice, such as those of a gearmotor, become robust too.

    Raises `InputError` for a quantity that is not in the problem, cannot be robust, or has no gradient.
    """
    chosen_names = _names_to_make_robust(problem, plan)
    sides: dict[str, set[Side]] = {name: set() for name in chosen_names}
    for constraint in problem.every_constraint:
        if constraint.quantity in sides and not constraint.equality:
            sides[constraint.quantity] |= {"low"} if constraint.lower is not None else set()
            sides[constraint.quantity] |= {"high"} if constraint.upper is not None else set()
    for objective in problem.objectives:
        if objective.quantity in sides and objective.sense != "target":
            sides[objective.quantity].add("low" if objective.sense == "maximise" else "high")
    made: dict[tuple[str, Side], RobustQuantity] = {}
    for name, needed in sides.items():
        for side in sorted(needed):
            made[name, side] = RobustQuantity(
                inner=problem.quantity(name),
                side=side,
                case=plan.kind,
                order=plan.order,
                share=plan.share,
                samples=plan.samples,
                shape=plan.shape,
                seed=problem.settings.seed,
                suffix="robust" if len(needed) == 1 else f"robust_{side}",
            )
    names = {key: quantity.name for key, quantity in made.items()}
    return replace(
        problem,
        objectives=tuple(_robust_objective(objective, names) for objective in problem.objectives),
        constraints=tuple(_robust_constraints(problem.constraints, names)),
        variants=tuple(
            replace(variant, limits=tuple(_robust_constraints(variant.limits, names))) for variant in problem.variants
        ),
        catalogue=tuple(
            replace(variant, limits=tuple(_robust_constraints(variant.limits, names))) for variant in problem.catalogue
        ),
        own=(*problem.own, *made.values()),
    )


def robust_quantities(problem: Problem) -> tuple[RobustQuantity, ...]:
    """Return the robust quantities of a problem."""
    return tuple(quantity for quantity in problem.own if isinstance(quantity, RobustQuantity))


def has_robust_requirements(problem: Problem) -> bool:
    """Return whether any objective or constraint is robust, which takes a hundred times as long."""
    names = [item.quantity for item in problem.objectives] + [item.quantity for item in problem.every_constraint]
    return any(isinstance(problem.quantity(name), RobustQuantity) for name in names)


def nominal_problem(problem: Problem) -> Problem:
    """Return the nominal problem of a robust one."""
    inner = {quantity.name: quantity.inner.name for quantity in robust_quantities(problem)}
    return replace(
        problem,
        objectives=tuple(
            replace(item, quantity=inner.get(item.quantity, item.quantity)) for item in problem.objectives
        ),
        constraints=_nominal_constraints(problem.constraints, inner),
        variants=tuple(
            replace(variant, limits=_nominal_constraints(variant.limits, inner)) for variant in problem.variants
        ),
        catalogue=tuple(
            replace(variant, limits=_nominal_constraints(variant.limits, inner)) for variant in problem.catalogue
        ),
        own=tuple(quantity for quantity in problem.own if not isinstance(quantity, RobustQuantity)),
    )


def _names_to_make_robust(problem: Problem, plan: Robust) -> list[str]:
    """Return the names of the quantities to make robust."""
    bounded = [c.quantity for c in problem.every_constraint if not c.equality]
    able = list(dict.fromkeys([o.quantity for o in problem.objectives if o.sense != "target"] + bounded))
    held = {c.quantity for c in problem.every_constraint if c.equality}
    aimed = {o.quantity for o in problem.objectives if o.sense == "target"}
    same = {"".join(name.split()): name for name in (*able, *held, *aimed)}  # spaces in a formula do not matter
    chosen = (
        [name for name in able if not (of := problem.quantity(name)).about_tolerances and not of.is_constant]
        if plan.quantities is None
        else [same.get("".join(name.split()), name) for name in plan.quantities]
    )
    for name in chosen:
        if name not in able and name in held:
            raise InputError(
                f"{name} cannot be kept at one value within tolerances; got equals; give min and max, or leave it out "
                "of robust, so that it stays nominal"
            )
        if name not in able and name in aimed:
            raise InputError(
                f"a robust objective must be minimised or maximised; {name} has a target; leave it out of robust, so "
                "that it stays nominal"
            )
        if name not in able:
            raise InputError(
                f"robust quantities must be objectives or constraints; got {name!r}; choose from {', '.join(able)}"
            )
        if not problem.quantity(name).has_gradient:
            raise InputError(
                f'a robust quantity needs a gradient; got {name} with gradient = "none"; set gradient = "finite '
                'differences", or leave it out of robust'
            )
    if not chosen:
        raise InputError(
            "nothing can be robust here: equalities, targets and position errors stay nominal; name quantities, or "
            "leave out robust"
        )
    return list(dict.fromkeys(chosen))


def _robust_objective(objective: Objective, names: dict[tuple[str, Side], str]) -> Objective:
    if objective.sense == "target":
        return objective
    side: Side = "low" if objective.sense == "maximise" else "high"
    return replace(objective, quantity=names.get((objective.quantity, side), objective.quantity))


def _robust_constraints(
    constraints: tuple[Constraint, ...], names: dict[tuple[str, Side], str]
) -> Iterator[Constraint]:
    for constraint in constraints:
        name, lower, upper = constraint.quantity, constraint.lower, constraint.upper
        if constraint.equality or not {(name, "low"), (name, "high")} & set(names):
            yield constraint
            continue
        if lower is not None:
            yield Constraint(quantity=names[name, "low"], lower=lower)
        if upper is not None:
            yield Constraint(quantity=names[name, "high"], upper=upper)


def _nominal_constraints(constraints: tuple[Constraint, ...], inner: dict[str, str]) -> tuple[Constraint, ...]:
    """Return constraints on the nominal quantities, with their two sides joined again."""
    return merge_constraints(replace(item, quantity=inner.get(item.quantity, item.quantity)) for item in constraints)
