"""Job in words and as data, as the software understands it."""

import math
from collections.abc import Mapping
from typing import Any

from ...model.cycle.crank_speed import turn_time
from ...model.linkage.dimensions import DIMENSIONS
from ...model.machine.cylinders_and_turns import cycle_turns
from ...model.machine.links_and_joints import Bar, Friction, Link
from ...model.machine.loads.load_text import join_range_ends
from ...model.machine.mechanism import Mechanism, Strength, Tolerance
from ...model.machine.varying_numbers import Varying
from ...model.swing.end_angles import swing_start_column
from ...objectives.kinds import count_with_noun
from ...objectives.motion_deviation import MotionDeviation
from ...objectives.own.quantity import OwnQuantity
from ...objectives.tables.design_input import column_of_variable, columns_of_design_numbers
from ...optimise.job.linear_contradictions import impossible_option_notes, impossible_options
from ...optimise.problem.constraint_violation import constraints_with_floors
from ...optimise.problem.contradictory_problems import idle_constraint_warnings
from ...optimise.problem.problem import Problem
from ...optimise.problem.question_registry import changes_of
from ...optimise.problem.requirements import Constraint, Discrete, Objective, Range
from ...optimise.problem.restatement import restate_constraint
from ...optimise.problem.tolerance_costs import Cost
from ...optimise.search.driving_load_warnings import driving_load_warnings
from ...optimise.search.elimination import EliminationBranch, elimination_branches
from ...optimise.search.stroke_warnings import overlong_part_warnings, stroke_warnings

_MOST_VALUES = 6  # maximum number of values of a variable that are all listed


def problem_in_words(problem: Problem) -> dict[str, Any]:
    """Return a job in words: name, given, loads, tolerances, costs, variables, rules, objectives, warnings, search.

    Each is a list of lines except name, search, the degrees of freedom, the minimum values, see
    `_allowed_minimum_values`, and the changes that resolve warnings, see `changes_of`.
    """
    branch = elimination_branches(problem)[0]
    settings = problem.settings
    samples = f", {count_with_noun(settings.samples, 'sample')} per round" if settings.samples else ""
    warnings = [
        *problem.warnings,
        *driving_load_warnings(problem),
        *overlong_part_warnings(problem),
        *stroke_warnings(problem),
        *idle_constraint_warnings(problem),
        *impossible_option_notes(problem),
    ]
    return {
        "name": problem.name,
        "given": [*_motion_lines(problem), *_machine_lines(problem), *_custom_lines(problem)],
        "loads": problem.mechanism.load_texts,
        "tolerances": _tolerance_lines(problem.mechanism),
        "costs": [] if problem.costs is None else [_cost_text(*item) for item in problem.costs.costs_by_name.items()],
        "variables": [
            *(f"{name} {_length_text(problem, name)}" for name in DIMENSIONS),
            *(_varying_text(item) for item in problem.mechanism.varying),
            *(_values_text(problem, item) for item in problem.discrete),
            *_choice_lines(problem),
        ],
        "rules": [
            *([f"slow stroke {problem.slow_stroke}"] if problem.slow_stroke else []),
            *(_constraint_text(constraint, problem) for constraint in constraints_with_floors(problem)),
            *_limit_lines(problem),
        ],
        "floors": _allowed_minimum_values(problem),
        "objectives": [_objective_text(objective, problem) for objective in problem.objectives],
        "unknowns": 3 + len(problem.mechanism.varying),
        "degrees_of_freedom": _degrees_of_freedom(branch),
        "eliminated": list(branch.eliminated),
        "warnings": warnings,
        "changes": changes_of(warnings),
        "search": f"{settings.method}, at most {count_with_noun(settings.designs, 'design')}, "
        f"seed {settings.seed}{samples}",
    }


def job_in_words(problem: Problem, tables: Mapping[str, Any]) -> dict[str, Any]:
    """Return `problem_in_words` of a problem, with the content of files, and notes on the tables that state it."""
    from ...optimise.job.job_notes import file_summaries, job_notes

    return problem_in_words(problem) | {"files": file_summaries(tables), "notes": job_notes(tables)}


