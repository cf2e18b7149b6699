"""Long stages between the rounds of a search: they are told, and nothing hangs on that."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from slidercrank.model.arrays import Array, IntArray
from slidercrank.model.kernel.batches import interrupted_by
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.optimise.front.front import Columns, ParetoFront
from slidercrank.optimise.front.hypervolume import ReportProgress, choose_designs_by_hypervolume
from slidercrank.optimise.front.progress import REPEATING, Progress
from slidercrank.optimise.methods.auto import partial_front
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search import assemble_front, checkpoints, sample_and_zoom
from slidercrank.optimise.search.assemble_front import columns_of_designs
from slidercrank.optimise.search.checkpoints import Record
from slidercrank.optimise.solve import solve

from .problems import MACHINE, Bounds, degrees, polish_few, problem

HELD: dict[str, Bounds] = {"stroke": 0.2, "transmission_angle": (degrees(30.0), None)}
GIVEN = problem({"peak_torque": "minimise", "time_ratio": "maximise"}, HELD, designs=4, samples=64)


@pytest.fixture(autouse=True)
def always(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tell at every occasion, and keep every step at once; polish few designs."""
    monkeypatch.setattr(sample_and_zoom, "REPORT_INTERVAL", 0.0)
    monkeypatch.setattr(checkpoints, "PAUSE", 0.0)
    polish_few(monkeypatch)


def searched(**more: object) -> tuple[ParetoFront, list[Progress], list[Record]]:
    """Return a front, what was told of stages and rounds, and what was kept."""
    told: list[Progress] = []
    kept: list[Record] = []
    front = solve(GIVEN, progress=told.append, stages=told.append, keep=kept.append, **more)  # type: ignore[arg-type]
    return front, told, kept


@cache
def whole() -> tuple[ParetoFront, list[Progress], list[Record]]:
    """Return front, rounds and records of an uninterrupted search that tells everything."""
    return searched()


def test_choosing_and_finishing_are_told_after_the_last_round_with_how_far_they_are() -> None:
    front, told, _ = whole()
    last = max(index for index, entry in enumerate(told) if not entry.steps)
    after = told[last + 1 :]
    assert [stage for stage, _ in itertools.groupby(entry.stage for entry in after)] == [
        "selecting designs",
        "finishing designs",
    ]
    assert all(entry.round == told[last].round and entry.step <= entry.steps for entry in after)
    assert {entry.steps for entry in after if entry.stage == "finishing designs"} == {len(front)}


def test_not_all_planned_rounds_are_done_while_a_round_is_computed() -> None:
    _, told, _ = whole()
    polishing = [entry for entry in told if entry.stage == "polishing"]
    assert any(entry.steps for entry in polishing)
    assert all(entry.round < entry.rounds for entry in polishing if entry.steps)
    assert polishing[-1].round == polishing[-1].rounds


