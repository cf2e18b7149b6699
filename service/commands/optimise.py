"""`slidercrank optimise`: from a job file to a front on screen and a run on disk."""

from __future__ import annotations

import contextlib
import shlex
import sys
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError, OutputLost, StoreError
from ...model.file_name_encoding import path_text
from ...model.optional_packages import import_extra, is_installed
from ...objectives.kinds import System
from ..designs.display_units import convert_result
from ..jobs.stores import FILE, Address, open_store
from ..runs.result import json_text
from ..runs.run_folder import RunFolder, runs_folder, translate_disk_errors
from ..text.options import Json, Runs, SettingOptions, Units
from ..text.screen import console, print_message, print_output, progress_bar, show_activity
from ..text.tables import show_result
from ..workers.engines import EngineOptions, engine_of
from .exit_and_interruption import EXIT_CODES, INTERRUPTED, Interruption

if TYPE_CHECKING:
    from ...optimise.front.front import ParetoFront
    from ...optimise.problem.problem import Problem
    from ..store import Artefact, Store

_FILES = ("front.csv", "front.json", "certificate.csv", "certificate.json", "job.toml", "job.json", "log.txt")
SEARCH = "slidercrank.optimise slidercrank.model", ("slidercrank.optimise.job", "slidercrank.optimise.solve")
"""Packages with the kernels of a search, and modules that import these packages."""
_NOTHING_GIVEN = "optimise needs a job file, or a run to continue; got neither; name a job or use --resume RUN"


@dataclass(frozen=True)
class Places:
    """Locations of runs and jobs, as given."""

    runs: Runs = None
    store: Address = None

    def resume_command(self, run: str) -> str:
        """Return the command that resumes a run, with the given locations but without passwords."""
        from ..store.address import without_secrets

        options = ["--runs", str(self.runs)] if self.runs else []
        options += ["--store", without_secrets(self.store)] if self.store else []
        return shlex.join(["slidercrank", "optimise", "--resume", run, *options])


def optimise(
    job: Annotated[Path | None, typer.Argument(metavar="JOB"), "Job file, .toml or .json."] = None,
    resume: Annotated[
        str | None, typer.Option(metavar="RUN"), "Instead of a job: an interrupted or cancelled run to continue."
    ] = None,
    *,
    places: Places,
    settings: SettingOptions,
    engine: EngineOptions,
    units: Units = "metric",
    json: Json = False,
    figures: Annotated[
        bool | None,
        typer.Option("--figures/--no-figures"),
        'Draw figures. [default: yes if the extra "figures" is installed]',
    ] = None,
) -> None:
    """Find the Pareto front of a job.

    Prints the front, and saves job, designs, figures and log in a new folder. Ctrl-C stops within about a second and
    keeps the designs found so far. --resume continues in the folder of that run, with the same result as an
    uninterrupted search. The run is also in the store, where `jobs` and the service can see it.
    """
    from ...model.kernel.disk_cache import compile_ahead

    compile_ahead(*SEARCH)
    from ..store.address import without_secrets
    from ..workers.direct_search import new_run, renewing_claim, resumed_run, save_result, search

    if (job is None) == (resume is None):
        raise InputError(
            "give either a job, or a run with --resume; got both; leave one out" if job else _NOTHING_GIVEN
        )
    if resume is not None and settings.stated_settings:
        raise InputError("a run must continue with its original number of designs and seed; leave them out")
    if figures:
        import_extra("matplotlib", "figures need")
    options, place = engine.validated(), runs_folder(places.runs)
    with contextlib.ExitStack() as opened:
        listed = True
        if job is not None:
            problem, tables, files = _problem_with_settings(job, settings)
            jobs, listed = opened.enter_context(_store_or_temporary(places))
            begin = new_run(jobs, place, problem, tables, files)
        else:
            jobs = opened.enter_context(open_store(places.store, places.runs))
            begin = resumed_run(jobs, place, resume or "", _problem_to_resume)
        interruption = opened.enter_context(Interruption())
        run, problem, claim = opened_run = opened.enter_context(begin)
        again = places.resume_command(claim.job.run) if listed else ""
        opened.enter_context(renewing_claim(claim, again=again))
        run.log(f"command: {' '.join(map(without_secrets, sys.argv[1:]))}")
        run.log(f"job {claim.job.id} in store {jobs.name}" if listed else "in a temporary store")
        with progress_bar() as show:
            front = search(
                opened_run, opened.enter_context(engine_of(options)), cancelled=interruption.is_requested, show=show
            )
        with show_activity("writing the designs"):
            result = save_result(opened_run, front)
        drawn = figures is not False and result.status == "done" and is_installed("matplotlib")
        result_in_units, lost = convert_result(result, units, problem), None
        try:
            if json:
                print_output(json_text(result_in_units.record()))
            else:
                show_result(console(), result_in_units)
                sys.stdout.flush()
        except OutputLost as error:
            lost = error
        if drawn:  # while the user reads the front
            _draw_front_figures(front, run, interruption, units)
    if lost is not None:
        raise lost
    if not json:
        show_files(run.path)
    elif result.status != "done":
        print_message(f"slidercrank: {result.message}")
    if figures is None and result.status == "done" and not drawn:
        print_message('no figures drawn: they need the extra "figures": pip install "slidercrank[figures]"')
    if result.status == "cancelled" and again:
        print_message(f"continue with: {again}")
    raise typer.Exit(INTERRUPTED if interruption.is_requested() else EXIT_CODES[result.status])


