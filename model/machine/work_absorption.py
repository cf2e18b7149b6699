"""Work over a turn: whether a machine absorbs any, judged by its parts rather than by numbers that cancel.

At constant crank speed the kinetic energy repeats after a turn. So does the energy stored by gravity and by every load
whose force depends only on the slider position. The mean drive torque is then zero for every linkage.
"""

import math
from collections import defaultdict
from collections.abc import Hashable
from dataclasses import replace

from .links_and_joints import Bar, Link, RigidLink
from .loads.load import Load
from .mechanism import Mechanism
from .memoise import memoise_by_machine
from .varying_numbers import Varying

_ROUNDING = 1e-12
"""Fraction of the forces by which their sum may be off, because decimal numbers add inexactly."""


def may_do_work_over_a_turn(mechanism: Mechanism) -> bool:
    """Return whether the mean drive torque over a turn may be nonzero for some design.

    It is zero without all of these: friction in loaded joints, crank acceleration, loads that depend on speed or have
    their own formula, loads that differ between strokes, and loads over crank angle (`Load.turn_work_by_key`). For each
    variable two values are tried, neither of them special.
    """
    return any(
        machine.acceleration != 0.0 or _has_friction(machine) or _loads_do_net_work(machine)
        for machine in _machines_at_generic_values(mechanism)
    )


def loads_may_do_work_over_a_turn(mechanism: Mechanism) -> bool:
    """Return whether the loads may absorb or supply net work over a turn for some design.

    See `may_do_work_over_a_turn`.
    """
    return any(map(_loads_do_net_work, _machines_at_generic_values(mechanism)))


@memoise_by_machine
def without_masses_and_friction(mechanism: Mechanism) -> Mechanism:
    """Return the machine without masses and friction: all work from its drive goes into the loads."""
    nothing = RigidLink(mass=0.0)
    of_loads = {"loads", "speed", "speed_profile"}

    def load_numbers(item: Varying) -> Varying:
        sets = tuple(entry for entry in item.sets if entry[0].partition(".")[0] in of_loads)
        return replace(item, sets=sets, idle=not sets)

    return Mechanism(
        speed=mechanism.speed,
        crank=nothing,
        rod=nothing,
        loads=mechanism.loads,
        branch=mechanism.branch,
        arrangement=mechanism.arrangement,
        speed_profile=mechanism.speed_profile,
        varying=tuple(map(load_numbers, mechanism.varying)),
    )


def has_friction_under_load(mechanism: Mechanism) -> bool:
    """Return whether friction acts in a joint that carries a force, for some design."""
    return any(map(_has_friction, _machines_at_generic_values(mechanism)))


def carries_linkage_forces(machine: Mechanism) -> bool:
    """Return whether forces act on the rod or the slider: loads, or weight and inertia of moving parts."""
    driven = machine.speed != 0.0 or machine.acceleration != 0.0 or any(machine.gravity)
    return (has_rod_or_slider_mass(machine) and driven) or has_slider_loads(machine)


def has_slider_loads(machine: Mechanism) -> bool:
    """Return whether loads act on the slider: at rest only speed-independent loads, in motion any load."""
    return any(not load.on_crank for load in _acting_loads(machine))


def needs_drive_torque(machine: Mechanism) -> bool:
    """Return whether the drive needs a torque: for the linkage, for loads on the crank, or for the crank itself.

    At constant speed and without gravity, the crank and the counterweight load the pivot but need no torque.
    """
    turned = any(load.on_crank for load in _acting_loads(machine))
    lifted = crank_has_mass(machine) and (any(machine.gravity) or machine.acceleration != 0.0)
    return carries_linkage_forces(machine) or turned or lifted


def _acting_loads(machine: Mechanism) -> list[Load]:
    """Return the loads that are not zero throughout; if the crank is at rest, only speed-independent ones."""
    driven = machine.speed != 0.0 or machine.acceleration != 0.0
    return [
        load
        for load in machine.loads
        if load.acts and (driven if load.is_moving_mass else machine.speed != 0.0 or not load.speed_power)
    ]


def carries_pivot_force(machine: Mechanism) -> bool:
    """Return whether a force acts on the crank pivot: from the linkage, or from weight and inertia of the crank."""
    driven = machine.speed != 0.0 or machine.acceleration != 0.0 or any(machine.gravity)
    return carries_linkage_forces(machine) or (crank_has_mass(machine) and driven)


def has_rod_or_slider_mass(machine: Mechanism) -> bool:
    """Return whether the rod or the slider has a mass or an inertia."""
    return machine.slider_mass > 0.0 or _has_weight(machine.rod)


def crank_has_mass(machine: Mechanism) -> bool:
    """Return whether the crank, with its counterweight, has a mass or an inertia."""
    return _has_weight(machine.crank) or machine.counterweight.mass > 0.0 or machine.counterweight.inertia > 0.0


def _has_weight(link: Link) -> bool:
    return isinstance(link, Bar) or link.mass > 0.0 or bool(link.inertia)


def _has_friction(machine: Mechanism) -> bool:
    friction = machine.friction
    past_pivot = (
        friction.guide > 0.0
        or friction.crank_pin.friction_circle_radius > 0.0
        or friction.slider_pin.friction_circle_radius > 0.0
    )
    return (past_pivot and carries_linkage_forces(machine)) or (
        friction.crank_pivot.friction_circle_radius > 0.0 and carries_pivot_force(machine)
    )


def _machines_at_generic_values(mechanism: Mechanism) -> list[Mechanism]:
    """Return the machine or, if it has variables, two machines with values that are not special."""
    if not mechanism.varying:
        return [mechanism]
    inner = [item.lower + (0.618 * n % 1.0) * (item.upper - item.lower) for n, item in enumerate(mechanism.varying, 1)]
    return [mechanism.with_largest_variables, mechanism.with_values(inner)]


def _loads_do_net_work(machine: Mechanism) -> bool:
    sizes: defaultdict[Hashable, list[float]] = defaultdict(list)
    for load in _acting_loads(machine):
        for key, works in load.turn_work_by_key(moving=machine.speed != 0.0).items():
            sizes[key].extend(works)
    return any(abs(math.fsum(parts)) > _ROUNDING * math.fsum(map(abs, parts)) for parts in sizes.values())
