"""More variables than the three dimensions, and discrete choices: optima that are known, or found another way."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

from slidercrank.model.errors import InputError
from slidercrank.model.machine.links_and_joints import Counterweight, RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.front.dominance import nondominated
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.front.hypervolume import hypervolume
from slidercrank.optimise.problem.problem import Problem, Variant
from slidercrank.optimise.problem.requirements import Constraint, Range
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.solve import solve
from tests.optimise.problems import MACHINE, degrees, problem

pytestmark = pytest.mark.usefixtures("little")

HEAVY = Mechanism(
    speed=30.0,
    crank=RigidLink(mass=0.8),
    rod=RigidLink(mass=1.1),
    slider_mass=2.0,
    counterweight=Counterweight(mass=1.5, radius=0.05),
)


def vary(machine: Mechanism, **ranges: tuple[float, float]) -> Mechanism:
    """Return a machine whose numbers vary; keys are paths with two underscores for a dot."""
    return replace(
        machine,
        varying=tuple(
            Varying(name=key.replace("__", "."), sets=((key.replace("__", "."), 1.0),), lower=lower, upper=upper)
            for key, (lower, upper) in ranges.items()
        ),
    )


def value(front: ParetoFront, row: int, name: str) -> float:
    """Return a quantity of a design, from its own machine."""
    return float(QUANTITIES[name].evaluate(front.mechanism(row), front.dimensions[row : row + 1, :3]).values[0])


def test_least_inertia_torque_has_the_least_mass_and_speed() -> None:
    """Without load and gravity, a slider of mass m at speed w takes the torque m w^2 f(crank angle, dimensions)."""
    bare = replace(HEAVY, crank=RigidLink(mass=0.0), rod=RigidLink(mass=0.0))
    light = replace(bare, slider_mass=0.7, speed=9.0)
    wanted = problem({"peak_torque": "minimise"}, {"stroke": 0.2}, mechanism=light, samples=300)
    found = solve(replace(wanted, mechanism=vary(bare, slider_mass=(0.7, 3.0), speed=(9.0, 40.0))))
    least = solve(wanted)
    assert found.dimensions[0, 3:].tolist() == [0.7, 9.0]
    assert found.values[0, 0] == pytest.approx(least.values[0, 0], rel=1e-9)
    assert found.designs["residual"][0] <= 1e-6


def test_fastest_slider_within_an_acceleration_is_that_of_the_scaling_law() -> None:
    """For fixed dimensions speed goes with w and acceleration with w^2: the speed that the limit allows is known."""
    design = np.array([[0.06, 0.2, 0.02]])
    one = replace(HEAVY, speed=1.0)
    rate = QUANTITIES["peak_slider_acceleration"].evaluate(one, design).values[0]
    front = solve(
        problem(
            {"peak_slider_speed": "maximise"},
            {"peak_slider_acceleration": (None, 50.0)},
            mechanism=vary(HEAVY, speed=(5.0, 90.0)),
            samples=200,
            crank=0.06,
            rod=0.2,
            offset=0.02,
        )
    )
    assert front.dimensions[0, 3] == pytest.approx(math.sqrt(50.0 / rate), rel=1e-8)
    assert front.mechanism(0).speed == front.dimensions[0, 3]


@pytest.mark.parametrize("name", ["peak_shaking_force", "rms_shaking_force", "peak_pivot_force"])
def test_best_counterweight_is_that_of_another_method(name: str) -> None:
    """A minimax over radius and angle; Nelder and Mead's method needs no gradients and knows nothing of ours."""
    machine = vary(HEAVY, counterweight__radius=(0.0, 0.2), counterweight__angle=(2.0, 5.0))
    design = np.array([[0.06, 0.2, 0.03]])
    front = solve(problem({name: "minimise"}, mechanism=machine, crank=0.06, rod=0.2, offset=0.03, samples=300))

    def alone(x: Any) -> float:
        weight = Counterweight(mass=1.5, radius=abs(float(x[0])), angle=float(x[1]))
        return float(QUANTITIES[name].evaluate(replace(HEAVY, counterweight=weight), design).values[0])

    options: Any = {"xatol": 1e-10, "fatol": 1e-11, "maxiter": 2000}
    starts = [[r, a] for r in (0.03, 0.1) for a in (2.8, 3.5)]
    best = min(float(minimize(alone, start, method="Nelder-Mead", options=options).fun) for start in starts)
    assert value(front, 0, name) == pytest.approx(front.values[0, 0], rel=1e-12)
    assert front.values[0, 0] <= best * (1.0 + 1e-9)
    assert front.values[0, 0] == pytest.approx(best, rel=1e-6)


