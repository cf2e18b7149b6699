"""Answers of all questions on random machines: as their types declare them, in inches the metric numbers changed."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.objectives.kinds import (
    DISPLAYED_KINDS,
    PRESSURE,
    name_and_kind_of_key,
    name_unit_and_factor_of_key,
    unit_text,
)
from slidercrank.objectives.tables.curve_extremes import defined_curves
from slidercrank.service.api.app import create_app
from slidercrank.service.designs.measured_curves_file import parse_measured_curves
from slidercrank.service.questions.design_question import BoundQuestion, DesignQuestion
from slidercrank.service.questions.discovery import DESIGN_QUESTIONS, QUESTION_COMMANDS, TOPICS
from slidercrank.service.questions.measured import MEASURED
from slidercrank.service.questions.record_types import schema_of
from slidercrank.service.render.blocks import Block, Sentence, Value
from slidercrank.service.render.formatting import plain_blocks
from slidercrank.service.runs.result import json_ready
from slidercrank.service.store import Store
from tests.case_count import ALL_CASES, case_count
from tests.doors.scripts import JOBS
from tests.service.machines import SORTS, Random, linkage_of, some_design, some_problem

METRIC = "|".join(
    sorted((re.escape(unit_text(kind.metric.symbol)) for kind in DISPLAYED_KINDS if kind.inch), key=len, reverse=True)
)
_LB_IN2 = 1.0 / (0.45359237 * 0.0254**2)
_PSI = PRESSURE.display_unit("inch").factor * 1e5
OTHER_KEYS = {
    "saving_N_per_kg": ("saving_lbf_per_lb", 0.45359237 / 4.4482216152605),
    "saving_per_um": ("saving_per_in", 25400.0),
    "bound_saving_per_um": ("bound_saving_per_in", 25400.0),
    **{f"{name}_kgm2": (f"{name}_lb_in2", _LB_IN2) for name in ("flywheel", "classical_estimate")},
    **{f"{name}_kgm2": (f"{name}_lb_in2", _LB_IN2) for name in ("flywheels", "classical_estimates")},
    "least_pressure_bar": ("least_pressure_psi", _PSI),
    "greatest_pressure_bar": ("greatest_pressure_psi", _PSI),
}
"""Key and factor in inches of what has no unit of one kind alone."""


def some_inputs(
    question: DesignQuestion, problem: sc.Problem, design: Sequence[float], random: Random
) -> dict[str, Any]:
    """Return inputs in SI that most designs of a machine can be asked with."""
    crank, rod, offset = design[:3]
    if question.name == "swing":
        if problem.motion is not None:
            return {"driver": str(random.choice(["crank", "slider"]))}
        start = float(random.uniform(0.2, 1.0))
        timed = random.random() < 0.6
        more = {"law": "harmonic", "duration": float(random.uniform(0.2, 2.0))} if timed else {}
        return {"start": start, "end": start + 0.7, "driver": str(random.choice(["crank", "slider"])), **more}
    if question.name == "lever":
        ends = {"start": float(random.uniform(-1.0, -0.6)), "end": float(random.uniform(0.2, 0.6)), "law": "slow"}
        carried = {"mass": 40.0, "centre": crank, "bore": 0.05, "piston_rod": 0.03}
        return ends | (carried if random.random() < 0.5 else {"length_tolerance": 1e-4})
    if question.name == "law":
        return {"objective": str(random.choice(["peak torque", "rms torque"]))}
    if question.name == "inverse":
        angle = float(random.uniform(0.3, 1.7))
        at = crank * math.cos(angle) + math.sqrt(rod**2 - (offset - crank * math.sin(angle)) ** 2)
        rates = {"slider_velocity": -0.4, "slider_acceleration": 2.5}
        return {"slider_position": at, **(rates if random.random() < 0.5 else {})}
    given: dict[str, Any] = {}
    for one in question.inputs:
        if one.required or random.random() < 0.6:
            given[one.name] = _some_value(one.name, one.words, crank, random)
    if "rod_mass" in given or "rod_radius" in given or "arm" in given:
        given |= {"rod_mass": 1.3, "rod_radius": 0.05}
    return given


def _some_value(name: str, words: Any, crank: float, random: Random) -> Any:
    if words is not None:
        return str(random.choice(get_args(words)))
    shares = {"limit": 3e-4, "fluctuation": 0.013, "crank_angle": 1.1, "rated_torque": 44.0, "mass": 2.1}
    return float(random.uniform(0.8, 1.2)) * shares.get(name, 0.2 * crank)


def asked_of(question: DesignQuestion, problem: sc.Problem, design: Sequence[float], random: Random) -> BoundQuestion:
    machine = problem.mechanism.with_values(list(design[3:]))
    return question.bind_to_problem(
        machine, linkage_of(problem, design), problem, some_inputs(question, problem, design, random)
    )


def answers_of(name: str) -> Iterator[tuple[BoundQuestion, dict[str, Any]]]:
    """Yield each question, one or two designs of every kind of machine that it applies to, and the numbers."""
    random = np.random.default_rng(sum(map(ord, name)))
    for sort in SORTS:
        for _ in range(2):
            problem = some_problem(sort, random)
            if name == "flywheel" and sort == "turn":
                continue  # with friction it takes 12 s
            try:
                asked = asked_of(DESIGN_QUESTIONS[name], problem, some_design(problem, random), random)
                yield asked, asked.numbers()
            except (InputError, AssemblyError):
                continue
            if not ALL_CASES:
                break


def assert_declared(record_type: Any, record: Any) -> None:
    """Compare a record of JSON with its schema, and what the schema says of its numbers with their keys."""
    judge = pytest.importorskip("jsonschema_rs")
    errors = judge.Draft202012Validator(schema_of(record_type)).iter_errors(record)
    assert [f"{error.instance_path}: {error.message}" for error in errors] == []


def assert_in_inches(metric: Any, inch: Any, factor: float = 1.0) -> None:
    """Compare the records of one answer in both systems; factor: of numbers without a key of their own."""
    if isinstance(metric, dict):
        for (key, value), (shown, other) in zip(metric.items(), inch.items(), strict=True):
            name, kind = name_and_kind_of_key(key)
            own = kind.display_unit("inch").factor / kind.metric.factor
            expected = OTHER_KEYS.get(key, (name + kind.display_unit("inch").suffix if kind.inch else key, own))
            assert shown == expected[0]
            assert_in_inches(value, other, expected[1] if name_unit_and_factor_of_key(key)[1] else factor)
    elif isinstance(metric, list):
        for one, other in zip(metric, inch, strict=True):
            assert_in_inches(one, other, factor)
    elif isinstance(metric, float):
        assert inch == pytest.approx(factor * metric, rel=1e-12)
    else:
        assert inch == metric


def numbers_of(record: Any) -> Iterator[float]:
    if isinstance(record, dict | list):
        for value in record.values() if isinstance(record, dict) else record:
            yield from numbers_of(value)
    elif isinstance(record, float):
        yield abs(record)


def values_of(text: Any) -> Iterator[Value]:
    """Yield the values of blocks and texts."""
    if isinstance(text, Value):
        yield text
    elif isinstance(text, Sentence):
        yield from values_of(text.text)
    elif isinstance(text, tuple | list):
        for part in text:
            yield from values_of(part)
    elif hasattr(text, "rows"):
        yield from values_of(text.rows)


def assert_shown_in_inches(blocks: Sequence[Block], record: Any, near: float = 1e-12) -> None:
    """Compare the numbers of a text in inches, which have no metric unit, with those of JSON in inches."""
    told = np.array(sorted(numbers_of(record)))
    for value in values_of(blocks):
        if value.number is not None and math.isfinite(value.number) and value.kind.inch is not None:
            number = abs(value.kind.inch.factor * value.number)
            steps = np.array([1.0, 1e-4])  # savings are told for 0.0001 in
            assert np.isclose(np.outer(steps, told), number, rtol=1e-9, atol=near).any(), (value, number)
    for block in plain_blocks(blocks, "inch"):
        for text in (block.sentence, *block.heads, *(cell for row in block.rows for cell in row)):
            assert not re.search(rf"(?:^|\s)(?:{METRIC})(?![\w^/²³])", text), text


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in DESIGN_QUESTIONS if name != "clearance"])
def test_answers_of_random_machines_are_as_declared_and_the_same_in_inches(name: str) -> None:
    answers = 0
    for asked, numbers in answers_of(name):
        answers += 1
        inch = asked.numbers_in_units(numbers, "inch")
        assert_declared(asked.question.record_type, json_ready(numbers))
        if name != "sensitivity":  # whose entries have units of their own: see test_topics_in_inches
            assert_in_inches(numbers, inch)
        near = 2e-5 if name == "counterweight" else 1e-12  # places of its mass are rounded to 0.001 mm
        assert_shown_in_inches(asked.blocks(numbers), inch, near)
    assert answers >= case_count(1, 2)


@pytest.mark.slow
def test_impacts_in_a_loose_joint_are_as_declared_and_the_same_in_inches() -> None:
    problem = sc.load_job(JOBS / "loose.toml", require_feasible=False)
    asked = TOPICS["clearance"].bind_to_design(problem.mechanism.nominal, sc.Linkage(0.03, 0.16, 0.01))
    analysis = asked.question.analysis_module
    stopped = analysis.run_simulation(asked.mechanism, asked.linkage, cancelled=lambda: True)
    done = analysis.run_simulation(asked.mechanism, asked.linkage, cycles=3, discard=1)
    for run in (stopped, done, replace(done, discard=2)):
        numbers = analysis.numbers(asked.mechanism, asked.linkage, run=run)
        inch = asked.numbers_in_units(numbers, "inch")
        assert_declared(asked.question.record_type, json_ready(numbers))
        assert_in_inches(numbers, inch)
        assert_shown_in_inches(asked.blocks(numbers), inch)


@pytest.mark.parametrize("sort", ["turn", "cylinders", "loose"])
def test_deviations_of_measured_curves_are_as_declared_and_the_same_in_inches(sort: str) -> None:
    random = np.random.default_rng(4)
    problem = some_problem(sort, random)
    machine, linkage = problem.mechanism.nominal, linkage_of(problem, some_design(problem, random))
    angles = np.sort(random.uniform(0.0, 2.0 * math.pi, 12))
    curves = defined_curves(machine, linkage, angles)
    heads = ["crank_angle_deg", *(curve.field for curve in curves)]
    noisy = [curve.kind.metric.factor * curve.values * random.uniform(0.9, 1.1, 12) for curve in curves]
    rows = np.column_stack([np.degrees(angles), *noisy]).tolist()
    text = "\n".join([",".join(heads), *(",".join(map(repr, row)) for row in rows)])
    asked = MEASURED.bind_to_design(machine, linkage, {"measured": parse_measured_curves(text, machine, linkage)})
    numbers = asked.numbers()
    assert len(numbers["curves"]) == len(curves)
    inch = asked.numbers_in_units(numbers, "inch")
    assert_declared(MEASURED.record_type, json_ready(numbers))
    assert_in_inches(numbers, inch)
    assert_shown_in_inches(asked.blocks(numbers)[:4], inch)  # below, what was read of the file is said in its units


ALL = {**DESIGN_QUESTIONS, "measured": MEASURED}


@pytest.mark.parametrize("name", ALL)
def test_a_schema_is_closed_says_its_units_and_why_a_number_may_be_null(name: str) -> None:
    schema = schema_of(ALL[name].record_type)
    records = [schema, *schema.get("$defs", {}).values()]
    assert all(record["additionalProperties"] is False and record["description"] for record in records)
    for record in records:
        for key, of in record["properties"].items():
            _, unit, _ = name_unit_and_factor_of_key(key.partition("_per_")[0])
            assert unit in of["title"]
            items = of.get("items", {})
            for value in (of, items):
                if {"type": "null"} in value.get("anyOf", ()):
                    assert value.get("description"), f"{key} is null for a reason"


def test_the_description_of_the_api_has_the_schema_of_every_answer(tmp_path: Path) -> None:
    with Store(tmp_path / "store.db") as store:
        schemas = create_app(store).openapi()["components"]["schemas"]

    def described(model: str, field: str) -> list[Any]:
        return [one.get("$ref", "").rpartition("/")[2] for one in schemas[model]["properties"][field]["anyOf"]]

    topics = [schema_of(topic.record_type)["title"] for topic in TOPICS.values()]
    assert described("TopicAnswer", "numbers") == [*topics, ""]
    for model in ("AnalysisModel", "StoredAnalysisModel"):
        places = schemas[model]["properties"]["analysis"]["properties"]
        assert {name: of["$ref"].rpartition("/")[2] for name, of in places.items()} == dict(
            zip(TOPICS, topics, strict=True)
        )
    for name in (*QUESTION_COMMANDS, "measured"):
        assert described(f"{name.capitalize()}Model", name) == [schema_of(ALL[name].record_type)["title"], ""]
    for name, question in ALL.items():
        schema = schema_of(question.record_type)
        text = json.dumps(schemas[schema["title"]]).replace("#/components/schemas/", "#/$defs/")
        assert json.loads(text) == {key: value for key, value in schema.items() if key != "$defs"}, name
