"""What `analyse --show` can add about one design: each topic is a module of `analyses` and one of `figures`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism

TOPICS = {
    "static_forces": "forces of the loads alone, mechanical advantage",
    "friction": "efficiency, self-locking",
    "motor": "power, RMS torque, reflected inertia",
    "balance": "shaking force and moment",
    "tolerances": "position error: exact worst case, simulated machines, yield, what it comes from",
    "sensitivity": "change of every quantity with every dimension",
    "approximations": "how wrong lumped masses and series are",
    "polygons": "position, velocity and acceleration diagrams at --at",
    "start_up": "start from rest under [drive], steady running",
    "flywheel": "flywheel for a speed --fluctuation",
    "clearance": "impacts in the joint that [clearance] makes loose",
}
"""Names and what they show."""
TOLD_THERE = (
    "self_locking_margin_deg",
    "peak_power_W",
    "mean_power_W",
    "peak_reflected_inertia_kg_m2",
    "peak_shaking_force_N",
    "rms_shaking_force_N",
    "peak_shaking_moment_Nm",
    "rms_shaking_moment_Nm",
)
"""Quantities that friction, motor and balance show; the table of a design leaves them out."""
ALL = "all"
WITHOUT_JOB = ("polygons",)


def chosen_topics(names: Iterable[str], *, job: bool) -> tuple[str, ...]:
    """Return the topics that were asked for, each once. Raises `InputError` for unknown ones and those without job."""
    import difflib

    asked = [name.strip().replace("-", "_") for text in names for name in text.split(",")]
    for name in asked:
        if name not in TOPICS and name != ALL:
            near = difflib.get_close_matches(name, TOPICS, n=1)
            hint = f"did you mean {near[0]}?" if near else f"choose from {', '.join(TOPICS)}, {ALL}"
            raise InputError(f"--show must name a topic; got {name!r}; {hint}")
        if not job and name not in (*WITHOUT_JOB, ALL):
            raise InputError(
                f"--show {name} needs masses, loads or tolerances; got no job file; give one: analyse JOB --show {name}"
            )
    everything = tuple(TOPICS) if job else WITHOUT_JOB
    return everything if ALL in asked else tuple(dict.fromkeys(asked))


class Topic:
    """One topic of one design. options: of the topic's `numbers`; those of the figure are among them."""

    def __init__(self, name: str, mechanism: Mechanism, linkage: Linkage, options: dict[str, Any]) -> None:
        self.name = name
        self._design = (mechanism, linkage)
        self._options = options
        self._module = import_module(f"..analyses.{name}", __package__)

    def numbers(self, cancelled: Callable[[], bool]) -> dict[str, Any]:
        """Return the topic's numbers, ready for JSON. Raises `InputError` where the design has none."""
        if self.name == "clearance":  # one simulation for numbers and figure
            self._options["run"] = self._module.simulated(*self._design, cancelled=cancelled)
        elif self.name == "start_up":
            self._options["cancelled"] = cancelled
        found: dict[str, Any] = self._module.numbers(*self._design, **self._options)
        return found

    def show(self, screen: Console, numbers: dict[str, Any]) -> None:
        """Write the topic's numbers for people."""
        self._module.show(screen, numbers)

    def draw(self, folder: Path) -> Path:
        """Write the topic's figure into a folder; return the file."""
        module = import_module(f"..figures.{self.name}", __package__)
        options = {name: value for name, value in self._options.items() if name != "limit"}
        file: Path = getattr(module, f"draw_{self.name}")(*self._design, folder / f"{self.name}.png", **options)
        return file
