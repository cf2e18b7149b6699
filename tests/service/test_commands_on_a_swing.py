"""Commands on a run whose crank swings: the same numbers everywhere, or a sentence with what to do instead."""

from __future__ import annotations

import csv
import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.service.cli import app
from slidercrank.service.jobs.job_toml import job_toml
from tests.optimise.problems import search_little
from tests.service.conftest import Command

BAR = {"width": "120 mm", "depth": "80 mm", "density": "7800 kg/m^3"}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a place with a run of the support whose rod is a bar of a width to be found."""
    place = tmp_path_factory.mktemp("swinging")
    job: dict[str, Any] = tomllib.loads(Path("runs/support.toml").read_text(encoding="utf-8"))
    job["mechanism"]["rod"] = BAR
    job["variables"]["mechanism.rod.width"] = ["60 mm", "200 mm"]
    job["objectives"]["rod_mass"] = "minimise"
    job["optimiser"] = {"method": "sobol", "evaluations": 400, "designs": 4, "seed": 1}
    file = place / "job.toml"
    file.write_text(job_toml(job), encoding="utf-8")
    done = CliRunner().invoke(app, ["optimise", str(file), "--runs", str(place / "runs"), "--no-figures"])
    assert done.exit_code == 0, done.stderr
    return place


def json_output(command: Command, place: Path, name: str, *given: object) -> Any:
    """Return the JSON output of a command on the run."""
    done = command(name, "latest", *given, "--runs", place / "runs", "--json")
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout)


def rows_of(command: Command, place: Path) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = json_output(command, place, "front")["designs"]
    assert len(rows) >= 2
    return rows


def test_swing_and_front_tell_the_same_of_each_design(command: Command, place: Path) -> None:
    for number, row in enumerate(rows_of(command, place), 1):
        found = json_output(command, place, "swing", "--design", number)
        assert row["peak_actuator_force_N"] == pytest.approx(abs(found["peak_drive_N"]), rel=1e-9)
        assert row["swing_angle_error_deg"] == pytest.approx(found["crank_position_error_deg"], rel=1e-9)
        assert row["actuator_travel_mm"] == pytest.approx(found["travel_mm"], rel=1e-12)
        assert row["swing_energy_J"] == pytest.approx(found["energy_forth_J"], rel=1e-9)
        width, long = 1e-3 * row["rod_width_mm"], 1e-3 * row["rod_mm"]
        mass = 7800.0 * 0.08 * (width * long + 0.25 * math.pi * width**2)
        assert row["rod_mass_kg"] == pytest.approx(mass, rel=1e-12)
        assert row["crank_mass_kg"] == pytest.approx(1200.0)
        assert row["moving_mass_kg"] == pytest.approx(1600.0 + mass, rel=1e-12)


def test_designs_are_chosen_by_what_they_are(command: Command, place: Path) -> None:
    rows = rows_of(command, place)
    middle = float(np.median([row["rod_mass_kg"] for row in rows]))
    kept = json_output(command, place, "front", "--where", f"rod_mass <= {middle!r} kg", "--sort", "swing_angle_error")
    few = [row for row in rows if row["rod_mass_kg"] <= middle]
    expected = sorted(few, key=lambda row: row["swing_angle_error_deg"])
    assert [row["crank_mm"] for row in kept["designs"]] == [row["crank_mm"] for row in expected]


def test_every_export_is_of_the_swing(command: Command, place: Path, tmp_path: Path) -> None:
    rows = rows_of(command, place)
    row = rows[0]
    for kind in ("csv", "json", "dxf", "svg", "motion", "gif", "cycle"):
        one = () if kind in ("csv", "json") else ("--design", 1)
        done = command("export", "latest", *one, f"--{kind}", tmp_path / kind, "--runs", place / "runs")
        assert done.exit_code == 0, done.stderr
    table = next(csv.DictReader((tmp_path / "csv").read_text(encoding="utf-8").splitlines()))
    kept = json.loads((tmp_path / "json").read_text(encoding="utf-8"))
    for name in ("peak_actuator_force_N", "rod_mass_kg", "swing_angle_error_deg"):
        assert float(table[name]) == row[name]
    assert [each["rod_mass_kg"] for each in kept["designs"]] == [each["rod_mass_kg"] for each in rows]
    cycle = list(csv.DictReader((tmp_path / "cycle").read_text(encoding="utf-8").splitlines()))
    drive = [abs(float(line["drive_N"])) for line in cycle]
    assert max(drive) == pytest.approx(row["peak_actuator_force_N"], rel=1e-3)
    assert [float(cycle[at]["crank_angle_deg"]) for at in (0, 180, -1)] == pytest.approx([11.16, 101.16, 11.16])
    assert "BODY" in (tmp_path / "dxf").read_text(encoding="ascii")
    assert 'id="BODY"' in (tmp_path / "svg").read_text(encoding="utf-8")
    assert "Back and forth" in (tmp_path / "motion").read_text(encoding="utf-8")
    assert (tmp_path / "gif").read_bytes().startswith(b"GIF89a")


def test_the_report_has_the_numbers_of_the_front(command: Command, place: Path, tmp_path: Path) -> None:
    done = command("report", "latest", "--design", 1, "--out", tmp_path / "report.html", "--runs", place / "runs")
    assert done.exit_code == 0, done.stderr
    text = re.sub(r"<[^>]*>", " ", (tmp_path / "report.html").read_text(encoding="utf-8"))
    row = rows_of(command, place)[0]
    for key in ("peak_actuator_force_N", "rod_mass_kg", "actuator_travel_mm"):
        assert f"{row[key]:.5g}" in text


@pytest.mark.slow
def test_round_like_and_wish_answer_with_designs_that_swing(
    command: Command, place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each tells of its design what `swing` tells of these lengths; the machine is that of the design."""
    search_little(monkeypatch)
    rows = rows_of(command, place)
    least = min(row["actuator_travel_mm"] for row in rows)
    near = json_output(command, place, "round", 1, "--to", "10 mm")
    like = json_output(command, place, "like", 1, "--where", f"actuator_travel <= {least - 20.0!r} mm")
    wish = json_output(command, place, "wish", 1, "--at", "swing_angle_error=improve")
    answers = [near["designs"][0], like["design"], wish["design"]]
    for row in answers:
        linkage = Linkage(*(1e-3 * row[f"{name}_mm"] for name in ("crank", "rod", "offset")))
        x = [float(linkage.at(math.radians(angle)).slider_position) for angle in (11.16, 101.16)]
        told = row.get("actuator_travel_mm", 2400.0 - row["slack_actuator_travel_mm"])
        assert told == pytest.approx(1e3 * (x[0] - x[1]), abs=1e-6)
    assert answers[0]["crank_mm"] % 10.0 == pytest.approx(0.0, abs=1e-9)
    assert answers[1]["actuator_travel_mm"] <= least - 20.0 + 1e-6
    assert answers[2]["swing_angle_error_deg"] <= rows[0]["swing_angle_error_deg"]


