"""Tools that create and read runs: search, front, and files of designs."""

from collections.abc import Sequence
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from ...model.errors import InfeasibleError, InputError
from ...model.file_name_encoding import path_text
from ...objectives.kinds import System
from ...optimise.problem.problem import Problem
from ..designs.design_selection_options import require_single_choice
from ..designs.display_units import convert_result
from ..designs.selection import no_match_message, numbered_rows, result_with_rows
from ..designs.stored_designs import front_of_result, stored_design
from ..jobs.submission import LONGEST_CALL, end_custom_processes_on_exit, job_json
from ..motion.design_file import ENDINGS, design_file
from ..questions.discovery import ALL
from ..runs.result import Result, csv_text, infeasible_result, json_text
from ..runs.run_folder import write_file
from ..store import Limits, Store
from ..text.options import Pick, Run, Selection, SettingOptions, Units
from ..text.tables import marked_and_evenly_spread_rows, show_design, show_front, show_result, usual_keys
from ..workers.direct_search import Opened, new_run, renewing_claim, resumed_run, save_result, with_settings
from ..workers.direct_search import search as front_of_run
from .call import Call, ToolResult, tables_with_files, text_printed_by
from .inputs import Files, FrontPart, Number, OptionalJob

Written = Literal["csv", "json", "figures", "report", "pdf", "dxf", "svg", "motion", "gif", "cycle"]
_OF_RUN = {"csv", "json", "figures"}
_NAMES = {
    "csv": "designs.csv",
    "json": "designs.json",
    "report": "design-{}-report.html",
    "pdf": "design-{}-report.pdf",
}
_NAMES |= {
    what: f"design-{{}}{ending}" if ending == f".{what}" else f"design-{{}}-{what}{ending}"
    for what, (ending, *_) in ENDINGS.items()
}
"""Names of the files to write, each with the design number."""


@dataclass(frozen=True)
class Search:
    """New search, or an interrupted one."""

    job: OptionalJob = None
    files: Files = field(default_factory=dict)
    resume: Annotated[
        str | None, Field(description="Instead of a job: a cancelled or interrupted run to continue.")
    ] = None
    seconds: Annotated[
        float | None, Field(description="Time limit in seconds; the designs found so far are returned.", gt=0.0)
    ] = None

    def open_new_or_resumed_run(
        self, call: Call, store: Store, settings: SettingOptions
    ) -> AbstractContextManager[Opened]:
        """Return the context of the run. Raises `InputError` unless exactly one of job and run is given."""
        if (self.job is None) == (self.resume is None):
            received = "both" if self.job else "neither"
            raise InputError(f"a search needs a job, or a run to continue; got {received}; give one of them")
        if self.resume is not None:
            if settings.stated_settings:
                raise InputError("a run must continue with its original number of designs and seed; leave them out")
            return resumed_run(store, call.runs, call.run_folder(self.resume).name, call.problem_to_resume)
        tables = tables_with_files(self.job or {}, self.files)
        problem, stated = with_settings(call.problem(tables, seconds=LONGEST_CALL), tables, settings.stated_settings)
        return new_run(store, call.runs, problem, stated, [job_json(stated)])


def optimise(call: Call, *, search: Search, settings: SettingOptions, part: FrontPart) -> ToolResult:
    """Search for the Pareto front of a job, and save it as a run.

    Takes a second to several minutes; reports progress. A cancelled search keeps its results; `resume` continues it and
    ends with the same front as an uninterrupted search. The answer contains some designs on the front; `front` selects
    others. numbers: their design numbers; knee and extremes: positions in the answer.
    """
    from ..workers.engines import EngineOptions, engine_of
    from ..workers.heartbeat import Budget

    with ExitStack() as entered:
        try:
            opened = entered.enter_context(
                search.open_new_or_resumed_run(call, entered.enter_context(call.store()), settings)
            )
        except InfeasibleError as error:
            return ToolResult(infeasible_result(error).record(), str(error), is_error=True)
        run, problem, claim = opened
        entered.enter_context(renewing_claim(claim, again=f"optimise with resume = {claim.job.run}"))
        budget = Budget(Limits(seconds=search.seconds), waited=lambda: claim.waited)
        engine = entered.enter_context(engine_of(EngineOptions()))
        entered.enter_context(end_custom_processes_on_exit(problem, engine))
        front = front_of_run(opened, engine, cancelled=lambda: call.cancelled() or budget.is_spent(), show=call.report)
        result = save_result(opened, front, budget)
    result_in_units = convert_result(result, part.units, problem)
    remedy = {"done": "", "infeasible": ""}.get(result.status, f"; continue it with optimise, resume = {run.path.name}")
    text = text_printed_by(lambda screen: show_result(screen, result_in_units))
    record = _record_of_rows(
        result_in_units,
        marked_and_evenly_spread_rows(result_in_units, range(len(result_in_units.designs)), part.rows),
        part,
    )
    return ToolResult(record, f"{text}\nRun: {run.path.name}{remedy}", is_error=result.status != "done")


