"""Bodies and jobs of wrong shapes: whatever stands for a value, the answer is in an engineer's words."""

from __future__ import annotations

import random
import re
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from typing import Any

import httpx
import pytest

from tests.service.api.conftest import Serve
from tests.service.api.serving import refusal_sentence

PYTHON = re.compile(
    r"None|NoneType|\bdict|\btuple\b|\bstr\b|\bint\b|\bfloat\b|instance|pydantic|(Input|input|String|string) should|"
    r"b'|\{'|\['"
)
WRONG: list[Any] = [
    *(None, [], {}, [None], [[]], [{}], {"": {}}, {"a": {"b": [1]}}, [["a"]], ["os:system"], {"min": None}),
    *({"choices": 3}, {"target": {}}, 3, -1.5, True, "x", "", "80 mm", [1, 2, 3], {"function": None}),
]
FULL: dict[str, Any] = {
    "name": "Press",
    "mechanism": {
        "speed": "300 rpm",
        "crank": {"mass": "0.2 kg", "inertia": "0.001 kg m^2", "centre": "10 mm"},
        "rod": {"width": "30 mm", "depth": "20 mm", "density": "7800 kg/m^3"},
        "counterweight": {"mass": "0.4 kg", "radius": "25 mm"},
        "slider": {"mass": "0.8 kg"},
        "gravity": "9.81 m/s^2",
        "branch": "open",
    },
    "load": [
        {"force": "200 N", "opposes": "outward stroke"},
        {"stiffness": "20 N/mm", "free_position": "25 mm", "measured_from": "crank pivot"},
        {"positions": ["0 mm", "20 mm"], "forces": ["1 N", "2 N"], "during": "cycle"},
    ],
    "friction": {"guide": 0.1, "crank_pin": {"radius": "10 mm", "coefficient": 0.08}},
    "tolerances": {"crank": "0.1 %", "crank_angle": "0.1 deg", "part_of_stroke": [0.0, 0.5]},
    "drive": {"motor": {"torque": "20 N m"}, "flywheel": "0.5 kg m^2"},
    "costs": {"crank": {"cost": 8.0, "at": "0.05 mm"}},
    "target_motion": {"crank_angles": ["0 deg", "90 deg"], "positions": ["240 mm", "200 mm"]},
    "quantity": {"mine": {"function": "os:getcwd", "unit": "mm", "gradient": "none", "limit": "3 s"}},
    "variables": {
        "crank": ["20 mm", "60 mm"],
        "rod": {"choices": ["140 mm", "150 mm"]},
        "offset": "10 mm",
        "mechanism": {"slider": {"mass": ["0.5 kg", "2 kg"]}},
    },
    "choice": [{"name": "motor", "option": [{"name": "a", "values": {"mechanism.speed": "60 rpm"}}, {"name": "b"}]}],
    "constraints": {"stroke": {"min": "80 mm", "max": "90 mm"}, "slow_stroke": "outward"},
    "objectives": {"time_ratio": "maximise", "peak_torque": {"target": "3 N m"}},
    "robust": {"kind": "percentile", "share": 0.99},
    "optimiser": {"method": "auto", "designs": 20, "seed": 1},
}


def places(part: Any, at: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the place of everything in a job."""
    for key, item in part.items() if isinstance(part, dict) else enumerate(part) if isinstance(part, list) else ():
        yield (*at, key)
        yield from places(item, (*at, key))


def job_with_value_at(at: tuple[Any, ...], value: Any) -> dict[str, Any]:
    """Return the full job with another value at a place."""
    job = deepcopy(FULL)
    if at[0] != "quantity":
        del job["quantity"]  # a job with functions of its own has a schema of its own, which takes a time
    part: Any = job
    for step in at[:-1]:
        part = part[step]
    part[at[-1]] = value
    return job


def test_no_message_about_a_job_of_wrong_shape_is_in_words_of_python(serve: Serve) -> None:
    client, rng = serve(allowed_quantities=frozenset({"os:getcwd"})), random.Random(3)
    every = [(at, value) for at in places(FULL) for value in WRONG]
    said = 0
    for at, value in rng.sample(every, 150):
        answer = client.post("/check", json={"job": job_with_value_at(at, value)})
        assert answer.status_code in (200, 422), (at, value, answer.text)
        if answer.status_code == 422:
            said += 1
            for line in refusal_sentence(answer, 422).split("\n  "):
                assert not PYTHON.search(line), (at, value, line)
                assert re.search(r"^\d+ problems$|got |missing|unknown key ", line), (at, value, line)
    assert said > 100


@pytest.mark.parametrize(
    ("part", "said"),
    [
        (["os:system"], 'quantity.x: must be a table of keys; got ["os:system"]; write it like { function = '),
        (None, "quantity.x: must have a value; got null; leave the key out"),
        ({}, "quantity.x.function: must name a module and a function in it; it is missing; write it like"),
        ({"function": "os.system"}, 'quantity.x.function: must name a module and a function in it; got "os.system"'),
        (
            {"function": "os:system"},
            'quantity.x: only functions that the operator allows may run here; got "os:system"',
        ),
    ],
)
def test_what_stands_in_place_of_a_function_is_told(shared: httpx.Client, part: object, said: str) -> None:
    assert refusal_sentence(shared.post("/check", json={"job": {**FULL, "quantity": {"x": part}}}), 422).startswith(
        said
    )


@pytest.mark.parametrize("kind", ["application/toml", "text/plain", "multipart/form-data", ""])
@pytest.mark.parametrize("path", ["/preview", "/toml", "/analyse", "/jobs/1/clone"])
def test_a_body_that_is_no_json_is_told_what_is_taken(shared: httpx.Client, path: str, kind: str) -> None:
    sentence = refusal_sentence(shared.post(path, content='name = "x"', headers={"Content-Type": kind}), 422)
    assert sentence.startswith("body: must be a JSON object of type application/json; got ")
    if kind == "application/toml":  # what the remedy names is there
        assert "POST /api/v1/parse" in sentence
        tables = shared.post("/parse", content='name = "x"', headers={"Content-Type": kind}).json()["job"]
        assert tables == tomllib.loads('name = "x"')


@pytest.mark.parametrize("body", [[], 3, "x", True, [{}], {"job": []}, {"job": None}, {"job": {}, "priority": None}])
def test_a_body_of_wrong_shape_is_refused_in_plain_words(shared: httpx.Client, body: object) -> None:
    sentence = refusal_sentence(shared.post("/check", json=body), 422)
    assert re.match(r"body( job| priority)?: must be a ", sentence)
    assert not PYTHON.search(sentence)