def freedom_in_words(problem: Problem) -> str:
    """Return the remaining degrees of freedom as a sentence."""
    branch = elimination_branches(problem)[0]
    left, unknowns = _degrees_of_freedom(branch), len(branch.names)
    numbers = "dimensions" if unknowns == 3 else "dimensions and other numbers"
    if _is_fixed(branch):
        return f"all {numbers} are fixed; requirements are only checked"
    text = f"{left} of {unknowns} {numbers} left to choose"
    if left < 0:
        text = f"{-left} more equalities than dimensions: a design exists only if they agree"
    elif left == 0:
        text = f"{text}: the equalities usually leave single designs"
    if branch.eliminated:
        text += f"; {', '.join(name.replace('_', ' ') for name in branch.eliminated)} met exactly by elimination"
    return text


def _is_fixed(branch: EliminationBranch) -> bool:
    return all(ends.fixed for ends in branch.bounds.values())


def _degrees_of_freedom(branch: EliminationBranch) -> int:
    equalities = 0 if _is_fixed(branch) else sum(constraint.equality for constraint in branch.remaining)
    return len(branch.free) - equalities


def _machine_lines(problem: Problem) -> list[str]:
    """Return the lines that describe the machine of a problem, with the ranges of its variables."""
    low, high = (machine_in_words(problem, end) for end in problem.mechanism.at_bounds_of_variables)
    if len(low) != len(high):  # a number that is zero at one end would omit its line
        return machine_in_words(problem, problem.mechanism)
    return [join_range_ends(lowest, highest) for lowest, highest in zip(low, high, strict=True)]


def machine_in_words(problem: Problem, mechanism: Mechanism) -> list[str]:
    """Return the lines that describe a machine of a problem: the stated machine, or that of a design."""
    return [*_speed_lines(problem, mechanism), *_mechanism_lines(mechanism)]


def _speed_lines(problem: Problem, mechanism: Mechanism) -> list[str]:
    if problem.motion is not None and not problem.motion.of_full_turn:
        return []
    if not mechanism.speed:
        return ["no crank speed: static"]
    turning = "clockwise" if mechanism.speed < 0.0 else "counter-clockwise"
    mean = "" if mechanism.speed_profile is None else "mean over the crank angle, "
    speed = f"crank speed {mechanism.speed * 30.0 / math.pi:.6g} rpm ({mean}{turning})"
    if mechanism.acceleration:
        return [speed]
    turns, seconds = cycle_turns(mechanism), turn_time(mechanism)
    cycle = "cycle time" if turns == 1 else "cycle time (two turns)"
    return [speed, f"{cycle} {turns * seconds:.6g} s, {60.0 / seconds:.6g} strokes per minute"]


def _mechanism_lines(mechanism: Mechanism) -> list[str]:
    lines = []
    if mechanism.speed_profile is not None:
        lines.append(
            f"speed over the crank angle: {mechanism.speed_profile.description}; quantities follow this profile"
        )
    if mechanism.acceleration:
        lines.append(f"crank acceleration {mechanism.acceleration:.6g} rad/s^2")
    links = ("crank", "rod") if mechanism.lever is None else ("crank",)
    lines += [f"{name}: {_link_text(getattr(mechanism, name))}" for name in links]
    if mechanism.counterweight.mass:
        weight = mechanism.counterweight
        lines.append(
            f"counterweight: {weight.mass:.6g} kg, {1e3 * weight.radius:.6g} mm from the pivot "
            f"at {math.degrees(weight.angle):.6g} deg from the crank"
        )
    if mechanism.lever is None:
        lines.append(f"slider: {mechanism.slider_mass:.6g} kg{mechanism.slider.text}")
    else:
        lines += mechanism.lever.texts
    if mechanism.arrangement is not None:
        lines.append(f"on one crankshaft: {mechanism.arrangement.text}")
        lines.append(
            "for all cylinders together: torque, power, work, energy, volumes and shaking; for the cylinder with "
            "the greatest value: joint forces and slider motion; for a cylinder whose line is not rotated: stresses "
            "and wear"
        )
    if any(mechanism.gravity):
        x, y = mechanism.gravity
        lines.append(f"gravity ({x:.6g}, {y:.6g}) m/s^2 along x and y")
    lines += [f"load: {load.text}" for load in mechanism.loads]
    if mechanism.drive is not None:
        lines.append(f"drive: {mechanism.drive.text}")
    lines += _friction_lines(mechanism.friction)
    lines += _strength_lines(mechanism.strength)
    if mechanism.branch == "crossed":
        lines.append("crossed branch")
    return lines


