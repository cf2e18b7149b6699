"""Every number of a changed design on the page equals API, CSV and Python: what-ifs, rounded, wished and kept ones."""

from __future__ import annotations

import csv
import io
import tomllib
from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import pytest
from playwright.sync_api import Page, expect

from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.optimise.job import load_job
from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import back_up
from tests.service import fronts
from tests.service.api.fixed_front import API, Solved, store_result
from tests.service.page.accessibility import findings
from tests.service.page.conftest import Pages, watched

LENGTHS = ("crank_mm", "rod_mm", "offset_mm")
NUMBERS = "nodes => nodes.map(node => [node.dataset.key, node.dataset.value])"
Row = dict[str, Any]
STRONG_JOB: list[int] = []  # its number, once it is in the store: other tests may have added jobs
STRONG: dict[str, Any] = {
    "mechanism": {
        "speed": "300 rpm",
        "slider": {"mass": "2 kg"},
        "rod": {"width": "40 mm", "depth": "20 mm", "density": "7850 kg/m^3"},
    },
    "sections": {
        "pins": {"crank_pivot": "20 mm", "crank_pin": "18 mm", "slider_pin": "16 mm"},
        "material": {
            "density": "7850 kg/m^3",
            "elasticity": "207 GPa",
            "yield_strength": "600 MPa",
            "ultimate_strength": "800 MPa",
            "endurance": "200 MPa",
            "bearing_pressure": "40 MPa",
        },
    },
}
"""Tables of a job whose rod has a section, a material and pins."""


@pytest.fixture(scope="module")
def opened(pages: Pages, solved: Solved, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, str, str]]:
    """Return a page, its address and that of the job in the API; nothing may go wrong there."""
    path = tmp_path_factory.mktemp("same") / "store.db"
    back_up(solved.store, path)
    with Store(path) as store, watched(pages, store) as (page, address):
        STRONG_JOB.append(store_result(store, solved.result, tomllib.loads(fronts.JOB) | STRONG))
        yield page, address, f"{address}{API}/jobs/{solved.number}"


def require_python(row: Row, solved: Solved) -> None:
    """Compare a row with what the library says of its lengths."""
    lengths = np.array([[row[key] / 1e3 for key in LENGTHS]])
    expected = analyse(load_job(solved.job).mechanism, lengths).iloc[0]
    known = [key for key in row if key in expected and isinstance(row[key], float)]
    assert len(known) > 30
    for key in known:
        # A millimetre is a thousandth of a metre only to rounding, which forces near a jump amplify.
        assert expected[key] == pytest.approx(row[key], rel=1e-9, abs=1e-9), key


def require_shown(shown: list[tuple[str, str]], row: Row) -> None:
    """Compare the cells of a table with a row."""
    assert shown
    for key, text in shown:
        value = row[key]
        assert (text == "") if value is None else (text == value) if isinstance(value, str) else float(text) == value, (
            key
        )


def numbers_of(page: Page, address: str, number: int, lengths: dict[str, float]) -> list[tuple[str, str]]:
    """Open a design with other lengths; return its column of all numbers."""
    query = "&".join(f"{key}={value!r}" for key, value in lengths.items())
    page.goto(f"{address}/#/help")
    page.goto(f"{address}/#/jobs/{number}/designs/3?{query}")
    cells = page.locator(".numbers [data-design='What if'][data-value]")
    expect(cells.first).to_be_attached(timeout=30_000)
    found: list[tuple[str, str]] = cells.evaluate_all(NUMBERS)
    return found


def test_numbers_of_a_what_if(opened: tuple[Page, str, str], solved: Solved) -> None:
    page, address, api = opened
    lengths = {key: float(str(solved.result.designs[2][key])) for key in LENGTHS}
    lengths["rod_mm"] *= 1.03
    row = httpx.post(f"{api}/designs/3/what-if", json={**lengths, "angles": 0}, timeout=60.0).json()["design"]
    shown = numbers_of(page, address, solved.number, lengths)
    assert {key for key, _ in shown} >= set(row) - {key for key in row if key.startswith("slack_")}
    require_shown(shown, row)
    require_python(row, solved)


def test_numbers_of_a_rounded_design(opened: tuple[Page, str, str], solved: Solved) -> None:
    page, address, api = opened
    body = {"to": ["0.5 mm"], "count": 1}
    (rounded,) = httpx.post(f"{api}/designs/3/rounded", json=body, timeout=60.0).json()["rounded"]["designs"]
    lengths = {key: rounded[key] for key in LENGTHS}
    row = httpx.post(f"{api}/designs/3/what-if", json={**lengths, "angles": 0}, timeout=60.0).json()["design"]
    for key in ("time_ratio", "least_transmission_angle_deg", *LENGTHS):
        assert rounded[key] == pytest.approx(row[key], rel=1e-12)
    require_shown(numbers_of(page, address, solved.number, lengths), row)
    require_python(row, solved)


