"""Numbers without a unit in a job: which ones warn, how, and in Python once for each problem."""

from __future__ import annotations

import math
import random
import warnings
from collections.abc import Callable
from copy import deepcopy
from typing import Any

import pytest

import slidercrank as sc
from slidercrank.model.errors import InfeasibleError, InputWarning, JobError
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.notes import notes_of

PRESS = {
    "name": "Press",
    "mechanism": {"speed": "120 rpm", "slider": {"mass": "2 kg"}, "gravity": 0.0},
    "load": [{"positions": ["0.1 m", "0.2 m"], "forces": ["0 N", "50 N"]}],
    "variables": {"crank": ["20 mm", "200 mm"], "rod": ["60 mm", "600 mm"], "offset": [0, "0.1 m"]},
    "objectives": {"peak_torque": "minimise", "transmission_angle": "maximise"},
}


def put(path: str, value: Any) -> dict[str, Any]:
    """Return the job with a value at a path; numbers in it are places in lists."""
    job: dict[str, Any] = deepcopy(PRESS)
    *steps, last = path.split(".")
    part: Any = job
    for step in steps:
        part = part[int(step)] if isinstance(part, list) else part.setdefault(step, {})
    part[last] = value
    return job


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (
            "mechanism.speed",
            120,
            'mechanism.speed = 120 has no unit: 120 is 120 rad/s = 1145.92 rpm; write "120 rpm" if that is meant, or '
            '"120 rad/s"',
        ),
        (
            "variables.crank",
            [20, 200],
            'variables.crank = [20, 200] has no unit: 20 is 20 m = 20000 mm; write "20 mm" if that is meant, or "20 m"',
        ),
        ("variables.rod", ["60 mm", 0.6], 'variables.rod = ["60 mm", 0.6] mixes numbers with and without a unit: 0.6'),
        ("variables.crank", {"choices": [0.02, 25]}, "variables.crank = { choices = [0.02, 25] } has no unit: 25 is"),
        ("load.0.positions", [0.1, 200], "load #1.positions = [0.1, 200] has no unit: 200 is 200 m = 200000 mm"),
        ("tolerances.crank", 0.015, 'tolerances.crank = 0.015 has no unit: 0.015 is 0.015 m = 15 mm; write "0.015 mm"'),
        ("tolerances.crank_angle", 30, "tolerances.crank_angle = 30 has no unit: 30 is 30 rad = 1718.87 deg"),
        ("constraints", {"rod - crank": {"max": 40}}, 'constraints."rod - crank".max = 40 has no unit: 40 is 40 m'),
        ("variables.mechanism.speed", [30, 60], "variables.mechanism.speed = [30, 60] has no unit: 30 is 30 rad/s"),
    ],
)
def test_a_number_without_a_unit_of_a_size_that_no_machine_has_is_warned_of(path: str, value: Any, said: str) -> None:
    (warning,) = parse_job(put(path, value), require_feasible=False).warnings
    assert warning.startswith(said)
    assert not any("without a unit" in note for note in notes_of(put(path, value)))


def test_values_with_units_and_believed_numbers_in_si_never_warn() -> None:
    draw = random.Random(35)
    for _ in range(40):
        crank, speed = 10.0 ** draw.uniform(-4.0, 1.0), draw.uniform(1.0, 1e4)
        unit, per_metre = draw.choice([("m", 1.0), ("mm", 1e3), ("in", 1.0 / 0.0254)])
        job = put("mechanism.speed", f"{speed!r} {draw.choice(['rpm', 'rad/s', 'rev/s'])}")
        job["variables"]["crank"] = draw.choice([[crank, 1.5 * crank], f"{30.0 * per_metre!r} {unit}"])
        if isinstance(job["variables"]["crank"], list) and 1.5 * crank > 10.0:
            continue
        assert parse_job(job, require_feasible=False).warnings == ()