def front(call: Call, *, run: Run, selection: Selection, pick: Pick, part: FrontPart) -> ToolResult:
    """Show the front of a run, part of it, or one selected design with all its quantities and trade-offs.

    numbers: design numbers; knee and extremes: positions in the answer.
    """
    folder, result = call.load_run_with_designs(run)
    chosen = selection.rows(result)
    picked = _selected_design_number(result, chosen, pick)
    if not chosen:
        raise InfeasibleError(no_match_message(result, selection.where or []))
    result_in_units = convert_result(
        result, part.units, None if part.units == "metric" else call.problem_of_run(folder, result)
    )
    if picked is None:
        rows = marked_and_evenly_spread_rows(result_in_units, chosen, part.rows)
        return ToolResult(
            _record_of_rows(result_in_units, rows, part),
            text_printed_by(lambda screen: show_front(screen, result_in_units, rows, limit=0)),
        )
    record = _record_of_rows(result_in_units, [picked], replace(part, columns=part.columns or [ALL]))
    record["trade_offs"] = record["trade_offs"] or _trade_off_sentences(call, folder, result, picked, part.units)
    text = text_printed_by(lambda screen: show_design(screen, result_in_units.designs[picked]))
    return ToolResult(record, "\n".join((f"design {picked + 1}", text, *record["trade_offs"])))


def files(
    call: Call,
    *,
    run: Run,
    write: Annotated[
        list[Written],
        Field(
            description="csv, json and figures cover the whole run; the other formats cover one design.", min_length=1
        ),
    ],
    design: Number = None,
    units: Units = "metric",
) -> ToolResult:
    """Write files of a run into its folder, and return their paths.

    For the run: its designs as CSV or JSON, and figures of its front. For one design (the knee by default): an HTML or
    PDF report, a true-scale DXF or SVG drawing, an HTML or GIF animation, its cycle as CSV.
    """
    if design is not None and _OF_RUN.issuperset(write):
        raise InputError(f"{', '.join(write)} cover all designs of a run; got design {design}; leave it out")
    folder, result = call.load_run_with_designs(run)
    picked = _selected_design_number(result, [], Pick(design=design))
    number = 1 + ((result.knee or 0) if picked is None else picked)
    problem = call.problem_of_run(folder, result)
    stored, result_in_units = stored_design(problem, result, number), convert_result(result, units, problem)
    named = {"name": result.name, "design": f"design {number}"}
    written: dict[str, list[str]] = {}
    for kind in dict.fromkeys(write):
        if call.cancelled():
            break
        if kind == "figures":
            written[kind] = _draw_figures(problem, result, folder, units)
            continue
        content: str | bytes
        if kind == "csv":
            content = csv_text(numbered_rows(result_in_units.designs))
        elif kind == "json":
            content = json_text(result_in_units.record())
        elif kind in ENDINGS:
            content = design_file(kind, stored, None, units, **named)
        else:
            from ..report.run_report import run_report

            content = run_report(folder, result, number, pdf=kind == "pdf", units=units)
        file = folder / _NAMES[kind].format(number)
        file = file if units == "metric" else file.with_stem(f"{file.stem}-{units}")
        write_file(file, content)
        written[kind] = [path_text(file)]
    record = {"run": path_text(folder), "number": number, "files": written}
    return ToolResult(record, "\n".join(f"{kind}: {', '.join(paths)}" for kind, paths in written.items()))


def _record_of_rows(result: Result, rows: Sequence[int], part: FrontPart) -> dict[str, Any]:
    """Return some designs of a result with their numbers, ready for JSON."""
    names = part.requested_keys(list(result.designs[0]), usual_keys(result)) if result.designs else None
    return result_with_rows(result, rows).record(names) | {"numbers": [row + 1 for row in rows]}


def _selected_design_number(result: Result, chosen: Sequence[int], pick: Pick) -> int | None:
    """Return the number of the design selected by name or by value, or None for neither."""
    if pick.design is None:
        return pick.row(result, chosen)
    require_single_choice(pick.design, result, has_other_choice=pick.chooses_by_value)
    return pick.design - 1


def _trade_off_sentences(call: Call, folder: Path, result: Result, row: int, units: System) -> list[str]:
    """Return the trade-off rates at a design as sentences; empty if it has none."""
    from ..designs.trade_offs import trade_offs_of

    try:
        problem = call.problem_of_run(folder, result)
        return trade_offs_of(front_of_result(problem, result), row, stored_design(problem, result, row + 1), units)
    except InputError:
        return []


def _draw_figures(problem: Problem, result: Result, folder: Path, units: System) -> list[str]:
    from ..figures.front_figures import write_front_figures

    return [
        path_text(file) for file in write_front_figures(front_of_result(problem, result), folder / "figures", units)
    ]
