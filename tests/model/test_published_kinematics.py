"""Published mechanisms: Norton's table P7-2, a vibrating sieve, a feeder.

Sources that write l sin(phi) = e + r sin(theta) are the mirror image of the convention here: offset = -e.
"""

from __future__ import annotations

import math
from decimal import Decimal

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar
from slidercrank.model.machine.mechanism import Branch
from tests.model.cases import Array

# Exact figures were computed independently in double precision and are given to ten digits.
EXACT = 1e-9


@pytest.mark.parametrize(
    ("branch", "position", "velocity", "rod_velocity", "acceleration", "rod_acceleration"),
    [
        ("open", 9.791823496, -41.460771862, 5.417363389, -709.098870834, -29.025463129),
        ("crossed", -4.595671074, -3.539228139, -5.417363389, -490.035424275, 29.025463129),
    ],
)
def test_norton_row_c(
    branch: Branch,
    position: float,
    velocity: float,
    rod_velocity: float,
    acceleration: float,
    rod_acceleration: float,
) -> None:
    """Boyle and Liu, The Offset Slider Crank: Kinematic Pseudographic Analysis, IJEE 13(3), Norton table P7-2 row c."""
    at = Linkage(3.0, 8.0, 2.0, branch=branch).at(math.radians(-30.0), speed=-15.0, acceleration=-10.0)
    np.testing.assert_allclose(at.slider_position, position, rtol=EXACT)
    np.testing.assert_allclose(at.slider_velocity, velocity, rtol=EXACT)
    np.testing.assert_allclose(at.rod_velocity, rod_velocity, rtol=EXACT)
    np.testing.assert_allclose(at.slider_acceleration, acceleration, rtol=EXACT)
    np.testing.assert_allclose(at.rod_acceleration, rod_acceleration, rtol=EXACT)


def test_norton_row_c_as_printed() -> None:
    at = Linkage(3.0, 8.0, 2.0).at(math.radians(-30.0), speed=-15.0, acceleration=-10.0)
    printed = {
        "slider_position": (9.79, 0.005),
        "slider_velocity": (-41.46, 0.005),
        "rod_velocity": (5.42, 0.005),
        "slider_acceleration": (-709.1, 0.05),
        "rod_acceleration": (-29.03, 0.005),
    }
    for name, (value, rounding) in printed.items():
        assert getattr(at, name) == pytest.approx(value, rel=0.0, abs=rounding), name


STEEL = Bar(width=0.03, depth=0.02, density=7800.0)
SIEVE = Linkage(0.140, 0.310, -0.060)
"""J. Gupta, Offset-Slider Crank Mechanism, course report ME748: a vibrating sieve at 300 rpm."""


@pytest.mark.parametrize(
    ("length", "exact_mass", "printed_mass", "last_digit", "inertias", "printed_inertias"),
    [
        (0.140, 0.765470, 0.764, 0.002, (1770.308, 1740.481, 80.858), (1758.88, 1729.192, 80.607)),
        (0.310, 1.561070, 1.56, 0.01, (14606.560, 14543.583, 167.048), (14559.33, 14496.4, 166.808)),
    ],
    ids=["crank AB", "rod BC"],
)
def test_sieve_links_have_the_published_masses_and_inertias(
    length: float,
    exact_mass: float,
    printed_mass: float,
    last_digit: float,
    inertias: tuple[float, ...],
    printed_inertias: tuple[float, ...],
) -> None:
    # The exact figures have six decimals (mass) and three (inertia). The printed ones come from a faceted solid: the
    # mass is up to two of its last digits low, the inertias 0.1 to 0.7 %.
    assert STEEL.mass(length) == pytest.approx(exact_mass, rel=0.0, abs=5e-7)
    assert STEEL.mass(length) == pytest.approx(printed_mass, rel=0.0, abs=last_digit)
    exact = 1e6 * np.array(STEEL.principal_inertias(length))
    np.testing.assert_allclose(exact, inertias, rtol=0, atol=5e-4)
    low = 1.0 - np.array(printed_inertias) / exact
    assert np.all((low > 0.001) & (low < 0.007))


def newton_raphson(design: tuple[float, float, float], theta: Array) -> tuple[Array, Array]:
    """Solve r e^(i theta) + l e^(i phi) = x + i e for (phi, x). Each angle starts from the one before."""
    r, l, e = design
    found = np.empty((2, len(theta)))
    phi, x = 0.0, r + l
    for n, angle in enumerate(theta):
        for _ in range(60):
            residual = np.array(
                [r * math.cos(angle) + l * math.cos(phi) - x, r * math.sin(angle) + l * math.sin(phi) - e]
            )
            slope = np.array([[-l * math.sin(phi), -1.0], [l * math.cos(phi), 0.0]])
            step = np.linalg.solve(slope, -residual)
            phi, x = phi + step[0], x + step[1]
            if np.abs(step).max() < 1e-16:
                break
        found[:, n] = phi, x
    return found[0], found[1]


