"""All numbers of one design and of the requested topics, as `analyse` prints and the API sends them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError
from ..designs.display_units import convert_record, convert_row
from ..designs.judged_requirements import JudgedChoice, Judgement, judged_rules_of_design, violations_of
from ..render.terminal import print_blocks
from ..runs.result import Row, rows_of_columns
from ..text.tables import show_design, show_rules, show_undefined, show_violated
from .design_question import BoundQuestion
from .discovery import TOPIC_COLUMNS, TOPICS

if TYPE_CHECKING:
    from rich.console import Console

    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism
    from ...model.swing.swing import Swing
    from ...objectives.kinds import System
    from ...objectives.quantity import Quantity
    from ...optimise.problem.problem import Problem
    from ..designs.judged_requirements import Judgement
    from ..designs.stored_designs import StoredDesign


@dataclass(frozen=True)
class Analysis:
    """Analysis of a design. row: all its numbers. found: numbers of its topics. notes: omissions with reasons.

    refused: topics that do not apply to the design, each with the reason. undefined: reasons for undefined quantities,
    by column; None if there is no job, as most are then undefined. violated: excess over allowable values, by column.
    """

    row: Row
    topic_numbers: dict[str, dict[str, Any]]
    topics: tuple[BoundQuestion, ...]
    notes: list[str]
    refused: list[str]
    undefined: dict[str, str] | None = None
    violated: dict[str, float] = field(default_factory=dict)

    def record(self, units: System = "metric", judgement: Judgement | None = None) -> dict[str, Any]:
        """Return all numbers of the design and of its topics, ready for JSON, with undefined and violated quantities.

        judgement: its job, evaluated at the design; None if there is no job.
        """
        topics = {topic.name: topic.numbers_in_units(self.topic_numbers[topic.name], units) for topic in self.topics}
        undefined = {} if self.undefined is None else {"undefined": convert_record(self.undefined, units)}
        judged: dict[str, Any] = {}
        if judgement is not None:
            judged["rules"] = [asdict(rule) for rule in judgement.rules]
            if judgement.choices:
                judged["choices"] = [asdict(choice) for choice in judgement.choices]
        return (
            convert_row(self.row, units)
            | topics
            | undefined
            | {"violated": convert_record(self.violated, units)}
            | judged
        )


def judge_design(
    problem: Problem, mechanism: Mechanism, linkage: Linkage, row: Row, system: System = "metric"
) -> Judgement:
    """Return the evaluation of a job at a design, with each combination of its choices.

    mechanism: mechanism of the design, before choices are applied. row: quantities of the design.
    """
    choices = []
    for index, variant in enumerate(problem.variants):
        part = problem.part(index)
        machine, quantities = replace(part.mechanism.nominal, speed=mechanism.speed), row
        if machine != mechanism:
            quantities, _ = quantities_of_design(machine, linkage, part.own)
        missed = tuple(rule for rule in judged_rules_of_design(part, quantities, system) if not rule.met)
        choices.append(JudgedChoice(labels=variant.labels, missed=missed))
    return Judgement(rules=judged_rules_of_design(problem, row, system), choices=choices)


def quantities_of_design(
    mechanism: Mechanism, linkage: Linkage, custom: Sequence[Quantity] = ()
) -> tuple[Row, dict[str, str]]:
    """Return every quantity of one design, and by column the reason for each missing one. custom: custom quantities."""
    from ...objectives.tables.all_quantities import analysis_columns
    from .peaks import lengths_row

    return with_undefined_values(
        rows_of_columns(analysis_columns(mechanism, lengths_row(linkage), custom=custom))[0], mechanism, linkage, custom
    )


def with_undefined_values(
    row: Row, mechanism: Mechanism, linkage: Linkage, custom: Sequence[Quantity] = (), swing: Swing | None = None
) -> tuple[Row, dict[str, str]]:
    """Return a row of all quantities with NaN for undefined ones, and the reason for each by column.

    row: row with the `analysis_columns` a table. custom: custom quantities of the job. swing: swing instead of full
    rotation.
    """
    from ...objectives.registry import QUANTITIES
    from ...objectives.tables.all_quantities import missing_value_reason
    from ...objectives.tables.swing_columns import PEAK_TORQUE_ANGLE
    from ...objectives.torque_and_power import PEAK_TORQUE

    reasons: dict[str, str] = {}
    for quantity in (*QUANTITIES.values(), *custom):
        value = row.get(quantity.field)
        if not isinstance(value, float):
            continue
        reason = quantity.undefined_because([mechanism]) or missing_value_reason(
            quantity, value, mechanism, linkage, swing
        )
        if reason:
            reasons |= {key: reason for key in (quantity.field, f"slack_{quantity.field}") if key in row}
    angle = row.get(PEAK_TORQUE_ANGLE)
    if isinstance(angle, float) and math.isnan(angle):
        reasons[PEAK_TORQUE_ANGLE] = reasons.get(PEAK_TORQUE.field, "the torque is the same at every crank angle")
    return row | dict.fromkeys(reasons, math.nan), reasons


def quantities_of_swing(design: StoredDesign) -> tuple[Row, dict[str, str]]:
    """Return every quantity of a swinging design, and by column the reason for each missing one."""
    import numpy as np

    from ...objectives.tables.swing_columns import swing_columns

    row = rows_of_columns(swing_columns(design.part.mechanism, np.array([design.values]), design.part.own))[0]
    return with_undefined_values(row, design.mechanism, design.linkage, design.part.own, design.part.motion)


def analysis_of(
    row: Row,
    mechanism: Mechanism,
    linkage: Linkage,
    topics: Sequence[str],
    *,
    further_topics: Sequence[BoundQuestion] = (),
    options: Mapping[str, dict[str, Any]] | None = None,
    notes: Sequence[str] = (),
    cancelled: Callable[[], bool],
    lenient: bool,
    undefined: dict[str, str] | None = None,
) -> Analysis:
    """Return the analysis of one design.

    row, undefined: from `quantities_of_design`. topics: from `chosen_topics`, each with its options. further_topics:
    added after these. cancelled: polled; once true, the remaining topics are omitted. lenient: whether to omit a topic
    that does not apply to this design instead of raising an error.
    """
    design = tuple(TOPICS[name].bind_to_design(mechanism, linkage, (options or {}).get(name)) for name in topics)
    design += tuple(further_topics)
    numbers_by_topic: dict[str, dict[str, Any]] = {}
    remarks, refused = list(notes), list[str]()
    for topic in design:
        if cancelled():
            remarks.append(
                f"interrupted; omitted: {', '.join(t.name for t in design[len(numbers_by_topic) + len(refused) :])}"
            )
            break
        try:
            numbers_by_topic[topic.name] = topic.numbers(cancelled)
        except InputError as error:
            reason = f"{topic.name}: {error}"
            if not lenient:
                raise InputError(reason) from None
            refused.append(reason)
    answered = tuple(topic for topic in design if topic.name in numbers_by_topic)
    return Analysis(row, numbers_by_topic, answered, remarks, refused, undefined, violations_of(mechanism, row))


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