def chosen(rods: tuple[float, ...], masses: tuple[float, ...], whole: Problem) -> Problem:
    """Return a problem with a choice among rods and slider masses."""
    return replace(
        whole,
        choices=("mass",),
        variants=tuple(
            Variant(
                labels=(f"{mass} kg",),
                mechanism=replace(whole.mechanism, slider_mass=mass),
                crank=whole.crank,
                rod=Range(lower=rod, upper=rod),
                offset=whole.offset,
            )
            for rod in rods
            for mass in masses
        ),
    )


def test_a_single_objective_over_choices_has_the_best_of_all_combinations() -> None:
    whole = problem({"peak_torque": "minimise"}, {"stroke": (0.18, 0.22), "time_ratio": (1.1, None)}, samples=1000)
    asked = chosen((0.25, 0.3, 0.42), (3.0, 1.2), whole)
    alone = [float(solve(part).values[0, 0]) for part in asked.parts()]
    front = solve(asked)
    assert front.variants == (int(np.argmin(alone)),)
    assert front.values[0, 0] == pytest.approx(min(alone), rel=1e-7)
    assert front.designs["choice_mass"].tolist() == ["1.2 kg"]


def test_the_front_over_choices_is_the_merged_front_of_all_combinations() -> None:
    whole = problem(
        {"footprint": "minimise", "transmission_angle": "maximise"},
        {"stroke": (0.18, 0.22), "time_ratio": (1.05, None)},
        designs=20,
        samples=1000,
    )
    asked = chosen((0.25, 0.33, 0.42), (2.0,), whole)
    front = solve(asked)
    merged = np.concatenate([solve(part).values for part in asked.parts()])
    merged = merged[nondominated(merged)]
    span = np.ptp(merged, axis=0)
    ideal = merged.min(axis=0)
    assert hypervolume(front.values, ideal, span) >= 0.99 * hypervolume(merged, ideal, span)
    # No design of either is dominated by the other's beyond rounding.
    for ours, theirs in ((front.values, merged), (merged, front.values)):
        worse = np.array([np.min(np.max((theirs - own) / span, axis=1)) for own in ours])
        assert worse.min() > -1e-6
    assert len(set(front.variants)) == 3
    for row in range(len(front)):
        assert front.dimensions[row, 1] == front.part(row).rod.lower
        assert value(front, row, "footprint") == pytest.approx(front.values[row, 0], rel=1e-12)


def test_limits_that_come_with_an_option_hold_for_it_alone() -> None:
    """A small motor with a torque limit, a large one that costs a heavier slider."""
    whole = problem({"transmission_angle": "maximise"}, {"stroke": 0.2, "peak_torque": (None, 500.0)}, samples=1000)
    light, heavy = (replace(MACHINE, slider_mass=mass) for mass in (1.0, 6.0))
    limit = Constraint(quantity="peak_torque", upper=12.0)

    def motor(name: str, machine: Mechanism, *limits: Constraint) -> Variant:
        return Variant(
            labels=(name,),
            mechanism=machine,
            crank=whole.crank,
            rod=whole.rod,
            offset=whole.offset,
            limits=limits,
        )

    asked = replace(whole, choices=("motor",), variants=(motor("small", light, limit), motor("large", heavy)))
    parts = asked.parts()
    assert parts[0].constraints[1] == Constraint(quantity="peak_torque", upper=12.0)
    assert parts[1].constraints == whole.constraints
    front = solve(asked)
    part = front.part(0)
    assert part.mechanism == front.mechanism(0)
    most = next(constraint.upper for constraint in part.constraints if constraint.quantity == "peak_torque")
    assert most is not None
    assert value(front, 0, "peak_torque") <= most * (1.0 + 1e-9)


