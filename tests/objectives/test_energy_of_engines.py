"""Work per cycle of engines, compressors and pumps with one and two turns, by integrating p dV.

Pressures, volumes and the integral over the crank angle are the tests' own. With friction alone between gas and crank,
the work of the gas over one cycle equals the work that the crank delivers plus the losses in the joints.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

import slidercrank as sc
from slidercrank.model.cycle.cycle import cycle_energies
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction, Pin
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.loads.crank_torque import CrankTorque
from slidercrank.model.machine.loads.cylinder import Cylinder
from slidercrank.model.machine.loads.engine import Engine, FourStroke
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import Array

BORE = 0.08
RUBBING = Friction(
    guide=0.06,
    crank_pivot=Pin(radius=0.02, coefficient=0.02),
    crank_pin=Pin(radius=0.02, coefficient=0.03),
    slider_pin=Pin(radius=0.01, coefficient=0.04),
)


def value(name: str, machine: Mechanism, design: Array) -> float:
    return float(QUANTITIES[name].evaluate(machine, design[None]).values[0])


def engine(random: np.random.Generator) -> tuple[Cylinder, list[Callable[[float, float], float]]]:
    """Return an engine of two strokes, and its pressure over volume and stroke volume, down and up."""
    ratio, up, down, low = random.uniform(6.0, 16.0), random.uniform(1.1, 1.4), random.uniform(1.1, 1.4), 0.9e5
    high = low * ratio**1.4 * random.uniform(1.5, 4.0)
    own = {"bore": BORE, "low": low, "high": high, "clearance": 1.0 / (ratio - 1.0)}
    load = Engine(**own, compression_exponent=up, expansion_exponent=down)
    return load, [
        lambda v, swept: high * (swept / (ratio - 1.0) / v) ** down,
        lambda v, swept: low * (swept * ratio / (ratio - 1.0) / v) ** up,
    ]


def four_strokes(random: np.random.Generator) -> tuple[Cylinder, list[Callable[[float, float], float]]]:
    """Return an engine of four strokes, and the pressures of expansion, exhaust, intake and compression."""
    two, (down, up) = engine(random)
    own = {name: getattr(two, name) for name in ("bore", "low", "high", "clearance")}
    exponents = {name: getattr(two, name) for name in ("compression_exponent", "expansion_exponent")}
    load = FourStroke(**own, **exponents, exhaust=1.2e5)
    return load, [down, lambda v, swept: 1.2e5, lambda v, swept: 0.9e5, up]


def compressor(random: np.random.Generator) -> tuple[Cylinder, list[Callable[[float, float], float]]]:
    """Return a compressor, and its pressure while the piston moves down and up."""
    clearance, low, high, n = random.uniform(0.03, 0.08), 1e5, random.uniform(4e5, 9e5), random.uniform(1.1, 1.4)
    own: dict[str, Any] = {"bore": BORE, "low": low, "high": high, "clearance": clearance}
    return Compressor(**own, compression_exponent=n, expansion_exponent=n), [
        lambda v, swept: max(low, high * (clearance * swept / v) ** n),
        lambda v, swept: min(high, low * ((1.0 + clearance) * swept / v) ** n),
    ]


def pump(random: np.random.Generator) -> tuple[Cylinder, list[Callable[[float, float], float]]]:
    """Return a pump of a liquid, and its pressure while the piston moves down and up."""
    own: dict[str, Any] = {"bore": BORE, "low": 1e5, "high": random.uniform(4e5, 30e5)}
    load = Compressor(**own, compression_exponent=0.0, expansion_exponent=0.0)
    return load, [lambda v, swept: load.low, lambda v, swept: load.high]


def gas_work(load: Cylinder, pressures: list[Callable[[float, float], float]], linkage: Linkage) -> float:
    """Return the integral of p dV over the strokes of the cycle, from the piston's top on."""
    top, bottom = (
        float(angle) for angle in linkage.dead_centre_angles[::-1]
    )  # outer, inner: the head is at the outer one
    reach, area = float(linkage.at(top).slider_position), 0.25 * math.pi * BORE**2
    swept = area * float(linkage.stroke)

    def rate(theta: float, pressure: Callable[[float, float], float]) -> float:
        r, l, e = (float(part) for part in (linkage.crank, linkage.rod, linkage.offset))
        across = e - r * math.sin(theta)
        along = math.sqrt(l**2 - across**2)
        moved = -r * math.sin(theta) + r * math.cos(theta) * across / along
        volume = load.clearance * swept + area * (reach - r * math.cos(theta) - along)
        return pressure(volume, swept) * -area * moved

    down = (bottom - top) % (2.0 * math.pi)
    total = 0.0
    for number, pressure in enumerate(pressures):
        span = (top, top + down) if number % 2 == 0 else (top + down, top + 2.0 * math.pi)
        total += quad(rate, *span, args=(pressure,), epsabs=1e-11, epsrel=1e-11, limit=400)[0]
    return float(total)


