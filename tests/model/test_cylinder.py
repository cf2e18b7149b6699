"""Cylinders of compressors and pumps: force, work, peaks, gradients, running, refusals, job file."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.model.cycle.cycle import breakpoints, cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import Drive, LinearMotor
from slidercrank.model.machine.links_and_joints import Friction, Pin, RigidLink
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.loads.cylinder import Cylinder
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.transient.steady_running import Runner
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.job import parse_job

Array = NDArray[np.float64]
DENSE = np.linspace(0.0, 2.0 * math.pi, 200_001)
AIR = Compressor(
    bore=0.07, low=1e5, high=8e5, clearance=0.05, compression_exponent=1.3, expansion_exponent=1.2, piston_rod=0.012
)


def random_compressor(random: np.random.Generator) -> Compressor:
    """Return a compressor that delivers; now and then one without clearance, isothermal, or a pump."""
    low, ratio = random.uniform(0.2e5, 3e5), random.uniform(1.05, 9.0)
    exponents = random.choice([1.0, 1.0 + 1e-7, 1.15, 1.3, 1.4], size=2)
    kind = random.integers(8)
    return Compressor(
        bore=random.uniform(0.03, 0.12),
        low=low,
        high=ratio * low,
        clearance=0.0 if kind == 0 else 0.9 * random.random() / (ratio ** (1.0 / exponents.min()) - 1.0),
        compression_exponent=0.0 if kind == 1 else float(exponents[0]),
        expansion_exponent=0.0 if kind == 1 else float(exponents[1]),
        back_pressure=random.uniform(0.0, 2e5),
        piston_rod=random.choice([0.0, 0.01]),
        head=random.choice(["outer dead centre", "inner dead centre"]),
    )


def random_case(seed: int) -> tuple[Mechanism, Array]:
    """Return a machine of one random compressor and nothing else, and a design (1, 3) that turns fully."""
    random = np.random.default_rng(seed)
    crank, offset = random.uniform(0.02, 0.06), random.uniform(-0.04, 0.04)
    rod = (crank + abs(offset)) * random.uniform(1.02, 4.0)
    machine = Mechanism(
        speed=random.choice([-60.0, 90.0]),
        loads=(random_compressor(random),),
        branch=random.choice(["open", "crossed"]),
    )
    return machine, np.array([[crank, rod, offset]])


def polytropic(p: float, v: float, w: float, n: float) -> float:
    """Return the work of a gas that expands from volume v at pressure p to w, J."""
    grown = math.log(w / v)
    return p * v * grown if n == 1.0 else -p * v / (n - 1.0) * math.expm1(-(n - 1.0) * grown)


def indicated(load: Cylinder, stroke: float) -> float:
    """Return the work of the gas over a turn by the textbook's four lines of the indicator diagram, J."""
    area = 0.25 * math.pi * (load.bore**2 - load.piston_rod**2)
    swept = area * stroke
    if load.compression_exponent == 0.0:
        return (load.low - load.high) * swept
    least = load.clearance * swept + load.clearance_volume
    most = least + swept
    ratio = load.high / load.low
    opened = least * ratio ** (1.0 / load.expansion_exponent)
    delivering = most / ratio ** (1.0 / load.compression_exponent)
    expansion = polytropic(load.high, least, opened, load.expansion_exponent) if least else 0.0
    compression = polytropic(load.low, most, delivering, load.compression_exponent)
    return float(expansion + load.low * (most - opened) + compression - load.high * (delivering - least))


def turning(machine: Mechanism, design: Array) -> Linkage:
    """Return the linkage of a design (1, 3)."""
    crank, rod, offset = design[0]
    return Linkage(crank, rod, offset, machine.branch)


def force(machine: Mechanism, design: Array, theta: Array) -> Array:
    """Return the force of gas and back pressure, N outward, by least and greatest of the polytropes."""
    (load,) = machine.loads
    assert isinstance(load, Cylinder)
    linkage = Linkage(design[0], design[1], design[2], machine.branch)
    at = linkage.at(theta, speed=machine.speed)
    x, v = (np.abs(at.slider_position), at.slider_velocity * np.sign(at.slider_position))
    inner, outer = (math.sqrt((design[1] + sign * design[0]) ** 2 - design[2] ** 2) for sign in (-1.0, 1.0))
    stroke, behind = outer - inner, load.head == "outer dead centre"
    z, away = (outer - x, v < 0.0) if behind else (x - inner, v > 0.0)
    if load.compression_exponent == 0.0:
        pressure = np.where(away, load.low, load.high)
    else:
        h = load.clearance * stroke + load.clearance_volume / load.area
        with np.errstate(divide="ignore"):
            falling = np.maximum(load.low, load.high * (h / (h + z)) ** load.expansion_exponent)
            rising = np.minimum(load.high, load.low * ((h + stroke) / (h + z)) ** load.compression_exponent)
        pressure = np.where(away, falling, rising)
    return np.asarray((-1.0 if behind else 1.0) * load.area * (pressure - load.back_pressure))


