"""The front that a job shows while it is solved."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Claim, Store
from slidercrank.service.workers.worker import MOST, front_progress, work
from tests.service import fronts


def test_values_are_those_of_the_table_of_designs() -> None:
    front = fronts.front(designs=20)
    shown = front_progress(front.problem, front.values)
    assert shown["columns"] == [front.problem.quantity(item.quantity).field for item in front.objectives]
    assert np.array(shown["points"]) == pytest.approx(front.designs[shown["columns"]].to_numpy(), rel=1e-12)


def test_a_large_front_is_thinned_and_keeps_its_ends() -> None:
    front = fronts.front(designs=20)
    many = np.linspace(0.0, 1.0, 500)[::-1, None] * np.array([1.0, 1.0, math.radians(1.0), 1e-3])
    shown = front_progress(front.problem, many)["points"]
    assert len(shown) == MOST
    assert shown[0] == pytest.approx([0.0, 0.0, 0.0, 0.0])
    assert shown[-1] == pytest.approx([-1.0, 1.0, -1.0, 1.0])
    assert len(json.dumps(shown)) < 8000


def test_a_front_without_designs_has_no_points() -> None:
    front = fronts.front(designs=1)
    assert front_progress(front.problem, np.zeros((0, 4)))["points"] == []


def test_a_job_that_is_solved_shows_how_its_front_grows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[Any] = []
    report = Claim.report

    def noted(claim: Claim, *given: Any) -> None:
        report(claim, *given)
        shown.append(store.job(claim.job.id).progress)

    monkeypatch.setattr(Claim, "report", noted)
    with Store(tmp_path / "store.db") as store:
        number = submit(store, tomllib.loads(fronts.JOB)).id
        work(store, drain=True)
        loading = [at for at in shown if at["stage"] == "loading"]
        assert loading == shown[: len(loading)]
        assert all("front" not in at for at in loading)
        assert all(0 < len(at["front"]["points"]) <= MOST for at in shown[len(loading) :])
        assert shown[-1]["front"]["columns"] == ["time_ratio", "least_transmission_angle_deg"]
        assert all("front" not in event.data for event in store.events(number))
        best = max(row["time_ratio"] for row in store.result(number).designs)  # type: ignore[type-var]
        assert max(point[0] for point in shown[-1]["front"]["points"]) == pytest.approx(best, rel=0.02)
