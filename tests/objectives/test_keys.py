"""Keys that end with their unit, in both systems."""

from __future__ import annotations

import pytest

from slidercrank.objectives.kinds import column_key_in_system, metric_key

LB, LBF, IN = 0.45359237, 4.4482216152605, 25.4


@pytest.mark.parametrize(
    ("key", "inch", "factor"),
    [
        ("crank_mm", "crank_in", 1.0 / IN),
        ("saving_N_per_kg", "saving_lbf_per_lb", LB / LBF),
        ("stiffness_N_per_m", "stiffness_lbf_per_in", 0.0254 / LBF),
        ("bound_saving_per_um", "bound_saving_per_in", 25400.0),
        ("counterweight_moment_kg_m", "counterweight_moment_lb_in", 1000.0 / IN / LB),
        ("least_pressure_bar", "least_pressure_psi", 1e5 * 0.0254**2 / LBF),
        ("pin_pressure_MPa", "pin_pressure_psi", 1e6 * 0.0254**2 / LBF),
        ("time_ratio", "time_ratio", 1.0),
        ("price_EUR", "price_EUR", 1.0),
        ("mass_percent_per_percent", "mass_percent_per_percent", 1.0),
    ],
)
def test_a_key_has_the_unit_of_the_system_and_its_value_the_factor(key: str, inch: str, factor: float) -> None:
    assert column_key_in_system(key, "metric") == (key, 1.0)
    found, by = column_key_in_system(key, "inch")
    assert found == inch
    assert by == pytest.approx(factor, rel=1e-14)
    if key.endswith(("_mm", "_MPa", "_kg_m")):
        assert metric_key(found) == key
