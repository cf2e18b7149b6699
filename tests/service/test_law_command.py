"""`slidercrank law`: what its answer says of constant speed, and of laws without torque."""

from __future__ import annotations

import contextlib
import json
import math
import re
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.objectives.registry import quantity
from tests.service.conftest import Command

LENGTHS = ("--crank", "40 mm", "--rod", "100 mm", "--offset", "20 mm")
IDLE = """
name = "Idle"
[mechanism]
speed = "60 rpm"
crank = { mass = "3 kg" }
rod = { mass = "2 kg" }
slider = { mass = "5 kg" }
[variables]
crank = "50 mm"
rod = "140 mm"
offset = "15 mm"
[objectives]
peak_torque = "minimise"
"""
SPEEDS = ("--least-speed", "1920 rpm", "--greatest-speed", "2880 rpm")


@pytest.mark.parametrize(
    "asked",
    [("--objective", "cycle time", "--torque-limit", "80 N m"), ("--cycle-time", "40 ms", "--timing", "at most")],
)
def test_a_law_is_compared_with_constant_speed_at_its_own_cycle_time(
    asked: tuple[str, ...], command: Command, pytestconfig: pytest.Config
) -> None:
    feeder = pytestconfig.rootpath / "runs/feeder.toml"
    answer = json.loads(command("law", feeder, *LENGTHS, *SPEEDS, *asked, "--json").stdout)
    machine = sc.load_job(feeder).mechanism
    machine = replace(machine, speed=machine.direction * 2.0 * math.pi / answer["cycle_time_s"])
    for name in ("peak_torque", "rms_torque"):
        value = quantity(name).evaluate(machine, np.array([[0.04, 0.1, 0.02]])).values[0]
        assert answer[f"{name}_at_constant_speed_Nm"] == pytest.approx(value, rel=1e-9)


def test_a_law_that_needs_no_torque_says_zero(command: Command, tmp_path: Path) -> None:
    job = tmp_path / "idle.toml"
    job.write_text(IDLE)
    answer = json.loads(command("law", job, "--json").stdout)
    assert (answer["peak_torque_Nm"], answer["rms_torque_Nm"], answer["gap"]) == (0.0, 0.0, 0.0)
    assert answer["peak_torque_at_constant_speed_Nm"] > 0.1
    assert "Proven: no law within these limits is better." in command("law", job).stdout


def test_the_guide_prints_what_the_command_prints(
    command: Command, pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    guide = (pytestconfig.rootpath / "docs/servo.md").read_text(encoding="utf-8")
    typed, printed = (re.findall(rf"^```{kind}\n(.*?)^```$", guide, re.M | re.S)[0] for kind in ("sh", "text"))
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs/feeder.toml").write_bytes((pytestconfig.rootpath / "runs/feeder.toml").read_bytes())
    with contextlib.chdir(tmp_path):
        done = command(*shlex.split(typed.replace("\\\n", " "))[1:])
    number = re.compile(r"(?<![\w.])\d+(?:\.\d+)?")
    answered = {number.sub("#", " ".join(line.split())): number.findall(line) for line in done.stdout.splitlines()}
    for line in printed.splitlines():
        if line.strip() != "...":
            shown, found = number.findall(line), answered[number.sub("#", " ".join(line.split()))]
            for one, other in zip(shown, found, strict=True):
                # Where the peak is reached, it is reached at many angles; the gap depends on the solver's last steps.
                if f"{one} deg" not in line and "Proven" not in line:
                    assert float(one) == pytest.approx(float(other), rel=2e-3), line
    assert {"cam.csv", "law.png"} <= {file.name for file in tmp_path.iterdir()}