def test_all_doubtful_numbers_of_a_job_have_a_line_each() -> None:
    job = put("mechanism.speed", 120) | {"variables": {"crank": [20, 200], "rod": [60, 600], "offset": 0}}
    assert [line.split(" = ")[0] for line in parse_job(job).warnings] == [
        "mechanism.speed",
        "variables.crank",
        "variables.rod",
    ]


def test_what_an_option_of_a_choice_sets_without_a_unit_is_warned_of() -> None:
    options = [{"name": "a", "values": {"crank": 40}}, {"name": "b", "values": {"mechanism.speed": 30}}]
    found = parse_job(PRESS | {"choice": [{"name": "size", "option": options}]}, require_feasible=False).warnings
    assert [line.split(" has")[0] for line in found] == [
        'choice "size", option "a": crank = 40',
        'choice "size", option "b": mechanism.speed = 30',
    ]


def test_a_value_put_in_place_of_a_number_of_the_job_is_judged_in_its_place() -> None:
    assert parse_job(put("mechanism.speed", 30), {"mechanism.speed": "300 rpm"}).warnings == ()
    (warning,) = parse_job(PRESS, {"mechanism.speed": 300}).warnings
    assert warning.startswith("mechanism.speed = 300 has no unit: 300 is 300 rad/s = 2864.79 rpm")


def test_a_range_whose_first_end_has_no_unit_is_not_called_empty_alone() -> None:
    with pytest.raises(JobError, match=r'got 20 to "200 mm"; 20 without a unit is 20 m; write "20 mm"'):
        parse_job(put("variables.crank", [20, "200 mm"]))


def test_an_impossible_requirement_names_the_missing_unit_as_its_cause() -> None:
    with pytest.raises(InfeasibleError, match=r'constraints\.stroke\.equals = 150 has no unit.*write "150 mm"'):
        parse_job(put("constraints.stroke", {"equals": 150}))


def test_python_warns_once_for_each_problem_and_names_the_line_that_stated_it() -> None:
    with pytest.warns(InputWarning, match="120 rad/s = 1145.92 rpm") as found:
        problem = sc.problem(put("mechanism.speed", 120))
    assert [warning.filename for warning in found] == [__file__]
    for _ in range(3):
        problem.evaluate([0.04, 0.3, 0.02])  # warnings are errors here
    assert math.isfinite(problem.analyse([0.04, 0.3, 0.02])["peak_torque"])


def test_a_warning_is_that_of_users_and_can_be_silenced() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        assert sc.problem(put("mechanism.speed", 120)).warnings


@pytest.mark.parametrize("ask", ["evaluate", "analyse"])
def test_designs_in_mm_are_warned_of_once_for_each_machine_and_problem(ask: str) -> None:
    problem, machine = sc.problem(PRESS), sc.Mechanism(speed=12.0, slider_mass=2.0)
    calls: dict[str, tuple[Callable[[list[float]], object], ...]] = {
        "evaluate": (lambda sizes: problem.evaluate(sizes), lambda sizes: sc.evaluate(machine, sizes, ["stroke"])),
        "analyse": (lambda sizes: problem.analyse(sizes), lambda sizes: sc.analyse(machine, sizes)),
    }
    for call in calls[ask]:
        call([0.04, 0.3, 0.02])
        with pytest.warns(InputWarning) as found:
            call([40.0, 300.0, 20.0])
        call([41.0, 300.0, 20.0])
        assert [str(warning.message) for warning in found] == [
            "lengths of designs are in m: crank 40 is 40 m = 40000 mm; write 0.04 for 40 mm"
        ]
        assert found[0].filename == __file__


def test_lengths_within_ranges_with_units_never_warn() -> None:
    ranges = {"crank": ["11 m", "12 m"], "rod": ["40 m", "60 m"], "offset": ["0.01 mm", "20 m"]}
    assert sc.problem(PRESS | {"variables": ranges}).evaluate([11.5, 50.0, 15.0]).shape == (2,)
