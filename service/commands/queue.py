"""`slidercrank jobs`, `cancel`, `resume` and `delete`: the jobs of a store."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Annotated, get_args

import typer

from ...model.errors import InputError
from ...objectives.kinds import count_with_noun, name_unit_and_factor_of_key
from ...optimise.front.progress import stage_text
from ..jobs.stores import (
    Address,
    Name,
    existing_store,
    find_job,
    has_store,
    printable_store_address,
    warn_without_workers,
)
from ..render.terminal import empty_table
from ..runs.result import json_text
from ..text.options import Json
from ..text.screen import console, print_message, print_output

if TYPE_CHECKING:
    from rich.console import Console

    from ..store import Job


def jobs(
    state: Annotated[
        list[str] | None, "Only jobs that are queued, running, done, infeasible, cancelled or failed. May be repeated."
    ] = None,
    name: Annotated[str, "Only jobs whose name contains this text."] = "",
    limit: Annotated[int, typer.Option(min=1, max=10_000), "Number of jobs to list, newest first."] = 20,
    store: Address = None,
    json: Json = False,
) -> None:
    """List the jobs in a store, newest first, with their results."""
    from ..store import State

    states_known = get_args(State)
    for name_of_state in state or []:
        if name_of_state not in states_known:
            raise InputError(
                f"--state must be {', '.join(states_known[:-1])} or {states_known[-1]}; got {name_of_state[:80]!r}; "
                "choose one"
            )
    matching: list[Job] = []
    if has_store(store):
        with existing_store(store) as opened:
            states: list[State] = state or []  # type: ignore[assignment] # looked at above
            matching = opened.jobs(states=states, name=name, limit=limit)
            if any(job.state == "queued" for job in matching):
                warn_without_workers(opened)
    if json:
        print_output(json_text([job.record() for job in matching]))
    elif matching:
        _show_jobs(console(), matching)
    else:
        print_message(
            f"slidercrank: no matching job in {printable_store_address(store)}"
            if state or name
            else f"slidercrank: no job in {printable_store_address(store)} yet; add one with: slidercrank submit JOB"
        )


def cancel(job: Name, store: Address = None, json: Json = False) -> None:
    """Cancel a job.

    The designs found so far are kept, and `resume` continues the job. Its worker responds within 2 s.
    """
    with existing_store(store) as opened:
        after = opened.cancel(find_job(opened, job).id)
    _print_job(after, json, "asked to stop" if after.cancel_asked and after.state == "running" else "")


def resume(job: Name, store: Address = None, json: Json = False) -> None:
    """Queue a cancelled or failed job again; it continues after its last completed round."""
    with existing_store(store) as opened:
        _print_job(opened.resume(find_job(opened, job).id), json)


def delete(job: Name, store: Address = None, json: Json = False) -> None:
    """Permanently delete an ended job with all its data."""
    with existing_store(store) as opened:
        deleted = find_job(opened, job)
        opened.delete(deleted.id)
    print_output(json_text({"deleted": deleted.id}) if json else f"job {deleted.id}: {deleted.name}, deleted\n")


def _print_job(job: Job, json: bool, state_text: str = "") -> None:
    text = state_text or (f"{job.state}: {job.reason}" if job.reason else job.state)
    print_output(json_text(job.record()) if json else f"job {job.id}: {job.name}, {text}\n")


def _show_jobs(screen: Console, listed: list[Job]) -> None:
    rows = empty_table(">no.", "submitted", "job", "state", "progress or result", ruled=True, pad_edge=True)
    for column in rows.columns[:-1]:
        column.no_wrap = True
    for job in listed:
        submitted = time.strftime("%Y-%m-%d %H:%M", time.localtime(job.submitted))
        state = "stopping" if job.state == "running" and job.cancel_asked else job.state
        rows.add_row(str(job.id), submitted, _shorten(job.name, 32), state, _shorten(_progress_or_result(job), 120))
    screen.print(rows)


def _progress_or_result(job: Job) -> str:
    """Return the progress or the result of a job in words."""
    if job.state in ("done", "cancelled") and job.summary is not None and job.summary["designs"]:
        best = []
        for column, value in job.summary["best"].items():
            name, unit, _ = name_unit_and_factor_of_key(column)  # titles of quantities would require slow imports
            best.append(f"{name.replace('_', ' ')} {value:.4g} {unit}".rstrip())
        return f"{count_with_noun(job.summary['designs'], 'design')}; best {', '.join(best)}"
    if job.state == "running" and job.progress is not None:
        return f"{stage_text(job.progress)}, {job.progress['feasible']:,} feasible"
    if job.state == "running":
        return f"with {job.worker}"
    return job.reason


def _shorten(text: str, limit: int) -> str:
    text = " ".join(text.split())
    return text if len(text) <= limit else f"{text[: limit - 3]}..."
