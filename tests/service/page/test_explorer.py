"""The explorer of a front: limits, marks and selected designs are the same in lines, scatter and table."""

from __future__ import annotations

import csv
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from playwright.sync_api import Locator, Page, expect

from slidercrank.service.runs.result import Row, result_of
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import Solved, served, store_result
from tests.service.fronts import JOB
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open
from tests.service.page.large_front import put_large

COUNT = 10_000


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Store, list[Row]]]:
    """Return a store with a front of 10,000 designs, and these."""
    with Store(tmp_path_factory.mktemp("large") / "store.db") as store:
        number = put_large(store, COUNT)
        yield store, store.result(number).designs


def view_of(solved: Solved, query: str = "") -> str:
    """Return the view of the small job."""
    return f"#/jobs/{solved.number}{query}"


def hash_of(page: Page) -> str:
    """Return the part of the address from # on."""
    return f"#{page.url.partition('#')[2]}"


def expect_designs(page: Page, numbers: list[int]) -> None:
    """Wait until the table shows these designs, in this order."""
    shown = page.locator("table.designs tbody tr td:nth-child(2) > a")
    expect(shown).to_have_text([str(number) for number in numbers])


def field(page: Page, label: str) -> Locator:
    """Return the field of a limit, in the menu of its axis, which is open then."""
    open_axis_menu(page, page.get_by_label(label))
    return page.get_by_role("textbox", name=label)


def open_axis_menu(page: Page, within: Locator) -> Locator:
    """Open the menu of the axis that something is in."""
    if not within.first.is_visible():
        page.locator(".axis-head", has=within).locator("summary").click()
    return within


def axis(page: Page, index: int, axes: int) -> tuple[float, float, float]:
    """Return where an axis is: x, top and bottom of its lines, in pixels of the screen."""
    canvas = page.locator(".lines canvas").last
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    assert box is not None
    return box["x"] + box["width"] * (index + 0.5) / axes, box["y"] + 12, box["y"] + box["height"] - 12


def cells(rows: list[Row], key: str) -> list[Any]:
    """Return a column."""
    return [row[key] for row in rows]


def test_a_limit_holds_everywhere_and_in_a_link(open_page: Open, solved: Solved) -> None:
    rows = solved.result.designs
    ratios = sorted(cells(rows, "time_ratio"))
    least = round((ratios[2] + ratios[3]) / 2, 6)
    kept = [index + 1 for index, row in enumerate(rows) if row["time_ratio"] >= least]
    assert 0 < len(kept) < len(rows)
    page = open_page(solved.store, view_of(solved))
    field(page, "At least time ratio").fill(str(least))
    field(page, "At least time ratio").press("Enter")
    expect(page.get_by_text(f"{len(kept)} of {len(rows)} designs listed")).to_be_visible()
    expect_designs(page, kept)
    page.wait_for_url(re.compile(rf"min\.time_ratio={least}"))
    again = open_page(solved.store, hash_of(page))
    expect(again.get_by_text(f"{len(kept)} of {len(rows)} designs listed")).to_be_visible()
    expect_designs(again, kept)
    again.get_by_role("button", name="Clear all limits").click()
    expect(again.get_by_text(f"{len(rows)} of {len(rows)} designs listed")).to_be_visible()


def test_dragging_along_an_axis_is_the_same_as_its_fields(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved))
    expect(page.get_by_text("8 of 8 designs listed")).to_be_visible()
    x, top, bottom = axis(page, 3, 5)
    page.mouse.move(x, top)
    page.mouse.down()
    page.mouse.move(x, (top + bottom) / 2, steps=5)
    page.mouse.up()
    ratios = cells(solved.result.designs, "time_ratio")
    middle = (min(ratios) + max(ratios)) / 2
    expect(field(page, "At least time ratio")).not_to_have_value("")
    least = float(field(page, "At least time ratio").input_value())
    assert least == pytest.approx(middle, rel=0.01)
    kept = [index + 1 for index, ratio in enumerate(ratios) if ratio >= least]
    expect(page.get_by_text(f"{len(kept)} of 8 designs listed")).to_be_visible()
    expect_designs(page, kept)
    page.locator(".axis-head .chooser-list:visible").click(position={"x": 90, "y": 5})  # between its parts
    expect(page.get_by_role("textbox", name="At least time ratio")).to_be_visible()
    page.keyboard.press("Escape")
    page.mouse.dblclick(x, (top + bottom) / 2)
    expect(page.get_by_text("8 of 8 designs listed")).to_be_visible()
    expect(field(page, "At least time ratio")).to_have_value("")


