"""Quantities of every sort, built-in, robust, of a wanted motion and own ones, at every door that takes a name."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app
from slidercrank.service.store import Store
from tests.service.api.serving import client_of
from tests.service.conftest import Command

JOB = """
name = "All sorts"
[mechanism]
speed = "300 rpm"
slider = { mass = "2 kg" }
[tolerances]
crank = "0.05 mm"
rod = "0.1 mm"
offset = "0.05 mm"
[target_motion]
crank_angles = ["0 deg", "90 deg", "180 deg", "270 deg"]
positions = ["240 mm", "190 mm", "130 mm", "180 mm"]
shift = "free"
[quantity.mine]
function = "judges:jerk"
unit = "m/s^3"
[quantity.pin_force]
function = "judges:force"
unit = "kN"
[variables]
crank = ["30 mm", "60 mm"]
rod = ["120 mm", "300 mm"]
offset = ["5 mm", "60 mm"]
[constraints]
stroke = { equals = "100 mm" }
transmission_angle = { min = "30 deg" }
pin_force = { max = "100 kN" }
[objectives]
peak_torque = "minimise"
motion_deviation = "minimise"
mine = "minimise"
time_ratio = "maximise"
[robust]
kind = "worst case"
order = 1
quantities = ["peak_torque", "transmission_angle"]
[optimiser]
designs = 10
samples = 128
"""
JUDGES = """
def jerk(designs):
    return 1e5 * designs.crank**2 / designs.rod

def force(designs):
    return 1e7 * designs.rod * designs.crank
