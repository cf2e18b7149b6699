"""Random machines of every sort that questions are asked of, as jobs, and designs in their ranges."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Sequence
from typing import Any

import numpy as np

import slidercrank as sc
from tests.doors.scripts import JOBS
from tests.service import sized

Random = np.random.Generator
SORTS = ("turn", "engine", "cylinders", "loose", "sized", "swing")
"""A press with friction, four strokes (720 deg), two cylinders with a speed profile, a motor, bars, a swing."""


def some_tables(sort: str, random: Random) -> dict[str, Any]:
    """Return the job of a machine with a speed and masses of its own."""
    tables = sized.TABLES if sort == "sized" else tomllib.loads((JOBS / f"{sort}.toml").read_text(encoding="utf-8"))
    tables = {key: table for key, table in json.loads(json.dumps(tables)).items() if key != "constraints"}
    tables.pop("clearance", None)  # its simulation takes 15 s
    tables["variables"].pop("mechanism.slider.mass", None)
    mechanism = tables["mechanism"]
    if sort != "swing":
        speed, unit = mechanism["speed"].split()
        mechanism["speed"] = f"{float(speed) * random.uniform(0.3, 1.3):.6g} {unit}"
    mechanism["slider"] = {**mechanism["slider"], "mass": f"{random.uniform(0.1, 9.0):.6g} kg"}
    mechanism["counterweight"] = {"mass": f"{random.uniform(0.1, 3.0):.4g} kg", "radius": "41.3 mm"}
    if random.random() < 0.3 and sort in ("turn", "loose"):
        mechanism["slider"] |= {"touch_distance": "7.3 mm", "dwell_distance": "1.7 mm"}
    return tables


def some_problem(sort: str, random: Random) -> sc.Problem:
    """Return the problem of such a job."""
    return sc.problem(some_tables(sort, random), require_feasible=False)


def linkage_of(problem: sc.Problem, design: Sequence[float]) -> sc.Linkage:
    """Return the linkage of a design, on the branch of its problem."""
    return sc.Linkage(design[0], design[1], design[2], problem.mechanism.nominal.branch)


def some_design(problem: sc.Problem, random: Random) -> list[float]:
    """Return a design within the ranges that rotates fully, or swings; lengths agree in mm, m and text."""
    for _ in range(1000):
        lengths = [round(8e3 * random.uniform(ends.lower, ends.upper)) / 8.0 for ends in problem.ranges.values()]
        design = [length / 1e3 for length in lengths]
        linkage = linkage_of(problem, design)
        if problem.motion is None and linkage.rotates_fully and linkage.least_transmission_angle > 0.2:
            return design
        if problem.motion is not None and np.isfinite(problem.evaluate([design])).all():
            return design
    raise AssertionError("no design of the ranges turns or swings")
