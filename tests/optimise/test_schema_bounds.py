"""Bounds of the JSON Schema are those of the model, at the bound and on both sides of it."""

from __future__ import annotations

import importlib
import math
import pkgutil
from typing import Any

import numpy as np
import pytest
from pydantic import BaseModel, ValidationError

import slidercrank.optimise.job as package
from slidercrank.model.errors import InputError
from slidercrank.optimise.job import job_schema
from slidercrank.optimise.job.loads import PARTS

Node = dict[str, Any]
WORDS = {"minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum"}
DEFS: dict[str, Node] = job_schema()["$defs"]
NAMES = [f"{package.__name__}.{item.name}" for item in pkgutil.iter_modules(package.__path__)]
CLASSES: dict[str, type[BaseModel]] = {
    one.__name__: one
    for module in map(importlib.import_module, NAMES)
    for one in vars(module).values()
    if isinstance(one, type) and issubclass(one, BaseModel)
} | {part.__name__: part for part in PARTS.values()}
GIVEN: dict[str, Node] = {
    "ArmPart": {"ram": "500 mm"},
    "ChoicePart": {"file": None, "option": [{"name": "a"}, {"name": "b"}]},
    "DrivePart": {"rated_torque": "5 N m"},
    "EngineLoad": {"peak_pressure": "40 bar"},
    "MechanismPart": {"gravity": "9.81 m/s^2"},
    "MotionPart": {"kind": "swing", "from": "0 deg", "to": "60 deg", "duration": "1 s", "law": "harmonic"},
}
"""What a table needs besides the examples of its required keys."""
CYLINDERS = ("Compressor", "Engine", "PressureAngle", "PressurePosition")
TOGETHER = {
    *(("CylinderPart", key) for key in ("closed_length", "stroke", "bore", "rod", "supply_pressure")),
    ("ClearancePart", "radial_clearance"),
    ("ClearancePart", "journal_radius"),
    *(("CompressorLoad", key) for key in ("suction", "discharge", "clearance", "clearance_volume")),
    *(("EngineLoad", key) for key in ("intake", "exhaust", "peak_pressure", "heat", "compression_ratio")),
    *(("EngineLoad", key) for key in ("compression_exponent", "expansion_exponent")),
    *((f"{load}Load", key) for load in CYLINDERS for key in ("piston_rod", "bore")),
    *(
        ("MotionPart", key)
        for key in (
            "from",
            "to",
            "swing",
            "duration",
            "actuator_tolerance",
            "slider_from",
            "slider_to",
            "slider_travel",
        )
    ),
    *(("MaterialPart", key) for key in ("yield_strength", "ultimate_strength", "endurance")),
    *(("RatedMotor", key) for key in ("rated_speed", "no_load_speed")),
    ("RobustPart", "share"),
    ("RobustPart", "samples"),
    ("SectionsPart", "width"),
    ("SectionsPart", "depth"),
}
"""Keys whose values another value of the table limits too, so that a value within the bounds may be refused."""


def numbers() -> list[tuple[str, str, Node]]:
    """Return table, key and node of every number with a bound, except in load files: these are read first."""
    return [
        (table, key, one)
        for table, node in DEFS.items()
        for key, of in (node.get("properties", {}).items() if table in CLASSES and table != "FileLoad" else ())
        for one in (of, *of.get("anyOf", []))
        if one.get("type") in ("number", "integer") and WORDS & set(one)
    ]


def within(node: Node, value: float) -> bool:
    """Return whether the schema takes a number."""
    return not (
        value < node.get("minimum", -math.inf)
        or value <= node.get("exclusiveMinimum", -math.inf)
        or value > node.get("maximum", math.inf)
        or value >= node.get("exclusiveMaximum", math.inf)
    )


def takes(table: str, key: str, value: float) -> bool:
    """Return whether the model takes a number, with the examples of what else the table needs."""
    part = DEFS[table]
    needed = {name: part["properties"][name]["examples"][0] for name in part.get("required", [])}
    try:
        CLASSES[table].model_validate(needed | GIVEN.get(table, {}) | {key: value})
    except (ValidationError, InputError):
        return False
    return True


def near(node: Node) -> list[float]:
    """Return random numbers at, just inside and just outside the bounds of a node, and others within."""
    random = np.random.default_rng(5)
    ends = [float(node[word]) for word in sorted(WORDS & set(node))]
    if node["type"] == "integer":
        return [end + step for end in ends for step in (-1, 0, 1)]
    steps = 10.0 ** random.uniform(-9.0, -6.0, 2)
    return [end + sign * step * max(1.0, abs(end)) for end in ends for step in (0.0, *steps) for sign in (-1.0, 1.0)]


@pytest.mark.parametrize("table", sorted({table for table, _, _ in numbers()}))
def test_schema_and_model_agree_on_every_bound(table: str) -> None:
    for of, key, node in numbers():
        for value in near(node) if of == table else ():
            given = int(value) if node["type"] == "integer" else value
            if not within(node, value):
                assert not takes(table, key, given), (key, value)
            elif (table, key) not in TOGETHER:
                assert takes(table, key, given), (key, value)


def test_bounds_that_examples_of_the_guide_name_are_stated() -> None:
    stated = {(table, key): node for table, key, node in numbers()}
    assert len(stated) > 80
    assert stated["SectionsPart", "eye_concentration"]["minimum"] == 1.0
    assert "exclusiveMinimum" not in stated["SectionsPart", "eye_concentration"]
    assert stated["ClearancePart", "poisson"]["maximum"] == 0.5
    assert stated["EngineLoad", "compression_ratio"]["exclusiveMinimum"] == 1.0
    assert stated["TolerancesPart", "crank_angle"]["maximum"] == 1e4  # rad: beyond any machine
