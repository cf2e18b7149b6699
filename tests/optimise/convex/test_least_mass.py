"""Least mass of crank and rod by the search against the geometric programme, where both have the same limits."""

from __future__ import annotations

from typing import Any

import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.tolerance_costs import SectionLimits
from slidercrank.optimise.sizing.sections import size_sections
from slidercrank.optimise.solve import solve
from tests.optimise.problems import search_little

SIZES: dict[str, Any] = {"crank_pivot": 0.012, "crank_pin": 0.025, "slider_pin": 0.022}
BAR = {"width": "60 mm", "depth": "20 mm", "density": 7850.0}
JOB: dict[str, Any] = {
    "name": "Least mass",
    "mechanism": {"speed": "90 rpm", "crank": BAR, "rod": BAR, "slider": {"mass": "3 kg"}, "gravity": "9.81 m/s^2"},
    "load": [{"force": "20 kN", "opposes": "outward stroke"}],
    "sections": {
        "pins": SIZES,
        "material": {
            "density": 7850.0,
            "elasticity": "207 GPa",
            "yield_strength": "200 MPa",
            "ultimate_strength": "200 MPa",
            "endurance": "200 MPa",
            "bearing_pressure": "60 MPa",
        },
    },
    "variables": {
        "crank": "2 mm",
        "rod": "90 mm",
        "offset": "2 mm",
        "mechanism": {name: {"width": ["10 mm", "60 mm"], "depth": ["3 mm", "40 mm"]} for name in ("crank", "rod")},
    },
    "constraints": {
        "static_safety": {"min": 2.0},
        "buckling_safety": {"min": 3.0},
        "pin_pressure_crank_pivot": {"max": "60 MPa"},
        "pin_pressure_crank_pin": {"max": "60 MPa"},
        "pin_pressure_slider_pin": {"max": "60 MPa"},
    },
    "objectives": {"moving_mass": "minimise"},
    "optimiser": {"designs": 1, "samples": 64},
}


@pytest.mark.slow
@pytest.mark.parametrize("concentration", [1.0, 2.5])
def test_least_mass_of_the_search_is_that_of_the_geometric_programme(
    concentration: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A short stroke and a thin shaft: net sections and bearing pressure decide, and of these both formulas are one."""
    problem = parse_job({**JOB, "sections": {**JOB["sections"], "eye_concentration": concentration}})
    strength = problem.mechanism.strength
    assert strength is not None
    limits = SectionLimits(
        **SIZES, width=(0.01, 0.06), depth=(0.003, 0.04), fatigue_safety=1.0, eye_concentration=concentration
    )
    linkage = Linkage(0.002, 0.09, 0.002)
    convex = size_sections(problem.mechanism.nominal, linkage, strength.material, limits)
    active = {name for name, used in convex.utilisation.items() if used > 1.0 - 1e-6}
    assert len(active) == 4
    assert all(name.partition(": ")[2].startswith(("net section", "bearing")) for name in active)
    search_little(monkeypatch)
    front = solve(problem)
    assert front.status == "done", front.message
    found = problem.quantity("moving_mass").evaluate(problem.mechanism, front.dimensions[:1]).values[0]
    assert found - problem.mechanism.slider_mass == pytest.approx(convex.mass, rel=1e-6)
