"""Inject faults and print what came of the jobs: `make faults`, or `python -m tests.faults` in the project's folder.

    python -m tests.faults kills --store sqlite --count 200 --seed 1

Exits with 1 if anything is not as it has to be.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from functools import partial
from typing import Annotated, Literal, Protocol

import typer

from .clocks import clocks
from .commits import commits
from .disk import disk
from .flood import flood
from .full_disk import fill_disk_at_random
from .full_store_disk import fill_store_disk
from .kills import kills
from .pauses import pauses
from .restarts import restarts
from .runaway import runaway
from .stalls import ATTACKS, Attack, stall
from .starts import starts
from .suspends import suspends
from .usage import Usage

app = typer.Typer(add_completion=False, help=__doc__)
Where = Annotated[Literal["sqlite", "postgresql"], typer.Option("--store", help="Kind of the store.")]
Count = Annotated[int, typer.Option(help="How many faults.")]
Seed = Annotated[int, typer.Option(help="Of everything random.")]


@app.callback(invoke_without_command=True)
def _all(context: typer.Context) -> None:
    """Without a command: all of them, on both databases."""
    if context.invoked_subcommand is not None:
        return
    everything: list[Callable[[], None]] = [
        lambda: _kills("sqlite"),
        lambda: _kills("postgresql"),
        lambda: _pauses("sqlite"),
        lambda: _pauses("postgresql"),
        lambda: _restarts(300.0),
        _full,
        lambda: _disk(5),
        lambda: _room(10),
        lambda: _clocks("sqlite"),
        lambda: _clocks("postgresql"),
        lambda: _runaway(1),
        lambda: _starts(24),
        lambda: _suspends(6),
        lambda: _commits("sqlite"),
        lambda: _commits("postgresql"),
        _dask,
        _flood,
        *(partial(_stall, attack) for attack in ATTACKS),
    ]
    failed = False
    for run in everything:
        try:
            run()
        except typer.Exit:
            failed = True
    raise typer.Exit(int(failed))


@app.command("kills")
def _kills(where: Where = "sqlite", count: Count = 200, seed: Seed = 1) -> None:
    """Kill workers by SIGKILL at random moments."""
    _report(f"{count} kills on {where}", lambda: kills(where, count, seed))


@app.command("pauses")
def _pauses(where: Where = "sqlite", count: Count = 50, seed: Seed = 1) -> None:
    """Pause workers for longer than their lease."""
    _report(f"{count} pauses on {where}", lambda: pauses(where, count, seed))


@app.command("restarts")
def _restarts(seconds: Annotated[float, typer.Option(help="For how long, s.")] = 300.0, seed: Seed = 1) -> None:
    """Crash and start PostgreSQL at random moments."""
    _report("{} crashes of PostgreSQL", lambda: restarts(seconds, seed))


@app.command("full")
def _full(count: Count = 50, seed: Seed = 1) -> None:
    """Let the disk be full at random moments (SQLite)."""
    _report(f"disk full {count} times on sqlite", lambda: fill_disk_at_random(count, seed))


@app.command("disk")
def _disk(count: Annotated[int, typer.Option(help="How often each disk is filled.")] = 5, seed: Seed = 1) -> None:
    """Let the disks of `optimise` and of `serve` be full: store, runs, figures, kernels, temporary files (as root)."""
    _report(f"each disk full {count} times", lambda: disk(count, seed))


@app.command("room")
def _room(count: Annotated[int, typer.Option(help="How often the disk is filled.")] = 10, seed: Seed = 1) -> None:
    """Leave a small disk room for leases but not for rounds, at random moments (SQLite, as root)."""
    _report(f"no room for a round {count} times on sqlite", lambda: fill_store_disk(count, seed))


@app.command("clocks")
def _clocks(where: Where = "sqlite", count: Count = 50, seed: Seed = 1) -> None:
    """Set the database's clock by an hour or a day while workers drain its queue."""
    _report(f"{count} steps of the clock on {where}", lambda: clocks(where, count, seed))


@app.command("runaway")
def _runaway(count: Annotated[int, typer.Option(help="Rounds of all kinds.")] = 1, seed: Seed = 1) -> None:
    """Let own functions loop: before and after records, cancelled, killed, ended."""
    _report(f"own functions that loop, {count} rounds", lambda: runaway(count, seed))


@app.command("starts")
def _starts(count: Annotated[int, typer.Option(help="How many services.")] = 24, seed: Seed = 1) -> None:
    """End services while they start, by SIGTERM and Ctrl-C."""
    _report(f"{count} services ended while they start", lambda: starts(count, seed))


@app.command("suspends")
def _suspends(count: Annotated[int, typer.Option(help="How many suspensions.")] = 6, seed: Seed = 1) -> None:
    """Suspend searches with an own function for longer than a call may take."""
    _report(f"{count} suspensions of searches with an own function", lambda: suspends(count, seed))


@app.command("commits")
def _commits(where: Where = "sqlite", every: Annotated[int, typer.Option(help="Each one of so many.")] = 1) -> None:
    """Let every commit of a job's life fail, each in three ways."""
    _report(f"{{}} failed commits on {where}", lambda: commits(where, every))


@app.command("dask")
def _dask(
    workers: Annotated[int, typer.Option(help="How many workers to kill.")] = 50,
    schedulers: Annotated[int, typer.Option(help="How many schedulers to kill.")] = 3,
    suspensions: Annotated[int, typer.Option(help="How often to suspend one of them.")] = 10,
    seed: Seed = 1,
) -> None:
    """Kill and suspend workers and schedulers of a Dask cluster under robust jobs."""
    from .dask_faults import strike

    _report("dask", lambda: strike(workers, schedulers, seed, suspensions=suspensions))


@app.command("flood")
def _flood(count: Annotated[int, typer.Option(help="How many of each kind.")] = 5, seed: Seed = 1) -> None:
    """Send an API endless bodies, addresses and headers, and hold half-open connections."""
    _report("flood", lambda: flood(count, seed))


@app.command("stall")
def _stall(
    attack: Annotated[Attack, typer.Argument(help="What is sent.")],
    seconds: Annotated[float, typer.Option(help="How long, s.")] = 30.0,
) -> None:
    """Send an API requests without the token and take no answers."""
    _report(f"stall, {attack}", lambda: stall(attack, seconds))


class Outcome(Protocol):
    """Outcome of a round. violations: everything that is not as it has to be, in words."""

    violations: list[str]

    def line(self) -> str:
        """Return the figures."""


def _report(title: str, inject: Callable[[], Outcome | tuple[int, Outcome]]) -> None:
    """Inject faults, and print their outcome and what they left. title: with a place for the count, if there is one."""
    begin = time.monotonic()
    with Usage() as usage:
        injected = inject()
    count, outcome = injected if isinstance(injected, tuple) else (0, injected)
    print(f"{title.format(count)}, {time.monotonic() - begin:.0f} s: {outcome.line()}\n  {usage.line()}", flush=True)
    violations = [*outcome.violations, *(f"left: {process}" for process in usage.left)]
    for violation in violations:
        print(f"  {violation}")
    if violations:
        raise typer.Exit(1)


if __name__ == "__main__":
    logging.disable()  # workers warn of what is done to them
    app()
