"""A design that friction locks: missing values have a reason, in Python, on the command line and in the API."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputError
from slidercrank.objectives.registry import QUANTITIES
from tests.service.api.fixed_front import API, Solved, client_of
from tests.service.conftest import Command

JOB: dict[str, Any] = {
    "name": "Locked",
    "mechanism": {"speed": "60 rpm", "slider": {"mass": "2 kg"}},
    "load": [{"force": "200 N", "opposes": "outward stroke"}],
    "friction": {"guide": 0.9},
    "variables": {"crank": ["20 mm", "100 mm"], "rod": ["60 mm", "200 mm"], "offset": ["0 mm", "40 mm"]},
    "quantity": {"share": {"formula": "mean_torque / 1 N m"}},
    "objectives": {"peak_torque": "minimise"},
}
SIZES = {"crank": "50 mm", "rod": "70 mm", "offset": "10 mm"}
BLANK = {"mean_torque": "mean_torque_Nm", "mean_power": "mean_power_W", "delivered_work": "delivered_work_J"}
MARGIN = math.degrees(math.acos(60.0 / 70.0) - math.atan(0.9))
"""acos((r + e) / l) - atan(mu): -10.98 deg."""
REASON = f"friction locks this design: the self-locking margin must be more than zero; got {MARGIN:.4g} deg; lengthen"


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


def test_python_says_why_a_locked_design_has_no_mean_torque() -> None:
    analysis = sc.problem(JOB).analyse([0.05, 0.07, 0.01])
    for name in (*BLANK, "share"):
        assert analysis.undefined[name].startswith(REASON), name
        with pytest.raises(InputError, match=re.escape(f"{name} is not defined here: {REASON}")):
            analysis[name]
        assert str(analysis.table().loc[name, "undefined_because"]).startswith(REASON)
    assert analysis["peak_torque"] == math.inf
    assert "tolerances" in analysis.undefined["position_error"]


def test_the_command_says_why_a_locked_design_has_no_mean_torque(command: Command, tmp_path: Path) -> None:
    job = tmp_path / "locked.json"
    job.write_text(json.dumps(JOB))
    line = ("analyse", job, "--crank", "50 mm", "--rod", "70 mm", "--offset", "10 mm")
    record = json.loads(command(*line, "--json").stdout)
    assert all(record[key] is None and record["undefined"][key].startswith(REASON) for key in BLANK.values())
    assert {key for key, value in record.items() if value is None} <= {*record["undefined"], "peak_torque_angle_deg"}
    text = " ".join(command(*line).stdout.split())
    titles = ", ".join([*(QUANTITIES[name].title for name in ("mean_torque", "delivered_work")), "share"])
    assert f"{titles}: friction locks this design: the self-locking margin must be more" in text
    assert "friction locks" in " ".join(command(*line, "--show", "extremes").stdout.split("Extremes over")[1].split())


def test_the_api_says_why_a_locked_design_has_no_mean_torque(client: httpx.Client) -> None:
    answer = client.post(f"{API}/analyse", json={"job": JOB, **SIZES})
    assert answer.status_code == 200, answer.text
    found = answer.json()["analysis"]
    assert all(found[key] is None and found["undefined"][key].startswith(REASON) for key in BLANK.values())


def test_a_design_that_runs_has_no_such_reason() -> None:
    analysis = sc.problem(JOB).analyse([0.03, 0.19, 0.01])
    assert not any("locks" in reason for reason in analysis.undefined.values())
    assert {*BLANK} <= {*analysis}