def _motion_lines(problem: Problem) -> list[str]:
    swing = problem.motion
    if swing is None:
        return []
    if swing.of_full_turn:
        return ["the crank rotates fully and turns the line from the second pivot"]
    factor, unit = (180.0 / math.pi, "deg") if swing.stated_for == "crank" else (1e3, "mm")
    start, end = (f"{factor * value:.6g}" for value in (swing.start, swing.end))
    ends = f"{swing.stated_for} swings from {start} to {end} {unit} and back"
    if swing_start_column(problem.mechanism) is not None:
        moved = f"by {factor * (swing.end - swing.start):.6g} {unit}" if swing.follows else f"to {end} {unit}"
        ends = f"{swing.stated_for} swings {moved} from the start of each design, and back"
    if swing.stated_for == "slider":
        ends += f", the crank pin {swing.side} of the line to the slider pin"
    timed = "" if swing.duration is None else f", {swing.duration:.6g} s per stroke"
    if swing.driver == "cylinder":
        ends = ends.replace("crank swings", "lever swings")
    lines = [f"{ends}; driven at the {swing.driver}, law {swing.law}{timed}"]
    if swing.actuator_tolerance:
        lines.append(f"tolerance of the actuator {1e3 * swing.actuator_tolerance:.6g} mm")
    return lines


def _custom_lines(problem: Problem) -> list[str]:
    lines = [
        f"{quantity.name}: {quantity.title}, by {quantity.function}"
        for quantity in problem.own
        if isinstance(quantity, OwnQuantity)
    ]
    targets = {
        quantity.target
        for quantity in problem.own
        if isinstance(quantity, MotionDeviation) and quantity.target is not None
    }
    return [
        *(f"target motion: {len(t.positions)} points, phase {t.phase}, shift {t.shift}" for t in targets),
        *lines,
    ]


def _link_text(link: Link) -> str:
    if isinstance(link, Bar):
        return f"bar {1e3 * link.width:.6g} x {1e3 * link.depth:.6g} mm (width x depth), {link.density:.6g} kg/m^3"
    if not link.mass:
        return "no mass"
    centre = "half-way" if link.centre is None else f"{1e3 * link.centre:.6g} mm along"
    inertia = "of a slender rod" if link.inertia is None else f"{link.inertia:.6g} kg m^2"
    centre_across = f" and {1e3 * link.centre_across:.6g} mm across" if link.centre_across else ""
    return f"{link.mass:.6g} kg, mass centre {centre}{centre_across}, inertia {inertia}"


def _friction_lines(friction: Friction) -> list[str]:
    lines = [f"friction in the guide: coefficient {friction.guide:.6g}"] if friction.guide else []
    for name in ("crank_pivot", "crank_pin", "slider_pin"):
        pin = getattr(friction, name)
        if pin.friction_circle_radius:
            lines.append(
                f"friction in the {name.replace('_', ' ')}: radius {1e3 * pin.radius:.6g} mm, "
                f"coefficient {pin.coefficient:.6g}"
            )
    return lines


