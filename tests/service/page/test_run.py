"""A run while it goes on, and what is said when it did not end well."""

from __future__ import annotations

import re
import threading
import tomllib
from dataclasses import replace
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, Route, expect
from sqlalchemy import delete

from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Store
from slidercrank.service.store.schema import jobs
from slidercrank.service.workers.worker import work
from tests.service import fronts
from tests.service.api.fixed_front import Solved, served, store_result
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open, watch
from tests.service.store.contents import add, claim_waiting_job, progress, result

TABLES = tomllib.loads(fronts.JOB)
FRONT: dict[str, Any] = {
    "columns": ["time_ratio", "crank_mm", "peak_torque_Nm"],
    "points": [[1.2, 30.0, 5.0], [1.3, 40.0, 6.0]],
}


def test_a_run_is_watched_until_its_front_is_there(open_page: Open, store: Store, solved: Solved) -> None:
    submit(store, TABLES)
    page = open_page(store, "#/jobs/1")
    expect(page.get_by_role("banner").last).to_be_visible()
    expect(page.get_by_text("Waiting for a worker.")).to_be_visible()
    claim = claim_waiting_job(store)
    claim.report(replace(progress(1), hypervolume=0.0), FRONT)
    expect(page.get_by_text("None of these meets every requirement yet")).to_be_visible()
    claim.report(progress(2), FRONT)
    expect(page.get_by_text("2 of 9")).to_be_visible()
    expect(page.get_by_role("img", name="The front so far: 2 designs")).to_be_visible()
    expect(page.get_by_text("None of these meets every requirement yet")).to_be_hidden()
    claim.add_message("begins anew")
    expect(page.get_by_text("begins anew")).to_be_visible()
    grown = {**FRONT, "points": [*FRONT["points"], [1.4, 50.0, 7.0]]}
    claim.report(progress(3), grown)
    expect(page.get_by_role("img", name="The front so far: 3 designs")).to_be_visible()
    expect(page.get_by_role("img", name=re.compile("Hypervolume: .* after round 3"))).to_be_visible()
    page.get_by_label("Up").select_option("peak torque")
    expect(page.get_by_role("list", name="Stages").get_by_role("listitem")).to_have_text(
        re.compile("evolving.*rounds 1 to 3")
    )
    expect(page.get_by_text("gained in the last round")).to_be_visible()
    require_accessible(page)
    page.evaluate("window.notReloaded = true")
    claim.finish(solved.result)
    expect(page.get_by_role("heading", name="All designs")).to_be_visible()
    assert page.evaluate("window.notReloaded")


def test_a_page_says_as_soon_as_a_worker_has_the_job(open_page: Open, store: Store) -> None:
    submit(store, TABLES)
    page = open_page(store, "#/jobs/1")
    expect(page.get_by_text("Waiting for a worker. No worker is running.")).to_be_visible()
    store.register("first")
    submit(store, TABLES)
    claim_waiting_job(store, "first")
    expect(page.get_by_text("Waiting for a worker.")).to_be_hidden(timeout=5_000)
    page = open_page(store, "#/jobs/2")
    expect(page.get_by_text("Waiting for a worker. Every worker is busy (1).")).to_be_visible()
    store.register("second")
    expect(page.get_by_text("Waiting for a worker. Every worker is busy (1).")).to_be_hidden(timeout=5_000)
    claim_waiting_job(store)
    expect(page.get_by_text("Waiting for a worker.")).to_be_hidden(timeout=2_000)
    expect(page.get_by_text("The front appears with the first finished designs.")).to_be_visible()


def test_an_estimate_that_is_not_renewed_vanishes(open_page: Open, store: Store) -> None:
    submit(store, TABLES)
    claim = claim_waiting_job(store)
    page = open_page(store, own_clock=True)
    page.clock.install()
    page.goto(f"{page.url}#/jobs/1")
    claim.report(progress(2))
    expect(page.get_by_text("about 0.7 s")).to_be_visible()
    claim.report(replace(progress(2), stage="polishing", step=0, steps=1))
    expect(page.get_by_text("polishing")).to_be_visible()
    expect(page.get_by_text("about 0.7 s")).to_be_visible()
    page.clock.run_for(6_000)
    expect(page.get_by_text("2 of 9")).to_be_visible()
    # What was drawn after the clock was moved on waits for its own seconds, which pass by themselves.
    expect(page.get_by_text("about 0.7 s")).to_be_hidden(timeout=20_000)


