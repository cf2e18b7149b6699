"""Numbers without a unit in a job: which ones warn, how, and in Python once for each problem."""

from __future__ import annotations

import math
import random
import warnings
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from typing import Any

import pytest

import slidercrank as sc
from slidercrank.model.errors import InputWarning, JobError
from slidercrank.optimise.job import parse_job, value_types
from slidercrank.optimise.job.job_notes import job_notes

PRESS = {
    "name": "Press",
    "mechanism": {"speed": "120 rpm", "slider": {"mass": "2 kg"}, "gravity": 0.0},
    "load": [{"positions": ["0.1 m", "0.2 m"], "forces": ["0 N", "50 N"]}],
    "variables": {"crank": ["20 mm", "200 mm"], "rod": ["60 mm", "600 mm"], "offset": [0, "0.1 m"]},
    "objectives": {"peak_torque": "minimise", "transmission_angle": "maximise"},
}
CLEARANCE = {"joint": "crank pin", "radial_clearance": "0.1 mm", "journal_radius": "10 mm"}
SPEEDS = {"crank_angles": ["0 deg", "90 deg", "180 deg", "270 deg"], "speeds": [120, 130, 120, 110]}
COMPRESSOR = {"bore": "70 mm", "suction": "1 bar", "discharge": "8 bar", "clearance_volume": 11.5}


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
            "mechanism.speed = 120 has no unit and is read as 120 rad/s (1145.92 rpm); if you mean 120 rpm, write "
            '"120 rpm", otherwise "120 rad/s"',
        ),
        (
            "variables.crank",
            [20, 200],
            "variables.crank = [20, 200] has no unit: 20 is read as 20 m (20000 mm); if you mean mm, write "
            '["20 mm", "200 mm"], otherwise ["20 m", "200 m"]',
        ),
        ("variables.rod", ["60 mm", 0.6], 'variables.rod = ["60 mm", 0.6] mixes numbers with and without a unit: 0.6'),
        (
            "variables.crank",
            {"choices": [0.02, 25]},
            "variables.crank = { choices = [0.02, 25] } has no unit: 25 is read as 25 m",
        ),
        (
            "load.0.positions",
            [0.1, 200],
            "load #1.positions = [0.1, 200] has no unit: 200 is read as 200 m (200000 mm)",
        ),
        (
            "tolerances.crank",
            0.015,
            "tolerances.crank = 0.015 has no unit and is read as 0.015 m (15 mm); if you mean 0.015 mm, write",
        ),
        (
            "tolerances.crank_angle",
            0.1,
            "tolerances.crank_angle = 0.1 has no unit and is read as 0.1 rad (5.72958 deg); if you mean 0.1 deg, write "
            '"0.1 deg", otherwise "0.1 rad"',
        ),
        ("tolerances.crank_angle", 30, "tolerances.crank_angle = 30 has no unit and is read as 30 rad (1718.87 deg)"),
        (
            "constraints",
            {"rod - crank": {"max": 40}},
            'constraints."rod - crank".max = 40 has no unit and is read as 40 m',
        ),
        (
            "variables.mechanism.speed",
            [30, 60],
            "variables.mechanism.speed = [30, 60] has no unit: 30 is read as 30 rad/s",
        ),
        (
            "clearance",
            CLEARANCE | {"journal_radius": 10},
            "clearance.journal_radius = 10 has no unit and is read as 10 m",
        ),
        ("variables.crank", 10, "variables.crank = 10 has no unit and is read as 10 m (10000 mm)"),
        (
            "load.0.forces",
            ["1 N", 2],
            'load #1.forces = ["1 N", 2] mixes numbers with and without a unit: 2 is read as 2 N; write "2 N"',
        ),
    ],
)
def test_a_number_without_a_unit_of_a_size_that_no_machine_has_is_warned_of(path: str, value: Any, said: str) -> None:
    (warning,) = parse_job(put(path, value), require_feasible=False).warnings
    assert warning.startswith(said)
    assert not any("without a unit" in note for note in job_notes(put(path, value)))


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
    assert warning.startswith("mechanism.speed = 300 has no unit and is read as 300 rad/s (2864.79 rpm)")


@pytest.mark.parametrize(
    ("path", "value", "key", "meant"),
    [
        ("variables.crank", [20, "200 mm"], "variables.crank", "20 mm"),
        ("variables.crank", {"min": 20, "max": "60 mm", "step": "1 mm"}, "variables.crank", "20 mm"),
        ("variables.mechanism.speed", [60, "120 rpm"], "variables.mechanism.speed", "60 rpm"),
        ("constraints.stroke", {"min": 50, "max": "100 mm"}, "constraints.stroke", "50 mm"),
    ],
)
def test_ends_that_cross_for_want_of_a_unit_are_not_to_be_swapped(path: str, value: Any, key: str, meant: str) -> None:
    with pytest.raises(JobError) as refused:
        parse_job(put(path, value))
    said = str(refused.value)
    assert said.startswith(f"{key}: {key}")
    assert f'write "{meant}"' in said
    assert f"; give {meant.split()[0]} its unit" in said
    assert "swap" not in said


