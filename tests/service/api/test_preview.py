"""A job while it is being written: what is wrong, where, and what its ranges allow."""

from __future__ import annotations

import json
import math
import time
import tomllib
from copy import deepcopy
from typing import Any
from unittest.mock import Mock

import httpx
import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job.job_file import MOST
from slidercrank.optimise.search.polish import polish_designs
from slidercrank.service.preview import possible_values
from tests.service.api.serving import refusal_sentence
from tests.service.weak_pins import TABLES

Job = dict[str, Any]


@pytest.fixture
def feeder(pytestconfig: pytest.Config) -> Job:
    return tomllib.loads((pytestconfig.rootpath / "runs" / "feeder.toml").read_text())


def preview(client: httpx.Client, job: Job) -> dict[str, Any]:
    response = client.post("/preview", json={"job": job})
    assert response.status_code == 200, response.text
    found: dict[str, Any] = response.json()
    return found


def test_a_valid_job_is_understood_as_check_understands_it(shared: httpx.Client, feeder: Job) -> None:
    found = preview(shared, feeder)
    assert found["wrong"] == []
    assert found["understood"] == shared.post("/check", json={"job": feeder}).json()
    assert found["allowed"]["unchecked"] == []


def test_a_number_that_probably_means_another_unit_is_among_the_warnings(shared: httpx.Client, feeder: Job) -> None:
    job = feeder | {"mechanism": feeder["mechanism"] | {"speed": -251}}
    (warning,) = preview(shared, job)["understood"]["warnings"]
    plate = {"mechanism": feeder["mechanism"] | {"speed": "2400 1/min"}}
    assert "crank speed 2400 rpm (counter-clockwise)" in preview(shared, feeder | plate)["understood"]["given"]
    assert warning.startswith(
        "mechanism.speed = -251 has no unit and is read as -251 rad/s (-2396.87 rpm); if you mean"
    )


@pytest.mark.parametrize(
    ("offset", "asked", "strokes"),
    [
        (["-40 mm", "40 mm"], None, ["inward", "outward"]),
        (["-40 mm", "40 mm"], "inward", ["inward"]),
        (["15 mm", "40 mm"], None, ["outward"]),
        (["-40 mm", "-15 mm"], None, ["inward"]),
        (["0 mm", "40 mm"], None, ["outward"]),
        ("0 mm", None, ["equal"]),
    ],
)
@pytest.mark.parametrize("profile", [{}, {"speed_profile": {"cosines": [0.0, 1e-3]}}], ids=["constant", "profile"])
def test_slow_strokes_are_those_of_all_designs_that_meet_the_job_not_of_the_example(
    offset: Any, asked: str | None, strokes: list[str], profile: Job, shared: httpx.Client
) -> None:
    """At constant speed the offset's sign decides, for a clockwise crank a positive one for a slow outward stroke."""
    job = {
        "mechanism": {"speed": "-60 rpm", **profile},
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["120 mm", "250 mm"], "offset": offset},
        "constraints": {"slow_stroke": asked} if asked else {},
    }
    assert preview(shared, job)["allowed"]["slow_strokes"] == strokes


def test_the_example_is_a_linkage_within_the_ranges_that_meets_the_requirements(
    shared: httpx.Client, feeder: Job
) -> None:
    found = preview(shared, feeder)
    assert set(found["allowed"]["met_by_all"]) == {"stroke", "rod_to_offset"}
    assert found["example"]["extremes"] is None
    example = found["example"]
    assert example["feasible"]
    assert example["clockwise"]
    linkage = Linkage(*(1e-3 * example[f"{name}_mm"] for name in ("crank", "rod", "offset")))
    assert 80.0 <= 1e3 * linkage.stroke <= 90.0
    assert linkage.rod / linkage.offset == pytest.approx(3.2, rel=1e-12)
    assert 20.0 <= example["crank_mm"] <= 60.0
    assert example["stroke_mm"] == pytest.approx(1e3 * linkage.stroke, rel=1e-12)
    assert example["slow_stroke"] == "outward"
    motion = example["motion"]
    at = linkage.at([math.radians(angle) for angle in motion["crank_angle_deg"]])
    assert motion["slider_position_mm"] == pytest.approx((1e3 * at.slider_position).tolist(), rel=1e-12)


