"""All numbers of one design, and of the topics that are asked for: what `analyse` prints and the API sends."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError
from ..designs.shown_units import record_in, row_in
from ..designs.violations import violated_by
from ..runs.result import Row, rows_of
from .discovery import TOPICS
from .question import QuestionOfDesign

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism
    from ...model.swing.swing import Swing
    from ...objectives.kinds import System
    from ...objectives.quantity import Quantity
    from ..designs.requirements import JudgedRule
    from ..designs.stored_designs import StoredDesign


@dataclass(frozen=True)
class Analysis:
    """Analysis of a design. row: all its numbers. found: those of its topics. notes: what is left out, and why.

    refused: topics that the design does not have, each with the reason. undefined: why quantities have no value, by
    their columns; None without a job, which defines next to nothing. violated: by how much the design goes beyond
    allowable values, by column.
    """

    row: Row
    found: dict[str, dict[str, Any]]
    topics: tuple[QuestionOfDesign, ...]
    notes: list[str]
    refused: list[str]
    undefined: dict[str, str] | None = None
    violated: dict[str, float] = field(default_factory=dict)

    def record(self, units: System = "metric", rules: Sequence[JudgedRule] | None = None) -> dict[str, Any]:
        """Return all numbers of the design and of its topics, for JSON, with what is undefined and what is violated.

        rules: of its job at the design; None without one.
        """
        topics = {topic.name: topic.numbers_in(self.found[topic.name], units) for topic in self.topics}
        undefined = {} if self.undefined is None else {"undefined": record_in(self.undefined, units)}
        judged = {} if rules is None else {"rules": [asdict(rule) for rule in rules]}
        return row_in(self.row, units) | topics | undefined | {"violated": record_in(self.violated, units)} | judged


def numbers_of(mechanism: Mechanism, linkage: Linkage, own: Sequence[Quantity] = ()) -> tuple[Row, dict[str, str]]:
    """Return every quantity of one design, and by column why it lacks others. own: quantities of its job."""
    from ...objectives.tables.analysis import columns_of
    from .peaks import row_of

    return determined(rows_of(columns_of(mechanism, row_of(linkage), custom=own))[0], mechanism, linkage, own)


def determined(
    row: Row, mechanism: Mechanism, linkage: Linkage, own: Sequence[Quantity] = (), swing: Swing | None = None
) -> tuple[Row, dict[str, str]]:
    """Return a row of all quantities with NaN for those that a design lacks, and by column why it lacks them.

    row: of the `columns_of` of a table. own: quantities of the job. swing: in place of a full turn.
    """
    from ...objectives.peak_torque import PEAK_TORQUE
    from ...objectives.registry import QUANTITIES
    from ...objectives.tables.missing_values import missing_value_reason
    from ...objectives.tables.turn_columns import PEAK_TORQUE_ANGLE

    reasons: dict[str, str] = {}
    for of in (*QUANTITIES.values(), *own):
        value = row.get(of.field)
        if not isinstance(value, float):
            continue
        reason = of.undefined_because([mechanism]) or missing_value_reason(of, value, mechanism, linkage, swing)
        if reason:
            reasons |= {key: reason for key in (of.field, f"slack_{of.field}") if key in row}
    angle = row.get(PEAK_TORQUE_ANGLE)
    if isinstance(angle, float) and math.isnan(angle):
        reasons[PEAK_TORQUE_ANGLE] = reasons.get(PEAK_TORQUE.field, "the torque is the same at every crank angle")
    return row | dict.fromkeys(reasons, math.nan), reasons


def numbers_of_swing(design: StoredDesign) -> tuple[Row, dict[str, str]]:
    """Return every quantity of a design that swings, and by column why it lacks others."""
    import numpy as np

    from ...objectives.tables.swinging import columns_of

    row = rows_of(columns_of(design.part.mechanism, np.array([design.values]), design.part.own))[0]
    return determined(row, design.mechanism, design.linkage, design.part.own, design.part.motion)


def analysis_of(
    row: Row,
    mechanism: Mechanism,
    linkage: Linkage,
    topics: Sequence[str],
    *,
    more: Sequence[QuestionOfDesign] = (),
    options: Mapping[str, dict[str, Any]] | None = None,
    notes: Sequence[str] = (),
    cancelled: Callable[[], bool],
    lenient: bool,
    undefined: dict[str, str] | None = None,
) -> Analysis:
    """Return the analysis of one design.

    row, undefined: of `numbers_of`. topics: of `chosen_topics`, each with its options. more: topics after these.
    cancelled: asked now and then; when it says so, the topics left are left out. lenient: a topic that this design does
    not have is left out, not an error.
    """
    design = tuple(TOPICS[name].of(mechanism, linkage, (options or {}).get(name)) for name in topics)
    design += tuple(more)
    found: dict[str, dict[str, Any]] = {}
    said, refused = list(notes), list[str]()
    for topic in design:
        if cancelled():
            said.append(f"interrupted; omitted: {', '.join(t.name for t in design[len(found) + len(refused) :])}")
            break
        try:
            found[topic.name] = topic.numbers(cancelled)
        except InputError as error:
            reason = f"{topic.name}: {error}"
            if not lenient:
                raise InputError(reason) from None
            refused.append(reason)
    shown = tuple(topic for topic in design if topic.name in found)
    return Analysis(row, found, shown, said, refused, undefined, violated_by(mechanism, row))
