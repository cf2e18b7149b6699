"""`slidercrank analyse`: one design."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.optimise.job import load_job
from slidercrank.service.questions.discovery import TOPIC_COLUMNS
from tests.service import fronts
from tests.service.conftest import Command
from tests.service.test_result import DESIGN_KEYS

JOB_WITH_MOTORS = """
name = "pusher"
[mechanism]
speed = "200 rpm"
slider = {{ mass = "{mass} kg" }}
[variables]
crank = ["40 mm", "60 mm"]
rod = ["150 mm", "300 mm"]
offset = ["0 mm", "20 mm"]
[[choice]]
name = "gearmotor"
file = "motors.csv"
[objectives]
price = "minimise"
transmission_angle = "maximise"
"""
FEEDER = ("--crank", "40 mm", "--rod", "64 mm", "--offset", "20 mm")


def test_without_a_job_motion_and_proportions_are_given(command: Command) -> None:
    done = command("analyse", *FEEDER, "--json")
    assert done.exit_code == 0, done.stderr
    row = json.loads(done.stdout)
    linkage = Linkage(0.04, 0.064, 0.02)
    assert set(DESIGN_KEYS) <= set(row)
    assert row["stroke_mm"] == pytest.approx(1e3 * linkage.stroke, rel=1e-14)
    assert row["time_ratio"] == pytest.approx(linkage.time_ratio, rel=1e-14)
    of_quantities = {of.field: any(not need.is_met(Mechanism()) for need in of.needs) for of in QUANTITIES.values()}
    for key, value in row.items():
        assert (value is None) == of_quantities.get(key, "loaded" in key or "torque" in key), key
    assert "need masses" in done.stderr
    assert "need a crank speed" in done.stderr


def test_what_needs_a_speed_says_that_a_job_has_none(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    job.write_text(job.read_text().replace('speed = "300 rpm"\n', ""))
    done = command("analyse", job, *FEEDER, "--show", "all")
    text = " ".join(done.stdout.split())
    assert "peak slider speed, peak slider acceleration, peak slider jerk" in text
    assert "it needs a crank speed" in text
    assert "peak slider speed 0" not in text
    assert re.search("peak power undefined .*it needs a crank speed", text)
    assert "balance: it needs a crank speed; got none; for example, add [mechanism] speed =" in done.stderr
    assert "speed 0" not in done.stdout + done.stderr
    row = json.loads(command("analyse", job, *FEEDER, "--json").stdout)
    assert row["peak_slider_speed_m_s"] is None


def test_a_speed_gives_slider_speed_and_acceleration(command: Command) -> None:
    row = json.loads(command("analyse", *FEEDER, "--speed", "-2400 rpm", "--json").stdout)
    assert row["peak_slider_speed_m_s"] == pytest.approx(16.989, abs=1e-3)
    assert row["slow_stroke"] == "outward"  # clockwise, the offset positive


def test_lengths_may_be_in_any_unit_and_negative_for_the_offset(command: Command) -> None:
    one = command("analyse", "--crank", "1 inch", "--rod", "0.1 m", "--offset", "-1.5 cm", "--json").stdout
    row = json.loads(one)
    assert (row["crank_mm"], row["rod_mm"], row["offset_mm"]) == (25.4, 100.0, -15.0)
    assert json.loads(command("analyse", "--crank=1 inch", "--rod=0.1 m", "--offset=-15 mm", "--json").stdout) == row


def test_a_job_gives_every_number(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    row = json.loads(command("analyse", job, *FEEDER, "--json").stdout)
    expected = analyse(load_job(job).mechanism, np.array([[0.04, 0.064, 0.02]])).iloc[0]
    assert row["peak_torque_Nm"] == expected["peak_torque_Nm"]
    assert list(row) == [*expected.index, "undefined", "violated", "rules"]


def test_the_speed_overrides_that_of_the_job(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    slow, quick = (
        json.loads(command("analyse", job, *FEEDER, "--speed", speed, "--json").stdout)["peak_torque_Nm"]
        for speed in ("300 rpm", "600 rpm")
    )
    assert quick == pytest.approx(4.0 * slow, rel=1e-12)  # inertia torque grows with the square


def test_a_dimension_that_the_job_fixes_need_not_be_given(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    job.write_text(job.read_text().replace('rod = ["60 mm", "600 mm"]', 'rod = "600 mm"'))
    done = command("analyse", job, "--crank", "40 mm", "--offset", "20 mm", "--json")
    assert json.loads(done.stdout)["rod_mm"] == 600.0
    done = command("analyse", job, "--crank", "40 mm")
    assert done.exit_code == 2
    assert "--offset is needed" in done.stderr


def test_the_table_leaves_out_what_is_not_known(command: Command) -> None:
    output = command("analyse", *FEEDER).stdout
    assert "88.7923" in output
    assert "torque" not in output


def test_figures_are_drawn_with_and_without_a_job(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    for number, arguments in enumerate([(job, *FEEDER), FEEDER]):
        done = command("analyse", *arguments, "--figures", tmp_path / str(number))
        assert done.exit_code == 0, done.stderr
        assert (tmp_path / str(number) / "design.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "--crank is needed"),
        (("--crank", "40 mm"), "--rod is needed"),
        (("--crank", "40", "--rod", "64 mm"), "--crank must be a length with its unit"),
        (("--crank", "-40 mm", "--rod", "64 mm"), "--crank must be positive"),
        (("--crank", "40 mm", "--rod", "64 deg"), "--rod must be a length"),
        (("--crank", "40 mm", "--rod", "nan mm"), "--rod must be a finite number"),
        (("--crank", "40 mm", "--rod", "64 mm", "--speed", "5 m/s"), "--speed must be an angular speed"),
        (("--crank", "50 mm", "--rod", "60 mm", "--offset", "20 mm"), "rod must exceed crank + |offset|"),
        (("none.toml", "--crank", "50 mm"), "no such file"),
        (("latest",), "the job file latest does not exist; correct its name, or add --design N"),
    ],
)
def test_wrong_values_are_exit_code_2(arguments: tuple[str, ...], words: str, command: Command) -> None:
    done = command("analyse", *arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr


def test_what_a_topic_shows_is_left_out_of_the_table_but_not_of_json(command: Command) -> None:
    job = str(Path(__file__).parents[2] / "runs" / "sieve.toml")
    design = ("--crank", "140 mm", "--rod", "310 mm", "--offset", "60 mm")
    shown = command("analyse", job, *design).stdout
    row = json.loads(command("analyse", job, *design, "--json").stdout)
    titles = {quantity.field: quantity.title for quantity in QUANTITIES.values()}
    for key in TOPIC_COLUMNS:
        assert titles[key] not in shown
    for key, value in row.items():
        assert (value is None) == (key in row["undefined"])
    assert "efficiency, friction loss per cycle: " not in shown  # of one rule each
    assert "efficiency: without friction nothing is lost, and the efficiency of every design is 1\n" in shown
    assert "friction loss per cycle: it needs friction in loaded joints\n" in shown
    assert titles["peak_torque_Nm"] in shown
    assert "--show: static_forces, friction, motor" in shown


def test_topics_that_a_design_does_not_have_leave_the_others_and_the_cycle(tmp_path: Path, command: Command) -> None:
    job, cycle = fronts.job_file(tmp_path), tmp_path / "cycle.csv"
    wanted = ("--show", "start_up,balance,clearance", "--cycle", str(cycle))
    done = command("analyse", job, *FEEDER, *wanted, "--json")
    assert done.exit_code == 2
    assert "balance" in json.loads(done.stdout)
    assert not {"start_up", "clearance"} & set(json.loads(done.stdout))
    assert done.stderr.count("start_up: ") == done.stderr.count("clearance: ") == 1
    rows = cycle.read_text(encoding="utf-8").splitlines()[1:]
    assert [row.partition(",")[0] for row in rows] == [f"{angle}.0" for angle in range(360)]


def test_a_quantity_of_the_job_in_an_unusual_unit_has_its_title_and_unit(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    text = job.read_text().replace(
        "[variables]", '[quantity.work]\nformula = "stroke * peak_slider_speed"\n\n[variables]'
    )
    job.write_text(text)
    shown = command("analyse", job, *FEEDER).stdout
    assert "m^2" in next(line for line in shown.splitlines() if line.lstrip().startswith("work"))


def test_the_help_says_when_a_missing_topic_is_an_error(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    named = command("analyse", job, *FEEDER, "--show", "tolerances,friction")
    every = command("analyse", job, *FEEDER, "--show", "all")
    assert "tolerances" in named.stderr
    assert "tolerances" in every.stderr
    assert (named.exit_code, every.exit_code) == (2, 0)
    text = " ".join(command("analyse", "--help").stdout.split())
    assert "the exit code is then 2 if the topic was named, and 0 with `--show all`" in text


@pytest.mark.parametrize(("mass", "fitting"), [(2.0, 3), (12.0, 1), (60.0, 0)])
def test_a_design_of_a_job_with_choices_is_judged_with_each_of_them(
    command: Command, tmp_path: Path, mass: float, fitting: int
) -> None:
    """Limits come with each gearmotor: without one, a design that none can drive would seem to meet the job."""
    limits = (4.0, 7.0, 20.0)
    rows = "\n".join(f"GM {limit:g};{limit};{10.0 * limit}" for limit in limits)
    (tmp_path / "motors.csv").write_text(f"name;peak_torque max (Nm);price (EUR)\n{rows}\n", encoding="utf-8")
    job = tmp_path / "job.toml"
    job.write_text(JOB_WITH_MOTORS.format(mass=mass), encoding="utf-8")
    sized = ("--crank", "50 mm", "--rod", "200 mm", "--offset", "10 mm")
    record = json.loads(command("analyse", job, *sized, "--json").stdout)
    torque = record["peak_torque_Nm"]
    assert sum(torque <= limit for limit in limits) == fitting
    assert [not choice["missed"] for choice in record["choices"]] == [torque <= limit for limit in limits]
    printed = " ".join(command("analyse", job, *sized).stdout.split())
    if fitting:
        fit = ", ".join(f"GM {limit:g}" for limit in limits if torque <= limit)
        assert f"meets every range and requirement of the job with {fitting} of 3 choices: {fit}." in printed
    else:
        assert "No choice in the job meets the requirements; with GM 4: Not met: peak torque (at most 4 N m)" in printed
