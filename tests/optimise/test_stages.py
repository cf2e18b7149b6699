"""Long stages between the rounds of a search: they are told, and nothing hangs on that."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.front.hypervolume import choose
from slidercrank.optimise.front.progress import REPEATING, Progress
from slidercrank.optimise.search import checkpoints, search
from slidercrank.optimise.search.checkpoints import Record
from slidercrank.optimise.solve import solve

from .problems import Bounds, degrees, polish_few, problem

HELD: dict[str, Bounds] = {"stroke": 0.2, "transmission_angle": (degrees(30.0), None)}
GIVEN = problem({"peak_torque": "minimise", "time_ratio": "maximise"}, HELD, designs=4, samples=64)


@pytest.fixture(autouse=True)
def always(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tell at every occasion, and keep every step at once; polish few designs."""
    monkeypatch.setattr(search, "TELL", 0.0)
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


def test_a_search_that_goes_on_tells_what_it_repeats() -> None:
    _, _, kept = whole()
    past = kept[: len(kept) // 2 + 1]
    rounds = past[-1].told
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
    monkeypatch.setattr(search, "TELL", 3600.0)
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


def saying(heard: list[str], stage: str) -> Callable[[], bool]:
    """Return a callback that ends a search once a stage was heard of."""
    return lambda: stage in heard


def test_the_choice_tells_of_every_gain_that_it_weighs() -> None:
    values = np.random.default_rng(1).random((200, 3))
    heard: list[tuple[int, int]] = []
    chosen = choose(values, 30, stand=lambda done, of: heard.append((done, of)))
    assert np.array_equal(chosen, choose(values, 30))
    assert len(heard) >= 30
    assert heard == sorted(heard)
    assert heard[-1] == (29, 30)


def test_a_short_stage_is_not_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "TELL", 3600.0)
    assert not [entry for entry in searched()[1] if entry.steps]
