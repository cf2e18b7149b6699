"""Values that the ranges of a swing job allow, from samples: closing, travel, feasible fraction, an example."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from pydantic import ValidationError

from ...model.arrays import Array
from ...model.errors import InputError
from ...model.kinematics.position import motion
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.closure import swings_without_dead_point
from ...model.swing.end_angles import swing_ends
from ...model.swing.swing import STARTS, Swing, with_start_set_by_machine
from ...model.turning_cylinder.lever_of_design import lever_sizes
from ...model.turning_cylinder.levers_of_designs import can_make_motion
from ...objectives.lever_geometry import CYLINDER_TRAVEL
from ...objectives.swing_quantities import ACTUATOR_TRAVEL, SWING_ANGLE, SWING_TRANSMISSION_ANGLE
from ...objectives.tables.swing_columns import swing_quantities
from ...optimise.job.motion import MotionPart, with_swing_margin
from ...optimise.job.named_files import table_in
from ...optimise.problem.constraint_violation import constraints_with_floors
from ...optimise.problem.problem import Problem
from ...optimise.problem.requirements import Objective
from .partial_job import ranges_of, requirement_names
from .possible_values import PATIENCE, Ends, Feasibility, example_design, lengths_of, run_within
from .samples import Screening, sampled_designs, screened_samples


@dataclass(frozen=True, kw_only=True)
class PossibleSwing(Feasibility):
    """Values that the ranges of a swing job allow. closing: fraction of the box that makes the swing.

    travel (m): its range for designs that meet the margin and the other checked requirements, if any do; None if no
    design makes the swing. example_swing: swing of the example, between crank angles. example_lever: machine of the
    example if it is a lever; its travel is that of its cylinder.
    """

    swing: Swing
    example_swing: Swing | None
    branch: float
    closing: float
    travel: Ends | None
    example_lever: Mechanism | None = None

    def position_at(self, crank_angle: float) -> float:
        """Return the slider position of the example, m, or the length of its cylinder, at a crank angle, rad."""
        assert self.example is not None
        if self.example_lever is not None:
            return float(lever_sizes(self.example_lever, Linkage(*self.example)).cylinder_length(crank_angle))
        return float(slider_positions(crank_angle, self.branch, np.array([self.example]))[0])

    def ends_of(self, swing: Swing) -> tuple[float, float]:
        """Return the positions at both ends of the example's swing, m; of a full turn the least and the greatest."""
        if self.example_lever is not None and self.example is not None and swing.of_full_turn:
            return lever_sizes(self.example_lever, Linkage(*self.example)).closable_length_range
        return self.position_at(swing.start), self.position_at(swing.end)


def possible_swing(tables: Mapping[str, Any], full_problem: Problem | None) -> PossibleSwing | None:
    """Return the values that the ranges of a job allow; None for full rotation, and while the job is unreadable.

    full_problem: the problem of the whole job, if it is valid; a lever needs it. Of several options the first is used.
    """
    if table_in(tables, "mechanism").get("inversion") is not None:
        return None if full_problem is None else _possible_lever(full_problem.part(0))
    try:
        part = MotionPart.model_validate(tables.get("motion", {}))
        swing, ranges = part.build(), ranges_of(tables)
        margin = with_swing_margin((), part.required_transmission_angle, swing)
    except (InputError, ValidationError):
        return None
    if swing is None or ranges is None:
        return None
    crossed = table_in(tables, "mechanism").get("branch") == "crossed"
    cheap = ACTUATOR_TRAVEL if swing.stated_for == "crank" else SWING_ANGLE
    objectives = (Objective(quantity=cheap.name, sense="minimise"),)
    free = (
        ()
        if full_problem is None
        else tuple(item for item in full_problem.mechanism.varying if item.paths[0] in STARTS.values())
    )
    light = Problem(
        name="preview",
        mechanism=Mechanism(speed=1.0, branch="crossed" if crossed else "open", start=part.start_ranges, varying=free),
        crank=ranges["crank"],
        rod=ranges["rod"],
        offset=ranges["offset"],
        objectives=objectives,
        constraints=margin,
        motion=swing,
        own=swing_quantities(swing),
    )
    full = None if full_problem is None else replace(full_problem.part(0), objectives=objectives)
    screening = None if full is None else run_within(PATIENCE, lambda: screened_samples(full))
    named = requirement_names(tables)
    unchecked = () if screening is not None else tuple(name for name in named if name != SWING_TRANSMISSION_ANGLE.name)
    return _possible_swing(swing, light, screened_samples(light) if screening is None else screening, unchecked)


