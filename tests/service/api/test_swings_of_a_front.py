"""Designs that swing, and of a cycle of two turns, over the API: curves, numbers, files."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import httpx
import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import Bar
from slidercrank.optimise.job import parse_job
from slidercrank.service.store import Store
from tests.service.api.fixed_front import API, client_of
from tests.service.api.swinging import ENGINE, solved_at_once, support

SLOW, TIMED, TURNS = "slow", "timed", "turns"


@dataclass
class Served:
    client: httpx.Client
    jobs: dict[str, int]

    def get(self, job: str, path: str, status: int = 200, **query: Any) -> httpx.Response:
        answer = self.client.get(f"{API}/jobs/{self.jobs[job]}/designs/1{path}", params=query or None)
        assert answer.status_code == status, answer.text
        return answer


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with Store(tmp_path_factory.mktemp("swing") / "store.db") as store:
        timed = support(law="cycloidal", duration="20 s")
        jobs = {name: solved_at_once(store, job) for name, job in ((SLOW, support()), (TIMED, timed), (TURNS, ENGINE))}
        with client_of(store) as client:
            yield Served(client, jobs)


def lengths(row: dict[str, Any]) -> list[float]:
    return [float(row[f"{name}_mm"]) for name in ("crank", "rod", "offset")]


@pytest.mark.parametrize("job", [SLOW, TIMED])
def test_curves_of_a_swing_go_forth_and_back(served: Served, job: str) -> None:
    found, row = served.get(job, "/curves", angles=72).json(), served.get(job, "").json()["design"]
    assert (found["turns"], found["inner_dead_centre_deg"], found["slow_stroke"]) == (0, None, None)
    curves = {key: np.array(values) for key, values in found["curves"].items()}
    assert {column["key"] for column in found["columns"]} == set(curves)
    r, l, e = lengths(row)
    angle = np.radians(curves["crank_angle_deg"])
    assert np.degrees(angle[[0, 36]]) == pytest.approx([11.16, 101.16])
    x = r * np.cos(angle) + np.sqrt(l * l - (e - r * np.sin(angle)) ** 2)
    np.testing.assert_allclose(curves["slider_position_mm"], x, rtol=1e-9)
    assert found["slider_ends_mm"] == pytest.approx(x[[0, 36]], rel=1e-9)
    np.testing.assert_allclose(curves["slider_position_mm"][1:36], curves["slider_position_mm"][:36:-1], rtol=1e-9)
    assert max(abs(curves["drive_N"])) == pytest.approx(row["peak_actuator_force_N"], rel=1e-3)
    assert ("power_W" in curves) == (job == TIMED)
    assert "even number" in served.get(job, "/curves", 422, angles=73).text


def test_a_cycle_of_two_turns_has_the_curves_of_both(served: Served) -> None:
    found = served.get(TURNS, "/curves", angles=144).json()
    assert found["turns"] == 2
    assert found["curves"]["crank_angle_deg"] == pytest.approx([5.0 * n for n in range(144)])
    once, twice = (np.array(found["curves"]["torque_Nm"][part]) for part in (slice(72), slice(72, None)))
    assert np.abs(once - twice).max() > 100.0
    position = found["curves"]["slider_position_mm"]
    assert position[:72] == pytest.approx(position[72:])


def test_numbers_and_other_lengths_are_those_of_the_swing(served: Served) -> None:
    row = served.get(SLOW, "").json()["design"]
    analysis = served.get(SLOW, "/analysis").json()["analysis"]
    for key in ("peak_actuator_force_N", "swing_angle_error_deg", "actuator_travel_mm"):
        assert analysis[key] == pytest.approx(row[key], rel=1e-6)
    assert "stroke_mm" not in analysis
    r, l, e = lengths(row)
    body = {"crank_mm": r, "rod_mm": l * 1.01, "offset_mm": e, "angles": 36}
    path = f"{API}/jobs/{served.jobs[SLOW]}/designs/1/what-if"
    found = served.client.post(path, json=body).json()
    force = parse_job(support()).evaluate([[r / 1e3, l * 1.01e-3, e / 1e3]], ["peak_actuator_force"])[0, 0]
    assert found["design"]["peak_actuator_force_N"] == pytest.approx(force, rel=1e-6)
    assert found["cycle"]["turns"] == 0
    refused = served.client.post(path, json={**body, "rod_mm": 300.0})
    assert (refused.status_code, "must close over the whole swing" in refused.text) == (422, True)


@pytest.mark.slow
def test_files_of_a_design_that_swings(served: Served) -> None:
    rows = list(csv.DictReader(io.StringIO(served.get(TIMED, "/cycle.csv").text)))
    assert {row["way"] for row in rows} == {"forth", "back"}
    assert float(rows[180]["time_s"]) == pytest.approx(20.0)
    for file, start in (
        ("linkage.dxf", b"  0"),
        ("linkage.svg", b"<?xml"),
        ("motion.html", b"<!doctype"),
        ("motion.gif", b"GIF"),
        ("report.html", b"<!doctype"),
    ):
        content = served.get(TIMED, f"/{file}").content
        assert content.lower().startswith(start.lower()), file
    assert "got 200 deg" in served.get(SLOW, "/linkage.svg", 422, crank_angle_deg=200.0).text


def test_the_swing_of_the_job_is_what_is_asked_without_a_word(served: Served) -> None:
    row, swing = served.get(TIMED, "").json()["design"], served.get(TIMED, "/swing").json()["swing"]
    assert (swing["driver"], swing["law"], swing["duration_s"]) == ("slider", "cycloidal", 20.0)
    assert abs(swing["peak_drive_N"]) == pytest.approx(row["peak_actuator_force_N"], rel=1e-6)
    assert swing["crank_position_error_deg"] == pytest.approx(row["swing_angle_error_deg"], rel=1e-6)
    other = served.get(TIMED, "/swing", end_deg=60.0).json()["swing"]
    assert math.isclose(other["end_crank_angle_deg"], 60.0)


@pytest.mark.parametrize("path", ["/topics/balance", "/topics/extremes", "/analysis?show=tolerances"])
def test_an_analysis_of_a_full_turn_is_refused(served: Served, path: str) -> None:
    assert "needs a rotating crank; the crank of this job swings" in served.get(SLOW, path, 422).text


def test_the_outlines_of_a_swing_have_body_and_actuator(served: Served) -> None:
    """The mass centre is the job's; the actuator stands beyond the slider all over the swing."""
    found = served.get(SLOW, "/curves", angles=72).json()
    of, row = found["outlines"], served.get(SLOW, "").json()["design"]
    crank = parse_job(support()).mechanism.crank
    assert not isinstance(crank, Bar)
    assert crank.centre is not None
    assert of["body"]["along_mm"] == pytest.approx(1e3 * crank.centre)
    assert of["body"]["across_mm"] == pytest.approx(1e3 * crank.centre_across)
    assert of["body"]["side_mm"] == pytest.approx(0.3 * row["crank_mm"])
    face = of["actuator"]["face_mm"]
    assert face > max(found["curves"]["slider_position_mm"]) + 0.5 * of["slider_length_mm"]
    left, low, right, high = of["extent_mm"]
    assert right == of["actuator"]["foot_mm"]
    assert low < row["offset_mm"] < high
    assert left < 0.0
    assert of["cylinders"] == []


