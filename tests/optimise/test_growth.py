"""The volume that is told while a search goes on: it never falls, and is what it says."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.optimise.front.dominance import nondominated
from slidercrank.optimise.front.hypervolume import REFERENCE
from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.candidates import FrontVolume
from slidercrank.optimise.search.checkpoints import Record
from slidercrank.optimise.search.sample_and_zoom import Archive, Run
from slidercrank.optimise.solve import solve

from .problems import JOBS, Bounds, degrees, problem, shipped

pytestmark = pytest.mark.usefixtures("little")

ONE, NONE = np.zeros((1, 2)), np.zeros((0, 2))
MIXED: dict[str, Bounds] = {
    "stroke": 0.2,
    "peak_slider_speed": (None, 4.0),
    "transmission_angle": (degrees(30.0), None),
}


def volumes(rounds: list[np.ndarray], **more: object) -> list[float]:
    growth = FrontVolume(np.zeros(rounds[0].shape[1]), **more)  # type: ignore[arg-type]
    return [growth.add(values) for values in rounds]


def counted(designs: np.ndarray, ideal: np.ndarray, span: np.ndarray) -> float:
    """Return the volume that designs (n, 2) dominate in boxes, by adding up its strips."""
    scaled = (designs[nondominated(designs)] - ideal) / span
    scaled = scaled[(scaled < REFERENCE).all(axis=1)]
    scaled = scaled[np.argsort(scaled[:, 0])]
    ends = [*scaled[1:, 0], REFERENCE]
    return float(sum((end - x) * (REFERENCE - y) for (x, y), end in zip(scaled, ends, strict=True))) / REFERENCE**2


@pytest.mark.parametrize("seed", range(20))
def test_the_volume_is_that_of_all_designs_so_far_in_the_box_of_the_first(seed: int) -> None:
    random = np.random.default_rng(seed)
    rounds = [random.normal(3.0 - 0.5 * k, 1.0, (random.integers(1, 30), 2)) for k in range(8)]
    first = rounds[0][nondominated(rounds[0])]
    ideal = first.min(axis=0)
    side = np.ptp(first, axis=0)
    span = np.maximum(np.where(side > 0.0, side, np.abs(ideal)), 0.1 * np.abs(ideal))
    for end, volume in enumerate(volumes(rounds), 1):
        assert volume == pytest.approx(counted(np.concatenate(rounds[:end]), ideal, span), rel=1e-12)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 6])
@pytest.mark.parametrize("most", [None, 7])
def test_the_volume_never_falls_however_many_designs_tell(count: int, most: int | None) -> None:
    random = np.random.default_rng(count)
    rounds = [np.abs(random.normal(0.0, 1.0 - 0.1 * k, (60, count))) + 0.05 * (9 - k) for k in range(9)]
    told = volumes(rounds, max_designs=most)
    assert all(one <= two for one, two in itertools.pairwise(told))
    assert told[0] < told[-1]


def test_nothing_one_design_ties_and_what_is_not_defined() -> None:
    assert volumes([NONE, NONE]) == [0.0, 0.0]
    assert volumes([NONE, ONE + 2.0, NONE, ONE + 2.0]) == pytest.approx([0.0, 1.0, 1.0, 1.0])
    assert volumes([np.array([[np.nan, 1.0], [np.inf, 0.0]]), ONE + 2.0]) == pytest.approx([0.0, 1.0])
    met = FrontVolume(np.array([0.2, 0.0]))
    assert met.add(np.array([[1e-17, 4.0]])) == pytest.approx(1.0)
    assert met.add(np.array([[1e-16, 2.0]])) > 1.4, "designs that meet a target differ by rounding"


def test_designs_that_violate_a_requirement_a_little_do_not_count() -> None:
    given = problem({"peak_torque": "minimise", "time_ratio": "maximise"})
    run, archive = Run(given, 2, lambda entry: None), Archive.empty(2)
    archive.add_points(0, np.zeros((2, 3)), np.array([[1.0, 2.0], [2.0, 1.0]]), is_feasible=np.zeros(2, dtype=bool))
    run.report_round("sampling", [], archive)
    archive.add_points(0, np.zeros((1, 3)), np.array([[3.0, 3.0]]))
    run.report_round("sampling", [], archive)
    assert [entry.hypervolume for entry in run.round_reports] == pytest.approx([0.0, 1.0])


def small(given: Problem, **settings: object) -> Problem:
    return replace(given, settings=replace(given.settings, **settings))  # type: ignore[arg-type]


CASES = {
    **{job: small(shipped(job), designs=12, samples=512) for job in JOBS},
    "equality": problem({"peak_torque": "minimise", "time_ratio": "maximise"}, MIXED, designs=6, samples=128),
    "alone": problem({"peak_torque": "minimise"}, {"stroke": (0.16, 0.22)}, samples=128),
    "target": problem({"time_ratio": 1.2, "peak_torque": "minimise"}, {"stroke": 0.2}, designs=6, samples=64),
}
CASES |= {
    "nsga2": small(CASES["target"], method="nsga2", samples=24, evaluations=160),
    "chebyshev": small(CASES["equality"], method="chebyshev", designs=4),
    "slsqp": small(CASES["alone"], method="slsqp"),
}


@pytest.mark.parametrize("name", CASES)
def test_no_search_tells_a_volume_that_falls_nor_when_it_goes_on(name: str) -> None:
    told: list[Progress] = []
    kept: list[Record] = []
    front = solve(CASES[name], progress=told.append, keep=kept.append)
    assert front.status == "done"
    assert told[-1].hypervolume > 0.0
    for rounds in (told, front.history):
        assert all(one.hypervolume <= two.hypervolume for one, two in itertools.pairwise(rounds))
    half = len(kept) // 2
    again: list[Progress] = []
    solve(CASES[name], progress=again.append, resume=kept[:half])
    before = told[: kept[half - 1].rounds]
    assert [entry.hypervolume for entry in [*before, *again]] == [entry.hypervolume for entry in told]
