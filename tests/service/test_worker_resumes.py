"""A job whose worker died, with a real search: the next worker goes on and finds the same."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.solve import solve
from slidercrank.service.jobs.submission import submit
from slidercrank.service.runs.result import csv_text
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import solve_claimed, work
from tests.service import fronts
from tests.service.store.contents import end_lease

TABLES = tomllib.loads(fronts.JOB)


@pytest.mark.parametrize("optimiser", [{"method": "nsga2", "samples": 16, "evaluations": 64}, {"samples": 128}])
def test_a_killed_job_goes_on_and_finds_the_same_designs(
    optimiser: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    address = str(tmp_path / "store.db")
    store = Store(address)
    tables = {**TABLES, "optimiser": {**optimiser, "designs": 6, "seed": 4}}
    whole, killed = submit(store, tables), submit(store, tables)
    lengths: list[int] = []

    class Killed(BaseException):
        """Stands for the end of the process."""

    def watched(*given: Any, resume: Any, **more: Any) -> ParetoFront:
        lengths.append(len(resume))
        return solve(*given, resume=resume, **more)

    def dying(*given: Any, progress: Any, **more: Any) -> ParetoFront:
        def tell(at: Any) -> None:
            progress(at)
            if at.round == 2:
                raise Killed

        return solve(*given, progress=tell, **more)

    monkeypatch.setattr("slidercrank.optimise.solve.solve", watched)
    claim = store.claim("first", lease=60.0)
    assert claim is not None
    solve_claimed(store, claim, lambda: False)
    monkeypatch.setattr("slidercrank.optimise.solve.solve", dying)
    claim = store.claim("second", lease=60.0)
    assert claim is not None
    claim.hand_back = lambda reason, **_: None  # type: ignore[method-assign] # the dead do not
    with pytest.raises(Killed):
        solve_claimed(store, claim, lambda: False)
    kept = claim.evaluation_records()
    assert len(kept) >= 2  # more where a round took long
    end_lease(address, killed.id)
    monkeypatch.setattr("slidercrank.optimise.solve.solve", watched)
    assert work(store, drain=True) == 1
    assert lengths == [0, len(kept)]
    one, other = store.result(whole.id), store.result(killed.id)
    assert (one.status, one.message, one.hypervolume) == (other.status, other.message, other.hypervolume)
    assert one.designs
    assert csv_text(one.designs) == csv_text(other.designs)
    store.close()
