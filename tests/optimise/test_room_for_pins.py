"""Bars that no pin fits are told before a search, and only these."""

from __future__ import annotations

import tomllib
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import parse_job

PRESS: dict[str, Any] = tomllib.loads((Path(__file__).parents[2] / "runs/press.toml").read_text(encoding="utf-8"))
NUMBERS = (
    *("mechanism.rod.width", "mechanism.crank.width"),
    *("sections.pins.crank_pin", "sections.pins.slider_pin", "sections.pins.crank_pivot"),
)
EYES = {"rod": ("crank_pin", "slider_pin"), "crank": ("crank_pin", "crank_pivot")}


def press(bounds: dict[str, tuple[int, int]], asked: str = "static_safety") -> dict[str, Any]:
    """Return the shipped press with widths and pins, mm, that vary between two ends or are held where these agree."""
    job = deepcopy(PRESS)
    del job["choice"]
    job["constraints"] = {asked: {"min": 1.0}}
    job["variables"] = {name: job["variables"][name] for name in ("crank", "rod", "offset")}
    for path, (low, high) in bounds.items():
        part, name, number = path.split(".")
        job[part][name][number] = f"{low} mm"
        if low < high:
            job["variables"].setdefault(part, {}).setdefault(name, {})[number] = [f"{low} mm", f"{high} mm"]
    return job


def test_a_job_is_refused_where_no_design_has_room_for_a_pin_and_only_there() -> None:
    random = np.random.default_rng(8)
    refused = 0
    for _ in range(60):
        bounds: dict[str, tuple[int, int]] = {}
        for name in NUMBERS:
            low = int(random.integers(20, 80) if name.startswith("mechanism") else random.integers(5, 60))
            bounds[name] = (low, low + int(random.choice([0, 10])))
        tight = [
            (link, pin)
            for link, pins in EYES.items()
            for pin in pins
            if bounds[f"sections.pins.{pin}"][0] >= bounds[f"mechanism.{link}.width"][1]
        ]
        if tight:
            refused += 1
            with pytest.raises(JobError, match="a bar must be wider than the pins in its eyes") as error:
                parse_job(press(bounds))
            assert any(f"mechanism.{link}.width" in str(error.value) and pin in str(error.value) for link, pin in tight)
        else:
            parse_job(press(bounds))
    assert 10 < refused < 50


def test_a_pin_that_is_as_thick_as_the_bar_is_refused_and_one_that_is_thinner_is_not() -> None:
    with pytest.raises(JobError, match=r"got 40 mm at most and sections\.pins\.crank_pin of 40 mm at least"):
        parse_job(press({"mechanism.rod.width": (40, 40), "sections.pins.crank_pin": (40, 40)}))
    parse_job(press({"mechanism.rod.width": (40, 40), "sections.pins.crank_pin": (39, 39)}))


def test_a_job_that_asks_for_no_eye_keeps_its_pins() -> None:
    """Buckling is of the bar between its eyes, which may be wider than it."""
    parse_job(press({"mechanism.rod.width": (40, 40), "sections.pins.crank_pin": (45, 45)}, asked="buckling_safety"))
