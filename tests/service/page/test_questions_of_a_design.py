"""Questions to a design on the page: forms from the declaration, and the numbers of the API in either system."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from playwright.sync_api import Locator, Page, expect

from slidercrank.service.questions.discovery import DESIGN_QUESTIONS, QUESTION_COMMANDS, TOPICS
from slidercrank.service.store import Store
from tests.case_count import ALL_CASES
from tests.service import sized
from tests.service.api.fixed_front import API
from tests.service.api.swinging import solved_at_once, support
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Pages, watched

DESIGN = 2
SYSTEMS = {"si": "metric", "inch": "inch"}
ABOVE = ("extremes", "sensitivity", "tolerances")
"""Questions with a section of their own."""
MISSING = ("clearance", "cylinders", "friction", "indicator", "polygons", "pump", "start_up", "uneven_speed")
"""What the machine of these tests may not have, or what takes long; the service refuses or tells it to other tests."""
TOLD = [name for name in TOPICS if name not in MISSING]
THREE_DIGITS = 5e-3
"""Relative: of a number that the service writes with three digits, and the page with those of the whole number."""
NUMBER = re.compile(r"[-+]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?")
POWER = re.compile("·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)")
RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
ANSWER = """node => [...node.children].flatMap(one => one.matches(".scroll")
  ? [...one.querySelectorAll("tr")].map(row => [...row.cells].map(cell => cell.textContent))
  : [[one.textContent]])"""


@pytest.fixture(scope="module")
def opened(pages: Pages, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Page, str]]:
    """Return a page and the address of its service, with a job that turns and one that swings."""
    with Store(tmp_path_factory.mktemp("asked") / "store.db") as store:
        solved_at_once(store, sized.TABLES)
        solved_at_once(store, support(law="cycloidal", duration="20 s"))
        with watched(pages, store, expected=("422",)) as found:
            found[0].goto(f"{found[1]}/#/help")
            yield found


def systems_of(name: str) -> dict[str, str]:
    """Return the systems of units in which a question is asked: one in turn, or both."""
    turn = list(DESIGN_QUESTIONS).index(name) % 2
    return SYSTEMS if ALL_CASES else dict([list(SYSTEMS.items())[turn]])


SIGNS = {"\u00a0": " ", "−": "-", "°": " deg", "²": "^2", "³": "^3"}
"""Signs of the page, and what the service writes."""


def text_and_numbers(text: str) -> tuple[str, list[float]]:
    """Return a text without its numbers, and these; the page writes powers of ten as 2.3·10⁻⁵."""
    text = POWER.sub(lambda found: f"e{found[1].translate(RAISED)}", text)
    for sign, written in SIGNS.items():
        text = text.replace(sign, written)
    numbers = [float(one.replace(",", "")) for one in NUMBER.findall(text)]
    return " ".join(NUMBER.sub("#", text).split()), numbers


def require_alike(shown: list[list[str]], told: list[list[str]], *, within: float = 1e-9) -> None:
    """Compare rows of texts: the words, and the numbers. within: relative."""
    assert len(shown) == len(told)
    for row, other in zip(shown, told, strict=True):
        for (words, numbers), (expected, values) in zip(
            map(text_and_numbers, row), map(text_and_numbers, other), strict=True
        ):
            assert words == expected
            assert numbers == pytest.approx(values, rel=within, abs=1e-12), other


def told_rows(told: list[dict[str, Any]]) -> list[list[str]]:
    """Return the rows of the text of an answer, as the service writes it."""
    found: list[list[str]] = []
    for block in told:
        found += [block["heads"]] if any(block["heads"]) else []
        found += block["rows"] or [[block["sentence"]]]
    return found


def text_of(parts: list[Any], system: str) -> str:
    """Return a text of an answer that comes as data."""

    def part_text(part: Any) -> str:
        if isinstance(part, str) or "sign" not in part:
            return str(part if isinstance(part, str) else part[system])
        shown = part[system]
        if shown["number"] is None:
            return str(part["missing"])
        size = float(shown["number"])
        whole = 10.0 ** shown["digits"] <= abs(size) < 1e6  # the page writes such a number without an exponent
        look = ".0f" if whole else f".{shown['digits']}g" if shown["decimals"] is None else f".{shown['decimals']}f"
        number = format(size, look)
        return f"{'+' if part['sign'] and float(shown['number']) > 0.0 else ''}{number} {shown['unit']}".rstrip()

    return "".join(map(part_text, parts))


def data_rows(blocks: list[dict[str, Any]], system: str) -> list[list[str]]:
    """Return the rows of an answer that comes as data."""
    found: list[list[str]] = []
    for block in blocks:
        heads = [text_of(one["title"], system) for one in block["columns"]]
        found += [heads] if any(heads) else []
        found += [[text_of(cell, system) for cell in row] for row in block["rows"]]
        found += [] if block["columns"] else [[text_of(block["text"], system)]]
    return found


def open_question(page: Page, address: str, name: str, system: str, job: int = 1) -> Locator:
    """Open a question to a design in a system of units; return its place."""
    page.evaluate("system => { localStorage.setItem('units', system); location.hash = '#/help'; }", system)
    expect(page.get_by_role("heading", level=1)).to_have_text("Help")
    page.evaluate("view => { location.hash = view; }", f"#/jobs/{job}/designs/{DESIGN}?tab={name}")
    place = page.locator(f"section.{name}") if name in (*ABOVE, "swing") else page.locator("section.analyses")
    place.scroll_into_view_if_needed(timeout=30_000)
    return place


def rows_of(place: Locator) -> list[list[str]]:
    """Return the rows of an answer on the page. Fails with what the page says in its place."""
    shown = place.locator(".question > [aria-live] > :not(.busy)").first
    shown.wait_for(timeout=60_000)
    assert shown.get_attribute("class") == "answer", shown.inner_text()
    rows: list[list[str]] = shown.locator("> div").evaluate(ANSWER)
    return rows


def api_record(address: str, path: str, **given: Any) -> Any:
    return httpx.get(f"{address}{API}/jobs/1/designs/{DESIGN}/{path}", params=given, timeout=60.0).json()


@pytest.mark.slow
@pytest.mark.parametrize("name", TOLD)
def test_a_topic_shows_what_the_service_writes_in_either_system(opened: tuple[Page, str], name: str) -> None:
    page, address = opened
    shown = {}
    for system, units in systems_of(name).items():
        answer = api_record(address, f"topics/{name}", units=units)
        if "told" not in answer:
            expect(open_question(page, address, name, system).locator(".question")).to_contain_text("Change the job")
            continue
        shown[system] = rows_of(open_question(page, address, name, system))
        require_alike(shown[system], told_rows(answer["told"]), within=THREE_DIGITS)
        require_alike(shown[system], data_rows(answer["blocks"], units))
    assert len(shown) in (0, len(systems_of(name)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "fields", "number"),
    [
        ("allocate", {"limit_mm": 0.3}, lambda record: record["error_mm"]),
        ("counterweight", {"radius_mm": 50.8}, lambda record: record["after"]["peak_shaking_force_N"]),
        ("law", {"greatest_speed_rpm": 400.0}, lambda record: record["peak_torque_Nm"]),
        ("lever", {"start_deg": -20.0, "end_deg": 50.0}, lambda record: record["travel_mm"]),
        ("sections", {}, lambda record: record["crank_width_mm"]),
        ("swing", {"start_deg": 40.0, "end_deg": 70.0}, lambda record: record["travel_mm"]),
    ],
)
def test_a_command_has_a_form_and_its_answer_on_the_page(
    opened: tuple[Page, str], name: str, fields: dict[str, float], number: Any
) -> None:
    page, address = opened
    answer = api_record(address, name, **fields)
    unit = {"counterweight": 4.4482216152605, "law": 0.1129848290276167}.get(name, 25.4)
    for system, units in systems_of(name).items():
        place = open_question(page, address, name, system) if name != "swing" else tab_of(page, address, system)
        for key, value in fields.items():
            factor = 1 / 25.4 if system == "inch" and key.endswith("_mm") else 1.0
            place.locator(f"[name={key}]").fill(repr(factor * value))
        if fields:  # a click misses the button if an answer above it arrives between press and release
            place.locator(f"[name={key}]").press("Enter")
            place.locator(".busy").wait_for(state="detached", timeout=60_000)
        rows = rows_of(place)
        require_alike(rows, data_rows(answer["blocks"], units))
        size = number(answer[name]) / (unit if system == "inch" else 1.0)
        values = [value for row in rows for cell in row for value in text_and_numbers(cell)[1]]
        assert any(value == pytest.approx(size, rel=5e-4) for value in values), (size, rows)
    labels = place.locator("form label").all_inner_texts()
    declared = DESIGN_QUESTIONS[name].inputs
    assert len(labels) == len(declared)
    assert all(one.title in label for one, label in zip(declared, labels, strict=True))
    require_accessible(page)


def tab_of(page: Page, address: str, system: str) -> Locator:
    """Open the swing of a design that turns."""
    open_question(page, address, "motor", system)
    page.get_by_text("for other machines").click()
    page.get_by_role("tab", name="Swing").press("Enter")
    return page.locator("section.analyses")


def test_a_form_needs_what_the_question_needs_and_names_the_unit_of_the_reader(opened: tuple[Page, str]) -> None:
    page, address = opened
    place = open_question(page, address, "allocate", "si")
    expect(place.get_by_role("alert")).to_have_text("Position error allowed: a value is needed, such as 0.1 mm.")
    field = place.get_by_label("Position error allowed")
    field.fill("−1")
    field.press("Enter")
    expect(place).to_contain_text("Limit must be above 0")
    page.get_by_label("Units").select_option("inch")
    expect(place.locator("label").first).to_have_text("Position error allowed  in")
    refused = api_record(address, "allocate", limit_mm=-1.0)
    assert refused["status"] == 422


def test_the_swing_of_a_design_is_that_of_its_job_until_another_is_asked(opened: tuple[Page, str]) -> None:
    page, address = opened
    place = open_question(page, address, "swing", "si", job=2)
    path = f"{address}{API}/jobs/2/designs/{DESIGN}/swing"
    require_alike(rows_of(place), data_rows(httpx.get(path, timeout=60.0).json()["blocks"], "metric"))
    place.locator("[name=law]").select_option("slow")
    place.get_by_role("button", name="Compute").press("Enter")
    expect(place.locator("h3").first).to_contain_text("slowly", timeout=30_000)
    slow = httpx.get(path, params={"law": "slow"}, timeout=60.0).json()
    require_alike(rows_of(place), data_rows(slow["blocks"], "metric"))


def test_the_service_lists_every_question_with_its_inputs(opened: tuple[Page, str]) -> None:
    _, address = opened
    listed = httpx.get(f"{address}{API}/topics", timeout=60.0).json()
    for of, names in (("topics", TOPICS), ("questions", QUESTION_COMMANDS)):
        assert [one["name"] for one in listed[of]] == list(names)
        for one in listed[of]:
            assert [given["key"] for given in one["inputs"]] == [
                given.key for given in DESIGN_QUESTIONS[one["name"]].inputs
            ]
            assert one["shows"]
