"""Every view of the page, on a store that has something for each: what is measured, and what is photographed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Page

from slidercrank.service.runs.result import Result
from slidercrank.service.store import Store
from tests.service.api.fixed_front import store_result
from tests.service.store.contents import progress

WIDTHS = (390, 820, 1280, 1920)
"""Widths of screens, px: a phone, a tablet upright, a laptop, a monitor."""
HEIGHTS = {390: 844, 820: 1180, 1280: 900, 1920: 1080}


@dataclass(frozen=True)
class View:
    """A view: its name, its address behind the #, and what is there once it is drawn, as selectors."""

    name: str
    address: str
    ready: tuple[str, ...]

    def open(self, page: Page, origin: str) -> None:
        """Open it, and wait until it is drawn."""
        page.goto(f"{origin}#{self.address}")
        self.wait(page)

    def wait(self, page: Page) -> None:
        """Wait until it is drawn, with its font."""
        for selector in self.ready:
            page.locator(selector).first.wait_for(timeout=60_000)
        page.evaluate("document.fonts.ready.then(() => null)")


def fill(store: Store, results: tuple[Result, Result], tables: dict[str, Any]) -> list[View]:
    """Put runs in all states into an empty store, and return the views on them. results: of runs 1 and 2."""
    first, second = (store_result(store, one, tables) for one in results)
    none = store_result(
        store,
        results[0],
        {**tables, "name": "Press, quick return"},
        name="Press, quick return",
        status="infeasible",
        designs=[],
        extremes={},
        knee=None,
        trade_offs=[],
        message="with a least transmission angle of 40 deg, time ratio is at most 1.2862; got min 1.5",
    )
    store.submit({**tables, "name": "Pump"}, name="Pump")
    stopped = store.claim("test")
    assert stopped is not None
    stopped.fail("no memory", again=False)
    store.submit({**tables, "name": "Compressor"}, name="Compressor", priority=5)
    claim = store.claim("test", lease=3600.0)
    assert claim is not None
    wanted = [item.column for item in results[0].objectives]
    points: list[list[Any]] = [[row[column] for column in wanted] for row in results[0].designs]
    for number in range(1, 6):
        claim.report(progress(number), {"columns": wanted, "points": points[: 4 + 20 * number]})
    store.submit({**tables, "name": "Sieve of the second line"}, name="Sieve of the second line")
    return [
        View("runs", "/", (".runs .run .thumbnail circle",)),
        View("new_run", "/new?preset=feeder", (".beside .status.good:text-is('Ready to start.')", ".sketch svg")),
        View("look", "/look", (".curves .chart", ".facts dd")),
        View("live", f"/jobs/{claim.job.id}", (".points circle", ".log li")),
        View("no_solution", f"/jobs/{none}", (".outcome",)),
        View("front", f"/jobs/{first}", ("table.designs tbody tr", ".linkage svg", ".marks li")),
        View("design", f"/jobs/{first}/designs/2", (".curves .chart", ".trade-offs .answer", ".group tbody tr")),
        View("designs", f"/jobs/{first}/designs/2?beside=5", (".curves .chart", ".group tbody tr")),
        View("compare", f"/compare?jobs={first},{second}", (".points circle",)),
        View("help", "/help", (".quantities li",)),
        View("quantity", "/help/peak_torque", (".terms dt",)),
    ]
