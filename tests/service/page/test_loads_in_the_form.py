"""Loads in the form: their effect below each, a force over part of a stroke, a warning for pushing forces."""

from __future__ import annotations

from playwright.sync_api import expect

from slidercrank.service.store import Store
from tests.service.page.conftest import Open, ready, text_of


def test_each_load_says_what_it_does_and_one_that_pushes_is_questioned(form: Open, store: Store) -> None:
    page = form(store, "#/new?preset=feeder")
    ready(page)
    first, second = (page.get_by_role("group", name=f"Load {number}") for number in (1, 2))
    expect(first).to_contain_text("2000 N inward, resists the outward stroke, throughout")
    expect(second).to_contain_text("60 N, resists both strokes, throughout")

    first.get_by_label("over", exact=True).fill("last 60 mm")
    expect(first).to_contain_text("from 60 mm before the outer dead centre to it; zero beyond")
    assert text_of(page)["load"][0] == {"force": "2 kN", "opposes": "outward stroke", "over": "last 60 mm"}

    first.get_by_label("kind of load", exact=True).select_option("direction")
    first.get_by_label("direction", exact=True).select_option("outward")
    first.get_by_label("during", exact=True).select_option("outward stroke")
    first.get_by_label("force", exact=True).fill("350")
    expect(first).to_contain_text("350 N outward, helps the outward stroke, throughout")
    beside = page.get_by_role("complementary")
    expect(beside).to_contain_text("do more work on the machine than they absorb")
    expect(beside).to_contain_text("if the load should resist, reverse its sign or define it as a force that")

    first.get_by_label("kind of load", exact=True).select_option("helps")
    expect(first).to_contain_text("helps the inward stroke")
    expect(beside).not_to_contain_text("do more work on the machine")