def test_long_stages_between_rounds_are_shown_with_how_far_they_are(open_page: Open, store: Store) -> None:
    submit(store, TABLES)
    claim = claim_waiting_job(store)
    page = open_page(store, "#/jobs/1")
    claim.report(progress(9), FRONT)
    expect(page.get_by_text("9 of 9")).to_be_visible()
    stages = {"loading": 1, "repeating rounds": 4, "selecting designs": 1200, "finishing designs": 2900}
    for stage, step in stages.items():
        claim.report(replace(progress(9), stage=stage, step=step, steps=3000), FRONT)
        expect(page.get_by_text(stage)).to_be_visible()
        expect(page.get_by_text(f"{step:,} of 3,000")).to_be_visible()
        expect(page.get_by_role("progressbar", name=stage)).to_have_js_property("value", step)
        expect(page.get_by_role("progressbar", name="Rounds", exact=True)).to_have_js_property("value", 9)
    expect(page.get_by_role("img", name=re.compile("Hypervolume: .* after round 9"))).to_be_visible()
    page.goto(page.url.replace("#/jobs/1", "#/"))
    expect(page.get_by_text("finishing designs, 2,900 of 3,000")).to_be_visible()


def test_a_run_that_was_stopped_twice_is_watched_to_its_end(open_page: Open, store: Store, solved: Solved) -> None:
    submit(store, TABLES)
    claim = claim_waiting_job(store)
    claim.report(progress(2), FRONT)
    store.cancel(1)
    claim.finish(replace(solved.result, status="cancelled"))
    store.resume(1)
    claim_waiting_job(store).fail("no memory", again=False)
    page = open_page(store, "#/jobs/1")
    page.get_by_role("button", name="Resume run 1").click()
    expect(page.get_by_role("heading", name="Front so far")).to_be_visible()
    claim = claim_waiting_job(store)
    claim.report(progress(3), FRONT)
    expect(page.get_by_text("3 of 9")).to_be_visible()
    expect(page.locator(".facts")).not_to_contain_text("8 designs")  # those of the search that was stopped
    page.reload()
    expect(page.get_by_text("failed: no memory")).to_be_visible()
    expect(page.get_by_text("3 of 9")).to_be_visible()
    claim.report(progress(4), FRONT)
    expect(page.get_by_text("4 of 9")).to_be_visible()
    expect(page.get_by_text("The connection to the service was lost.")).to_be_hidden()
    claim.finish(solved.result)
    expect(page.get_by_role("heading", name="All designs")).to_be_visible()


def test_a_search_that_says_nothing_at_first_is_explained(open_page: Open, store: Store) -> None:
    submit(store, TABLES)
    claim = claim_waiting_job(store)
    page = open_page(store, own_clock=True)
    page.clock.install()
    page.goto(f"{page.url}#/jobs/1")
    expect(page.get_by_role("heading", name="Progress")).to_be_visible()
    why = page.get_by_text("compiles the machine model")
    expect(why).to_be_hidden()
    page.clock.run_for(11_000)
    expect(why).to_be_visible()
    claim.report(progress(1))
    expect(page.get_by_text("1 of 9")).to_be_visible()
    expect(why).to_be_hidden()


def test_a_worker_solves_a_run_that_is_watched(open_page: Open, store: Store) -> None:
    submit(store, TABLES)
    page = open_page(store, "#/jobs/1")
    expect(page.get_by_text("Waiting for a worker.")).to_be_visible()
    worker = threading.Thread(target=work, args=(store,), kwargs={"drain": True})
    worker.start()
    expect(page.get_by_text("8 of 8 designs listed")).to_be_visible(timeout=60_000)
    worker.join()


def test_a_running_job_is_cancelled_and_keeps_what_it_found(open_page: Open, store: Store, solved: Solved) -> None:
    submit(store, TABLES)
    claim = claim_waiting_job(store)
    page = open_page(store, "#/jobs/1")
    page.get_by_role("button", name="Stop run 1").click()
    expect(page.get_by_text("stopping")).to_be_visible()
    claim.finish(replace(solved.result, status="cancelled", message="cancelled: 8 designs"))
    expect(page.locator(".state")).to_have_text("◼ stopped")
    expect(page.get_by_role("heading", name="Stopped early")).to_be_visible()
    expect(page.get_by_text("a longer search finds better designs. 8 designs.", exact=False)).to_be_visible()
    expect(page.get_by_text("8 of 8 designs listed")).to_be_visible()
    expect(page.get_by_role("button", name="Resume run 1")).to_be_visible()


def test_a_run_without_a_solution_says_what_contradicts(open_page: Open, store: Store) -> None:
    store_result(
        store, result("infeasible", []), TABLES, message="time ratio 1.5 caps the transmission angle at 27.46 deg"
    )
    page = open_page(store, "#/jobs/1")
    expect(page.get_by_role("heading", name="No design meets all requirements")).to_be_visible()
    told = page.get_by_text("caps the transmission angle")
    expect(told).to_have_text("Time ratio 1.5 caps the transmission angle at 27.46°.")
    expect(page.get_by_role("link", name="Change the job")).to_have_attribute("href", "#/new?from=1")
    require_accessible(page)