def test_sheets_count_signs_times_variants() -> None:
    whole = problem({"peak_torque": "minimise"}, offset=(-0.1, 0.1), mechanism=vary(MACHINE, slider_mass=(1.0, 2.0)))
    asked = chosen((0.25, 0.3), (1.0,), replace(whole, mechanism=vary(MACHINE, slider_mass=(1.0, 2.0))))
    found = elimination_branches(asked)
    assert [(branch.variant, branch.sign) for branch in found] == [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)]
    evaluator = Evaluator(asked, found[2])
    assert evaluator.dimension == 3  # crank, size of the offset, mass
    u = np.random.default_rng(4).random((50, 3))
    designs, _, _ = evaluator.screen_designs_objectives_violation(u)
    assert designs.shape == (50, 4)
    assert np.all(designs[:, 1] == 0.3)
    goals, limits = evaluator.objective_and_constraint_rows(u[evaluator.can_evaluate(u)])
    assert goals.gradients.shape[2] == limits.gradients.shape[2] == 3


def test_the_same_seed_gives_the_same_front_bit_for_bit_with_more_variables() -> None:
    asked = problem(
        {"peak_torque": "minimise", "transmission_angle": "maximise"},
        {"stroke": 0.2},
        mechanism=vary(MACHINE, slider_mass=(1.0, 2.0)),
        designs=8,
        samples=200,
    )
    assert solve(asked).designs.equals(solve(asked).designs)


def test_contradicting_requirements_are_explained_with_more_variables() -> None:
    asked = problem(
        {"peak_torque": "minimise"},
        {"stroke": 0.2, "transmission_angle": (degrees(89.0), None)},
        mechanism=vary(MACHINE, slider_mass=(1.0, 2.0)),
        samples=200,
    )
    front = solve(asked)
    assert front.status == "infeasible"
    assert "transmission angle" in front.message


@pytest.mark.parametrize(
    ("path", "lower", "upper", "words"),
    [
        ("slider.mass", 1.0, 2.0, "a number of the machine"),
        ("branch", 1.0, 2.0, "a variable must be a number of the machine"),
        ("speed", -1.0, 2.0, "must not be 0 or change its sign"),
        ("slider_mass", -1.0, 2.0, "zero or more"),
        ("slider_mass", 3.0, 2.0, "lower <= upper"),
        ("loads.3.outward", 1.0, 2.0, "a number of the machine"),
    ],
)
def test_impossible_variables_are_refused(path: str, lower: float, upper: float, words: str) -> None:
    with pytest.raises(InputError, match=words):
        vary(MACHINE, **{path.replace(".", "__"): (lower, upper)})


def test_a_machine_with_varying_numbers_is_not_taken_for_one_machine() -> None:
    from slidercrank.model.cycle.cycle import cycle
    from slidercrank.model.linkage.linkage import Linkage

    machine = vary(MACHINE, slider_mass=(1.0, 2.0))
    with pytest.raises(InputError, match="slider_mass varies"):
        cycle(machine, Linkage(0.05, 0.2, 0.0), [0.0])
    with pytest.raises(InputError, match="4 numbers: crank, rod, offset, slider_mass"):
        QUANTITIES["peak_torque"].evaluate(machine, np.array([[0.05, 0.2, 0.0]]))
    with pytest.raises(InputError, match="4 numbers"):
        QUANTITIES["stroke"].evaluate(machine, np.array([[0.05, 0.2, 0.0]]))
