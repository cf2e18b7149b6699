"""A force without a sign: against a stroke or along it, over its first or last length."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputWarning, JobError
from slidercrank.model.machine.loads.load import Load
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.optimise.job import Job, job_schema, parse_job
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.driving_load_warnings import net_work
from slidercrank.optimise.search.stroke_warnings import overlong_part_warnings

LENGTHS = {"crank": ["20 mm", "100 mm"], "rod": ["200 mm", "400 mm"], "offset": ["0 mm", "50 mm"]}


def tables(load: dict[str, Any], **variables: Any) -> dict[str, Any]:
    """Return the tables of a job with a force of 350 N."""
    return {
        "name": "Pusher",
        "mechanism": {"speed": "90 rpm"},
        "load": [{"force": "350 N"} | load],
        "variables": LENGTHS | variables,
        "objectives": {"peak_torque": "minimise"},
    }


def problem(load: dict[str, Any], **variables: Any) -> Problem:
    """Return the problem of the job."""
    return parse_job(tables(load, **variables))


@pytest.mark.parametrize(
    ("key", "stroke", "over", "force", "datum"),
    [
        ("opposes", "outward stroke", "last 60 mm", -350.0, "outer dead centre"),
        ("opposes", "outward stroke", "first 60 mm", -350.0, "inner dead centre"),
        ("opposes", "inward stroke", "last 60 mm", 350.0, "inner dead centre"),
        ("opposes", "inward stroke", "first 60 mm", 350.0, "outer dead centre"),
        ("helps", "outward stroke", "the last 6 cm", 350.0, "outer dead centre"),
        ("helps", "inward stroke", "First 0.06 m", -350.0, "outer dead centre"),
    ],
)
def test_a_part_of_a_stroke_is_a_table_from_the_dead_centre_where_it_begins_or_ends(
    key: str, stroke: Any, over: str, force: float, datum: Any
) -> None:
    asked = problem({key: stroke, "over": over})
    (load,) = asked.mechanism.loads
    assert load == PositionTable(
        positions=(0.0, 0.06, 0.06), forces=(force, force, 0.0), datum=datum, during=stroke, may_drive=key == "helps"
    )
    sign = 1.0 if key == "helps" else -1.0
    work = net_work(asked, np.array([[0.05, 0.3, 0.02], [0.02, 0.3, 0.0]]), [0])
    assert work == pytest.approx([sign * 350.0 * 0.06, sign * 350.0 * 0.04], rel=1e-9)  # a stroke of 40 mm has no 60 mm


@pytest.mark.parametrize(
    ("load", "wanted"),
    [
        ({"helps": "outward stroke"}, StrokeForce(outward=350.0, inward=0.0, may_drive=True)),
        ({"helps": "motion", "over": "whole stroke"}, StrokeForce(outward=350.0, inward=-350.0, may_drive=True)),
        ({"opposes": "motion"}, StrokeForce(outward=-350.0, inward=350.0)),
        ({"opposes": "inward stroke", "over": "Whole Stroke"}, StrokeForce(outward=0.0, inward=350.0)),
    ],
)
def test_a_whole_stroke_is_a_force_that_is_constant_in_it(load: dict[str, Any], wanted: Load) -> None:
    assert problem(load).mechanism.loads == (wanted,)


@pytest.mark.parametrize(
    ("load", "said"),
    [
        ({"opposes": "motion", "over": "last 60 mm"}, "must name one stroke; got motion, which means both"),
        ({"opposes": "outward stroke", "over": "60 mm"}, 'must be "first" or "last" and a length'),
        ({"opposes": "outward stroke", "over": 0.06}, 'must be "first" or "last" and a length'),
        (
            {"opposes": "outward stroke", "over": "last 60"},
            'must be a length with its unit; got "60"; write it like "last 60 mm"',
        ),
        ({"opposes": "outward stroke", "over": "last -60 mm"}, "must be positive"),
        ({"resists": "outward stroke"}, "did you mean opposes?"),
        ({"assists": "outward stroke"}, "did you mean helps?"),
        ({"opposes": "outward stroke", "helps": "inward stroke"}, "must be of one kind"),
    ],
)
def test_what_is_no_part_of_a_stroke_is_refused_with_the_remedy(load: dict[str, Any], said: str) -> None:
    with pytest.raises(JobError) as caught:
        problem(load)
    assert said in str(caught.value)


def test_the_part_may_be_a_choice_and_says_that_it_cannot_be_a_range() -> None:
    load = {"opposes": "outward stroke", "over": "last 60 mm"}
    asked = problem(load, **{"load.1.over": {"choices": ["last 60 mm", "last 20 mm"]}})
    assert [part.mechanism.loads[0].knots()[0] for part in asked.parts()] == [(0.0, 0.06, 0.06), (0.0, 0.02, 0.02)]
    with pytest.raises(JobError, match=r"load\.1\.over: must name a number; got last 0\.02 m; make it a choice"):
        problem(load, **{"load.1.over": ["last 20 mm", "last 60 mm"]})


@pytest.mark.parametrize(
    ("load", "place"),
    [
        ({"opposes": "outward stroke", "over": "last 140 mm"}, "last 140 mm of the outward stroke"),
        ({"opposes": "inward stroke", "over": "last 140 mm"}, "last 140 mm of the inward stroke"),
        ({"helps": "outward stroke", "over": "first 140 mm"}, "first 140 mm of the outward stroke"),
    ],
)
def test_a_part_longer_than_every_stroke_is_warned_of(load: dict[str, Any], place: str) -> None:
    asked = problem(load, crank=["20 mm", "60 mm"], offset="0 mm")  # strokes from 40 to 120 mm
    (warning,) = overlong_part_warnings(asked)
    assert warning.startswith(f"load #1 acts over the {place}, but the longest stroke of the sampled designs is ")
    assert warning.endswith(" mm, so it acts over the whole stroke; shorten this part, or leave it out")
    longest = float(warning.partition("designs is ")[2].partition(" mm")[0])
    assert 110.0 < longest <= 120.0
    whole = problem({key: value for key, value in load.items() if key != "over"})
    designs = np.array([[0.06, 0.3, 0.0], [0.02, 0.3, 0.0]])
    assert net_work(asked, designs, [0]) == pytest.approx(net_work(whole, designs, [0]), rel=1e-9)


@pytest.mark.parametrize(
    ("load", "crank"),
    [
        ({"opposes": "outward stroke", "over": "last 100 mm"}, ["20 mm", "60 mm"]),  # some strokes are longer
        ({"opposes": "outward stroke", "over": "last 120 mm"}, "60 mm"),  # the whole stroke, exactly
        ({"opposes": "outward stroke"}, "60 mm"),
    ],
)
def test_a_part_that_a_stroke_can_contain_is_not_warned_of(load: dict[str, Any], crank: Any) -> None:
    assert overlong_part_warnings(problem(load, crank=crank, offset="0 mm")) == []


def test_a_part_that_a_choice_shortens_is_not_warned_of() -> None:
    load = {"opposes": "outward stroke", "over": "last 300 mm"}
    short, long = ({"choices": ["last 300 mm", over]} for over in ("last 60 mm", "last 400 mm"))
    assert overlong_part_warnings(problem(load, **{"load.1.over": short})) == []
    (warning,) = overlong_part_warnings(problem(load, **{"load.1.over": long}))
    assert "last 300 mm" in warning


def test_a_table_that_is_longer_than_the_stroke_is_not_warned_of() -> None:
    table = {"positions": ["0 mm", "300 mm"], "forces": ["-10 N", "-20 N"], "measured_from": "outer dead centre"}
    job = tables({}) | {"load": [table]}
    assert overlong_part_warnings(parse_job(job)) == []


def test_python_warns_of_a_part_longer_than_every_stroke() -> None:
    with pytest.warns(InputWarning, match="load #1 acts over the last 300 mm"):
        sc.problem(tables({"opposes": "inward stroke", "over": "last 300 mm"}))


def test_a_job_with_a_part_of_a_stroke_that_was_read_is_a_job_again() -> None:
    job = Job.model_validate(tables({"helps": "outward stroke", "over": "last 0.1234567890123 in"}))
    again = Job.model_validate(json.loads(job.model_dump_json(exclude_none=True)))
    assert again.machine() == job.machine()


def test_the_schema_has_the_default_and_takes_what_the_job_takes() -> None:
    over = job_schema()["$defs"]["HelpingForce"]["properties"]["over"]
    assert over["default"] == "whole stroke"
    assert over == job_schema()["$defs"]["OpposingForce"]["properties"]["over"]
