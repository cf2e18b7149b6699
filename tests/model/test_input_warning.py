"""Lengths of a linkage that were meant in mm: Python warns of them, in the name of the user's line."""

from __future__ import annotations

import random

import pytest

import slidercrank as sc
from slidercrank.optimise.job import parse_job

DRAW = random.Random(350)
LARGE = {
    "name": "Digger",
    "mechanism": {"speed": "3 rpm", "slider": {"mass": "2 t"}},
    "variables": {"crank": ["11 m", "12 m"], "rod": ["40 m", "60 m"], "offset": ["0.01 mm", "20 m"]},
    "constraints": {"stroke": {"min": "20 m", "max": "30 m"}},
    "objectives": {"peak_torque": "minimise"},
}


def test_a_linkage_by_itself_has_no_scale() -> None:
    assert float(sc.Linkage(3.0, 8.0, 2.0).stroke) == pytest.approx(1e-3 * float(sc.Linkage(3e3, 8e3, 2e3).stroke))


def test_lengths_with_units_never_warn_wherever_this_software_makes_linkages_of_them() -> None:
    problem = parse_job(LARGE, require_feasible=False)
    assert problem.analyse([11.5, 50.0, 15.0])["stroke"] > 20.0
    assert "11000 to 12000 mm" in problem._repr_html_()
