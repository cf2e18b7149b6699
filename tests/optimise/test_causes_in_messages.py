"""Messages on a job name the true cause, and a remedy that helps."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import parse_job

SIEVE = tomllib.loads((Path(__file__).parents[2] / "runs" / "sieve.toml").read_text(encoding="utf-8"))
RUBS: dict[str, Any] = {"guide": 0.5}
TORQUE: dict[str, Any] = {"crank_torque": "-5 N m"}
TABLE: dict[str, Any] = {"positions": ["1 mm", "2 mm"], "forces": ["1 N", "2 N"]}


def job(load: list[dict[str, Any]], objective: str, /, **tables: Any) -> dict[str, Any]:
    """Return a job without masses, with one objective beside the time ratio."""
    better = "maximise" if objective == "efficiency" else "minimise"
    own = {"mechanism": {"speed": "60 rpm"}, "load": load, "objectives": {objective: better, "time_ratio": "maximise"}}
    return SIEVE | own | tables


def refusal(data: dict[str, Any]) -> str:
    with pytest.raises(JobError) as caught:
        parse_job(data)
    return str(caught.value)


@pytest.mark.parametrize("name", ["efficiency", "friction_loss"])
def test_friction_in_joints_without_forces_asks_for_a_force_and_not_for_friction(name: str) -> None:
    said = refusal(job([TORQUE], name, friction=RUBS))
    assert said.startswith(f"objectives.{name}: ")
    assert "without friction" not in said
    assert "[friction]" not in said
    assert "got no inertia force or weight of rod or slider, nor a load on the slider" in said
    assert 'for example, add [mechanism] slider = { mass = "0.8 kg" }' in said
    parse_job(job([TORQUE], name, friction=RUBS, mechanism={"speed": "60 rpm", "slider": {"mass": "0.8 kg"}}))
    parse_job(job([TORQUE, {"force": "200 N", "opposes": "motion"}], name, friction=RUBS))
    assert "got none; for example, add [friction] guide = 0.1" in refusal(job([TORQUE], name))


def test_friction_under_the_weight_of_a_crank_alone_is_not_called_no_friction() -> None:
    crank = {"speed": "60 rpm", "crank": {"mass": "1 kg"}, "gravity": "9.81 m/s^2"}
    said = refusal(job([], "mean_torque", mechanism=crank, friction=RUBS))
    assert "got no friction in joints that carry a force" in said


@pytest.mark.parametrize(
    ("load", "said"),
    [
        (
            {"force": "5 N", "opposes": "motion", "during": "outward stroke"},
            'load #2.during: a load with opposes must not have this key; got "outward stroke"; it belongs to a load '
            "with direction, positions, pressure_positions, crank_angles or pressure_angles; possible here: force, "
            "opposes",
        ),
        (
            {"crank_torque": "5 N m", "measured_from": "outer dead centre"},
            "load #2.measured_from"
            ': a load with crank_torque must not have this key; got "outer dead centre"; it belongs to a load with '
            "stiffness, positions, crank_angles or torque_angles; possible here: crank_torque",
        ),
        (
            {"crank_torque": "5 N m", "mesured_from": 1},
            'load #2.mesured_from: unknown key "mesured_from"; possible here: ',
        ),
        ({"force": "5 N", "direction": "inward", "durin": "cycle"}, "did you mean during?"),
    ],
)
def test_a_key_of_another_kind_of_load_is_said_to_be_one(load: dict[str, Any], said: str) -> None:
    assert said in refusal(SIEVE | {"load": [{"viscous": "15 N s/m"}, load]})


def test_a_key_of_another_kind_of_motor_is_said_to_be_one() -> None:
    said = refusal(SIEVE | {"drive": {"motor": {"torque": "5 N m", "no_load_speed": "1500 rpm"}}})
    assert "drive.motor.no_load_speed: a table with torque must not have this key" in said
    assert "it belongs to a table with stall_torque or rated_torque; possible here: torque" in said


def test_a_misspelt_width_of_a_link_alone_is_a_width() -> None:
    assert "did you mean width?" in refusal(SIEVE | {"mechanism": {"speed": "60 rpm", "crank": {"widht": "1 mm"}}})


def test_an_unknown_key_in_brackets_is_named_itself() -> None:
    said = refusal(SIEVE | {"mechanism": {"speed": "60 rpm", "(speed)": 3}})
    assert said.startswith('mechanism."(speed)": unknown key "(speed)"; ')


@pytest.mark.parametrize(
    ("path", "said"),
    [
        (
            "load.1.positions",
            "must name a single number; got load.1.positions, a list of 2 values; the values in a list",
        ),
        ("load.1.forces.2", "must name a single number; got load.1.forces.2 from a list of 2 values; the values in a"),
        ("load.1", "must name a number that the job gives; got load.1, a table without a number that can vary"),
        ("load.2", "must name a number that the job gives; got load.2, a table; did you mean load.2.force?"),
        ("mechanism.slider", "must name a number that the job gives; got mechanism.slider, a table; did you mean "),
        ("load.3.viscous", "must name a number that the job gives; got load.3.viscous; give it in [load] first"),
    ],
)
def test_what_cannot_vary_is_refused_for_what_it_is(path: str, said: str) -> None:
    slider = {"speed": "60 rpm", "slider": {"mass": "1 kg"}}
    data = job([TABLE, {"opposes": "motion", "force": "5 N"}], "peak_torque", mechanism=slider)
    wrong = refusal(data | {"variables": SIEVE["variables"] | {path: ["1 N", "2 N"]}})
    assert wrong.startswith(f"variables.{path}: {said}")


@pytest.mark.parametrize("name", ["peak_torque", "rms_torque"])
@pytest.mark.parametrize(
    "load",
    [
        {"crank_torque": "0 N m"},
        {"torque_angles": ["0 deg", "90 deg"], "torques": ["0 N m", "0 N m"]},
        TABLE | {"forces": ["0 N", "0 N"]},
        {"pressure_positions": ["1 mm", "2 mm"], "bore": "70 mm", "pressures": ["1 bar", "1 bar"]}
        | {"back_pressure": "1 bar"},
    ],
    ids=lambda load: next(iter(load)),
)
def test_a_load_of_zero_throughout_loads_nothing(load: dict[str, Any], name: str) -> None:
    said = refusal(job([load], name))
    assert said.startswith(
        f"objectives.{name}: it needs masses that move or have weight, or loads; got none, or only zeros"
    )
    assert "got none, or only zeros; for example, add [mechanism] slider = " in said
    parse_job(job([load, {"viscous": "15 N s/m"}], name))


@pytest.mark.parametrize("given", [["0 N m", "2 N m"], ["-2 N m", "2 N m"], {"choices": ["0 N m", "2 N m"]}])
def test_zero_may_be_the_start_or_a_choice_of_a_load_that_varies(given: Any) -> None:
    variables = SIEVE["variables"] | {"load.1.crank_torque": given}
    parse_job(job([{"crank_torque": "0 N m"}], "peak_torque", variables=variables))