def _possible_swing(swing: Swing, light: Problem, sample: Screening, unchecked: tuple[str, ...]) -> PossibleSwing:
    sign = -1.0 if light.mechanism.nominal.branch == "crossed" else 1.0
    box, is_uniform = sampled_designs(replace(light, constraints=()))
    turning = swings_without_dead_point(light.mechanism, swing, box)
    designs, good = sample.designs, sample.is_feasible
    closes = np.isfinite(sample.violation)
    example = example_design(designs, sample.violation, box[turning])
    basis = designs[good] if good.any() else designs[closes] if closes.any() else box[turning]
    ends = swing_ends(light.mechanism, swing, basis)
    travel = np.abs(slider_positions(ends.end, sign, basis) - slider_positions(ends.start, sign, basis))
    example_swing = None
    if example is not None:
        example_ends = swing_ends(light.mechanism, swing, example[None])
        example_swing = replace(
            swing, start=float(example_ends.start[0]), end=float(example_ends.end[0]), stated_for="crank", follows=False
        )
    return PossibleSwing(
        swing=swing,
        example_swing=example_swing,
        branch=sign,
        closing=float(turning[is_uniform].mean()),
        travel=(float(travel.min()), float(travel.max())) if len(travel) else None,
        feasible=sample.feasible_fraction,
        sampled=sample.uniform_sample_count,
        met_by_all=sample.met_by_all,
        example=lengths_of(example),
        example_feasible=bool(good.any()),
        unchecked=unchecked,
    )


def _possible_lever(problem: Problem) -> PossibleSwing | None:
    """Return the values that the ranges of a lever allow; None if it does not swing."""
    swing = problem.motion
    if swing is None:
        return None
    light = replace(problem, objectives=(Objective(quantity=CYLINDER_TRAVEL.name, sense="minimise"),))
    box, is_uniform = sampled_designs(replace(light, constraints=()))
    passing = can_make_motion(light.mechanism, swing, box)
    screening = run_within(PATIENCE, lambda: screened_samples(light))
    checked = light if screening is not None else replace(light, constraints=())
    sample = screened_samples(checked) if screening is None else screening
    good, closes = sample.is_feasible, np.isfinite(sample.violation)
    basis = sample.designs[good] if good.any() else sample.designs[closes] if closes.any() else box[passing]
    travel = light.quantity(CYLINDER_TRAVEL.name).evaluate(light.mechanism, basis).values if len(basis) else basis
    example = example_design(sample.designs, sample.violation, box[passing])
    machine = None if example is None else light.mechanism.with_values(example[3:].tolist())
    placed = None if machine is None else with_start_set_by_machine(machine, swing)
    return PossibleSwing(
        swing=swing,
        example_swing=placed,
        branch=1.0,
        closing=float(passing[is_uniform].mean()),
        travel=(float(travel.min()), float(travel.max())) if len(travel) else None,
        feasible=sample.feasible_fraction,
        sampled=sample.uniform_sample_count,
        met_by_all=sample.met_by_all,
        example=lengths_of(example),
        example_feasible=bool(good.any()),
        unchecked=()
        if checked is light
        else tuple(constraint.quantity for constraint in constraints_with_floors(problem)),
        example_lever=machine,
    )


def slider_positions(angle: float | Array, sign: float, designs: Array) -> Array:
    """Return slider positions (n,), m, of designs (n, 3) at a crank angle; NaN where the linkage does not close."""
    r, l, e = designs[:, 0], designs[:, 1], designs[:, 2]
    with np.errstate(invalid="ignore", divide="ignore"):
        closes = np.abs(e - r * np.sin(angle)) < l
        return np.where(closes, motion(np.sin(angle), np.cos(angle), r, l, e, sign).x, np.nan)
