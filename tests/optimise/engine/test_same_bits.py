"""Whatever the engine, the workers and the chunks, a search finds the same bits."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.arrays import Array
from slidercrank.model.tolerance.error_distributions import Shape
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.robust.quantity import Case, RobustQuantity, Side
from slidercrank.optimise.engine.engine import Engine
from slidercrank.optimise.engine.processes import Processes
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.robust_problem import Robust, robust_problem
from slidercrank.optimise.search.batch_quantities import evaluate_pieces, join_batches, screen_quantities
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.search.polish import polish_designs
from slidercrank.optimise.solve import solve
from tests.optimise.engine import work
from tests.optimise.problems import problem, search_little, shipped
from tests.optimise.test_own_quantities import ACCELERATION, job, module
from tests.optimise.test_robust_problem import TOLERANT, plain

JOB = robust_problem(
    replace(plain(1), settings=replace(plain(1).settings, samples=200)),
    Robust(samples=1024, quantities=("peak_torque", "time_ratio")),
)
CUTS = ([0, 1, 40], [0, 7, 16, 33, 40], [0, 39, 40])


@pytest.fixture(autouse=True, scope="module")
def few() -> Iterator[None]:
    """Search little."""
    with pytest.MonkeyPatch.context() as patch:
        search_little(patch)
        yield


@pytest.fixture(scope="module")
def serial() -> ParetoFront:
    return solve(JOB)


def test_a_robust_job_gives_the_same_bits_on_every_engine(engine: Engine, serial: ParetoFront) -> None:
    engine.map(work.square, [1])  # started, so that it takes whatever is heavy
    mapped = 0

    class Counting:
        workers = engine.workers
        should_map = engine.should_map
        close = engine.close

        def map(self, function: Callable[[Any], Any], items: list[Any], *, poll: object = None) -> list[Any]:
            nonlocal mapped
            mapped += len(items)
            return engine.map(function, items)

    found = solve(JOB, engine=Counting())  # type: ignore[arg-type]
    assert mapped > 2 or engine.workers == 1
    assert found.dimensions.tobytes() == serial.dimensions.tobytes()
    assert found.values.tobytes() == serial.values.tobytes()
    assert found.designs.equals(serial.designs)
    assert (found.evaluations, found.hypervolume) == (serial.evaluations, serial.hypervolume)


def test_a_function_of_your_own_gives_the_same_bits_in_processes(processes: Processes, tmp_path: Path) -> None:
    slow = ACCELERATION.replace("    return", "    import time; time.sleep(0.005 * len(designs))\n    return")
    own = parse_job(job(module(tmp_path, slow), optimiser={"designs": 2, "samples": 40}), folder=tmp_path)
    processes.map(work.square, [1])
    found, alone = solve(own, engine=processes), solve(own)
    assert found.designs.equals(alone.designs)
    assert found.evaluations == alone.evaluations


def all_quantities() -> Problem:
    """A problem with every quantity there is, and robust ones of every kind."""
    kinds: tuple[tuple[Case, int, Shape], ...] = (
        ("percentile", 2, "normal"),
        ("percentile", 2, "uniform"),
        ("worst case", 1, "normal"),
    )
    sides: tuple[Side, ...] = ("high", "low")
    made = [
        RobustQuantity(
            inner=QUANTITIES[name],
            side=side,
            case=kind,
            order=order,
            shape=shape,
            samples=1024,
            suffix=f"{kind[0]}_{shape}_{side}",
        )
        for name in ("peak_torque", "transmission_angle")
        for side in sides
        for kind, order, shape in kinds
    ]
    return replace(problem({"time_ratio": "maximise"}, mechanism=TOLERANT), own=tuple(made))


def designs(count: int) -> Array:
    random = np.random.default_rng(3)
    found = np.stack([random.uniform(*ends, count) for ends in ((0.02, 0.06), (0.15, 0.4), (-0.05, 0.05))], axis=1)
    found[5, 2], found[17, 2] = 0.0, 1e-5  # at the kink of |offset| every machine of a sample is evaluated
    return found


@pytest.mark.slow
def test_no_quantity_of_a_design_depends_on_the_designs_beside_it() -> None:
    judged, dimensions = all_quantities(), designs(40)
    names = (*QUANTITIES, *(quantity.name for quantity in judged.own))
    whole, quick = evaluate_pieces(judged, names, dimensions), screen_quantities(judged, names, dimensions)
    for cuts in CUTS:
        parts = [dimensions[begin:end] for begin, end in pairwise(cuts)]
        for name, one, other in zip(
            names, whole, join_batches([evaluate_pieces(judged, names, part) for part in parts]), strict=True
        ):
            for field in ("values", "gradients", "labels"):
                assert np.array_equal(getattr(one, field), getattr(other, field), equal_nan=True), (name, field)
        for column, name in enumerate(names):
            found = np.concatenate([screen_quantities(judged, (name,), part)[0] for part in parts])
            assert np.array_equal(found, quick[column], equal_nan=True), name


@pytest.mark.parametrize("name", ["feeder", "sieve"])
def test_the_polish_of_a_design_does_not_depend_on_the_designs_beside_it(name: str) -> None:
    evaluator = Evaluator(shipped(name), elimination_branches(shipped(name))[0])
    start = np.random.default_rng(1).random((200, evaluator.dimension))
    start = start[evaluator.can_evaluate(start)][:12]
    scale = np.ones(len(shipped(name).objectives))
    whole = polish_designs(evaluator, start, scale, iterations=10)
    parts = [polish_designs(evaluator, part, scale, iterations=10) for part in (start[:1], start[1:8], start[8:])]
    assert np.array_equal(whole.u, np.concatenate([part.u for part in parts]))
    assert np.array_equal(whole.values, np.concatenate([part.values for part in parts]))
    assert np.array_equal(whole.residual, np.concatenate([part.residual for part in parts]))
    assert [len(each) for each in whole.active] == [len(each) for part in parts for each in part.active]
