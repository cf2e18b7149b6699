"""`slidercrank optimise`: from a job file to a front on the screen and a run on the disk."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..model.errors import InputError
from .interruption import Interruption
from .result import Result, json_text, result_of
from .run_folder import RunFolder, disk, runs_place
from .screen import console, give, progress_bar, say, waiting
from .stored_generations import GenerationsFile, stopped_run
from .stored_runs import find_run
from .tables import show_design, show_front

if TYPE_CHECKING:
    from ..optimise.front import ParetoFront, Progress
    from ..optimise.ledger import Record
    from ..optimise.problem import Problem

NOTHING_FEASIBLE, INTERRUPTED = 3, 130
_NOTHING_GIVEN = "optimise needs a job file, or a run to go on with; got neither; name a job or use --resume RUN"
EXIT_CODES = {"done": 0, "infeasible": NOTHING_FEASIBLE, "cancelled": INTERRUPTED}

Runs = Annotated[
    Path | None,
    typer.Option(help="Where runs are kept.  [default: SLIDERCRANK_RUNS, else ./runs]"),
]
Json = Annotated[bool, typer.Option("--json", help="Print only JSON on standard output.")]


def optimise(
    job: Annotated[Path | None, typer.Argument(metavar="JOB", help="The job file, .toml or .json.")] = None,
    resume: Annotated[
        str | None, typer.Option(metavar="RUN", help="Instead of a job: go on with an interrupted or cancelled run.")
    ] = None,
    runs: Runs = None,
    designs: Annotated[int | None, typer.Option(min=1, max=10_000, help="Deliver at most so many designs.")] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Of everything random.")] = None,
    json: Json = False,
    figures: Annotated[bool, typer.Option(help="Draw the figures.")] = True,
) -> None:
    """Find the Pareto front of a job.

    Prints the front, and keeps job, designs, figures and log in a new folder. Ctrl-C stops within about a second and
    keeps what was found. The run can then go on with --resume, in its folder, and ends as if it had never stopped.
    """
    from ..optimise.job import files_beside

    if (job is None) == (resume is None):
        raise InputError("give either a job, or a run with --resume; got both" if job else _NOTHING_GIVEN)
    past: list[Record] = []
    if job is not None:
        problem = _problem(job, designs, seed)
        folder = RunFolder(runs_place(runs), problem.name)
    else:
        if designs is not None or seed is not None:
            raise InputError("a run goes on with the designs and the seed that it began with; leave them out")
        stopped = find_run(resume or "", runs_place(runs))
        problem, past = stopped_run(stopped)
        folder = RunFolder.again(stopped)
    with Interruption() as interruption, folder as run:
        run.log(f"command: {' '.join(sys.argv[1:])}")
        if job is not None:
            run.keep_job(job, files_beside(job))
        kept = GenerationsFile(run.path, problem.settings, past)
        try:
            front = _solve(problem, run, interruption, kept)
        finally:
            kept.write()
        result = result_of(front, str(run.path))
        run.keep_result(result, _versions(front))
        run.log(f"{result.status}: {result.message}")
        if result.status != "cancelled":
            kept.remove()
        if figures and result.status == "done":
            _draw(front, run, interruption)
    if json:
        give(json_text(result.record()))
        if result.status != "done":
            say(f"slidercrank: {result.message}")
    else:
        show_result(result)
    if result.status == "cancelled" and kept.generations:
        say(f"go on with: slidercrank optimise --resume {run.path.name}")
    raise typer.Exit(INTERRUPTED if interruption.asked() else EXIT_CODES[result.status])


def show_result(result: Result) -> None:
    """Write what a run found: the front as a table, what the knee costs, where the files are."""
    screen = console()
    screen.print(f"{result.name}: {result.message}, in {result.seconds:.1f} s", style="bold", soft_wrap=True)
    if len(result.designs) == 1:
        show_design(screen, result.designs[0])
    elif result.designs:
        show_front(screen, result, range(len(result.designs)))
    if result.trade_offs:
        screen.print("\nAt the knee:")
        for sentence in result.trade_offs:
            screen.print(f"  {sentence}", soft_wrap=True)
    screen.print(f"\nFiles: {result.run}", soft_wrap=True)
    listed = ", ".join(_contents(Path(result.run)))
    if listed:
        screen.print(f"  {listed}", soft_wrap=True)


def _contents(folder: Path) -> list[str]:
    names = [
        name
        for name in (
            "front.csv",
            "front.json",
            "certificate.csv",
            "certificate.json",
            "job.toml",
            "job.json",
            "log.txt",
        )
        if (folder / name).exists()
    ]
    pictures = len(list((folder / "figures").glob("*.png")))
    return [*names, f"figures/ ({pictures} pictures)"] if pictures else names


def _problem(job: Path, designs: int | None, seed: int | None) -> Problem:
    from ..optimise.job import load_job

    problem = load_job(job)
    settings = problem.settings
    return replace(
        problem,
        settings=replace(
            settings,
            designs=settings.designs if designs is None else designs,
            seed=settings.seed if seed is None else seed,
        ),
    )


def _solve(problem: Problem, run: RunFolder, interruption: Interruption, kept: GenerationsFile) -> ParetoFront:
    from ..optimise.solve import solve

    with progress_bar() as show:

        def tell(at: Progress) -> None:
            run.log(
                f"{at.stage} {at.round}/{at.rounds}: {at.evaluations} evaluated, {at.feasible} feasible, "
                f"hypervolume {at.hypervolume:.6g}, {at.seconds:.2f} s"
            )
            show(at)

        return solve(
            problem,
            progress=tell,
            cancelled=interruption.asked,
            resume=tuple(kept.generations),
            keep=kept.keep,
        )


def _draw(front: ParetoFront, run: RunFolder, interruption: Interruption) -> None:
    from .figures import draw_front

    with waiting("drawing the figures"), disk(run.figures):
        for file in draw_front(front, run.figures):
            run.log(f"figures/{file.name}")
            if interruption.asked():
                run.log("interrupted; the other figures are left out")
                return


def _versions(front: ParetoFront) -> dict[str, str]:
    from importlib.metadata import version

    return {**front.versions, "matplotlib": version("matplotlib")}
