"""`slidercrank certify`: a proof of how far the front of a run can be from the true one."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..designs.columns import DIMENSIONS
from ..runs.result import Result, Row, csv_text, json_text, rows_of
from ..runs.run_folder import write_file
from ..runs.stored_runs import problem_of
from ..text.options import Json, Run, Runs
from ..text.screen import answer, waiting
from .ending import INTERRUPTED, NOT_PROVEN, Interruption
from .run_choice import run_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from rich.console import Console

    from ...optimise.certificate.certificate import Certificate, Step
    from ...optimise.problem.problem import Problem

_SHOWN_NOTES = 8
_SIZES = tuple(f"{name}_mm" for name in DIMENSIONS)


def certify(
    run: Run,
    epsilon: Annotated[float, "Distance to be proven, as a share of each objective's range over the front."] = 0.01,
    seconds: Annotated[float, "Stop after so long with what is proven by then."] = 60.0,
    runs: Runs = None,
    json: Json = False,
) -> None:
    """Prove how far the front of a run can be from the true one.

    Searches the whole design box and adds designs where the front leaves gaps: no feasible design then beats all of
    them by more than epsilon. Keeps certificate.json, and the added designs as certificate.csv, in the run's folder.
    Exit code 4 if the budget does not suffice; Ctrl-C gives what is proven so far.
    """
    folder, result = run_of(run, runs)
    problem = problem_of(folder, result)
    if not result.designs:
        _nothing_feasible(result, problem, seconds, json=json)
    import numpy as np

    from ...optimise.certificate.certify import certify_designs

    sizes = np.array([[row[name] for name in _SIZES] for row in result.designs], dtype=np.float64) / 1e3
    with Interruption() as interruption, waiting("bounding the design box") as status:

        def tell(at: Step) -> None:
            proven = f"{100.0 * at.epsilon:.3g} % proven" if math.isfinite(at.epsilon) else "nothing proven yet"
            if status is not None:
                status.update(f"{proven}, {at.open:,} of {at.boxes:,} boxes open, {at.added:,} designs added")

        options = {"epsilon": epsilon, "seconds": seconds}
        found = certify_designs(problem, sizes, **options, progress=tell, cancelled=interruption.asked)
    rows = rows_of(found.table.to_dict("list")) if len(found.table) else []
    record = _record(found, problem, str(folder), rows)
    write_file(folder / "certificate.json", json_text(record))
    write_file(folder / "certificate.csv", csv_text(rows))
    answer(json, record, lambda screen: _show(screen, found, result, folder))
    if interruption.asked():
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if found.proven else NOT_PROVEN)


def _nothing_feasible(result: Result, problem: Problem, seconds: float, *, json: bool) -> None:
    from ...optimise.certificate.infeasible import prove_infeasible

    proven = prove_infeasible(problem, seconds=seconds)
    text = "no design of the ranges meets all requirements"
    message = f"proven: {text}" if proven else f"not proven that {text}; allow more time"
    record = {"run": result.run, "name": result.name, "infeasible": proven, "message": message}
    answer(json, record, lambda screen: screen.print(f"{result.name}: {message}", soft_wrap=True))
    raise typer.Exit(0 if proven else NOT_PROVEN)


def _record(found: Certificate, problem: Problem, run: str, rows: list[Row]) -> dict[str, Any]:
    wanted = [problem.quantity(objective.quantity) for objective in problem.objectives]
    return {
        "run": run,
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
        "added": rows,
    }


def _by_size(values: NDArray[np.float64] | None) -> dict[str, Any] | None:
    return None if values is None else dict(zip(_SIZES, (1e3 * values).tolist(), strict=True))


def _show(screen: Console, found: Certificate, result: Result, folder: Path) -> None:
    screen.print(f"{result.name}: {found.message}", style="bold", soft_wrap=True)
    lines = [f"Design box: {found.boxes:,} boxes in {found.seconds:.1f} s"]
    if found.open:
        lines[0] += f", {found.open:,} open ({100.0 * found.remaining:.3g} % of it)"
    if found.where is not None:
        lines.append(f"Farthest from proven: {_ranges(found.where)}")
    if found.hole is not None:
        sizes = (f"{name} {1e3 * size:.6g} mm" for name, size in zip(DIMENSIONS, found.hole, strict=True))
        lines.append(f"Largest gap of the delivered front: {', '.join(sizes)}")
    if math.isfinite(found.hypervolume_gap):
        lines.append(
            f"Hypervolume: {result.hypervolume:.6g}, the true front's exceeds it by at most {found.hypervolume_gap:.3g}"
        )
    lines += [f"Note: {note}" for note in found.notes[:_SHOWN_NOTES]]
    lines.append(f"Files: {folder / 'certificate.json'}")
    if len(found.added):
        lines.append(f"       {folder / 'certificate.csv'} ({len(found.added)} added designs)")
    for line in lines:
        screen.print(line, soft_wrap=True)


def _ranges(where: NDArray[np.float64]) -> str:
    return ", ".join(
        f"{name} {1e3 * low:.6g} to {1e3 * high:.6g} mm" for name, (low, high) in zip(DIMENSIONS, where, strict=True)
    )