@pytest.mark.parametrize("speed", ["90 rpm", "-90 rpm", None])
def test_curves_of_three_fixed_lengths_are_those_of_the_linkage_and_rest_at_its_dead_centres(
    shared: httpx.Client, speed: str | None
) -> None:
    job: Job = {"variables": {"crank": "50 mm", "rod": "150 mm", "offset": "40 mm"}}
    example = preview(shared, job | ({"mechanism": {"speed": speed}} if speed else {}))["example"]
    omega = {"90 rpm": 3.0 * math.pi, "-90 rpm": -3.0 * math.pi, None: 1.0}[speed]
    curves = {key: np.array(values) for key, values in example["motion"].items()}
    theta, step = np.radians(curves["crank_angle_deg"]), 1e-4

    def position(angle: Any) -> Any:  # m: x = r cos(theta) + sqrt(l^2 - (e - r sin(theta))^2)
        return 0.05 * np.cos(angle) + np.sqrt(0.15**2 - (0.04 - 0.05 * np.sin(angle)) ** 2)

    before, at, after = position(theta - step), position(theta), position(theta + step)
    assert curves["slider_position_mm"] == pytest.approx(1e3 * at, rel=1e-12)
    assert curves["slider_velocity_m_s"] == pytest.approx(omega * (after - before) / (2 * step), abs=1e-7)
    acceleration = omega**2 * (after - 2 * at + before) / step**2
    assert curves["slider_acceleration_m_s2"] == pytest.approx(acceleration, abs=1e-5)
    fine = np.linspace(0.0, 2.0 * math.pi, 200_001)
    speeds = (position(fine + step) - position(fine - step)) * omega / (2 * step)
    accelerations = (position(fine + step) - 2 * position(fine) + position(fine - step)) * omega**2 / step**2
    angles = np.degrees(np.arccos((0.04 - 0.05 * np.sin(fine)) / 0.15))
    transmission = np.minimum(angles, 180.0 - angles)
    for key, values, tolerance in (
        ("slider_position_mm", 1e3 * position(fine), 1e-6),
        ("slider_velocity_m_s", speeds, 1e-7),
        ("slider_acceleration_m_s2", accelerations, 1e-5),
        ("transmission_angle_deg", transmission, 1e-3),  # a cusp: the greatest value lies between the points
    ):
        least, greatest = example["extremes"][key]
        assert (least["value"], greatest["value"]) == pytest.approx((values.min(), values.max()), abs=tolerance)
        for end in (least, greatest):
            there = np.interp(math.radians(end["crank_angle_deg"]), fine, values)
            assert there == pytest.approx(end["value"], abs=10 * tolerance)
    centres = position(np.radians(example["dead_centres_deg"]))
    assert 1e3 * centres == pytest.approx(example["slider_ends_mm"], rel=1e-12)
    assert example["slider_ends_mm"] == pytest.approx([1e3 * math.sqrt(d) for d in (0.0084, 0.0384)], rel=1e-12)


WIDE: Job = {"crank": ["20 mm", "100 mm"], "rod": ["60 mm", "400 mm"], "offset": ["0 mm", "100 mm"]}
NOT_MET = {
    "too short a rod": {"variables": WIDE | {"crank": "50 mm", "rod": ["30 mm", "45 mm"]}},
    "one short rod": {"variables": {"crank": "50 mm", "rod": "80 mm", "offset": "40 mm"}},
    "two against each other": {
        "variables": WIDE,
        "constraints": {"time_ratio": {"min": 2, "max": 3}, "transmission_angle": {"min": "40 deg"}},
    },
    "hardly long enough rods": {
        "variables": {"crank": ["50 mm", "60 mm"], "rod": ["60 mm", "81 mm"], "offset": ["30 mm", "90 mm"]}
    },
    "beyond the ranges": {"variables": WIDE, "constraints": {"stroke": {"equals": "400 mm"}}},
}


