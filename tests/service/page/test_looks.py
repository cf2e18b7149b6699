"""Every view on every width of screen: nothing too wide, clipped, over other text, or too small to hit."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import Solved, served
from tests.service.page.accessibility import findings
from tests.service.page.conftest import Pages, watch
from tests.service.page.every_view import HEIGHTS, WIDTHS, View, fill
from tests.service.page.looks import faults

VIEWS = (
    *("runs", "new_run", "look", "live", "no_solution", "front"),
    *("design", "designs", "compare", "help", "quantity"),
)

# Curves out of sight are drawn anew a moment after those in sight.
DRAWN = """() => [...document.querySelectorAll(".curves .chart")].every((chart) =>
  Math.abs(chart.getAttribute("viewBox").split(" ")[2] - chart.getBoundingClientRect().width) < 2)"""


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory, solved: Solved) -> Iterator[tuple[str, dict[str, View]]]:
    """Return the address of a service, and its views by name."""
    other = replace(solved.result, name="Sieve, other seed", seed=2)
    with Store(tmp_path_factory.mktemp("looks") / "store.db") as store:
        views = fill(store, (solved.result, other), tomllib.loads(fronts.JOB))
        with served(store) as address:
            yield address, {view.name: view for view in views}


@pytest.mark.slow
@pytest.mark.parametrize("name", VIEWS)
def test_a_view_is_whole_and_legible_on_every_screen(
    pages: Pages, shown: tuple[str, dict[str, View]], name: str
) -> None:
    address, views = shown
    wrong: list[str] = []
    found: dict[str, object] = {}
    with pages.fresh(address, viewport={"width": 1280, "height": 900}, reduced_motion="reduce") as page:
        watch(page, address, wrong)
        views[name].open(page, f"{address}/")
        for width in WIDTHS:
            page.set_viewport_size({"width": width, "height": HEIGHTS[width]})
            page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            page.wait_for_function(DRAWN)
            if worst := faults(page):
                found[f"{width} px"] = worst
        page.set_viewport_size({"width": 1280, "height": 900})
        if broken := findings(page):
            found["light"] = broken
        page.emulate_media(color_scheme="dark")
        if broken := findings(page, ("color-contrast", "link-in-text-block")):
            found["dark"] = broken
    assert not found, json.dumps(found, indent=1)
    assert wrong == []


def test_every_view_is_measured(shown: tuple[str, dict[str, View]], pytestconfig: pytest.Config) -> None:
    _, views = shown
    assert tuple(views) == VIEWS
    files = {file.stem for file in Path(pytestconfig.rootpath, "service/page/static/views").glob("*.js")}
    assert files == {"runs", "new_run", "look", "run", "design", "compare", "help"}
