"""Run all benchmarks and print their figures: `make benchmark`, or `python -m benchmarks` in the project's folder.

Beside them report those of commit b5d5c0c, before speed was worked on (2 cores, AMD EPYC, 2026-11-23), or of a version
of your own choice, measured with its own Python and these files:
    OTHER/.venv/bin/python -m benchmarks --save before.json; python -m benchmarks --before before.json
"""

from __future__ import annotations

import argparse
import json
import traceback
from collections.abc import Callable, Iterable
from pathlib import Path

from . import (
    corners,
    evaluation,
    many_designs,
    methods,
    page,
    page_design,
    peak_accuracy,
    search,
    service_rest,
    startup,
    wishes,
)
from .report import Row, machine, show

_ALL: dict[str, tuple[str, Callable[[], Iterable[Row]]]] = {
    "evaluation": ("Evaluation", lambda: [*evaluation.speed(), *evaluation.accuracy(), *evaluation.memory()]),
    "public": ("Evaluation by a problem", evaluation.public),
    "search": ("Search", lambda: [row for job in ("feeder", "sieve") for row in search.compare(f"runs/{job}.toml")]),
    "methods": ("Methods: hypervolume of the designs delivered over that of the default's", methods.compare),
    "wishes": ("Wishes on the fronts of the shipped jobs", wishes.wishes),
    "many": ("Many designs", many_designs.grows),
    "corners": ("Unusual jobs, each solved in a warm process", corners.corners),
    "commands": ("Commands", startup.commands),
    "service": ("A service at rest", service_rest.rest),
    "page": (f"The page with a front of {page.DESIGNS} designs", page.measure),
    "design": ("A design on the page", page_design.solved),
    "accuracy": ("Greatest relative error of peak torque, 1,000 random linkages", peak_accuracy.accuracy),
}

_BEFORE = Path(__file__).with_name("before.json")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="benchmarks", description="Measure and print.")
    parser.add_argument("parts", nargs="*", help=f"all by default: {', '.join(_ALL)}")
    parser.add_argument("--save", type=Path, help="a JSON file for the medians")
    parser.add_argument("--before", type=Path, default=_BEFORE, help="one that another version has saved")
    given = parser.parse_args()
    if unknown := set(given.parts) - set(_ALL):
        parser.error(f"no such part: {', '.join(sorted(unknown))}")
    before = json.loads(given.before.read_text())
    print(machine())
    medians: dict[str, float] = {}
    for title, rows in (_ALL[name] for name in given.parts or _ALL):
        try:
            medians |= show(title, rows(), before)
        except Exception:  # of a version that these files do not fit, what does fit is measured
            if not given.save:
                raise
            traceback.print_exc()
    if given.save:
        given.save.write_text(json.dumps(medians, indent=1))


main()
