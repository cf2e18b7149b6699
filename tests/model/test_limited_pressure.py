"""The ideal engine cycle at limited pressure: work, limits, end of burning, peaks, derivatives, refusals."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import breakpoints, cycle
from slidercrank.model.cycle.gas_work import burning_end_angle, indicator_diagram
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.engine import Engine, FourStroke, LimitedPressure
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.job import parse_job

LOAD: dict[str, Any] = {
    "bore": "86 mm",
    "compression_ratio": 16,
    "intake": "1 bar",
    "peak_pressure": "80 bar",
    "heat": "1.8 MJ/m^3",
}
JOB: dict[str, Any] = {
    "name": "engine",
    "mechanism": {"speed": "3000 rpm"},
    "load": [LOAD],
    "variables": {"crank": "43 mm", "rod": ["120 mm", "180 mm"], "offset": "0 mm"},
    "objectives": {"delivered_work": "maximise", "peak_guide_force": "minimise"},
}


def engine(**changed: Any) -> Engine:
    """Return the engine of the job with other entries."""
    (load,) = parse_job({**JOB, "load": [{**LOAD, **changed}]}).mechanism.loads
    assert isinstance(load, Engine)
    return load


def random_case(seed: int) -> tuple[Mechanism, np.ndarray[Any, np.dtype[np.float64]], dict[str, float]]:
    """Return a machine with such an engine, of four strokes for odd seeds, its design, and what was given."""
    random = np.random.default_rng(seed)
    given = {
        "compression_ratio": random.uniform(6.0, 20.0),
        "compression_exponent": random.uniform(1.1, 1.4),
        "expansion_exponent": random.uniform(1.05, 1.35),
        "heat_capacity_ratio": random.uniform(1.2, 1.4),
        "intake": random.uniform(0.5e5, 2e5),
        "bore": random.uniform(0.03, 0.1),
    }
    ratio, kappa = given["compression_ratio"], given["heat_capacity_ratio"]
    compressed = given["intake"] * ratio ** given["compression_exponent"]
    given["peak_pressure"] = compressed * random.uniform(1.02, 2.5)
    at_once = (given["peak_pressure"] - compressed) / ((ratio - 1.0) * (kappa - 1.0))
    given["heat"] = at_once + random.uniform(0.02, 0.5) * given["peak_pressure"] * kappa / (kappa - 1.0)
    strokes = {"cycle": "720 deg", "exhaust": 1.1e5} if seed % 2 else {}
    head = str(random.choice(["outer dead centre", "inner dead centre"]))
    load = engine(**given, **strokes, head=head)
    branch: Branch = "crossed" if seed % 3 == 0 else "open"
    speed = float(random.choice([-200.0, 300.0]))
    crank = random.uniform(0.02, 0.05)
    design = np.array([[crank, crank * random.uniform(2.5, 5.0), random.uniform(-0.5, 0.5) * crank]])
    return Mechanism(speed=speed, loads=(load,), branch=branch, slider_mass=0.3), design, given


def swept(load: Engine, design: Any) -> float:
    """Return the swept volume, m^3."""
    return 0.25 * math.pi * load.bore**2 * float(Linkage(*design[0]).stroke)


@pytest.mark.parametrize("seed", range(24))
def test_the_work_is_that_of_the_closed_expression(seed: int) -> None:
    """Volumes and pressures of the corners 1, 2, 3 (peak), 4 (end of burning), 5 (end of the stroke)."""
    machine, design, given = random_case(seed)
    (load,) = machine.loads
    assert isinstance(load, LimitedPressure)
    volume, ratio, kappa = swept(load, design), given["compression_ratio"], given["heat_capacity_ratio"]
    up, down, peak = given["compression_exponent"], given["expansion_exponent"], given["peak_pressure"]
    clearance = volume / (ratio - 1.0)
    compressed = given["intake"] * ratio**up
    at_once = (peak - compressed) * clearance / (kappa - 1.0)
    burnt = clearance + (given["heat"] * volume - at_once) * (kappa - 1.0) / (kappa * peak)
    last = peak * (burnt / (ratio * clearance)) ** down
    whole = peak * (burnt - clearance) + (peak * burnt - last * ratio * clearance) / (down - 1.0)
    whole -= (compressed * clearance - given["intake"] * ratio * clearance) / (up - 1.0)
    four = isinstance(load, FourStroke)
    wanted = whole + (load.low - 1.1e5) * volume if four else whole
    size = peak * volume
    for name in ("indicated_work", "delivered_work"):
        found = QUANTITIES[name].evaluate(machine, design).values[0]
        assert found == pytest.approx(wanted, abs=1e-10 * size), name


@pytest.mark.parametrize("seed", range(24))
def test_burning_ends_where_the_volume_says_and_cuts_the_cycle_there(seed: int) -> None:
    machine, design, _ = random_case(seed)
    (load,) = machine.loads
    assert isinstance(load, LimitedPressure)
    linkage = Linkage(design[0, 0], design[0, 1], design[0, 2], branch=machine.branch)
    end = burning_end_angle(machine, linkage, load)
    assert end is not None
    area, top = load.area * (1.0 if load.head == "inner dead centre" else -1.0), swept(load, design)
    wanted = top * (load.clearance + load.burning_share)
    around = end + machine.direction * np.array([-1e-6, 0.0, 1e-6, 1e-4])
    found = indicator_diagram(machine, linkage, load, around)
    assert found.volume[1] == pytest.approx(wanted, rel=1e-9)
    assert found.pressure[:2] == pytest.approx([load.high, load.high], rel=1e-12)
    assert found.pressure[3] < found.pressure[2] < load.high
    angles = np.random.default_rng(seed).uniform(0.0, 4.0 * math.pi, 100)
    pressures = indicator_diagram(machine, linkage, load, angles).pressure
    push = cycle(machine, linkage, angles).load
    assert push == pytest.approx(area * (pressures - load.back_pressure), abs=1e-9 * load.high * load.area)
    if load.cycle_turns == 1:
        assert np.abs(breakpoints(machine, linkage) - end).min() < 1e-9


@pytest.mark.parametrize("seed", range(8))
def test_peaks_are_those_of_a_dense_sweep(seed: int) -> None:
    machine, design, _ = random_case(seed)
    linkage = Linkage(design[0, 0], design[0, 1], design[0, 2], branch=machine.branch)
    curves = cycle(machine, linkage, np.linspace(0.0, 4.0 * math.pi, 40_001))
    for kind, curve in ((Signal.TORQUE, curves.torque), (Signal.GUIDE_FORCE, curves.guide)):
        peak = find_peaks(machine, kind, design).values[0, 0]
        assert np.abs(curve).max() <= peak * (1.0 + 1e-12)
        assert np.abs(curve).max() == pytest.approx(peak, rel=2e-3)


@pytest.mark.parametrize("seed", range(6))
def test_gradients_are_those_of_differences_in_dimensions_and_numbers_of_the_load(seed: int) -> None:
    machine, design, _ = random_case(seed)
    (load,) = machine.loads
    names = ("bore", "low", "high", "heat", "heat_capacity_ratio", "expansion_exponent")
    varying = tuple(
        Varying(name=name, sets=((f"loads.0.{name}", 1.0),), lower=getattr(load, name), upper=getattr(load, name))
        for name in names
    )
    free = replace(machine, varying=varying)
    at = np.hstack([design, [[getattr(load, name) for name in names]]])
    for name in ("indicated_work", "delivered_work", "peak_torque", "rms_torque"):
        of = QUANTITIES[name]
        found = of.evaluate(free, at, gradients=True)
        assert found.gradients is not None
        for column in range(at.shape[1]):
            step = 1e-5 * (at[0, column] or 1.0) * (np.arange(at.shape[1]) == column)
            up, down = (of.evaluate(free, at + sign * step).values[0] for sign in (1.0, -1.0))
            slope = (up - down) / (2.0 * step.sum())
            size = max(abs(slope), abs(found.values[0] / at[0, column]) * 1e-2)
            assert found.gradients[0, column] == pytest.approx(slope, abs=1e-6 * size), (name, column)


def test_with_as_much_heat_as_reaches_the_peak_pressure_it_is_the_cycle_of_constant_volume() -> None:
    for strokes in ({}, {"cycle": "720 deg", "exhaust": "1.2 bar"}):
        at_once = (80e5 - 1e5 * 16.0**1.3) / 15.0 / 0.4
        limited, plain = engine(heat=at_once * (1.0 + 1e-14), **strokes), engine(heat=0, **strokes)
        assert isinstance(limited, LimitedPressure)
        assert not isinstance(plain, LimitedPressure)
        design = np.array([[0.043, 0.15, 0.008]])
        for name in ("indicated_work", "peak_torque", "rms_torque", "peak_guide_force"):
            first, second = (
                QUANTITIES[name].evaluate(Mechanism(speed=300.0, loads=(load,), slider_mass=0.4), design).values[0]
                for load in (limited, plain)
            )
            assert first == pytest.approx(second, rel=1e-10), name


@pytest.mark.parametrize("seed", range(6))
def test_without_a_rise_of_pressure_it_has_the_efficiency_of_the_diesel_cycle(seed: int) -> None:
    """1 - r^(1 - k) (rho^k - 1) / (k (rho - 1)): Cengel and Boles, Thermodynamics, 7th ed., eq. 9-12."""
    random = np.random.default_rng(seed)
    ratio, k, heat = random.uniform(12.0, 22.0), random.uniform(1.25, 1.4), random.uniform(0.5e6, 2e6)
    compressed = 1e5 * ratio**k
    exponents = dict.fromkeys(("compression_exponent", "expansion_exponent", "heat_capacity_ratio"), k)
    peak = f"{1e-5 * compressed:.6g} bar"  # as a refusal tells it
    load = engine(compression_ratio=ratio, peak_pressure=peak, heat=heat, **exponents)
    assert load.high == compressed
    design = np.array([[0.043, 0.15, 0.008]])
    rho = 1.0 + heat * (k - 1.0) / (k * compressed) * (ratio - 1.0)
    efficiency = 1.0 - ratio ** (1.0 - k) * (rho**k - 1.0) / (k * (rho - 1.0))
    work = QUANTITIES["indicated_work"].evaluate(Mechanism(speed=300.0, loads=(load,)), design).values[0]
    assert work / (heat * swept(load, design)) == pytest.approx(efficiency, rel=1e-10)


def test_the_first_turn_of_four_strokes_burns_as_two_strokes_do() -> None:
    four, two = engine(cycle="720 deg"), engine()
    assert isinstance(four, FourStroke)
    assert four.load_on_turn(1) == two
    assert "over 3.855 % of the stroke" in four.text


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (
            {"heat": "0.3 MJ/m^3"},
            r"takes 0\.720694 MJ/m\^3; got 0\.3 MJ/m\^3, which reaches 54\.7583 bar; raise the heat",
        ),
        ({"heat": "60 MJ/m^3"}, r"end within the stroke, with at most 28\.7207 MJ/m\^3 of heat; got 60 MJ/m\^3"),
        ({"peak_pressure": "20 bar"}, r"not be below that of compression alone, 36\.7583 bar; got 20 bar"),
        ({"heat_capacity_ratio": 1}, "heat_capacity_ratio: must be above 1; got 1"),
        ({"peak_pressure": 0, "heat": 0}, "must have a peak pressure, heat or both; got neither"),
    ],
)
@pytest.mark.parametrize("strokes", ["360 deg", "720 deg"])
def test_an_impossible_engine_is_refused_with_what_and_how_much(
    wrong: dict[str, Any], words: str, strokes: str
) -> None:
    with pytest.raises(InputError, match=words):
        engine(**wrong, cycle=strokes)


def test_heat_and_peak_pressure_may_vary_where_every_pair_of_them_is_possible() -> None:
    """Else the least heat would not reach the greatest pressure."""
    free = {**JOB["variables"], "load.1.heat": ["1.2 MJ/m^3", "2 MJ/m^3"], "load.1.peak_pressure": ["60 bar", "90 bar"]}
    assert len(parse_job({**JOB, "variables": free}).mechanism.varying) == 2
    apart = free | {"load.1.heat": ["0.8 MJ/m^3", "2 MJ/m^3"]}
    with pytest.raises(InputError, match=r"the heat must reach the peak pressure of 90 bar.*got 0\.8 MJ/m"):
        parse_job({**JOB, "variables": apart})
