"""Bars in the view of a design: as long as their values, on a screen and on paper."""

from __future__ import annotations

import math

from tests.service.api.fixed_front import Solved
from tests.service.page.conftest import Open


def test_bars_of_objectives_say_where_a_design_is_in_its_front(open_page: Open, solved: Solved) -> None:
    row = solved.result.designs[2]
    page = open_page(solved.store, f"#/jobs/{solved.number}/designs/3", reduced_motion="reduce")
    page.locator(".objective .share").first.wait_for()
    for media in ("screen", "print"):
        page.emulate_media(media=media)
        shares = page.locator(".objective .share").evaluate_all(
            "nodes => nodes.map(node => [node.firstElementChild.getBoundingClientRect().width / node.clientWidth, "
            "getComputedStyle(node.firstElementChild).printColorAdjust])"
        )
        designs = solved.result.designs
        for (share, adjust), wanted in zip(shares, solved.result.objectives, strict=True):
            ranks = [wanted.minimised_value(item) for item in designs]
            expected = (max(ranks) - wanted.minimised_value(row)) / (max(ranks) - min(ranks))
            assert math.isclose(share, expected, abs_tol=0.01)
            assert adjust == "exact"