@pytest.mark.parametrize("kind", [engine, four_strokes, compressor, pump])
@pytest.mark.parametrize("seed", range(3))
def test_works_of_a_cycle_have_one_basis_and_are_integrals_of_pressure_over_volume(kind: Any, seed: int) -> None:
    random = np.random.default_rng(400 + seed)
    load, pressures = kind(random)
    machine = Mechanism(speed=50.0, slider_mass=0.5, loads=(load,), friction=RUBBING)
    crank = random.uniform(0.03, 0.05)
    design = np.array([crank, crank * random.uniform(3.0, 4.5), crank * random.uniform(-0.2, 0.2)])
    linkage = Linkage(*design)
    wanted = gas_work(load, pressures, linkage)
    names = ("indicated_work", "delivered_work", "energy_per_cycle", "friction_loss")
    works = {name: value(name, machine, design) for name in names}
    assert works["indicated_work"] == pytest.approx(wanted, rel=1e-9)
    assert works["indicated_work"] == pytest.approx(works["delivered_work"] + works["friction_loss"], rel=1e-9)
    assert works["energy_per_cycle"] == -works["delivered_work"]
    swept = value("displacement_volume", machine, design)
    assert value("mean_effective_pressure", machine, design) == pytest.approx(wanted / swept, rel=1e-9)
    turns = len(pressures) // 2
    power = value("mean_power", machine, design)
    assert power == pytest.approx(works["energy_per_cycle"] * 50.0 / (2.0 * math.pi * turns), rel=1e-12)
    found = cycle_energies(machine, linkage)
    assert (-found.useful, -found.input, found.heat) == pytest.approx(
        (wanted, works["delivered_work"], works["friction_loss"]), rel=1e-9
    )
    share = works["delivered_work"] / wanted
    efficiency = value("efficiency", machine, design)
    assert efficiency == pytest.approx(share if wanted > 0.0 else 1.0 / share, rel=1e-9)
    assert found.efficiency == pytest.approx(efficiency, rel=1e-9)
    assert 0.5 < efficiency < 1.0


def test_efficiency_is_continuous_from_a_driven_machine_to_one_that_drives_and_zero_where_friction_takes_all() -> None:
    """A force that changes its sign: U runs through zero, and H, of a heavy slider, hardly changes."""
    design, stroke = np.array([0.05, 0.2, 0.01]), float(Linkage(0.05, 0.2, 0.01).stroke)
    machine = Mechanism(speed=5.0, slider_mass=20.0, gravity=(0.0, -9.81), friction=Friction(guide=0.2))
    found = {}
    for force in (-400.0, -1.0, -1e-6, 1e-6, 1.0, 19.0, 21.0, 400.0):
        own = replace(machine, loads=(StrokeForce(outward=force, inward=-force),))
        useful, heat = -2.0 * force * stroke, value("friction_loss", own, design)
        given, taken = (useful + heat, useful) if useful > 0.0 else (-useful, max(0.0, -useful - heat))
        found[force] = value("efficiency", own, design)
        assert found[force] == pytest.approx(taken / given, rel=1e-9)
        assert cycle_energies(own, Linkage(*design)).efficiency == pytest.approx(found[force], rel=1e-7)
    assert found[1e-6] == found[1.0] == 0.0
    assert 0.0 < found[-1e-6] < 1e-6
    assert found[400.0] > 0.5


def test_gradients_of_the_efficiency_of_machines_that_drive_are_those_of_differences() -> None:
    quantity, random = QUANTITIES["efficiency"], np.random.default_rng(77)
    for kind in (engine, four_strokes):
        for extra in ((), (CrankTorque(resistance=3.0),)):
            machine = Mechanism(speed=50.0, slider_mass=0.5, loads=(kind(random)[0], *extra), friction=RUBBING)
            design = np.array([0.04, 0.15, 0.004])
            slopes = quantity.evaluate(machine, design[None], gradients=True).gradients
            assert slopes is not None
            for column in range(3):
                step = 1e-6 * (np.arange(3) == column)
                differences = (
                    value("efficiency", machine, design + step) - value("efficiency", machine, design - step)
                ) / 2e-6
                # Differences of second order with a step of 1e-6 m: rounding and their own error are near 1e-7.
                assert slopes[0, column] == pytest.approx(differences, rel=1e-5, abs=1e-6)


JOB: dict[str, Any] = {
    "name": "Engine",
    "mechanism": {"speed": "3000 rpm", "slider": {"mass": "0.5 kg"}},
    "load": [
        {
            **{"bore": "86 mm", "compression_ratio": 10, "intake": "0.9 bar", "peak_pressure": "55 bar"},
            **{"exhaust": "1.1 bar", "cycle": "720 deg"},
        }
    ],
    "friction": {"guide": 0.05, "crank_pin": {"coefficient": 0.02, "radius": "20 mm"}},
    "variables": {"crank": "43 mm", "rod": ["120 mm", "180 mm"], "offset": "0 mm"},
    "objectives": {"efficiency": "maximise"},
    "optimiser": {"method": "random", "evaluations": 32},
}


def test_a_job_finds_the_engine_of_greatest_efficiency() -> None:
    front = sc.solve(sc.problem(JOB))
    table = front.designs
    best = table["efficiency"].to_numpy()
    assert len(best) == 1
    assert 0.9 < best[0] < 1.0
    assert best == pytest.approx((table["delivered_work_J"] / table["indicated_work_J"]).to_numpy(), rel=1e-9)


def test_a_quotient_of_works_is_refused_before_the_run_with_what_serves_instead() -> None:
    for below in ("indicated_work", "delivered_work", "energy_per_cycle"):
        ratio = {"formula": f"friction_loss / {below}"}
        wrong = {**JOB, "quantity": {"ratio": ratio}, "objectives": {"ratio": "minimise", "footprint": "minimise"}}
        with pytest.raises(InputError, match=rf"got {below} as a divisor, .*; use efficiency instead: work output"):
            sc.problem(wrong)
