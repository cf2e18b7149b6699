"""Every quantity as the only objective: what the search finds is no worse than the best of random designs."""

import dataclasses
from functools import cache

import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.objectives.quantity import Quantity
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.problem.requirements import Sense
from slidercrank.optimise.solve import solve
from tests.case_count import in_turn
from tests.model.cases import fitted
from tests.optimise.problems import MACHINE, problem, search_little

RUBBING = dataclasses.replace(MACHINE, friction=Friction(guide=0.1))
LEAN = np.radians(40.0)
WISHES = ("minimise", "maximise", "target")


@cache
def random_values(quantity: Quantity, count: int = 2000) -> np.ndarray:
    """Return the quantity of random designs that keep the bounds below."""
    random = np.random.default_rng(6)
    designs = random.uniform((0.05, 0.1, 0.001), (0.1, 0.4, 0.08), (count, 3))
    r, l, e = designs.T
    met = np.arccos(np.minimum((r + e) / l, 1.0)) >= LEAN
    return quantity.evaluate(fitted(quantity, RUBBING), designs[met]).values


@pytest.mark.parametrize(("name", "wish"), in_turn(3, QUANTITIES, WISHES))
def test_no_random_design_is_better_than_the_best_of_the_search(
    name: str, wish: Sense, monkeypatch: pytest.MonkeyPatch
) -> None:
    search_little(monkeypatch)
    found = random_values(QUANTITIES[name])
    middle = float(np.median(found))
    given = problem(
        {name: middle if wish == "target" else wish},
        {"transmission_angle": (LEAN, None)} if name != "transmission_angle" else {"stroke": (0.05, 0.3)},
        crank=(0.05, 0.1),
        rod=(0.1, 0.4),
        offset=(0.001, 0.08),
        mechanism=fitted(QUANTITIES[name], RUBBING),
        designs=1,
        samples=64,
    )
    front = solve(given)
    assert front.status == "done", front.message
    best = {"minimise": found.min(), "maximise": -found.max(), "target": np.abs(found - middle).min()}[wish]
    value = float(given.quantity(name).evaluate(given.mechanism, front.dimensions[:1]).values[0])
    worth = {"minimise": value, "maximise": -value, "target": abs(value - middle)}[wish]
    assert worth <= best + 1e-7 * (abs(middle) + 1e-12)
