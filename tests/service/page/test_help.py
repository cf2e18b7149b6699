"""The help: how it works, every quantity found, shown with its picture, and accessible."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import expect

from slidercrank.objectives.registry import FACTS
from slidercrank.service.store import Store
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open


def test_the_help_lists_every_quantity_and_finds_those_of_some_words(open_page: Open, store: Store) -> None:
    page = open_page(store, "#/help")
    cards = page.locator(".quantities .panel")
    every = len(FACTS) + 3  # robust ones
    expect(cards).to_have_count(every)
    assert page.locator(".picture").count() == every
    assert page.locator(".picture:not(:has(.mark))").count() == 0  # each points something out
    assert page.locator(".quantities .group").all_inner_texts()[:3] == ["Dimensions", "Motion", "Drive"]
    glossary = (Path(__file__).parents[3] / "docs/glossary.md").read_text()
    terms, meanings = (page.locator(f".terms {part}").all_text_contents() for part in ("dt", "dd"))
    assert len(terms) == len(meanings) > 10
    for term, meaning in zip(terms, meanings, strict=True):
        assert f"| {term} | {meaning} |" in glossary
    page.get_by_label("Search").fill("knee")
    expect(page.locator(".terms dt")).to_have_text(["knee"])
    page.get_by_label("Search").fill("torque motor")
    expect(page.get_by_role("link", name="RMS torque")).to_be_visible()
    expect(page.get_by_role("link", name="footprint")).to_have_count(0)
    assert "search=torque" in page.url
    page.reload()
    expect(page.get_by_label("Search")).to_have_value("torque motor")
    require_accessible(page)


def test_a_quantity_has_a_page_by_its_name_and_by_its_column(open_page: Open, store: Store) -> None:
    page = open_page(store, "#/help/peak_torque")
    expect(page.get_by_role("heading", level=1)).to_have_text("peak torque")
    expect(page.get_by_role("img", name="Picture: peak torque")).to_be_visible()
    expect(page.locator("dl")).to_contain_text("docs/theory.md, section 8. Dynamics")
    expect(page).to_have_title("peak torque · slidercrank")
    assert page.locator(".formula math").count() >= 2
    assert page.locator(".formula mfrac").evaluate("node => node.getBoundingClientRect().height") > 20  # it is set
    page.evaluate("location.hash = '#/help/transmission_angle'")
    page.locator("dl").get_by_role("link", name="offset").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("offset")
    page.evaluate("location.hash = '#/help/peak_torque'")
    expect(page.get_by_role("heading", level=1)).to_have_text("peak torque")
    require_accessible(page)
    page.evaluate("location.hash = '#/help/stroke_mm'")
    expect(page.get_by_role("heading", level=1)).to_have_text("stroke")
    page.evaluate("location.hash = '#/help/nonsense'")
    expect(page.get_by_role("main")).to_contain_text('No quantity is called "nonsense"')