"""
# Name, column, a little of it with its unit, and whether it is an objective of the run.
SORTS = {
    "built-in": ("time_ratio", "time_ratio", "0.01", True),
    "built-in, neither": ("peak_guide_force", "peak_guide_force_N", "1 N", False),
    "robust": ("peak_torque_robust", "peak_torque_robust_Nm", "1 N m", True),
    "robust constraint": (
        "transmission_angle_robust",
        "least_transmission_angle_robust_deg",
        "1 deg",
        False,
    ),
    "motion deviation": ("motion_deviation", "motion_deviation_mm", "0.1 mm", True),
    "motion deviation, neither": ("motion_deviation_rms", "motion_deviation_rms_mm", "0.1 mm", False),
    "own": ("mine", "mine_m_s3", "100 mm/s^3", True),
    "own constraint": ("pin_force", "pin_force_kN", "0.1 kN", False),
}
OBJECTIVES = {name: row for name, row in SORTS.items() if row[3]}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a place with a job and a run of it."""
    folder = tmp_path_factory.mktemp("sorts")
    (folder / "job.toml").write_text(JOB, encoding="utf-8")
    (folder / "judges.py").write_text(JUDGES, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("SLIDERCRANK_STORE", raising=False)
        done = CliRunner().invoke(
            app, ["optimise", str(folder / "job.toml"), "--runs", str(folder / "runs"), "--no-figures"]
        )
    assert done.exit_code == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def designs(place: Path) -> list[dict[str, Any]]:
    (file,) = place.glob("runs/*/front.json")
    found: list[dict[str, Any]] = json.loads(file.read_text())["designs"]
    return found


def answer(command: Command, *arguments: object) -> Any:
    done = command(*arguments)
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("sort", SORTS)
def test_the_front_is_sorted_filtered_and_shown_by_it(
    sort: str, place: Path, designs: list[dict[str, Any]], command: Command
) -> None:
    name, column, _, _ = SORTS[sort]
    values = [row[column] for row in designs]
    middle = float(np.median(values))
    at = ("latest", "--runs", place / "runs", "--json", "--columns", name)
    least = answer(command, "front", *at, "--sort", name)["designs"]
    falls = name == "time_ratio"  # best first
    assert [row[column] for row in least] == sorted(values, reverse=falls)
    kept = answer(command, "front", *at, "--where", f"{column} <= {middle!r}")["designs"]
    assert len(kept) == sum(value <= middle * (1.0 + 1e-8) for value in values) < len(values)


@pytest.mark.parametrize("sort", OBJECTIVES)
def test_a_design_is_chosen_by_it_on_the_command_line_and_by_the_api(
    sort: str, place: Path, designs: list[dict[str, Any]], command: Command, api: httpx.Client
) -> None:
    name, column, little, _ = SORTS[sort]
    best = (max if name == "time_ratio" else min)(row[column] for row in designs)
    other = "peak_torque_robust" if name == "time_ratio" else "time_ratio"
    for ranking in (name, f"{name}: {little}, {other}"):
        line = answer(command, "front", "latest", "--runs", place / "runs", "--json", "--lexicographic", ranking)
        served = api.get("jobs/1/pick", params={"lexicographic": ranking})
        assert served.status_code == 200, served.text
        assert served.json()["number"] == line["number"]
        if ranking == name:
            assert designs[line["number"] - 1][column] == best
    weighed = answer(command, "front", "latest", "--runs", place / "runs", "--json", "--topsis", f"{name}=1")
    served = api.get("jobs/1/pick", params={"topsis": f"{name}=1"})
    assert designs[weighed["number"] - 1][column] == best
    assert served.json()["number"] == weighed["number"]


def test_a_tolerance_of_a_ranking_counts_in_the_unit_that_it_is_given_in(
    place: Path, designs: list[dict[str, Any]], command: Command
) -> None:
    """A twentieth of the range of the own quantity, in its shown unit and in another one, chooses the same."""
    values = [row["mine_m_s3"] for row in designs]
    slack = 0.4 * (max(values) - min(values))
    chosen = {
        answer(
            command,
            *("front", "latest", "--runs", place / "runs", "--json"),
            *("--lexicographic", f"mine: {given}, peak_torque_robust"),
        )["number"]
        for given in (f"{slack!r} m/s^3", f"{1e3 * slack!r} mm/s^3", "40 %")
    }
    near = [row for row in designs if row["mine_m_s3"] <= min(values) + slack]
    (number,) = chosen
    assert designs[number - 1]["peak_torque_robust_Nm"] == min(row["peak_torque_robust_Nm"] for row in near)
    assert len(near) > 1


@pytest.mark.parametrize("sort", SORTS)
def test_it_is_swept(sort: str, place: Path, designs: list[dict[str, Any]], command: Command) -> None:
    name, column, _, _ = SORTS[sort]
    row = designs[0]
    sizes = [f"--{size}={row[f'{size}_mm']!r} mm" for size in ("crank", "rod")]
    over = f"offset={row['offset_mm']!r} mm, 6 mm"
    found = answer(command, "sweep", place / "job.toml", *sizes, "--over", over, "--of", name, "--json")
    assert found[0][column] == pytest.approx(row[column], rel=1e-9)
    shown = command("sweep", place / "job.toml", *sizes, "--over", over, "--of", name)
    assert shown.exit_code == 0
    assert f"{row[column]:.6g}" in shown.stdout


@pytest.mark.parametrize("sort", ["robust constraint", "motion deviation, neither", "own constraint"])
def test_a_design_like_another_is_asked_for_by_it(
    sort: str, place: Path, designs: list[dict[str, Any]], command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "slidercrank.optimise.decisions.similar_design._ROUNDS", 1
    )  # how near it comes is tested elsewhere
    monkeypatch.setattr("slidercrank.optimise.decisions.similar_design._STARTS", 4)
    name, column, _, _ = SORTS[sort]
    ranked = sorted(range(len(designs)), key=lambda row: designs[row][column])
    row, other = (ranked[3], ranked[6]) if name == "transmission_angle_robust" else (ranked[6], ranked[3])
    wanted = designs[other][column]
    sign = ">=" if wanted > designs[row][column] else "<="
    arguments = (
        "like",
        "latest",
        row + 1,
        "--runs",
        place / "runs",
        "--json",
        "--where",
        f"{column} {sign} {wanted!r}",
    )
    after = answer(command, *arguments)["design"]
    assert (after[column] - wanted) * (1.0 if sign == ">=" else -1.0) >= -1e-6 * wanted


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("front", "latest", "--sort", "peak_torqe"), "there is no quantity or column 'peak_torqe'; did you mean"),
        (("front", "latest", "--lexicographic", "yours"), "got 'yours'; name one of them"),
        (("front", "latest", "--lexicographic", "stroke"), "peak_torque_robust, .*got 'stroke'; name one of them"),
        (("like", "latest", 1, "--where", "yours >= 3"), "there is no quantity or column 'yours'"),
    ],
)
def test_an_unknown_name_is_refused_with_those_of_the_run(
    arguments: tuple[object, ...], said: str, place: Path, command: Command
) -> None:
    import re

    done = command(*arguments, "--runs", place / "runs")
    assert done.exit_code == 2
    assert re.search(said, done.stderr.replace("\n", " "))


def test_a_sweep_names_the_nearest_quantity_of_the_job(place: Path, command: Command) -> None:
    sizes = ("--crank", "40 mm", "--rod", "160 mm")
    done = command("sweep", place / "job.toml", *sizes, "--over", "offset=5 mm, 6 mm", "--of", "pin_forse")
    assert done.exit_code == 2
    assert "did you mean pin_force?" in done.stderr


@pytest.fixture(scope="module")
def api(place: Path) -> Any:
    with Store(place / "runs" / "slidercrank.db") as store, client_of(store) as client:
        yield client