@pytest.mark.parametrize("name", NOT_MET)
def test_the_change_beside_a_sentence_settles_it(shared: httpx.Client, name: str) -> None:
    job = deepcopy(NOT_MET[name])
    allowed = preview(shared, job)["allowed"]
    assert allowed["feasible_share"] == 0.0
    assert [change["sentence"] for change in allowed["changes"]] == allowed["said"] != []
    for change in allowed["changes"]:
        table, key = change["path"].split(".")
        changed = preview(shared, job | {table: job[table] | {key: change["value"]}})["allowed"]
        assert change["sentence"] not in changed["said"]
        assert changed["said"] == [] or all("designs tried" in sentence for sentence in changed["said"]), changed[
            "said"
        ]


@pytest.mark.parametrize("rod", ["200 mm", [150, 300], 200])
@pytest.mark.parametrize("offset", ["0 mm", [0, 40]])
def test_lengths_in_the_wrong_unit_are_the_cause_and_each_has_its_change(
    shared: httpx.Client, rod: Any, offset: Any
) -> None:
    job = {"variables": {"crank": [20, 100], "rod": rod, "offset": offset}}
    plain = [f"variables.{name}" for name, value in job["variables"].items() if not isinstance(value, str)]
    allowed = preview(shared, job)["allowed"]
    assert [change["path"] for change in allowed["changes"]] == plain
    assert [change["sentence"] for change in allowed["changes"]] == allowed["said"]
    for change in allowed["changes"]:
        name = change["path"].removeprefix("variables.")
        stated = job["variables"][name]
        assert change["value"] == ([n and f"{n} mm" for n in stated] if isinstance(stated, list) else f"{stated} mm")
        job["variables"][name] = change["value"]
    settled = preview(shared, job)["allowed"]
    assert settled["said"] == settled["changes"] == []
    assert settled["feasible_share"] > 0.0


@pytest.mark.parametrize("more", [{}, {"time_ratio": {"min": 1.1, "max": 1.12}}, {"rod_to_offset": {"equals": 3.2}}])
def test_as_many_designs_meet_an_exact_value_as_a_thin_band_around_it(shared: httpx.Client, more: Job) -> None:
    def share(stroke: Job) -> float:
        constraints = {"stroke": stroke, "transmission_angle": {"min": "40 deg"}, **more}
        return float(preview(shared, {"variables": WIDE, "constraints": constraints})["allowed"]["feasible_share"])

    exact = share({"equals": "100 mm"})
    assert exact > 0.3
    for half in (0.01, 1.0, 5.0):
        assert share({"min": f"{100 - half} mm", "max": f"{100 + half} mm"}) == pytest.approx(exact, abs=0.06)


@pytest.mark.parametrize("offset", [(0.0, 100.0), (-10.0, 150.0)])
def test_fractions_beside_the_form_are_those_of_the_volume_of_the_box(
    shared: httpx.Client, offset: tuple[float, float]
) -> None:
    ends = {"crank": (20.0, 100.0), "rod": (60.0, 400.0), "offset": offset}
    variables = {name: [f"{low:g} mm", f"{high:g} mm"] for name, (low, high) in ends.items()}
    random = np.random.default_rng(1)
    r, l, e = (random.uniform(low, high, 100_000) for low, high in ends.values())
    rotates = l > r + np.abs(e)
    feasible = rotates & (np.abs(e) + r <= l * math.cos(math.radians(40.0)))
    constraints = {"transmission_angle": {"min": "40 deg"}}
    allowed = preview(shared, {"variables": variables, "constraints": constraints})["allowed"]
    assert allowed["turning_share"] == pytest.approx(rotates.mean(), abs=0.03)
    assert allowed["feasible_share"] == pytest.approx(feasible.mean(), abs=0.03)
    assert allowed["hardest_share"] == pytest.approx(feasible.sum() / rotates.sum(), abs=0.03)


def test_a_crank_that_locks_is_told_how_much_longer_a_rod_it_needs(shared: httpx.Client) -> None:
    lengths = {"crank": "50 mm", "rod": "80 mm", "offset": "-40 mm"}
    (said,) = preview(shared, {"variables": lengths})["allowed"]["said"]
    assert said == (
        "this crank does not rotate fully: the rod must be longer than crank + offset, 90 mm; "
        "got 80 mm; lengthen the rod by more than 10 mm"
    )
    assert preview(shared, {"variables": lengths | {"rod": "120 mm"}})["allowed"]["said"] == []
    ranges = {"crank": ["50 mm", "60 mm"], "rod": ["70 mm", "80 mm"], "offset": ["-40 mm", "-35 mm"]}
    (said,) = preview(shared, {"variables": ranges})["allowed"]["said"]
    assert said.endswith("offset, at least 85 mm; got at most 80 mm; lengthen the rod by more than 5 mm")