def test_the_outlines_of_an_engine_have_bore_and_clearance(served: Served) -> None:
    """Between piston and head there is stroke / (compression ratio - 1) at the top; other lengths move it along."""
    cycle, row = served.get(TURNS, "/curves", angles=720).json(), served.get(TURNS, "").json()["design"]
    lengths = {name: row[name] for name in ("crank_mm", "rod_mm", "offset_mm")} | {"crank_mm": 40.0, "rod_mm": 130.0}
    path = f"{API}/jobs/{served.jobs[TURNS]}/designs/1/what-if"
    other = served.client.post(path, json={**lengths, "angles": 720}).json()["cycle"]
    for found in (cycle, other):
        of, positions = found["outlines"], found["curves"]["slider_position_mm"]
        (barrel,) = of["cylinders"]
        assert barrel["bore_mm"] == of["slider_height_mm"] == pytest.approx(86.0)
        half, top, bottom = 0.5 * of["slider_length_mm"], max(positions), min(positions)
        assert barrel["head_mm"] - (top + half) == pytest.approx((top - bottom) / 9.0, rel=1e-9)
        assert barrel["foot_mm"] == pytest.approx(bottom - half, rel=1e-9)
        assert of["body"] is of["actuator"] is None


def test_the_way_back_leads_into_the_swing(served: Served) -> None:
    """A swing has no other crank angles; the job of a full turn has both."""
    curves = served.get(SLOW, "/curves", angles=72).json()["curves"]
    for place in (3, 17, 30):
        at = curves["slider_position_mm"][place]
        found = served.get(SLOW, "/inverse", slider_position_mm=at).json()["inverse"]
        assert [each["crank_angle_deg"] for each in found["solutions"]] == pytest.approx(
            [curves["crank_angle_deg"][place]], rel=1e-9
        )
        assert "outside the swing from 11.16 to 101.16 deg" in found["note"]
    beyond = 1.01 * max(curves["slider_position_mm"])
    refused = served.get(SLOW, "/inverse", 422, slider_position_mm=beyond).json()["detail"]
    assert refused.startswith("the position must be between ") or "reaches" in refused
    row = served.get(TURNS, "").json()["design"]
    turning = served.get(TURNS, "/inverse", slider_position_mm=row["rod_mm"]).json()["inverse"]
    assert (len(turning["solutions"]), turning["note"]) == (2, "")


def test_questions_of_a_full_turn_are_refused(served: Served) -> None:
    one = f"{API}/jobs/{served.jobs[SLOW]}"
    measured = {"csv": "crank_angle_deg,slider_position_mm\n20,3000\n40,2500\n90,1500\n"}
    lengths = {"crank": "1.4 m", "rod": "1.8 m", "offset": "-50 mm"}
    answers = [
        served.client.post(f"{one}/designs/1/measured", json=measured),
        served.client.post(f"{API}/analyse", json={"job": support(), **lengths}),
    ]
    for answer in answers:
        assert answer.status_code == 422
        assert "needs a rotating crank" in answer.json()["detail"]