@pytest.mark.parametrize("seed", range(60))
def test_the_mean_torque_is_the_closed_work_of_the_indicator_diagram(seed: int) -> None:
    """Gauss-Legendre panels between exact valve events: to 1e-10 of the work that goes to and fro."""
    machine, design = random_case(seed)
    (load,) = machine.loads
    assert isinstance(load, Cylinder)
    stroke = Linkage(*design[0]).stroke
    mean = torque_averages(machine, design).mean[0] * 2.0 * math.pi * machine.direction
    wanted = indicated(load, float(stroke))
    assert -mean == pytest.approx(wanted, rel=1e-10, abs=1e-12 * load.high * load.area * float(stroke))
    assert QUANTITIES["indicated_work"].evaluate(machine, design).values[0] == pytest.approx(
        wanted, rel=1e-12, abs=1e-9 * abs(wanted)
    )
    assert QUANTITIES["delivered_work"].evaluate(machine, design).values[0] == -mean


@pytest.mark.parametrize("seed", range(20))
def test_the_force_is_that_of_the_polytropes_at_every_angle(seed: int) -> None:
    machine, design = random_case(seed)
    theta = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi, 400)
    found = cycle(machine, turning(machine, design), theta)
    wanted = force(machine, design[0], theta)
    assert np.abs(found.load - wanted).max() <= 1e-9 * np.abs(wanted).max()
    power = found.torque * machine.speed + found.load * found.slider_velocity * np.sign(found.slider_position)
    assert np.abs(power).max() <= 1e-9 * np.abs(found.load * found.slider_velocity).max()


@pytest.mark.parametrize("signal", [Signal.TORQUE, Signal.GUIDE_FORCE])
def test_peaks_are_those_of_a_dense_sweep(signal: Signal) -> None:
    """A kink lies up to a spacing, 3e-5 rad, from a sample: below 1e-3 of the peak here."""
    for seed in range(8):
        machine, design = random_case(seed)
        value = find_peaks(machine, signal, design).values[0, 0]
        curve = cycle(machine, turning(machine, design), DENSE)
        swept = np.abs(curve.torque if signal == Signal.TORQUE else curve.guide).max()
        assert swept * (1.0 - 1e-12) <= value <= swept * (1.0 + 1e-3)


def test_with_friction_the_mean_torque_is_the_integral_between_breakpoints() -> None:
    """Sixty Gauss nodes on eighths of the segments between breakpoints; friction makes up to ten of these."""
    friction = Friction(
        guide=0.06, crank_pin=Pin(radius=0.014, coefficient=0.02), slider_pin=Pin(radius=0.009, coefficient=0.03)
    )
    machine = Mechanism(speed=90.0, slider_mass=0.35, rod=RigidLink(mass=0.3), loads=(AIR,), friction=friction)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    random = np.random.default_rng(2)
    for _ in range(4):
        design = np.array([[random.uniform(0.025, 0.035), random.uniform(0.08, 0.2), random.uniform(-0.03, 0.03)]])
        linkage = turning(machine, design)
        cuts = breakpoints(machine, linkage)
        ends = np.concatenate(
            [np.linspace(a, b, 9)[:-1] for a, b in itertools.pairwise([*cuts, cuts[0] + 2.0 * math.pi])]
        )
        ends = np.append(ends, cuts[0] + 2.0 * math.pi)
        width, middle = 0.5 * np.diff(ends)[:, None], 0.5 * (ends[1:] + ends[:-1])[:, None]
        torque = cycle(machine, linkage, (middle + width * nodes).ravel()).torque.reshape(-1, 60)
        wanted = float((torque @ weights) @ width[:, 0]) / (2.0 * math.pi)
        assert torque_averages(machine, design).mean[0] == pytest.approx(wanted, rel=1e-11)
        works = [QUANTITIES[name].evaluate(machine, design).values[0] for name in ("delivered_work", "indicated_work")]
        assert works[0] < works[1] < 0.0


def test_valve_events_are_where_the_pressures_meet() -> None:
    linkage = Linkage(0.03, 0.11, -0.01)
    machine = Mechanism(speed=90.0, loads=(AIR,))
    at = linkage.at(breakpoints(machine, linkage), speed=1.0)
    z = at.slider_position.max() - at.slider_position
    stroke = float(linkage.stroke)
    h = 0.05 * stroke
    events = {0.0, stroke, h * (8.0 ** (1.0 / 1.2) - 1.0), (h + stroke) * 8.0 ** (-1.0 / 1.3) - h}
    assert sorted(z) == pytest.approx(sorted(events), abs=1e-15)


