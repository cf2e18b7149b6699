"""Inputs of topics: declared once, and the same at the command line and in the API."""

from __future__ import annotations

import inspect
import json
from collections.abc import Iterator
from importlib import import_module
from typing import Any

import httpx
import numpy as np
import pytest
from typer.testing import CliRunner

from slidercrank.model.errors import InputError
from slidercrank.objectives.kinds import LENGTH, RATIO
from slidercrank.service.cli import app as command_line
from slidercrank.service.questions.discovery import INPUTS, TOPIC_OF_INPUT, TOPICS
from slidercrank.service.questions.inputs import Input, read_inputs
from tests.service.alike import assert_same
from tests.service.api.fixed_front import API, Solved, client_of

RANGES = {"crank_angle": (-400.0, 400.0), "fluctuation": (0.005, 0.5)}
"""Of values in metric units that the machine of the front has an answer for."""


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    with client_of(solved.store) as opened:
        yield opened


def printed_numbers(solved: Solved, *options: str) -> Any:
    place = ["--runs", str(solved.folder.parent), "--design", "2"]
    done = CliRunner().invoke(command_line, ["analyse", "latest", *place, "--json", *options])
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout)


def test_no_two_topics_have_an_input_of_the_same_name() -> None:
    assert len(INPUTS) == sum(len(topic.inputs) for topic in TOPICS.values())
    assert len({one.flag for one in INPUTS.values()}) == len({one.key for one in INPUTS.values()}) == len(INPUTS)


@pytest.mark.parametrize("one", INPUTS.values(), ids=list(INPUTS))
def test_every_input_is_a_parameter_of_numbers_with_its_default(one: Input) -> None:
    analysis = import_module(f"{TOPICS[TOPIC_OF_INPUT[one.name]].package}.analysis")
    default = inspect.signature(analysis.numbers).parameters[one.name].default
    assert default == (one.default if one.usual else None)
    assert (one.name in inspect.signature(analysis.figure).parameters) == one.drawn


@pytest.mark.parametrize("name", RANGES)
def test_any_value_gives_the_same_numbers_by_option_and_in_the_api(
    client: httpx.Client, solved: Solved, name: str
) -> None:
    one, topic, random = INPUTS[name], TOPIC_OF_INPUT[name], np.random.default_rng(3)
    for value in random.uniform(*RANGES[name], 3).tolist():
        typed = f"{value!r} {one.unit.symbol}".strip()
        expected = printed_numbers(solved, "--show", topic, one.flag, typed)[topic]
        answer = client.get(f"{solved.path}/designs/2/topics/{topic}", params={one.key: value})
        assert_same(answer.json()["numbers"], expected)


def test_a_topic_that_the_machine_lacks_is_refused_with_its_input_too(client: httpx.Client, solved: Solved) -> None:
    answer = client.get(f"{solved.path}/designs/2/topics/tolerances", params={"limit_mm": 0.3})
    assert (answer.status_code, "a position error needs tolerances; got none" in answer.text) == (422, True)
    answer = client.get(f"{solved.path}/designs/2/topics/motor", params={"limit_mm": 0.3})
    assert "the topic motor has no inputs; got limit; leave limit out" in answer.text


@pytest.mark.parametrize(
    ("path", "given"),
    [
        ("topics/press", {"touch_distance": 12.0, "crank": "40 mm"}),
        ("inverse", {"slider_position": 200.0, "slider_position_mm": 200.0}),
        ("swing", {"start": 3.0}),
    ],
)
def test_an_input_without_its_unit_is_refused_and_not_lost(
    client: httpx.Client, solved: Solved, path: str, given: dict[str, float | str]
) -> None:
    answer = client.get(f"{solved.path}/designs/2/{path}", params=given)
    assert answer.status_code == 422
    name = next(iter(given))
    assert f"{name} must have its unit in its name here; got {name}; call it {name}_" in answer.json()["detail"]


def test_the_list_of_topics_has_what_each_is_asked_with(client: httpx.Client) -> None:
    listed = {one["name"]: one["inputs"] for one in client.get(f"{API}/topics").json()["topics"]}
    assert listed["motor"] == []
    (angle,) = listed["polygons"]
    told = {"key": "crank_angle_deg", "title": "Crank angle", "unit": "deg", "usual": "30 deg", "required": False}
    assert told.items() <= angle.items()


LIMIT = Input("limit", LENGTH, "Limit", "A limit.", "2 mm", sign="positive", upper_limit=1.0)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ("2", "limit must be a length with its unit; got"),
        ("2 kg", "limit must be a length"),
        ("-2 mm", "limit must be positive"),
        (float("nan"), "limit must be a finite number"),
        (True, "limit must be a length; got true"),
        ([1.0], "limit must be a length"),
        ("3 m", 'limit must be less than 1000 mm; got "3 m"; write it like 2 mm'),
        ("0 mm", 'limit must be positive; got "0 mm"; write it like "2 mm"'),
    ],
)
def test_a_value_that_is_none_is_refused_in_a_sentence(given: object, sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        read_inputs((LIMIT,), {"limit": given}, "yield")
    assert sentence in str(refused.value)


def test_texts_and_numbers_in_si_are_read_and_none_is_not_given() -> None:
    assert read_inputs((LIMIT,), {"limit": "0.5 mm"}, "yield") == read_inputs((LIMIT,), {"limit": 5e-4}, "yield")
    assert read_inputs((LIMIT,), {"limit": None}, "yield") == {}
    assert Input("share", RATIO, "Share", "A share.").read("0.5", "share") == 0.5
    with pytest.raises(InputError, match="yield may only be given limit; got speed; leave speed out"):
        read_inputs((LIMIT,), {"speed": 1.0}, "yield")
    with pytest.raises(InputError, match="motor has no inputs; got limit; leave limit out"):
        read_inputs((), {"limit": 1.0}, "motor")
