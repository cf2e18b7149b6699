"""Simulation of a loose joint over several crank revolutions, and its statistics: numbers, text and figure."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from ....model.clearance.run import ClearanceProgress, ClearanceRun, Status, simulate
from ....model.clearance.statistics import clearance_statistics
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.links_and_joints import Joint, Law
from ....model.machine.mechanism import Mechanism
from ...render.blocks import Block, Table, Text, Unit, column, heading, note, sentence, value_from_record, words
from ..record_types import Keys, Note

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ....objectives.kinds import System

CYCLES, DISCARD = 12, 4

# Field of the summary, key without unit, unit in the key, factor from SI, title, and unit if the key has none.
ROWS = (
    ("peak_acceleration", "peak_acceleration", "_m_s2", 1.0, "peak slider acceleration", ""),
    ("acceleration_ratio", "peak_acceleration_ratio", "", 1.0, "  relative to ideal joints", ""),
    ("displacement_deviation",) * 2 + ("_percent", 100.0, "slider displacement error", "% of stroke"),
    ("velocity_deviation", "velocity_deviation", "_m_s", 1.0, "slider velocity error", ""),
    ("impacts", "impacts_per_turn", "", 1.0, "impacts per turn", ""),
    ("contact_share", "contact_share", "_percent", 100.0, "time in contact", "%"),
    ("peak_contact_force", "peak_contact_force", "_N", 1.0, "peak contact force", ""),
    ("penetration", "penetration", "_mm", 1e3, "maximum penetration", ""),
    ("input_work", "input_work", "_J", 1.0, "work of the drive per turn", ""),
    ("load_work", "load_work", "_J", 1.0, "work of the loads per turn", ""),
    ("dissipated", "dissipated", "_J", 1.0, "energy lost in the joint per turn", ""),
    ("stored", "stored", "_J", 1.0, "gain in stored energy per turn", ""),
)


_Counted = Annotated[float | None, Note("mean over the counted turns; null if there are none")]
_Uncertain = Annotated[
    float | None, Note("half the width of the 99 % confidence interval; null if fewer than two turns are counted")
]
Impacts = Annotated[
    dict[str, Any],
    Keys(
        "Impacts",
        "Statistics of a simulation of the loose joint over turns of the crank.",
        {
            "joint": Joint,
            "radial_clearance_mm": float,
            "law": Law,
            "restitution": float,
            "friction": float,
            "contact_stiffness_N_per_m_to_1_5": float,
            "status": Status,
            "turns": int,
            "turns_discarded": int,
            **{f"{key}{unit}": _Counted for _, key, unit, *_ in ROWS},
            **{f"{key}_uncertainty{unit}": _Uncertain for _, key, unit, *_ in ROWS},
            "fastest_impact_m_s": Annotated[float | None, Note("null if there is no impact")],
            "energy_residual_J": Annotated[
                float | None, Note("greatest error of the energy balance in a turn; null if no turns are counted")
            ],
        },
    ),
]


def run_simulation(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    cycles: int = CYCLES,
    discard: int = DISCARD,
    cancelled: Callable[[], bool] | None = None,
) -> ClearanceRun:
    """Return the simulation of the mechanism's loose joint; shows its progress on a terminal.

    Raises `InputError` if no joint is loose, and the errors of `model.clearance.run.simulate`.
    """
    if mechanism.clearance is None:
        raise InputError(
            "a simulation of joint clearance needs a joint with clearance; all joints of this job are ideal; for "
            "example, add to the job "
            '[clearance] with joint = "crank pin", radial_clearance = "0.2 mm" and journal_radius = "10 mm"'
        )
    with _turns_bar() as report:
        options: dict[str, Any] = {"cycles": cycles, "discard": discard, "progress": report, "cancelled": cancelled}
        return simulate(mechanism, linkage, mechanism.clearance, **options)


def compute_shared_options(
    mechanism: Mechanism, linkage: Linkage, cancelled: Callable[[], bool], **_: Any
) -> dict[str, Any]:
    """Return the simulation that numbers and figure share."""
    return {"run": run_simulation(mechanism, linkage, cancelled=cancelled)}


def numbers(mechanism: Mechanism, linkage: Linkage, *, run: ClearanceRun | None = None, **options: Any) -> Impacts:
    """Return the statistics of a simulation, ready for JSON: each with its uncertainty, None if undefined.

    run: finished simulation; by default `run_simulation` runs one with the options.
    """
    run = run or run_simulation(mechanism, linkage, **options)
    clearance = run.clearance
    summary = clearance_statistics(run) if run.cycles > run.discard else None
    record: dict[str, Any] = {
        "joint": clearance.joint,
        "radial_clearance_mm": 1e3 * clearance.radius,
        "law": clearance.law,
        "restitution": clearance.restitution,
        "friction": clearance.friction,
        "contact_stiffness_N_per_m_to_1_5": clearance.contact_stiffness,
        "status": run.status,
        "turns": 0 if summary is None else summary.turns,
        "turns_discarded": min(run.discard, run.cycles),
    }
    for field, key, unit, factor, _, _ in ROWS:
        estimate = None if summary is None else getattr(summary, field)
        certain = None if estimate is None else estimate.uncertainty
        record[f"{key}{unit}"] = None if estimate is None else factor * estimate.value
        record[f"{key}_uncertainty{unit}"] = None if certain is None else factor * certain
    record["fastest_impact_m_s"] = None if summary is None else summary.fastest_impact
    record["energy_residual_J"] = None if summary is None else summary.energy_residual
    return record


def blocks(numbers: dict[str, Any]) -> list[Block]:
    """Return the statistics in human-readable form."""
    head = heading(
        f"Radial clearance {{size}} at the {numbers['joint']} (contact law: {numbers['law']})",
        size=value_from_record(numbers, "radial_clearance_mm"),
    )
    if not numbers["turns"]:
        return [head, sentence("cancelled before a turn could be counted")]
    rows: list[tuple[Text, ...]] = []
    for _, key, unit, _, title, percent in ROWS:
        value = value_from_record(numbers, f"{key}{unit}", digits=4)
        certain = value_from_record(numbers, f"{key}_uncertainty{unit}", digits=2, bare=True)
        if value.number == 0.0 and not certain.number:
            continue
        spread = "" if certain.number is None else words("± {certain}", certain=certain)
        rows.append((title, value, spread, percent or Unit(value.kind)))
    cancelled = "; cancelled before the end" if numbers["status"] == "cancelled" else ""
    means = f"means over {numbers['turns']} turns, after {numbers['turns_discarded']} of running-in"
    return [
        head,
        Table((column(left=True), column(), column(left=True), column(left=True)), tuple(rows)),
        note(f"{means}, ± 99 % confidence{cancelled}"),
    ]


def figure(mechanism: Mechanism, linkage: Linkage, *, run: ClearanceRun | None = None) -> Callable[[System], Figure]:
    """Return the figure for the last revolution of a simulation.

    run: finished simulation; by default `run_simulation` runs one.
    """
    from .figure import clearance_figure

    return partial(clearance_figure, run or run_simulation(mechanism, linkage))


@contextlib.contextmanager
def _turns_bar() -> Iterator[Callable[[ClearanceProgress], None] | None]:
    """Show a progress bar on standard error if it is a terminal; yield the callback for each revolution.

    Only the main thread shows it: a service runs simulations for others.
    """
    if not sys.stderr.isatty() or threading.current_thread() is not threading.main_thread():
        yield None
        return
    from tqdm import tqdm

    with tqdm(desc="loose joint, turn 1", bar_format="{desc} {bar:24} {elapsed}", total=1, leave=False) as bar:

        def report(turn: ClearanceProgress) -> None:
            bar.total, bar.n = turn.cycles, turn.cycle
            bar.set_description_str(f"loose joint, turn {turn.cycle} of {turn.cycles}, {turn.impacts} impacts")

        yield report