def test_strokes_of_the_ranges_are_those_of_the_closed_form(shared: httpx.Client) -> None:
    ranges = {"crank": ["20 mm", "60 mm"], "rod": "200 mm", "offset": "50 mm"}
    allowed = preview(shared, {"variables": ranges})["allowed"]
    ends = [1e3 * float(Linkage(crank, 0.2, 0.05).stroke) for crank in (0.02, 0.06)]
    assert allowed["stroke_mm"] == pytest.approx(ends, rel=1e-9)
    assert allowed["turning_share"] == 1.0


def test_the_greatest_time_ratio_with_a_transmission_angle_is_that_of_the_edge(shared: httpx.Client) -> None:
    job = {
        "variables": {"crank": ["20 mm", "60 mm"], "rod": "100 mm", "offset": ["0 mm", "80 mm"]},
        "constraints": {"transmission_angle": {"min": "40 deg"}},
    }
    allowed = preview(shared, job)["allowed"]
    cosine = 0.1 * math.cos(math.radians(40.0))
    fine = (0.02 + 1e-5 * step for step in range(4001))
    best = max(float(Linkage(crank, 0.1, cosine - crank).time_ratio) for crank in fine if cosine > crank)
    assert allowed["time_ratio"][1] == pytest.approx(best, rel=1e-3)
    assert allowed["time_ratio"][1] <= best * (1.0 + 1e-6)


def test_a_thin_band_allows_what_each_value_in_it_allows(shared: httpx.Client) -> None:
    ranges = {"crank": ["20 mm", "100 mm"], "rod": ["60 mm", "400 mm"], "offset": ["0 mm", "100 mm"]}

    def greatest(stroke: Job) -> float:
        constraints = {"stroke": stroke, "transmission_angle": {"min": "40 deg"}}
        ratio = preview(shared, {"variables": ranges, "constraints": constraints})["allowed"]["time_ratio"]
        return float(ratio[1])

    band = greatest({"min": "99 mm", "max": "101 mm"})
    assert band >= 0.995 * greatest({"equals": "100 mm"})
    assert band <= 1.2863  # what no linkage with 40 deg exceeds


def test_what_is_typed_besides_the_ranges_searches_no_ends_anew(
    shared: httpx.Client, feeder: Job, monkeypatch: pytest.MonkeyPatch
) -> None:
    changed = deepcopy(feeder)
    changed["mechanism"]["slider"]["mass"] = "7.25 kg"
    wider = deepcopy(feeder)
    wider["variables"]["crank"] = ["19.5 mm", "60 mm"]
    first = preview(shared, feeder)
    searched = Mock(side_effect=polish_designs)
    monkeypatch.setattr(possible_values, "polish_designs", searched)
    again = preview(shared, changed)
    assert again["understood"] != first["understood"]
    assert again["allowed"] == first["allowed"]
    searched.assert_not_called()
    preview(shared, wider)
    searched.assert_called()


def test_a_time_ratio_that_no_linkage_has_is_said_with_what_is_possible(shared: httpx.Client, feeder: Job) -> None:
    feeder["constraints"] |= {"time_ratio": {"min": 2.0}, "transmission_angle": {"min": "40 deg"}}
    found = preview(shared, feeder)
    (wrong,) = found["wrong"]
    assert wrong["path"] == "constraints.time_ratio"
    assert "it is at most 1.28521" in wrong["sentence"]
    assert found["understood"] is None
    assert any(
        "time ratio at least 2 is asked, at most 1.28521 is possible" in sentence
        for sentence in found["allowed"]["said"]
    )