def test_limits_are_in_the_units_of_the_reader_and_stay_those_of_the_service(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved, "?min.rod_mm=254"))
    expect(field(page, "At least rod, mm")).to_have_value("254")
    page.get_by_label("Units").select_option("inch")
    expect(field(page, "At least rod, in")).to_have_value("10")
    field(page, "At most rod, in").fill("20")
    field(page, "At most rod, in").press("Enter")
    page.wait_for_url(re.compile(r"max\.rod_mm=508"))
    page.get_by_text("Axes", exact=True).click()
    expect(page.get_by_role("group", name="Axes").get_by_label("stroke, in", exact=True)).to_be_visible()


def test_sentences_exports_and_figures_follow_the_units_of_the_reader(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved))
    costs = page.locator(".trade-offs")
    metric = re.compile(r"\d (mm|N m|N)\b")
    expect(costs).to_contain_text("costs")
    before = costs.inner_text()
    page.get_by_label("Units").select_option("inch")
    if metric.search(before):
        expect(costs).not_to_have_text(before)
    expect(costs).to_contain_text("costs")
    assert not metric.search(costs.inner_text())
    page.get_by_text("Download", exact=True).click()
    with page.expect_download() as download:
        page.get_by_role("link", name="Designs as CSV").click()
    assert download.value.path().read_text().startswith("number,crank_in,rod_in,offset_in")
    figure = page.get_by_role("link", name=re.compile("as SVG")).first
    expect(figure).to_have_attribute("href", re.compile("units=inch"))
    page.reload()
    expect(page.get_by_label("Units")).to_have_value("inch")
    expect(costs).to_contain_text("costs")
    assert not metric.search(costs.inner_text())
    page.get_by_label("Units").select_option("si")
    expect(costs).to_have_text(re.compile(re.escape(before.split("costs")[0].strip())))


def test_what_is_no_number_is_marked_and_changes_nothing(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved))
    field(page, "At least time ratio").fill("much")
    field(page, "At least time ratio").press("Enter")
    expect(field(page, "At least time ratio")).to_have_attribute("aria-invalid", "true")
    expect(page.get_by_text("8 of 8 designs listed")).to_be_visible()


def test_words_are_ticked(open_page: Open, solved: Solved) -> None:
    words = cells(solved.result.designs, "slow_stroke")
    page = open_page(solved.store, view_of(solved, "?axes=slow_stroke,time_ratio&columns=slow_stroke"))
    page.locator(".axis-head summary", has_text="slow stroke").click()
    group = page.get_by_role("group", name="Only slow stroke")
    first = sorted(set(words))[0]
    group.get_by_label(first).uncheck()
    kept = [word for word in words if word != first] or words  # none ticked is no limit
    expect(page.get_by_text(f"{len(kept)} of 8 designs listed")).to_be_visible()
    expect(page.get_by_role("cell", name=words[0], exact=True).first).to_be_visible()


def test_axes_are_flipped_moved_left_out_and_chosen(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved))
    ratio = page.locator(".axis-head", has_text="time ratio")
    expect(ratio).to_contain_text("↑ better")
    expect(page.get_by_role("columnheader", name="time ratio")).to_contain_text("more is better")
    page.locator(".axis-head summary", has_text="time ratio").press("Enter")
    page.get_by_role("button", name="Flip: time ratio").press("Enter")
    page.wait_for_url(re.compile(r"-time_ratio"))
    expect(ratio).to_contain_text("↓ better")
    page.get_by_role("button", name="Move left: time ratio").click()
    expect(page.get_by_role("button", name="Move left: time ratio")).to_be_focused()  # its menu stays open
    page.keyboard.press("Escape")
    expect(ratio.locator("summary")).to_be_focused()
    for _ in range(2):
        page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Leave out: crank").press("Enter")
    page.get_by_text("Axes", exact=True).click()
    page.get_by_role("group", name="Axes").get_by_label("stroke, mm", exact=True).check()
    page.keyboard.press("Escape")
    expect(field(page, "At least stroke, mm")).to_be_visible()
    page.wait_for_url(re.compile(r"axes=rod_mm%2C-time_ratio%2Coffset_mm%2C\w+%2Cstroke_mm"))


