"""Designs of levers over the API: each address answers, or refuses in one sentence."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from slidercrank.service.store import Store
from tests.optimise.problems import LEVER, SHAPER
from tests.service.api.fixed_front import API, client_of
from tests.service.api.swinging import solved_at_once

ANSWERED = (
    "",
    "/analysis",
    "/curves",
    "/cycle.csv",
    "/lever",
    "/lever.svg",
    "/linkage.dxf",
    "/linkage.svg",
    "/motion.gif",
    "/motion.html",
    "/requirements",
)
REFUSED = {
    "/swing": "needs a crank with rod and slider",
    **dict.fromkeys(("/counterweight", "/law", "/sections"), "needs a rotating crank; the lever of this job swings"),
}


@pytest.mark.slow
def test_designs_of_levers_are_answered_or_refused_in_one_sentence(tmp_path: Path) -> None:
    variables = LEVER["variables"] | {"mechanism.frame_angle": ["-75 deg", "-50 deg"]}
    with Store(tmp_path / "store.db") as store:
        number = solved_at_once(store, LEVER | {"variables": variables})
        with client_of(store) as client:
            design = f"{API}/jobs/{number}/designs/1"
            for path in ANSWERED:
                answer = client.get(design + path)
                assert answer.status_code == 200, (path, answer.text)
            for path, part in REFUSED.items():
                answer = client.get(design + path)
                assert answer.status_code == 422, (path, answer.text)
                assert part in answer.json()["detail"]
            lever = client.get(f"{design}/lever").json()["lever"]
            curves = client.get(f"{design}/curves", params={"angles": 400}).json()
            assert curves["slider_ends_mm"] == pytest.approx([lever["start_length_mm"], lever["end_length_mm"]])
            assert curves["curves"]["lever_angle_deg"][::200] == pytest.approx([-20.0, 50.0])
            assert curves["outlines"]["lever"]["frame_angle_deg"] == pytest.approx(lever["frame_angle_deg"])
            assert max(curves["curves"]["push_N"]) + 30.0 == pytest.approx(lever["peak_push_N"], rel=1e-4)
            assert max(curves["curves"]["cylinder_speed_m_s"]) == -min(curves["curves"]["cylinder_speed_m_s"])
            extents = np.array(
                [
                    client.get(f"{API}/jobs/{number}/designs/{other}/curves").json()["outlines"]["extent_mm"]
                    for other in (1, 2, 3)
                ]
            )
            whole = client.get(f"{API}/jobs/{number}/front").json()["extent_mm"]
            assert whole == pytest.approx([*extents.min(axis=0)[:2], *extents.max(axis=0)[2:]])
            preview = client.post(f"{API}/preview", json={"job": LEVER})
            assert preview.status_code == 200, preview.text
            assert (preview.json()["wrong"], preview.json()["example"]) == ([], None)
            swing = preview.json()["swing"]
            example = swing["example"]
            assert (swing["from_deg"], swing["to_deg"]) == pytest.approx((-20.0, 50.0))
            crank, rod, offset = (1e-3 * example[f"{name}_mm"] for name in ("crank", "rod", "offset"))
            first, last = (
                1e3 * math.sqrt(crank**2 + rod**2 - 2.0 * crank * rod * math.cos(angle) - offset**2)
                for angle in (math.radians(40.0), math.radians(110.0))
            )
            assert example["slider_ends_mm"] == pytest.approx([first, last])
            assert swing["travel_mm"][0] <= example["travel_mm"] <= swing["travel_mm"][1]
            assert example["feasible"]
            assert example["outlines"]["lever"]["frame_angle_deg"] == pytest.approx(-60.0)


@pytest.mark.slow
def test_designs_of_a_crank_that_turns_an_arm_are_answered_or_refused_in_one_sentence(tmp_path: Path) -> None:
    with Store(tmp_path / "store.db") as store:
        number = solved_at_once(store, SHAPER)
        with client_of(store) as client:
            design = f"{API}/jobs/{number}/designs/1"
            for path in ANSWERED:
                answer = client.get(design + path)
                assert answer.status_code == (422 if path.startswith("/lever") else 200), (path, answer.text)
            for path in REFUSED:
                answer = client.get(design + path)
                assert answer.status_code == 422, (path, answer.text)
                assert "needs a crank with rod and slider" in answer.json()["detail"], path
            found = client.get(f"{design}/curves", params={"angles": 400}).json()
            curves, numbers = found["curves"], client.get(design).json()["design"]
            assert curves["crank_angle_deg"][::100] == pytest.approx([0.0, 90.0, 180.0, 270.0])
            assert max(map(abs, curves["torque_Nm"])) == pytest.approx(numbers["peak_crank_torque_Nm"], rel=1e-3)
            assert max(map(abs, curves["ram_speed_m_s"])) == pytest.approx(numbers["peak_ram_speed_m_s"], rel=1e-3)
            assert found["outlines"]["extent_mm"][0] < found["outlines"]["extent_mm"][2]
            preview = client.post(f"{API}/preview", json={"job": SHAPER})
            assert preview.status_code == 200, preview.text
            assert preview.json()["wrong"] == []
            swing = preview.json()["swing"]
            assert (swing["from_deg"], swing["to_deg"]) == pytest.approx((0.0, 360.0))
            least = min(swing["example"]["crank_mm"], swing["example"]["rod_mm"])
            assert swing["example"]["travel_mm"] == pytest.approx(2.0 * least, rel=0.1)
