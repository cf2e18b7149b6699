"""The ideal four-stroke cycle: work, pressures of all strokes, derivatives, numbers that vary, refusals."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.cycle.gas_work import evaluate_on_gas_cycle, indicator_diagram
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.engine import Engine, FourStroke
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.job import parse_job

LOAD = {
    "bore": "86 mm",
    "compression_ratio": 10,
    "intake": "0.9 bar",
    "peak_pressure": "55 bar",
    "exhaust": "1.1 bar",
    "cycle": "720 deg",
}
JOB: dict[str, Any] = {
    "name": "engine",
    "mechanism": {"speed": "3000 rpm"},
    "load": [LOAD],
    "variables": {"crank": "43 mm", "rod": ["120 mm", "180 mm"], "offset": "0 mm"},
    "objectives": {"delivered_work": "maximise", "peak_guide_force": "minimise"},
}


def engine(**changed: Any) -> FourStroke:
    """Return the engine of the job with other entries."""
    (load,) = parse_job({**JOB, "load": [{**LOAD, **changed}]}).mechanism.loads
    assert isinstance(load, FourStroke)
    return load


@pytest.mark.parametrize("seed", range(12))
def test_the_work_is_that_of_two_polytropes_and_two_strokes_at_constant_pressure(seed: int) -> None:
    """Over the cycle of two turns; so is the mean effective pressure."""
    random = np.random.default_rng(seed)
    ratio, up, down = random.uniform(6.0, 18.0), random.uniform(1.1, 1.4), random.uniform(1.1, 1.3)
    low, bore, out = random.uniform(0.4e5, 2e5), random.uniform(0.03, 0.1), random.uniform(0.8e5, 1.5e5)
    high = low * ratio ** max(up, down) * random.uniform(1.3, 4.0)
    load = engine(
        bore=bore,
        compression_ratio=ratio,
        intake=low,
        exhaust=out,
        peak_pressure=high,
        compression_exponent=up,
        expansion_exponent=down,
        head=str(random.choice(["outer dead centre", "inner dead centre"])),
    )
    branch: Branch = "crossed" if seed % 3 == 0 else "open"
    machine = Mechanism(speed=float(random.choice([-200.0, 300.0])), loads=(load,), branch=branch)
    crank = random.uniform(0.02, 0.05)
    design = np.array([[crank, crank * random.uniform(2.5, 5.0), random.uniform(-0.5, 0.5) * crank]])
    swept = 0.25 * math.pi * bore**2 * float(Linkage(*design[0]).stroke)
    least = swept / (ratio - 1.0)
    gained = high * least * (1.0 - ratio ** (1.0 - down)) / (down - 1.0)
    spent = low * ratio**up * least * (1.0 - ratio ** (1.0 - up)) / (up - 1.0)
    whole = gained - spent + (low - out) * swept
    found = {
        name: QUANTITIES[name].evaluate(machine, design).values[0] for name in ("indicated_work", "delivered_work")
    }
    assert found["indicated_work"] == pytest.approx(whole, rel=1e-12)
    assert found["delivered_work"] == pytest.approx(whole, rel=1e-10)
    mean = QUANTITIES["mean_effective_pressure"].evaluate(machine, design).values[0]
    assert mean == pytest.approx(whole / swept, rel=1e-12)
    assert torque_averages(machine, design).mean[0] * machine.speed * whole < 0.0


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("head", ["outer dead centre", "inner dead centre"])
def test_the_strokes_follow_each_other(way: float, head: str) -> None:
    """From the dead centre away from the head: compression, burning, expansion, exhaust, intake."""
    load, linkage = engine(head=head), Linkage(0.043, 0.15, 0.008)
    machine = Mechanism(speed=300.0 * way, loads=(load,))
    inner, outer = linkage.dead_centre_angles
    bottom = outer if head == "inner dead centre" else inner
    bottom = bottom if way > 0.0 else bottom - 2.0 * math.pi * (bottom > 0.0)
    top = inner if head == "inner dead centre" else outer
    first = (way * (top - bottom)) % (2.0 * math.pi)
    after = 1e-7
    places = [after, first - after, first + after, 2 * math.pi - after, 2 * math.pi + after]
    places += [2 * math.pi + first - after, 2 * math.pi + first + after, 4 * math.pi - after]
    angles = bottom + way * np.array(places)
    area, sign = load.area, (-1.0 if head == "outer dead centre" else 1.0)
    pressures = load.back_pressure + sign * cycle(machine, linkage, angles).load / area
    wanted = [0.9e5, 0.9e5 * 10.0**1.3, 55e5, 55e5 / 10.0**1.3, 1.1e5, 1.1e5, 0.9e5, 0.9e5]
    start = 2 if pressures[0] > 1e5 else 0  # which of the two turns comes first follows from the angle of the bottom
    assert start == 0 or pressures[0] == pytest.approx(1.1e5)
    order = wanted if start == 0 else [*wanted[4:], *wanted[:4]]
    assert pressures == pytest.approx(order, rel=1e-6)
    assert indicator_diagram(machine, linkage, load, angles).pressure == pytest.approx(order, rel=1e-6)


def test_peaks_are_those_of_a_sweep_over_both_turns_and_gradients_those_of_differences() -> None:
    machine = replace(parse_job(JOB).mechanism, slider_mass=0.6, gravity=(-9.81, 0.0))
    design = np.array([[0.043, 0.15, 0.008]])
    dense = np.linspace(0.0, 4.0 * math.pi, 40_001)
    curves = cycle(machine, Linkage(*design[0]), dense)
    for kind, curve in ((Signal.TORQUE, curves.torque), (Signal.GUIDE_FORCE, curves.guide)):
        peak = find_peaks(machine, kind, design).values[0, 0]
        assert np.abs(curve).max() <= peak * (1.0 + 1e-12)
        assert np.abs(curve).max() == pytest.approx(peak, rel=1e-3)
    sets = {"bore": ("bore", 1.0), "peak": ("high", 1.0), "out": ("exhaust", 1.0), "in": ("low", 1.0)}
    varying = tuple(
        Varying(name=name, sets=((f"loads.0.{path}", factor),), lower=getattr(machine.loads[0], path), upper=high)
        for (name, (path, factor)), high in zip(sets.items(), (0.1, 60e5, 1.2e5, 0.95e5), strict=True)
    )
    free = replace(machine, varying=varying)
    at = np.hstack([design, [[0.09, 57e5, 1.15e5, 0.92e5]]])
    plain = free.with_values(at[0, 3:].tolist())
    for name in ("indicated_work", "mean_effective_pressure", "delivered_work", "peak_torque"):
        of = QUANTITIES[name]
        found = of.evaluate(free, at, gradients=True)
        assert found.gradients is not None
        assert found.values == pytest.approx(of.evaluate(plain, design).values, rel=1e-12)
        for column in range(at.shape[1]):
            step = 1e-5 * (at[0, column] or 1.0) * (np.arange(at.shape[1]) == column)
            up, down = (of.evaluate(free, at + sign * step).values[0] for sign in (1.0, -1.0))
            slope = (up - down) / (2.0 * step.sum())
            size = max(abs(slope), abs(found.values[0] / at[0, column]) * 1e-3)
            assert found.gradients[0, column] == pytest.approx(slope, abs=1e-6 * size), (name, column)


def test_several_cylinders_share_a_crankshaft_and_one_of_two_strokes_keeps_its_own_cycle() -> None:
    """Beside a two-stroke one, whose work comes every turn, the four-stroke one has its own once in two."""
    four = engine()
    own = {name: getattr(four, name) for name in ("bore", "low", "high", "clearance")}
    two = Engine(**own, compression_exponent=1.3, expansion_exponent=1.3)
    design = np.array([[0.043, 0.15, 0.0]])
    work, cycles = (
        [
            evaluate_on_gas_cycle(Mechanism(speed=300.0, loads=loads), design, of)[0][0]
            for loads in ((four,), (two,), (four, two))
        ]
        for of in (lambda gas: gas.work, lambda gas: gas.cycle_work)
    )
    assert work[2] == pytest.approx(work[0] + 2.0 * work[1], rel=1e-12)
    assert cycles[2] == pytest.approx(work[0] + work[1], rel=1e-12)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"cycle": "360 deg"}, "exhaust pressure needs a four-stroke cycle"),
        ({"exhaust": "-1 bar"}, "exhaust: an absolute pressure must be at or above vacuum, 0"),
        ({"peak_pressure": "10 bar"}, "exceed that of compression alone"),
        ({"cycle": "1080 deg"}, 'must be "360 deg" or "720 deg"'),
    ],
)
def test_an_impossible_engine_is_refused(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        engine(**wrong)


def test_the_exhaust_is_at_the_back_pressure_where_it_is_left_out() -> None:
    assert engine(exhaust=0).exhaust == pytest.approx(101_325.0)
    assert engine(exhaust=0, back_pressure="1.2 bar").exhaust == pytest.approx(1.2e5)
