"""Bars in the view of a design: as long as their values, on a screen and on paper."""

from __future__ import annotations

import math
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.service.questions.tolerances.analysis import numbers
from tests.service import fronts
from tests.service.api.fixed_front import Solved
from tests.service.page.conftest import Open

# Of each row of the tables: the value in words, and the bar and its cell, px.
BARS = """tables => tables.map(table => [table.caption.textContent, [...table.rows].map(row => {
  const cell = row.querySelector(".bars");
  const bar = cell.firstElementChild;
  const seen = getComputedStyle(bar);
  return {
    value: row.lastElementChild.textContent,
    left: bar.getBoundingClientRect().left - cell.getBoundingClientRect().left - cell.clientLeft,
    width: bar.getBoundingClientRect().width,
    whole: cell.clientWidth,
    printed: seen.display !== "none" && seen.visibility === "visible" && seen.printColorAdjust === "exact",
  };
})])"""


def value(text: str) -> float:
    """Return a value as it is written: "−0.34 %"."""
    return 0.0 if text.startswith("–") else float(text.split()[0].replace("−", "-"))


def require_true(page: Page, tables: str, *, signed: bool, common: bool) -> None:
    """Compare all bars with their values. common: of all tables, one scale."""
    found = [(caption, rows) for caption, rows in page.locator(tables).evaluate_all(BARS)]
    assert found
    every = [value(row["value"]) for _, rows in found for row in rows]
    for caption, rows in found:
        own = [value(row["value"]) for row in rows]
        most = max(map(abs, every if common else own))
        for row, number in zip(rows, own, strict=True):
            reach = row["whole"] / 2 if signed else row["whole"]
            asked = reach * abs(number) / most
            assert row["width"] == pytest.approx(asked, abs=1.0), (caption, row)
            start = reach if signed else 0.0
            assert row["left"] == pytest.approx(start - (asked if number < 0.0 else 0.0), abs=1.0), (caption, row)
            assert row["printed"], (caption, row)
        assert max(row["width"] for row in rows) > 1.0 or not any(own)


def _with(route: Route, changes: dict[str, Any]) -> None:
    """Answer as the service does, but for some keys."""
    answer = route.fetch()
    route.fulfill(response=answer, json={**answer.json(), **changes})


def test_bars_are_as_long_as_their_values(open_page: Open, solved: Solved) -> None:
    row = solved.result.designs[2]
    crank, rod, offset = (float(row[f"{name}_mm"] or 0.0) / 1e3 for name in ("crank", "rod", "offset"))
    linkage = Linkage(crank, rod, offset)
    found = {"tolerances": numbers(fronts.MACHINE, linkage, samples=200)}
    assert min(part["share_of_variance_percent"] for part in found["tolerances"]["contributions"]) < 5.0

    page = open_page(solved.store, "", reduced_motion="reduce", viewport={"width": 1280, "height": 900})
    page.route("**/designs/3/requirements", lambda route: _with(route, {"tolerances": True}))
    page.route("**/analysis?show=tolerances", lambda route: route.fulfill(json={"analysis": found}))
    page.evaluate(f"location.hash = '#/jobs/{solved.number}/designs/3'")
    page.locator(".sensitivity").scroll_into_view_if_needed()
    expect(page.get_by_role("table", name="time ratio")).to_be_visible(timeout=30_000)
    page.locator(".tolerances").scroll_into_view_if_needed()
    expect(page.get_by_role("table", name="of the variance")).to_be_visible(timeout=30_000)
    for media in ("screen", "print"):
        page.emulate_media(media=media)
        require_true(page, ".sensitivity table", signed=True, common=True)
        require_true(page, ".tolerances table", signed=False, common=False)
        shares = page.locator(".objective .share").evaluate_all(
            "nodes => nodes.map(node => [node.firstElementChild.getBoundingClientRect().width / node.clientWidth, "
            "getComputedStyle(node.firstElementChild).printColorAdjust])"
        )
        designs = solved.result.designs
        for (share, adjust), wanted in zip(shares, solved.result.objectives, strict=True):
            ranks = [wanted.rank(item) for item in designs]
            expected = (max(ranks) - wanted.rank(row)) / (max(ranks) - min(ranks))
            assert math.isclose(share, expected, abs_tol=0.01)
            assert adjust == "exact"
