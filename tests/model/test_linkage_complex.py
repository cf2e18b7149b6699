"""Complex numbers in a linkage: the imaginary part is the derivative, the real part the number without it."""

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.kernel.arithmetic import STEP
from slidercrank.model.kinematics.closed_forms import ClosedForm, evaluate_closed_form
from slidercrank.model.linkage.inverse_kinematics import crank_from_stroke
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch

Array = NDArray[np.float64]


def designs(count: int = 50) -> Array:
    random = np.random.default_rng(4)
    crank, offset = random.uniform(0.02, 0.2, count), random.uniform(-0.1, 0.1, count)
    return np.stack([crank, (crank + np.abs(offset)) * random.uniform(1.05, 4.0, count), offset], axis=1)


def stepped(some: Array, column: int) -> Linkage:
    moved = some.astype(np.complex128)
    moved[:, column] += 1j * STEP
    return Linkage(moved[:, 0], moved[:, 1], moved[:, 2])


@pytest.mark.parametrize("column", [0, 1, 2])
def test_closed_forms_have_the_derivatives_of_the_compiled_ones(column: int) -> None:
    some = designs()
    linkage, plain = stepped(some, column), Linkage(*some.T)
    for form, name in (
        (ClosedForm.STROKE, "stroke"),
        (ClosedForm.TIME_RATIO, "time_ratio"),
        (ClosedForm.TRANSMISSION_ANGLE, "least_transmission_angle"),
    ):
        _, slopes = evaluate_closed_form(form, some, gradients=True)
        assert slopes is not None
        found = getattr(linkage, name)
        np.testing.assert_allclose(found.imag / STEP, slopes[:, column], rtol=1e-11, atol=1e-13)
        np.testing.assert_allclose(found.real, getattr(plain, name), rtol=1e-14)


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("column", [0, 1, 2])
def test_motion_and_dead_centres_have_the_derivatives_of_differences(column: int, branch: Branch) -> None:
    some, angle, h = designs(), np.linspace(0.0, 6.0, 50), 1e-7
    moved = some.astype(np.complex128)
    moved[:, column] += 1j * STEP
    ahead, behind = some.copy(), some.copy()
    ahead[:, column] += h
    behind[:, column] -= h
    one, more, less = (Linkage(x[:, 0], x[:, 1], x[:, 2], branch) for x in (moved, ahead, behind))
    at, high, low = (linkage.at(angle, speed=3.0, acceleration=2.0) for linkage in (one, more, less))
    for name in ("slider_position", "slider_velocity", "slider_acceleration", "rod_angle", "transmission_angle"):
        slope = (getattr(high, name) - getattr(low, name)) / (2.0 * h)
        slope = np.mod(slope * h + 1.0, 2.0) / h - 1.0 / h if name == "rod_angle" else slope
        np.testing.assert_allclose(getattr(at, name).imag / STEP, slope, rtol=1e-4, atol=1e-4, err_msg=name)
    for centre in (0, 1):
        for name in ("dead_centres", "dead_centre_angles"):
            slope = (getattr(more, name)[centre] - getattr(less, name)[centre]) / (2.0 * h)
            np.testing.assert_allclose(getattr(one, name)[centre].imag / STEP, slope, rtol=1e-5, atol=1e-5)


def test_velocity_is_the_derivative_by_a_stepped_crank_angle() -> None:
    linkage, angle = Linkage(0.04, 0.1, 0.02), np.linspace(0.0, 6.0, 20)
    found = linkage.at(angle + 1j * STEP)
    moving = linkage.at(angle, speed=1.0)
    np.testing.assert_allclose(found.slider_position.imag / STEP, moving.slider_velocity, rtol=1e-13, atol=1e-16)
    np.testing.assert_allclose(found.rod_angle.imag / STEP, moving.rod_velocity, rtol=1e-13, atol=1e-16)


def test_crank_from_stroke_is_inverse_to_the_stroke_in_its_derivative_too() -> None:
    crank = crank_from_stroke(0.08 + 1j * STEP, rod=0.1, offset=0.02)
    back = Linkage(crank, 0.1, 0.02).stroke
    assert complex(back).real == pytest.approx(0.08, rel=1e-14)
    assert complex(back).imag / STEP == pytest.approx(1.0, rel=1e-13)


def test_conditions_look_at_the_real_part() -> None:
    assert np.isrealobj(Linkage(0.04, 0.1, 0.02).stroke)
    assert bool(Linkage(0.04 + 1j, 0.1, 0.02).rotates_fully)
    with pytest.raises(AssemblyError, match=r"rod 100 mm, crank 80 mm, offset 30 mm"):
        Linkage(0.08 + 1e-30j, 0.1, 0.03).require_full_rotation()
    with pytest.raises(InputError, match=r"crank must be above zero; got -0\.04 m"):
        Linkage(-0.04 + 1e-30j, 0.1, 0.03)
    with pytest.raises(InputError, match="finite"):
        Linkage(complex(0.04, np.nan), 0.1, 0.03)
