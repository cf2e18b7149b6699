"""Single designs over the API: numbers, curves, what-if, and jobs before anything runs."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import pytest
from typer.testing import CliRunner

from slidercrank.model.errors import RunError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.optimise.job import job_schema, load_job, parse_job
from slidercrank.optimise.problem.table_columns import choice_field
from slidercrank.optimise.solve import solve
from slidercrank.service.cli import app as command_line
from slidercrank.service.designs.design_curves import cycle_table
from slidercrank.service.designs.stored_designs import design_of_row, front_of_result
from slidercrank.service.questions.design_analysis import quantities_of_design
from slidercrank.service.runs.result import result_of
from tests.service import fronts, test_variables
from tests.service.api.fixed_front import API, Solved, client_of

TABLES = tomllib.loads(fronts.JOB)
SIZES = {"crank": "120 mm", "rod": "400 mm", "offset": "50 mm"}


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    """Return a client of its service."""
    with client_of(solved.store) as found:
        yield found


def command(*arguments: object) -> Any:
    """Return the JSON that the command line prints, or the sentence with which it refuses."""
    done = CliRunner().invoke(command_line, [str(argument) for argument in arguments])
    return json.loads(done.stdout) if done.exit_code == 0 else done.stderr.removeprefix("slidercrank: ").rstrip("\n")


def test_the_analysis_of_a_design_is_that_of_its_dimensions(solved: Solved, client: httpx.Client) -> None:
    row = solved.result.designs[3]
    found = client.get(f"{solved.path}/designs/4/analysis").json()
    assert (found["number"], found["notes"]) == (4, [])
    lengths = [f"--{name}={row[f'{name}_mm']!r} mm" for name in ("crank", "rod", "offset")]
    expected = command("analyse", solved.job, *lengths, "--json")
    expected.pop("rules")  # for which the API has a place of their own
    assert list(found["analysis"]) == list(expected)
    for key, value in expected.items():
        assert found["analysis"][key] == (pytest.approx(value, rel=1e-9) if isinstance(value, float) else value), key


def test_every_stored_number_comes_out_of_its_analysis_again(solved: Solved, client: httpx.Client) -> None:
    for number, row in enumerate(solved.result.designs, 1):
        analysis = client.get(f"{solved.path}/designs/{number}/analysis").json()["analysis"]
        for key in ("crank_mm", "rod_mm", "offset_mm"):
            assert analysis[key] == row[key]
        for key, value in analysis.items():
            if isinstance(value, float) and isinstance(row[key], float):
                assert value == pytest.approx(row[key], rel=1e-9, abs=1e-12), key


def test_topics_are_added(solved: Solved, client: httpx.Client) -> None:
    found = client.get(f"{solved.path}/designs/1/analysis", params={"show": ["static-forces", "motor,friction"]}).json()
    assert {"static_forces", "motor", "friction"} <= set(found["analysis"])
    assert found["notes"] == []


def test_topics_that_a_design_does_not_have_are_notes_only_for_all(solved: Solved, client: httpx.Client) -> None:
    row = solved.result.designs[0]
    lengths = [f"--{name}={row[f'{name}_mm']!r} mm" for name in ("crank", "rod", "offset")]
    answer = client.get(f"{solved.path}/designs/1/analysis?show=tolerances")
    assert answer.status_code == 422
    assert answer.json()["detail"] == command("analyse", solved.job, *lengths, "--show", "tolerances")
    notes = client.get(f"{solved.path}/designs/1/analysis?show=all").json()["notes"]
    assert any(note.startswith("tolerances: ") for note in notes)


def test_an_unknown_topic_is_refused_as_on_the_command_line(solved: Solved, client: httpx.Client) -> None:
    answer = client.get(f"{solved.path}/designs/1/analysis?show=balanse")
    assert answer.status_code == 422
    lengths = [f"--{name}={size}" for name, size in SIZES.items()]
    assert answer.json()["detail"] == command("analyse", solved.job, *lengths, "--show", "balanse").replace("--", "")


def test_curves_are_those_of_the_model(solved: Solved, client: httpx.Client) -> None:
    found = client.get(f"{solved.path}/designs/2/curves", params={"angles": 8}).json()
    stored = design_of_row(load_job(solved.job), solved.result.designs[1])
    assert found["curves"]["crank_angle_deg"] == pytest.approx([0, 45, 90, 135, 180, 225, 270, 315])
    motion = stored.linkage.at(np.radians(np.arange(0.0, 360.0, 45.0)), speed=stored.mechanism.speed)
    assert found["curves"]["slider_position_mm"] == pytest.approx(1e3 * motion.slider_position)
    assert found["curves"]["slider_velocity_m_s"] == pytest.approx(motion.slider_velocity)
    assert found["curves"]["slider_acceleration_m_s2"] == pytest.approx(motion.slider_acceleration)
    assert [column["key"] for column in found["columns"]] == list(found["curves"])
    assert all(len(values) == 8 for values in found["curves"].values())
    assert found["slow_stroke"] == solved.result.designs[1]["slow_stroke"]
    assert found["inner_dead_centre_deg"] == pytest.approx(solved.result.designs[1]["inner_dead_centre_deg"])


def test_curves_reach_the_peaks_of_the_table(solved: Solved, client: httpx.Client) -> None:
    curves = client.get(f"{solved.path}/designs/1/curves", params={"angles": 3600}).json()["curves"]
    row = solved.result.designs[0]
    assert min(curves["transmission_angle_deg"]) == pytest.approx(row["least_transmission_angle_deg"], rel=1e-5)
    assert max(map(abs, curves["torque_Nm"])) == pytest.approx(row["peak_torque_Nm"], rel=1e-4)
    assert max(map(abs, curves["guide_N"])) == pytest.approx(row["peak_guide_force_N"], rel=1e-4)
    pin = np.hypot(curves["crank_pin_x_N"], curves["crank_pin_y_N"])
    assert pin.max() == pytest.approx(row["peak_crank_pin_force_N"], rel=1e-4)


@pytest.mark.parametrize("angles", [3, 3601, -1, 10**30])
def test_curves_of_too_few_or_too_many_angles_are_refused(angles: int, solved: Solved, client: httpx.Client) -> None:
    assert client.get(f"{solved.path}/designs/1/curves?angles={angles}").status_code == 422


def test_curves_without_a_speed_are_per_crank_speed() -> None:
    table = {column.key: column for column in cycle_table(Mechanism(), Linkage(0.04, 0.1), angles=4)}
    assert table["slider_velocity_mm_per_rad"].unit == "mm/rad"
    assert table["slider_velocity_mm_per_rad"].values == pytest.approx([0.0, -40.0, 0.0, 40.0])


def test_what_if_is_what_the_command_line_analyses(solved: Solved, client: httpx.Client) -> None:
    answer = client.post(f"{API}/analyse", json={"job": TABLES, **SIZES, "show": ["motor"]})
    lengths = [f"--{name}={size}" for name, size in SIZES.items()]
    expected = command("analyse", solved.job, *lengths, "--show", "motor", "--json")
    assert all(rule["met"] is not None for rule in expected.pop("rules"))
    assert answer.json()["analysis"] == expected


def test_what_if_takes_other_numbers_of_the_job(solved: Solved, client: httpx.Client) -> None:
    body = {"job": TABLES, **SIZES, "values": {"mechanism.slider.mass": "4 kg"}, "speed": "150 rpm"}
    answer = client.post(f"{API}/analyse", json=body)
    lengths = [f"--{name}={size}" for name, size in SIZES.items()]
    more = ("--set", "mechanism.slider.mass=4 kg", "--speed", "150 rpm")
    expected = command("analyse", solved.job, *lengths, *more, "--json")
    expected.pop("rules")
    assert answer.json()["analysis"] == expected


@pytest.mark.parametrize(
    ("sizes", "arguments"),
    [
        ({"crank": "120 mm", "rod": "400 mm"}, ("--crank=120 mm", "--rod=400 mm")),
        ({**SIZES, "crank": "120"}, ("--crank=120", "--rod=400 mm", "--offset=50 mm")),
        ({**SIZES, "rod": "100 mm"}, ("--crank=120 mm", "--rod=100 mm", "--offset=50 mm")),
        ({**SIZES, "crank": "-1 mm"}, ("--crank=-1 mm", "--rod=400 mm", "--offset=50 mm")),
        ({**SIZES, "speed": "nan rpm"}, ("--crank=120 mm", "--rod=400 mm", "--offset=50 mm", "--speed=nan rpm")),
    ],
)
def test_a_wrong_what_if_is_refused_as_on_the_command_line_but_for_dashes(
    sizes: dict[str, str], arguments: tuple[str, ...], solved: Solved, client: httpx.Client
) -> None:
    answer = client.post(f"{API}/analyse", json={"job": TABLES, **sizes})
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert answer.json()["detail"] == command("analyse", solved.job, *arguments, "--json").replace("--", "")


def test_unknown_keys_of_a_what_if_are_refused(client: httpx.Client) -> None:
    answer = client.post(f"{API}/analyse", json={"job": TABLES, **SIZES, "rodd": "1 mm"})
    assert answer.status_code == 422
    assert "rodd" in answer.json()["detail"]


def test_the_schema_is_that_of_jobs(client: httpx.Client) -> None:
    assert client.get(f"{API}/schema").json() == job_schema()


def test_check_says_what_the_command_line_says(solved: Solved, client: httpx.Client) -> None:
    expected = command("check", solved.job, "--json")
    assert client.post(f"{API}/check", json={"job": TABLES}).json() == expected
    as_file = client.post(f"{API}/check", content=fronts.JOB, headers={"Content-Type": "application/toml"})
    assert as_file.json() == expected


@pytest.mark.parametrize("place", ["check", "analyse"])
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"variables": {"crank": ["20 mm", "10 mm"]}}, "variables"),
        ({"target_motion": {"file": "/etc/passwd"}}, "a file must be in the folder of the job file, or be sent"),
        ({"quantity": {"evil": {"function": "os:system", "unit": "mm", "title": "x"}}}, "quantity.evil"),
        ({"mechanism": {"speed": "nan rpm"}}, "speed"),
    ],
)
def test_a_wrong_job_is_refused_before_anything_runs(
    place: str, change: dict[str, Any], words: str, client: httpx.Client
) -> None:
    body = {"job": {**TABLES, **change}, **(SIZES if place == "analyse" else {})}
    answer = client.post(f"{API}/{place}", json=body)
    assert (answer.status_code, answer.headers["content-type"]) == (422, "application/problem+json")
    assert words in answer.json()["detail"]


def test_stored_designs_have_the_choices_and_the_varying_numbers_of_their_rows() -> None:
    problem = parse_job(tomllib.loads(test_variables.JOB))
    front = solve(problem)
    result = result_of(front, "x")
    again = front_of_result(problem, result)
    assert again.variants == front.variants
    assert len(set(front.variants)) > 1
    assert again.dimensions == pytest.approx(front.dimensions, rel=1e-15)
    assert again.values == pytest.approx(front.values, rel=1e-14)
    assert (again.knee(), again.extremes()) == (result.knee, result.extremes)
    for row, given in enumerate(result.designs):
        stored = design_of_row(problem, given)
        assert stored.part.rod == front.part(row).rod
        assert stored.mechanism == again.mechanism(row)
        for key, value in quantities_of_design(stored.mechanism, stored.linkage)[0].items():
            expected = (
                pytest.approx(given[key], rel=1e-9, abs=1e-12, nan_ok=True) if isinstance(value, float) else value
            )
            assert value == expected, key


@pytest.mark.parametrize("change", [{"crank_mm": math.nan}, {"choice_rod_section": "1 m"}, {"slider_mass_kg": "heavy"}])
def test_a_row_of_another_job_is_refused(change: dict[str, Any]) -> None:
    problem = parse_job(tomllib.loads(test_variables.JOB))
    row: dict[str, Any] = {"crank_mm": 40.0, "rod_mm": 150.0, "offset_mm": 10.0, "slider_mass_kg": 1.0}
    labels = zip(problem.choices, problem.variants[0].labels, strict=True)
    row |= {choice_field(name): label for name, label in labels}
    assert change.keys() <= row.keys()
    design_of_row(problem, row)
    with pytest.raises(RunError, match="a stored design must match its job"):
        design_of_row(problem, {**row, **change})