@pytest.mark.parametrize(
    "query", ["?axes=stroke_mm%2Crod_mm", "?x=stroke_mm&y=rod_mm&colour=stroke_mm", "?columns=stroke_mm"]
)
def test_a_column_that_is_constant_but_for_a_last_bit_is_drawn_as_one_value(
    open_page: Open, solved: Solved, tmp_path: Path, query: str
) -> None:
    rows = [{**row, "stroke_mm": (280.0, 280.00000000000006)[n % 2]} for n, row in enumerate(solved.result.designs)]
    with Store(tmp_path / "store.db") as store:
        store_result(store, solved.result, tomllib.loads(JOB), designs=rows)
        page = open_page(store, f"#/jobs/1{query}")
        expect(page.get_by_text("8 of 8 designs listed")).to_be_visible()
        page.get_by_text("Axes", exact=True).click()
        axes = page.get_by_role("group", name="Axes")
        expect(axes).to_be_visible()
        if "axes=" not in query:
            axes.get_by_label("stroke, mm", exact=True).check()
        page.keyboard.press("Escape")
        expect(field(page, "At least stroke, mm")).to_have_attribute("placeholder", "280")
        expect(field(page, "At most stroke, mm")).to_have_attribute("placeholder", "280")


@pytest.mark.slow
def test_the_table_is_sorted_best_first_and_its_columns_are_chosen(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved))
    ratios = cells(solved.result.designs, "least_transmission_angle_deg")
    button = page.get_by_role("columnheader").get_by_role("button", name="least transmission angle")
    best = [row + 1 for row in sorted(range(8), key=lambda row: -ratios[row])]
    button.click()
    page.wait_for_url(re.compile("sort=-least_transmission_angle_deg"))
    expect_designs(page, best)
    button.click()
    page.wait_for_url(re.compile("sort=least_transmission_angle_deg"))
    expect_designs(page, best[::-1])
    field(page, "At least least transmission angle").fill(str(round(sorted(ratios)[3] - 1e-3, 4)))
    field(page, "At least least transmission angle").press("Enter")
    kept = best[4::-1]  # five of eight, the least angle first
    expect_designs(page, kept)
    page.get_by_text("Download", exact=True).click()
    with page.expect_download() as download:
        page.get_by_role("button", name="5 listed, in the order of the table, as CSV").click()
    table = list(csv.DictReader(download.value.path().read_text().splitlines()))
    assert [int(row["number"]) for row in table] == kept
    assert [float(row["rod_mm"]) for row in table] == [solved.result.designs[number - 1]["rod_mm"] for number in kept]
    page.locator("table.designs tbody a").first.click()  # next and previous follow the list
    for number in kept[1:]:
        page.get_by_label("Next design").click()
        page.wait_for_url(re.compile(rf"designs/{number}$"))
    expect(page.get_by_role("heading", level=1)).to_contain_text(f"{kept[-1]} of 8, 5 of 5 listed")
    expect(page.get_by_label("Next design")).to_have_count(0)
    page.locator(".back a").click()
    expect_designs(page, kept)
    page.get_by_role("button", name="Clear all limits").click()
    page.get_by_text("Columns", exact=True).click()
    page.get_by_role("group", name="Columns").get_by_label("status").check()
    expect(page.get_by_role("columnheader", name="status")).to_be_visible()
    expect(page.get_by_role("cell", name="stationary").first).to_be_visible()


