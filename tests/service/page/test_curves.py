"""Curves of a design over time and the way of the slider, as CSV; forces with scale and number."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Page, expect
from typer.testing import CliRunner

from slidercrank.service.cli import app as command_line
from tests.service.api.fixed_front import Solved
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Pages, watched


@pytest.fixture(scope="module")
def opened(pages: Pages, solved: Solved) -> Iterator[tuple[Page, str]]:
    with watched(pages, solved.store) as (page, address):
        page.goto(f"{address}/#/jobs/{solved.number}/designs/2")
        yield page, address


def test_curves_go_over_what_is_chosen_and_the_address_says_so(opened: tuple[Page, str], solved: Solved) -> None:
    page, address = opened
    page.goto(f"{address}/#/jobs/{solved.number}/designs/2?over=position")
    chart = page.locator("figure[data-key='torque_Nm'] svg")
    expect(chart).to_be_visible(timeout=30_000)
    expect(chart).to_have_attribute("aria-label", re.compile("over the slider position"))
    page.locator("select[name=over]").select_option("time")
    expect(chart).to_have_attribute("aria-label", re.compile("over the time"))
    page.wait_for_url("**over=time*")
    page.locator("select[name=over]").select_option("way")
    require_accessible(page)


def test_three_curves_are_large_and_others_take_their_place(opened: tuple[Page, str], solved: Solved) -> None:
    page, address = opened
    page.goto(f"{address}/#/help")
    page.goto(f"{address}/#/jobs/{solved.number}/designs/2")
    large = page.locator(".curves.large figure")
    expect(large).to_have_count(3, timeout=30_000)
    page.get_by_role("button", name="Make it large: Slider acceleration").press("Enter")
    expect(large.first).to_have_attribute("data-key", "slider_acceleration_m_s2")
    expect(large).to_have_count(3)
    expect(page.get_by_role("button", name="Make it small: Slider acceleration")).to_be_focused()
    page.reload()
    expect(large.first).to_have_attribute("data-key", "slider_acceleration_m_s2", timeout=30_000)


def test_the_csv_of_the_curves_is_that_of_the_command_line(
    opened: tuple[Page, str], solved: Solved, tmp_path_factory: pytest.TempPathFactory
) -> None:
    page, address = opened
    path = str(page.get_by_role("link", name="Curves as CSV").get_attribute("href"))
    found = list(csv.DictReader(io.StringIO(httpx.get(f"{address}/{path}", timeout=60.0).text)))
    file = tmp_path_factory.mktemp("cycle") / "cycle.csv"
    options = ["--runs", str(solved.folder.parent), "--design", "2", "--cycle", str(file)]
    assert CliRunner().invoke(command_line, ["export", "latest", *options]).exit_code == 0
    expected = list(csv.DictReader(io.StringIO(file.read_text())))
    assert len(found) == len(expected) == 360
    for one, other in zip(found, expected, strict=True):
        assert one.keys() == other.keys()
        for key, value in other.items():
            assert (one[key] == value) or float(one[key]) == pytest.approx(float(value), rel=1e-4, abs=1e-4)


def test_forces_have_a_scale_and_each_a_number(opened: tuple[Page, str], solved: Solved) -> None:
    page, address = opened
    page.get_by_role("checkbox", name="Forces").check()
    page.get_by_role("slider", name="Crank angle").press("Home")
    curves = httpx.get(f"{address}{solved.path}/designs/2/curves", timeout=60.0).json()["curves"]
    expect(page.locator(".controls")).to_contain_text("too small for an arrow")
    guide = abs(curves["guide_N"][0])
    expect(page.locator(".legend.forces .guide-force")).to_have_text(f"guide on slider {guide:.4g}\u00a0N")
    dots = page.locator(".mechanism .force").evaluate_all("nodes => nodes.map(node => node.getAttribute('d'))")
    assert all(
        d != "M0 0"
        for d, key in zip(dots, ("pivot_x_N", "crank_pin_x_N", "slider_pin_x_N"), strict=False)
        if curves[key][0]
    )
