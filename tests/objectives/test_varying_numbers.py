"""Numbers of the machine that vary from design to design: values as of the machine alone, exact gradients."""

from __future__ import annotations

import numpy as np
import pytest

from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.closed_form import ClosedFormQuantity
from slidercrank.objectives.cycle_peak import CyclePeak, screen_peaks
from slidercrank.objectives.flow import GasQuantity
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.all_quantities import analyse
from tests.model.varying_machines import BARS, BODIES, RUBBED, VARIED, unit_steps, varied_designs
from tests.objectives.richardson import derivatives
from tests.objectives.test_gradients import greatest_piece, same_piece

# As in test_gradients: the extrapolation's own accuracy. Relative to the change that a fifth of the number's range
# makes, or to a thousandth of the quantity where that is more: a smaller influence drowns in rounding of the value.
CLOSE = 1e-7
# What a closed form gives depends on no number of the machine. Friction changes what follows from joint forces.
# What cylinders give has a test of its own, with every number of a cylinder; so have crankshafts.
FOLLOWING = [
    name
    for name, quantity in QUANTITIES.items()
    if not isinstance(quantity, ClosedFormQuantity | GasQuantity) and not quantity.unmet_need(BARS, "undefined")
]
OF_BODIES = (
    *("peak_torque", "rms_torque", "mean_power", "peak_guide_force", "position_error_rss"),
    *("peak_reflected_inertia", "peak_shaking_force", "rms_shaking_moment"),
)
OF_RUBBED = ("peak_torque", "mean_power", "peak_pivot_force", "peak_slider_pin_force", "self_locking_margin")
CASES = [
    pytest.param(name, machine, id=f"{name}-{kind}")
    for kind, machine, names in (
        ("bars", BARS, FOLLOWING),
        ("bodies", BODIES, OF_BODIES),
        ("rubbed", RUBBED, OF_RUBBED),
    )
    for name in names
]


@pytest.mark.parametrize(("name", "machine"), CASES)
def test_gradient_by_every_varying_number_is_that_of_extrapolated_differences(name: str, machine: Mechanism) -> None:
    quantity = QUANTITIES[name]
    designs = varied_designs(machine, 2, seed=21)
    steps = unit_steps(machine, designs)
    function, _ = same_piece(quantity, machine, designs, greatest_piece(quantity, machine, designs))
    expected, _ = derivatives(function, designs, 0.25 * steps)
    found = quantity.evaluate(machine, designs, gradients=True)
    assert found.gradients is not None
    assert found.gradients.shape == designs.shape
    size = np.maximum(np.abs(expected * steps), 1e-3 * np.abs(found.values)[:, None])
    size = np.maximum(size, np.finfo(np.float64).tiny)  # no friction, no loss
    assert np.max(np.abs((found.gradients - expected) * steps) / size) < CLOSE


@pytest.mark.parametrize("machine", VARIED.values(), ids=VARIED)
def test_a_varied_design_has_the_values_of_the_machine_with_these_numbers(machine: Mechanism) -> None:
    designs = varied_designs(machine, 4, seed=22)
    for quantity in QUANTITIES.values():
        found = quantity.evaluate(machine, designs).values
        alone = [
            quantity.evaluate(machine.with_values(design[3:].tolist()), design[None, :3]).values[0].item()
            for design in designs
        ]
        # Masses and speeds come out of the same products in another order: some roundings of difference.
        np.testing.assert_allclose(found, alone, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("machine", [BARS, BODIES], ids=["bars", "bodies"])
def test_screening_agrees_with_the_exact_peaks_where_numbers_vary(machine: Mechanism) -> None:
    designs = varied_designs(machine, 64, seed=23)
    peaks = [q for q in QUANTITIES.values() if isinstance(q, CyclePeak) and q.name in ("peak_torque", "position_error")]
    for peak, screened in zip(peaks, screen_peaks(peaks, machine, designs, gradients=True), strict=True):
        exact = peak.evaluate(machine, designs, gradients=True)
        assert screened.gradients is not None
        assert exact.gradients is not None
        np.testing.assert_allclose(screened.values, exact.values, rtol=1e-9)
        np.testing.assert_allclose(screened.gradients, exact.gradients, rtol=1e-6, atol=1e-9 * exact.values.max())


def test_every_varied_number_matters_to_some_quantity() -> None:
    """So that no gradient above is compared with zero alone."""
    for machine in (BARS, BODIES, RUBBED):
        designs = varied_designs(machine, 2, seed=24)
        moved = np.zeros(designs.shape[1], dtype=bool)
        for quantity in QUANTITIES.values():
            slopes = quantity.evaluate(machine, designs, gradients=True).gradients
            assert slopes is not None
            moved |= np.isfinite(slopes).all(axis=0) & (np.abs(slopes) > 0.0).all(axis=0)
        assert moved.all(), [item.name for item, n in zip(machine.varying, moved[3:], strict=True) if not n]


def test_the_table_of_designs_names_varying_numbers_with_their_units() -> None:
    designs = varied_designs(BARS, 2, seed=25)
    table = analyse(BARS, designs)
    assert list(table.columns[:6]) == [
        "crank_mm",
        "rod_mm",
        "offset_mm",
        "speed_rpm",
        "acceleration_rad_s2",
        "slider_mass_kg",
    ]
    assert table["crank_width_mm"].tolist() == pytest.approx(1e3 * designs[:, 6])
    assert table["speed_rpm"].tolist() == pytest.approx(designs[:, 3] * 30.0 / np.pi)
