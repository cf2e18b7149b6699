"""Contradictions that are refused, or told, before a search: linear rules together, options, functions."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.objectives.flow import VOLUMETRIC_EFFICIENCY
from slidercrank.objectives.formula.expression import Call, Name, linear_form_of_unknown
from slidercrank.objectives.formula.ranges import FormulaBounds, Interval
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.linear_contradictions import impossible_option_notes
from slidercrank.optimise.solve import solve

pytestmark = pytest.mark.usefixtures("little")

NAMES = ("crank", "rod", "offset")


def job(**tables: Any) -> dict[str, Any]:
    return {
        "name": "early",
        "mechanism": {"speed": "100 rpm", "slider": {"mass": "2 kg"}},
        "load": [{"force": "150 N", "opposes": "motion"}],
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["50 mm", "300 mm"], "offset": ["-40 mm", "40 mm"]},
        "objectives": {"stroke": "maximise"},
    } | tables


def rule(factors: np.ndarray) -> str:
    terms = [f"{factor!r} * {name}" for factor, name in zip(factors.tolist(), NAMES, strict=True)]
    return " + ".join(terms).replace("+ -", "- ")


def test_linear_rules_that_a_design_meets_are_taken_and_those_that_exclude_each_other_refused() -> None:
    """Rules through one design; their sum, shifted by a millimetre, excludes them."""
    random = np.random.default_rng(16)
    for _ in range(40):
        crank = random.uniform(0.02, 0.06)
        offset = random.uniform(-0.04, 0.04)
        design = np.array([crank, random.uniform(crank + abs(offset) + 0.01, 0.3), offset])
        factors = np.round(random.uniform(-2.0, 2.0, (2, 3)), 2)
        given = {rule(own): {"equals": f"{float(1e3 * own @ design)!r} mm"} for own in factors}
        parse_job(job(constraints=given))
        total = factors.sum(axis=0)
        given[rule(total)] = {"equals": f"{float(1e3 * total @ design + 1.0)!r} mm"}
        with pytest.raises(JobError, match=r"which exclude each other; .*that; leave out one of them"):
            parse_job(job(constraints=given))


def test_rules_that_no_ranges_make_possible_do_not_advise_to_widen_them() -> None:
    """Two ratios of rod and crank, or a formula that is a number; with a constant ranges may help."""
    random = np.random.default_rng(17)
    for _ in range(10):
        one, two = np.round(random.uniform(1.2, 9.0, 2), 2).tolist()
        with pytest.raises(JobError, match="no range can change that; leave out one of them"):
            parse_job(job(constraints={"rod": {"equals": f"{one} * crank"}, "crank": {"equals": f"rod / {two}"}}))
        lift = {"rod": {"equals": "3 * crank"}, "rod - 2 * crank": {"equals": f"{60.0 + 10.0 * one} mm"}}
        with pytest.raises(JobError, match="or widen the ranges"):
            parse_job(job(constraints=lift))
        with pytest.raises(JobError, match="mm for every design; got min 0 mm; leave it out"):
            parse_job(job(constraints={"crank": {"min": f"crank + {one} mm"}}))


def test_rules_that_meet_beyond_the_ranges_are_refused_and_name_those_that_matter() -> None:
    rules = {"rod": {"equals": "3 * crank + 10 mm"}, "rod + 3 * crank": {"min": "400 mm"}}
    extra = {"2 * crank + rod": {"max": "2 m"}}
    with pytest.raises(JobError) as told:
        parse_job(job(constraints=rules | extra))
    assert "rod + 3 * crank min 400 mm" in str(told.value)
    assert "2 * crank" not in str(told.value)
    parse_job(job(constraints=rules | {"rod + 3 * crank": {"min": "300 mm"}}))


def test_bounds_of_quotients_are_those_of_designs_that_turn() -> None:
    random = np.random.default_rng(17)
    for _ in range(60):
        low, span = random.uniform((0.02, 0.05, -0.05), (0.06, 0.2, 0.03)), random.uniform(0.0, (0.05, 0.2, 0.08))
        ends = {name: Interval(a, a + b) for name, a, b in zip(NAMES, low, span, strict=True)}
        ranges = FormulaBounds(ends, {name: linear_form_of_unknown(name) for name in NAMES}, {})
        x = random.uniform(low, low + span, (20_000, 3))
        edges = random.integers(0, 3, x.shape)
        x = np.where(edges == 0, low, np.where(edges == 1, low + span, x))
        x = x[x[:, 1] > x[:, 0] + np.abs(x[:, 2])]
        if len(x) < 500:
            continue
        for pair in (("rod", "crank"), ("crank", "rod"), ("offset", "rod")):
            above, below = (x[:, NAMES.index(name)] for name in pair)
            values = above / below
            found = ranges.bounds_of_formula(Call("/", tuple(map(Name, pair))))
            assert found.lower <= values.min()
            assert values.max() <= found.upper
            size = found.upper - found.lower
            assert values.min() - found.lower <= 0.2 * size + 1e-12
            assert found.upper - values.max() <= 0.2 * size + 1e-12


@pytest.mark.parametrize("formula", ["asin(rod / crank)", "acos(rod / (crank + abs(offset)))", "asin(-rod / crank)"])
def test_a_function_without_a_value_for_any_design_that_turns_is_refused(formula: str) -> None:
    with pytest.raises(JobError, match="which is always outside it within the ranges"):
        parse_job(job(constraints={formula: {"max": "3 rad"}}))
    parse_job(job(constraints={"asin(crank / rod)": {"max": "3 rad"}}))


@pytest.mark.parametrize("table", ["constraints", "objectives"])
def test_a_formula_without_a_value_for_any_design_is_named_as_the_reason(table: str) -> None:
    formula = "sqrt(1 - peak_torque / 1e-9 N m)"
    asked = {formula: {"max": 2.0} if table == "constraints" else "minimise"}
    front = solve(parse_job(job(**{table: asked}, optimiser={"samples": 256, "designs": 2})))
    assert front.status == "infeasible"
    assert f"{formula} has no value for any of" in front.message
    assert "no crank rotates fully" not in front.message


def test_options_that_no_design_can_have_are_told_and_refused_where_none_is_left() -> None:
    high, low = {"stroke": {"min": "300 mm"}}, {"stroke": {"min": "30 mm"}}

    def with_options(*limits: dict[str, Any]) -> dict[str, Any]:
        options = [{"name": f"M {place}", "constraints": own} for place, own in enumerate(limits)]
        return job(choice=[{"name": "motor", "option": options}], objectives={"peak_torque": "minimise"})

    (told,) = impossible_option_notes(parse_job(with_options(high, low)))
    assert told.endswith("M 0: stroke min 300 mm, where at most 154.919 mm is possible")
    assert impossible_option_notes(parse_job(with_options(low, low))) == []
    with pytest.raises(
        JobError, match="at least one option must have a design within the ranges; none has: for M 0 stroke min 300"
    ):
        parse_job(with_options(high, high))
    with pytest.raises(JobError, match=r'choice "M 1": time_ratio: the time ratio, .* got max 0\.3'):
        parse_job(with_options(low, {"time_ratio": {"max": 0.3}}))


@pytest.mark.parametrize(
    ("table", "given", "written"),
    [
        ("objectives", "minimise", '"minimise"'),
        ("constraints", {"max": "2 kg"}, '{ max = "2 kg" }'),
        ("objectives", {"target": "2 kg"}, '{ target = "2 kg" }'),
    ],
)
def test_a_path_without_quotes_is_written_out_with_them(table: str, given: object, written: str) -> None:
    bare = {"mechanism": {"slider": {"mass": given}}}
    with pytest.raises(JobError) as told:
        parse_job(job(**{table: bare | ({"stroke": "maximise"} if table == "objectives" else {})}))
    assert f'write it as "mechanism.slider.mass" = {written}' in str(told.value)


def test_one_combination_is_one() -> None:
    """Of two offsets the slow stroke leaves one."""

    def of(**constraints: Any) -> dict[str, Any]:
        sizes = {"crank": "40 mm", "rod": "150 mm", "offset": {"values": ["-10 mm", "10 mm"]}}
        wanted = {"peak_torque": "minimise"}
        return job(variables=sizes, constraints=constraints, objectives=wanted, optimiser={"samples": 64, "designs": 4})

    for slow, words in (
        ({"slow_stroke": "outward"}, "not even the one combination"),
        ({}, "none of 2 combinations of"),
    ):
        with pytest.raises(JobError, match=words):
            parse_job(of(stroke={"equals": "80.1 mm"}, **slow))
    assert "exact: 1 combination of" in solve(parse_job(of(slow_stroke="outward"))).message
    assert "exact: all 2 combinations of" in solve(parse_job(of())).message


def test_rules_that_differ_by_the_rounding_of_their_units_are_one() -> None:
    parse_job(job(constraints={"rod": {"equals": "3 inch"}, "2 * rod": {"equals": "152.4 mm"}}))


def test_a_clearance_volume_that_no_stroke_of_the_job_delivers_from_is_refused_with_the_greatest_one() -> None:
    """The longest stroke is 2 sqrt(r l); just below the told volume some design delivers, from it on none does."""
    random = np.random.default_rng(18)
    for _ in range(6):
        discharge, exponent = random.uniform(3.0, 12.0), random.uniform(1.0, 1.4)
        cylinder = {
            "bore": "70 mm",
            "suction": "1 bar",
            "discharge": f"{discharge} bar",
            "expansion_exponent": exponent,
            "clearance": 0.01,
        }
        given = job(load=[cylinder | {"clearance_volume": "900 cm^3"}], objectives={"peak_torque": "minimise"})
        with pytest.raises(JobError, match=r"load #1\.clearance_volume: must be below .*; got 900 cm\^3") as refusal:
            parse_job(given)
        told = float(str(refusal.value).split("below ")[1].split(" cm^3")[0])
        corner = np.array([[0.06, 0.3, 0.24 - 1e-9]])  # the inner dead centre is at the pivot
        problem = parse_job(job(load=[cylinder | {"clearance_volume": "1 cm^3"}]))
        for factor, delivers in ((0.99, True), (1.01, False)):
            load = problem.mechanism.loads[0]
            assert isinstance(load, Compressor)
            load = replace(load, clearance_volume=factor * told * 1e-6)
            machine = replace(problem.mechanism, loads=(load,))
            assert (VOLUMETRIC_EFFICIENCY.evaluate(machine, corner).values[0] > 0.0) == delivers
        held = given | {"constraints": {"stroke": {"max": "40 mm"}}}
        with pytest.raises(JobError, match="otherwise a stroke of 40 mm, the longest in the job, delivers nothing"):
            parse_job(held)
        followed = cylinder | {"clearance_volume": f"{0.9 * told} cm^3"}
        parse_job(given | {"load": [followed]})
        parse_job(given | {"variables": given["variables"] | {"load.1.bore": ["70 mm", "400 mm"]}})
