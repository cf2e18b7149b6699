"""The picture of points that a running search and a comparison show."""

from __future__ import annotations

from typing import Any

from playwright.sync_api import Page

from slidercrank.service.store import Store
from tests.service.page.conftest import Open

DRAWN = """async (places) => {
  const { points } = await import(new URL("page/charts/points.js", document.baseURI));
  const column = { title: "peak torque", unit: "N m" };
  const picture = points([{ points: places }], column, column, "a front");
  const ticks = [...picture.querySelectorAll("text:not(.title)")].map((one) => one.textContent);
  return [picture.querySelectorAll("circle").length, ticks];
}"""


def drawn_points(page: Page, places: list[list[float | str | None]]) -> Any:
    return page.evaluate(DRAWN, places)


def test_a_design_without_a_value_is_left_out_and_leaves_the_axes_as_they_are(open_page: Open, store: Store) -> None:
    page = open_page(store, "#/help")
    whole: list[list[float | str | None]] = [[100.0, 140.0], [103.0, 150.0], [105.0, 160.0]]
    count, ticks = drawn_points(page, whole)
    assert count == 3
    assert drawn_points(page, [*whole, [None, 155.0], [104.0, None], [None, None], ["inward", 150.0]]) == [count, ticks]
    assert drawn_points(page, [[None, None]])[0] == 0
    assert drawn_points(page, [])[0] == 0
