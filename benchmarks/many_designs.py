"""Cost of many delivered designs: four objectives, three free dimensions, from a hundred to ten thousand."""

from __future__ import annotations

import math
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise
from time import perf_counter, process_time

from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.job import load_job
from slidercrank.optimise.solve import solve

from .report import Row, peak_memory

COUNTS = (100, 1_000, 10_000)


def grows() -> list[Row]:
    """Return times, their growth, the memory, and the longest time without a word, each count in a process."""
    seconds, memory, silence = zip(*(_measured(count) for count in COUNTS), strict=True)
    power = math.log(seconds[-1] / seconds[0]) / math.log(COUNTS[-1] / COUNTS[0])
    rows = [Row(f"{count:,} designs: processor time, s", [own]) for count, own in zip(COUNTS, seconds, strict=True)]
    return [
        *rows[:-1],
        replace(rows[-1], at_most=60.0),
        Row(f"power by which time grows from {COUNTS[0]} to {COUNTS[-1]:,}", [power], at_most=1.2),
        Row(f"{COUNTS[-1]:,} designs: peak memory, MB", [memory[-1]], at_most=500.0),
        Row("longest time without a word, s", list(silence), at_most=1.0, worst=True),
    ]


def _measured(count: int) -> tuple[float, float, float]:
    command = [sys.executable, "-c", f"from benchmarks.many_designs import deliver; deliver({count})"]
    finished = subprocess.run(command, check=True, capture_output=True, text=True)
    seconds, memory, silence = map(float, finished.stdout.split())
    return seconds, memory, silence


def deliver(count: int) -> None:
    """Solve the feeder without its rule; print processor time, s, peak memory, MB, and longest silence, s."""
    given = load_job("runs/feeder.toml")
    free = tuple(constraint for constraint in given.constraints if constraint.quantity != "rod_to_offset")
    problem = replace(given, constraints=free, settings=replace(given.settings, designs=count))
    solve(replace(problem, settings=replace(problem.settings, designs=10)))  # kernels are loaded
    told = [perf_counter()]

    def note(_: Progress) -> None:
        told.append(perf_counter())

    begin = process_time()
    found = solve(problem, progress=note, stages=note)
    seconds = process_time() - begin
    told.append(perf_counter())
    if len(found) != count:
        raise RuntimeError(f"{count} designs were asked for; got {len(found)}")
    longest = max(after - before for before, after in pairwise(told))
    print(seconds, peak_memory(), longest)
