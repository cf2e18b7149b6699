"""Certificate for a front; without designs, a proof that nothing is feasible."""

import math
from typing import Any

from ....model.arrays import Array
from ....model.linkage.dimensions import DIMENSIONS
from ....objectives.kinds import LENGTH
from ....objectives.tables.design_input import columns_of_design_numbers
from ....optimise.certificate.certificate import Certificate, Step
from ....optimise.certificate.certify import certify_designs
from ....optimise.certificate.defaults import EPSILON, SECONDS
from ....optimise.certificate.infeasibility_certificate import prove_infeasible
from ....optimise.front.front import ParetoFront
from ....optimise.problem.problem import Problem
from ...designs.display_units import convert_record
from ...render.blocks import Block, Value, heading, joined, sentence, words
from ...runs.result import rows_of_columns
from ..front_or_job_question import Answer, SearchListener

_MOST_NOTES = 8


def analyse(
    front: ParetoFront, *, watch: SearchListener, epsilon: float = EPSILON, seconds: float = SECONDS, **_: Any
) -> Answer:
    """Return the certificate, or the proof for a front without designs. Raises the errors of `certify_designs`."""
    if not len(front):
        return _infeasibility_result(front.problem, seconds)

    def report(step: Step) -> None:
        proven = f"{100.0 * step.epsilon:.3g} % proven" if math.isfinite(step.epsilon) else "nothing proven yet"
        watch.report(f"{proven}, {step.open:,} of {step.boxes:,} boxes open, {step.added:,} designs added")

    options = {"epsilon": epsilon, "seconds": seconds}
    certificate = certify_designs(
        front.problem,
        front.dimensions,
        variants=front.variants,
        **options,
        progress=report,
        cancelled=watch.cancelled,
    )
    record = _certificate_record(certificate, front.problem)
    return Answer(
        record=lambda units: convert_record(record, units),
        blocks=_certificate_blocks(certificate, front),
        is_satisfied=certificate.proven,
        message=certificate.message,
        search_result=certificate,
    )


def _infeasibility_result(problem: Problem, seconds: float) -> Answer:
    proven = prove_infeasible(problem, seconds=seconds)
    text = "no design within the ranges meets all requirements"
    message = f"proven: {text}" if proven else f"not proven that {text}; allow more time"
    record = {"name": problem.name, "infeasible": proven, "message": message}
    lines = [sentence("{name}: {message}", name=problem.name, message=message)]
    return Answer(record=lambda _: dict(record), blocks=lines, is_satisfied=proven, message=message)


def _certificate_record(certificate: Certificate, problem: Problem) -> dict[str, Any]:
    """Return a certificate ready for JSON, metric; the added designs come last, with all their numbers."""
    quantities = [problem.quantity(objective.quantity) for objective in problem.objectives]
    return {
        "name": problem.name,
        "status": certificate.status,
        "message": certificate.message,
        "epsilon_asked": certificate.requested,
        "epsilon": certificate.epsilon,
        "epsilon_of_delivered": certificate.delivered,
        "gap_of_delivered": certificate.gap,
        "hole": _values_by_column(certificate.hole, problem),
        "ranges": {
            quantity.field: float(span) * quantity.unit.factor
            for quantity, span in zip(quantities, certificate.span, strict=True)
        },
        "hypervolume_gap": certificate.hypervolume_gap,
        "boxes": certificate.boxes,
        "open_boxes": certificate.open,
        "remaining_share": certificate.remaining,
        "remaining_where": _values_by_column(certificate.worst_open_box, problem),
        "notes": list(certificate.notes),
        "seconds": certificate.seconds,
        "added": rows_of_columns(certificate.table.to_dict("list")) if len(certificate.table) else [],
    }


def _values_by_column(values: Array | None, problem: Problem) -> dict[str, Any] | None:
    if values is None:
        return None
    columns = columns_of_design_numbers(problem.mechanism.varying).values()
    return {key: (unit.factor * value).tolist() for (key, unit), value in zip(columns, values, strict=True)}


def _certificate_blocks(certificate: Certificate, front: ParetoFront) -> list[Block]:
    share = f", {certificate.open:,} open ({100.0 * certificate.remaining:.3g} % of it)" if certificate.open else ""
    blocks: list[Block] = [
        heading("{name}: {message}", name=front.problem.name, message=certificate.message),
        sentence(f"Design box: {certificate.boxes:,} boxes in {certificate.seconds:.1f} s{share}"),
    ]
    if certificate.worst_open_box is not None:
        ranges = [
            words("{name} {low} to {high}", name=name, low=Value(low, LENGTH, bare=True), high=Value(high, LENGTH))
            for name, (low, high) in zip(DIMENSIONS, certificate.worst_open_box[:3].tolist(), strict=True)
        ]
        blocks.append(sentence("Largest gap in the proof: {ranges}", ranges=joined(ranges)))
    if certificate.hole is not None:
        sizes = [
            words("{name} {size}", name=name, size=Value(size, LENGTH))
            for name, size in zip(DIMENSIONS, certificate.hole[:3].tolist(), strict=True)
        ]
        blocks.append(sentence("Largest gap in the front of the search: {sizes}", sizes=joined(sizes)))
    if math.isfinite(gap := certificate.hypervolume_gap):
        volume = f"Hypervolume: {front.hypervolume:.6g}; that of the true front is larger by at most {gap:.3g}"
        blocks.append(sentence(volume))
    return [*blocks, *(sentence("Note: {note}", note=note) for note in certificate.notes[:_MOST_NOTES])]
