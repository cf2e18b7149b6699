"""Needs of quantities: the properties that a machine must have for a quantity to be defined or nonzero."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal

from ..model.cycle.gas_work import compressors, cylinder_loads
from ..model.machine.cylinders_and_turns import cylinder_count
from ..model.machine.links_and_joints import Bar
from ..model.machine.mechanism import Mechanism
from ..model.machine.work_absorption import (
    carries_linkage_forces,
    carries_pivot_force,
    crank_has_mass,
    has_friction_under_load,
    has_rod_or_slider_mass,
    loads_may_do_work_over_a_turn,
    may_do_work_over_a_turn,
    needs_drive_torque,
)
from ..model.signals.shaking_balance import has_rocking_couple, has_shaking_force

Consequence = Literal["undefined", "equal", "zero"]


@dataclass(frozen=True)
class Need:
    """A property that a quantity requires of a machine.

    is_met: whether a machine meets it; with variables, whether it may meet it. missing: rule, value and remedy;
    "{instead}" stands for alternative quantities. consequence: effect of an unmet need: the quantity is undefined,
    equals another one, or is zero for every design.
    """

    is_met: Callable[[Mechanism], bool]
    missing: str
    consequence: Consequence = "zero"

    @property
    def rule(self) -> str:
        """The rule alone, without value and remedy."""
        return self.missing.partition(";")[0]


def _has_friction(machine: Mechanism) -> bool:
    return machine.with_largest_variables.friction.acts


def _has_mass(machine: Mechanism) -> bool:
    lever = machine.lever
    return crank_has_mass(machine) or has_rod_or_slider_mass(machine) or (lever is not None and lever.has_masses)


_defining = partial(Need, consequence="undefined")
_MASSES = 'it needs masses; got none; for example, add [mechanism] slider = { mass = "0.8 kg" }'
_LOADS = (
    "it needs masses that move or have weight, or loads; got none, or only zeros; for example, add "
    '[mechanism] slider = { mass = "0.8 kg" } with a speed, or a [[load]]'
)
_SLIDER_LOADS = _LOADS.replace("or loads;", "or loads on the slider;") + " on the slider"
_SPEED = 'it needs a crank speed; got none; for example, add [mechanism] speed = "300 rpm"'

TOLERANCES = _defining(
    lambda machine: machine.with_largest_variables.tolerances.are_stated,
    'a position error needs tolerances; got none; for example, add [tolerances] crank = "0.05 mm"',
)
FRICTION = Need(
    _has_friction,
    "a self-locking margin needs friction; got none; for example, add [friction] guide = 0.1, or use {instead}",
    consequence="equal",
)
SPEED = _defining(lambda machine: machine.with_largest_variables.speed != 0.0, _SPEED)
REPEATS = _defining(
    lambda machine: machine.with_largest_variables.acceleration == 0.0,
    "a stroke time needs a speed that repeats every turn; got a crank acceleration; leave it out, or use time_ratio",
)
MOTION = _defining(
    lambda machine: machine.with_largest_variables.speed != 0.0 or machine.with_largest_variables.acceleration != 0.0,
    _SPEED,
)
"""A crank that turns or is about to turn."""
MASSES = Need(lambda machine: _has_mass(machine.with_largest_variables), _MASSES)
SWINGING_MASSES = Need(
    lambda machine: (
        has_rod_or_slider_mass(machine.with_largest_variables) or machine.with_largest_variables.acceleration != 0.0
    ),
    _MASSES,
)
"""Masses whose angular momentum changes; at constant speed, the crank exerts only a shaking force through its pivot."""
DRIVEN = Need(lambda machine: needs_drive_torque(machine.with_largest_variables), _LOADS)
LOADED = Need(lambda machine: carries_linkage_forces(machine.with_largest_variables), _SLIDER_LOADS)
"""Masses or loads beyond the crank."""
PIVOT_LOADED = Need(lambda machine: carries_pivot_force(machine.with_largest_variables), _SLIDER_LOADS)
WORK = Need(
    may_do_work_over_a_turn,
    "it needs work over a turn, which is zero here for all dimensions; got no friction in joints that carry a "
    "force, no load that always resists (viscous, drag) and none that differs between the strokes; use {instead}, "
    "or add the load that the machine works against",
)
LOAD_WORK = _defining(
    loads_may_do_work_over_a_turn,
    "an efficiency needs a load that absorbs or supplies net work over a cycle; got none; "
    'for example, add [[load]] force = "200 N", opposes = "motion"',
)
_RUBS = "got none; for example, add [friction] guide = 0.1"
_UNLOADED = (
    "got no inertia force or weight of rod or slider, nor a load on the slider; for example, add "
    '[mechanism] slider = { mass = "0.8 kg" } with a speed, or a [[load]] on the slider'
)
_HEAT = "it needs friction in loaded joints"
HEAT = (_defining(_has_friction, f"{_HEAT}; {_RUBS}"), _defining(has_friction_under_load, f"{_HEAT}; {_UNLOADED}"))
"""Friction, and joints that carry a force."""
LOSSES = (
    Need(
        _has_friction,
        f"without friction nothing is lost, and the efficiency of every design is 1; {_RUBS}",
        consequence="equal",
    ),
    Need(
        has_friction_under_load,
        f"friction in unloaded joints dissipates nothing, so the efficiency of every design is 1; {_UNLOADED}",
        consequence="equal",
    ),
)
"""Friction, and joints that carry a force; otherwise the efficiency is 1."""
CYLINDER = _defining(
    lambda machine: bool(cylinder_loads(machine)),
    "it needs a cylinder; got none; for example, add "
    '[[load]] bore = "70 mm", suction = "1 bar", discharge = "8 bar", clearance = 0.05',
)
COMPRESSOR = _defining(
    lambda machine: bool(compressors(machine)),
    "it needs a compressor or pump; got none; for example, add "
    '[[load]] bore = "70 mm", suction = "1 bar", discharge = "8 bar", clearance = 0.05',
)


def _rotates_unevenly(mechanism: Mechanism) -> bool:
    """Return whether the speed of flywheel or rotor varies within the cycle."""
    machine = mechanism.with_largest_variables
    turns = machine.drive is not None and machine.drive.inertia > 0.0
    return turns and (machine.speed_profile is not None or machine.acceleration != 0.0)


def need_of_motor_limit(key: str, example: str) -> Need:
    """Return the need for a limit on the motor. key: key in [drive]. example: its value as in a job."""
    return _defining(
        lambda machine: machine.drive is not None and getattr(machine.drive, key) is not None,
        f'it needs the {key.replace("_", " ")} of the motor; got none; for example, add [drive] {key} = "{example}"',
    )


DRIVE_TRAIN = _defining(
    lambda machine: machine.drive is not None,
    "it needs [drive]; got none; for example, add [drive] gear_ratio = 5",
)
MOTOR_LOADED = Need(
    lambda machine: needs_drive_torque(machine.with_largest_variables) or _rotates_unevenly(machine), _LOADS
)
"""Loads on the motor: anything that requires drive torque, or the inertia of a flywheel or a rotor."""
ROTOR = _defining(
    lambda machine: machine.drive is not None and machine.drive.motor_inertia > 0.0,
    'an inertia ratio needs the inertia of the rotor; got none; for example, add [drive] motor_inertia = "5 kg cm^2"',
)
SHAKES = Need(
    has_shaking_force,
    "the shaking forces of these cylinders cancel for every design; got cranks and banks that oppose each other in "
    "pairs; use peak_rocking_couple, or leave it out",
)
"""Cylinders whose shaking forces do not cancel."""
COUPLES = _defining(
    has_rocking_couple,
    "a rocking couple needs cylinders at different places along the shaft whose forces do not cancel; got no "
    'places, or all forces at one place; for example, add [mechanism] cylinders = { phases = ["0 deg", "180 deg"], '
    'places = ["-50 mm", "50 mm"] }',
)
ONE_CYLINDER = _defining(
    lambda machine: cylinder_count(machine) == 1,
    "it needs a single cylinder, because a stroke belongs to one cylinder; got several on one crankshaft, whose "
    "torques add up; "
    "use {instead}",
)
ONE_TIMING = _defining(
    lambda machine: machine.speed_profile is None or cylinder_count(machine) == 1,
    "with a speed profile it needs a single cylinder, because each has its own stroke times; got several cylinders "
    "on one "
    "crankshaft; use crank_angle_ratio, which is the same for all, or the least value over the cylinders: "
    "outward_to_inward_time_ratio or inward_to_outward_time_ratio",
)
EVEN_SPEED = _defining(
    lambda machine: machine.speed_profile is None,
    "it is only defined at constant speed; got a speed profile; leave the profile out",
)
STRENGTH = _defining(
    lambda machine: machine.strength is not None,
    "it needs a material and pins; got none; for example, add [sections] with pins and [sections.material], as in "
    "docs/sizing.md",
)
WEARS = _defining(
    lambda machine: machine.strength is not None and machine.strength.wear_coefficient is not None,
    "it needs pins and a wear coefficient; got none; for example, add "
    '[sections] wear_coefficient = "1e-9 mm^2/N", with pins and [sections.material] as in docs/sizing.md',
)
_BAR = '{}; got none; for example, add [mechanism] {} = { width = "30 mm", depth = "20 mm", density = "7850 kg/m^3" }'
ROD_BAR = _defining(
    lambda machine: isinstance(machine.rod, Bar),
    _BAR.replace("{}", "it needs a rod given by its section", 1).replace("{}", "rod", 1),
)
CRANK_BAR = _defining(
    lambda machine: isinstance(machine.crank, Bar),
    _BAR.replace("{}", "it needs a crank given by its section", 1).replace("{}", "crank", 1),
)
A_BAR = _defining(
    lambda machine: isinstance(machine.rod, Bar) or isinstance(machine.crank, Bar),
    _BAR.replace("{}", "it needs links given by their sections", 1).replace("{}", "rod", 1),
)


def _need_of_mass(part: str) -> Need:
    def weighs(machine: Mechanism) -> bool:
        link = getattr(machine.with_largest_variables, part)
        return isinstance(link, Bar) or link.mass > 0.0

    return Need(
        weighs,
        f'it needs the mass of the {part}; got none; for example, add [mechanism] {part} = {{ mass = "0.5 kg" }}',
    )


CRANK_MASS, ROD_MASS = _need_of_mass("crank"), _need_of_mass("rod")
