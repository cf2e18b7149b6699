"""Accessibility of a page: findings of axe-core in light and in dark, and fit on a narrow screen."""

from __future__ import annotations

from collections.abc import Sequence

from axe_playwright_python.base import AXE_SCRIPT  # type: ignore[import-untyped]
from playwright.sync_api import Page

# The rules that look at colours, which are all that a scheme changes.
_OF_COLOURS = ("color-contrast", "link-in-text-block")
_ALIKE = "tr:nth-child(n + 5)"
"""Rows that look like those above them. `test_looks` measures every row of every view."""


def findings(page: Page, rules: Sequence[str] = (), without: str = "") -> list[tuple[str, list[str]]]:
    """Findings of axe-core: each broken rule with its places. rules: all unless given. without: places to pass over."""
    # Places that break no rule are not described: that takes longer than to find them. No rule that is on asks for the
    # text of style sheets, which would be read once more.
    options = {"resultTypes": ["violations"], "preload": {"assets": ["media"]}} | (
        {"runOnly": list(rules)} if rules else {}
    )
    if page.evaluate("!window.axe"):
        page.evaluate(AXE_SCRIPT)
    run = "async ([where, options]) => (await axe.run(where, options)).violations"
    found = page.evaluate(run, [{"exclude": [without] if without else []}, options])
    return [(rule["id"], [node["html"][:200] for node in rule["nodes"]]) for rule in found]


def require_accessible(page: Page) -> None:
    """Fail with what axe-core finds, in either scheme; and if the page is wider than a small phone."""
    page.emulate_media(color_scheme="light")
    found = findings(page, without=_ALIKE)
    assert found == [], found
    page.emulate_media(color_scheme="dark")
    assert findings(page, _OF_COLOURS, _ALIKE) == []
    page.emulate_media(color_scheme="light")
    size = page.viewport_size
    assert size is not None
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    page.set_viewport_size(size)