NAMES = (
    *("displacement_volume", "clearance_ratio", "indicated_work", "mean_effective_pressure", "volumetric_efficiency"),
    *("delivered_work", "torque_fluctuation", "peak_torque", "peak_guide_force"),
)
VARIED = {
    "bore": (0.06, 0.08),
    "piston_rod": (0.01, 0.014),
    "clearance": (0.03, 0.06),
    "clearance_volume": (1e-6, 8e-6),
    "low": (0.9e5, 1.1e5),
    "high": (5e5, 8e5),
    "compression_exponent": (1.2, 1.4),
    "expansion_exponent": (1.1, 1.3),
    "back_pressure": (0.9e5, 1.2e5),
}


@pytest.mark.parametrize("head", ["outer dead centre", "inner dead centre"])
def test_gradients_by_dimensions_and_by_every_number_of_the_cylinder_are_those_of_differences(head: Any) -> None:
    varying = tuple(
        Varying(name=name, lower=low, upper=high, sets=((f"loads.0.{name}", 1.0),))
        for name, (low, high) in VARIED.items()
    )
    machine = Mechanism(
        speed=-80.0, slider_mass=0.4, loads=(replace(AIR, head=head, clearance_volume=2e-6),), varying=varying
    )
    random = np.random.default_rng(3)
    shares = random.uniform(0.2, 0.8, (4, len(VARIED)))
    ends = np.array(list(VARIED.values()))
    designs = np.column_stack(
        [
            random.uniform([0.025, 0.1, -0.02], [0.04, 0.16, 0.02], (4, 3)),
            ends[:, 0] + shares * (ends[:, 1] - ends[:, 0]),
        ]
    )
    for name in NAMES:
        quantity = QUANTITIES[name]
        slopes = quantity.evaluate(machine, designs, gradients=True).gradients
        assert slopes is not None
        for column in range(designs.shape[1]):
            step = np.zeros(designs.shape)
            step[:, column] = 1e-5 * np.abs(designs[:, column]) + 1e-9
            two = [quantity.evaluate(machine, designs + sign * step).values for sign in (1.0, -1.0)]
            wanted = (two[0] - two[1]) / (2.0 * step[:, column])
            size = np.abs(two[0]) / np.abs(designs[:, column])
            assert np.abs(slopes[:, column] - wanted).max() <= 1e-6 * size.max(), (name, column)


def test_volumetric_efficiency_counts_what_expands_from_the_clearance() -> None:
    machine, design = Mechanism(speed=90.0, loads=(AIR,)), np.array([[0.03, 0.11, 0.01]])
    found = {name: QUANTITIES[name].evaluate(machine, design).values[0] for name in NAMES}
    assert found["volumetric_efficiency"] == pytest.approx(1.05 - 0.05 * 8.0 ** (1.0 / 1.2), rel=1e-14)
    assert found["clearance_ratio"] == pytest.approx(0.05, rel=1e-14)
    swept = AIR.area * float(Linkage(*design[0]).stroke)
    assert found["displacement_volume"] == pytest.approx(swept, rel=1e-14)
    assert found["mean_effective_pressure"] == pytest.approx(found["indicated_work"] / swept, rel=1e-14)


def test_a_double_acting_compressor_adds_up_its_sides() -> None:
    sides = (replace(AIR, piston_rod=0.0), replace(AIR, head="inner dead centre", clearance=0.07, piston_rod=0.02))
    design = np.array([[0.03, 0.11, 0.01], [0.04, 0.1, -0.03]])
    both = Mechanism(speed=90.0, loads=sides)
    each = [Mechanism(speed=90.0, loads=(side,)) for side in sides]
    for name in ("displacement_volume", "indicated_work"):
        parts = [QUANTITIES[name].evaluate(machine, design).values for machine in each]
        assert QUANTITIES[name].evaluate(both, design).values == pytest.approx(sum(parts), rel=1e-14)
    theta = np.linspace(0.1, 6.0, 50)
    alone = sum(cycle(machine, Linkage(*design[0]), theta).load for machine in each)
    assert cycle(both, Linkage(*design[0]), theta).load == pytest.approx(alone, rel=1e-12)


