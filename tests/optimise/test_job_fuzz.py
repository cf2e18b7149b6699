"""Whatever stands in a job, the answer is a problem or a JobError, never another exception."""

import tomllib
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import load_job, parse_job
from slidercrank.optimise.problem.problem import Problem
from tests.case_count import case_count

RUNS = Path(__file__).parents[2] / "runs"
SHIPPED = sorted(RUNS.glob("*.toml"))
JOBS = [tomllib.loads(path.read_text(encoding="utf-8")) for path in SHIPPED]

WORDS = st.sampled_from(
    [
        *("speed", "crank", "rod", "offset", "mass", "force", "opposes", "direction", "positions", "forces"),
        *("crank_angles", "viscous", "stiffness", "free_position", "min", "max", "equals", "target", "during"),
        *("stroke", "time_ratio", "rod_to_offset", "rod_to_crank", "mean_torque", "gravity_direction", "width"),
        *("minimise", "maximise", "open", "motion", "outward stroke", "inward", "outer dead centre", "auto"),
        *("80 mm", "0 mm", "-1 mm", "1e-9 mm", "10000 m", "300 rpm", "5 N", "1 N s/m", "40 deg", "90 deg", "0.1 %"),
        *("100 %", "nan", "1 degC", "1e999 m", "5e-324", ""),
    ]
)
SCALARS = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), WORDS, st.text(max_size=8), st.binary(max_size=3)
)
KEYS = st.one_of(WORDS, st.text(max_size=6))
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(KEYS, inner, max_size=4)),
    max_leaves=8,
)


def containers(node: Any) -> list[Any]:
    """Every table and list of a job that holds something."""
    if isinstance(node, dict):
        return ([node] if node else []) + [x for item in node.values() for x in containers(item)]
    if isinstance(node, list):
        return ([node] if node else []) + [x for item in node for x in containers(item)]
    return []


def answered(job: Any) -> None:
    try:
        problem = parse_job(job)
    except JobError as error:
        message = str(error)
    else:
        message = ""
        assert isinstance(problem, Problem)
    assert message.replace("\n", " ").isprintable()
    assert "pydantic" not in message


@pytest.mark.slow
@settings(max_examples=case_count(150, 400))
@given(st.data())
def test_a_mutated_job_gives_a_problem_or_a_job_error(data: st.DataObject) -> None:
    job = deepcopy(data.draw(st.sampled_from(JOBS)))
    for _ in range(data.draw(st.integers(1, 3))):
        inside = containers(job)
        if not inside:
            break
        place = data.draw(st.sampled_from(inside))
        key = data.draw(st.sampled_from(range(len(place)) if isinstance(place, list) else sorted(place, key=repr)))
        action = data.draw(st.sampled_from(["replace", "replace", "delete", "add"]))
        if action == "replace":
            place[key] = data.draw(VALUES)
        elif action == "delete":
            del place[key]
        elif isinstance(place, list):
            place.append(data.draw(VALUES))
        else:
            place[data.draw(KEYS)] = data.draw(VALUES)
    answered(job)


@settings(max_examples=case_count(120, 300))
@given(VALUES)
def test_any_data_gives_a_problem_or_a_job_error(data: Any) -> None:
    answered(data)


LENGTHS = st.one_of(st.floats(1e-9, 1e4), st.sampled_from([1e-9, 0.1, 0.2, 0.3, 0.30000000000000004, 1e4]))
BOUNDS = st.one_of(st.floats(0.0, 10.0), st.sampled_from([1.0, 1.5, 3.0, 3.2]))


@settings(max_examples=case_count(60, 120))
@given(
    st.lists(LENGTHS, min_size=6, max_size=6),
    st.dictionaries(
        st.sampled_from(["stroke", "time_ratio", "transmission_angle", "rod_to_offset", "rod_to_crank", "footprint"]),
        st.dictionaries(st.sampled_from(["min", "max", "equals"]), BOUNDS, min_size=1, max_size=2),
    ),
)
def test_any_ranges_and_bounds_give_a_problem_or_a_job_error(
    ends: list[float], constraints: dict[str, dict[str, float]]
) -> None:
    crank, rod, offset = (sorted(ends[i : i + 2]) for i in (0, 2, 4))
    variables = {"crank": crank, "rod": rod, "offset": offset}
    answered(JOBS[0] | {"variables": variables, "constraints": constraints})


@settings(max_examples=case_count(120, 300), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(SHIPPED), st.integers(0, 4000), st.integers(0, 12), st.binary(max_size=6))
def test_a_damaged_file_gives_a_problem_or_a_job_error(
    tmp_path: Path, source: Path, begin: int, length: int, replacement: bytes
) -> None:
    content = source.read_bytes()
    file = tmp_path / "damaged.toml"
    file.write_bytes(content[:begin] + replacement + content[begin + length :])
    try:
        problem = load_job(file)
    except JobError as error:
        message = str(error)
    else:
        message = f"{file}: read"
        assert isinstance(problem, Problem)
    assert message.startswith(f"{file}: ")
