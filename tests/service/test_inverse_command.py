"""`slidercrank inverse`: crank angles, speeds and accelerations for a slider motion."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job import load_job
from slidercrank.service.designs.stored_designs import stored_design
from slidercrank.service.runs.runs_on_disk import problem_of, read_run
from tests.model.cases import random_designs
from tests.service import fronts
from tests.service.conftest import Command

LINKAGE = Linkage(0.06, 0.23, 0.07)
SIZES = ("--crank", "60 mm", "--rod", "230 mm", "--offset", "70 mm")
HERE = ("--slider-position", "240 mm")
MOVING = ("--slider-velocity", "-1 m/s", "--slider-acceleration", "3 m/s^2")
OUTER = f"{1e3 * float(LINKAGE.dead_centres[1])!r} mm"


def numbers_of(command: Command, *arguments: object) -> dict[str, Any]:
    done = command("inverse", *arguments, "--json")
    assert done.exit_code == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def test_help_names_the_command(command: Command) -> None:
    assert "  inverse " in command("--help").stdout
    assert command("inverse", "--help").exit_code == 0


def test_json_has_the_numbers_of_python(command: Command) -> None:
    found = numbers_of(command, *SIZES, *HERE, *MOVING)
    assert (found["crank_mm"], found["rod_mm"], found["offset_mm"]) == (60.0, 230.0, 70.0)
    assert (found["branch"], found["note"]) == ("open", "")
    given = ("slider_position_mm", "slider_velocity_m_s", "slider_acceleration_m_s2")
    assert [found[key] for key in given] == [240.0, -1.0, 3.0]
    expected = LINKAGE.from_slider(0.24, velocity=-1.0, acceleration=3.0)
    assert len(expected) == len(found["solutions"]) == 2
    for solution, one in zip(found["solutions"], expected, strict=True):
        assert one.speed is not None
        assert solution == {
            "crank_angle_deg": pytest.approx(math.degrees(one.crank_angle), rel=1e-14),
            "stroke": one.stroke,
            "crank_speed_rpm": pytest.approx(one.speed * 30.0 / math.pi, rel=1e-14),
            "crank_acceleration_rad_s2": one.acceleration,
        }


def test_random_solutions_give_the_slider_motion_back(command: Command) -> None:
    random = np.random.default_rng(41)
    for crank, rod, offset in random_designs(15, seed=42, least_margin=0.05).tolist():
        linkage = Linkage(crank, rod, offset)
        inner, outer = linkage.dead_centres
        position = float(inner + random.uniform(0.05, 0.95) * (outer - inner))
        velocity, acceleration = random.uniform(-5.0, 5.0), random.uniform(-90.0, 90.0)
        sizes = (f"--crank={crank!r} m", f"--rod={rod!r} m", f"--offset={offset!r} m")
        motion = (f"--slider-velocity={velocity!r} m/s", f"--slider-acceleration={acceleration!r} m/s^2")
        found = numbers_of(command, *sizes, f"--slider-position={position!r} m", *motion)
        assert [solution["stroke"] for solution in found["solutions"]] == ["outward", "inward"]
        for solution in found["solutions"]:
            speed, change = solution["crank_speed_rpm"] * math.pi / 30.0, solution["crank_acceleration_rad_s2"]
            at = linkage.at(math.radians(solution["crank_angle_deg"]), speed=speed, acceleration=change)
            assert at.slider_position == pytest.approx(position, rel=1e-9)
            assert at.slider_velocity == pytest.approx(velocity, rel=1e-9)
            size = crank * (speed**2 + abs(change))
            assert at.slider_acceleration == pytest.approx(acceleration, rel=1e-9, abs=1e-9 * size)


def test_the_table_shows_what_was_asked_for(command: Command) -> None:
    shown = command("inverse", *SIZES, *HERE, *MOVING).stdout
    for words in ("position 240 mm, velocity -1 m/s, acceleration 3 m/s²", "outward", "inward"):
        assert words in shown
    for number in ("312.364", "-141.481", "128.718", "80.1563", "162.872", "-118.235"):
        assert number in shown
    alone = command("inverse", *SIZES, *HERE).stdout
    assert "312.364" in alone
    assert "rpm" not in alone
    assert "rad/s^2" not in alone


def test_what_is_not_asked_for_is_null(command: Command) -> None:
    for solution in numbers_of(command, *SIZES, *HERE)["solutions"]:
        assert (solution["crank_speed_rpm"], solution["crank_acceleration_rad_s2"]) == (None, None)


def test_a_dead_centre_has_no_crank_speed_and_says_why(command: Command) -> None:
    arguments = (*SIZES, "--slider-position", OUTER, "--slider-velocity", "0 m/s")
    found = numbers_of(command, *arguments)
    (solution,) = found["solutions"]
    angle = math.degrees(float(LINKAGE.dead_centre_angles[1]))
    assert solution.pop("crank_angle_deg") == pytest.approx(angle, rel=1e-9)
    assert solution == {"stroke": None, "crank_speed_rpm": None, "crank_acceleration_rad_s2": None}
    assert "the slider is at rest at any crank speed" in found["note"]
    done = command("inverse", *arguments)
    assert "dead centre" in done.stdout
    assert "undefined" in done.stdout
    assert done.stderr == f"{found['note']}\n"


def test_inches_are_given_and_shown(command: Command) -> None:
    sizes = ("--crank", "2 inch", "--rod", "8 inch", "--offset", "1 inch")
    motion = ("--slider-position", "7 inch", "--slider-velocity", "10 inch/s", "--slider-acceleration", "0 inch/s^2")
    inch, metric = (numbers_of(command, *sizes, *motion, "--units", units) for units in ("inch", "metric"))
    assert inch["solutions"] == metric["solutions"]
    for name, value in (("crank", 2.0), ("rod", 8.0), ("offset", 1.0), ("slider_position", 7.0)):
        assert inch[f"{name}_in"] == pytest.approx(value, rel=1e-14)
        assert metric[f"{name}_mm"] == pytest.approx(25.4 * value, rel=1e-14)
    assert inch["slider_velocity_in_s"] == pytest.approx(10.0, rel=1e-14)
    assert inch["slider_acceleration_in_s2"] == 0.0
    assert not any(key.endswith(("_mm", "_m_s", "_m_s2")) for key in inch)
    shown = command("inverse", *sizes, *motion, "--units", "inch").stdout
    assert "position 7 in, velocity 10 in/s, acceleration 0 in/s²" in shown


def test_a_job_gives_fixed_dimensions_and_the_branch(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    text = job.read_text().replace('rod = ["60 mm", "600 mm"]', 'rod = "230 mm"')
    job.write_text(text.replace("[mechanism]\n", '[mechanism]\nbranch = "crossed"\n'))
    assert load_job(job).mechanism.branch == "crossed"
    arguments = (job, "--crank", "60 mm", "--offset", "70 mm")
    found = numbers_of(command, *arguments, "--slider-position", "-240 mm")
    assert (found["rod_mm"], found["branch"]) == (230.0, "crossed")
    expected = Linkage(0.06, 0.23, 0.07, "crossed").from_slider(-0.24)
    angles = [math.degrees(one.crank_angle) for one in expected]
    assert [solution["crank_angle_deg"] for solution in found["solutions"]] == pytest.approx(angles, rel=1e-12)
    done = command("inverse", *arguments, *HERE)
    assert done.exit_code == 2
    assert "in reach of the crossed branch, -281.424945 mm to -154.919334 mm; got 240 mm" in done.stderr
    assert "--offset is needed" in command("inverse", job, "--crank", "60 mm", *HERE).stderr


def test_a_design_of_a_run_has_its_own_dimensions(kept: Path, command: Command) -> None:
    (folder,) = (file.parent for file in kept.glob("*/front.json"))
    result = read_run(folder)
    linkage = stored_design(problem_of(folder, result), result, 2).linkage
    position = float(linkage.dead_centres[0] + 0.4 * linkage.stroke)
    where = ("--slider-position", f"{position!r} m")
    found = numbers_of(command, "latest", "--runs", kept, "--design", 2, *where)
    assert found["crank_mm"] == pytest.approx(1e3 * float(linkage.crank), rel=1e-14)
    angles = [math.degrees(one.crank_angle) for one in linkage.from_slider(position)]
    assert [solution["crank_angle_deg"] for solution in found["solutions"]] == pytest.approx(angles, rel=1e-12)
    done = command("inverse", "latest", "--runs", kept, "--design", 2, *where, "--crank", "60 mm")
    assert (done.exit_code, done.stdout) == (2, "")
    assert "got --design and --crank; leave out one of the two" in done.stderr
    done = command("inverse", "latest", "--runs", kept, "--design", 999, *where)
    assert (done.exit_code, done.stdout) == (2, "")
    assert "got 999" in done.stderr


def test_a_linkage_that_does_not_turn_fully_has_solutions(command: Command) -> None:
    sizes = ("--crank", "100 mm", "--rod", "80 mm", "--offset", "50 mm")
    (solution,) = numbers_of(command, *sizes, "--slider-position", "50 mm")["solutions"]
    assert solution["stroke"] == "inward"
    at = Linkage(0.10, 0.08, 0.05).at(math.radians(solution["crank_angle_deg"]))
    assert at.slider_position == pytest.approx(0.05, rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((*SIZES, "--slider-position", "300 mm"), "154.919334 mm to 281.424945 mm; got 300 mm with crank 60 mm"),
        ((*SIZES, "--slider-position", "240"), "--slider-position must be a length with its unit"),
        ((*SIZES, "--slider-position", "240 kg"), "--slider-position must be a length"),
        ((*SIZES, "--slider-position", "nan mm"), "--slider-position must be a finite number"),
        ((*SIZES, "--slider-position", "inf mm"), "--slider-position must be a finite number"),
        ((*SIZES, *HERE, "--slider-velocity", "3 rpm"), "--slider-velocity must be a speed"),
        ((*SIZES, *HERE, "--slider-velocity", "0"), "--slider-velocity must be a speed with its unit"),
        ((*SIZES, *HERE, "--slider-velocity", "-inf m/s"), "--slider-velocity must be a finite number"),
        ((*SIZES, *HERE, *MOVING[:2], "--slider-acceleration", "1 m/s"), "--slider-acceleration must be"),
        ((*SIZES, *HERE, *MOVING[2:]), "got acceleration 3 m/s^2 alone; add the velocity"),
        ((*SIZES, "--slider-position", OUTER, *MOVING[:2]), "the slider velocity must be 0 at the dead centre"),
        (HERE, "--crank is needed"),
        (("--crank", "nan mm", *SIZES[2:], *HERE), "--crank must be a finite number"),
        (("--crank", "50 mm", "--rod", "50 mm", "--slider-position", "0 mm"), "leaves the crank angle undetermined"),
        (("--crank", "50 mm", "--rod", "60 mm", "--offset", "200 mm", *HERE), "or the linkage cannot close"),
        (("none.toml", *SIZES, *HERE), "no such file"),
        (("latest", *SIZES, *HERE), "the job file latest does not exist; correct its name, or add --design N"),
        ((*HERE, "--design", "3"), "name it: slidercrank inverse RUN --design NO"),
    ],
)
def test_wrong_values_are_one_sentence_and_exit_code_2(
    arguments: tuple[str, ...], words: str, command: Command
) -> None:
    done = command("inverse", *arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
    assert done.stderr.startswith("slidercrank: ")
    assert done.stderr.count("\n") == 1