def test_a_motor_settles_where_it_gives_what_the_compressor_takes() -> None:
    linkage = Linkage(0.03, 0.11, 0.01)
    machine = Mechanism(speed=90.0, slider_mass=0.4, loads=(AIR,))
    motor = LinearMotor(stall_torque=40.0, no_load_speed=120.0)
    drive = Drive(motor=motor, flywheel=5.0)
    speed = Runner(machine, linkage).balanced_speed(drive)
    wanted = -indicated(AIR, float(linkage.stroke)) / (2.0 * math.pi)
    assert float(motor.torque_at(speed)) == pytest.approx(wanted, rel=1e-8)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"bore": 0.0}, "bore must be positive and finite; got 0 m"),
        ({"bore": math.nan}, "bore must be positive"),
        ({"low": 0.0}, "low pressure, absolute, must be positive and finite; got 0 Pa"),
        ({"back_pressure": -1.0}, "back pressure, absolute, must be zero or more and finite; got -1 Pa"),
        ({"high": 1e5}, "discharge pressure must exceed the suction pressure; got 1 bar over 1 bar"),
        ({"high": 0.5e5}, "got 0.5 bar over 1 bar"),
        ({"piston_rod": 0.07}, "thinner than the bore; got 70 mm"),
        ({"clearance": 0.3}, "clearance must be below 0.2147 of the swept volume.*got 0.3"),
        ({"clearance": math.inf}, "clearance must be zero or more and finite"),
        ({"compression_exponent": 0.0}, "both exponents must be zero.*got 0 and 1.2"),
        ({"head": "left"}, "head must be 'outer dead centre' or 'inner dead centre'; got 'left'"),
    ],
)
def test_an_impossible_cylinder_is_refused_with_what_and_how_much(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        replace(AIR, **wrong)


JOB: dict[str, Any] = {
    "name": "compressor",
    "mechanism": {"speed": "900 rpm"},
    "load": [{"bore": "70 mm", "suction": "1 bar", "discharge": "8 bar", "clearance": 0.05}],
    "variables": {"crank": ["20 mm", "40 mm"], "rod": ["80 mm", "200 mm"], "offset": "0 mm"},
    "objectives": {"peak_torque": "minimise", "indicated_work": "maximise"},
}


def test_a_cylinder_of_a_job_file_is_in_si_with_the_atmosphere_behind_the_piston() -> None:
    (load,) = parse_job(JOB).mechanism.loads
    assert load == Compressor(
        bore=0.07, low=1e5, high=8e5, clearance=0.05, compression_exponent=1.3, expansion_exponent=1.3
    )
    assert load.back_pressure == 101_325.0
    assert "head at the outer dead centre, 1.01325 bar behind the piston" in load.text
    pump = parse_job({**JOB, "load": [{**JOB["load"][0], "medium": "liquid"}]}).mechanism.loads[0]
    assert pump.text.startswith("pump from 1 to 8 bar, bore")


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"bore": "0 mm"}, "load #1.bore: must be positive"),
        ({"suction": "-0.2 bar"}, 'load #1.suction: an absolute pressure must be above vacuum, 0; got "-0.2 bar"'),
        (
            {"discharge": "0.8 bar"},
            "load #1: the discharge pressure must exceed the suction pressure; got 0.8 bar over",
        ),
        ({"clearance": 0.5}, "load #1: the clearance must be below"),
        ({"suction": "1 J"}, "load #1.suction: must be a pressure"),
    ],
)
def test_a_wrong_cylinder_of_a_job_file_is_refused_at_its_key(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words.replace(".", r"\.")):
        parse_job({**JOB, "load": [{**JOB["load"][0], **wrong}]})


def test_quantities_of_cylinders_are_refused_without_one() -> None:
    for name in ("displacement_volume", "volumetric_efficiency", "indicated_work"):
        with pytest.raises(InputError, match=r"cylinder|compressor"):
            parse_job(
                {
                    **JOB,
                    "load": [],
                    "mechanism": {"slider": {"mass": "1 kg"}, "speed": "1 rpm"},
                    "objectives": {name: "maximise"},
                }
            )


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"expansion_exponent": 1e-9}, "at least 0.2"),
        ({"compression_exponent": 0.1}, "at least 0.2"),
        ({"low": 1e5, "high": 1e5}, "raise the discharge pressure"),
        ({"low": 2e5, "high": 1e5}, "swap the two"),
        ({"piston_rod": 0.07}, "give a thinner rod"),
    ],
)
def test_remedies_fit_what_was_given(given: dict[str, float], words: str) -> None:
    usual = {"bore": 0.07, "low": 1e5, "high": 8e5, "compression_exponent": 1.3, "expansion_exponent": 1.2}
    with pytest.raises(InputError, match=words):
        Compressor(**(usual | given))  # type: ignore[arg-type]
