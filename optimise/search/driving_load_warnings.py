"""Warning about loads that drive a machine that is not an engine, because signs are easily reversed.

Over a cycle, the loads on slider and crank do the net work W = integral of F dx + M d theta on the machine. It is
negative if the machine is driven, and zero for springs, weights and tables over position. It is positive only for
engines. A job declares an engine by a load that `may_drive`, such as gas or a helping force, whose work does not count
here, or by requiring a delivered work of zero or more.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...model.arrays import Array
from ...model.machine.cylinders_and_turns import cycle_turns
from ...model.machine.loads.stroke_force import StrokeForce
from ...model.machine.mechanism import Mechanism
from ...model.machine.varying_numbers import Varying
from ...model.machine.work_absorption import loads_may_do_work_over_a_turn, without_masses_and_friction
from ...model.signals.averages import torque_averages
from ...model.swing.work import net_work_of_loads
from ...objectives.energy import DELIVERED_WORK
from ..problem.problem import Problem
from ..problem.question_registry import Change, Remark
from .stroke_warnings import sampled_designs

if TYPE_CHECKING:
    from ..front.front import ParetoFront

_ROUNDING = 1e-9
"""Relative to the RMS torque over a cycle: a smaller mean torque is rounding."""
_NAMED = 3
"""Maximum number of loads to name one by one."""


def driving_load_warnings(problem: Problem) -> list[str]:
    """Return the warning about loads that do positive net work on sampled designs of a problem, if any."""
    return (
        _load_warning(sampled_designs(problem), "sampled design") if any(map(_may_be_driven, problem.parts())) else []
    )


def front_driving_load_warnings(front: ParetoFront) -> list[str]:
    """Return the warning about loads that do positive net work on designs of a front, if any."""
    variants = front.variants or (0,) * len(front)
    rows = [
        [row for row, rows_of_variant in enumerate(variants) if rows_of_variant == variant]
        for variant in sorted({*variants})
    ]
    return _load_warning(
        ((front.part(rows_of_variant[0]), front.dimensions[rows_of_variant]) for rows_of_variant in rows), "design"
    )


def net_work(problem: Problem, designs: Array, loads: Collection[int] | None = None) -> Array:
    """Return the net work (n,), J per cycle, that loads do on designs (n, 3 + k).

    loads: indices of the loads that count; by default, all that are not declared to drive. NaN for a design that cannot
    make the required motion.
    """
    if loads is None:
        loads = [k for k, load in enumerate(problem.mechanism.loads) if not load.may_drive]
    machine = _with_counted_loads(problem.mechanism, loads)
    if problem.motion is not None:
        return net_work_of_loads(machine, problem.motion, designs)
    if not loads_may_do_work_over_a_turn(machine):
        return np.zeros(len(designs))
    torque = torque_averages(without_masses_and_friction(machine), designs)
    mean = np.where(np.abs(torque.mean) > _ROUNDING * torque.rms_over_angle, torque.mean, 0.0)
    return -2.0 * math.pi * cycle_turns(machine) * machine.direction * mean


def _with_counted_loads(mechanism: Mechanism, counted: Collection[int]) -> Mechanism:
    """Return the machine with empty loads in place of those that do not count."""
    ignored = set(range(len(mechanism.loads))).difference(counted)
    if not ignored:
        return mechanism

    def remove_ignored(item: Varying) -> Varying:
        sets = tuple(setting for setting in item.sets if not any(setting[0].startswith(f"loads.{k}.") for k in ignored))
        return replace(item, sets=sets, idle=not sets)

    nothing = StrokeForce(outward=0.0, inward=0.0)
    loads = tuple(nothing if k in ignored else load for k, load in enumerate(mechanism.loads))
    return replace(mechanism, loads=loads, varying=tuple(map(remove_ignored, mechanism.varying)))


def _may_be_driven(problem: Problem) -> bool:
    """Whether undeclared loads may drive the machine while no delivered work is required.

    This check saves most problems from compiling the torque kernels.
    """
    delivers = any(
        constraint.quantity == DELIVERED_WORK.name and constraint.lower is not None and constraint.lower >= 0.0
        for constraint in problem.constraints
    )
    return not delivers and any(
        not (load.may_drive or load.never_drives) for load in problem.mechanism.with_largest_variables.loads
    )


def _load_warning(parts: Iterable[tuple[Problem, Array]], design: str) -> list[str]:
    """Return the warning about designs, each with the problem for its choices. design: noun for one of them."""
    works: list[float] = []
    subject, named, count = "loads", "", 0
    for part, designs in parts:
        work = net_work(part, designs) if _may_be_driven(part) else np.zeros(len(designs))
        drives = work > 0.0
        count += int(np.isfinite(work).sum())
        works += work[drives].tolist()
        if not named and drives.any():
            named = _name_driving_loads(part, designs[drives][:1])
            subject += (
                " that are not declared as driving" if any(load.may_drive for load in part.mechanism.loads) else ""
            )
    if not works:
        return []
    extent = f"in every {design}" if len(works) == count else f"in some {design}s"
    ends = " to ".join(dict.fromkeys(f"{end:.4g}" for end in (min(works), max(works))))
    required = "" if part.motion is not None else f", or require a {DELIVERED_WORK.short} of at least 0 J"
    sentence = (
        f"{extent} {subject} do more work on the machine than they absorb, by {ends} J per cycle: {named}; if the load "
        "should resist, reverse its sign or define it as a force that opposes a stroke; if it should drive, define "
        f"it as one that helps a stroke{required}"
    )
    if not required:
        return [sentence]
    change = Change(f"constraints.{DELIVERED_WORK.name}", {"min": "0 J"}, f"Require a {DELIVERED_WORK.short} of 0 J")
    return [Remark(sentence, change)]


def _name_driving_loads(part: Problem, design: Array) -> str:
    """Return the loads that do positive net work on a design, numbered as in the job."""
    names = [
        f"load #{k + 1} ({text})"
        for k, (load, text) in enumerate(zip(part.mechanism.loads, part.mechanism.load_texts, strict=True))
        if not load.may_drive and net_work(part, design, [k])[0] > 0.0
    ]
    return " and ".join(names[:_NAMED])
