"""Text for the analysis of one design."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..designs.display_units import convert_record, convert_row
from ..render.terminal import print_blocks
from ..text.tables import show_design, show_rules, show_undefined, show_violated
from .discovery import TOPIC_COLUMNS

if TYPE_CHECKING:
    from rich.console import Console

    from ...objectives.kinds import System
    from ...objectives.quantity import Quantity
    from ..designs.judged_requirements import Judgement
    from .design_analysis import Analysis


def show_analysis(
    screen: Console,
    analysis: Analysis,
    judgement: Judgement | None,
    units: System,
    *,
    custom: Sequence[Quantity] = (),
    hint: str = "",
) -> None:
    """Write all numbers of a design, its rules as met or missed, and its topics.

    judgement: its job, evaluated at the design; None if there is no job. custom: custom quantities of its job. hint:
    line before the topics, or "".
    """
    row, reasons = analysis.row, (analysis.undefined or {}).items()
    show_design(screen, convert_row({key: row[key] for key in row if key not in TOPIC_COLUMNS}, units), custom=custom)
    show_undefined(screen, {key: why for key, why in reasons if key not in TOPIC_COLUMNS}, custom)
    show_violated(screen, convert_record(analysis.violated, units), convert_row(row, units))
    if judgement is not None:
        show_rules(screen, judgement)
    if hint:
        screen.print(hint, style="dim")
    for topic in analysis.topics:
        screen.print()
        print_blocks(screen, topic.blocks(analysis.topic_numbers[topic.name]), units)
