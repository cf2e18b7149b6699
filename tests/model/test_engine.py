"""The ideal two-stroke engine cycle: work, pressures, sign of the delivered work, refusals, job file."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import ConstantTorque, Drive
from slidercrank.model.machine.loads.engine import Engine
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.transient.forward_dynamics import State, simulate
from slidercrank.model.transient.steady_running import Runner
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.job import parse_job

JOB: dict[str, Any] = {
    "name": "engine",
    "mechanism": {"speed": "3000 rpm"},
    "load": [{"bore": "54 mm", "compression_ratio": 8, "intake": "1 bar", "peak_pressure": "40 bar"}],
    "variables": {"crank": "27 mm", "rod": ["80 mm", "140 mm"], "offset": "0 mm"},
    "objectives": {"delivered_work": "maximise", "peak_guide_force": "minimise"},
}


def engine(**changed: Any) -> Engine:
    """Return the engine of the job with other entries."""
    (load,) = parse_job({**JOB, "load": [{**JOB["load"][0], **changed}]}).mechanism.loads
    assert isinstance(load, Engine)
    return load


@pytest.mark.parametrize("seed", range(20))
def test_the_delivered_work_is_that_of_the_two_polytropes(seed: int) -> None:
    """Positive either way round: p_h V_c (1 - r^(1 - n)) / (n - 1) less that of compression."""
    random = np.random.default_rng(seed)
    ratio, up, down = random.uniform(4.0, 18.0), random.uniform(1.1, 1.4), random.uniform(1.1, 1.3)
    low, bore = random.uniform(0.5e5, 2e5), random.uniform(0.03, 0.1)
    high = low * ratio ** max(up, down) * random.uniform(1.3, 4.0)
    load = engine(
        bore=bore,
        compression_ratio=ratio,
        intake=low,
        peak_pressure=high,
        compression_exponent=up,
        expansion_exponent=down,
        head=str(random.choice(["outer dead centre", "inner dead centre"])),
    )
    machine = Mechanism(speed=float(random.choice([-200.0, 300.0])), loads=(load,))
    crank = random.uniform(0.02, 0.05)
    design = np.array([[crank, crank * random.uniform(2.5, 5.0), random.uniform(-0.5, 0.5) * crank]])
    least = 0.25 * math.pi * bore**2 * float(Linkage(*design[0]).stroke) / (ratio - 1.0)
    gained = high * least * (1.0 - ratio ** (1.0 - down)) / (down - 1.0)
    spent = low * ratio**up * least * (1.0 - ratio ** (1.0 - up)) / (up - 1.0)
    wanted = gained - spent
    assert QUANTITIES["indicated_work"].evaluate(machine, design).values[0] == pytest.approx(wanted, rel=1e-12)
    assert QUANTITIES["delivered_work"].evaluate(machine, design).values[0] == pytest.approx(wanted, rel=1e-10)
    assert torque_averages(machine, design).mean[0] * machine.speed < 0.0


def test_the_gas_reaches_its_peak_pressure_after_the_top_and_the_intake_pressure_before_compression() -> None:
    machine, linkage = Mechanism(speed=300.0, loads=(engine(),)), Linkage(0.027, 0.1, 0.004)
    bottom, top = linkage.dead_centre_angles
    area, after = 0.25 * math.pi * 0.054**2, 1e-7
    load = cycle(machine, linkage, np.array([top - after, top + after, bottom - after, bottom + after])).load
    pressures = 101_325.0 - load / area
    wanted = [1e5 * 8.0**1.3, 40e5, 40e5 / 8.0**1.3, 1e5]
    assert pressures == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_without_a_motor_the_flywheel_gains_what_the_gas_gives_at_every_angle(direction: float) -> None:
    """Massless links: J w^2 / 2 rises by the closed work of the gas less the back pressure's."""
    load = engine(expansion_exponent=1.25)
    linkage = Linkage(0.027, 0.1, 0.004)
    machine = Mechanism(speed=direction, loads=(load,))
    top = float(linkage.dead_centre_angles[1])
    drive = Drive(motor=ConstantTorque(torque=0.0), flywheel=0.02)
    start = State(angle=top + 1e-9 * direction, speed=150.0 * direction)
    found = simulate(machine, linkage, drive, duration=10.0, turns=4, start=start)
    gained = 0.5 * 0.02 * (found.speed**2 - 150.0**2)
    stroke = float(linkage.stroke)
    z = float(linkage.at(top).slider_position) - found.slider_position
    h, area = stroke / 7.0, load.area

    def worked(p: float, n: float, at: float) -> Any:
        """Return the work from a height to that of z, J."""
        return area * p * at / (n - 1.0) * (1.0 - (at / (h + z)) ** (n - 1.0))

    turned = (found.angle - top) * direction
    turns = np.floor(turned / (2.0 * math.pi))
    whole = QUANTITIES["indicated_work"].evaluate(machine, np.array([[0.027, 0.1, 0.004]])).values[0]
    end = area * 40e5 * h / 0.25 * (1.0 - 8.0**-0.25)
    away = found.slider_velocity < 0.0
    gas = np.where(away, worked(40e5, 1.25, h), end + worked(1e5, 1.3, h + stroke))
    wanted = turns * whole + gas - load.back_pressure * area * z
    inside = (z > 1e-6 * stroke) & (z < (1.0 - 1e-6) * stroke)
    assert inside.sum() > 300
    assert np.abs(gained - wanted)[inside].max() <= 1e-8 * np.abs(wanted).max()


