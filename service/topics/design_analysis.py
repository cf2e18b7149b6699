"""All numbers of one design, and of the topics that are asked for: what `analyse` prints and the API sends."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError
from ..runs.result import Row, rows_of
from .discovery import TOPICS
from .topic import TopicOfDesign

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism
    from ...objectives.quantity import Quantity
    from ..designs.stored_designs import StoredDesign


@dataclass(frozen=True)
class Analysis:
    """Analysis of a design. row: all its numbers. found: those of its topics. notes: what is left out, and why.

    refused: topics that the design does not have, each with the reason. undefined: why quantities have no value, by
    their columns; None without a job, which defines next to nothing.
    """

    row: Row
    found: dict[str, dict[str, Any]]
    topics: tuple[TopicOfDesign, ...]
    notes: list[str]
    refused: list[str]
    undefined: dict[str, str] | None = None

    def record(self) -> dict[str, Any]:
        """Return all numbers of the design and of its topics, for JSON, and the reasons of those that are undefined."""
        return self.row | self.found | ({} if self.undefined is None else {"undefined": self.undefined})


def numbers_of(mechanism: Mechanism, linkage: Linkage, own: Sequence[Quantity] = ()) -> Row:
    """Return every quantity of one design. own: quantities of its job."""
    from ...objectives.tables.analysis import columns_of
    from .peaks import row_of

    return rows_of(columns_of(mechanism, row_of(linkage), own=own))[0]


def undefined_of(row: Row, mechanism: Mechanism, linkage: Linkage, own: Sequence[Quantity] = ()) -> dict[str, str]:
    """Return by column why a design has no value for a quantity. row: from `numbers_of`. own: quantities of its job."""
    from ...objectives.registry import QUANTITIES
    from ...objectives.tables.missing_values import missing_value_reason

    reasons = {}
    for of in (*QUANTITIES.values(), *own):
        reason = of.undefined_because([mechanism])
        value = row.get(of.field)
        if reason is None and isinstance(value, float) and math.isnan(value):
            reason = missing_value_reason(of, mechanism, linkage)
        if reason:
            reasons[of.field] = reason
    return reasons


def numbers_of_swing(design: StoredDesign) -> Row:
    """Return every quantity of a design that swings."""
    import numpy as np

    from ...objectives.tables.swinging import columns_of

    return rows_of(columns_of(design.part.mechanism, np.array([design.values]), design.part.own))[0]


def analysis_of(
    row: Row,
    mechanism: Mechanism,
    linkage: Linkage,
    topics: Sequence[str],
    *,
    more: Sequence[TopicOfDesign] = (),
    options: Mapping[str, dict[str, Any]] | None = None,
    notes: Sequence[str] = (),
    cancelled: Callable[[], bool],
    lenient: bool,
    undefined: dict[str, str] | None = None,
) -> Analysis:
    """Return the analysis of one design.

    row: of `numbers_of`. topics: of `chosen_topics`, each with its options. more: topics after these. cancelled: asked
    now and then; when it says so, the topics left are left out. lenient: a topic that this design does not have is
    left out, not an error. undefined: of `undefined_of`.
    """
    design = tuple(TOPICS[name].of(mechanism, linkage, (options or {}).get(name)) for name in topics)
    design += tuple(more)
    found: dict[str, dict[str, Any]] = {}
    said, refused = list(notes), list[str]()
    for topic in design:
        if cancelled():
            said.append(f"interrupted; left out: {', '.join(t.name for t in design[len(found) + len(refused) :])}")
            break
        try:
            found[topic.name] = topic.numbers(cancelled)
        except InputError as error:
            reason = f"{topic.name}: {error}"
            if not lenient:
                raise InputError(reason) from None
            refused.append(reason)
    return Analysis(row, found, tuple(topic for topic in design if topic.name in found), said, refused, undefined)
