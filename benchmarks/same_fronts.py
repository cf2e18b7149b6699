"""Fronts of two checkouts compared bit for bit: `python -m benchmarks.same_fronts OTHER` in the project's folder.

Each checkout solves the shipped jobs and 50 random ones with the Python of its own `.venv`, on this machine. Compared
are dimensions, objectives, every number of the table of designs and the hypervolume, or the message of a refusal.
Columns that one checkout alone has are named and left out. A front that differs is no worse where none of its designs
is dominated by one of the other front by more than 1e-9 of that one's range, and its hypervolume in the box of both
together is lower by 1e-6 at most, once its own ends are those of the other front where they are better: as many designs
with better ends enclose less. Prints a line for each job that differs and a summary; ends with 1 where one differs,
and with `--no-worse` only where one is worse.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from slidercrank.optimise.front.hypervolume import hypervolume, ideal_and_range

Table = dict[str, Any]

COUNT = 50
DOMINATED, LOWER = 1e-9, 1e-6  # of a range; of the hypervolume
OBJECTIVES = {
    "peak_torque": "minimise",
    "transmission_angle": "maximise",
    "time_ratio": "maximise",
    "position_error": "minimise",
    "rms_torque": "minimise",
    "footprint": "minimise",
    "peak_power": "minimise",
    "peak_guide_force": "minimise",
    "peak_slider_acceleration": "minimise",
    "peak_shaking_force": "minimise",
    "stroke": "maximise",
}
SEVERAL = ("auto", "auto", "auto", "auto", "nsga2", "nsga3", "sobol", "chebyshev")
ONE = ("auto", "slsqp", "trust_constr", "minimax", "cmaes", "tpe", "differential_evolution")

_SOLVE = """
import json, sys
from slidercrank import solve
from slidercrank.optimise.job import parse_job

def bits(value):
    return float(value).hex() if isinstance(value, (int, float)) and not isinstance(value, bool) else str(value)

found = {}
with open(sys.argv[1], encoding="utf-8") as file:
    jobs = json.load(file)
