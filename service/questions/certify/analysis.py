"""Certificate of a front; without designs, a proof that nothing is feasible."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ....model.linkage.dimensions import DIMENSIONS
from ....objectives.kinds import LENGTH
from ....optimise.certificate.certify import EPSILON, SECONDS, certify_designs
from ....optimise.certificate.infeasible import prove_infeasible
from ...designs.shown_units import record_in
from ...render.blocks import Block, Value, heading, joined, sentence, words
from ...runs.result import rows_of
from ..wider import Answer, Watch

if TYPE_CHECKING:
    from ....model.arrays import Array
    from ....optimise.certificate.certificate import Certificate, Step
    from ....optimise.front.front import ParetoFront
    from ....optimise.problem.problem import Problem

_SHOWN_NOTES = 8


def answer(front: ParetoFront, *, watch: Watch, epsilon: float = EPSILON, seconds: float = SECONDS, **_: Any) -> Answer:
    """Return the certificate, or of a front without designs the proof. Raises as `certify_designs` does."""
    if not len(front):
        return _nothing_feasible(front.problem, seconds)

    def tell(at: Step) -> None:
        proven = f"{100.0 * at.epsilon:.3g} % proven" if math.isfinite(at.epsilon) else "nothing proven yet"
        watch.tell(f"{proven}, {at.open:,} of {at.boxes:,} boxes open, {at.added:,} designs added")

    options = {"epsilon": epsilon, "seconds": seconds}
    found = certify_designs(front.problem, front.dimensions[:, :3], **options, progress=tell, cancelled=watch.cancelled)
    record = _record(found, front.problem)
    return Answer(
        record=lambda units: record_in(record, units),
        blocks=_blocks(found, front),
        met=found.proven,
        message=found.message,
        found=found,
    )


def _nothing_feasible(problem: Problem, seconds: float) -> Answer:
    proven = prove_infeasible(problem, seconds=seconds)
    text = "no design within the ranges meets all requirements"
    message = f"proven: {text}" if proven else f"not proven that {text}; allow more time"
    record = {"name": problem.name, "infeasible": proven, "message": message}
    lines = [sentence("{name}: {message}", name=problem.name, message=message)]
    return Answer(record=lambda _: dict(record), blocks=lines, met=proven, message=message)


def _record(found: Certificate, problem: Problem) -> dict[str, Any]:
    """Return a certificate for JSON, metric; at the end the added designs with all their numbers."""
    wanted = [problem.quantity(objective.quantity) for objective in problem.objectives]
    return {
        "name": problem.name,
        "status": found.status,
        "message": found.message,
        "epsilon_asked": found.asked,
        "epsilon": found.epsilon,
        "epsilon_of_delivered": found.delivered,
        "gap_of_delivered": found.gap,
        "hole": _by_size(found.hole),
        "ranges": {of.field: float(span) * of.unit.factor for of, span in zip(wanted, found.span, strict=True)},
        "hypervolume_gap": found.hypervolume_gap,
        "boxes": found.boxes,
        "open_boxes": found.open,
        "remaining_share": found.remaining,
        "remaining_where": _by_size(found.where),
        "notes": list(found.notes),
        "seconds": found.seconds,
        "added": rows_of(found.table.to_dict("list")) if len(found.table) else [],
    }


def _by_size(values: Array | None) -> dict[str, Any] | None:
    sizes = (f"{name}_mm" for name in DIMENSIONS)
    return None if values is None else dict(zip(sizes, (1e3 * values).tolist(), strict=True))


def _blocks(found: Certificate, front: ParetoFront) -> list[Block]:
    share = f", {found.open:,} open ({100.0 * found.remaining:.3g} % of it)" if found.open else ""
    blocks: list[Block] = [
        heading("{name}: {message}", name=front.problem.name, message=found.message),
        sentence(f"Design box: {found.boxes:,} boxes in {found.seconds:.1f} s{share}"),
    ]
    if found.where is not None:
        ranges = [
            words("{name} {low} to {high}", name=name, low=Value(low, LENGTH, bare=True), high=Value(high, LENGTH))
            for name, (low, high) in zip(DIMENSIONS, found.where.tolist(), strict=True)
        ]
        blocks.append(sentence("Largest gap in the proof: {ranges}", ranges=joined(ranges)))
    if found.hole is not None:
        sizes = [
            words("{name} {size}", name=name, size=Value(size, LENGTH))
            for name, size in zip(DIMENSIONS, found.hole.tolist(), strict=True)
        ]
        blocks.append(sentence("Largest gap in the front of the search: {sizes}", sizes=joined(sizes)))
    if math.isfinite(gap := found.hypervolume_gap):
        volume = f"Hypervolume: {front.hypervolume:.6g}; that of the true front is larger by at most {gap:.3g}"
        blocks.append(sentence(volume))
    return [*blocks, *(sentence("Note: {note}", note=note) for note in found.notes[:_SHOWN_NOTES])]
