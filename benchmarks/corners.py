"""Processor time of unusual jobs over that of the plain feeder job, each solved in this process once it is warm.

Each job is runs/feeder.toml with one change, or another machine. Processes that compute quantities of your own count.
What a front is worth is measured elsewhere: here a job is only to take no longer than others of its kind. `--profile
NAME` tells where.
"""

from __future__ import annotations

import argparse
import copy
import cProfile
import math
import pstats
import sys
import tempfile
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import psutil

import slidercrank as sc
from slidercrank.optimise.job import parse_job

from .report import Row, show

Job = dict[str, Any]

AT_MOST = 4.0
IN_PYTHON = 8.0
"""Limit of a quantity of your own that Python computes design by design; its calls alone take most of it."""
_POINTS = 200
_OWN = """
import math
import numpy as np

def in_numpy(designs):
    return np.sqrt(designs.crank**2 + designs.offset**2)[:, 0] + designs.rod[:, 0]

def in_python(designs):
    columns = (designs.crank[:, 0], designs.rod[:, 0], designs.offset[:, 0])
    return np.array([(crank * crank + offset * offset) ** 0.5 + rod for crank, rod, offset in zip(*columns)])

def of_motion(designs):
    return designs.peaks(lambda angle: designs.acceleration(angle) * designs.transmission_angle(angle))
"""


def jobs() -> dict[str, tuple[Job, float]]:
    """Return the jobs by name, each with its limit; the plain one comes first."""
    plain = tomllib.loads(Path("runs/feeder.toml").read_text(encoding="utf-8"))

    def job(change: Callable[[Job], object], limit: float = AT_MOST) -> tuple[Job, float]:
        made = copy.deepcopy(plain)
        change(made)
        return made, limit

    def table(angles: bool) -> Callable[[Job], object]:
        ends = 360.0 if angles else 90.0
        places = [f"{ends * point / _POINTS:.6g} {'deg' if angles else 'mm'}" for point in range(_POINTS)]
        forces = [f"{-1000.0 - 900.0 * math.sin(0.1 * point):.6g} N" for point in range(_POINTS)]
        load: Job = {"crank_angles" if angles else "positions": places, "forces": forces}
        if not angles:
            load["measured_from"] = "inner dead centre"
        return lambda made: made["load"].append(load)

    def own(function: str) -> Callable[[Job], object]:
        def change(made: Job) -> None:
            made["quantity"] = {"own": {"function": f"corner_quantities:{function}", "unit": "m"}}
            made["objectives"]["own"] = "minimise"

        return change

    def objective(name: str, sense: str = "minimise") -> Callable[[Job], object]:
        return lambda made: made["objectives"].update({name: sense})

    rubs = {
        "guide": 0.1,
        **{pin: {"radius": "8 mm", "coefficient": 0.08} for pin in ("crank_pivot", "crank_pin", "slider_pin")},
    }
    options = ("300 g", "500 g", "700 g")
    links = ("mechanism.crank.mass", "mechanism.rod.mass", "mechanism.slider.mass")
    return {
        "plain": job(lambda made: None),
        "RMS torque": job(objective("rms_torque")),
        "mean torque": job(objective("mean_torque")),
        "a least peak": job(objective("force_transmission", "maximise")),
        "friction in all joints": job(lambda made: made.update(friction=rubs)),
        f"load over {_POINTS} positions": job(table(angles=False)),
        f"load over {_POINTS} crank angles": job(table(angles=True)),
        "percentile": job(lambda made: made.update(robust={"kind": "percentile", "share": 0.99})),
        "worst case": job(lambda made: made.update(robust={"kind": "worst case"})),
        "six variables": job(lambda made: made["variables"].update({link: ["200 g", "1 kg"] for link in links})),
        "27 choices": job(lambda made: made["variables"].update({link: {"choices": [*options]} for link in links})),
        "nothing feasible": job(lambda made: made["constraints"].update(peak_torque={"max": "90 N m"})),
        "nothing feasible, RMS torque": job(lambda made: made["constraints"].update(rms_torque={"max": "30 N m"})),
        "nothing feasible, friction": job(
            lambda made: made.update(
                friction=rubs, constraints=made["constraints"] | {"peak_torque": {"max": "90 N m"}}
            )
        ),
        "lever moved by a cylinder": (tomllib.loads(Path("runs/tipper.toml").read_text(encoding="utf-8")), 3.0),
        "own quantity, NumPy": job(own("in_numpy")),
        "own quantity, Python": job(own("in_python"), IN_PYTHON),
        "own quantity, peaks": job(own("of_motion")),
    }


def corners(names: list[str] | None = None, repeats: int = 3) -> list[Row]:
    """Return the ratio of each job, or of those named."""
    with _own_quantities() as folder:
        asked = {name: given for name, given in jobs().items() if not names or name in names or name == "plain"}
        problems = {name: (parse_job(job, folder=folder), limit) for name, (job, limit) in asked.items()}
        times: dict[str, list[float]] = {name: [] for name in asked}
        for attempt in range(repeats + 1):
            for name, (problem, _) in problems.items():
                took = _seconds(problem)
                if attempt:  # the first compiles, imports, and starts processes
                    times[name].append(took)
    return [
        Row(
            f"{name}, over the plain job",
            [took / base for took, base in zip(times[name], times["plain"], strict=True)],
            at_most=limit,
        )
        for name, (_, limit) in problems.items()
        if name != "plain"
    ]


def profile(name: str) -> None:
    """Print the functions that take the most time of their own, and with what they call."""
    with _own_quantities() as folder:
        problem = parse_job(jobs()[name][0], folder=folder)
        sc.solve(problem)
        measured = cProfile.Profile()
        measured.runcall(sc.solve, problem)
        pstats.Stats(measured).sort_stats("tottime").print_stats(25).sort_stats("cumulative").print_stats(45)


@contextmanager
def _own_quantities() -> Iterator[Path]:
    """Give a folder with the module of own quantities."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "corner_quantities.py").write_text(_OWN, encoding="utf-8")
        yield Path(folder)


def _seconds(problem: sc.Problem) -> float:
    """Return the processor time of a solution, s; that of processes that live on counts."""
    before = _processor()
    sc.solve(problem)
    return _processor() - before


def _processor() -> float:
    own = psutil.Process()
    times = [own.cpu_times(), *(child.cpu_times() for child in own.children(recursive=True))]
    ended = times[0].children_user + times[0].children_system
    return ended + sum(each.user + each.system for each in times)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Unusual jobs over the plain one, in processor time.")
    parser.add_argument("names", nargs="*", help="of jobs; all by default")
    parser.add_argument("--profile", metavar="NAME", help="print where the time of one job goes")
    parser.add_argument("--repeats", type=int, default=3)
    given = parser.parse_args()
    if given.profile:
        profile(given.profile)
        sys.exit()
    show("Unusual jobs", corners(given.names, given.repeats))
