"""How much a job may hold, and how long the largest one takes to read."""

from __future__ import annotations

import random
import time
import tomllib
from typing import Any

import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.job_file import MOST, require_few_values, toml_tables
from slidercrank.service.jobs.job_toml import job_toml

LONGEST = 10.0
"""Times as long as the parser takes for a large file: a half is usual at most, a table that is read over and over takes
some 50."""
FORCE = {"force": "1 N", "direction": "inward"}
TABLE = {"crank_angles": [f"{0.3 * n:.3f} deg" for n in range(1000)], "forces": [1.0] * 1000}
Job = dict[str, Any]


def job(**parts: Any) -> Job:
    """Return a job with some parts in place of its own."""
    found: Job = {
        "name": "Press",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "2 kg"}},
        "variables": {"crank": ["20 mm", "200 mm"], "rod": ["60 mm", "600 mm"], "offset": ["0 mm", "100 mm"]},
        "objectives": {"time_ratio": "maximise", "transmission_angle": "maximise"},
    }
    more = parts.pop("variables", {})
    return {**found, **parts, "variables": {**found["variables"], **more}}


def items(value: Any) -> int:
    """Return how many values, lists and tables there are within a value."""
    inside = list(value.values()) if isinstance(value, dict) else value if isinstance(value, list) else []
    return len(inside) + sum(map(items, inside))


def drawn(rng: random.Random, count: int, depth: int = 0) -> Any:
    """Return data of about so many values: lists, tables, numbers and texts with all signs of TOML."""
    if count <= 1 or depth > 4:
        return rng.choice([1, 1.5, True, "=,[{", "x # y", "'", '"""', {}, []])
    parts = [drawn(rng, size, depth + 1) for size in (count // 2, *[1] * rng.randint(1, 4), count // 2)]
    return parts if rng.random() < 0.5 else {f"k{n}": part for n, part in enumerate(parts)}


def test_what_a_job_may_hold_is_counted_alike_as_tables_and_as_text() -> None:
    rng = random.Random(1)
    for _ in range(5):
        data = {"load": [drawn(rng, 60) for _ in range(rng.randint(1, 8))], "x": drawn(rng, 400)}
        data["fill"] = [0] * (MOST - items(data) - 1)
        assert items(data) == MOST
        require_few_values(data)
        assert toml_tables(job_toml(data)) == tomllib.loads(job_toml(data)) == data
        data["fill"].append(0)
        with pytest.raises(JobError, match=f"at most {MOST} values, lists and tables; got {MOST + 1}; leave some out"):
            require_few_values(data)


@pytest.mark.parametrize("one", ["[[a]]\n", "[t{}]\n", "k{} = 1\n", "[t{}.a.a.a.a.a]\n", "a.b.k{} = [{{}}]\n"])
def test_a_text_of_far_too_many_values_is_refused_before_it_is_read(one: str) -> None:
    text = "".join(one.format(number) for number in range(3 * MOST))
    begin = time.process_time()
    tomllib.loads(text[: text.index("\n", len(text) // 3) + 1])
    reading = 3.0 * (time.process_time() - begin)  # more, where names are long
    begin = time.process_time()
    with pytest.raises(JobError, match=f"at most {MOST} values"):
        toml_tables(text)
    assert time.process_time() - begin < reading


def test_signs_in_texts_and_comments_are_no_values() -> None:
    text = "# " + "=,[{" * 20_000 + "\nname = '" + "=,[{" * 20_000 + '\'\nx = """' + "[=,\n" * 20_000 + '"""\n'
    assert len(toml_tables(text)["name"]) == 80_000


def large_jobs() -> dict[str, tuple[Job, str]]:
    """Return jobs that took very long to read, with what is said of them; nothing of those that are fine."""
    loads = [FORCE] * 50
    few = f"at most {MOST} values"
    lots = {"load": {str(n + 1): {"force": ["1 N", "2 N"]} for n in range(50)}}
    masses = {"mechanism.slider.mass": {"choices": list(range(1, 201))}}
    return {
        "empty loads": (job(load=[{}] * 110_000), few),
        "as many empty loads as are read": (job(load=[{}] * (MOST - 50)), "load #1: must be one of"),
        "lengths of a catalogue": (job(variables={"crank": {"choices": [f"{n} um" for n in range(100, 90_000)]}}), few),
        "some of these": (job(variables={"crank": {"choices": [f"{n} um" for n in range(100, 9_000)]}}), "at most 200"),
        "objectives": (job(objectives={f"o{n}": 1 for n in range(80_000)}), few),
        "constraints": (job(constraints={f"o{n}": {"min": 1} for n in range(4_900)}), "unknown key"),
        "paths": (job(variables={f"mechanism.a{n}": [1, 2] for n in range(3_000)}), "must name a number that the job"),
        "quantities": (job(quantity={f"q{n}": {"function": "a:b"} for n in range(4_000)}), "at most 20 entries"),
        "numbers in long tables": (job(load=[TABLE, TABLE, *loads[:46]], variables=shifted(lots, 2, 46)), ""),
        "numbers in every combination": (job(load=loads, variables={**lots, **masses}), "at most 2000"),
        "choices beside tables": (job(load=[TABLE] * 4, variables=masses), ""),
    }


def shifted(lots: Job, first: int, count: int) -> Job:
    """Return the same numbers of loads further down."""
    return {"load": {str(first + n + 1): lots["load"][str(n + 1)] for n in range(count)}}


@pytest.fixture(scope="module")
def reading() -> float:
    """Processor time, s, that the parser takes for a large file on this machine."""
    begin = time.thread_time()
    tomllib.loads("[[a]]\n" * (3 * MOST))
    return time.thread_time() - begin


@pytest.mark.parametrize("kind", large_jobs())
def test_no_job_takes_long_to_read(kind: str, reading: float) -> None:
    data, said = large_jobs()[kind]
    begin = time.thread_time()
    if said:
        with pytest.raises(JobError, match=said):
            parse_job(data)
    else:
        assert parse_job(data).name == "Press"
    assert time.thread_time() - begin < LONGEST * reading
