"""Measurements of a view: width, clipped text, text over other text, the size of what is clicked and of labels."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Page

LEAST_TARGET = 24
"""Least size of what is clicked, px, or room around it (WCAG 2.2, 2.5.8)."""

_SCRIPT = (
    (Path(__file__).parent / "static/looks.mjs").read_text(encoding="utf-8").replace("export function", "function")
)


def faults(page: Page) -> dict[str, list[str]]:
    """Faults: "wider" than the window; text "clipped" or "over" another; "small" targets; "tiny" or "huge" labels."""
    found: dict[str, list[str]] = page.evaluate(f"(least) => {{ {_SCRIPT} return findFaults(least); }}", LEAST_TARGET)
    return found
