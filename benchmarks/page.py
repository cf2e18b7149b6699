"""Speed and size of the page with a front of 10,000 designs: `python -m benchmarks.page`.

First view: from the address of the run to the drawn explorer, in a browser that has seen nothing yet, of a service that
has read the front before; and of one that has not. Brush: from a movement on an axis to the end of the frame that shows
it in lines and scatter; the table follows. Hover: from a movement over the lines to the end of the frame that shows the
linkage of another design. A brush begins half a second after a first view: no hand is there sooner.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from statistics import quantiles

from playwright.sync_api import Browser, Page

from slidercrank.service.store import Store
from tests.service.page.browser import chromium
from tests.service.page.large_front import put_large

from .report import Row, machine, show
from .service_process import service

DESIGNS = 10_000
MOST_FIRST = 1000.0  # ms
MOST_BRUSH = 50.0  # ms
MOST_WEIGHT = 250.0  # kB, of which the typeface is 48
REPEATS = 5

# Moves the pointer along an axis and back, a tenth of it at a time; a step ends after the frame that it caused.
_BRUSH = """async (steps) => {
  const canvas = [...document.querySelectorAll(".lines canvas")].at(-1);
  const box = canvas.getBoundingClientRect();
  const x = box.left + box.width * 1.5 / 7;
  const send = (kind, clientY) =>
    canvas.dispatchEvent(new PointerEvent(kind, {clientX: x, clientY, button: 0, pointerId: 1, bubbles: true}));
  canvas.setPointerCapture = () => {};
  const painted = () => new Promise((done) => requestAnimationFrame(() => {
    const channel = new MessageChannel();
    channel.port1.onmessage = done;
    channel.port2.postMessage(0);
  }));
  const times = [];
  await new Promise((done) => setTimeout(done, 500));
  send("pointerdown", box.top + 20);
  for (let step = 1; step <= steps; step += 1) {
    await new Promise((done) => setTimeout(done, 30));
    const begin = performance.now();
    send("pointermove", box.top + 20 + (box.height - 40) * (1 - Math.abs(2 * step / steps - 1)));
    await painted();
    times.push(performance.now() - begin);
  }
  send("pointerup", box.top + 20);
  return times;
}"""
# Moves the pointer down between two axes; a step ends after the frame that shows the linkage of another design.
_HOVER = """async (steps) => {
  const canvas = [...document.querySelectorAll(".lines canvas")].at(-1);
  const box = canvas.getBoundingClientRect();
  const title = document.querySelector(".linkage h2");
  const painted = () => new Promise((done) => requestAnimationFrame(() => {
    const channel = new MessageChannel();
    channel.port1.onmessage = done;
    channel.port2.postMessage(0);
  }));
  const times = [];
  await new Promise((done) => setTimeout(done, 500));
  for (let step = 1; step <= steps; step += 1) {
    await new Promise((done) => setTimeout(done, 30));
    const before = title.textContent;
    const begin = performance.now();
    const [clientX, clientY] = [box.left + box.width * 2 / 7, box.top + box.height * (0.2 + 0.6 * step / steps)];
    canvas.dispatchEvent(new PointerEvent("pointermove", {clientX, clientY, bubbles: true}));
    await painted();
    if (title.textContent !== before) times.push(performance.now() - begin);
  }
  return times;
}"""
# What came from the service beside its data, compressed as it was, bytes.
_WEIGHT = """() => [...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource")]
  .filter(({name}) => !name.includes("/api/")).reduce((sum, {encodedBodySize}) => sum + encodedBodySize, 0)"""
# Since the page was asked for, ms, once the explorer was painted.
_FIRST = """async () => {
  const frame = () => new Promise(requestAnimationFrame);
  while (document.querySelectorAll("table.designs tbody tr").length < 2) await frame();
  await frame();
  return performance.now();
}"""


def measure() -> list[Row]:
    """Return first views and brushes, ms, and the weight of the page, kB."""
    cold, warm, brushes, hovers, weights = [], [], [], [], []
    with tempfile.TemporaryDirectory() as place, chromium() as browser:
        file = Path(place) / "store.db"
        with Store(file) as store:
            number = put_large(store, DESIGNS)
        for _ in range(REPEATS):
            with service(str(file), Path(place), workers=0) as running:
                view = running.address_of(f"jobs/{number}")
                cold.append(_first_view(browser, view)[0])
                taken, page = _first_view(browser, view)
                warm.append(taken)
                weights.append(page.evaluate(_WEIGHT) / 1000.0)
                hovers += page.evaluate(_HOVER, 20)
                brushes += page.evaluate(_BRUSH, 20)
                page.context.close()
    return [
        Row(f"first view of {DESIGNS} designs, service just started, ms", cold, at_most=MOST_FIRST),
        Row(f"first view of {DESIGNS} designs, ms", warm, at_most=MOST_FIRST, worst=True),
        Row("a brush, median, ms", brushes, at_most=MOST_BRUSH),
        Row("a brush, 95th percentile, ms", [quantiles(brushes, n=20)[-1]], at_most=MOST_BRUSH),
        Row("hover to linkage, 95th percentile, ms", [quantiles(hovers, n=20)[-1]], at_most=MOST_BRUSH),
        Row("page without data, compressed, kB", weights, at_most=MOST_WEIGHT),
    ]


def _first_view(browser: Browser, view: str) -> tuple[float, Page]:
    page = browser.new_context(viewport={"width": 1440, "height": 1000}).new_page()
    page.goto("about:blank")
    page.goto(view, wait_until="commit")
    taken: float = page.evaluate(_FIRST)
    return taken, page


def main() -> None:
    """Measure and print the figures."""
    print(machine())
    show(f"The page with a front of {DESIGNS} designs, headless Chromium, {REPEATS} starts", measure())


if __name__ == "__main__":
    sys.exit(main())