def test_a_search_that_goes_on_tells_what_it_repeats() -> None:
    _, _, kept = whole()
    past = kept[: len(kept) // 2 + 1]
    rounds = past[-1].rounds
    assert rounds > 2
    _, told, _ = searched(resume=past)
    repeated = [entry for entry in told if entry.stage == REPEATING]
    assert told[: len(repeated)] == repeated
    assert {entry.steps for entry in repeated} == {len(past)}
    steps = [entry.step for entry in repeated]
    assert steps == sorted(steps)
    assert steps[0] == 0
    assert steps[-1] > len(past) // 2
    assert next(entry for entry in told if not entry.steps).round == rounds + 1


def test_a_search_that_goes_on_tells_so_before_it_computes_anything(monkeypatch: pytest.MonkeyPatch) -> None:
    _, _, kept = whole()
    monkeypatch.setattr(sample_and_zoom, "REPORT_INTERVAL", 3600.0)
    _, told, _ = searched(resume=kept)
    assert (told[0].stage, told[0].step, told[0].steps) == (REPEATING, 0, len(kept))


def test_what_is_told_changes_nothing() -> None:
    silent: list[Record] = []
    alone = solve(GIVEN, keep=silent.append)
    front, _, kept = whole()
    assert front.designs.equals(alone.designs)
    assert (
        np.concatenate([record.words for record in kept]).tobytes()
        == np.concatenate([record.words for record in silent]).tobytes()
    )
    assert [replace(entry, seconds=0.0) for entry in front.history] == [
        replace(entry, seconds=0.0) for entry in alone.history
    ]


def test_a_search_is_cancelled_in_any_stage() -> None:
    for stage in ("selecting designs", "finishing designs"):
        heard: list[str] = []
        front = solve(GIVEN, stages=lambda at: heard.append(at.stage), cancelled=saying(heard, stage))  # noqa: B023
        assert front.status == "cancelled"
        assert stage in heard


STEPS = np.repeat(np.linspace(0.1, 0.3, 1000), 2)
STEPPING = replace(
    MACHINE, loads=(PositionTable(positions=tuple(STEPS), forces=tuple(np.sin(99.0 * STEPS)), datum="crank pivot"),)
)


TWO = replace(STEPPING, arrangement=Arrangement(phases=(0.0, 2.0)))


@pytest.mark.parametrize("machine", [STEPPING, pytest.param(TWO, marks=pytest.mark.slow)], ids=["one", "two cylinders"])
def test_designs_with_thousands_of_steps_are_analysed_few_at_a_time_and_come_out_the_same(machine: Mechanism) -> None:
    stepping = problem({"rms_torque": "minimise"}, mechanism=machine)
    designs = np.array([[0.05, 0.2, 0.02], [0.06, 0.22, 0.01]])[np.arange(11) % 2] * np.linspace(1.0, 1.1, 11)[:, None]
    asked: list[int] = []

    def columns(some: Array) -> Columns:
        asked.append(0)
        with interrupted_by(lambda: None, between_parts=lambda: asked.append(asked.pop() + 1)):
            return columns_of_designs(stepping, np.zeros(len(some), np.int64), some)

    whole = columns(designs)
    each = [columns(design[None]) for design in designs]
    assert asked[0] >= asked[1] + 2 * 8  # parts of at most five designs, of eight signals and more
    for name, column in whole.items():
        assert column.tobytes() == np.concatenate([one[name] for one in each]).tobytes()


def test_a_cancelled_front_has_as_many_designs_as_are_analysed_in_a_moment(monkeypatch: pytest.MonkeyPatch) -> None:
    analysed: list[int] = []

    def slowly(given: Problem, variants: IntArray, dimensions: Array, *rest: ReportProgress) -> Columns:
        if "polishing" in heard:
            analysed.append(len(dimensions))
            time.sleep(0.1 * len(dimensions))
        return columns_of_designs(given, variants, dimensions, *rest)

    for module in (partial_front, assemble_front):
        monkeypatch.setattr(module, "columns_of_designs", slowly)
    heard: list[str] = []
    given = replace(GIVEN, settings=replace(GIVEN.settings, designs=40))
    front = solve(given, progress=lambda at: heard.append(at.stage), cancelled=saying(heard, "polishing"))
    assert front.status == "cancelled"
    assert 2 <= len(front) <= 7
    assert sum(analysed) <= 20


def saying(heard: list[str], stage: str) -> Callable[[], bool]:
    """Return a callback that ends a search once a stage was heard of."""
    return lambda: stage in heard


def test_the_choice_tells_of_every_gain_that_it_weighs() -> None:
    values = np.random.default_rng(1).random((200, 3))
    heard: list[tuple[int, int]] = []
    chosen = choose_designs_by_hypervolume(values, 30, report=lambda done, of: heard.append((done, of)))
    assert np.array_equal(chosen, choose_designs_by_hypervolume(values, 30))
    assert len(heard) >= 30
    assert heard == sorted(heard)
    assert heard[-1] == (29, 30)


def test_a_short_stage_is_not_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sample_and_zoom, "REPORT_INTERVAL", 3600.0)
    assert not [entry for entry in searched()[1] if entry.steps]


def test_a_long_step_reports_its_stage_at_every_poll_until_its_round_ends() -> None:
    reports: list[Progress] = []
    run = sample_and_zoom.Run(GIVEN, 2, stages=reports.append)
    run.begin_round("polishing")
    for _ in range(3):
        run.checkpoints.poll()
    assert [(entry.stage, entry.step, entry.steps) for entry in reports] == [("polishing", 0, 1)] * 3
    run.report_round("polishing", [], run.archive)
    del reports[:]
    run.checkpoints.poll()
    assert not reports