def _strength_lines(strength: Strength | None) -> list[str]:
    """Return material, pins, and assessment of stresses; empty for a machine without [sections]."""
    if strength is None:
        return []
    names = ("elasticity", "yield_strength", "ultimate_strength", "endurance", "bearing_pressure")
    pressures = {name.replace("_", " "): getattr(strength.material, name) for name in names}
    pins = {name.replace("_", " "): getattr(strength, name) for name in ("crank_pivot", "crank_pin", "slider_pin")}
    lines = [
        f"material of crank and rod: {strength.material.density:.6g} kg/m^3",
        *(
            f"{name} of the material: " + (f"{1e-9 * value:.6g} GPa" if value >= 1e10 else f"{1e-6 * value:.6g} MPa")
            for name, value in pressures.items()
        ),
        f"pins: {', '.join(f'{name} {1e3 * value:.6g} mm' for name, value in pins.items())}",
        f"stress concentration of the eyes: {strength.eye_concentration:.6g}",
        f"mean stresses in fatigue: by {strength.criterion.capitalize()}",
    ]
    if strength.wear_coefficient is not None:
        lines.append(f"wear coefficient: {1e6 * strength.wear_coefficient:.6g} mm^2/N")
    return lines


def _tolerance_lines(mechanism: Mechanism) -> list[str]:
    tolerances = mechanism.tolerances
    lines = [f"{name} {text}" for name in DIMENSIONS if (text := _tolerance_text(getattr(tolerances, name)))]
    if tolerances.crank_angle.absolute:
        lines.append(f"crank angle {math.degrees(tolerances.crank_angle.absolute):.6g} deg")
    for name in ("crank_pivot", "crank_pin", "slider_pin", "guide"):
        clearance = getattr(tolerances.clearances, name)
        if clearance:
            lines.append(f"radial clearance of the {name.replace('_', ' ')} {1e3 * clearance:.6g} mm")
    window = tolerances.window
    if lines and (window.during != "cycle" or window.start > 0.0 or window.end < 1.0):
        lines.append(f"counted in the {window.during}, {window.start:.6g} to {window.end:.6g} of the stroke")
    return lines


def _tolerance_text(tolerance: Tolerance) -> str:
    parts = ((1e3 * tolerance.absolute, "mm"), (100.0 * tolerance.fraction, "%"))
    return " + ".join(f"{value:.6g} {unit}" for value, unit in parts if value)


def _cost_text(name: str, cost: Cost) -> str:
    factor, unit = (math.degrees(1.0), "deg") if name == "crank_angle" else (1e3, "mm")
    power = "" if cost.exponent == 1.0 else f"^{cost.exponent:.6g}"
    fixed = f"{cost.fixed:.6g} + " if cost.fixed else ""
    ends = [f"at least {factor * cost.least:.6g} {unit}"] if cost.least else []
    ends += [f"at most {factor * cost.greatest:.6g} {unit}"] if math.isfinite(cost.greatest) else []
    text = f"{name.replace('_', ' ')} {fixed}{cost.cost:.6g} ({factor * cost.at:.6g} {unit} / tolerance){power}"
    return ", ".join([text, *ends])


def _length_text(problem: Problem, name: str) -> str:
    """Return the range of a dimension, or all its choices."""
    ranges = sorted({(getattr(part, name).lower, getattr(part, name).upper) for part in problem.variants})
    if len(ranges) < 2:
        return _length_range_text(getattr(problem, name))
    return f"{', '.join(f'{1e3 * lower:.6g}' for lower, _ in ranges)} mm, one of these"


def _varying_text(item: Varying) -> str:
    unit = column_of_variable(item)[1]
    ends = f"{unit.factor * item.lower:.6g} to {unit.factor * item.upper:.6g} {unit.symbol}".rstrip()
    return f"{item.name} {ends}"


def _values_text(problem: Problem, item: Discrete) -> str:
    """Return the values of a discrete variable: its rule, and its first and last values."""
    unit = columns_of_design_numbers(problem.mechanism.varying)[item.name][1]
    values = [f"{unit.factor * value:.6g}" for value in item.values]
    few = values if len(values) <= _MOST_VALUES else [*values[:2], "...", values[-1]]
    return f"{item.name} {item.rule}: {count_with_noun(len(values), 'value')}, {', '.join(few)} {unit.symbol}".rstrip()