for name, job in jobs.items():
    try:
        front = solve(parse_job(job))
    except Exception as error:
        found[name] = {"error": f"{type(error).__name__}: {error}"}
        continue
    found[name] = {
        "status": front.status,
        "hypervolume": bits(front.hypervolume),
        "dimensions": [[bits(x) for x in row] for row in front.dimensions.tolist()],
        "values": [[bits(x) for x in row] for row in front.values.tolist()],
        "table": {c: [bits(x) for x in front.designs[c].tolist()] for c in front.designs.columns},
    }
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump(found, file)
"""


def random_machine(random: np.random.Generator, *, slowest: float) -> Table:
    """Return the tables of a machine: mechanism, load and tolerances. slowest: least speed, rpm."""
    return {
        "mechanism": {
            "speed": f"{random.uniform(slowest, 400.0):.3f} rpm",
            "crank": {"width": "30 mm", "depth": "20 mm", "density": "7800 kg/m^3"},
            "rod": {"width": "25 mm", "depth": "15 mm", "density": "7800 kg/m^3"},
            "slider": {"mass": f"{random.uniform(0.5, 5.0):.3f} kg"},
        },
        "load": [{"force": "150 N", "opposes": str(random.choice(["motion", "outward stroke", "inward stroke"]))}],
        "tolerances": {"crank": "0.05 mm", "rod": "0.1 mm", "offset": "0.05 mm", "crank_angle": "0.1 deg"},
    }


def random_job(seed: int) -> Table:
    """Return a job around a random linkage: rules that it meets, one to four objectives, any of the methods."""
    random = np.random.default_rng([20_261_122, seed])
    crank, rod, offset = random.uniform(30.0, 80.0), random.uniform(160.0, 320.0), random.uniform(5.0, 60.0)
    spans = 1.0 + random.uniform(0.1, 0.8, 3)
    variables: Table = {
        name: [f"{size / span:.4g} mm", f"{size * span:.4g} mm"]
        for name, size, span in zip(("crank", "rod", "offset"), (crank, rod, offset), spans, strict=True)
    }
    stroke = np.sqrt((rod + crank) ** 2 - offset**2) - np.sqrt((rod - crank) ** 2 - offset**2)
    wanted = random.choice(list(OBJECTIVES), size=random.integers(1, 5), replace=False)
    method = str(random.choice(ONE if len(wanted) == 1 else SEVERAL))
    job: Table = {
        "name": f"random {seed}",
        **random_machine(random, slowest=60.0),
        "variables": variables,
        "constraints": {"transmission_angle": {"min": "25 deg"}},
        "objectives": {str(name): OBJECTIVES[str(name)] for name in wanted},
        "optimiser": {"designs": 20, "samples": 2048, "seed": seed, "method": method},
    }
    if method != "auto":
        job["optimiser"]["evaluations"] = 400
    if random.random() < 0.5 and "stroke" not in wanted:
        rule = random.choice(["equals", "min", "max"])
        job["constraints"]["stroke"] = {str(rule): f"{stroke:.4g} mm"}
    if random.random() < 0.3:
        job["load"].append({"viscous": f"{random.uniform(5.0, 60.0):.4g} N s/m"})
    if random.random() < 0.3:
        job["load"].append({"stiffness": f"{random.uniform(50.0, 500.0):.4g} N/m", "free_position": f"{rod:.4g} mm"})
    if random.random() < 0.3:
        job["friction"] = {"guide": 0.08}
    if random.random() < 0.3:
        variables["mechanism.slider.mass"] = ["0.5 kg", "5 kg"]
        job["mechanism"]["slider"]["mass"] = "1 kg"
    elif random.random() < 0.3:
        variables["rod"] = {"choices": [f"{rod * factor:.4g} mm" for factor in (0.9, 1.0, 1.15)]}
    if random.random() < 0.1 and method == "auto" and "position_error" not in wanted:
        job["robust"] = {"samples": 128, "share": 0.9}
    return job


def jobs(root: Path) -> dict[str, Table]:
    """Return the shipped jobs and the random ones by name."""
    shipped = {
        file.name: tomllib.loads(file.read_text(encoding="utf-8")) for file in sorted((root / "runs").glob("*.toml"))
    }
    return shipped | {f"random {seed}": random_job(seed) for seed in range(COUNT)}


def fronts(checkout: Path, asked: Mapping[str, Table]) -> dict[str, Table]:
    """Return the fronts that a checkout finds, numbers as hexadecimal text."""
    with tempfile.TemporaryDirectory() as folder:
        given, found = Path(folder) / "jobs.json", Path(folder) / "fronts.json"
        given.write_text(json.dumps(asked), encoding="utf-8")
        program = [str(checkout.absolute() / ".venv" / "bin" / "python"), "-c", _SOLVE, str(given), str(found)]
        subprocess.run(program, check=True, cwd=folder, env=dict(os.environ))
        read: dict[str, Table] = json.loads(found.read_text(encoding="utf-8"))
        return read


def worse(ours: Table, theirs: Table) -> str:
    """Return in which way our front is worse than the other one; empty where it is not."""
    for part in ("error", "status"):
        if ours.get(part) != theirs.get(part):
            return f"another {part}"
    fronts = [np.array([[*map(float.fromhex, row)] for row in front.get("values", ())]) for front in (ours, theirs)]
    if not all(map(len, fronts)):
        return "" if len(fronts[0]) == len(fronts[1]) else "no designs on one side"
    our, their = fronts
    apart = (our[:, None] - their) / ideal_and_range(their)[1]
    beaten = ((apart >= 0.0).all(axis=2) & (apart.max(axis=2) > DOMINATED)).any(axis=1)
    if beaten.any():
        return f"{beaten.sum()} of {len(our)} designs dominated"
    box = ideal_and_range(np.concatenate(fronts))
    ends = our[our.argmin(axis=0)]
    for column in np.flatnonzero(ends.min(axis=0) < their.min(axis=0)).tolist():
        their[their[:, column].argmin()] = ends[column]
    lost = hypervolume(their, *box) - hypervolume(our, *box)
    return f"hypervolume lower by {lost:.2g}" if lost > LOWER else ""


def main() -> int:
    """Compare and print; return 1 where a front differs."""
    parser = argparse.ArgumentParser(description="Fronts of two checkouts compared bit for bit.")
    parser.add_argument("other", type=Path, help="a checkout with an installed .venv; this one is the current folder")
    parser.add_argument("--no-worse", action="store_true", help="end with 1 only where a front of this one is worse")
    given = parser.parse_args()
    here, other = Path.cwd(), given.other.absolute()
    if not (other / ".venv/bin/python").exists():
        parser.error(f"a checkout to compare with must have an installed .venv; {other} has none; run make run in it")
    asked = jobs(here)
    ours, theirs = fronts(here, asked), fronts(other, asked)
    extra: set[str] = set()
    for name in asked:
        tables = [front[name]["table"] for front in (ours, theirs) if "table" in front[name]]
        alone = set.union(*map(set, tables)) - set.intersection(*map(set, tables)) if tables else set()
        extra |= alone
        for table, column in itertools.product(tables, alone):
            table.pop(column, None)
    if extra:
        print(f"not compared: {', '.join(sorted(extra))}")
    differing = [name for name in asked if ours[name] != theirs[name]]
    lost = {name: why for name in differing if (why := worse(ours[name], theirs[name]))}
    for name in differing:
        our, their = ours[name], theirs[name]
        parts = [part for part in sorted({*our, *their}) if our.get(part) != their.get(part)]
        print(f"{name}: {', '.join(parts)} differ; {lost.get(name, 'no worse')}")
        if "error" in ours[name] or "error" in theirs[name]:
            print(f"  {ours[name].get('error')}\n  {theirs[name].get('error')}")
    refused = sum("error" in front for front in ours.values())
    designs = sum(len(front.get("dimensions", ())) for front in ours.values())
    print(
        f"{len(asked)} jobs, {designs} designs, {refused} refused: {len(asked) - len(differing)} the same bit for bit, "
        f"{len(differing)} not, of these {len(lost)} worse"
    )
    return 1 if (lost if given.no_worse else differing) else 0


if __name__ == "__main__":
    sys.exit(main())