def test_the_design_that_weights_choose_is_that_of_the_service(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved))
    page.get_by_role("slider", name="time ratio").fill("9")
    page.get_by_role("slider", name="least transmission angle").fill("2")
    with served(solved.store) as address:
        question = {"topsis": "time_ratio=9, transmission_angle=2"}
        picked = httpx.get(f"{address}{solved.path}/pick", params=question).json()["number"]
    expect(page.get_by_text(f"These weights choose design {picked}.")).to_be_visible()
    page.wait_for_url(re.compile("weights=9%2C2"))


def test_everything_is_reached_by_keyboard(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved))
    first = page.locator("table.designs tbody a").first
    expect(first).to_be_visible()
    first.focus()
    page.keyboard.press("Space")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Space")
    side_by_side = page.get_by_role("link", name="Designs 1, 2 side by side")
    expect(side_by_side).to_have_attribute("href", f"#/jobs/{solved.number}/designs/1?beside=2")
    expect(page.get_by_role("checkbox", name="Select design 2")).to_be_checked()
    page.wait_for_url(re.compile("selected=1%2C2"))
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    page.wait_for_url(re.compile(rf"#/jobs/{solved.number}/designs/3$"))
    page.go_back()
    expect(page.get_by_role("checkbox", name="Select design 2")).to_be_checked()
    designs = solved.result.designs
    order = sorted(range(len(designs)), key=lambda row: float(str(designs[row]["time_ratio"])))
    page.get_by_role("application", name="Scatter").focus()
    page.keyboard.press("ArrowRight")  # the first of the list, which has the greatest time ratio
    for row in order[-2:-4:-1]:
        page.keyboard.press("ArrowLeft")
        expect(page.locator(".dots").get_by_role("status")).to_contain_text(f"Design {row + 1}: time ratio")
        expect(page.locator(".linkage h2")).to_contain_text(f"Design {row + 1}")
    page.keyboard.press("Space")
    expect(page.get_by_role("checkbox", name=f"Select design {order[-3] + 1}", exact=True)).to_be_checked()
    page.get_by_role("application", name="Parallel coordinates").focus()
    for key in ("ArrowDown", "ArrowRight", "ArrowUp"):
        page.keyboard.press(key)
    expect(page.locator(".lines").get_by_role("status")).to_contain_text("follow the axis of rod")
    page.locator(".axis-head summary", has_text="rod").press("Enter")
    page.get_by_role("button", name="Logarithmic: rod").press("Enter")
    page.wait_for_url(re.compile("log=rod_mm"))
    page.keyboard.press("Space")
    expect(page).not_to_have_url(re.compile("log=rod_mm"))


def test_an_axis_may_be_logarithmic(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved, "?log=rod_mm&x=rod_mm&y=time_ratio"))
    expect(page.get_by_role("checkbox", name="Logarithmic, across")).to_be_checked()
    expect(page.get_by_role("checkbox", name="Logarithmic, up")).to_be_hidden()  # 1 to 1.3 is one size
    rods = [float(str(row["rod_mm"])) for row in solved.result.designs]
    x, top, bottom = axis(page, 1, 5)
    page.mouse.move(x, bottom + 3)
    page.mouse.down()
    page.mouse.move(x, (top + bottom) / 2, steps=4)
    page.mouse.up()
    most = field(page, "At most rod, mm")
    expect(most).not_to_have_value("")
    assert float(most.input_value()) == pytest.approx((min(rods) * max(rods)) ** 0.5, rel=0.01)
    page.get_by_role("checkbox", name="Logarithmic, across").uncheck()
    expect(page).not_to_have_url(re.compile("log="))


