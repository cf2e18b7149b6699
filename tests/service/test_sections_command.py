"""`slidercrank sections`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job import load_job
from slidercrank.optimise.sizing.sections import size_sections
from tests.service.conftest import Command

pytestmark = pytest.mark.filterwarnings("ignore:in every sampled design the loaded stroke")
JOB = """
name = "Press"
[mechanism]
speed = "120 rpm"
slider = { mass = "3 kg" }
[[load]]
force = "2 kN"
opposes = "outward stroke"
[variables]
crank = "50 mm"
rod = ["100 mm", "400 mm"]
offset = "10 mm"
[objectives]
peak_torque = "minimise"
"""
SECTIONS = """
[sections]
pins = { crank_pivot = "15 mm", crank_pin = "12 mm", slider_pin = "10 mm" }
static_safety = 2.5
[sections.material]
density = "7850 kg/m^3"
elasticity = "207 GPa"
yield_strength = "350 MPa"
ultimate_strength = "520 MPa"
endurance = "150 MPa"
bearing_pressure = "20 MPa"
"""


def written_job_file(folder: Path, text: str) -> Path:
    file = folder / "press.toml"
    file.write_text(text, encoding="utf-8")
    return file


def test_json_is_what_the_function_gives(command: Command, tmp_path: Path) -> None:
    job = written_job_file(tmp_path, JOB + SECTIONS)
    done = command("sections", job, "--rod", "200 mm", "--json")
    assert done.exit_code == 0, done.output
    shown = json.loads(done.stdout)
    problem = load_job(job)
    limits, strength = problem.sections, problem.mechanism.strength
    assert limits is not None
    assert strength is not None
    assert limits.static_safety == 2.5
    assert limits.crank_pin == pytest.approx(0.012)
    found = size_sections(problem.mechanism, Linkage(0.05, 0.2, 0.01), strength.material, limits)
    assert shown["mass_kg"] == pytest.approx(found.mass, rel=1e-9)
    assert shown["rod_width_mm"] == pytest.approx(1e3 * found.rod.width, rel=1e-9)
    assert shown["utilisation"] == pytest.approx(found.utilisation, rel=1e-6)
    assert shown["crank_mass_kg"] + shown["rod_mass_kg"] == pytest.approx(shown["mass_kg"], rel=1e-12)


def test_a_job_that_names_a_catalogue_is_sized_with_the_concentration_of_its_eyes(
    command: Command, tmp_path: Path
) -> None:
    choice = '[[choice]]\nname = "drive"\nfile = "drives.csv"\n'
    (tmp_path / "drives.csv").write_text("name,mechanism.speed (rpm)\nslow,100\nfast,120\n", encoding="utf-8")
    job = written_job_file(
        tmp_path, JOB + choice + SECTIONS.replace("[sections]\n", "[sections]\neye_concentration = 2.5\n", 1)
    )
    limits = load_job(job).sections
    assert limits is not None
    assert limits.eye_concentration == 2.5
    done = command("sections", job, "--rod", "200 mm")
    assert done.exit_code == 0, done.output


def test_the_table_names_what_holds_the_mass(command: Command, tmp_path: Path) -> None:
    done = command("sections", written_job_file(tmp_path, JOB + SECTIONS), "--rod", "200 mm")
    assert done.exit_code == 0, done.output
    assert "mass of both: " in done.stdout
    assert "rod: buckling out of the plane" in done.stdout
    assert "% of mass" in done.stdout


@pytest.mark.parametrize(
    ("text", "arguments", "message"),
    [
        (JOB, ("--rod", "200 mm"), "sizing sections needs the table [sections]; this job has none"),
        (JOB + SECTIONS, (), "--rod is needed"),
        (JOB + SECTIONS.replace("150 MPa", "450 MPa"), ("--rod", "200 mm"), "got 450, 350 and 520 MPa; swap them"),
        (
            JOB + SECTIONS.replace('"350 MPa"', '"350 Pa"'),
            ("--rod", "200 mm"),
            'yield_strength: must be from 1 MPa to 20 GPa; got "350 Pa"; steels have',
        ),
        (
            JOB + SECTIONS.replace('"207 GPa"', "207"),
            ("--rod", "200 mm"),
            "elasticity: must be from 10 MPa to 2 TPa; got 207;",
        ),
        (
            JOB + SECTIONS.replace('"20 MPa"', "20e12"),
            ("--rod", "200 mm"),
            "bearing_pressure: must be from 10 kPa to 5 GPa",
        ),
        (JOB + SECTIONS.replace("2.5", "0.5"), ("--rod", "200 mm"), "static_safety: must be at least 1"),
    ],
)
def test_what_cannot_be_sized_is_refused_in_words(
    command: Command, tmp_path: Path, text: str, arguments: tuple[str, ...], message: str
) -> None:
    done = command("sections", written_job_file(tmp_path, text), *arguments)
    assert done.exit_code == 2
    assert message in " ".join(done.stderr.split())


def test_loads_that_no_section_carries_are_infeasible(command: Command, tmp_path: Path) -> None:
    job = written_job_file(tmp_path, JOB.replace("120 rpm", "60000 rpm") + SECTIONS)
    done = command("sections", job, "--rod", "200 mm", "--json")
    assert done.exit_code == 3
    assert "no section within the ranges carries" in done.stderr
    assert json.loads(done.stdout)["status"] == "infeasible"
