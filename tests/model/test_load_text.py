"""The sentence of a load: size, sign, effect and range, against forces and works of the tests' own model."""

from __future__ import annotations

import re
from typing import Any, Final

import numpy as np
import pytest

from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.crank_torque import CrankTorque, CrankTorqueTable
from slidercrank.model.machine.loads.drag import Drag
from slidercrank.model.machine.loads.load import Load
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from tests.model.virtual_work import load_force, outward_motion, path, stroke_ends

_VERBS = "partly helps and partly resists|helps|resists"
OUTER: Final = "outer dead centre"
OUTWARD: Final = "outward stroke"


@pytest.mark.parametrize(
    ("load", "words"),
    [
        (
            PositionTable(positions=(0.0, 0.06), forces=(350.0, 350.0), datum=OUTER, during=OUTWARD),
            "350 N outward, helps the outward stroke, from 60 mm before the outer dead centre to it; "
            "constant beyond, hence everywhere",
        ),
        (
            PositionTable(
                positions=(0.0, 0.001, 0.01, 0.012), forces=(-14e3, -20e3, -20e3, 0.0), datum=OUTER, during=OUTWARD
            ),
            "up to 20000 N inward, resists the outward stroke, from 12 mm before the outer dead centre to it; zero "
            "beyond",
        ),
        (
            PositionTable(positions=(0.0, 0.06, 0.06), forces=(350.0, 350.0, 0.0), datum=OUTER, during="inward stroke"),
            "350 N outward, resists the inward stroke, from the outer dead centre to 60 mm after it; zero beyond",
        ),
        (
            PositionTable(positions=(0.1, 0.2), forces=(-100.0, -300.0)),
            "100 to 300 N inward, resists the outward stroke and helps the inward stroke, no net work over a cycle, "
            "between 100 mm and 200 mm from the crank pivot; 100 N inward nearer and 300 N inward beyond",
        ),
        (StrokeForce(outward=-80.0, inward=80.0), "80 N, resists both strokes, throughout"),
        (StrokeForce(outward=0.0, inward=-80.0), "80 N inward, helps the inward stroke, throughout"),
        (
            StrokeForce(outward=-80.0, inward=60.0),
            "80 N inward on the outward and 60 N outward on the inward stroke, resists both strokes, throughout",
        ),
        (
            StrokeForce(outward=50.0, inward=50.0),
            "50 N outward, helps the outward stroke and resists the inward stroke, no net work over a cycle, "
            "throughout",
        ),
        (
            AngleTable(angles=(0.0, np.pi / 2), forces=(0.0, -100.0), datum=OUTER),
            "up to 100 N inward, helps inward and resists outward motion, from 0 to 90 deg after the outer dead "
            "centre; periodic over 360 deg",
        ),
        (
            CrankTorque(torque=-50.0),
            "50 N m clockwise on the crank, helps clockwise and resists counter-clockwise rotation",
        ),
        (
            CrankTorqueTable(angles=(0.0, np.pi), forces=(20.0, -5.0)),
            "5 N m clockwise to 20 N m counter-clockwise on the crank, helps or resists depending on the crank angle, "
            "from 0 to 180 deg of crank angle; periodic over 360 deg",
        ),
        (Viscous(coefficient=10.0), "viscous, 10 N s/m, resists both strokes, proportional to the speed"),
        (StrokeForce(outward=0.0, inward=0.0), "0 N, no effect, throughout"),
    ],
)
def test_a_load_says_its_size_sign_effect_and_range(load: Load, words: str) -> None:
    assert load.text == words


def test_a_load_that_varies_says_its_range() -> None:
    random = np.random.default_rng(36)
    for _ in range(50):
        least, most = sorted(float(f"{force:.4g}") for force in random.uniform(1.0, 900.0, 2))
        force = Varying(name="force", sets=(("loads.1.outward", -1.0),), lower=least, upper=most)
        soft = Varying(name="stiffness", sets=(("loads.0.stiffness", 1.0),), lower=10.0 * least, upper=10.0 * most)
        loads = (Spring(stiffness=5000.0, free_position=0.1), StrokeForce(outward=-350.0, inward=0.0))
        spring, resistance = Mechanism(speed=9.0, loads=loads, varying=(force, soft)).load_texts
        assert resistance == f"{least:.6g} to {most:.6g} N inward, resists the outward stroke, throughout"
        assert spring.startswith(f"spring {10.0 * least:.6g} to {10.0 * most:.6g} N/m, free at 100 mm from the")
    turned = Varying(name="force", sets=(("loads.1.outward", 1.0),), lower=-200.0, upper=100.0)
    assert Mechanism(speed=9.0, loads=loads, varying=(turned,)).load_texts[1] == (
        "200 N inward, resists the outward stroke, throughout; at the other end of the range 100 N outward, helps the "
        "outward stroke, throughout"
    )
    assert Mechanism(loads=loads).load_texts == [load.text for load in loads]


