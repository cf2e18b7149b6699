"""Contradictions within a job, detected before a search.

Only certain contradictions raise an error: each test holds for every design within the ranges. The optimiser detects
and reports subtler ones.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...model.errors import InfeasibleError, InputError, JobError
from ...model.machine.links_and_joints import Bar
from ...model.machine.loads.compressor import Compressor
from ...model.machine.mechanism import Mechanism
from ...model.machine.varying_numbers import number_at_path
from ...objectives.bar_pieces import LINKS, NEAR
from ...objectives.lengths_and_time_ratio import STROKE, TIME_RATIO
from ...objectives.link_strength import LinkStress
from ...objectives.swing_quantity import SwingQuantity
from ...objectives.units import quote
from ..feasibility.impossible_swing_reasons import require_swinging
from ..problem.contradictory_problems import require_longer_slow_stroke, require_nonzero_quantities
from ..problem.problem import Problem
from ..problem.requirements import Range, merge_constraints
from ..problem.restatement import restate_constraint
from ..search.elimination import offset_signs, require_offset_for_slow_stroke
from .linear_contradictions import require_compatible_linear_requirements, require_possible_option
from .mistake_messages import key_of_location
from .reachable_values import Box, require_reachable


def require_no_contradiction(problem: Problem) -> None:
    """Raise an error, naming key, rule, value and remedy, if the problem contradicts itself.

    It is an `InfeasibleError` if the parts are valid but no design meets them all, otherwise a `JobError`.
    """
    for key, quantity, word, value in _bounds_and_targets(problem):
        _require_possible_value(problem, key, quantity, word, value)
    for objective in problem.objectives:
        _require_varying_objective(problem, objective.quantity)
    _require_one_density(problem)
    require_nonzero_quantities(problem)
    require_eyes_wider_than_pins(problem)
    if problem.motion is not None:
        require_swinging(problem)
        return
    _require_compressor_delivery(problem)
    require_reachable(problem)
    _require_reachable_formulas(problem)
    require_slow_stroke(problem)
    require_possible_option(problem)
    require_compatible_linear_requirements(problem)


_ONE_MATERIAL = 0.05
"""Relative difference in density within which two bars may have the same material: steels lie between 7,700 and
8,000."""


def _require_one_density(problem: Problem) -> None:
    """Reject a bar with another density than the material in [sections]; a density that varies is exempt."""
    machine = problem.mechanism
    if machine.strength is None:
        return
    density = machine.strength.material.density
    free = {path for item in machine.varying for path in item.paths}
    for name in ("crank", "rod"):
        bar = getattr(machine, name)
        stated = isinstance(bar, Bar) and f"{name}.density" not in free
        if stated and not math.isclose(bar.density, density, rel_tol=_ONE_MATERIAL):
            raise JobError(
                f"mechanism.{name}.density: a bar must be of the material in [sections.material], its density within "
                f"{100.0 * _ONE_MATERIAL:.0f} % of that; got "
                f"{bar.density:.6g} kg/m^3 and sections.material.density = {density:.6g} kg/m^3; make them equal"
            )


def require_eyes_wider_than_pins(problem: Problem) -> None:
    """Raise `InfeasibleError` if stresses are required and no choice has eyes wider than their pins."""
    names = {*(item.quantity for item in problem.constraints), *(item.quantity for item in problem.objectives)}
    stresses = [item for item in map(problem.quantity, names) if isinstance(item, LinkStress)]
    if not stresses:
        return
    refused = []
    for part in problem.parts():
        links = {link for item in stresses for link in item.links_with_bars(part.mechanism)}
        reasons = [reason for link in sorted(links) for reason in _oversized_pin_messages(part.mechanism, link)]
        if not reasons:
            return
        refused.append(reasons[0])
    raise InfeasibleError(refused[0])


def _oversized_pin_messages(mechanism: Mechanism, link: str) -> list[str]:
    """Return why a link's eyes have no net section, whatever the values of the extra variables."""
    width = max(_number_range(mechanism, f"{link}.width"))
    return [
        f"mechanism.{link}.width: a bar must be wider than the pins in its eyes; got {1e3 * width:.6g} mm at most "
        f"and sections.pins.{pin} of {1e3 * least:.6g} mm at least; widen the bar or use a thinner pin"
        for pin in (NEAR, LINKS[link].far)
        if (least := min(_number_range(mechanism, f"strength.{pin}"))) >= width
    ]


