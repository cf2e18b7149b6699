"""A machine whose only loads are torques on the crank, through every interface."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputError
from tests.service.conftest import Command

SPEED = 2.0 * math.pi  # 60 rpm
JOB: dict[str, Any] = {
    "name": "crank",
    "mechanism": {"speed": "60 rpm"},
    "load": [{"crank_torque": "-50 N m"}],
    "variables": {"crank": "40 mm", "rod": "150 mm", "offset": "0 mm"},
    "objectives": {"peak_torque": "minimise"},
}
DESIGN = [0.04, 0.15, 0.0]
TABLE = {"torque_angles": ["0 deg", "120 deg", "240 deg"], "torques": ["-20 N m", "-80 N m", "-50 N m"]}


@pytest.mark.parametrize(
    ("load", "peak", "mean", "square"),
    [
        ({"crank_torque": "-50 N m"}, 50.0, 50.0, 2500.0),
        ({"crank_torque": "50 N m"}, 50.0, -50.0, 2500.0),
        ({"crank_resistance": "30 N m"}, 30.0, 30.0, 900.0),
        # Straight lines between a and b have the mean square (a^2 + a b + b^2) / 3.
        (TABLE, 80.0, 50.0, (8400.0 + 12900.0 + 3900.0) / 9.0),
    ],
)
@pytest.mark.filterwarnings("ignore:.*do more work on the machine")  # torques with the rotation too
def test_every_quantity_of_the_drive_has_its_value(
    load: dict[str, Any], peak: float, mean: float, square: float
) -> None:
    wanted = {
        **{"peak_torque": peak, "mean_torque": mean, "rms_torque": math.sqrt(square)},
        **{"peak_torque_outward": peak, "torque_fluctuation": math.sqrt(max(0.0, square - mean**2))},
        **{"peak_power": SPEED * peak, "mean_power": SPEED * mean},
        **{"energy_per_cycle": 2.0 * math.pi * mean, "delivered_work": -2.0 * math.pi * mean},
    }
    for name, value in wanted.items():
        problem = sc.problem({**JOB, "load": [load], "objectives": {name: "minimise"}})
        if load is TABLE and name == "peak_torque_outward":
            value = 65.0  # at 180 deg, where the outward stroke begins
        assert problem.evaluate([DESIGN], [name])[0][0] == pytest.approx(value, rel=1e-12)
        assert problem.analyse(DESIGN)[name] == pytest.approx(value, rel=1e-12)


def test_a_job_finds_the_torque() -> None:
    front = sc.solve(sc.problem(JOB))
    assert front.designs["peak_torque_Nm"].tolist() == [50.0]


def test_the_command_says_it(command: Command, tmp_path: Path) -> None:
    path = tmp_path / "crank.toml"
    path.write_text(
        'name = "crank"\n[mechanism]\nspeed = "60 rpm"\n[[load]]\ncrank_torque = "-50 N m"\n[variables]\n'
        'crank = "40 mm"\nrod = "150 mm"\noffset = "0 mm"\n[objectives]\npeak_torque = "minimise"\n'
    )
    assert command("check", str(path)).exit_code == 0
    done = command("analyse", str(path), "--json", "--show", "motor")
    assert done.exit_code == 0, done.stderr
    row = json.loads(done.stdout)
    assert row["peak_torque_Nm"] == row["motor"]["peak_torque_Nm"] == 50.0
    assert row["torque_fluctuation_Nm"] == 0.0
    refused = command("analyse", str(path), "--show", "flywheel")
    assert refused.exit_code == 2
    assert "sizing a flywheel needs a torque that varies over the cycle" in refused.stderr


def test_a_job_with_neither_mass_nor_load_stays_refused() -> None:
    bare = {key: part for key, part in JOB.items() if key != "load"}
    none: list[dict[str, Any]] = [{"load": []}, {}]
    for load in none:
        with pytest.raises(
            InputError,
            match=r"masses that move or have weight, or loads; got none, or only zeros; .*\[\[load\]\]",
        ):
            sc.problem({**bare, **load})


def test_joints_carry_no_force_of_a_torque_on_the_crank_and_a_refusal_says_so() -> None:
    for name in ("peak_pivot_force", "peak_guide_force"):
        with pytest.raises(
            InputError, match=r"or loads on the slider; got none, or only zeros; .*\[\[load\]\] on the slider"
        ):
            sc.problem({**JOB, "objectives": {name: "minimise"}})
    assert np.all(sc.problem(JOB).evaluate([DESIGN], ["peak_pivot_force"])[0] == 0.0)