def test_sieve_moves_as_newton_raphson_solves_its_loop() -> None:
    theta = np.linspace(0.0, 2.0 * math.pi, 721)
    speed = 300.0 * 2.0 * math.pi / 60.0
    phi, x = newton_raphson((0.140, 0.310, -0.060), theta)
    at = SIEVE.at(theta, speed=speed)
    np.testing.assert_allclose(at.slider_position, x, rtol=1e-14)
    np.testing.assert_allclose(at.rod_angle, phi, rtol=0, atol=1e-14)
    # Rates: the loop differentiated, two linear equations for (phi', x') and once more for (phi'', x'').
    for n in range(0, len(theta), 7):
        slope = np.array([[-0.310 * math.sin(phi[n]), -1.0], [0.310 * math.cos(phi[n]), 0.0]])
        s, c = 0.140 * math.sin(theta[n]), 0.140 * math.cos(theta[n])
        first = np.linalg.solve(slope, [s, -c])
        tilt = 0.310 * first[0] ** 2
        second = np.linalg.solve(slope, [c + tilt * math.cos(phi[n]), s + tilt * math.sin(phi[n])])
        np.testing.assert_allclose([at.rod_velocity[n], at.slider_velocity[n]], speed * first, rtol=0, atol=1e-12)
        np.testing.assert_allclose(
            [at.rod_acceleration[n], at.slider_acceleration[n]], speed**2 * second, rtol=0, atol=1e-9
        )


def test_sieve_cycle_takes_a_fifth_of_a_second_and_its_strokes_share_it_by_the_time_ratio() -> None:
    inner, outer = SIEVE.dead_centre_angles
    speed = 300.0 * 2.0 * math.pi / 60.0
    assert 2.0 * math.pi / speed == pytest.approx(0.2, rel=1e-15)
    outward = ((outer - inner) % (2.0 * math.pi)) / speed
    assert SIEVE.slow_stroke() == "outward"
    assert outward / (0.2 - outward) == pytest.approx(SIEVE.time_ratio, rel=1e-13)


def test_feeder_has_the_exact_proportions() -> None:
    """Obaseki and Alfred, Modeling and Investigating the Effect of Offset Distance on Slider-Crank Mechanism.

    k = 40, c = 3.2 e = 64, e = 20 mm. The paper prints a stroke of 2 k = 80 mm and a time ratio of 1.08; both hold for
    other mechanisms only.
    """
    feeder = Linkage(0.040, 0.064, -0.020)
    inner, outer = feeder.dead_centre_angles
    # sqrt(104^2 - 20^2) - sqrt(24^2 - 20^2) = 88.7923074...
    exact_stroke = float(Decimal(104**2 - 20**2).sqrt() - Decimal(24**2 - 20**2).sqrt())
    assert exact_stroke == pytest.approx(88.792307416, rel=1e-11)
    assert 1e3 * feeder.stroke == pytest.approx(exact_stroke, rel=1e-13)
    # The other figures are known with six decimals, the transmission angle with three.
    excess = abs(math.degrees((inner - outer) % (2.0 * math.pi)) - 180.0)
    assert excess == pytest.approx(45.355201, rel=0.0, abs=5e-7)
    assert feeder.time_ratio == pytest.approx(1.673701, rel=0.0, abs=5e-7)
    assert feeder.time_ratio == pytest.approx((180.0 + excess) / (180.0 - excess), rel=1e-13)
    assert math.degrees(feeder.least_transmission_angle) == pytest.approx(20.364, rel=0.0, abs=5e-4)
    assert math.degrees(feeder.least_transmission_angle) == pytest.approx(
        math.degrees(math.acos(0.060 / 0.064)), rel=1e-13
    )
    half = Linkage(0.040, 0.064, 0.010)
    assert 1e3 * half.stroke == pytest.approx(81.700690, rel=0.0, abs=5e-7)
    assert half.time_ratio == pytest.approx(1.237506, rel=0.0, abs=5e-7)


def test_time_ratio_that_the_feeder_paper_prints_belongs_to_a_rod_of_three_cranks() -> None:
    assert Linkage(0.040, 0.120, 0.020).time_ratio == pytest.approx(1.08, abs=0.005)
    assert Linkage(0.040, 0.128, 0.020).time_ratio == pytest.approx(1.08, abs=0.015)


def test_centred_experiment_has_the_exact_end_accelerations() -> None:
    """The same paper's experiment: 38.1 and 152.4 mm, no offset, 20.994 rad/s; positive inward."""
    ends = Linkage(0.0381, 0.1524).at([math.pi, 0.0], speed=20.994).slider_acceleration
    # r w^2 (1 -+ r / l) for r / l = 1 / 4, printed with the opposite axis.
    np.testing.assert_allclose(ends, [12.594375, -20.990625], rtol=3e-8)
