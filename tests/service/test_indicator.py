"""`analyse --show indicator`: numbers, text and figure of the cylinders, and a sentence without one."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.service.figures.panel_figure import panel_in_units
from slidercrank.service.questions.indicator import analysis
from tests.service.conftest import Command

AIR = Compressor(bore=0.07, low=1e5, high=8e5, clearance=0.05, compression_exponent=1.3, expansion_exponent=1.2)
LINKAGE = Linkage(0.03, 0.12, 0.0)


def test_numbers_are_those_of_the_textbook() -> None:
    """In line, z = r (1 - cos(theta)) + l - sqrt(l^2 - r^2 sin^2(theta))."""
    found: Any
    (found,) = analysis.numbers(Mechanism(speed=90.0, loads=(AIR,)), LINKAGE)["cylinders"]
    swept = 1e6 * 0.25 * math.pi * 0.07**2 * 0.06
    assert found["least_volume_cm3"] == pytest.approx(0.05 * swept, rel=1e-9)
    assert found["greatest_volume_cm3"] == pytest.approx(1.05 * swept, rel=1e-9)
    assert (found["least_pressure_bar"], found["greatest_pressure_bar"]) == (pytest.approx(1.0), pytest.approx(8.0))
    shares = 0.05 * (8.0 ** (1.0 / 1.2) - 1.0), 1.05 * 8.0 ** (-1.0 / 1.3) - 0.05
    for name, share in zip(("expansion", "compression"), shares, strict=True):
        theta = math.radians(found[f"{name}_ends_deg"])
        z = 0.03 * (1.0 - math.cos(theta)) + 0.12 - math.sqrt(0.12**2 - (0.03 * math.sin(theta)) ** 2)
        assert z / 0.06 == pytest.approx(share, rel=1e-12)
    assert found["expansion_ends_deg"] < 180.0 < found["compression_ends_deg"]


def test_the_figure_has_a_closed_line_for_each_cylinder() -> None:
    machine = Mechanism(speed=90.0, loads=(AIR, Compressor(**{**vars(AIR), "head": "inner dead centre"})))
    diagram, curve = (panel_in_units(panel, "metric") for panel in analysis.figure(machine, LINKAGE).panels)
    assert [line.label for line in diagram.lines] == [line.label for line in curve.lines] == ["load 1", "load 2"]
    for line in diagram.lines:
        assert (line.x[0], line.y[0]) == (line.x[-1], line.y[-1])
        assert np.ptp(line.y) == pytest.approx(7.0)


def test_a_machine_without_a_cylinder_is_told_what_to_add() -> None:
    with pytest.raises(InputError, match="needs a cylinder; this job has none; for example, add to the job"):
        analysis.numbers(Mechanism(speed=1.0), LINKAGE)


def test_the_command_shows_and_draws_the_shipped_compressor(
    pytestconfig: pytest.Config, command: Command, tmp_path: Path
) -> None:
    line = (
        "analyse",
        str(pytestconfig.rootpath / "runs/compressor.toml"),
        "--crank",
        "30 mm",
        "--rod",
        "120 mm",
        "--offset",
        "0 mm",
    )
    done = command(*line, "--show", "indicator", "--json", "--figures", str(tmp_path))
    found = json.loads(done.stdout)["indicator"]["cylinders"]
    assert [one["load"] for one in found] == [1]
    assert (tmp_path / "indicator.png").stat().st_size > 10_000
    assert "compression ends" in command(*line, "--show", "indicator").stdout
