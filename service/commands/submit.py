"""`slidercrank submit` and `slidercrank watch`: a job for the workers, and its events until it ends."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import StoreError
from ...optimise.front.progress import Progress, stage_text
from ..jobs.stores import Address, Name, existing_store, find_job, open_store, warn_without_workers
from ..resources.memory import parse_size
from ..runs.result import json_text
from ..text.options import JobFile, Json
from ..text.screen import console, error_console, print_message, print_output, progress_bar
from ..text.standard_streams import has_reader_left
from .exit_and_interruption import EXIT_CODES

if TYPE_CHECKING:
    from ..store import Artefact, Event, Job, Store

_LOOK = 0.25  # s between two checks for new events
_AWAY = 1.0  # s between two attempts while the database is unreachable
_SELDOM = 5.0  # s between two lines of a long stage
_MEDIA = {".toml": "application/toml", ".json": "application/json"}


@dataclass(frozen=True)
class JobLimits:
    """Limits on the search of a job."""

    seconds: Annotated[float | None, "Time limit of its search, s; the designs found so far are kept."] = None
    evaluations: Annotated[
        int | None, "Maximum number of designs that its search evaluates; those found so far are kept."
    ] = None
    memory: Annotated[
        str | None,
        typer.Option(metavar="SIZE"),
        'Fail the job if its worker uses more memory than this, such as "2 GB".',
    ] = None


def submit(
    job: Annotated[JobFile, "Job file, .toml or .json."],
    store: Address = None,
    priority: Annotated[int, "-1000 to 1000; jobs with higher priority are solved first."] = 0,
    key: Annotated[str | None, "Key of this submission; repeating it with the same key returns the same job."] = None,
    attempts: Annotated[int, "Attempts without progress before the job fails."] = 3,
    *,
    job_limits: JobLimits,
    watch: Annotated[bool, "Show its events until it ends."] = False,
    json: Json = False,
) -> None:
    """Queue a job for the workers of a store; see `serve` and `worker`.

    The job is checked first. With --watch the exit code is that of the job, as for optimise; 2 if the job fails.
    """
    from ...optimise.job import load_job, read_job
    from ..jobs.submission import functions_of
    from ..jobs.submission import submit as put_in
    from ..store import Limits

    load_job(job)  # its messages contain the file name
    tables = read_job(job)
    functions = sorted(set(functions_of(tables).values()))
    memory = None if job_limits.memory is None else parse_size(job_limits.memory, "--memory")
    limits = Limits(seconds=job_limits.seconds, evaluations=job_limits.evaluations, memory=memory)
    with open_store(store) as opened:
        queued = put_in(
            opened,
            tables,
            priority=priority,
            key=key,
            most_attempts=attempts,
            limits=limits,
            source=_original_job_file(job),
            allowed_quantities=functions,
        )
        if not (watch and json):
            print_output(json_text(queued.record()) if json else f"job {queued.id}: {queued.name}, {queued.state}\n")
        if queued.state == "queued":
            _print_worker_requirements(functions, job)
            warn_without_workers(opened)
        if watch:
            raise typer.Exit(_write_events(opened, queued, json=json))


def watch(job: Name, store: Address = None, json: Json = False) -> None:
    """Show past and new events of a job until it ends; --json prints one event per line.

    The exit code is that of the job, as for optimise; 2 if the job failed. Ctrl-C stops watching; the job continues.
    """
    with existing_store(store) as opened:
        watched = find_job(opened, job)
        if watched.state == "queued":
            warn_without_workers(opened)
        raise typer.Exit(_write_events(opened, watched, json=json))


def _print_worker_requirements(functions: Sequence[str], job: Path) -> None:
    """Print the requirements on workers for a job with custom functions."""
    if functions:
        options = " ".join(f"--allow-quantity {function}" for function in functions)
        print_message(
            f"slidercrank: workers may call {', '.join(functions)} only if allowed, and import its module from the "
            f"folder where they were started: slidercrank serve {options}; or solve the job here: slidercrank "
            f"optimise {job}"
        )


def _original_job_file(job: Path) -> Artefact | None:
    """Return the original job file; None if it refers to other files, whose contents are in the job's tables."""
    from ...optimise.job import needed_files
    from ..store import Artefact

    suffix = job.suffix.lower()
    if needed_files(job):
        return None
    return Artefact(name=f"job{suffix}", media_type=_MEDIA[suffix], content=job.read_bytes())


def _write_events(store: Store, job: Job, *, json: bool) -> int:
    """Write the events of a job until it ends and return its exit code; 0 if the reader stops."""
    try:
        with _event_writer(json) as show:
            for event in events_until_end(store, job.id):
                show(event)
                if has_reader_left():
                    return EXIT_CODES["done"]
        ended = store.job(job.id)
        if not json:
            _print_front_of_job(store, ended)
    except KeyboardInterrupt:
        print_message(f"job {job.id} continues; stop it with: slidercrank cancel {job.id}")
        raise
    return EXIT_CODES[ended.state]


def events_until_end(store: Store, number: int) -> Iterator[Event]:
    """Yield past and future events of a job until it has ended; wait while the database is unreachable.

    Raises `NotFound` if the job is deleted in the meantime.
    """
    from ..store.database import Unavailable
    from ..store.records import ENDED

    last, away = 0, False
    while True:
        try:
            ended = store.job(number).state in ENDED  # checked first: an ended job already has all its events
            events = store.events(number, after=last)
        except Unavailable as error:
            if not away:
                print_message(f"slidercrank: {error}; trying again")
            away = True
            time.sleep(_AWAY)
            continue
        away = False
        for event in events:
            last = event.number
            yield event
        if ended and not events:
            return
        if not events:
            time.sleep(_LOOK)


@contextlib.contextmanager
def _event_writer(json: bool) -> Iterator[Callable[[Event], None]]:
    """Yield the event writer: JSON, or words with a progress bar on a terminal."""
    if json:
        from ..store.serialisation import compact_json

        yield lambda event: print_output(f"{compact_json(event.record())}\n")
        return

    live, last = error_console().is_terminal, 0.0
    with progress_bar() as bar:

        def show(event: Event) -> None:
            nonlocal last
            if live and event.kind == "progress":
                bar(Progress(**event.data))
            elif not event.data.get("steps") or event.at - last >= _SELDOM:
                last = event.at if event.data.get("steps") else 0.0
                print_output(f"{time.strftime('%H:%M:%S', time.localtime(event.at))}  {event_in_words(event)}\n")

        yield show


def event_in_words(event: Event) -> str:
    """Return an event in words, on one line."""
    data: dict[str, Any] = event.data
    if event.kind == "progress":
        return (
            f"{stage_text(data)}: {data['evaluations']:,} evaluated, "
            f"{data['feasible']:,} feasible, hypervolume {data['hypervolume'] or 0.0:.4f}"
        )
    text = data.get("text") or ": ".join(part for part in (data.get("state"), data.get("reason")) if part)
    return " ".join(str(text).split())


def _print_front_of_job(store: Store, job: Job) -> None:
    """Print the front of an ended job, if there is one."""
    from ..text.tables import show_front

    if job.summary is None or not job.summary["designs"]:
        return
    try:
        result = store.result(job.id)
    except StoreError:
        return
    screen = console()
    screen.print(f"\n{result.name}: {result.message}, in {result.seconds:.1f} s", style="bold", soft_wrap=True)
    show_front(screen, result, range(len(result.designs)))