def test_the_scatter_tells_opens_and_keeps_what_is_in_a_box(open_page: Open, large: tuple[Store, list[Row]]) -> None:
    store, rows = large
    page = open_page(store, "#/jobs/1?x=crank_mm&y=rod_mm")
    canvas = page.locator(".dots canvas").last
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    assert box is not None
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.move(*middle)
    page.mouse.down()
    page.mouse.move(middle[0] + 80, middle[1] + 60, steps=4)
    page.mouse.up()
    page.wait_for_url(re.compile("max.rod_mm"))
    low, high = (float(page.get_by_label(f"At {side} crank, mm").input_value()) for side in ("least", "most"))
    under, over = (float(page.get_by_label(f"At {side} rod, mm").input_value()) for side in ("least", "most"))
    kept = sum(low <= row["crank_mm"] <= high and under <= row["rod_mm"] <= over for row in rows)  # type: ignore[operator]
    assert 0 < kept < COUNT
    expect(page.get_by_text(f"{kept:,} of 10,000 designs listed")).to_be_visible()
    before = page.locator(".linkage h2").inner_text()
    page.mouse.move(middle[0] + 40, middle[1] + 30)
    expect(page.locator(".linkage h2")).not_to_have_text(before)
    (design,) = re.findall(r"^Design (\d+)", page.locator(".linkage h2").inner_text())
    page.mouse.click(middle[0] + 40, middle[1] + 30)
    page.wait_for_url(re.compile(rf"#/jobs/1/designs/{design}$"))


def test_the_linkage_of_what_is_pointed_at_is_drawn_at_one_scale_and_moves(open_page: Open, solved: Solved) -> None:
    rows = solved.result.designs
    page = open_page(solved.store, view_of(solved))
    title = page.locator(".linkage h2")
    crank = page.locator(".linkage circle.path")
    expect(title).to_have_text(re.compile(r"^Design \d+"))  # at rest the knee
    way = page.locator(".linkage .link.crank").locator("..")
    at_rest = way.get_attribute("transform")
    page.wait_for_timeout(100)
    assert way.get_attribute("transform") == at_rest
    radii = []
    for number in (1, len(rows)):
        page.locator("table.designs tbody tr").nth(number - 1).hover()
        expect(title).to_have_text(re.compile(rf"^Design {number}\b"))
        radii.append(float(crank.get_attribute("r") or "nan"))
    expect(way).not_to_have_attribute("transform", at_rest or "")
    cranks = [float(rows[index]["crank_mm"] or 0.0) for index in (0, -1)]
    assert radii[1] / radii[0] == pytest.approx(cranks[1] / cranks[0], rel=1e-9)
    expect(page.locator(".linkage dl")).to_contain_text(f"{cranks[1]:.4g} mm")
    assert page.locator(".worth .small-linkage").count() == page.locator(".worth .marks li").count() > 1

    x, top, _ = axis(page, 3, 5)  # the best time ratio is that of the first design
    page.mouse.move(x + 30, top - 11)
    page.mouse.move(x, top)
    expect(title).to_have_text(re.compile(r"^Design 1\b"))
    page.get_by_role("link", name="3", exact=True).focus()
    expect(title).to_have_text(re.compile(r"^Design 3\b"))
    page.locator(".linkage a", has_text="Open").click()
    page.wait_for_url(re.compile(rf"#/jobs/{solved.number}/designs/3$"))