def test_a_requirement_that_no_design_meets_is_blamed_and_not_one_that_most_meet(
    shared: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is the safety that none has, not the transmission angle: that is met by many."""
    monkeypatch.setattr(possible_values, "PATIENCE", 60.0)
    for safety in ({"min": 500.0}, {"max": 0.01}):
        job = {**TABLES, "constraints": {"transmission_angle": {"min": "70 deg"}, "static_safety": safety}}
        allowed = preview(shared, job)["allowed"]
        assert (allowed["hardest"], allowed["hardest_share"], allowed["feasible_share"]) == ("static_safety", 0.0, 0.0)
        (said,) = allowed["said"]
        assert "on its own, static safety is met by 0 % of those that rotate fully" in said
        assert "transmission angle" not in said
        (change,) = allowed["changes"]
        job["constraints"]["static_safety"] = change["value"]
        assert preview(shared, job)["allowed"]["said"] == []
    job["constraints"]["static_safety"] = {"min": 0.01}
    allowed = preview(shared, job)["allowed"]
    assert allowed["said"] == []
    assert allowed["hardest"] == "transmission_angle"
    assert 0.0 < allowed["hardest_share"] < 1.0


def test_what_the_samples_hold_though_the_search_varies_it_is_said(
    shared: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(possible_values, "PATIENCE", 60.0)
    varying = {**TABLES["variables"], "sections": {"pins": {"crank_pin": ["5 mm", "15 mm"]}}}
    job = {**TABLES, "variables": varying, "constraints": {"static_safety": {"min": 500.0}}}
    (said,) = preview(shared, job)["allowed"]["said"]
    assert "tried with the job's values of sections.pins.crank_pin meets every requirement" in said


def test_an_infinite_value_meets_a_least_one(shared: httpx.Client) -> None:
    job = {
        "variables": {"crank": ["20 mm", "60 mm"], "rod": "200 mm", "offset": "0 mm"},
        "constraints": {"rod_to_offset": {"min": 3.0}, "transmission_angle": {"min": "75 deg"}},
    }
    allowed = preview(shared, job)["allowed"]
    assert allowed["hardest"] == "transmission_angle"
    assert allowed["transmission_angle_deg"] is not None


def test_ranges_in_which_nothing_turns_are_said(shared: httpx.Client) -> None:
    found = preview(shared, {"variables": {"crank": "100 mm", "rod": "90 mm", "offset": "0 mm"}})
    assert found["example"] is None
    assert found["allowed"]["turning_share"] == 0.0
    assert "this crank does not rotate fully" in found["allowed"]["said"][0]


WRONG = {
    "name": ("name", ""),
    "mechanism.speed": ("mechanism", "speed", "300"),
    "mechanism.slider.mass": ("mechanism", "slider", "mass", "2 mm"),
    "mechanism.rod.mass": ("mechanism", "rod", "mass", "heavy"),
    "load #2.force": ("load", 1, "force", "-1 N"),
    "tolerances.crank": ("tolerances", "crank", "1 kg"),
    "variables.crank": ("variables", "crank", ["60 mm", "20 mm"]),
    "constraints.stroke.min": ("constraints", "stroke", "min", "80"),
    "constraints.transmission_angle": ("constraints", "transmission_angle", {"min": "95 deg"}),
    "objectives.time_ratio": ("objectives", "time_ratio", "best"),
    "optimiser.designs": ("optimiser", "designs", 0),
    "mechanism.colour": ("mechanism", "colour", "red"),
}


@pytest.mark.parametrize("path", WRONG)
def test_what_is_wrong_has_its_place(shared: httpx.Client, feeder: Job, path: str) -> None:
    *keys, last, value = WRONG[path]
    part: Any = feeder
    for key in keys:
        part = part[key]
    part[last] = value
    found = preview(shared, feeder)
    assert [wrong["path"] for wrong in found["wrong"]] == [path]
    assert not found["wrong"][0]["sentence"].startswith(path)


def test_several_wrong_values_are_said_at_once_and_the_ranges_are_still_looked_at(
    shared: httpx.Client, feeder: Job
) -> None:
    feeder["name"] = ""
    feeder["mechanism"]["slider"]["mass"] = "x"
    found = preview(shared, feeder)
    assert {wrong["path"] for wrong in found["wrong"]} == {"name", "mechanism.slider.mass"}
    assert found["allowed"]["stroke_mm"] is not None
    assert found["example"]["clockwise"]


def test_an_empty_job_says_what_is_missing(shared: httpx.Client) -> None:
    found = preview(shared, {})
    assert {"name", "mechanism", "variables", "objectives"} == {wrong["path"] for wrong in found["wrong"]}
    assert (found["allowed"], found["example"]) == (None, None)


def test_a_job_that_names_a_file_of_the_service_is_refused(shared: httpx.Client, feeder: Job) -> None:
    feeder["target_motion"] = {"file": "/etc/passwd"}
    (wrong,) = preview(shared, feeder)["wrong"]
    assert wrong["path"] == "target_motion"
    assert "a file must be in the folder of the job file, or be sent" in wrong["sentence"]


def hostile(feeder: Job) -> dict[str, Job]:
    """Return jobs that are meant to take long or to break something."""

    def but(**changes: Any) -> Job:
        return {**deepcopy(feeder), **changes}

    table = {"positions": [f"{n} mm" for n in range(1000)], "forces": ["1 N"] * 1000}
    options = [{"name": str(n), "values": {"mechanism.slider.mass": f"{n + 1} kg"}} for n in range(100)]
    angles = [f"{0.35 * n} deg" for n in range(1000)]
    wanted = {"crank_angles": angles, "positions": ["100 mm"] * 1000, "phase": "free", "shift": "free"}
    tiny = {"crank": ["1e-9 m", "1e4 m"], "rod": ["1e-9 m", "1e4 m"], "offset": ["-1e4 m", "1e4 m"]}
    return {
        "tables of loads": but(load=[table] * 50, constraints={"peak_torque": {"max": "1 N m"}}),
        "many choices": but(choice=[{"name": "c", "option": options}, {"name": "d", "option": options[:2]}]),
        "a wanted motion": but(
            target_motion=wanted,
            constraints={"motion_deviation": {"max": "1 mm"}},
            objectives={"motion_deviation": "minimise", "time_ratio": "maximise"},
        ),
        "a robust job": but(robust={"kind": "percentile", "samples": 65536}),
        "every size": but(variables=tiny, constraints={}),
        "many keys": but(mechanism={f"k{n}": n for n in range(20_000)}),
        "many bounds": but(constraints={f"k{n}": {"min": n} for n in range(20_000)}),
        "lists for texts": but(variables={"crank": [[[]]], "rod": {"choices": list(range(5000))}, "offset": None}),
        "texts for tables": but(constraints="all", objectives=3, variables="wide", mechanism=[], load={}),
        "odd keys": but(constraints={"": {"min": 1}, "a.b #3: c": 2, "\n": 3}),
    }


@pytest.mark.parametrize("kind", hostile({}))
def test_no_job_takes_long_or_breaks_the_preview(shared: httpx.Client, feeder: Job, kind: str) -> None:
    job = hostile(feeder)[kind]
    begin = time.monotonic()
    response = shared.post("/preview", json={"job": job})
    assert response.status_code in (200, 400), response.text
    assert time.monotonic() - begin < 5.0  # far from what is usual, near to what would mean no bound at all


def test_a_job_of_too_many_values_is_refused_with_their_number_at_every_door(shared: httpx.Client, feeder: Job) -> None:
    count = len(json.dumps(feeder).split(",")) + MOST
    rule = f"a job must have at most {MOST} values, lists and tables; got "
    empty: list[Any] = [{}, {"viscous": 1.0}, []]
    for one in empty:
        job = {**feeder, "load": [one] * count}
        found = preview(shared, job)
        assert [one["path"] for one in found["wrong"]] == [""]
        assert found["wrong"][0]["sentence"].startswith(rule)
        assert found["understood"] is found["example"] is found["allowed"] is None
        for path in ("/check", "/jobs", "/toml"):
            assert refusal_sentence(shared.post(path, json={"job": job}), 422) == found["wrong"][0]["sentence"]
    text = b"[[load]]\n" * count
    assert refusal_sentence(
        shared.post("/check", content=text, headers={"Content-Type": "application/toml"}), 422
    ).startswith(rule)


def test_a_preview_is_of_a_job_and_nothing_else(shared: httpx.Client) -> None:
    assert "body path: unknown" in refusal_sentence(shared.post("/preview", json={"job": {}, "path": "x"}), 422)


def test_formulas_of_a_job_have_their_units_or_their_mistakes_while_the_rest_is_missing(shared: httpx.Client) -> None:
    job = {
        "variables": {"mechanism": {"slider": {"mass": ["1 kg", "3 kg"]}}},
        "quantity": {"room": {"formula": "offset - crank"}, "round": {"formula": "round + 1 mm"}},
        "constraints": {
            "room / mechanism.slider.mass": {"max": ""},
            "crank + peak_torque": {"max": "1 mm"},
            "stroke": {"max": "2.2 * crnk"},
            "": {"max": "1 mm"},
            "quick": {"max": 2},
        },
        "objectives": {"2 * (crank": "minimise", "crank": "minimise"},
    }
    found = preview(shared, job)
    units = {formula["path"]: formula["unit"] for formula in found["formulas"]}
    assert units["quantity.room.formula"] == "mm"
    assert units['constraints."room / mechanism.slider.mass"'] == "m kg^-1"
    assert units["objectives.crank"] == "mm"
    assert units["quantity.round.formula"] is None
    wrong = {one["path"]: one["sentence"] for one in found["wrong"]}
    assert "adds mm and N m" in wrong['constraints."crank + peak_torque"']
    assert "did you mean crank" in wrong["constraints.stroke.max"]
    assert wrong['constraints.""'].startswith("is missing")
    assert wrong["constraints.quick"].startswith('no quantity, dimension or variable is called "quick"')
    assert "every opening bracket must be closed" in wrong['objectives."2 * (crank"']
    assert {(one["name"], one["unit"]) for one in found["names"]} == {
        ("room", "mm"),
        ("round", None),
        ("mechanism.slider.mass", "kg"),
    }


def test_a_job_of_formulas_made_of_each_other_is_looked_at_within_a_moment(shared: httpx.Client) -> None:
    own = {"a0": {"formula": "crank"}, "a1": {"formula": "rod"}}
    own |= {f"a{n}": {"formula": f"a{n - 1} + a{n - 2}"} for n in range(2, 150)}
    begin = time.monotonic()
    found = preview(shared, {"quantity": own})
    assert time.monotonic() - begin < 20.0  # each asked for by itself: 2^150 sums
    assert {formula["unit"] for formula in found["formulas"]} == {"mm"}


def test_a_swing_has_its_travel_share_and_an_example_that_closes_between_its_two_ends(
    shared: httpx.Client, pytestconfig: pytest.Config
) -> None:
    job = tomllib.loads((pytestconfig.rootpath / "runs" / "support.toml").read_text())
    for _ in range(20):  # beside other work a moment may be too short
        found = preview(shared, job)
        if not found["swing"]["unchecked"]:
            break
    swing, example = found["swing"], found["swing"]["example"]
    assert found["allowed"] is found["example"] is None
    assert (swing["from_deg"], swing["to_deg"]) == pytest.approx((11.16, 101.16), rel=1e-12)
    assert 0.0 < swing["feasible_share"] < swing["closing_share"] < 1.0
    assert example["feasible"]
    crank, rod, offset = (example[f"{name}_mm"] for name in ("crank", "rod", "offset"))

    def place(angle: float) -> float:
        theta = math.radians(angle)
        return float(crank * math.cos(theta)) + math.sqrt(rod**2 - (offset - crank * math.sin(theta)) ** 2)

    assert example["travel_mm"] == pytest.approx(abs(place(101.16) - place(11.16)), rel=1e-9)
    assert swing["travel_mm"][0] <= example["travel_mm"] <= swing["travel_mm"][1] <= 2400.0 * (1 + 1e-6)
    places = example["motion"]["slider_position_mm"]
    assert [n for n, x in enumerate(places) if x is not None] == list(range(11, 103))
    assert places[60] == pytest.approx(place(60.0), rel=1e-9)
    unfinished = preview(shared, job | {"name": ""})["swing"]
    assert unfinished["closing_share"] == swing["closing_share"]
    assert unfinished["unchecked"] == ["actuator_travel"]
    assert preview(shared, job | {"motion": {"kind": "swing", "from": "0 deg"}})["swing"] is None
    assert preview(shared, job | {"motion": job["motion"] | {"to": "360 deg"}})["swing"]["example"] is None