def test_a_constant_torque_keeps_the_mean_speed_of_an_engine_by_taking_its_work() -> None:
    machine, linkage = Mechanism(speed=200.0, loads=(engine(),)), Linkage(0.027, 0.1, 0.004)
    running = Runner(machine, linkage).run_under_constant_torque(0.05)
    whole = QUANTITIES["indicated_work"].evaluate(machine, np.array([[0.027, 0.1, 0.004]])).values[0]
    assert -running.motor_torque[0] * 2.0 * math.pi == pytest.approx(whole, rel=1e-9)
    energy = 0.5 * 0.05 * running.speed**2
    assert energy.max() - energy.min() > 0.5 * whole


def test_heat_gives_the_pressure_of_an_ideal_gas_at_constant_volume() -> None:
    """Heat is c_v times the rise of p V: 1.2 MJ/m^3 of swept volume, a seventh of it clearance."""
    load = engine(peak_pressure=0.0, heat="1.2 MJ/m^3", heat_capacity_ratio=1.35)
    rise = load.high - 1e5 * 8.0**1.3
    assert rise / (1.35 - 1.0) / 7.0 == pytest.approx(1.2e6, rel=1e-13)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"peak_pressure": "10 bar"}, r"exceed that of compression alone, 14\.9285 bar; got 10 bar"),
        ({"peak_pressure": "0 bar"}, "a peak pressure, heat or both; got neither"),
        ({"compression_ratio": 1}, "compression_ratio: must be above 1; got 1"),
        ({"heat_capacity_ratio": 1}, "heat_capacity_ratio: must be above 1; got 1"),
        ({"heat_capacity_ratio": 0.9}, "heat_capacity_ratio: must be above 1; got 0.9"),
        (
            {"peak_pressure": "16 bar", "expansion_exponent": 1.39},
            "not expand below its intake pressure, 1 bar; got 0.8",
        ),
        ({"bore": 0}, "bore: must be positive"),
        ({"intake": "-1 bar"}, 'intake: an absolute pressure must be above vacuum, 0; got "-1 bar"'),
    ],
)
def test_an_impossible_engine_is_refused_with_what_and_how_much(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        engine(**wrong)


def test_an_engine_has_no_volumetric_efficiency() -> None:
    with pytest.raises(InputError, match="compressor or pump; got none"):
        parse_job({**JOB, "objectives": {"volumetric_efficiency": "maximise"}})
