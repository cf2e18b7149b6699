"""A press, a pusher with six gearmotors and a sieve with an exact stroke, from nothing to a rounded design.

At the command line, in Python and over the API. What each door gives is judged here by formulas of textbooks: the
position of the slider, x = r cos + sqrt(l^2 - (e - r sin)^2), and virtual work on a grid of crank angles.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import slidercrank as sc
from slidercrank.service.jobs.job_toml import job_toml
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.case_count import in_turn
from tests.service.api.fixed_front import API, client_of
from tests.service.conftest import Command

Row = dict[str, Any]
SEARCH = {"designs": 4, "samples": 128, "seed": 35}
ANGLES = np.linspace(0.0, 2.0 * np.pi, 7200, endpoint=False)
MOTORS = {"GM 150": (150, 830), "GM 30": (30, 280), "GM 45": (45, 340), "GM 60": (60, 430), "GM 80": (80, 520)}
MOTORS |= {"GM 110": (110, 660)}
"""Greatest torque, N m, and price, EUR, in the order of the maker's list."""
CATALOGUE = "name;Peak torque (N m);price (EUR)\n" + "".join(f"{n};{t};{p}\n" for n, (t, p) in MOTORS.items())

ENDS = (("min", "0"), ("max", "inf"))
ALONE = {"objectives": {"peak_torque": "minimise", "transmission_angle": "maximise"}}
"""What is judged of a machine without its choices."""


@dataclass(frozen=True)
class Story:
    """A machine. force: N, against each motion or against the outward one. allow: a miss of the stroke, mm."""

    tables: dict[str, Any]
    force: float
    mass: float
    rpm: float
    steps: dict[str, float]
    inward: bool = True
    allow: float = 0.0
    files: dict[str, str] = field(default_factory=dict)


STORIES = {
    "press": Story(
        {
            "name": "Press for bushings",
            "mechanism": {"speed": "-30 rpm", "slider": {"mass": "12 kg"}},
            "load": [{"force": "5 kN", "opposes": "outward stroke"}],
            "variables": {"crank": ["25 mm", "60 mm"], "rod": ["120 mm", "400 mm"], "offset": ["10 mm", "60 mm"]},
            "constraints": {
                "stroke": {"min": "80 mm", "max": "84 mm"},
                "transmission_angle": {"min": "50 deg"},
                "slow_stroke": "outward",
            },
            "objectives": {"peak_torque": "minimise", "time_ratio": "maximise"},
        },
        force=5000.0,
        mass=12.0,
        rpm=-30.0,
        steps={"crank": 0.5, "rod": 1.0, "offset": 1.0},
        inward=False,
    ),
    "pusher": Story(
        {
            "name": "Pusher",
            "mechanism": {"speed": "60 rpm", "slider": {"mass": "4 kg"}},
            "load": [{"force": "300 N", "opposes": "motion"}],
            "variables": {"crank": ["40 mm", "220 mm"], "rod": ["300 mm", "700 mm"], "offset": ["0 mm", "60 mm"]},
            "constraints": {"stroke": {"min": "120 mm"}, "transmission_angle": {"min": "45 deg"}},
            "choice": [{"name": "gearmotor", "file": "gearmotors.csv"}],
            "objectives": {"price": "minimise", "stroke": "maximise"},
        },
        force=300.0,
        mass=4.0,
        rpm=60.0,
        steps={"crank": 1.0, "rod": 1.0, "offset": 1.0},
        files={"gearmotors.csv": CATALOGUE},
    ),
    "sieve": Story(
        {
            "name": "Sieve",
            "mechanism": {"speed": "300 1/min", "slider": {"mass": "1.95 kg"}},
            "load": [{"force": "60 N", "opposes": "motion"}],
            "variables": {"crank": ["80 mm", "160 mm"], "rod": ["200 mm", "600 mm"], "offset": ["0 mm", "150 mm"]},
            "constraints": {"stroke": {"equals": "280 mm"}, "transmission_angle": {"min": "35 deg"}},
            "objectives": {"peak_torque": "minimise", "time_ratio": "maximise"},
        },
        force=60.0,
        mass=1.95,
        rpm=300.0,
        steps={"crank": 0.5, "rod": 1.0, "offset": 0.5},
        allow=0.2,
    ),
}


def at_the_command_line(story: Story, place: Path, command: Command, number: int) -> tuple[list[Row], list[Row]]:
    """Return designs on the front, and rounded ones near one of them."""
    for name, content in story.files.items():
        (place / name).write_text(content, encoding="utf-8")
    (place / "job.toml").write_text(job_toml(tables_of(story)), encoding="utf-8")
    checked = command("check", place / "job.toml")
    assert checked.exit_code == 0, checked.output
    assert "warning" not in checked.stdout
    done = command("optimise", place / "job.toml", "--runs", place, "--no-figures", "--json")
    assert done.exit_code == 0, done.output
    options = [part for text in texts_of(story) for part in ("--to", text)]
    nearest = command("round", "latest", number, "--runs", place, *options, "--json")
    assert nearest.exit_code == (3 if story.allow else 0), nearest.output
    if story.allow:
        assert not json.loads(nearest.stdout)["met"]
        options += ["--allow", f"stroke={story.allow} mm"]
        nearest = command("round", "latest", number, "--runs", place, *options, "--json")
    assert nearest.exit_code == 0, nearest.output
    return json.loads(done.stdout)["designs"], json.loads(nearest.stdout)["designs"]