@contextlib.contextmanager
def _store_or_temporary(places: Places) -> Iterator[tuple[Store, bool]]:
    """Yield the store, or a temporary one for this run if it is unusable, and whether it is temporary."""
    from ..store import Store

    with contextlib.ExitStack() as opened:
        try:
            store = opened.enter_context(open_store(places.store, places.runs))
            store.require_writable()
            listed = True
        except StoreError as error:
            print_message(
                f"slidercrank: {error}\nwithout a store, `jobs` does not list this run, and it cannot be continued "
                "once stopped"
            )
            folder = opened.enter_context(tempfile.TemporaryDirectory(prefix="slidercrank-"))
            store, listed = opened.enter_context(Store(Path(folder) / FILE)), False
        yield store, listed


def show_files(run: Path) -> None:
    """Print the locations of a run's files."""
    screen = console()
    screen.print(f"\nFiles: {path_text(run)}", soft_wrap=True)
    listed = [name for name in _FILES if (run / name).exists()]
    pictures = len(list((run / "figures").glob("*.png")))
    listed += [f"figures/ ({pictures} pictures)"] if pictures else []
    if listed:
        screen.print(f"  {', '.join(listed)}", soft_wrap=True)


def _problem_with_settings(job: Path, settings: SettingOptions) -> tuple[Problem, dict[str, Any], list[Artefact]]:
    """Return the problem of a job file and its tables, both with the given options applied, and its files."""
    from ...optimise.job import load_job, needed_files, read_job
    from ...optimise.job.job_notes import job_notes
    from ..workers.direct_search import job_and_attached_files, with_settings

    problem, tables = load_job(job), read_job(job)
    for note in job_notes(tables):
        print_message(f"note: {note}")
    with translate_disk_errors(job.parent):
        files = job_and_attached_files(job, needed_files(job))
    return *with_settings(problem, tables, settings.stated_settings), files


def _problem_to_resume(tables: Mapping[str, Any], folder: Path) -> Problem:
    from ...optimise.job import parse_job

    return parse_job(tables, folder=folder)


def _draw_front_figures(front: ParetoFront, run: RunFolder, interruption: Interruption, units: System) -> None:
    from ..figures.front_figures import write_front_figures

    with show_activity("drawing the figures"), translate_disk_errors(run.figures):
        for file in write_front_figures(front, run.figures, units):
            run.log(f"figures/{file.name}")
            if interruption.is_requested():
                run.log("interrupted; the remaining figures are not drawn")
                return
