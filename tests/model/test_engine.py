"""The ideal two-stroke engine cycle: work, pressures, sign of the delivered work, refusals, job file."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.engine import Engine
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import average_torque
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
    """Positive whichever way the crank turns: p_h V_c (1 - r^(1 - n)) / (n - 1) less the same of compression."""
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
    assert average_torque(machine, design).mean[0] * machine.speed < 0.0


def test_the_gas_reaches_its_peak_pressure_after_the_top_and_the_intake_pressure_before_compression() -> None:
    machine, linkage = Mechanism(speed=300.0, loads=(engine(),)), Linkage(0.027, 0.1, 0.004)
    bottom, top = linkage.dead_centre_angles
    area, after = 0.25 * math.pi * 0.054**2, 1e-7
    load = cycle(machine, linkage, np.array([top - after, top + after, bottom - after, bottom + after])).load
    pressures = 101_325.0 - load / area
    wanted = [1e5 * 8.0**1.3, 40e5, 40e5 / 8.0**1.3, 1e5]
    assert pressures == pytest.approx(wanted, rel=1e-9)


def test_heat_gives_the_pressure_of_an_ideal_gas_at_constant_volume() -> None:
    """The heat per swept volume is c_v times the rise of p V: 1.2 MJ/m^3 on a clearance of a seventh."""
    load = engine(peak_pressure=0.0, heat="1.2 MJ/m^3", heat_capacity_ratio=1.35)
    rise = load.high - 1e5 * 8.0**1.3
    assert rise / (1.35 - 1.0) / 7.0 == pytest.approx(1.2e6, rel=1e-13)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"peak_pressure": "10 bar"}, r"exceed that of compression alone, 14\.9285 bar; got 10 bar"),
        ({"heat": "1 MJ/m^3"}, "either a peak pressure or heat; got both"),
        ({"peak_pressure": "0 bar"}, "either a peak pressure or heat; got neither"),
        ({"compression_ratio": 1}, "compression ratio must exceed 1; got 1"),
        (
            {"peak_pressure": "16 bar", "expansion_exponent": 1.39},
            "not expand below its intake pressure, 1 bar; got 0.8",
        ),
        ({"bore": 0}, "bore: must be positive"),
        ({"intake": "-1 bar"}, "intake: must be positive"),
    ],
)
def test_an_impossible_engine_is_refused_with_what_and_how_much(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        engine(**wrong)


def test_an_engine_has_no_volumetric_efficiency() -> None:
    with pytest.raises(InputError, match="compressor or pump; got none"):
        parse_job({**JOB, "objectives": {"volumetric_efficiency": "maximise"}})