def in_python(story: Story, place: Path, _: Command, number: int) -> tuple[list[Row], list[Row]]:
    """Return the same in Python, from the tables as a dict."""
    for name, content in story.files.items():
        (place / name).write_text(content, encoding="utf-8")
    front = sc.solve(sc.problem(tables_of(story), folder=place))
    steps = {name: 1e-3 * step for name, step in story.steps.items()}
    found = front.rounded(number - 1, steps)
    assert found.is_met == (not story.allow)
    if story.allow:
        found = front.rounded(number - 1, steps, allow={"stroke": 1e-3 * story.allow})
        assert found.is_met
    rounded = [{key: values[row].item() for key, values in found.columns.items()} for row in range(len(found))]
    rows = [{key: values[row] for key, values in front.columns.items()} for row in range(len(front))]
    return rows, rounded


def over_the_api(story: Story, place: Path, _: Command, number: int) -> tuple[list[Row], list[Row]]:
    """Return the same over HTTP."""
    with Store(place / "store.db") as store, client_of(store) as client:
        sent = client.post(f"{API}/jobs", json={"job": tables_of(story), "files": story.files})
        assert sent.status_code == 201, sent.text
        work(store, drain=True)
        path = f"{API}/jobs/{sent.json()['id']}/designs"
        asked: dict[str, Any] = {"to": texts_of(story)}
        found = client.post(f"{path}/{number}/rounded", json=asked).json()["rounded"]
        assert found["met"] == (not story.allow)
        if story.allow:
            asked["allow"] = [f"stroke={story.allow} mm"]
            found = client.post(f"{path}/{number}/rounded", json=asked).json()["rounded"]
            assert found["met"]
        return client.get(path).json()["designs"], found["designs"]


DOORS: dict[str, Callable[[Story, Path, Command, int], tuple[list[Row], list[Row]]]] = {
    "command line": at_the_command_line,
    "Python": in_python,
    "API": over_the_api,
}


def tables_of(story: Story) -> dict[str, Any]:
    return {**story.tables, "optimiser": SEARCH}


def texts_of(story: Story) -> list[str]:
    return [f"{name}={step} mm" for name, step in story.steps.items()]


def slider(row: Row, angles: NDArray[np.float64]) -> NDArray[np.float64]:
    crank, rod, offset = (1e-3 * float(row[f"{name}_mm"]) for name in ("crank", "rod", "offset"))
    across = offset - crank * np.sin(angles)
    return np.asarray(crank * np.cos(angles) + np.sqrt(rod * rod - across * across))


def peak_torque(story: Story, row: Row) -> float:
    """Return the greatest torque, N m, of the load and the slider's inertia, by differences on a grid."""
    step = ANGLES[1]
    before, now, after = (slider(row, ANGLES + by) for by in (-step, 0.0, step))
    first, second = (after - before) / (2.0 * step), (after - 2.0 * now + before) / step**2
    speed = story.rpm * np.pi / 30.0
    velocity = first * speed
    against = np.where(velocity > 0.0, story.force, -story.force if story.inward else 0.0)
    torque = (story.mass * second * speed**2 + against) * first
    return float(np.abs(torque).max())


def stroke(row: Row) -> float:
    """Return the stroke, mm, in closed form."""
    crank, rod, offset = (float(row[f"{name}_mm"]) for name in ("crank", "rod", "offset"))
    return float(np.sqrt((rod + crank) ** 2 - offset**2) - np.sqrt((rod - crank) ** 2 - offset**2))


def cheapest(story: Story, row: Row) -> str:
    """Return the cheapest gearmotor whose torque suffices."""
    needed = peak_torque(story, row)
    return min((name for name, (torque, _) in MOTORS.items() if torque >= needed), key=lambda name: MOTORS[name][1])


@pytest.mark.slow
@pytest.mark.parametrize(("machine", "door"), in_turn(3, STORIES, DOORS))
def test_a_machine_comes_from_nothing_to_a_rounded_design(
    machine: str, door: str, tmp_path: Path, command: Command
) -> None:
    story, number = STORIES[machine], 2
    front, rounded = DOORS[door](story, tmp_path, command, number)
    assert len(front) >= 2
    assert rounded
    bounds = story.tables["constraints"]["stroke"]
    least, most = (float(str(bounds.get(key, bounds.get("equals", default))).split()[0]) for key, default in ENDS)
    lengths = np.array([[1e-3 * row[f"{name}_mm"] for name in ("crank", "rod", "offset")] for row in rounded])
    judged = sc.problem({key: part for key, part in tables_of(story).items() if key != "choice"} | ALONE)
    for row, (torque, angle) in zip(rounded, judged.evaluate(lengths), strict=True):
        for name, step in story.steps.items():
            assert row[f"{name}_mm"] % step == 0.0
            low, high = (float(end.split()[0]) for end in story.tables["variables"][name])
            assert low <= row[f"{name}_mm"] <= high
        assert least - story.allow - 1e-9 <= stroke(row) <= most + story.allow + 1e-9
        assert np.degrees(angle) >= float(story.tables["constraints"]["transmission_angle"]["min"].split()[0]) - 1e-9
        assert torque == pytest.approx(peak_torque(story, row), rel=1e-4)
        if "peak_torque_Nm" in row:
            assert row["peak_torque_Nm"] == pytest.approx(torque, rel=1e-9)
    if machine == "pusher":
        for row in front:
            assert row["choice_gearmotor"] == cheapest(story, row)
            assert row["price_EUR"] == MOTORS[row["choice_gearmotor"]][1]
        assert len({row["choice_gearmotor"] for row in front}) > 1
        greatest = MOTORS[front[number - 1]["choice_gearmotor"]][0]
        assert all(peak_torque(story, row) <= greatest for row in rounded)
