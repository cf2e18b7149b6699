"""Closed forms of many designs at once are those of the linkage."""

from __future__ import annotations

import numpy as np
import pytest

from slidercrank.model.kinematics.closed_forms import ClosedForm, evaluate_closed_form
from slidercrank.model.linkage.linkage import Linkage
from tests.model.cases import Array, random_designs

DESIGNS = random_designs(5000, seed=91)


def values(form: ClosedForm, designs: Array = DESIGNS) -> Array:
    return evaluate_closed_form(form, designs)[0]


def test_they_are_those_of_the_linkage() -> None:
    linkage = Linkage(*DESIGNS.T)
    # Contracted multiplications and another arcsine: some ulps, amplified near locking.
    np.testing.assert_allclose(values(ClosedForm.TIME_RATIO), linkage.time_ratio, rtol=1e-13)
    np.testing.assert_allclose(values(ClosedForm.TRANSMISSION_ANGLE), linkage.least_transmission_angle, rtol=1e-12)
    np.testing.assert_allclose(values(ClosedForm.STROKE), linkage.stroke, rtol=1e-12)
    np.testing.assert_allclose(values(ClosedForm.ROD_TO_CRANK), DESIGNS[:, 1] / DESIGNS[:, 0], rtol=1e-15)
    np.testing.assert_allclose(values(ClosedForm.ROD_TO_OFFSET), DESIGNS[:, 1] / np.abs(DESIGNS[:, 2]), rtol=1e-15)


def test_rod_to_offset_is_infinite_without_offset() -> None:
    assert values(ClosedForm.ROD_TO_OFFSET, DESIGNS * [1.0, 1.0, 0.0]).tolist() == [np.inf] * len(DESIGNS)


def test_footprint_is_the_rectangle_around_the_pins_over_the_cycle() -> None:
    designs = DESIGNS[:200]
    theta = np.linspace(0.0, 2.0 * np.pi, 2000)
    x = Linkage(*designs.T[..., None]).at(theta).slider_position
    r, e = designs[:, 0], designs[:, 2]
    width = np.maximum(x.max(axis=1), r) + r
    height = np.maximum(r, e) - np.minimum(-r, e)
    forms = np.maximum(values(ClosedForm.FOOTPRINT_OF_CRANK, designs), values(ClosedForm.FOOTPRINT_OF_OFFSET, designs))
    # 2,000 angles miss the outer dead centre by up to 1.6e-3 rad, so the width by 1e-6.
    np.testing.assert_allclose(forms, width * height, rtol=2e-5)


@pytest.mark.parametrize("form", list(ClosedForm), ids=lambda form: form.name)
def test_gradients_are_given_only_when_asked_for(form: ClosedForm) -> None:
    assert evaluate_closed_form(form, DESIGNS)[1] is None
    found, slopes = evaluate_closed_form(form, DESIGNS, gradients=True)
    assert slopes is not None
    assert slopes.shape == (len(DESIGNS), 3)
    # With the gradients the compiler shares other products: an ulp, amplified near locking.
    np.testing.assert_allclose(found, values(form), rtol=1e-13)
