"""`slidercrank certify`: a proof of how far the front of a run can be from the true one."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.file_names import path_text
from ..designs.proof import certificate_record, infeasible_record, sentences_of, sizes_of
from ..designs.shown_units import record_in
from ..runs.result import Result, csv_text, json_text, rows_of
from ..runs.run_folder import write_file
from ..runs.stored_runs import problem_of
from ..text.options import Json, Run, Runs, Units
from ..text.screen import answer, waiting
from .ending import INTERRUPTED, NOT_PROVEN, Interruption
from .run_choice import run_of

if TYPE_CHECKING:
    from rich.console import Console

    from ...objectives.kinds import System
    from ...optimise.certificate.certificate import Certificate, Step
    from ...optimise.problem.problem import Problem


def certify(
    run: Run,
    epsilon: Annotated[float, "Distance to be proven, as a share of each objective's range over the front."] = 0.01,
    seconds: Annotated[float, "Stop after so long with what is proven by then."] = 60.0,
    runs: Runs = None,
    units: Units = "metric",
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
    from ...optimise.certificate.certify import certify_designs

    with Interruption() as interruption, waiting("bounding the design box") as status:

        def tell(at: Step) -> None:
            proven = f"{100.0 * at.epsilon:.3g} % proven" if math.isfinite(at.epsilon) else "nothing proven yet"
            if status is not None:
                status.update(f"{proven}, {at.open:,} of {at.boxes:,} boxes open, {at.added:,} designs added")

        options = {"epsilon": epsilon, "seconds": seconds}
        found = certify_designs(problem, sizes_of(result), **options, progress=tell, cancelled=interruption.asked)
    rows = rows_of(found.table.to_dict("list")) if len(found.table) else []
    record = certificate_record(found, problem, path_text(folder), rows)
    write_file(folder / "certificate.json", json_text(record))
    write_file(folder / "certificate.csv", csv_text(rows))
    answer(json, record_in(record, units), lambda screen: _show(screen, found, result, folder, units))
    if interruption.asked():
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if found.proven else NOT_PROVEN)


def _nothing_feasible(result: Result, problem: Problem, seconds: float, *, json: bool) -> None:
    from ...optimise.certificate.infeasible import prove_infeasible

    proven = prove_infeasible(problem, seconds=seconds)
    record = infeasible_record(result, proven=proven)
    answer(json, record, lambda screen: screen.print(f"{result.name}: {record['message']}", soft_wrap=True))
    raise typer.Exit(0 if proven else NOT_PROVEN)


def _show(screen: Console, found: Certificate, result: Result, folder: Path, units: System) -> None:
    first, *lines = sentences_of(found, result, units)
    screen.print(first, style="bold", soft_wrap=True)
    lines.append(f"Files: {folder / 'certificate.json'}")
    if len(found.added):
        lines.append(f"       {folder / 'certificate.csv'} ({len(found.added)} added designs)")
    for line in lines:
        screen.print(line, soft_wrap=True)