def _number_range(mechanism: Mechanism, path: str) -> tuple[float, ...]:
    """Return the ends between which a number of a machine may vary, or its only value."""
    for item in mechanism.varying:
        for set_path, factor in item.sets:
            if set_path == path:
                return factor * item.lower, factor * item.upper
    value = number_at_path(mechanism.nominal, path)
    assert value is not None
    return (value,)


def _require_compressor_delivery(problem: Problem) -> None:
    """Reject compressors whose clearance is too large for any stroke within the ranges, in every variant."""
    reasons = [_why_nothing_delivered(part) for part in problem.parts()]
    if reasons and all(reasons):
        raise InfeasibleError(reasons[0])


def _why_nothing_delivered(part: Problem) -> str:
    """Return why a compressor of a problem without choices delivers in no design, or "".

    After expansion to the suction pressure, the gas left in the clearance must not fill the swept volume. A stroke is
    at most 2 sqrt(r l), reached at e = l - r.
    """
    stroke_limits = [item.upper for item in part.constraints if item.quantity == STROKE.name and item.upper is not None]
    stroke = min([2.0 * math.sqrt(part.crank.upper * part.rod.upper), *stroke_limits])
    varies = {path for item in part.mechanism.varying for path in item.paths}
    for k, load in enumerate(part.mechanism.loads):
        if not isinstance(load, Compressor) or load.expansion_exponent == 0.0 or load.clearance_volume == 0.0:
            continue
        if any(path.startswith(f"loads.{k}.") for path in varies):
            continue
        grown = (load.high / load.low) ** (1.0 / load.expansion_exponent) - 1.0
        swept = 0.25 * math.pi * (load.bore**2 - load.piston_rod**2) * stroke
        greatest_volume = swept * (1.0 / grown - load.clearance)
        if load.clearance_volume >= greatest_volume:
            return (
                f"load #{k + 1}.clearance_volume: must be below {1e6 * greatest_volume:.4g} cm^3, otherwise a stroke "
                "of "
                f"{1e3 * stroke:.6g} mm, the longest in the job, delivers nothing at {load.high / load.low:.4g} times "
                f"the suction pressure; got {1e6 * load.clearance_volume:.6g} cm^3; reduce it or the pressure ratio, "
                "or allow longer strokes"
            )
    return ""


def _require_reachable_formulas(problem: Problem) -> None:
    """Raise `InfeasibleError` if formulas require values of known quantities beyond those within the ranges."""
    restated = {item.quantity: restate_constraint(problem, item) for item in problem.constraints}
    keys = [key_of_location(["constraints", name]) for name, item in restated.items() if item.quantity != name]
    if not keys:
        return
    words = f"{' and '.join(keys)} {'requires' if len(keys) == 1 else 'require'} in other words"
    try:
        require_reachable(replace(problem, constraints=merge_constraints(restated.values())))
    except InputError as error:
        raise InfeasibleError(f"{error}; this is equivalent to what {words}") from None


def _bounds_and_targets(problem: Problem) -> Iterator[tuple[str, str, str, float]]:
    """Yield key, quantity, word and value of every bound and target."""
    for constraint in problem.constraints:
        for word, value in constraint.sides:
            yield key_of_location(["constraints", constraint.quantity]), constraint.quantity, word, value
    for variant in problem.variants:
        for constraint in variant.limits:
            for word, value in constraint.sides:
                yield (
                    f"choice {' and '.join(map(quote, variant.labels))}: {key_of_location([constraint.quantity])}",
                    constraint.quantity,
                    word,
                    value,
                )
    for objective in problem.objectives:
        if objective.target is not None:
            yield key_of_location(["objectives", objective.quantity]), objective.quantity, "target", objective.target


