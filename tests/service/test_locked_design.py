"""A design that friction locks: missing values have a reason, in Python, on the command line and in the API."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputError
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.service.questions.strength import analysis as strength
from tests.service import fronts as made
from tests.service.api.fixed_front import API, Solved, client_of, store_result
from tests.service.conftest import Command

pytestmark = pytest.mark.filterwarnings("ignore:in every sampled design the loaded stroke")
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
FORCED = (
    *("peak_torque", "rms_torque", "torque_fluctuation", "peak_torque_outward", "peak_torque_inward"),
    *("peak_pivot_force", "peak_crank_pin_force", "peak_guide_force", "efficiency", "force_transmission"),
    *("energy_per_cycle", "friction_loss"),
)
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
    assert all(math.isfinite(value) for value in analysis.values())
    for name in FORCED:
        assert analysis.undefined[name].startswith(REASON), name
    assert "tolerances" in analysis.undefined["position_error"]


def test_the_command_says_why_a_locked_design_has_no_mean_torque(command: Command, tmp_path: Path) -> None:
    job = tmp_path / "locked.json"
    job.write_text(json.dumps(JOB))
    line = ("analyse", job, "--crank", "50 mm", "--rod", "70 mm", "--offset", "10 mm")
    record = json.loads(command(*line, "--json").stdout)
    assert all(record[key] is None and record["undefined"][key].startswith(REASON) for key in BLANK.values())
    assert {key for key, value in record.items() if value is None} <= {*record["undefined"]}
    assert not {"inf", "-inf"} & {value for value in record.values() if isinstance(value, str)}
    assert record["undefined"]["peak_torque_angle_deg"].startswith(REASON)
    assert not re.search(r"\binf\b", command(*line).stdout)
    text = " ".join(command(*line).stdout.split())
    (listed,) = re.findall(r"([^:]*): friction locks this design: the self-locking margin must be more", text)
    titles = [QUANTITIES[name].title for name in ("mean_torque", "delivered_work", *FORCED)]
    assert all(title in listed for title in (*titles, "share"))
    assert "friction locks" in " ".join(
        command(*line, "--show", "extremes").stdout.split("Extreme values over")[1].split()
    )


def test_the_api_says_why_a_locked_design_has_no_mean_torque(client: httpx.Client) -> None:
    answer = client.post(f"{API}/analyse", json={"job": JOB, **SIZES})
    assert answer.status_code == 200, answer.text
    found = answer.json()["analysis"]
    columns = [*BLANK.values(), *(QUANTITIES[name].field for name in FORCED)]
    assert all(found[key] is None and found["undefined"][key].startswith(REASON) for key in columns)


def test_a_locked_design_with_sections_has_neither_stresses_nor_safeties() -> None:
    # A safety of zero is finite: it is the worst there is for the search, and no number of this design.
    steel = {"density": "7850 kg/m^3", "elasticity": "205 GPa", "yield_strength": "500 MPa"}
    steel |= {"ultimate_strength": "750 MPa", "endurance": "240 MPa", "bearing_pressure": "20 MPa"}
    bars = {name: {"width": "25 mm", "depth": "12 mm", "density": "7850 kg/m^3"} for name in ("crank", "rod")}
    pins = dict.fromkeys(("crank_pivot", "crank_pin", "slider_pin"), "12 mm")
    job = JOB | {
        "mechanism": JOB["mechanism"] | bars,
        "sections": {"pins": pins, "material": steel},
        "quantity": {
            "capped": {"formula": "min(peak_torque / 1 N m, 5)"},
            "inverse": {"formula": "1 / (1 + peak_torque / 1 N m)"},
        },
    }
    problem = sc.problem(job)
    analysis = problem.analyse([0.05, 0.07, 0.01])
    without = sc.problem(job | {"friction": {"guide": 0.0}}).analyse([0.05, 0.07, 0.01])
    names = ("static_safety", "fatigue_safety", "buckling_safety", "rod_stress", "pv_crank_pin", "capped", "inverse")
    for name in names:
        assert analysis.undefined[name].startswith(REASON), name
    # What is shown does not depend on friction; the margin alone does, and says how far the design is from running.
    assert math.degrees(analysis["self_locking_margin"]) == pytest.approx(MARGIN)
    assert {name: value for name, value in analysis.items() if without.get(name) != value}.keys() == {
        "self_locking_margin"
    }
    searched = problem.evaluate([0.05, 0.07, 0.01], ["peak_torque", "static_safety", "efficiency"])
    assert searched.tolist() == [math.inf, 0.0, -math.inf]
    numbers = strength.numbers(analysis.mechanism, analysis.linkage)
    assert numbers["static_safety"] is numbers["rod_stress_MPa"] is None
    json.dumps(numbers, allow_nan=False)


def test_a_sweep_has_no_forces_where_friction_locks_and_says_why(command: Command, tmp_path: Path) -> None:
    job = tmp_path / "locked.json"
    job.write_text(json.dumps(JOB))
    line = ("sweep", job, "--crank", "50 mm", "--rod", "80 mm", "--over", "offset=0 mm..25 mm:3")
    of = ("--of", "efficiency", "--of", "peak_torque", "--of", "rod_to_offset")
    first, *locked = json.loads(command(*line, *of, "--json").stdout)
    assert 0.0 < first["efficiency"] < 1.0
    assert (first["reason"], first["rod_to_offset"]) == ("", "inf")  # l / |e| without offset: that is its value
    for row in locked:
        assert row["efficiency"] is row["peak_torque_Nm"] is None
        assert row["rod_to_offset"] == pytest.approx(80.0 / row["offset_mm"])
        assert row["reason"].startswith("efficiency, peak torque: friction locks this design: the self-locking")
    done = command(*line, *of)
    assert not re.search(r"-inf", done.stdout)
    assert "2 of 3 have no value; the first: efficiency, peak torque: friction locks" in " ".join(done.stderr.split())
    alone = json.loads(command(*line, "--of", "efficiency", "--json").stdout)
    assert alone[1]["reason"].startswith("friction locks this design")


def test_what_if_has_no_value_where_friction_locks_the_changed_design(client: httpx.Client, solved: Solved) -> None:
    number = store_result(solved.store, solved.result, tomllib.loads(made.JOB) | {"friction": {"guide": 0.9}})
    lengths = {"crank_mm": 130.0, "rod_mm": 250.0, "offset_mm": 80.0}  # acos(210 / 250) - atan(0.9) = -9.1 deg
    answer = client.post(f"{API}/jobs/{number}/designs/1/what-if", json={**lengths, "angles": 0})
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert not {"inf", "-inf"} & {value for value in found["design"].values() if isinstance(value, str)}
    for name in FORCED:
        key = QUANTITIES[name].field
        reason = "friction locks this design: the self-locking margin"
        if name in ("efficiency", "force_transmission"):
            reason = ""  # which this machine lacks for want of a load
        assert found["design"][key] is None, key
        assert found["undefined"][key].startswith(reason), key
    assert {key for key, value in found["design"].items() if value is None} <= {*found["undefined"]}
    assert "self_locking_margin_deg" in found["broken"]


def test_a_swing_that_friction_locks_has_no_drive_and_says_why() -> None:
    job = {
        "name": "Locked swing",
        "mechanism": {"slider": {"mass": "2 kg"}},
        "motion": {"kind": "swing", "from": "20 deg", "to": "110 deg", "duration": "1 s", "law": "cycloidal"},
        "load": [{"force": "200 N", "opposes": "motion"}],
        "friction": {"guide": 0.9},
        "variables": {"crank": ["20 mm", "100 mm"], "rod": ["60 mm", "200 mm"], "offset": ["0 mm", "40 mm"]},
        "objectives": {"peak_actuator_torque": "minimise"},
    }
    analysis = sc.problem(job).analyse([0.05, 0.06, 0.0])
    for name in ("peak_actuator_torque", "peak_actuator_power", "swing_energy", "swing_efficiency"):
        assert analysis.undefined[name].startswith("friction locks this design: a drive must be able"), name
    assert [name for name, value in analysis.items() if not math.isfinite(value)] == ["rod_to_offset"]  # l / |e|
    assert "peak_actuator_torque" in sc.problem(job).analyse([0.05, 0.2, 0.01])


def test_a_design_that_runs_has_no_such_reason() -> None:
    analysis = sc.problem(JOB).analyse([0.03, 0.19, 0.01])
    assert not any("locks" in reason for reason in analysis.undefined.values())
    assert {*BLANK} <= {*analysis}
