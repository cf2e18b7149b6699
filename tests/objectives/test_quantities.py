"""The contract of every quantity: shapes, units, pieces, and what it says about simple changes of the design."""

from __future__ import annotations

import dataclasses
import math
import re

import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.drive_train import MotorSpeed
from slidercrank.objectives.quantity import Quantity
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.units import to_si
from tests.model.cases import MACHINES, SMOOTH, TABLES, TOLERANCES, Array, fitted, random_designs

pytestmark = pytest.mark.usefixtures("shared_batches")
DESIGNS = random_designs(200, seed=12)
CASES = [
    pytest.param(quantity, fitted(quantity, machine), id=f"{quantity.name}-{name}")
    for quantity in QUANTITIES.values()
    for name, machine in MACHINES.items()
]


def values(name: str, designs: Array, machine: Mechanism = SMOOTH) -> Array:
    return QUANTITIES[name].evaluate(machine, designs).values


@pytest.mark.parametrize("quantity", QUANTITIES.values(), ids=QUANTITIES)
def test_name_field_and_unit_belong_together(quantity: Quantity) -> None:
    assert QUANTITIES[quantity.name] is quantity
    assert quantity.title
    symbol, suffix = quantity.unit.symbol, quantity.field.removeprefix("least_").removeprefix(quantity.name)
    assert suffix.replace("_", "") == re.sub("[^A-Za-z0-9]", "", symbol)
    assert quantity.unit.factor * to_si(f"1 {symbol}", quantity.kind) == pytest.approx(1.0, rel=1e-15)


def test_fields_are_unique() -> None:
    assert len({quantity.field for quantity in QUANTITIES.values()}) == len(QUANTITIES)


@pytest.mark.parametrize(("quantity", "machine"), CASES)
def test_values_and_gradients_have_the_shape_of_the_batch(quantity: Quantity, machine: Mechanism) -> None:
    plain = quantity.evaluate(machine, DESIGNS)
    full = quantity.evaluate(machine, DESIGNS, gradients=True)
    assert plain.values.shape == full.values.shape == (200,)
    assert plain.values.dtype == np.float64
    assert plain.gradients is None
    assert full.gradients is not None
    assert full.gradients.shape == (200, 3)
    assert np.all(np.isfinite(full.values))
    assert np.all(np.isfinite(full.gradients))
    # Closed forms share other products when gradients are wanted too: an ulp, amplified near locking.
    np.testing.assert_allclose(full.values, plain.values, rtol=1e-13)
    assert np.any(full.gradients != 0.0) or isinstance(quantity, MotorSpeed)  # which no length changes


@pytest.mark.parametrize(("quantity", "machine"), CASES)
def test_quantity_is_the_greatest_of_its_pieces(quantity: Quantity, machine: Mechanism) -> None:
    pieces = quantity.pieces(machine, DESIGNS)
    k = pieces.values.shape[1]
    assert pieces.values.shape == pieces.labels.shape == (200, k)
    assert pieces.gradients.shape == (200, k, 3)
    exact = quantity.evaluate(machine, DESIGNS, gradients=True)
    sign = -1.0 if pieces.least else 1.0  # the least of its pieces is the greatest of the negative ones
    np.testing.assert_allclose((sign * pieces.values).max(axis=1), sign * exact.values, rtol=1e-13)
    greatest = np.argmax(sign * pieces.values, axis=1)
    assert exact.gradients is not None
    np.testing.assert_array_equal(pieces.gradients[np.arange(200), greatest], exact.gradients)
    there = np.isfinite(pieces.values)
    assert np.all(sign * pieces.values[~there] == -np.inf)
    assert np.all(np.isfinite(pieces.gradients))
    assert np.all(np.isfinite(pieces.labels[there]))


@pytest.mark.parametrize(("quantity", "machine"), CASES)
def test_a_design_is_judged_alike_alone_and_in_a_batch(quantity: Quantity, machine: Mechanism) -> None:
    together = quantity.evaluate(machine, DESIGNS[:41], gradients=True)  # no multiple of what a processor does at once
    assert together.gradients is not None
    for n in (0, 7, 40):
        alone = quantity.evaluate(machine, DESIGNS[n : n + 1], gradients=True)
        assert alone.gradients is not None
        assert alone.values[0] == together.values[n]
        np.testing.assert_array_equal(alone.gradients[0], together.gradients[n])


@pytest.mark.parametrize("quantity", QUANTITIES.values(), ids=QUANTITIES)
def test_no_designs_have_no_values(quantity: Quantity) -> None:
    empty = quantity.evaluate(SMOOTH, np.empty((0, 3)), gradients=True)
    assert empty.values.shape == (0,)
    assert empty.gradients is not None
    assert empty.gradients.shape == (0, 3)
    assert quantity.pieces(SMOOTH, np.empty((0, 3))).values.shape[0] == 0


@pytest.mark.parametrize("quantity", QUANTITIES.values(), ids=QUANTITIES)
def test_only_a_signed_quantity_may_be_negative(quantity: Quantity) -> None:
    if not quantity.signed:
        for machine in MACHINES.values():
            assert np.all(quantity.evaluate(fitted(quantity, machine), DESIGNS).values >= 0.0)