@pytest.mark.parametrize(
    ("path", "value", "key", "meant"),
    [
        ("constraints.stroke", {"equals": 150}, "constraints.stroke", "150 mm"),
        ("constraints", {"rod": {"equals": 150}}, "constraints.rod", "150 mm"),
        ("constraints", {"offset": {"min": 15}}, "constraints.offset", "15 mm"),
        ("variables.crank", {"min": "20 mm", "max": "60 mm", "step": 1}, "variables.crank", "1 mm"),
        ("load.0.positions", [10, "60 mm"], "load #1.positions", "10 mm"),
        ("load", [COMPRESSOR], "load #1.clearance_volume", "11.5 cm^3"),
        ("mechanism.speed_profile", SPEEDS, "mechanism", "120 rpm"),
        ("clearance", CLEARANCE | {"radial_clearance": 0.1}, "clearance", "0.1 mm"),
        ("mechanism.speed_profile", SPEEDS | {"crank_angles": [0, 90, 180]}, "mechanism.speed_profile", "90 deg"),
    ],
)
def test_a_refusal_begins_with_the_missing_unit_that_may_be_its_cause(
    path: str, value: Any, key: str, meant: str
) -> None:
    with pytest.raises(JobError) as refused:
        parse_job(put(path, value))
    said = str(refused.value)
    assert said.startswith(f"{key}: {key}")
    assert "; if you mean " in said
    assert f'"{meant}"' in said


@pytest.mark.parametrize("inside", [[], [1], {}, [1, 2]])
def test_a_list_in_a_list_is_refused_without_a_word_of_plain_numbers(inside: Any) -> None:
    job = deepcopy(PRESS)
    job["load"][0]["positions"][0] = inside  # type: ignore[index]
    with pytest.raises(JobError, match=r"positions #1: must be a length; got .*; write it like") as refused:
        parse_job(job)
    assert "unit" not in str(refused.value)


def test_a_refusal_elsewhere_has_no_word_of_plain_numbers() -> None:
    job = put("mechanism.speed", 120)
    job["objectives"] = {"time_ratio": "maximum", "stroke": "maximise"}
    with pytest.raises(JobError, match=r"objectives\.time_ratio: must be") as refused:
        parse_job(job)
    assert "120" not in str(refused.value)
    job["objectives"] = {"time_ratio": "maximise"}
    job["variables"]["offset"] = "0 mm"
    with pytest.raises(JobError, match=r"objectives\.time_ratio: without offset") as refused:
        parse_job(job)
    assert "120" not in str(refused.value)


@pytest.mark.parametrize(
    ("path", "text", "said"),
    [
        ("constraints.stroke", {"equals": "0.1 +- 0.001"}, 'a length with its unit; got "0.1 +- 0.001"'),
        ("variables.crank", "40 mm +- 50 mm", 'positive; got "40 mm +- 50 mm", which is -10.0 mm to 90.0 mm'),
    ],
)
def test_a_range_with_a_middle_is_refused_as_it_was_typed(path: str, text: Any, said: str) -> None:
    with pytest.raises(JobError) as refused:
        parse_job(put(path, text))
    assert str(refused.value).startswith(f"{path}: must be {said}")


def test_python_warns_once_for_each_problem_and_names_the_line_that_stated_it() -> None:
    with pytest.warns(InputWarning, match="120 rad/s \\(1145.92 rpm\\)") as found:
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
            "lengths of designs must be in m: crank 40 is 40 m = 40000 mm; write 0.04 for 40 mm"
        ]
        assert found[0].filename == __file__


def test_designs_in_mm_are_warned_of_for_each_problem_on_one_line_under_the_default_filter() -> None:
    problems = [sc.problem(PRESS | {"name": name}) for name in ("one", "two", "two")]
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("default")
        for problem in (*problems, *problems):
            problem.evaluate([40.0, 300.0, 20.0])
    assert [(warning.category, warning.filename) for warning in found] == 3 * [(InputWarning, __file__)]


def test_crank_angles_in_degrees_are_warned_of_and_two_turns_in_radians_are_not() -> None:
    analysis = sc.problem(PRESS).analyse([0.04, 0.3, 0.02])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        analysis.cycle([0.0, math.pi, 4.0 * math.pi])
        analysis.cycle(360)
    with pytest.warns(InputWarning) as found:
        analysis.cycle([0, 90, 180, 270])
    assert [str(warning.message) for warning in found] == [
        "crank angles must be in rad: crank angle 90 is 90 rad = 5156.62 deg; write 1.5708 for 90 deg"
    ]
    assert found[0].filename == __file__