def test_ten_thousand_designs_are_limited_together_and_right(open_page: Open, large: tuple[Store, list[Row]]) -> None:
    store, rows = large
    page = open_page(
        store, "#/jobs/1?max.peak_torque_Nm=60&min.time_ratio=1.1&max.peak_power_W=900&sort=peak_torque_Nm"
    )
    kept = [
        (row["peak_torque_Nm"], number)
        for number, row in enumerate(rows, 1)
        if row["peak_torque_Nm"] <= 60 and row["time_ratio"] >= 1.1 and row["peak_power_W"] <= 900  # type: ignore[operator]
    ]
    assert 20 < len(kept) < COUNT
    expect(page.get_by_text(f"{len(kept):,} of 10,000 designs listed")).to_be_visible()
    expect_designs(page, [number for _, number in sorted(kept)[:20]])
    page.get_by_role("button", name="Last page").click()
    expect(page.get_by_text(f"{len(kept)} of {len(kept):,}")).to_be_visible()
    expect_designs(page, [number for _, number in sorted(kept)[(len(kept) - 1) // 20 * 20 :]])


def test_the_explorer_is_accessible(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved, "?min.time_ratio=1.01&selected=1,2&weights=3,1&colour=slow_stroke"))
    expect(page.get_by_text("These weights choose")).to_be_visible()
    page.get_by_text("Columns", exact=True).click()
    require_accessible(page)


def test_an_address_with_nonsense_shows_the_front(open_page: Open, solved: Solved) -> None:
    nonsense = "?x=none&y=&axes=-,what&min.time_ratio=abc&max.no=3&selected=0,99,1.5&page=-7&sort=-x&weights=1"
    page = open_page(solved.store, view_of(solved, nonsense))
    expect(page.get_by_text("8 of 8 designs listed")).to_be_visible()
    expect_designs(page, list(range(1, 9)))


@pytest.mark.slow
def test_a_front_is_explored_at_another_size(open_page: Open, solved: Solved) -> None:
    page = open_page(solved.store, view_of(solved), viewport={"width": 390, "height": 800})
    expect(page.get_by_text("8 of 8 designs listed")).to_be_visible()
    for width in (390, 820, 1280):  # no menu leaves the screen
        page.set_viewport_size({"width": width, "height": 800})
        for menu in ("Axes", "Columns", "Download"):
            page.get_by_text(menu, exact=True).click()
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), (menu, width)
            page.get_by_text(menu, exact=True).click()
    page.set_viewport_size({"width": 1200, "height": 800})
    x, top, bottom = axis(page, 4, 5)
    page.mouse.move(x, bottom)
    page.mouse.down()
    page.mouse.move(x, (top + bottom) / 2, steps=4)
    page.mouse.up()
    expect(field(page, "At most least transmission angle")).not_to_have_value("")


@pytest.mark.slow
def test_a_line_drawn_by_hand_keeps_what_is_in_it(open_page: Open, large: tuple[Store, list[Row]]) -> None:
    store, rows = large
    page = open_page(store, "#/jobs/1?x=crank_mm&y=rod_mm")
    page.get_by_role("combobox", name="Drag").select_option("by hand")
    canvas = page.locator(".dots canvas").last
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for dx, dy in ((100, 0), (0, 100)):
        page.mouse.move(x + dx, y + dy)
    page.mouse.up()
    page.wait_for_url(re.compile("lasso=crank_mm%2Crod_mm"))
    shown = parse_qs(urlsplit(hash_of(page).replace("#", "")).query)["lasso"][0].split(",")[2:]
    (x1, y1), (x2, y2), (x3, y3) = (tuple(map(float, shown[i : i + 2])) for i in (0, 2, 4))
    assert (y2, x3) == pytest.approx((y1, x1), rel=1e-3)
    kept = 0
    for row in rows:
        across = (float(row["crank_mm"] or 0.0) - x1) / (x2 - x1)
        up = (float(row["rod_mm"] or 0.0) - y1) / (y3 - y1)
        kept += across >= 0.0 and up >= 0.0 and across + up <= 1.0
    assert kept > 20
    count = page.get_by_text("of 10,000 designs listed")
    found = int(count.inner_text().split()[0].replace(",", ""))
    assert found == pytest.approx(kept, abs=3)  # the address has five digits of the corners
    again = open_page(store, hash_of(page))
    expect(again.get_by_text("of 10,000 designs listed")).not_to_contain_text("10,000 of")
    page.get_by_role("button", name="Clear all limits").click()
    expect(page.get_by_text("10,000 of 10,000 designs listed")).to_be_visible()


def test_a_front_whose_loaded_stroke_is_fast_says_so_and_shows_the_slow_stroke(open_page: Open, store: Store) -> None:
    found = fronts.front(fronts.FOUR[:2], designs=4)
    number = store_result(store, result_of(found, "x"), tomllib.loads(fronts.JOB))
    page = open_page(store, f"#/jobs/{number}")
    expect(page.locator("main")).to_contain_text("Warning: in 4 of 4 designs the loaded stroke")
    table = page.locator("table.designs")
    expect(table.get_by_role("columnheader", name="slow stroke")).to_be_visible()
    expect(table.locator("tbody tr td:last-child")).to_have_text(["inward"] * 4)