def test_a_run_that_failed_says_so_and_what_to_do(open_page: Open, store: Store) -> None:
    add(store)
    claim_waiting_job(store).fail("no memory", again=False)
    page = open_page(store, "#/jobs/1")
    expect(page.get_by_role("heading", name="The run stopped with an error")).to_be_visible()
    expect(page.get_by_text("no memory")).to_be_visible()
    page.get_by_role("button", name="Resume run 1").click()
    expect(page.get_by_role("heading", name="Front so far")).to_be_visible()


@pytest.mark.slow
def test_a_lost_connection_comes_back(browser: Browser, store: Store) -> None:
    submit(store, TABLES)
    claim = claim_waiting_job(store)
    wrong: list[str] = []
    page = browser.new_context().new_page()
    with served(store) as address:
        watch(page, address, wrong, ("Failed to load resource", "ERR_"))
        page.goto(f"{address}/#/jobs/1")
        expect(page.get_by_role("heading", name="Progress")).to_be_visible()
        claim.report(progress(1))
        expect(page.get_by_text("1 of 9")).to_be_visible()
    port = urlsplit(address).port
    assert port is not None
    expect(page.get_by_text("The connection to the service was lost.")).to_be_visible()
    require_accessible(page)
    claim.report(progress(2))
    with served(store, port=port):
        expect(page.get_by_text("2 of 9")).to_be_visible(timeout=15_000)
        expect(page.get_by_text("The connection to the service was lost.")).to_be_hidden()
        claim.report(progress(3))
        expect(page.get_by_text("3 of 9")).to_be_visible()
        page.context.close()
    assert wrong == []


def test_a_run_that_is_deleted_elsewhere_while_it_is_watched_says_so(open_page: Open, store: Store) -> None:
    add(store)
    page = open_page(store, "#/jobs/1", expected=("404",))
    expect(page.get_by_role("heading", name="Progress")).to_be_visible()
    with store.writing() as connection:  # cancelled and deleted before the page heard of either
        connection.execute(delete(jobs))
    expect(page.get_by_role("heading", name="Run 1 no longer exists")).to_be_visible()


def test_what_is_done_with_a_run_that_was_deleted_elsewhere_is_said(open_page: Open, store: Store) -> None:
    add(store)
    store.cancel(1)
    page = open_page(store, "#/jobs/1", expected=("404",))
    button = page.get_by_role("button", name="Resume run 1")
    expect(button).to_be_visible()
    store.delete(1)
    button.click()
    expect(page.get_by_role("status").filter(has_text="no longer exists")).to_be_visible()
    expect(page.get_by_role("heading", name="No runs yet")).to_be_visible()


def test_the_table_of_a_run_is_a_few_steps_of_the_tab_key_from_its_head(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, f"#/jobs/{solved.number}", reduced_motion="reduce")
    expect(page.locator("table.designs tbody tr").first).to_be_visible(timeout=30_000)
    page.locator("#main").focus()
    page.keyboard.press("Tab")
    expect(page.get_by_role("button", name="Skip to the table of designs")).to_be_focused()
    in_table = "document.activeElement.closest('.the-table') !== null"
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    assert page.evaluate(in_table)
    page.locator("#main").focus()
    stops = 0
    while stops < 40 and not page.evaluate(in_table):
        page.keyboard.press("Tab")
        stops += 1
    assert stops <= 15, "through all that stands before it"


def test_a_number_of_no_run_is_said(open_page: Open, store: Store) -> None:
    page = open_page(store, "#/jobs/99", expected=("404",))
    expect(page.get_by_text("there is no job 99; list the jobs")).to_be_visible()


def test_everything_of_a_run_can_be_taken_away(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, f"#/jobs/{solved.number}")
    page.get_by_text("Download", exact=True).click()
    for name in ("Designs as CSV", "Front as JSON", "Designs as Parquet", "job.json"):
        link = page.get_by_role("link", name=name)
        expect(link).to_be_visible()
        with page.expect_download() as download:
            link.click()
        assert download.value.failure() is None
    expect(page.get_by_role("link", name=re.compile("as SVG")).first).to_be_visible(timeout=30_000)
    require_accessible(page)


@pytest.mark.parametrize("before", ["", "#/help"])
def test_a_menu_that_is_opened_before_the_front_came_stays_open(open_page: Open, solved: Solved, before: str) -> None:
    page = open_page(solved.store, before)
    expect(page.get_by_role("heading", level=1)).to_be_visible()
    held: list[Route] = []
    page.route("**/front*", lambda route: held.append(route))
    page.goto(f"{page.url.split('#')[0]}#/jobs/{solved.number}")
    page.get_by_text("Download", exact=True).click()
    link = page.get_by_role("link", name="Designs as CSV")
    expect(link).to_be_visible()
    held.pop().continue_()
    expect(page.get_by_text("8 of 8 designs listed")).to_be_visible()
    expect(link).to_be_visible()