def test_lengths_within_ranges_with_units_never_warn() -> None:
    ranges = {"crank": ["11 m", "12 m"], "rod": ["40 m", "60 m"], "offset": ["0.01 mm", "20 m"]}
    assert sc.problem(PRESS | {"variables": ranges}).evaluate([11.5, 50.0, 15.0]).shape == (2,)


def test_a_job_of_values_with_units_is_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[object] = []
    original = value_types.RangeOf.read

    def counted(of: value_types.RangeOf, value: object) -> object:
        read.append(value)
        return original(of, value)

    monkeypatch.setattr(value_types.RangeOf, "read", counted)
    job = put("load.0.positions", ["0.1 m", "0.2 m"])
    parse_job(job)
    assert read.count(["20 mm", "200 mm"]) == 1
    read.clear()
    parse_job(put("mechanism.speed", 12.0))
    assert read.count(["20 mm", "200 mm"]) == 2  # the numbers without a unit are named by a refusal


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            {"quantity": "transmission_angle", "lower": 90},
            "requirements must be in SI: transmission_angle, lower = 90 is 90 rad = 5156.62 deg; write 1.5708 for 90 "
            "deg",
        ),
        (
            {"quantity": "stroke", "lower": 0.1, "upper": 150.0},
            "requirements must be in SI: stroke, upper = 150 is 150 m = 150000 mm; write 0.15 for 150 mm",
        ),
        (
            {"quantity": "displacement_volume", "upper": 500},
            "requirements must be in SI: displacement_volume, upper = 500 is 500 m^3 = 5e+08 cm^3; write 0.0005 for "
            "500 "
            "cm^3",
        ),
    ],
)
def test_a_bound_in_python_that_was_meant_in_another_unit_is_warned_of_once(given: dict[str, Any], said: str) -> None:
    with pytest.warns(InputWarning) as found:
        sc.Constraint(**given)
    assert [str(warning.message) for warning in found] == [said]
    assert found[0].filename == __file__


def test_targets_and_changed_bounds_are_warned_of_too() -> None:
    with pytest.warns(InputWarning, match="stroke, target = 150 is 150 m = 150000 mm"):
        sc.Objective(quantity="stroke", sense="target", target=150)
    fine = sc.Constraint(quantity="stroke", upper=0.15)
    with pytest.warns(InputWarning, match="stroke, upper = 150 is 150 m"):
        long = replace(fine, upper=150.0)
    replace(sc.problem(PRESS), constraints=(long,))  # the warning is that of the line that stated the number


def test_bounds_in_si_of_machines_and_bounds_with_units_never_warn() -> None:
    draw = random.Random(351)
    for _ in range(60):
        sc.Constraint(quantity="stroke", upper=10.0 ** draw.uniform(-4.0, 1.0))
        sc.Constraint(quantity="transmission_angle", lower=draw.uniform(0.0, math.pi / 2.0))
        sc.Constraint(quantity="peak_torque", upper=10.0 ** draw.uniform(-3.0, 6.0))
        sc.Constraint(quantity="position_error", upper=10.0 ** draw.uniform(-7.0, -3.0))
    digger = put("constraints.stroke", {"min": "11 m", "max": "30 m"})
    problem = sc.problem(digger, require_feasible=False)
    assert [(of.lower, of.upper) for of in problem.constraints] == [(11.0, 30.0)]


def test_allowed_misses_and_ranges_in_python_that_were_meant_in_mm_are_warned_of() -> None:
    tables = put("constraints.stroke", {"equals": "150 mm"}) | {"optimiser": {"designs": 3, "samples": 64}}
    front = sc.solve(sc.problem(tables))
    with pytest.warns(InputWarning) as found:
        front.rounded(0, 0.001, allow={"stroke": 0.2}, count=1)
    assert [(str(warning.message), warning.filename) for warning in found] == [
        ("allowed deviations are in SI: stroke 0.2 is 0.2 m = 200 mm; write 0.0002 for 0.2 mm", __file__)
    ]
    for allowed in (0.0002, "0.2 mm", "20 mm", 0.015):
        front.rounded(0, 0.001, allow={"stroke": allowed}, count=1)
    with (
        pytest.warns(InputWarning, match="ranges of lengths are in m: rod 400 is 400 m = 400000 mm; write 0.4"),
        pytest.raises(sc.InputError),
    ):
        sc.like(front, 0, ranges={"rod": (None, 400.0), "crank": (0.1, 0.02)})
