"""`slidercrank swing`: numbers of Python in JSON, curves, figure, units, messages."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.optimise.job import load_job
from tests.model.swing.swings import random_swings
from tests.service.conftest import Command

SUPPORT = Path("tests/data/turning_support.toml")
SIZES = ("--crank", "1.4 m", "--rod", "1.8 m", "--offset", "-50 mm")
OVER = ("--from", "11.16 deg", "--to", "101.16 deg")


def numbers_of(command: Command, *arguments: object) -> dict[str, Any]:
    done = command("swing", *arguments, "--json")
    assert done.exit_code == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize("driver", ["crank", "slider"])
def test_json_has_the_numbers_of_python(command: Command, driver: Any) -> None:
    law = ["--law", "cycloidal", "--duration", "30 s"]
    off = 1e-3 if driver == "slider" else 0.0
    law += ["--actuator-tolerance", "1 mm"] if off else []
    found = numbers_of(command, SUPPORT, *SIZES, *OVER, "--driver", driver, *law)
    expected = load_job(SUPPORT).swing(
        [1.4, 1.8, -0.05],
        start=math.radians(11.16),
        end=math.radians(101.16),
        driver=driver,
        law="cycloidal",
        duration=30.0,
        actuator_tolerance=off,
    )
    unit, side, factor = ("Nm", "slider", 1e3) if driver == "crank" else ("N", "crank", 180.0 / math.pi)
    error = f"{side}_position_error_{'mm' if driver == 'crank' else 'deg'}"
    assert expected.position_error is not None
    assert expected.peak_power is not None
    for key, value in {
        f"peak_drive_{unit}": expected.peak_drive.value,
        f"drive_at_start_forth_{unit}": expected.drive_start[0],
        f"drive_at_end_back_{unit}": expected.drive_end[1],
        "energy_forth_J": expected.energy_forward,
        "travel_mm": 1e3 * expected.travel,
        "peak_power_W": expected.peak_power.value,
        "least_transmission_angle_deg": math.degrees(expected.least_transmission.value),
        error: factor * expected.position_error.value,
    }.items():
        assert found[key] == pytest.approx(value, rel=1e-12), key
    place = found[f"{side}_position_error_at_crank_angle_deg"]
    assert place == pytest.approx(math.degrees(expected.position_error.crank_angle), abs=1e-5)  # flat at the top


def test_random_linkages_that_need_not_turn_through(command: Command) -> None:
    seen = set()
    for _, linkage, swing in random_swings(30, seed=31):
        sizes = [f"{float(getattr(linkage, name))!r} m" for name in ("crank", "rod", "offset")]
        ends = [f"{math.degrees(angle)!r} deg" for angle in (swing.start, swing.end)]
        if linkage.branch == "crossed":
            continue
        given = ("--crank", sizes[0], "--rod", sizes[1], "--offset", sizes[2], "--from", ends[0], "--to", ends[1])
        found = numbers_of(command, *given, "--driver", swing.driver)
        x = [1e3 * float(linkage.at(angle).slider_position) for angle in (swing.start, swing.end)]
        assert [found["start_slider_position_mm"], found["end_slider_position_mm"]] == pytest.approx(x, rel=1e-9)
        assert "the drive is zero" in found["notes"][0]
        seen.add(bool(linkage.rotates_fully))
    assert False in seen


def test_curves_and_figure(command: Command, tmp_path: Path) -> None:
    curves, figure = tmp_path / "curves.csv", tmp_path / "a" / "swing.png"
    given = (SUPPORT, *SIZES, *OVER, "--driver", "slider", "--curves", curves, "--figure", figure)
    done = command("swing", *given)
    assert done.exit_code == 0, done.stderr
    assert "peak drive" in done.stdout
    with curves.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [rows[0]["way"], rows[-1]["way"]] == ["forth", "back"]
    angles = [float(row["crank_angle_deg"]) for row in rows]
    assert angles[0] == pytest.approx(11.16, abs=1e-9)
    assert angles[180] == angles[181] == pytest.approx(101.16, abs=1e-9)
    peak = max(abs(float(row["drive_N"])) for row in rows)
    assert peak == pytest.approx(abs(numbers_of(command, *given[:-4])["peak_drive_N"]), rel=1e-6)
    assert figure.read_bytes().startswith(b"\x89PNG")


def test_speed_and_acceleration_of_the_crank_stand_in_curves_and_extremes(command: Command, tmp_path: Path) -> None:
    """Summed up over the time they are the angle and the speed."""
    curves, timed = tmp_path / "curves.csv", ("--law", "polynomial", "--duration", "4 s")
    given = (SUPPORT, *SIZES, *OVER, "--driver", "slider", *timed)
    found = numbers_of(command, *given, "--curves", curves)["extremes"]
    with curves.open(encoding="utf-8") as file:
        forth = [row for row in csv.DictReader(file) if row["way"] == "forth"]
    columns = ("time_s", "crank_angle_deg", "crank_speed_rpm", "crank_acceleration_rad_s2")
    time, angle, speed, rise = (np.array([float(row[name]) for row in forth]) for name in columns)
    assert np.trapezoid(6.0 * speed, time) == pytest.approx(angle[-1] - angle[0], rel=1e-3)
    assert np.trapezoid(rise[:91], time[:91]) == pytest.approx(speed[90] * math.pi / 30.0, rel=1e-3)
    assert found["crank_speed"]["greatest_rpm"] == pytest.approx(speed.max(), rel=1e-3)
    assert found["crank_acceleration"]["least_rad_s2"] == pytest.approx(rise.min(), rel=1e-3)
    assert "crank_speed" not in numbers_of(command, *given[: -len(timed)])["extremes"]  # slow


def test_inch_units_are_the_metric_ones_converted(command: Command) -> None:
    given = (SUPPORT, *SIZES, *OVER, "--driver", "slider")
    metric, inch = numbers_of(command, *given), numbers_of(command, *given, "--units", "inch")
    assert inch["travel_in"] == pytest.approx(metric["travel_mm"] / 25.4, rel=1e-12)
    assert inch["peak_drive_lbf"] == pytest.approx(metric["peak_drive_N"] / 4.4482216152605, rel=1e-12)
    assert inch["peak_drive_at_crank_angle_deg"] == metric["peak_drive_at_crank_angle_deg"]


def test_a_design_of_a_run_swings_with_its_own_machine(command: Command) -> None:
    found = numbers_of(command, SUPPORT, *SIZES, *OVER)
    assert found["driver"] == "crank"
    assert found["peak_drive_Nm"] == pytest.approx(-46492.83, rel=1e-6)
    refused = command("swing", SUPPORT, *SIZES, *OVER, "--design", "1")
    assert refused.exit_code == 2


def test_what_is_not_given_is_as_the_job_has_it(command: Command) -> None:
    problem = load_job("runs/support.toml")
    assert problem.motion is not None
    found = numbers_of(command, "runs/support.toml", *SIZES)
    names = ["peak_actuator_force", "swing_angle_error", "actuator_travel", "swing_transmission_angle"]
    force, error, travel, angle = problem.evaluate([[1.4, 1.8, -0.05]], names)[0]
    assert abs(found["peak_drive_N"]) == pytest.approx(force, rel=1e-9)
    assert found["crank_position_error_deg"] == pytest.approx(math.degrees(error), rel=1e-9)
    assert found["travel_mm"] == pytest.approx(1e3 * travel, rel=1e-12)
    assert found["least_transmission_angle_deg"] == pytest.approx(math.degrees(angle), rel=1e-9)
    other = numbers_of(command, "runs/support.toml", *SIZES, "--to", "60 deg", "--actuator-tolerance", "0 mm")
    assert other["end_crank_angle_deg"] == pytest.approx(60.0)
    assert other["crank_position_error_deg"] < found["crank_position_error_deg"]
    bare = command("swing", *SIZES, "--to", "60 deg")
    assert (bare.exit_code, "got no --from" in bare.stderr) == (2, True)


@pytest.mark.parametrize(
    "given",
    [
        ("analyse",),
        ("sweep", "--over", "offset=-60 mm..0 mm:3", "--of", "peak_actuator_force"),
        ("sections",),
        ("allocate", "--limit", "1 mm"),
        ("balance",),
    ],
    ids=lambda given: given[0],
)
def test_commands_of_a_full_turn_say_so_of_a_job_that_swings(command: Command, given: tuple[str, ...]) -> None:
    name, *options = given
    sizes = SIZES if name != "sweep" else SIZES[:4]
    done = command(name, "runs/support.toml", *sizes, *options)
    assert done.exit_code == 2
    assert f"{name} needs a rotating crank; the crank of this job swings" in " ".join(done.stderr.split())


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("--from", "11 deg", "--to", "11 deg"), "less than a turn apart"),
        (("--from", "", "--to", "50 deg"), "--from must be an angle"),
        (("--from", "11", "--to", "50 deg"), "--from must be an angle with its unit"),
        (("--from", "11 deg", "--to", "50 mm"), "--to must be an angle"),
        (("--from", "-20 deg", "--to", "50 deg", "--driver", "slider"), "dead point"),
        ((*OVER, "--driver", "motor"), "'motor' is not one of"),
        ((*OVER, "--law", "harmonic"), "any other swing must have one"),
        ((*OVER, "--duration", "3 s"), "a slow swing must have no duration"),
        ((*OVER, "--law", "harmonic", "--duration", "0 s"), "--duration must be"),
        ((*OVER, "--actuator-tolerance", "-1 mm"), "--actuator-tolerance must"),
        ((*OVER, "--actuator-tolerance", "1 mm"), "needs a slider that drives"),
        ((*OVER, "--curves", "-"), "name one"),
        ((*OVER, "--figure", "swing.svg"), "must end with .png"),
        ((*OVER, "--curves", "."), "must end with .csv"),
        ((*OVER, "--actuator-tolerance", "inf mm"), 'got "inf mm"; write it like "80 mm"'),
    ],
)
def test_wrong_input_is_a_sentence(command: Command, given: tuple[str, ...], words: str) -> None:
    done = command("swing", SUPPORT, *SIZES, *given)
    assert done.exit_code == 2
    assert words in " ".join(done.stderr.split())
    assert "Traceback" not in done.stderr
    assert "plain number" not in done.stderr  # a command takes none


def test_a_linkage_that_does_not_close_is_told_where(command: Command) -> None:
    done = command("swing", "--crank", "100 mm", "--rod", "60 mm", "--from", "0 deg", "--to", "80 deg")
    assert done.exit_code == 2
    assert "got a rod of 60 mm and 98.4808 mm at 80 deg" in done.stderr


def test_random_ends_never_end_in_a_traceback(command: Command) -> None:
    random = np.random.default_rng(8)
    for _ in range(40):
        size = [f"{value:.4g} mm" for value in random.uniform([1.0, 1.0, -200.0], [200.0, 200.0, 200.0])]
        ends = [f"{value:.4g} deg" for value in random.uniform(-800.0, 800.0, 2)]
        given = ("--crank", size[0], "--rod", size[1], "--offset", size[2], "--from", ends[0], "--to", ends[1])
        done = command("swing", *given, "--driver", random.choice(["crank", "slider"]), "--json")
        assert done.exit_code in (0, 2)
        if done.exit_code == 0:
            json.loads(done.stdout)


def test_extremes_of_forces_are_undefined_where_friction_locks(command: Command, tmp_path: Path) -> None:
    stuck = 'radius = "300 mm", coefficient = 0.9'
    text = Path("runs/support.toml").read_text(encoding="utf-8")
    job = tmp_path / "stuck.toml"
    job.write_text(f"{text}\n[friction]\ncrank_pivot = {{ {stuck} }}\ncrank_pin = {{ {stuck} }}\n", encoding="utf-8")
    found = numbers_of(command, job, *SIZES)["extremes"]
    assert found["slider_position"]["greatest_mm"] == pytest.approx(3144.679, rel=1e-6)
    for name in ("drive", "crank_pin", "guide"):
        assert {value for key, value in found[name].items() if key != "title"} == {None}
    told = command("swing", job, *SIZES)
    assert told.exit_code == 0
    assert "undefined" in told.stdout
    free = numbers_of(command, "runs/support.toml", *SIZES)["extremes"]["drive"]
    assert (free["least_N"], free["least_way"]) == (pytest.approx(-26630.6, rel=1e-5), "forth")
