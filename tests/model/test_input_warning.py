"""Lengths of a linkage that were meant in mm: Python warns of them, in the name of the user's line."""

from __future__ import annotations

import random

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputWarning
from slidercrank.model.linkage.variation import vary
from slidercrank.optimise.job import parse_job

DRAW = random.Random(350)
LARGE = {
    "name": "Digger",
    "mechanism": {"speed": "3 rpm", "slider": {"mass": "2 t"}},
    "variables": {"crank": ["11 m", "12 m"], "rod": ["40 m", "60 m"], "offset": ["0.01 mm", "20 m"]},
    "constraints": {"stroke": {"min": "20 m", "max": "30 m"}},
    "objectives": {"peak_torque": "minimise"},
}


@pytest.mark.parametrize("crank", [round(10.0 ** DRAW.uniform(1.1, 3.0), 1) for _ in range(6)])
def test_a_linkage_in_mm_is_warned_of_with_both_readings(crank: float) -> None:
    with pytest.warns(InputWarning) as found:
        linkage = sc.Linkage(crank=crank, rod=3.0 * crank)
    assert [str(one.message) for one in found] == [
        f"lengths of a linkage are in m: crank {crank:g} is {crank:g} m = {1e3 * crank:.6g} mm; write {1e-3 * crank:g} "
        f"for {crank:g} mm"
    ]
    assert found[0].filename == __file__
    assert float(linkage.stroke) == pytest.approx(2.0 * crank)  # it is a warning


def test_the_first_length_beyond_any_machine_is_named_also_among_many() -> None:
    with pytest.warns(InputWarning, match="in m: rod 300 is 300 m = 300000 mm; write 0.3 for 300 mm"):
        sc.Linkage(0.04, [0.1, 300.0, 200.0], 0.02)
    with pytest.warns(InputWarning, match="in m: offset -12 is -12 m = -12000 mm; write -0.012 for -12 mm"):
        sc.Linkage(5.0 + 1e-30j, 10.0, -12.0)


def test_lengths_of_machines_never_warn() -> None:
    for _ in range(200):
        crank = 10.0 ** DRAW.uniform(-4.0, 0.5)
        sc.Linkage(crank, DRAW.uniform(1.1, 3.0) * crank, DRAW.uniform(-0.05, 0.05) * crank)
    sc.Linkage(crank=np.array([1e-4, 3.0]) + 1e-30j, rod=10.0)


def test_lengths_with_units_never_warn_wherever_this_software_makes_linkages_of_them() -> None:
    problem = parse_job(LARGE, require_feasible=False)
    assert problem.analyse([11.5, 50.0, 15.0])["stroke"] > 20.0
    assert "11000 to 12000 mm" in problem._repr_html_()
    with pytest.warns(InputWarning):
        linkage = sc.Linkage(11.5, 50.0)
    assert vary(linkage, [("crank", 12.0)], [0.0]).varied[0].value == 12.0
