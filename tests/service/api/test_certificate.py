"""Proof of a front over the API: that of the command line."""

from __future__ import annotations

import json
import tomllib
from typing import Any

import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app as command_line
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import API, Solved, client_of, store_result


def test_a_proof_is_that_of_the_command_line(solved: Solved) -> None:
    options = ["--epsilon", "0.2", "--seconds", "20"]
    done = CliRunner().invoke(command_line, ["certify", str(solved.folder), *options, "--json"])
    assert done.exit_code == 0, done.stderr
    expected = json.loads(done.stdout)
    with client_of(solved.store) as client:
        answer = client.get(f"{solved.path}/certificate", params={"epsilon": 0.2, "seconds": 20}).json()
        assert client.get(f"{solved.path}/certificate", params={"epsilon": 0.2, "seconds": 20}).json() == answer
        assert client.get(f"{solved.path}/certificate", params={"epsilon": 1.5}).status_code == 422
        assert client.get(f"{solved.path}/certificate", params={"seconds": 100}).status_code == 422
    assert answer["proven"] is True
    found = answer["certificate"]
    assert found.keys() == expected.keys()
    for key in found.keys() - {"seconds", "run", "added"}:
        told = expected[key]
        assert found[key] == (pytest.approx(told, rel=1e-9) if isinstance(told, float) else told), key
    assert found["message"] in answer["sentences"][0]


def test_a_run_without_designs_is_proven_infeasible_and_one_that_cannot_be_bounded_is_refused(
    store: Store, solved: Solved
) -> None:
    tables = tomllib.loads(fronts.JOB)
    contrary = {**tables, "constraints": {**tables["constraints"], "transmission_angle": {"min": "80 deg"}}}
    empty: dict[str, Any] = {"status": "infeasible", "designs": [], "extremes": {}, "knee": None, "trade_offs": []}
    none = store_result(store, solved.result, contrary, **empty)
    average = {**tables, "objectives": {**tables["objectives"], "rms_torque": "minimise"}}
    unbounded = store_result(store, solved.result, average)
    with client_of(store) as client:
        answer = client.get(f"{API}/jobs/{none}/certificate").json()
        assert answer["proven"] is True
        assert answer["certificate"]["infeasible"] is True
        refused = client.get(f"{API}/jobs/{unbounded}/certificate")
    assert refused.status_code == 422
    assert "RMS torque over time has no bound" in refused.json()["detail"]