def random_load(random: np.random.Generator) -> Load:
    """Return a load on the slider of any kind and sign."""
    forces = random.uniform(-400.0, 400.0, 3) * random.integers(0, 2, 3)
    forces = [np.abs(forces), -np.abs(forces), forces][random.integers(3)]
    force = tuple(forces.tolist())
    during = random.choice(["cycle", "outward stroke", "inward stroke"]).item()
    kind = random.integers(6)
    if kind == 0:
        return StrokeForce(outward=force[0], inward=force[1])
    if kind == 1:
        return Spring(stiffness=random.uniform(100.0, 2000.0), free_position=random.uniform(-0.1, 0.3))
    if kind == 2:
        return Viscous(coefficient=random.uniform(1.0, 50.0))
    if kind == 3:
        return Drag(drag=random.uniform(1.0, 50.0))
    if kind == 4:
        return AngleTable(angles=tuple(np.sort(random.uniform(0.0, 6.0, 3)).tolist()), forces=force, during=during)
    return PositionTable(
        positions=tuple((random.integers(0, 2) * 0.01 + np.cumsum([0.0, *random.uniform(0.001, 0.05, 2)])).tolist()),
        forces=force,
        datum=random.choice(["crank pivot", "inner dead centre", "outer dead centre"]).item(),
        during=during,
    )


def test_the_effect_of_random_loads_is_the_sign_of_their_power_in_each_stroke_of_random_machines() -> None:
    random = np.random.default_rng(35)
    theta = 2.0 * np.pi * (np.arange(2000) + 0.5) / 2000
    counted: dict[str, int] = {}
    for _ in range(300):
        load = random_load(random)
        crank, offset = random.uniform(0.02, 0.1), random.uniform(-0.1, 0.1)
        design = np.array([crank, (crank + abs(offset)) * random.uniform(1.05, 3.0), offset])
        machine = Mechanism(speed=float(random.choice([-9.0, 9.0])), branch=random.choice(["open", "crossed"]).item())
        at = path(design, theta, 1.0 if machine.branch == "open" else -1.0)
        position, velocity, outward = outward_motion(machine, at)
        force = load_force(load, position, velocity, outward, theta, stroke_ends(design))
        power = force * velocity
        noise = 1e-9 * np.abs(power).max()
        for stroke, during in (("outward", outward), ("inward", ~outward)):
            gives, takes = (power[during] > noise).any(), (power[during] < -noise).any()
            found = re.search(rf"({_VERBS}) (?:both strokes|the {stroke} stroke)", load.effect_text)
            if found is None and load.possible_stroke_forces is None:  # by direction, below, or a spring
                continue
            said = found[1] if found else ""
            assert not gives or "helps" in said, load.text
            assert not takes or "resists" in said, load.text
            counted[said] = counted.get(said, 0) + 1
        if "helps outward and resists inward motion" in load.effect_text:
            assert (force >= 0.0).all()
            assert force.any()
        if "helps inward and resists outward motion" in load.effect_text:
            assert (force <= 0.0).all()
            assert force.any()
        gross = np.abs(power).sum()
        if "no net work" in load.effect_text:
            assert abs(power.sum()) <= 2e-3 * gross
        if isinstance(load, PositionTable) and force.any():
            _check_range(load, position, force, outward, stroke_ends(design))
    assert min(counted[verb] for verb in ("", *_VERBS.split("|"))) > 10


def _check_range(load: PositionTable, position: Any, force: Any, outward: Any, ends: tuple[Any, Any]) -> None:
    """Assert that the range and what holds beyond it, as the sentence has them, are those of the force."""
    found = re.fullmatch(r"(?:from|between|within) (?P<range>.*); (?P<beyond>.*?) beyond", load.range_text)
    assert found is not None, load.range_text
    datum = next(name for name in ("crank pivot", "inner dead centre", "outer dead centre") if name in load.range_text)
    counted = {
        "crank pivot": position,
        "inner dead centre": position - ends[0],
        "outer dead centre": ends[1] - position,
    }
    far = max(float(number) for number in re.findall(r"([\d.e-]+) mm", found["range"])) * 1e-3
    acting = (
        outward if load.during == "outward stroke" else ~outward if load.during == "inward stroke" else outward | True
    )
    beyond = force[acting & (counted[datum] > far * (1.0 + 1e-5))]
    said = found["beyond"].rsplit(" and ", 1)[-1]
    if said == "zero":
        assert not beyond.any()
    elif said == "constant":
        assert np.allclose(force[acting], load.forces[0])
    else:
        size, way = re.fullmatch(r"([\d.e-]+) N (\w+)", said).groups()  # type: ignore[union-attr]
        assert np.allclose(beyond, float(size) * (1.0 if way == "outward" else -1.0), rtol=1e-5)
