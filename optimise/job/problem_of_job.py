"""The problem that a job states."""

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from ...model.errors import InfeasibleError, InputError, JobError
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...objectives.formula.formulas import Formulas
from ...objectives.motion_deviation import motion_deviations
from ...objectives.quantity import Quantity
from ...objectives.registry import QUANTITIES
from ...objectives.tables.swing_columns import require_possible_cylinder, swing_quantities
from ..discrete.discrete_messages import require_meetable_requirements
from ..methods.registry import require_supported_settings
from ..problem.constraint_violation import FEASIBLE, relative_violation
from ..problem.contradictory_problems import no_option_error
from ..problem.problem import Problem, Variant
from ..problem.requirements import Constraint, merge_constraints
from .constraints_and_objectives import constraints_of, objectives_of, slow_stroke_of
from .contradictions import require_no_contradiction
from .custom_quantities import function_quantities, named_formulas
from .lever import require_parts_of_lever
from .mistake_messages import key_of_location
from .model import Job
from .motion import (
    require_constant_swing_speed,
    require_crank_speed,
    require_only_start_varies,
    require_starts_on_one_side_of_end,
    require_swing_motion,
    with_swing_margin,
)
from .option_amounts import amounts_of_choices, excess_amount_text
from .sections_table import make_robust
from .target_motion import require_target
from .variables_and_variants import (
    choices_and_variants,
    dimension_ranges,
    discrete_variables,
    has_list_of_values,
    machine_with_variables,
    range_of_dimension,
)


def problem_of(
    job: Job, *, folder: Path | None = None, installed: tuple[Quantity, ...] = (), require_feasible: bool = True
) -> Problem:
    """Return the problem that a job states. Raises JobError.

    folder: folder with the modules of its functions. installed: quantities from packages that it names.
    require_feasible: whether to raise `InfeasibleError` if the job is infeasible; a search needs that, a given
    design does not.
    """
    require_parts_of_lever(job.mechanism, costs=job.costs, target_motion=job.target_motion)
    variables, motion = job.variables, job.swing()
    machine = _machine_for_motion(job, motion)
    amounts = amounts_of_choices(
        {part.name: [option.amounts for option in part.option] for part in job.choice}, job.quantity
    )
    custom = (
        *amounts,
        *(() if job.target_motion is None else motion_deviations(job.target_motion.build())),
        *function_quantities(job.quantity, folder),
        *installed,
        *(() if motion is None else swing_quantities(motion)),
    )
    formulas = Formulas(custom, machine, dimension_ranges(job), named_formulas(job.quantity), turning=motion is None)
    choices, variants, catalogue = choices_and_variants(job, formulas, {of.name: of for of in amounts})
    objectives = tuple(objectives_of(job.objectives, formulas))
    constraints = with_swing_margin(
        _join_by_formula(constraints_of(job.constraints, formulas), formulas),
        job.motion.required_transmission_angle,
        motion,
    )
    named_quantities = {item.quantity for item in objectives} | {item.quantity for item in constraints}
    missing = [of for of in amounts if of.name in named_quantities]
    quantities = QUANTITIES | {of.name: of for of in (*custom, *formulas.formula_quantities.values())}
    variants, left_out = _possible_variants(variants, constraints, quantities, missing)
    catalogue, _ = _possible_variants(catalogue, constraints, quantities, missing)
    if choices and not variants:
        if require_feasible:
            raise no_option_error(left_out)
        choices, catalogue = (), ()  # the quantities that judge a design do not depend on them
    limits = [*constraints, *(limit for variant in variants for limit in variant.limits)]
    named = {*named_quantities, *(item.quantity for item in limits)}
    if motion is None:
        slow = bool(slow_stroke_of(job.constraints) or any(variant.slow_stroke for variant in variants))
        require_crank_speed(job.mechanism, machine, [quantities[name] for name in sorted(named)], slow)
    problem = Problem(
        name=job.name,
        mechanism=machine,
        crank=range_of_dimension(variables.crank),
        rod=range_of_dimension(variables.rod),
        offset=range_of_dimension(variables.offset),
        choices=choices,
        variants=variants,
        left_out=left_out,
        catalogue=catalogue,
        objectives=objectives,
        constraints=constraints,
        slow_stroke=slow_stroke_of(job.constraints),
        discrete=discrete_variables(job),
        motion=motion,
        costs=None if job.costs is None else job.costs.build(),
        sections=None if job.sections is None else job.sections.build(),
        settings=job.optimiser.build(),
        own=(
            *custom,
            *(
                formula
                for name, formula in formulas.formula_quantities.items()
                if name in job.quantity or name in named
            ),
        ),
    )
    _require_tolerances_below_lengths(problem)
    try:
        require_no_contradiction(problem)
        require_meetable_requirements(problem)
    except InfeasibleError as error:
        if require_feasible:
            error.problem = problem
            raise
    require_supported_settings(problem)
    return make_robust(problem, job.robust)