def _choice_lines(problem: Problem) -> list[str]:
    """Return the options of each choice that a design can have, and the number of their combinations."""
    lines = []
    idle = {label for label, _ in impossible_options(problem)}
    possible = [variant for variant in problem.variants if ", ".join(variant.labels) not in idle]
    for place, name in enumerate(problem.choices):
        options = dict.fromkeys(
            _option_text(name, variant.labels[place], variant.mechanism.speed) for variant in possible
        )
        lines.append(f"{name}: {', '.join(options)}")
    count = len(possible)
    if count > 1:
        lines.append(f"{count} combinations of choices, all tried")
    return lines


def _option_text(name: str, label: str, speed: float) -> str:
    """Return an option as the job states it, and a speed also in rpm. speed: crank speed, rad/s."""
    rpm = f"{speed * 30.0 / math.pi:.6g} rpm"
    return f"{label} ({rpm})" if name == "speed" and label != rpm else label


_MOST_LISTED = 12  # maximum number of combinations whose limits are listed individually


def _limit_lines(problem: Problem) -> list[str]:
    """Return the limits for each combination of choices, such as the limits of a gearmotor."""
    limited = [variant for variant in problem.variants if variant.limits]
    if len(limited) > _MOST_LISTED:
        return [f"limits set by {len(limited)} combinations of choices"]
    return [
        f"with {' and '.join(variant.labels)}: {_constraint_text(limit, problem, is_stated=True)}"
        for variant in limited
        for limit in variant.limits
    ]


def _length_range_text(bounds: Range) -> str:
    if bounds.fixed:
        return f"{1e3 * bounds.lower:.6g} mm, fixed"
    return f"{1e3 * bounds.lower:.6g} to {1e3 * bounds.upper:.6g} mm"


def _constraint_text(constraint: Constraint, problem: Problem, *, is_stated: bool = False) -> str:
    """Return a constraint in words. is_stated: whether it certainly comes from the job."""
    quantity = problem.quantity(constraint.quantity)
    is_stated = is_stated or constraint in problem.constraints

    def format_bound(value: float) -> str:
        return f"{value * quantity.unit.factor:.6g} {quantity.unit.symbol}".rstrip()

    if constraint.equality:
        return f"{quantity.title} = {format_bound(constraint.lower or 0.0)}"
    ends = (("at least", constraint.lower), ("at most", constraint.upper))
    bounds = " and ".join(f"{word} {format_bound(end)}" for word, end in ends if end is not None)
    if is_stated:
        replaces = quantity.floor is not None and constraint.lower is not None and constraint.lower < quantity.floor
        return f"{quantity.title} {bounds}" + (
            f" (replaces the default of {format_bound(quantity.floor or 0.0)})" if replaces else ""
        )
    return f"{quantity.title} {bounds} (default, as the job sets none)"


def _allowed_minimum_values(problem: Problem) -> list[dict[str, Any]]:
    """Return the least allowed values of quantities with a default: quantity, value, unit, whether it is that one."""
    floors = []
    for constraint in constraints_with_floors(problem):
        restated = restate_constraint(problem, constraint)
        quantity = problem.quantity(restated.quantity)
        if quantity.floor is not None and restated.lower is not None:
            value, default = restated.lower * quantity.unit.factor, constraint not in problem.constraints
            floors.append(
                {"quantity": quantity.name, "least": value, "unit": quantity.unit.symbol, "is_default": default}
            )
    return floors


def _objective_text(objective: Objective, problem: Problem) -> str:
    quantity = problem.quantity(objective.quantity)
    if objective.target is None:
        return f"{objective.sense} {quantity.title}"
    return f"bring {quantity.title} to {objective.target * quantity.unit.factor:.6g} {quantity.unit.symbol}".rstrip()