def test_numbers_of_a_wished_design_that_is_kept(opened: tuple[Page, str, str], solved: Solved) -> None:
    page, address, api = opened
    page.goto(f"{address}/#/help")
    page.goto(f"{address}/#/jobs/{solved.number}?wish.time_ratio=1.3")
    answer = page.locator(".wish-answer")
    table = answer.locator("details table")
    expect(table).to_be_attached(timeout=60_000)
    wished = httpx.post(f"{api}/wish", json={"at": {"time_ratio": "1.3"}}, timeout=60.0).json()
    require_shown(table.locator("[data-value]").evaluate_all(NUMBERS), wished["design"])
    require_python(wished["design"], solved)
    reached = (
        answer.get_by_role("table", name="Desired and achieved values").locator("[data-value]").evaluate_all(NUMBERS)
    )
    assert {key: float(value) for key, value in reached} == {
        one["quantity"]: one["reached"] for one in wished["objectives"]
    }
    answer.get_by_role("button", name="Keep", exact=True).click()
    page.get_by_label("Name of the design").fill("Wished")
    page.get_by_role("dialog").get_by_role("button", name="Keep").click()
    line = page.locator(".kept tbody tr")
    expect(line).to_contain_text("Wished", timeout=30_000)
    (kept,) = httpx.get(f"{api}/kept", timeout=60.0).json()["designs"]
    require_shown(line.locator("[data-value]").evaluate_all(NUMBERS), kept["cells"])
    shared = wished["design"].keys() & kept["cells"].keys()  # how optimal it is was found by the search alone
    assert len(shared) > 40
    for key, value in ((key, wished["design"][key]) for key in shared):
        alike = pytest.approx(value, rel=1e-9, abs=1e-9) if isinstance(value, float) else value
        assert kept["cells"][key] == alike, key
    (row,) = csv.DictReader(io.StringIO(httpx.get(f"{api}/kept.csv", timeout=60.0).text))
    for key, value in kept["cells"].items():
        if isinstance(value, float):
            assert float(row[key]) == value, key


def test_strength_has_a_tab_with_what_the_api_tells(opened: tuple[Page, str, str]) -> None:
    page, address, _ = opened
    page.goto(f"{address}/#/help")
    page.goto(f"{address}/#/jobs/{STRONG_JOB[-1]}/designs/2")
    page.locator(".analyses").scroll_into_view_if_needed(timeout=30_000)
    page.get_by_role("tab", name="Strength").click(timeout=30_000)
    panel = page.get_by_role("tabpanel")
    path = f"{address}{API}/jobs/{STRONG_JOB[-1]}/designs/2/topics/strength"
    found = httpx.get(path, timeout=60.0).json()
    row = httpx.get(f"{address}{API}/jobs/{STRONG_JOB[-1]}/designs/2/analysis", timeout=60.0).json()["analysis"]
    for key, value in found["numbers"].items():
        assert key == "bars" or value == pytest.approx(row[key], rel=1e-9), key
    assert found["numbers"]["bars"].keys() == {"rod"}
    expect(panel.locator("tr", has_text="rod stress")).to_contain_text(f"{found['numbers']['rod_stress_MPa']:.6g}")
    expect(panel.get_by_role("img", name="Figure: Strength")).to_have_js_property("complete", True, timeout=30_000)


@pytest.mark.slow
def test_certify_has_a_tab_that_proves_what_the_command_line_does(
    opened: tuple[Page, str, str], solved: Solved
) -> None:
    page, address, api = opened
    page.goto(f"{address}/#/help")
    page.goto(f"{address}/#/jobs/{solved.number}/designs/2")
    page.locator(".analyses").scroll_into_view_if_needed(timeout=30_000)
    page.get_by_role("tab", name="Proof of the front").press("Enter", timeout=30_000)
    panel = page.get_by_role("tabpanel")
    share = panel.get_by_label("Largest gap, as a fraction of each objective's range")
    share.fill("0.2")
    share.press("Enter")
    expect(panel).to_contain_text("Design box", timeout=60_000)
    query = {"epsilon": 0.2}
    told = httpx.get(f"{api}/certificate", params=query, timeout=60.0).json()["sentences"]
    shown = panel.locator(".answer :is(h3, p)").all_inner_texts()
    assert [text.replace("\u00a0", " ") for text in shown] == told
    assert findings(page) == []


@pytest.mark.slow
def test_like_has_a_tab_that_finds_what_the_api_does(opened: tuple[Page, str, str], solved: Solved) -> None:
    page, address, api = opened
    page.goto(f"{address}/#/help")
    page.goto(f"{address}/#/jobs/{solved.number}/designs/2")
    page.locator(".analyses").scroll_into_view_if_needed(timeout=30_000)
    tab = page.get_by_role("tab", name="Nearest with conditions")
    tab.press("Enter", timeout=30_000)
    panel = page.get_by_role("tabpanel")
    expect(tab).to_be_focused()  # also where the panel has been drawn meanwhile
    where = panel.get_by_label("Conditions, separated by semicolons")
    where.press("Enter")
    expect(panel.get_by_role("alert")).to_contain_text("a value is needed")
    (rod,) = (row["rod_mm"] for row in solved.result.designs[1:2])
    conditions = [f"rod <= {0.9 * float(str(rod))!r} mm", "transmission_angle >= 20 deg"]
    for asked, status in ((conditions, "done"), (["transmission_angle >= 89 deg"], "infeasible")):
        where.fill(" ; ".join(asked))
        where.press("Enter")
        sent = httpx.post(f"{api}/designs/2/like", json={"where": asked}, timeout=60.0).json()
        assert sent["like"]["status"] == status
        (text, *_) = (block["text"] for block in sent["blocks"])
        sentence = str(text[0]).replace(" deg", "°")
        expect(panel.locator(".answer :is(h3, p)").first).to_contain_text(sentence, timeout=60_000)
    assert findings(page) == []
