"""Text of the analysis of one design."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..designs.shown_units import record_in, row_in
from ..render.terminal import print_blocks
from ..text.tables import show_design, show_rules, show_undefined, show_violated
from .discovery import TOLD_THERE

if TYPE_CHECKING:
    from rich.console import Console

    from ...objectives.kinds import System
    from ...objectives.quantity import Quantity
    from ..designs.requirements import JudgedRule
    from .design_analysis import Analysis


def show_analysis(
    screen: Console,
    found: Analysis,
    rules: Sequence[JudgedRule],
    units: System,
    *,
    own: Sequence[Quantity] = (),
    more: str = "",
) -> None:
    """Write all numbers of a design, how it meets the rules of its job, and its topics.

    own: quantities of its job. more: a line before the topics, "" for none.
    """
    row, reasons = found.row, (found.undefined or {}).items()
    show_design(screen, row_in({key: row[key] for key in row if key not in TOLD_THERE}, units), own=own)
    show_undefined(screen, {key: why for key, why in reasons if key not in TOLD_THERE}, own)
    show_violated(screen, record_in(found.violated, units), row_in(row, units))
    show_rules(screen, rules)
    if more:
        screen.print(more, style="dim")
    for topic in found.topics:
        screen.print()
        print_blocks(screen, topic.blocks(found.found[topic.name]), units)
