"""The list of runs as people use it."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace
from urllib.parse import parse_qs, urlsplit

import pytest
from playwright.sync_api import Page, Request, expect

from slidercrank.service.jobs.submission import submit
from slidercrank.service.presets.jobs import shipped_jobs
from slidercrank.service.runs.result import StoredObjective
from slidercrank.service.store import Store
from slidercrank.service.store.bookmarks_and_wishes import bookmark_design
from tests.service import fronts
from tests.service.api.fixed_front import Solved, store_result
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open
from tests.service.store.contents import ROWS, add, claim_waiting_job, progress, result

TABLES = tomllib.loads(fronts.JOB)
# Of each answer with points, bytes that were sent, and those of its body.
_SENT = """() => performance.getEntriesByType("resource").filter(({ name }) => name.includes("front-points"))
  .map(({ transferSize, encodedBodySize }) => [transferSize, encodedBodySize])"""


def run(page: Page, name: str) -> object:
    """Return the item of a run."""
    return page.get_by_role("listitem").filter(has_text=name)


def test_an_empty_store_leads_to_a_new_run(open_page: Open, store: Store) -> None:
    page = open_page(store)
    expect(page.get_by_role("heading", name="No runs yet")).to_be_visible()
    machines = page.get_by_role("navigation", name="Shipped machines").get_by_role("link")
    expect(machines).to_have_count(len(shipped_jobs()))
    require_accessible(page)
    expect(machines.filter(has_text="Air compressor").locator("path.cylinder")).to_have_count(1)
    expect(machines.filter(has_text="Tilting support").locator("g.body:not([hidden])")).to_have_count(1)
    expect(page.locator(".machine-picture path.cylinder")).to_have_count(1)
    rods = page.locator(".machine-picture .moving g:not([hidden]):has(> path.rod)")
    turned = "nodes => nodes.map(node => node.getAttribute('transform'))"
    before = rods.evaluate_all(turned)
    page.wait_for_timeout(300)
    assert all(one != other for one, other in zip(before, rods.evaluate_all(turned), strict=True))  # all move
    page.get_by_role("link", name="New run").last.click()
    page.wait_for_url(re.compile(r"#/new$"))
    page.go_back()
    machines.filter(has_text="Vibrating sieve").click()
    page.wait_for_url(re.compile(r"#/new\?preset=sieve$"))


def test_a_run_is_shown_with_its_state_in_words_and_its_best_values(open_page: Open, store: Store) -> None:
    found = result(rows=[{**row, "rod_mm": 120.0, "offset_mm": 30.0, "position_error_mm": 0.25} for row in ROWS])
    error = StoredObjective(
        quantity="position_error",
        sense="minimise",
        column="position_error_mm",
        title="position error, worst case",
        unit="mm",
    )
    extremes = {**found.extremes, "position_error": 0}
    store_result(store, replace(found, objectives=(*found.objectives, error), extremes=extremes), TABLES)
    page = open_page(store)
    item = page.get_by_role("listitem")
    expect(item).to_contain_text("done")
    expect(item).to_contain_text("2 designs")
    expect(item).to_contain_text("best: time ratio 1.25 · position error, worst case 0.25 mm")  # as at the run
    expect(item.get_by_role("img", name="the front: 2 designs")).to_be_visible()
    require_accessible(page)
    item.get_by_role("link", name="Feeder", exact=True).click()
    page.wait_for_url(re.compile(r"#/jobs/1$"))


@pytest.mark.slow
def test_the_list_changes_as_jobs_do(open_page: Open, store: Store) -> None:
    page = open_page(store, reduced_motion="reduce")
    expect(page.get_by_role("heading", name="No runs yet")).to_be_visible()
    submit(store, TABLES)
    item = page.get_by_role("listitem")
    expect(item).to_contain_text("queued")
    claim = claim_waiting_job(store)
    columns, points = ["time_ratio", "crank_mm"], [[1.2, 30.0], [1.3, 40.0], [1.4, 60.0]]
    claim.report(progress(3), {"columns": columns, "points": points[:2]})
    expect(item).to_contain_text("round 3 of 9")
    expect(item.get_by_role("img", name="the front: 2 designs")).to_be_visible()
    claim.report(progress(4), {"columns": columns, "points": points})
    expect(item.get_by_role("img", name="the front: 3 designs")).to_be_visible()
    claim.finish(result())
    expect(item).to_contain_text("done")
    store.delete(claim.job.id)
    expect(item).to_have_count(0)


def test_a_run_is_cancelled_and_resumed_from_the_list(open_page: Open, store: Store) -> None:
    job = submit(store, TABLES)
    page = open_page(store)
    page.get_by_role("button", name="Cancel run 1").click()
    expect(page.get_by_role("listitem")).to_contain_text("stopped")
    assert store.job(job.id).state == "cancelled"
    page.get_by_role("button", name="Resume run 1").press("Enter")
    expect(page.get_by_role("listitem")).to_contain_text("queued")


def test_deleting_asks_first(open_page: Open, store: Store) -> None:
    store_result(store, result(), TABLES)
    page = open_page(store)
    page.get_by_label("More for run 1").click()
    page.get_by_role("button", name="Delete run 1").click()
    expect(page.get_by_role("dialog", name="Delete run 1?")).to_be_visible()
    require_accessible(page)
    page.get_by_role("button", name="Keep it").click()
    expect(page.get_by_role("listitem")).to_have_count(1)
    expect(page.get_by_label("More for run 1")).to_be_focused()
    page.get_by_label("More for run 1").press("Enter")
    page.get_by_role("button", name="Delete run 1").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    expect(page.get_by_role("heading", name="No runs yet")).to_be_visible()
    assert store.jobs() == []


def test_what_somebody_else_deleted_is_said_and_vanishes(open_page: Open, store: Store) -> None:
    add(store)
    page = open_page(store, expected=("404",), own_clock=True)
    button = page.get_by_role("button", name="Cancel run 1")
    expect(button).to_be_visible()
    page.clock.install()  # so that the list does not look before the button is used
    store.cancel(1)
    store.delete(1)
    button.click()
    expect(page.get_by_role("status").filter(has_text="no longer exists")).to_be_visible()
    page.clock.run_for(5000)
    expect(page.get_by_role("listitem")).to_have_count(0)


def test_runs_are_found_by_name_and_state_and_a_link_finds_the_same(open_page: Open, store: Store) -> None:
    for name in ("Press", "Sieve", "Sieve again"):
        add(store, name)
    store.cancel(2)
    page = open_page(store)
    page.get_by_label("Name", exact=True).fill("sieve")
    expect(page.get_by_role("listitem")).to_have_count(2)
    page.get_by_label("State").select_option("cancelled")
    expect(page.get_by_role("listitem")).to_have_count(1)
    expect(page.get_by_role("listitem")).to_contain_text("run 2")
    again = open_page(store, page.url.partition("/#")[2].join(("#", "")))
    expect(again.get_by_role("listitem")).to_contain_text("run 2")
    expect(again.get_by_label("Name", exact=True)).to_have_value("sieve")
    again.get_by_label("Name", exact=True).fill("loom")
    expect(again.get_by_text("No run matches")).to_be_visible()


def test_older_runs_are_on_further_pages(open_page: Open, store: Store) -> None:
    for number in range(30):
        add(store, f"Feeder {number}")
    page = open_page(store)
    expect(page.get_by_role("listitem")).to_have_count(25)
    page.get_by_role("button", name="Next page").click()
    expect(page.get_by_role("listitem")).to_have_count(5)
    expect(page.get_by_text("Feeder 0", exact=True)).to_be_visible()
    page.get_by_role("button", name="First page").click()
    expect(page.get_by_text("Feeder 29", exact=True)).to_be_visible()


def test_runs_are_sorted_by_keyboard_with_decision_and_workers_in_sight(open_page: Open, store: Store) -> None:
    for name in ("Press", "Feeder", "Sieve"):
        add(store, name)
    bookmark_design(store, 2, dimensions=(0.04, 0.1, 0.0), name="Rounded A", decided=True)
    claim = claim_waiting_job(store, worker="bench-7")
    claim.finish(result())
    page = open_page(store)
    names = page.get_by_role("listitem").locator(".name")
    expect(names).to_have_text(["Sieve", "Feeder", "Press"])
    expect(page.get_by_role("search")).to_contain_text("no worker, 2 waiting: start one with slidercrank worker")
    store.register("one")
    expect(page.get_by_role("search")).to_contain_text("1 worker, 0 busy, 2 waiting")
    page.get_by_label("Sort by").press("n")  # as "name" begins
    expect(names).to_have_text(["Feeder", "Press", "Sieve"])
    again = open_page(store, page.url.partition("/#")[2].join(("#", "")))
    expect(again.get_by_role("listitem").locator(".name")).to_have_text(["Feeder", "Press", "Sieve"])
    page.get_by_label("Sort by").select_option("decided")
    expect(names).to_have_text(["Feeder", "Sieve", "Press"])
    heights = page.get_by_role("listitem").evaluate_all("rows => rows.map(row => row.offsetHeight)")
    assert max(heights) <= 64, "25 runs take two screens at most"


def pictures_asked_for(page: Page) -> list[list[int]]:
    """Return a list that gets the numbers of the runs in each request for pictures from now on."""
    asked: list[list[int]] = []

    def note(request: Request) -> None:
        if "/front-points?" in request.url:
            asked.append([int(number) for number in parse_qs(urlsplit(request.url).query)["job"]])

    page.on("request", note)
    return asked


def runs_with_visible_pictures(page: Page) -> set[int]:
    """Return the numbers of the runs of whose pictures something is seen."""
    return set(
        page.evaluate(
            """() => [...document.querySelectorAll("li.run")].filter((row) => {
              const { top, bottom } = row.querySelector(".thumbnail").getBoundingClientRect();
              return bottom > 0 && top < innerHeight;
            }).map((row) => Number(row.textContent.match(/run (\\d+)/)[1]))"""
        )
    )


@pytest.mark.slow
def test_of_200_runs_only_those_in_sight_are_asked_for_their_fronts(open_page: Open, store: Store) -> None:
    for _ in range(200):
        store_result(store, result(), TABLES)
    page = open_page(store, "#/help")
    page.route(
        "**/api/v1/jobs?*", lambda route: route.continue_(url=route.request.url.replace("limit=25", "limit=200"))
    )
    asked = pictures_asked_for(page)
    page.get_by_role("link", name="Runs").first.click()
    pictures = page.get_by_role("img", name="the front: 2 designs")
    expect(page.get_by_role("listitem").filter(has_text="Compare run")).to_have_count(200)
    expect(pictures.first).to_be_visible()
    first = runs_with_visible_pictures(page)
    assert 4 < len(first) < 20
    assert asked == [sorted(first, reverse=True)]
    expect(pictures).to_have_count(len(first))
    page.mouse.move(600, 400)
    seen = set(first)
    for _ in range(12):
        page.mouse.wheel(0, 150)
        page.wait_for_function(
            "() => new Promise((done) => requestAnimationFrame(() => setTimeout(() => done(true), 50)))"
        )
        seen |= runs_with_visible_pictures(page)
    expect(pictures).to_have_count(len(seen))
    assert sorted(number for request in asked for number in request) == sorted(seen)  # each once
    page.get_by_role("listitem").filter(has_text="run 1 ·").scroll_into_view_if_needed()
    expect(page.get_by_role("listitem").filter(has_text="run 1 ·").get_by_role("img")).to_be_visible()
    asked_for = {number for request in asked for number in request}
    assert asked_for <= seen | runs_with_visible_pictures(page)
    assert len(asked_for) < 90


def test_pictures_stay_while_rows_are_drawn_anew(open_page: Open, store: Store) -> None:
    for _ in range(3):
        store_result(store, result(), TABLES)
    page = open_page(store, "#/help", own_clock=True)
    page.clock.install()
    asked = pictures_asked_for(page)
    page.get_by_role("link", name="Runs").first.click()
    expect(page.get_by_role("img", name="the front: 2 designs")).to_have_count(3)
    page.clock.run_for(130_000)
    expect(page.get_by_text("2 minutes ago").first).to_be_visible()
    expect(page.get_by_role("img", name="the front: 2 designs")).to_have_count(3)
    assert asked == [[3, 2, 1]]


def test_points_of_pictures_are_sent_once(open_page: Open, store: Store) -> None:
    store_result(store, result(rows=ROWS * 50), TABLES)
    page = open_page(store)
    sent: list[list[int]] = []
    for _ in range(2):
        expect(page.get_by_role("img", name="the front: 64 designs")).to_be_visible()
        page.wait_for_function(f"() => ({_SENT})().length === {len(sent) + 1}")
        sent = page.evaluate(_SENT)
        page.get_by_role("link", name="Help").first.click()
        expect(page.get_by_role("heading", level=1)).not_to_have_text("Runs")
        page.get_by_role("link", name="Runs").first.click()
    (first, body), (second, same) = sent
    assert body == same
    assert second < body < first, "the second time only that nothing has changed"


def test_pictures_that_the_service_could_not_give_come_later(open_page: Open, store: Store) -> None:
    store_result(store, result(), TABLES)
    page = open_page(store, "#/help", expected=("503",), own_clock=True)
    page.clock.install()
    page.route("**/front-points?*", lambda route: route.fulfill(status=503, json={"detail": "away"}))
    with page.expect_response("**/front-points?*"):
        page.get_by_role("link", name="Runs").first.click()
    expect(page.get_by_role("listitem")).to_contain_text("2 designs")
    expect(page.get_by_role("img", name="the front")).to_have_count(0)
    page.unroute("**/front-points?*")
    page.clock.run_for(65_000)
    expect(page.get_by_role("img", name="the front: 2 designs")).to_be_visible()


@pytest.mark.slow
def test_runs_without_a_front_have_no_picture(open_page: Open, store: Store) -> None:
    add(store)
    claim_waiting_job(store).fail("its worker was killed", again=False)
    store_result(
        store, replace(result("infeasible", rows=[]), message="time ratio is at most 1.2; got min 1.5"), TABLES
    )
    add(store)
    page = open_page(store, "#/help")
    asked = pictures_asked_for(page)
    with page.expect_response("**/front-points?*"):
        page.get_by_role("link", name="Runs").first.click()
    with page.expect_response("**/api/v1/jobs?*"):  # the second look: nothing has changed
        expect(page.get_by_role("listitem").filter(has_text="Compare run")).to_have_count(3)
    expect(page.get_by_role("img", name="the front")).to_have_count(0)
    assert asked == [[3, 2, 1]]
    expect(page.get_by_text("time ratio is at most 1.2; got at least 1.5")).to_be_visible()  # in the words of the form


def test_two_runs_are_compared(open_page: Open, store: Store, solved: Solved) -> None:
    better = [{**row, "time_ratio": float(row["time_ratio"]) + 1.0} for row in solved.result.designs]  # type: ignore[arg-type]
    store_result(store, solved.result, TABLES)
    store_result(store, solved.result, TABLES, designs=better)
    page = open_page(store)
    link = page.get_by_role("link", name="Compare 2 runs")
    page.get_by_label("Compare run 1").check()
    expect(link).to_have_count(0)
    page.get_by_label("Compare run 2").check()
    link.click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Compare runs")
    cells = page.get_by_role("row").filter(has_text="best time ratio").get_by_role("cell")
    best = max(float(row["time_ratio"]) for row in better)  # type: ignore[arg-type]
    expect(cells.nth(1)).to_have_text(f"{best:.5g} ✓")
    picture = page.get_by_role("img", name="The fronts of 2 runs")
    expect(picture).to_be_visible()
    expect(page.locator(".compare")).to_contain_text(
        "Run 2 matches or beats every design of run 1, to 2 % of each range."
    )
    expect(page.locator(".compare")).to_contain_text("The jobs differ only in their names.")
    require_accessible(page)
    picture.locator(".series-1 circle").first.hover()
    expect(page.locator(".readout")).to_contain_text("Run 1, design")
    cells.nth(1).get_by_role("link").click()
    expect(page.get_by_role("heading", level=1)).to_contain_text("Design", timeout=30_000)
    page.go_back()
    picture.locator(".series-2 rect").first.click()
    page.wait_for_url("**/#/jobs/2/designs/*")
    page.evaluate("location.hash = '#/help'")
    expect(page.get_by_role("heading", level=1)).to_have_text("Help", timeout=30_000)
    store.delete(2)
    gone = open_page(store, "#/compare?jobs=1,2", expected=("404",))
    expect(gone.get_by_text("Run 2 no longer exists.")).to_be_visible()


def test_back_gives_the_focus_back_to_what_led_away(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, reduced_motion="reduce")
    led = page.locator(f".run a.name[href='#/jobs/{solved.number}']")
    led.press("Enter")
    second = page.locator("table.designs tbody a[href*='/designs/2']").first
    second.press("Enter")
    expect(page.get_by_role("heading", level=1)).to_contain_text("Design 2")
    page.go_back()
    expect(second).to_be_focused()
    page.go_back()
    expect(led).to_be_focused()
    page.go_forward()
    expect(second).to_be_focused()
