"""Jobs that go through the form, every field touched, and stay the same word for word."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from slidercrank.model.machine.loads.engine import FourStroke
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.catalogue import with_catalogues
from slidercrank.service.store import Store
from tests.service.page.conftest import Open, ready, text_of

Job = dict[str, Any]
TOUCH = """() => {
  let count = 0;
  for (const one of document.querySelectorAll(".sections input:not([type=checkbox]), .sections textarea")) {
    one.dispatchEvent(new Event("input", { bubbles: true }));
    one.dispatchEvent(new Event("change", { bubbles: true }));
    count += 1;
  }
  return count;
}"""
"""Touch every field without changing it."""


def job_with_every_field(sieve: Job) -> Job:
    """Return a job with one of everything that the form has fields for."""
    return sieve | {
        "variables": {
            "crank": {"min": "80 mm", "max": "160 mm", "step": "0.5 mm"},
            "rod": {"min": "200 mm", "max": "600 mm", "series": "R20"},
            "offset": {"values": ["20 mm", "40 mm", "60 mm"]},
            "mechanism": {"slider": {"mass": ["1 kg", "3 kg"]}, "rod": {"width": {"choices": ["20 mm", "30 mm"]}}},
            "sections": {"pins": {"crank_pin": ["10 mm", "20 mm"]}},
            "load.1.force": ["50 N", "70 N"],
        },
        "quantity": {"room": {"formula": "rod - crank", "title": "room", "unit": "cm"}, "two": {"formula": "2 * room"}},
        "constraints": {
            "stroke": {"min": "2 * crank", "max": "300 mm"},
            "2 * crank + rod": {"max": "900 mm"},
            "rod / crank": {"min": 1.5},
            "room": {"min": "10 mm", "max": "1 m"},
            "rod": {"max": "580 mm"},
            "transmission_angle": {"min": 0.7},
        },
        "objectives": {
            "peak_torque": "minimise",
            "peak_torque_outward / peak_torque_inward": {"target": 1.1},
            "two": {"target": "900 mm"},
            "time_ratio": {"target": 1.2},
        },
        "load": [
            {"force": "60 N", "opposes": "motion"},
            {
                "crank_angles": ["0 deg", "90 deg", "3 rad"],
                "forces": ["0 N", "-100 N", 5],
                "measured_from": "outer dead centre",
            },
        ],
        "sections": {
            "material": {
                "density": "7850 kg/m^3",
                "elasticity": "207 GPa",
                "yield_strength": "350 MPa",
                "ultimate_strength": "520 MPa",
                "endurance": "150 MPa",
                "bearing_pressure": "20 MPa",
            },
            "pins": {"crank_pivot": "15 mm", "crank_pin": "12 mm", "slider_pin": "10 mm"},
            "width": ["10 mm", "80 mm"],
            "eye_concentration": 2.5,
        },
    }


def pass_through_form(page: Page, job: Job, tmp_path: Path) -> None:
    """Bring a job into the form, touch every field, and compare."""
    file = tmp_path / "job.json"
    file.write_text(json.dumps(job))
    page.get_by_label("Job file to import").set_input_files(file)
    expect(page.get_by_label("name", exact=True).first).to_have_value(job["name"])
    status = page.get_by_role("complementary").get_by_role("status")
    expect(status).to_have_text("Ready to start.", timeout=30_000)
    assert page.evaluate(TOUCH) > 15
    expect(status).to_have_text("Ready to start.", timeout=30_000)
    found = json.loads(page.locator("#job-text").input_value())
    assert found == job
    for table in ("constraints", "objectives", "quantity"):
        assert list(found.get(table, {})) == list(job.get(table, {}))


@pytest.mark.slow
def test_every_job_that_ships_and_those_of_the_tests_stay_word_for_word_with_every_field_touched(
    form: Open, store: Store, pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    root = pytestconfig.rootpath
    files = sorted([*(root / "runs").glob("*.toml"), *(root / "tests" / "data").glob("*.toml")])
    jobs = [with_catalogues(tomllib.loads(file.read_text()), file.parent) for file in files]
    assert len(jobs) >= 5
    sieve = next(job for job in jobs if job["name"] == "Vibrating sieve")
    parse_job(job_with_every_field(sieve))
    page = form(store, "#/new")
    for job in [*jobs, job_with_every_field(sieve)]:
        pass_through_form(page, job, tmp_path)


def test_points_of_a_load_are_pasted_from_a_table_with_their_units_and_mistakes_are_said_with_their_line(
    form: Open, store: Store
) -> None:
    page = form(store, "#/new?preset=sieve")
    page.get_by_label("kind of load").first.select_option("crank_angles")
    table = page.get_by_label("points, one per line", exact=True)
    table.fill("angle (deg);force (kN)\n0;0\n90;-0,5\n270;0,25")
    expect(page.get_by_label("Unit of forces")).to_have_value("kN")
    status = page.get_by_role("complementary").get_by_role("status")
    expect(status).to_have_text("Ready to start.", timeout=30_000)
    load = json.loads(page.locator("#job-text").input_value())["load"][0]
    assert load == {"crank_angles": ["0 deg", "90 deg", "270 deg"], "forces": ["0 kN", "-0.5 kN", "0.25 kN"]}
    page.get_by_label("Unit of forces").select_option("N")
    expect(table).to_have_value("0\t0\n90\t-500\n270\t250")
    table.fill("0 0\n90\n270 5")
    expect(table).to_have_attribute("aria-invalid", "true")
    expect(page.get_by_text("Line 2 must have two numbers")).to_be_visible()
    table.fill("0 0\n270 5\n90 1")
    expect(page.get_by_text("Must increase")).to_be_visible()


@pytest.mark.slow
def test_a_catalogue_is_pasted_and_stays_in_the_job_as_a_table(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    page.get_by_text("Catalogues to choose from").click()
    page.get_by_role("button", name="Add a catalogue").click()
    table = page.get_by_role("group", name="Catalogue 1").get_by_role("textbox").last
    expect(table).to_be_focused()
    table.fill("name,peak_torqe max (N m)\nGM 40,40")
    expect(page.get_by_text("did you mean peak_torque")).to_be_visible()
    text = "name;peak_torque max (N m);price (EUR)\nGM 60;60;310\nGM 200;200;840\nGM 50;60;400"
    table.fill(text)
    expect(page.get_by_text("3 rows.")).to_be_visible()
    expect(page.get_by_text("of 3 rows 1 is searched")).to_be_attached()
    status = page.get_by_role("complementary").get_by_role("status")
    expect(status).to_have_text("Ready to start.", timeout=30_000)
    job = json.loads(page.locator("#job-text").input_value())
    assert job["choice"] == [{"name": "catalogue 1", "table": text}]
    assert [variant.labels for variant in parse_job(job).variants] == [("GM 200",)]
    page.get_by_role("button", name="Remove catalogue 1").click()
    assert "choice" not in json.loads(page.locator("#job-text").input_value())


def test_cylinders_an_uneven_speed_and_an_engine_of_four_strokes_are_filled_in(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=compressor")
    ready(page)
    for fold in ("Several cylinders on one crankshaft", "Acceleration of the crank, uneven speed"):
        page.locator("details.more > summary").filter(has_text=fold).click()
    page.get_by_label("phases", exact=True).fill("0 deg, 180 deg")
    page.get_by_label("banks", exact=True).fill("0 deg, 90 deg")
    page.get_by_label("places", exact=True).fill("-50 mm, 50 mm")
    ready(page)
    machine = parse_job(text_of(page)).mechanism
    assert machine.arrangement is not None
    assert machine.arrangement.phases == pytest.approx((0.0, math.pi))
    assert machine.arrangement.banks == pytest.approx((0.0, 0.5 * math.pi))
    assert machine.arrangement.places == (-0.05, 0.05)
    for field in ("places", "banks", "phases"):  # the job's time ratio has no uneven speed with several cylinders
        page.get_by_label(field, exact=True).fill("")
    page.get_by_label("cosines", exact=True).fill("0, 0.05")
    ready(page)
    assert parse_job(text_of(page)).mechanism.speed_profile is not None
    page.get_by_label("cosines", exact=True).fill("")
    points = page.locator("#f-mechanism-speed_profile-crank_angles-c")
    points.fill("crank angle (deg)\tspeed (rpm)\n0\t900\n90\t880\n180\t900\n270\t920")
    ready(page)
    profile = text_of(page)["mechanism"]["speed_profile"]
    assert profile == {
        "crank_angles": ["0 deg", "90 deg", "180 deg", "270 deg"],
        "speeds": ["900 rpm", "880 rpm", "900 rpm", "920 rpm"],
    }
    points.fill("")
    ready(page)
    assert "speed_profile" not in text_of(page)["mechanism"]
    kind = page.get_by_label("kind of load", exact=True)
    kind.select_option(label="ideal engine cycle")
    page.get_by_label("cycle", exact=True).select_option("720 deg")
    page.get_by_label("heat", exact=True).fill("1.6 kJ/L")
    page.get_by_label("heat", exact=True).blur()
    page.get_by_label("peak pressure", exact=True).fill("")
    page.get_by_label("exhaust", exact=True).fill("1.1 bar")
    page.get_by_label("exhaust", exact=True).blur()
    ready(page)
    load = parse_job(text_of(page)).mechanism.loads[0]
    assert isinstance(load, FourStroke)
    # The pressure after compression, and the rise by the heat at constant volume.
    risen = 1e5 * 8.0**1.3 + 0.4 * 1.6e6 * 7.0
    assert (load.high, load.exhaust) == pytest.approx((risen, 1.1e5), rel=1e-9)


def test_points_of_a_load_are_read_from_a_file_in_any_encoding_and_told(
    form: Open, store: Store, tmp_path: Path
) -> None:
    page = form(store, "#/new?preset=sieve")
    page.get_by_label("kind of load").first.select_option("crank_angles")
    file = tmp_path / "trace.csv"
    file.write_bytes("Position [mm];Kraft [kN]\n0;-0,5\n20;0\n".encode("utf-16"))
    page.get_by_role("group", name="Load 1").get_by_label("File of points").set_input_files(file)
    expect(
        page.get_by_text("trace.csv: 2 rows of Position [mm], Kraft [kN]; first 0, -0.5; last 20, 0")
    ).to_be_visible()
    expect(page.get_by_label("kind of load").first).to_have_value("positions")
    load = json.loads(page.locator("#job-text").input_value())["load"][0]
    assert (load["positions"], load["forces"]) == (["0.0 mm", "20.0 mm"], ["-0.5 kN", "0.0 kN"])