def test_inverse_gives_the_crank_angles_of_the_swing(command: Command, place: Path) -> None:
    random = np.random.default_rng(15)
    for number, row in enumerate(rows_of(command, place), 1):
        linkage = Linkage(*(1e-3 * row[f"{name}_mm"] for name in ("crank", "rod", "offset")))
        for angle in random.uniform(11.2, 101.1, 3):
            at = float(linkage.at(math.radians(angle)).slider_position)
            found = json_output(command, place, "inverse", "--design", number, f"--slider-position={1e3 * at!r} mm")
            assert [each["crank_angle_deg"] for each in found["solutions"]] == pytest.approx([angle], rel=1e-9)
            assert (
                "one other crank angle for this position lies outside the swing from 11.16 to 101.16" in found["note"]
            )
    inside = float(linkage.at(math.radians(120.0)).slider_position)
    done = command("inverse", "latest", "--design", number, f"--slider-position={inside!r} m", "--runs", place / "runs")
    assert done.exit_code == 2
    stays = (
        r"must be between [\d.]+ and [\d.]+ mm, the slider's travel while the crank swings from 11\.16 to 101\.16 deg; "
        r"got [\d.]+ mm"
    )
    assert re.search(stays, " ".join(done.stderr.split()))


@pytest.mark.parametrize(
    ("name", "given", "words"),
    [
        ("analyse", ("--design", 1), "use swing to analyse its designs"),
        ("analyse", ("--design", 1, "--show", "balance"), "use swing to analyse its designs"),
        ("analyse", ("--design", 1, "--measured", "curves.csv"), "use swing to analyse its designs"),
        (
            "report",
            ("--design", 1, "--measured", "curves.csv"),
            "with measured curves needs a rotating crank",
        ),
        ("front", ("--where", "stroke >= 1 m"), "'stroke'"),
    ],
)
def test_what_is_of_a_full_turn_is_refused_in_a_sentence(
    command: Command, place: Path, tmp_path: Path, name: str, given: tuple[object, ...], words: str
) -> None:
    (tmp_path / "curves.csv").write_text("crank_angle_deg,slider_position_mm\n20,3000\n40,2500\n90,1500\n")
    options = [tmp_path / one if one == "curves.csv" else one for one in given]
    options += ["--out", tmp_path / "report.html"] if name == "report" else []
    done = command(name, "latest", *options, "--runs", place / "runs")
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in " ".join(done.stderr.split())
    assert "Traceback" not in done.stderr
