"""Smoothness of a moving design on the page, and delay of an answer to "what if": `python -m benchmarks.page_design`.

Frames: the times that the browser gives to the frames of three seconds of play, for one design and for three side by
side with their forces. What if: from a movement of a length to the end of the frame that shows mechanism, curves,
numbers and front anew, of a service on the same machine.
"""

from __future__ import annotations

import tempfile
import tomllib
from pathlib import Path

from playwright.sync_api import Browser, Page

from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service.page.browser import chromium

from .report import Row, machine, show
from .service_process import Service, service

LEAST_FRAMES = 55.0  # a second
MOST_ANSWER = 100.0  # ms
SECONDS = 3.0
REPEATS = 3
CHANGES = 25
_JOB = Path(__file__).parents[1] / "runs" / "feeder.toml"

_FRAMES = """async (seconds) => {
  const times = [];
  const end = performance.now() + 1000 * seconds;
  while (performance.now() < end) times.push(await new Promise(requestAnimationFrame));
  return (1000 * (times.length - 1)) / (times.at(-1) - times[0]);
}"""
# Moves the crank through its range; a change ends after the frame that shows its answer.
_CHANGES = """async (count) => {
  const field = document.querySelector("#what-if-crank_mm");
  const results = document.querySelector(".what-if .results");
  const start = Number(field.value);
  const painted = () => new Promise((done) => requestAnimationFrame(() => {
    const channel = new MessageChannel();
    channel.port1.onmessage = done;
    channel.port2.postMessage(0);
  }));
  const times = [];
  for (let change = 1; change <= count; change += 1) {
    await new Promise((done) => setTimeout(done, 50));
    const answered = new Promise((done) => new MutationObserver(done).observe(results, {childList: true}));
    const begin = performance.now();
    field.value = start * (1 - 0.004 * change);
    field.dispatchEvent(new Event("input"));
    await answered;
    await painted();
    times.push(performance.now() - begin);
  }
  return times;
}"""


def frames(page: Page, what: str) -> Row:
    """Return the frames a second of a design that moves; the page shows it."""
    page.get_by_role("button", name="Play").click()
    found = [float(page.evaluate(_FRAMES, SECONDS)) for _ in range(REPEATS)]
    page.get_by_role("button", name="Pause").click()
    return Row(f"frames a second, {what}", found, at_least=LEAST_FRAMES)


def answers(page: Page) -> Row:
    """Return how long "what if" takes, ms, from the input to the drawn answer; the page shows a design."""
    page.evaluate(_CHANGES, 3)  # the first ones load what they need
    page.get_by_role("button", name="Reset").click()
    return Row(f"what if, ms, median of {CHANGES} changes", page.evaluate(_CHANGES, CHANGES), at_most=MOST_ANSWER)


def measure(browser: Browser, running: Service, job: int) -> list[Row]:
    """Return all figures of a job that has three designs or more."""
    page = browser.new_page(viewport={"width": 1440, "height": 900}, reduced_motion="reduce")
    found = []
    for what, query in (("one design", ""), ("three designs and their forces", "?beside=2,3")):
        page.goto(running.address_of(f"jobs/{job}/designs/1{query}"))
        page.locator(".trade-offs li").first.wait_for()
        page.get_by_role("checkbox", name="Forces").set_checked(bool(query))
        page.wait_for_timeout(500)
        found.append(frames(page, what))
        if not query:
            found.append(answers(page))
    page.close()
    return found


def solved() -> list[Row]:
    """Solve a small job and return the figures of its designs."""
    tables = tomllib.loads(_JOB.read_text(encoding="utf-8"))
    tables["optimiser"] = {"designs": 10, "samples": 512, "seed": 1}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "store.db"
        with Store(file) as store:
            job = submit(store, tables).id
            work(store, drain=True)
        with service(str(file), Path(folder), workers=0) as running, chromium() as browser:
            return measure(browser, running, job)


def main() -> None:
    """Measure and print."""
    print(machine())
    show("A design on the page", solved())


if __name__ == "__main__":
    main()
