"""The form of a new run: presets, what is typed, what is wrong, drafts, files, units, keyboard."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import httpx
import pytest
from playwright.sync_api import Locator, Page, expect

from slidercrank.objectives.units import kind_of_any_unit, to_si
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.catalogue import with_catalogues
from slidercrank.service.api.settings import Settings
from slidercrank.service.store import Store
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open

READY = "Ready to start."


@pytest.fixture
def shipped(pytestconfig: pytest.Config) -> dict[str, dict[str, Any]]:
    """Return the jobs that ship, with the options of a catalogue in place of its file."""
    files = (pytestconfig.rootpath / "runs").glob("*.toml")
    return {file.stem: with_catalogues(tomllib.loads(file.read_text()), file.parent) for file in files}


def status(page: Page) -> Locator:
    return page.get_by_role("complementary").get_by_role("status")


def ready(page: Page) -> None:
    expect(status(page)).to_have_text(READY, timeout=30_000)


def text_of(page: Page) -> dict[str, Any]:
    """Return the job as the text beside the form has it."""
    found: dict[str, Any] = json.loads(page.locator("#job-text").input_value())
    return found


def start(page: Page) -> None:
    page.get_by_role("button", name="Start the search").click()


def test_the_first_job_has_no_warning_and_what_was_understood_stays_beside_it(form: Open, store: Store) -> None:
    page = form(store, "#/new", viewport={"width": 1280, "height": 560})
    ready(page)
    beside = page.get_by_role("complementary")
    expect(beside.locator(".warning")).to_have_count(0)
    beside.get_by_text("What was understood").press("Enter")
    understood = beside.locator("details")
    expect(understood).to_contain_text("stroke = 100 mm")
    page.get_by_label("stroke, exactly").fill("90")
    expect(understood).to_contain_text("stroke = 90 mm")
    expect(understood.get_by_role("heading", name="Objectives")).to_be_visible()
    start_button = page.get_by_role("button", name="Start the search")
    for place in ("0", "document.body.scrollHeight"):
        page.evaluate(f"window.scrollTo(0, {place})")
        expect(start_button).to_be_in_viewport(ratio=1.0)
        beside.evaluate("node => node.scrollTo(0, node.scrollHeight / 4)")
        expect(start_button).to_be_in_viewport(ratio=1.0)


def test_a_file_is_asked_for_only_where_the_job_names_one(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    file = page.locator("#f-mechanism-speed_profile-file-c")
    expect(page.locator("#f-mechanism-speed_profile-crank_angles-c")).to_have_count(1)
    expect(file).to_have_count(0)  # a service opens none
    job = text_of(page)
    job["mechanism"]["speed_profile"] = {"file": "speeds.csv"}
    content = json.dumps(job).encode()
    page.locator("#job-import").set_input_files({"name": "own.json", "mimeType": "application/json", "buffer": content})
    expect(file).to_have_value("speeds.csv")


def test_a_preset_with_another_stroke_becomes_one_job_of_exactly_these_tables_also_on_a_double_click(
    form: Open, store: Store, shipped: dict[str, Any]
) -> None:
    page = form(store, "#/new?preset=sieve")
    expect(page.get_by_label("name", exact=True)).to_have_value("Vibrating sieve")
    page.get_by_label("stroke, exactly").fill("260")
    ready(page)
    page.get_by_role("button", name="Start the search").dblclick()
    page.wait_for_url("**/#/jobs/1")
    wanted = shipped["sieve"]
    wanted["constraints"]["stroke"] = {"equals": "260 mm"}
    assert store.job_tables(1) == wanted
    assert len(store.jobs()) == 1
    assert store.job(1).name == "Vibrating sieve"
    page.goto(f"{page.url.split('#')[0]}#/new")
    expect(page.get_by_label("name", exact=True)).to_have_value("New slider-crank")  # the draft has become a job


def test_back_from_a_started_run_leads_to_the_form_as_it_was_sent(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    page.get_by_label("stroke, exactly").fill("260")
    page.get_by_text("Samples, budget, priority").click()
    page.get_by_role("textbox", name="time limit (s)").fill("90")
    ready(page)
    start(page)
    page.wait_for_url("**/#/jobs/1")
    page.go_back()
    ready(page)
    expect(page.get_by_label("stroke, exactly")).to_have_value("260")
    page.get_by_text("Samples, budget, priority").click()
    expect(page.get_by_role("textbox", name="time limit (s)")).to_have_value("90")
    assert text_of(page) == store.job_tables(1)


def test_a_seed_that_a_browser_would_round_is_refused_as_it_was_typed(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    page.get_by_label("seed", exact=True).fill("12345678901234567890")
    error = page.get_by_text("got 12345678901234567890; write a smaller one")
    expect(error).to_be_visible()
    page.get_by_label("seed", exact=True).fill("9007199254740991")
    ready(page)
    expect(error).to_be_hidden()
    assert text_of(page)["optimiser"]["seed"] == 2**53 - 1


def test_every_preset_and_a_copy_of_a_job_are_shown_whole_and_stay_as_they_are(
    form: Open, store: Store, shipped: dict[str, Any]
) -> None:
    page = form(store, "#/new")
    for name, job in shipped.items():
        page.get_by_label("Start from an example").select_option(name)
        ready(page)
        assert text_of(page) == job
        assert page.url.endswith(f"#/new?preset={name}")
    store.submit(shipped["support"], name="Tilting support")
    page.evaluate("sessionStorage.clear(); location.hash = '#/new?from=1'")
    expect(page.get_by_role("button", name="Bring back")).to_be_hidden()
    ready(page)
    assert text_of(page) == shipped["support"]
    start(page)
    page.wait_for_url("**/#/jobs/2")
    assert (store.job(2).origin, store.job(1).origin) == (1, None)
    httpx.post(f"{page.url.split('#')[0]}api/v1/jobs", json={"job": shipped["sieve"], "origin": 99}, timeout=60.0)
    assert store.job(3).origin is None  # it is gone


def test_the_first_job_of_an_empty_form_can_be_solved_and_its_sketch_moves_until_paused(
    open_page: Open, store: Store
) -> None:
    page = open_page(store, "#/new")
    ready(page)
    assert len(parse_job(text_of(page)).objectives) == 4
    drawn = page.get_by_role("img", name="A linkage within the ranges")
    before = drawn.inner_html()
    page.wait_for_timeout(150)
    assert drawn.inner_html() != before
    page.get_by_role("button", name="Pause").click()
    page.wait_for_timeout(50)
    before = drawn.inner_html()
    page.wait_for_timeout(150)
    assert drawn.inner_html() == before


IMPOSSIBLE = "Impossible: no design can meet the requirements of this job."
WRONG = [
    ("name", "", "is missing"),
    ("crank speed", "fast", "must be an angular speed"),
    ("slider mass", "-2", "must be zero or more"),
    ("crank, from", "200", "must run from its lower to its upper end"),
    ("rod, to", "ten", "must be a length"),
    ("stroke, exactly", "9000", "at most"),
    ("time ratio, at most", "0.9", "must be 1 or more"),
    ("least transmission angle, at least", "95", "must lie between 0 and 90°"),
    ("crank angle tolerance", "x", "must be an angle"),
    ("designs", "1.5", "must be a whole number"),
    ("crank, to", "2*(75", "is not closed"),
]


@pytest.mark.slow
def test_wrong_input_is_said_beside_its_field_until_it_is_corrected_and_is_not_sent(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_label("time ratio", exact=True).and_(page.get_by_role("combobox")).select_option("max")
    page.get_by_label("time ratio, at most").fill("1.1")
    for label, typed, sentence in WRONG:
        field = page.get_by_label(label, exact=True)
        before = field.input_value()
        field.fill(typed)
        expect(field, label).to_have_attribute("aria-invalid", "true")
        described = field.get_attribute("aria-describedby")
        expect(page.locator(f"#{described}"), label).to_contain_text(re.compile(re.escape(sentence), re.IGNORECASE))
        impossible = label == "stroke, exactly"  # a wish that is typed rightly
        expect(status(page)).to_have_text(IMPOSSIBLE if impossible else "One thing to correct.")
        field.fill(before)
        expect(field, label).not_to_have_attribute("aria-invalid", "true")
    page.get_by_label("time ratio", exact=True).and_(page.get_by_role("combobox")).select_option("equals")
    exact = page.get_by_label("time ratio, exactly")
    exact.fill("1.5")  # more than the least transmission angle leaves
    expect(exact).to_have_attribute("aria-invalid", "true")
    expect(page.locator(f"#{exact.get_attribute('aria-describedby')}")).to_contain_text(
        re.compile(r"^Impossible: .*got exactly 1\.5")
    )
    expect(status(page)).to_have_text(IMPOSSIBLE)
    expect(page.get_by_role("button", name="Start the search")).to_be_disabled()
    exact.press("Enter")
    expect(page.get_by_role("alert")).to_have_text(f"{IMPOSSIBLE} Change the marked fields.")
    assert store.jobs() == []
    expect(page.get_by_text("Time ratio exactly 1.5 is asked, at the nearest 1.2")).to_be_visible()
    page.get_by_label("time ratio", exact=True).and_(page.get_by_role("combobox")).select_option("max")
    page.get_by_label("time ratio, at most").fill("1.1")
    ready(page)
    expect(page.get_by_role("button", name="Start the search")).to_be_enabled()
    for label, typed, number, said in (
        ("rod, from", "3 in + 5 mm", "81.2", '"3 in + 5 mm" = 81.2 mm'),
        ("rod, to", "1,500", "1500", '"1,500" is read as 1500 mm; write 1.500 if you mean that.'),
    ):
        page.get_by_label(label, exact=True).fill(typed)
        page.get_by_label(label, exact=True).blur()
        expect(page.get_by_label(label, exact=True)).to_have_value(number)
        expect(page.get_by_role("status").filter(has_text=said)).to_be_visible()
    page.get_by_label("slider mass", exact=True).fill("heavy")
    expect(status(page)).to_have_text("One thing to correct.")
    start(page)
    expect(page.get_by_label("slider mass", exact=True)).to_be_focused()
    expect(page.get_by_role("alert")).to_have_text("Correct the marked fields first.")
    assert store.jobs() == []


def test_what_was_typed_survives_leaving_and_starting_over_is_asked_for(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=feeder")
    page.get_by_label("name", exact=True).fill("Mine")
    page.get_by_label("crank, from").fill("25")
    page.get_by_role("link", name="Help").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Help")
    page.get_by_role("link", name="New run").first.click()
    expect(page.get_by_label("name", exact=True)).to_have_value("Mine")
    page.reload()
    expect(page.get_by_label("crank, from")).to_have_value("25")
    page.get_by_role("button", name="Start over").click()
    expect(page.get_by_label("name", exact=True)).to_have_value("New slider-crank")
    page.get_by_role("button", name="Restore the previous job").click()
    expect(page.get_by_label("name", exact=True)).to_have_value("Mine")
    page.evaluate("location.hash = '#/new?preset=sieve'")  # as by a link
    expect(page.get_by_label("name", exact=True)).to_have_value("Vibrating sieve")
    page.get_by_role("button", name="Restore the previous job").click()
    page.reload()
    expect(page.get_by_label("name", exact=True)).to_have_value("Mine")


def test_a_job_in_inches_is_the_same_job_and_whoever_prefers_inches_begins_with_them(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_label("stroke, exactly").fill("101.6")
    page.get_by_label("Unit of slider mass").select_option("lb")
    page.get_by_label("slider mass", exact=True).fill("5")
    metric = text_of(page)
    page.get_by_label("Unit of stroke").select_option("in")
    expect(page.get_by_label("stroke, exactly")).to_have_value("4")
    inches = text_of(page)
    assert inches["constraints"]["stroke"] == {"equals": "4 in"}
    assert inches["mechanism"]["slider"]["mass"] == "5 lb"
    assert parse_job(inches) == parse_job(metric)
    page.get_by_label("Units").select_option("inch")
    expect(page.get_by_role("complementary")).to_contain_text(" in")
    understood = page.get_by_role("complementary").locator("details li")
    expect(understood.filter(has_text=re.compile(r"^crank [\d.]+ to [\d.]+ in$"))).to_have_count(1)
    assert not any(re.search(r"\d (mm|kg|N)\b", line or "") for line in understood.all_text_contents())
    page.get_by_role("button", name="Start over").click()
    ready(page)
    assert text_of(page)["constraints"]["stroke"] == {"equals": "4 in"}
    assert text_of(page)["mechanism"]["gravity"] == "386.09 in/s^2"


@pytest.mark.slow
def test_a_job_file_comes_in_and_goes_out_the_same(
    form: Open, store: Store, pytestconfig: pytest.Config, shipped: dict[str, Any], tmp_path: Path
) -> None:
    page = form(store, "#/new", expected=("422",))
    title = page.get_by_label("name", exact=True).first  # own quantities have one too
    for name in shipped:
        file = pytestconfig.rootpath / "runs" / f"{name}.toml"
        job = tomllib.loads(file.read_text())
        page.get_by_label("Job file to import").set_input_files(file)
        expect(title).to_have_value(job["name"])
        for kind, read in (("TOML", tomllib.loads), ("JSON", json.loads)):
            with page.expect_download() as begun:
                page.get_by_role("button", name=f"Download {kind}").click()
            saved = tmp_path / begun.value.suggested_filename
            begun.value.save_as(saved)
            assert saved.suffix == f".{kind.lower()}"
            assert read(saved.read_text()) == job
        page.get_by_role("button", name="Start over").click()
        page.get_by_label("Job file to import").set_input_files(saved)
        expect(title).to_have_value(job["name"])
        assert text_of(page) == job
    before = text_of(page)
    bad = tmp_path / "bad.toml"
    bad.write_text("name = ")
    page.get_by_label("Job file to import").set_input_files(bad)
    expect(page.locator("#notices")).to_contain_text("there must be = and a value")
    assert text_of(page) == before


def test_the_text_and_the_form_are_in_step_and_no_part_is_lost(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_text("The job as text").click()
    job = text_of(page)
    job["costs"] = {"crank": {"cost": 8.0, "at": "0.05 mm"}}
    job["variables"]["mechanism"] = {"slider": {"mass": ["1 kg", "3 kg"]}}
    job["constraints"]["2 * crank + rod"] = {"max": "900 mm"}
    job["constraints"]["stroke"] = {"max": "2.5 * crank"}
    job["mechanism"]["speed"] = "-90 rpm"
    page.locator("#job-text").fill(json.dumps(job))
    expect(page.get_by_label("crank speed", exact=True)).to_have_value("90")
    expect(page.get_by_label("direction", exact=True)).to_have_value("-")
    expect(page.locator("summary", has_text="Costs of tolerances")).to_contain_text("cost 8; at 0.05 mm")
    expect(page.get_by_label("formula 1, requirement", exact=True)).to_have_value("2 * crank + rod")
    page.get_by_label("crank speed", exact=True).fill("80")
    ready(page)
    assert text_of(page) == {**job, "mechanism": {**job["mechanism"], "speed": "-80 rpm"}}
    page.locator("#job-text").fill("{")
    expect(page.locator("#job-text-error")).to_contain_text("not valid JSON yet")
    expect(page.get_by_label("crank speed", exact=True)).to_have_value("80")


@pytest.mark.slow
def test_a_time_of_a_cycle_stands_in_place_of_the_speed(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_text("The job as text").click()
    job = text_of(page)
    rest = {key: value for key, value in job["mechanism"].items() if key != "speed"}
    job["mechanism"] = {**rest, "cycle_time": "2 s", "direction": "clockwise"}
    page.locator("#job-text").fill(json.dumps(job))
    seconds = page.get_by_label("cycle time", exact=True)
    expect(seconds).to_have_value("2")
    expect(page.get_by_label("direction", exact=True)).to_have_value("-")
    ready(page)
    assert text_of(page) == job
    expect(page.locator("body")).to_contain_text("cycle time 2 s, 30 strokes per minute")
    seconds.fill("1.5")
    page.get_by_label("direction", exact=True).select_option("")
    ready(page)
    assert text_of(page)["mechanism"] == {**rest, "cycle_time": "1.5 s"}
    page.get_by_label("direction", exact=True).select_option("-")
    page.get_by_label("speed given by", exact=True).select_option("strokes per minute")
    strokes = page.get_by_label("strokes per minute", exact=True)
    expect(strokes).to_be_focused()
    expect(page.locator("#f-mechanism-strokes_per_minute-c-error")).to_contain_text("strokes per minute")
    strokes.fill("40")
    ready(page)
    assert text_of(page)["mechanism"] == {**rest, "strokes_per_minute": 40, "direction": "clockwise"}
    page.get_by_label("speed given by", exact=True).select_option("")
    page.get_by_label("crank speed", exact=True).fill("90")
    ready(page)
    assert text_of(page)["mechanism"] == {**rest, "speed": "-90 rpm"}


NO_TABLES: dict[str, tuple[tuple[str, ...], Any]] = {
    "mechanism.crank": (("mechanism", "crank"), "2 kg"),
    "load #1": (("load",), ["200 N"]),
    "variables.crank": (("variables", "crank"), {"choices": "20 mm"}),
    "constraints.stroke": (("constraints", "stroke"), "280 mm"),
    "objectives.time_ratio": (("objectives", "time_ratio"), ["maximise"]),
}


@pytest.mark.slow
def test_a_text_where_a_table_belongs_is_said_and_the_form_stays(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_text("The job as text").click()
    right = page.locator("#job-text").input_value()
    for said, (place, given) in NO_TABLES.items():
        page.locator("#job-text").fill(right)
        ready(page)
        job = text_of(page)
        table = job
        for key in place[:-1]:
            table = table[key]
        table[place[-1]] = given
        page.locator("#job-text").fill(json.dumps(job))
        expect(status(page), said).to_contain_text("to correct", timeout=30_000)
        assert page.locator(".sections section").count() >= 8, said
        assert text_of(page) == job
        page.get_by_label("name", exact=True).fill(f"With {said}")
        assert text_of(page) == {**job, "name": f"With {said}"}


def test_every_unit_that_a_field_offers_is_one_of_job_files_and_means_the_same(form: Open, store: Store) -> None:
    page = form(store, "#/help")
    offered = page.evaluate(
        """async () => {
          const { kinds, readyKinds, unitsOf, convert } = await import(new URL("page/lib/units.js", document.baseURI));
          await readyKinds();
          const one = (kind, unit) => [unit, convert("1", unit, unitsOf(kind)[0], kind)];
          return kinds().flatMap((kind) => unitsOf(kind).map((unit) => one(kind, unit)));
        }"""
    )
    assert len(offered) > 50
    for unit, in_si in offered:
        assert to_si(f"1 {unit}", kind_of_any_unit(unit)) == pytest.approx(float(in_si), rel=1e-9), unit


@pytest.mark.slow
def test_loads_requirements_and_objectives_are_added_and_taken_away(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_role("button", name="Add another load").click()
    page.get_by_label("kind of load").nth(1).select_option("stiffness")
    page.get_by_role("button", name="Remove load 1").click()
    page.get_by_label("Another requirement").select_option("peak_guide_force")
    expect(page.get_by_label("peak guide force, at most")).to_be_focused()
    page.keyboard.type("800")
    page.get_by_label("peak torque", exact=True).and_(page.get_by_role("checkbox")).uncheck()
    page.get_by_label("time ratio: minimise, maximise or target").select_option("target")
    page.get_by_label("time ratio: target value").fill("1.2")
    page.get_by_label("crank", exact=True).and_(page.get_by_role("combobox")).first.select_option("fixed")
    page.get_by_label("crank, fixed at").fill("45")
    ready(page)
    job = text_of(page)
    assert job["load"] == [{"stiffness": "1 N/mm", "free_position": "0 mm", "measured_from": "inner dead centre"}]
    assert job["constraints"]["peak_guide_force"] == {"max": "800 N"}
    assert "peak_torque" not in job["objectives"]
    assert job["objectives"]["time_ratio"] == {"target": 1.2}
    assert job["variables"]["crank"] == "45 mm"


def test_a_submission_whose_answer_was_lost_is_sent_again_as_the_same(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=feeder", expected=("ERR_FAILED", "net::"))
    ready(page)

    def lose(route: Any) -> None:
        route.fetch()
        route.abort()

    page.route("**/api/v1/jobs", lose, times=1)
    start(page)
    expect(page.get_by_role("alert")).to_contain_text("is not responding")
    page.reload()
    ready(page)
    start(page)
    page.wait_for_url("**/#/jobs/1")
    assert [job.id for job in store.jobs()] == [1]


def test_a_refusal_is_said_in_words_and_nothing_is_lost(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=feeder", settings=Settings(submissions_per_minute=1), expected=("429",))
    address = page.url.split("#")[0]
    httpx.post(f"{address}api/v1/jobs", json={"job": {}}, trust_env=False)
    page.get_by_label("name", exact=True).fill("Mine")
    ready(page)
    start(page)
    expect(page.get_by_role("alert")).to_contain_text("minute")
    expect(page.get_by_label("name", exact=True)).to_have_value("Mine")
    assert store.jobs() == []


@pytest.mark.slow
def test_limits_and_priority_go_with_the_job_and_wrong_ones_are_said(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=feeder", expected=("422",))
    ready(page)
    page.get_by_text("Samples, budget, priority and limits").click()
    wrong = {
        "priority": ("2000", "1.5", "high"),
        "time limit (s)": ("-1", "0", "abc", "1e400"),
        "limit of designs": ("0", "2.5", "1e30"),
        "memory limit (MB)": ("-1", "x"),
    }
    for name, values in wrong.items():
        field = page.get_by_label(name, exact=True)
        for value in values:
            field.fill(value)
            expect(status(page)).to_have_text("One thing to correct.")
            expect(field).to_have_attribute("aria-invalid", "true")
            expect(field).to_have_accessible_description(re.compile("got"))
        field.fill("")
        ready(page)
    priority = page.get_by_label("priority", exact=True)
    priority.fill("2000")
    start(page)
    expect(page.get_by_role("alert")).to_have_text("Correct the marked fields first.")
    priority.fill("5")
    page.get_by_label("time limit (s)", exact=True).fill("60")
    ready(page)
    start(page)
    page.wait_for_url("**/#/jobs/1")
    assert (store.job(1).priority, store.job(1).limits.seconds) == (5, 60.0)


@pytest.mark.slow
def test_the_service_is_asked_when_typing_rests_and_again_when_it_was_away(form: Open, store: Store) -> None:
    page = form(store, "#/new", expected=("ERR_FAILED",))
    ready(page)
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url) if request.url.endswith("/preview") else None)
    page.route("**/preview", lambda route: route.abort(), times=1)
    # Within the page, where no other program's pause is taken for a rest.
    page.get_by_label("name", exact=True).evaluate(
        """(field) => {
          for (const letter of " of many letters") {
            field.value += letter;
            field.dispatchEvent(new Event("input", { bubbles: true }));
          }
        }"""
    )
    expect(status(page)).to_contain_text("is not responding")
    ready(page)
    assert len(asked) <= 4


def test_the_form_is_filled_and_sent_by_keyboard_alone(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    reached: list[str] = []
    for _ in range(200):
        page.keyboard.press("Tab")
        where = page.evaluate("document.activeElement.id || document.activeElement.textContent")
        reached.append(where)
        if where == "f-name-c":
            page.keyboard.type("By keyboard")
        elif where == "Start the search":
            break
    assert {"preset", "f-mechanism-speed-c", "f-variables-crank-c", "f-objectives-time_ratio-c", "add-load"} <= set(
        reached
    )
    page.keyboard.press("Shift+Tab")
    page.keyboard.press("Tab")
    ready(page)
    page.keyboard.press("Enter")
    page.wait_for_url("**/#/jobs/1")
    assert "By keyboard" in store.job(1).name


def test_a_question_mark_opens_the_sentence_and_leads_to_the_help(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ask = page.get_by_role("button", name="What is stroke?").first
    ask.focus()
    page.keyboard.press("Enter")
    expect(ask).to_have_attribute("aria-expanded", "true")
    expect(page.get_by_text("The stroke is the distance between the slider").first).to_be_visible()
    page.get_by_role("link", name="More about stroke").first.click()
    expect(page.get_by_role("heading", level=1)).to_have_text("stroke")


@pytest.mark.slow
def test_points_in_a_form_do_not_widen_the_page(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=press", viewport={"width": 390, "height": 844})
    expect(page.get_by_role("button", name="Read a file …")).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    page.locator("#f-variables-crank-0").fill("abc")
    expect(status(page)).to_have_text("One thing to correct.")
    expect(page.get_by_role("complementary")).to_contain_text("Give valid ranges of crank, rod and offset")
    expect(page.get_by_role("complementary")).not_to_contain_text("rotates fully")
    page.get_by_role("button", name="One thing to correct.").click()
    expect(page.locator("[aria-invalid=true]").first).to_be_focused()


def test_the_form_is_accessible_in_both_schemes_and_fits_a_narrow_screen(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=support")
    ready(page)
    page.get_by_label("slider mass", exact=True).fill("heavy")
    expect(status(page)).to_have_text("One thing to correct.")
    for fold in page.locator("main summary").all():
        fold.click()
    page.get_by_role("button", name="What is crank?").first.click()
    require_accessible(page)
    page.set_viewport_size({"width": 390, "height": 800})
    page.evaluate("scrollTo(0, 0)")
    expect(page.get_by_role("button", name="Start the search")).to_be_in_viewport(ratio=1)


@pytest.mark.slow
def test_a_number_without_its_unit_is_warned_of_first_and_apart_from_notes(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=sieve")
    ready(page)
    job = text_of(page)
    job["mechanism"] |= {"speed": 120}
    job["mechanism"].pop("gravity", None)
    content = json.dumps(job).encode()
    page.locator("#job-import").set_input_files({"name": "own.json", "mimeType": "application/json", "buffer": content})
    facts = page.get_by_role("complementary")
    warning = facts.locator(".warning").first
    expect(warning).to_contain_text("is read as 120 rad/s (1145.92 rpm)", timeout=30_000)
    assert warning.evaluate("node => node.previousElementSibling === null")
    warning.get_by_role("button", name="Write 120 rpm").click()
    expect(facts).to_contain_text("crank speed 120 rpm", timeout=30_000)
    expect(facts.locator(".warning")).to_have_count(0)
    expect(facts.locator(".note")).to_contain_text("Masses are given without gravity")
    job["mechanism"]["speed"] = "120 U/min"
    job["variables"]["offset"] = "10 mm +- 2 mm"
    content = json.dumps(job).encode()
    page.locator("#job-import").set_input_files({"name": "own.json", "mimeType": "application/json", "buffer": content})
    expect(facts).to_contain_text("crank speed 120 rpm", timeout=30_000)
    expect(facts.locator(".warning")).to_have_count(0)
    ready(page)
    assert text_of(page) == job


def test_the_slow_stroke_is_asked_for_and_a_loaded_fast_one_is_warned_of(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=feeder")
    ready(page)
    beside = page.get_by_role("complementary")
    expect(beside).not_to_contain_text("is the faster one")
    page.get_by_label("offset, from").fill("-80")
    page.get_by_label("offset, to").fill("-15")
    expect(beside).to_contain_text("the loaded stroke (the outward one, against the load) is the faster one")
    beside.get_by_role("button", name="Require a slow inward stroke").press("Enter")
    expect(beside).not_to_contain_text("is the faster one")
    ready(page)
    assert text_of(page)["constraints"]["slow_stroke"] == "inward"
    expect(page.get_by_label("slow stroke", exact=True)).to_have_value("inward")
    page.get_by_label("slow stroke", exact=True).select_option("outward")
    expect(page.locator("main")).to_contain_text("let the offset go above 0")
    page.get_by_label("slow stroke", exact=True).select_option("")
    ready(page)
    assert "slow_stroke" not in text_of(page)["constraints"]


def test_what_the_ranges_allow_has_every_slow_stroke(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=feeder")
    beside = page.get_by_role("complementary")
    slow = beside.locator("dt", has_text="slow stroke").locator("xpath=following-sibling::dd[1]")
    expect(slow).to_have_text("outward")
    expect(beside).to_contain_text("tried, all with the requested stroke and rod to offset")
    for length in ("crank", "rod", "offset", "stroke"):  # the drawing is of one design, in numbers
        expect(beside.locator(".sketch + .row")).to_contain_text(re.compile(rf"{length} [\d.]+\smm"))
    page.get_by_label("offset, from").fill("-80")
    expect(slow).to_have_text("inward or outward")


def test_what_nobody_has_typed_yet_is_asked_for_and_blamed_only_at_the_start(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_label("Another requirement").select_option("footprint")
    field = page.locator("#f-constraints-footprint-max")
    needed = page.locator(".needed:visible")
    expect(needed).to_contain_text("Needs a number", timeout=30_000)
    assert field.get_attribute("aria-invalid") is None
    page.get_by_role("button", name="Start the search").click()
    expect(field).to_have_attribute("aria-invalid", "true")
    assert store.jobs() == []
    field.fill("900")
    ready(page)


def test_a_field_takes_the_value_of_another_one_by_its_name(form: Open, store: Store) -> None:
    page = form(store, "#/new")
    ready(page)
    page.get_by_label("crank, to", exact=True).fill("=stroke*3/4")
    expect(page.locator(".understood:visible").first).to_contain_text("75 mm")
    ready(page)
    assert text_of(page)["variables"]["crank"] == ["20 mm", "75 mm"]
    page.get_by_label("crank, to", exact=True).fill("=height/2")
    expect(page.locator(".error:visible").first).to_contain_text("height", timeout=30_000)