@pytest.mark.parametrize("quantity", QUANTITIES.values(), ids=QUANTITIES)
def test_picture_is_one_that_the_page_draws(quantity: Quantity, pytestconfig: pytest.Config) -> None:
    script = pytestconfig.rootpath / "service" / "page" / "static" / "help" / "picture.js"
    drawn = script.read_text(encoding="utf-8").split("const PICTURES = {")[1]
    assert quantity.picture in re.findall(r'^  "?([a-z -]+)"?: \{', drawn, flags=re.MULTILINE)


def test_peak_rms_and_mean_torque_are_in_order() -> None:
    for machine in MACHINES.values():
        peak, rms, mean = (values(name, DESIGNS, machine) for name in ("peak_torque", "rms_torque", "mean_torque"))
        assert np.all(peak > rms)
        assert np.all(rms > np.abs(mean))


def test_peak_torque_is_that_of_the_worse_stroke() -> None:
    outward, inward = values("peak_torque_outward", DESIGNS, TABLES), values("peak_torque_inward", DESIGNS, TABLES)
    np.testing.assert_allclose(np.maximum(outward, inward), values("peak_torque", DESIGNS, TABLES), rtol=1e-13)


def test_time_ratio_is_at_least_one_and_grows_with_the_offset() -> None:
    assert np.all(values("time_ratio", DESIGNS) >= 1.0)
    found = QUANTITIES["time_ratio"].evaluate(SMOOTH, DESIGNS, gradients=True).gradients
    assert found is not None
    assert np.all(found[:, 2] * DESIGNS[:, 2] > 0.0)


def test_transmission_angle_grows_with_the_rod_and_falls_with_crank_and_offset() -> None:
    found = QUANTITIES["transmission_angle"].evaluate(SMOOTH, DESIGNS, gradients=True).gradients
    assert found is not None
    assert np.all(found[:, 0] < 0.0)
    assert np.all(found[:, 1] > 0.0)
    assert np.all(found[:, 2] * DESIGNS[:, 2] < 0.0)
    assert np.all(values("transmission_angle", DESIGNS) < 0.5 * math.pi)


def test_position_error_is_at_least_the_rod_tolerance() -> None:
    # The rod's influence is 1 / cos(phi), never below one.
    rod = TOLERANCES.rod.absolute + TOLERANCES.rod.fraction * DESIGNS[:, 1]
    assert np.all(values("position_error_rss", DESIGNS) > rod)
    assert np.all(values("position_error", DESIGNS) > values("position_error_rss", DESIGNS))


@pytest.mark.parametrize(
    ("name", "power"),
    [
        ("time_ratio", 0),
        ("transmission_angle", 0),
        ("rod_to_offset", 0),
        ("rod_to_crank", 0),
        ("stroke", 1),
        ("peak_slider_speed", 1),
        ("peak_slider_acceleration", 1),
        ("peak_guide_force", 1),
        ("peak_pivot_force", 1),
        ("footprint", 2),
        ("peak_torque", 2),
        ("rms_torque", 2),
        ("peak_power", 2),
        ("self_locking_margin", 0),
        ("peak_reflected_inertia", 2),
        ("peak_shaking_force", 1),
        ("rms_shaking_force", 1),
        ("peak_shaking_moment", 2),
        ("rms_shaking_moment", 2),
    ],
)
def test_quantity_scales_with_a_power_of_the_size(name: str, power: int) -> None:
    # Inertia loads of masses that stay: forces grow with the size, torques with its square.
    machine = Mechanism(speed=20.0, acceleration=9.0, slider_mass=2.0, rod=RigidLink(mass=1.0))
    ratio = values(name, 2.0 * DESIGNS, machine) / values(name, DESIGNS, machine)
    np.testing.assert_allclose(ratio, 2.0**power, rtol=1e-12)


@pytest.mark.parametrize("name", QUANTITIES)
def test_mirrored_machine_is_judged_alike(name: str) -> None:
    """Mirrored about the slider line: offset, rotation, gravity along y, mass centres across and phases change sign."""
    machine = fitted(QUANTITIES[name], SMOOTH)
    rod = machine.rod
    mirrored = dataclasses.replace(
        machine,
        speed=-SMOOTH.speed,
        acceleration=-machine.acceleration,
        gravity=(SMOOTH.gravity[0], -SMOOTH.gravity[1]),
        rod=dataclasses.replace(rod, centre_across=0.02) if isinstance(rod, RigidLink) else rod,
        counterweight=dataclasses.replace(SMOOTH.counterweight, angle=-SMOOTH.counterweight.angle),
    )
    if (shaft := machine.arrangement) is not None:
        shaft = dataclasses.replace(shaft, phases=tuple(-phase for phase in shaft.phases))
        mirrored = dataclasses.replace(mirrored, arrangement=shaft)
    original, image = values(name, DESIGNS, machine), values(name, DESIGNS * [1.0, 1.0, -1.0], mirrored)
    # The mirrored torque is the negative one.
    sign = -1.0 if name == "mean_torque" else 1.0
    scale = {"mean_torque": values("peak_torque", DESIGNS), "mean_power": values("peak_power", DESIGNS)}.get(
        name, original
    )
    np.testing.assert_allclose(sign * image / scale, original / scale, rtol=0, atol=1e-11)