def _machine_for_motion(job: Job, motion: Swing | None) -> Mechanism:
    """Return the machine of a job. Raise an error for a target, numbers or quantities that its motion excludes."""
    paths = job.variables.stated_values_by_path
    require_target(job.target_motion, job.objectives, job.constraints)
    chosen = {path for part in job.choice for option in part.option for path in option.values_by_path}
    if motion is not None and not motion.of_full_turn:
        require_constant_swing_speed({*paths, *chosen})
    chosen |= {path for path, stated_value in paths.items() if has_list_of_values(stated_value)}
    require_only_start_varies({path: path in chosen for path in {**paths, **dict.fromkeys(chosen)}})
    require_swing_motion(motion, job.objectives, job.constraints)
    machine = machine_with_variables(job)
    require_starts_on_one_side_of_end(motion, machine.varying)
    return machine


def _require_tolerances_below_lengths(problem: Problem) -> None:
    """Reject a tolerance that may be as long as its link, because its unit must be wrong."""
    for part in problem.variants or (problem,):
        for name, ends in (("crank", part.crank), ("rod", part.rod)):
            limit = getattr(part.mechanism.with_largest_variables.tolerances, name).deviation_limit(ends.lower)
            if limit >= ends.lower:
                raise JobError(
                    f"tolerances.{name}: must be less than the {name} itself, which may be {1e3 * ends.lower:g} mm; "
                    f"got {1e3 * limit:g} mm; lower it"
                )


def _join_by_formula(constraints: Iterable[Constraint], formulas: Formulas) -> tuple[Constraint, ...]:
    """Return constraints, with those on the same formula merged, because a formula may be written in several ways.

    Raises `InfeasibleError` if they exclude every value.
    """
    joined: dict[str, Constraint] = {}
    for constraint in constraints:
        name = constraint.quantity
        try:
            (joined[name],) = merge_constraints((joined.get(name, constraint), constraint))
        except InputError:
            bounds_text = _bounds_text((joined[name], constraint), formulas.formula_quantities[name])
            raise InfeasibleError(
                f"{key_of_location(['constraints', name])}: the requirements on one formula must not contradict each "
                "other; "
                f"got {bounds_text}; leave out one of them"
            ) from None
    return tuple(joined.values())


def _possible_variants(
    variants: tuple[Variant, ...],
    constraints: tuple[Constraint, ...],
    quantities: Mapping[str, Quantity],
    required: Iterable[Quantity],
) -> tuple[tuple[Variant, ...], tuple[tuple[str, str], ...]]:
    """Return the variants whose limits are compatible with the job's constraints; labels of the others, with reasons.

    quantities: quantities by name. required: amounts that a variant must have.
    """
    reasons = [
        _missing_amount(variant, required)
        or _impossible_cylinder(variant)
        or _contradiction_of(variant, constraints, quantities)
        for variant in variants
    ]
    left_out = tuple(
        (", ".join(variant.labels), why) for variant, why in zip(variants, reasons, strict=True) if why is not None
    )
    return tuple(variant for variant, why in zip(variants, reasons, strict=True) if why is None), left_out


def _missing_amount(variant: Variant, required: Iterable[Quantity]) -> str | None:
    """Say which required amount a variant lacks; None if it lacks none."""
    amounts = dict(variant.amounts)
    return next(
        (f"no {quantity.title}, which the job requires" for quantity in required if quantity.name not in amounts), None
    )


def _impossible_cylinder(variant: Variant) -> str | None:
    """Say which sizes of a lever's cylinder do not belong to one cylinder with a variant; None if they do."""
    try:
        require_possible_cylinder(variant.mechanism)
    except InputError as error:
        return str(error).split("; ")[1].removeprefix("got ")
    return None


def _contradiction_of(
    variant: Variant, constraints: Iterable[Constraint], quantities: Mapping[str, Quantity]
) -> str | None:
    """Say which limit of a variant excludes every value that a constraint allows; None if none does."""
    constraint_by_name = {item.quantity: item for item in constraints}
    for name, value in variant.amounts:
        constraint = constraint_by_name.get(name)
        if constraint is not None and relative_violation(constraint, np.array([value]))[0] > FEASIBLE:
            unit = quantities[name].unit
            word, bound = next(
                (word, bound)
                for word, bound in constraint.sides
                if (value < bound and word != "max") or (value > bound and word != "min")
            )
            texts = [f"{number * unit.factor:.6g} {unit.symbol}".rstrip() for number in (value, bound)]
            return excess_amount_text(quantities[name].title, texts[0], word, texts[1])
    for limit in variant.limits:
        name = limit.quantity
        pair = (constraint_by_name[name], limit) if name in constraint_by_name else (limit,)
        try:
            (constraint_by_name[name],) = merge_constraints(pair)
        except InputError:
            return f"{quantities[name].title} {_bounds_text(pair, quantities[name])}, which exclude each other"
    return None


def _bounds_text(constraints: Iterable[Constraint], quantity: Quantity) -> str:
    """Describe the bounds that constraints set on a quantity."""
    sides = (side for item in constraints for side in item.sides)
    return " and ".join(
        f"{word} {bound * quantity.unit.factor:.6g} {quantity.unit.symbol}".rstrip() for word, bound in sides
    )
