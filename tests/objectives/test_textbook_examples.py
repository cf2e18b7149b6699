"""Worked examples of textbooks, as limits of a machine: each printed result within its printed digits.

A crank a millionth of the rod's length puts a steady force of the slider along the rod, as the authors have it. A round
column is the rectangular bar of its area and least radius of gyration: Euler's and Johnson's loads know no more of a
section. Numbers are those of the sources in their own units.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import Bar, RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Criterion, Material, Mechanism, Strength
from slidercrank.objectives.registry import QUANTITIES

INCH, FOOT, POUND, MINUTE = 0.0254, 0.3048, 4.4482216152605, 60.0
PSI = POUND / INCH**2
KPSI = 1e3 * PSI
NO_MASS = 1e-9  # kg/m^3
STEEL = Material(
    density=7850.0,
    elasticity=207e9,
    yield_strength=500e6,
    ultimate_strength=800e6,
    endurance=200e6,
    bearing_pressure=50e6,
)


def strut(
    length: float, width: float, depth: float, forces: tuple[float, float], strength: Strength, *, speed: float = 1.0
) -> tuple[Mechanism, np.ndarray]:
    """Return a machine whose massless rod carries a force in each stroke, tension positive, N, and its design."""
    machine = Mechanism(
        speed=speed,
        crank=RigidLink(mass=0.0),
        rod=Bar(width=width, depth=depth, density=NO_MASS),
        loads=(StrokeForce(outward=forces[0], inward=forces[1]),),
        strength=strength,
    )
    return machine, np.array([[1e-6 * length, length, 0.0]])


def pinned(material: Material = STEEL, *, pin: float = 1e-6, concentration: float = 1.0) -> Strength:
    """Return a material with pins of one diameter, m."""
    return Strength(material=material, crank_pivot=pin, crank_pin=pin, slider_pin=pin, eye_concentration=concentration)


def value(name: str, machine: Mechanism, design: np.ndarray) -> float:
    return float(QUANTITIES[name].evaluate(machine, design).values[0])


def printed(number: str) -> pytest.approx:  # type: ignore[valid-type]
    """Return the values that are rounded to the digits of a printed number."""
    digits = len(number.partition("e")[0].partition(".")[2])
    return pytest.approx(float(number), rel=0.0, abs=0.5001 * 10.0**-digits)


def test_sample_problem_1_1_of_beer_and_johnston_pins_and_net_section_of_a_link() -> None:
    """F. P. Beer, E. R. Johnston Jr., J. T. DeWolf, Mechanics of Materials, 6th ed., Sample Problem 1.1, p. 18."""
    pins = Strength(material=STEEL, crank_pivot=1e-3, crank_pin=0.375 * INCH, slider_pin=0.25 * INCH)
    link = strut(6.0 * INCH, 1.25 * INCH, 0.375 * INCH, (750.0 * POUND,) * 2, pins)
    assert value("rod_stress", *link) / PSI == printed("2286")  # (c), at the pin A
    assert value("pin_shear_crank_pin", *link) / PSI == printed("6790.6")  # (a), cut once
    assert value("pin_shear_slider_pin", *link) / 2.0 / PSI == printed("7639")  # (b), cut twice
    side = strut(6.0 * INCH, 1.25 * INCH, 0.25 * INCH, (375.0 * POUND,) * 2, pins)
    assert value("pin_pressure_slider_pin", *side) / PSI == printed("6000")  # (e), in each of the two sides


def round_column(diameter: float) -> tuple[float, float]:
    """Return the sides of the rectangular bar that buckles as a round column does."""
    least = math.sqrt(12.0) * diameter / 4.0
    return 0.25 * math.pi * diameter**2 / least, least


@pytest.mark.parametrize(
    ("diameter", "length", "strength", "elasticity", "load", "safety"),
    [
        # R. G. Budynas and J. K. Nisbett, Shigley's Mechanical Engineering Design, 9th ed., Example 4-17, p. 187: Euler
        ("37.48", 1500.0, 500e6, 207e9, 22e3, 4.0),
        # Problems on the Design of Machine Elements (V. M. Faires), solved: section 5, no. 334, pages 1 to 3 of 18:
        # (a) by Johnson, (b) and (c) by Euler; inches.
        ("1.096", 25.0, 48.0 * KPSI, 30e3 * KPSI, 10e3 * POUND, 3.0),
        ("1.507", 50.0, 48.0 * KPSI, 30e3 * KPSI, 10e3 * POUND, 3.0),
        ("1.0657", 25.0, 150.0 * KPSI, 30e3 * KPSI, 10e3 * POUND, 3.0),
    ],
)
def test_columns_that_textbooks_size_have_the_safety_they_ask_for(
    diameter: str, length: float, strength: float, elasticity: float, load: float, safety: float
) -> None:
    unit = 1e-3 if length > 1000.0 else INCH
    digits = len(diameter.partition(".")[2])
    material = replace(
        STEEL,
        yield_strength=strength,
        elasticity=elasticity,
        endurance=0.1 * strength,
        ultimate_strength=2.0 * strength,
    )
    found = [
        value("buckling_safety", *strut(length * unit, *round_column(size * unit), (-load, -load), pinned(material)))
        for size in (float(diameter) - 0.5 * 10.0**-digits, float(diameter) + 0.5 * 10.0**-digits)
    ]
    assert found[0] <= safety <= found[1]


def test_problem_4_77_of_shigley_a_rod_of_a_press_that_johnson_s_formula_sizes() -> None:
    """R. G. Budynas and J. K. Nisbett, Solutions Manual to Mechanical Engineering Design, 8th ed., 4-77 (b), p. 110."""
    material = replace(STEEL, yield_strength=37.5 * KPSI, elasticity=30e3 * KPSI, endurance=20.0 * KPSI)
    rod = strut(18.0 * INCH, *round_column(0.875 * INCH), (-5655.0 * POUND,) * 2, pinned(material))
    safety = value("buckling_safety", *rod)
    assert safety == printed("3.13")
    assert safety * 5655.0 == pytest.approx(17714.0, rel=2e-4)  # with l/k rounded to 82.3 in print


def test_problem_6_10_of_shigley_a_plate_with_a_hole_under_a_reversed_force() -> None:
    """The same manual, 6-10, p. 152: 60 x 10 mm, a hole of 12 mm, K_f 2.23, S_e 168.1 MPa: 20.1 kN at n = 1.8."""
    material = replace(STEEL, yield_strength=370e6, ultimate_strength=440e6, endurance=168.1e6, elasticity=207e9)
    plate = strut(0.3, 0.06, 0.01, (20.1e3, -20.1e3), pinned(material, pin=0.012, concentration=2.23))
    assert value("fatigue_safety", *plate) == printed("1.8")
    assert value("fatigue_safety", *plate) * 20.1 / 1.8 == printed("20.1")
    pulled = strut(0.3, 0.06, 0.01, (98.7e3, -98.7e3), pinned(material, pin=0.012))
    assert value("static_safety", *pulled) * 98.7 / 1.8 == printed("98.7")


def test_problem_6_17_of_shigley_amplitude_and_mean_of_a_bar_that_is_pulled_more_and_less() -> None:
    """The same manual, 6-17, p. 156: 1 x 3/8 in, a hole of 1/4 in, 0.8 to 3 kip; n_y 5.06, amplitude 8.45, mean 14.6.

    Amplitude and mean from both criteria: 1/n = a/S_e + m/S_ut and a/S_e + m/S_y.
    """
    material = replace(
        STEEL, yield_strength=54.0 * KPSI, ultimate_strength=64.0 * KPSI, endurance=24.4 * KPSI, elasticity=30e3 * KPSI
    )
    pulls = (3000.0 * POUND, 800.0 * POUND)
    bar = strut(5.0 * INCH, INCH, 0.375 * INCH, pulls, pinned(material, pin=0.25 * INCH))
    assert value("static_safety", *bar) == printed("5.06")
    net = strut(5.0 * INCH, INCH, 0.375 * INCH, pulls, pinned(material, pin=0.25 * INCH, concentration=2.16))

    def used(criterion: Criterion) -> float:
        machine, design = net
        strength = replace(pinned(material, pin=0.25 * INCH, concentration=2.16), criterion=criterion)
        return 1.0 / value("fatigue_safety", replace(machine, strength=strength), design)

    mean = (used("soderberg") - used("goodman")) / (1.0 / 54.0 - 1.0 / 64.0)
    assert mean == printed("14.6")
    assert 24.4 * (used("goodman") - mean / 64.0) == printed("8.45")


def test_problem_12_22_of_shigley_turns_until_a_bushing_is_worn() -> None:
    """The same manual, 12-22, p. 323: 1 x 1 in, 500 lbf, 200 rev/min, worn by 0.005 in after 16.7 million turns.

    There w = (4/pi) f1 f2 K F V t / (D L), the greatest depth; ours is the mean over the projected area. The text lost
    the factor 10^6 of the turns.
    """
    wear = 1.8 * 0.6e-10 * INCH**3 * MINUTE / (POUND * FOOT * 60.0 * MINUTE)
    strength = replace(pinned(pin=INCH), wear_coefficient=wear)
    speed = 200.0 * 2.0 * math.pi / MINUTE
    machine, design = strut(10.0 * INCH, 2.0 * INCH, INCH, (500.0 * POUND,) * 2, strength, speed=speed)
    machine = replace(machine, crank=Bar(width=2.0 * INCH, depth=INCH, density=NO_MASS))
    depth = 4.0 / math.pi * value("wear_pivot", machine, design) / INCH
    assert 0.005 / depth == printed("16.7")
    pressure = value("pin_pressure_crank_pivot", machine, design)
    assert pressure / PSI == pytest.approx(500.0, rel=1e-9)
    assert value("pv_pivot", machine, design) / pressure / (FOOT / MINUTE) == printed("52.4")


def test_problem_12_23_of_shigley_pressure_and_speed_of_a_bushing() -> None:
    """The same manual, 12-23, trial 1, p. 323: 1 x 1 in, 2 (100) lbf, 400 rev/min: 200 psi at pi (400)/12 ft/min."""
    speed = 400.0 * 2.0 * math.pi / MINUTE
    machine, design = strut(10.0 * INCH, 2.0 * INCH, INCH, (200.0 * POUND,) * 2, pinned(pin=INCH), speed=speed)
    machine = replace(machine, crank=Bar(width=2.0 * INCH, depth=INCH, density=NO_MASS))
    assert value("pin_pressure_crank_pivot", machine, design) / PSI == printed("200")
    worked = value("pv_pivot", machine, design) / (PSI * FOOT / MINUTE)
    assert worked == pytest.approx(200.0 * math.pi * 400.0 / 12.0, rel=1e-9)


def test_an_eye_of_khurmi_and_gupta_that_a_moment_bends() -> None:
    """R. S. Khurmi and J. K. Gupta, A Textbook of Machine Design, ch. 32, a rocker arm, p. 1198: 25.1 MPa.

    443e3 N mm at a hole of 36 mm in 60 x 37.5 mm, Z = 17,640 mm^3. A long crank, so that the force beside the moment
    is next to nothing.
    """
    strength = Strength(material=STEEL, crank_pivot=0.036, crank_pin=1e-3, slider_pin=1e-3)
    arm, moment = 1e3, 443.0
    machine = Mechanism(
        crank=Bar(width=0.06, depth=0.0375, density=NO_MASS),
        rod=RigidLink(mass=0.0),
        loads=(StrokeForce(outward=moment / arm, inward=moment / arm),),
        strength=strength,
    )
    design = np.array([[arm, 1e6 * arm, 0.0]])
    assert value("crank_stress", replace(machine, speed=1e-6), design) / 1e6 == printed("25.1")


def test_example_32_3_of_khurmi_and_gupta_a_connecting_rod_that_whips() -> None:
    """R. S. Khurmi and J. K. Gupta, A Textbook of Machine Design, Example 32.3, p. 1161: 51.3 N m by its own inertia.

    1.64 kg/m, 380 mm long, crank 95 mm, 1,800 rev/min. The text lets the transverse inertia fall from m r omega^2 at
    the crank pin to zero at the other end. So it does for a rod much longer than its crank: here the crank has a
    thousandth, at a speed that leaves r omega^2 as it is, and the rod is thin, so that axial inertia adds nothing.
    """
    length, per_length, width, less = 0.38, 1.64, 1e-4, 1e-3
    depth = 0.02
    machine = Mechanism(
        speed=1800.0 * 2.0 * math.pi / MINUTE / math.sqrt(less),
        crank=RigidLink(mass=0.0),
        rod=Bar(width=width, depth=depth, density=per_length / (width * depth)),
        strength=pinned(),
    )
    stress = value("rod_stress", machine, np.array([[0.095 * less, length, 0.0]]))
    assert stress * depth * width**2 / 6.0 == printed("51.3")