def _require_possible_value(problem: Problem, key: str, name: str, word: str, value: float) -> None:
    """Reject a value that a quantity cannot have in any linkage."""
    quantity = problem.quantity(name)
    value_text = f"got {word} {value * quantity.unit.factor:.6g} {quantity.unit.symbol}".rstrip()
    # A swing may exceed the domain that full rotation imposes.
    turning = problem.motion is None or isinstance(quantity, SwingQuantity)
    if turning and quantity.domain is not None and quantity.domain.refuses_bound(value, least=word == "min"):
        raise JobError(f"{key}: {quantity.domain.rule}; {value_text}; {quantity.domain.remedy}")
    if not quantity.signed and value < 0.0:
        raise JobError(f"{key}: {name} is never negative; {value_text}; give its size")


def _require_varying_objective(problem: Problem, name: str) -> None:
    """Reject an objective that is the same for every design."""
    equality = next(
        (
            c
            for c in problem.constraints
            if c.equality and name in (c.quantity, restate_constraint(problem, c).quantity)
        ),
        None,
    )
    if equality is not None:
        raise JobError(
            f"objectives.{name}: a quantity with a fixed value cannot also be an objective; got "
            f"{key_of_location(['constraints', equality.quantity])} with equals; leave out one of the two"
        )
    centred = problem.offset.fixed and problem.offset.lower == 0.0
    if centred and problem.quantity(name).in_line is not None:
        # With a speed profile, a ratio of times is also the same for every design, though not 1.
        values = {_value_without_offset(part, name) for part in problem.parts()}
        if len(values) > 1:
            return
        value = values.pop()
        raise JobError(
            f"objectives.{name}: without offset it is {value} for every design; got offset fixed "
            "at 0; give variables.offset a range or leave out the objective"
        )


def _value_without_offset(part: Problem, name: str) -> str:
    """Return the value, as text, of a quantity that is the same for every design without offset."""
    design = np.array([[1.0, 3.0, 0.0, *(item.lower for item in part.mechanism.varying)]])
    value = float(part.quantity(name).evaluate(part.mechanism, design).values[0])
    return "infinite" if value == math.inf else f"{value:.6g}"


def require_slow_stroke(problem: Problem) -> None:
    """Raise `InfeasibleError`, naming rule, value and remedy, if no design has the required slow stroke.

    Call it only if some designs within the ranges rotate fully.
    """
    parts = problem.parts()
    require_offset_for_slow_stroke(problem, parts)
    if any(part.slow_stroke is None for part in parts):
        return
    ratio = next((c for c in problem.constraints if c.quantity == TIME_RATIO.name), None)
    require_longer_slow_stroke(problem)
    if any(part.mechanism.speed_profile is not None for part in parts):
        return  # neither the offset's sign nor a closed form then decides which stroke is slow
    ends = [sign * size for part in parts for sign, sizes in offset_signs(part) for size in (sizes.lower, sizes.upper)]
    narrowed = replace(
        problem,
        offset=Range(lower=min(ends), upper=max(ends)),
        choices=(),
        variants=(),
    )
    try:
        require_reachable(narrowed)
    except InfeasibleError as error:
        side = "above" if narrowed.offset.lower >= 0.0 else "below"
        alternative = f"or leave out constraints.slow_stroke, which keeps the offset {side} 0"
        raise InfeasibleError(f"{error}, {alternative}") from None
    greatest = Box.from_problem(narrowed).bounds_on_quantity(TIME_RATIO)[1]
    floor = TIME_RATIO.floor or 1.0
    if greatest < floor and (ratio is None or ((ratio.lower or 0.0) <= 1.0 and ratio.upper is None)):
        least = 1.0 + 0.5 * (greatest - 1.0)
        raise InfeasibleError(
            f"constraints.slow_stroke: a stroke counts as slow from a time ratio of {floor:g} unless the job sets "
            f"another; the ranges of crank, rod and offset allow at most {greatest:.6g}; allow a longer crank or a "
            f"larger offset, or set constraints.{TIME_RATIO.name} = {{ min = {least:.4g} }}"
        )
