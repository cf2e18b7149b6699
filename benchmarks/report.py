"""One measured figure, its limit, and the table of all."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from rich.console import Console
from rich.table import Table


@dataclass(frozen=True)
class Row:
    """A repeated measurement, and the limit that its median must keep; or its greatest figure, if `worst`."""

    what: str
    figures: list[float]
    at_least: float | None = None
    at_most: float | None = None
    worst: bool = False

    def kept(self) -> bool | None:
        """Whether the limit is met; None if there is none."""
        if self.at_least is not None:
            return median(self.figures) >= self.at_least
        if self.at_most is not None:
            return (max if self.worst else median)(self.figures) <= self.at_most
        return None

    def cells(self) -> tuple[str, str, str, str, str]:
        """Return name, median, range, limit and verdict."""
        limit = "" if self.at_least is None else f">= {self.at_least:g}"
        limit = limit if self.at_most is None else f"<= {self.at_most:g}"
        verdict = {None: "", True: "kept", False: "MISSED"}[self.kept()]
        spread = f"{min(self.figures):.3g} - {max(self.figures):.3g}" if len(self.figures) > 1 else ""
        return self.what, f"{median(self.figures):.4g}", spread, limit, verdict


def machine() -> str:
    """Return the processor's name and the number of cores."""
    cpu = Path("/proc/cpuinfo")
    lines = cpu.read_text().splitlines() if cpu.exists() else []
    name = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "unknown processor")
    return f"{os.cpu_count()} cores, {name}"


def peak_memory() -> float:
    """Return the peak memory of this process, MB; `ru_maxrss` would be its parent's where that is greater."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(float(line.split()[1]) for line in lines if line.startswith("VmHWM:")) / 1024.0


def show(title: str, rows: Iterable[Row], before: Mapping[str, float] | None = None) -> dict[str, float]:
    """Print a table of figures, each beside that of another version if there is one, and return the medians."""
    then = () if before is None else ("before",)
    table = Table("figure", *then, "median", "least - greatest", "limit", "", title=title, title_justify="left")
    medians = {}
    for row in rows:
        name, *cells = row.cells()
        medians[name] = median(row.figures)
        old = () if before is None else (f"{before[name]:.4g}" if name in before else "",)
        table.add_row(name, *old, *cells)
    Console(width=150).print(table)
    return medians
