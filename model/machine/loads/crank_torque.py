"""A torque on the crank besides the drive's: constant, opposing every motion, from a spring, or tabulated."""

import math
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar

from ...checks import require_numbers
from ...errors import InputError
from ..mechanism import Mechanism
from .angle_table import AngleTable
from .load import ANGLE_DATUM, CYCLE, Enters, Entry, Load, Passage, Table, increasing_points_entry, load_builder
from .load_text import TURNS, effect_by_direction, force_magnitude_text, spring_effect


def require_loads_repeating_each_turn(mechanism: Mechanism) -> None:
    """Raise an error for a load that does not repeat after one crank turn."""
    for load in mechanism.with_largest_variables.loads:
        if load.differs_after_a_turn:
            raise InputError(
                "a spring on the crank would wind up with every turn; got a crank that rotates fully with a "
                f'{load.magnitude_text}; let the crank swing, [motion] kind = "swing", or give its torque over the '
                "crank angle"
            )


def require_no_crank_load(mechanism: Mechanism, subject: str) -> None:
    """Raise an error for loads on the crank if an analysis supports only loads on the slider. subject: the analysis."""
    for load in mechanism.with_largest_variables.loads:
        if load.on_crank:
            raise InputError(
                f"{subject} accepts only loads on the slider; got {load.magnitude_text}; leave that load out"
            )


@dataclass(frozen=True, kw_only=True)
class CrankTorque(Load):
    """A torque on the crank, N m: torque - resistance sgn(w) - crank_stiffness (theta - free_angle).

    torque: positive counter-clockwise. resistance: torque against every motion (Coulomb, of known magnitude).
    crank_stiffness: stiffness of a spring between crank and frame, N m/rad. free_angle: rad; the angle continues beyond
    a turn, so only a swinging crank can have a spring.
    """

    torque: float = 0.0
    resistance: float = 0.0
    crank_stiffness: float = 0.0
    free_angle: float = 0.0

    enters: ClassVar = Enters.CRANK_TORQUE
    on_crank: ClassVar = True
    sizes: ClassVar = ("torque", "resistance", "crank_stiffness")
    slots: ClassVar = {
        "torque": (2, "N m"),
        "resistance": (3, "N m"),
        "crank_stiffness": (4, "N m/rad"),
        "free_angle": (5, "rad"),
    }

    def __post_init__(self) -> None:
        require_numbers(self, "torque", "free_angle")
        require_numbers(self, "resistance", phrase="the {} of the crank", least=0.0, unit="N m")
        require_numbers(self, "crank_stiffness", phrase="the stiffness of a spring on the crank", least=0.0)

    def numbers_for_kernel(self) -> tuple[float, ...]:
        """Return the numbers in `slots`, after unit factors."""
        return (1.0, 1.0, self.torque, self.resistance, self.crank_stiffness, self.free_angle)

    @property
    def differs_after_a_turn(self) -> bool:
        """Whether it has a spring."""
        return self.crank_stiffness != 0.0

    def turn_work_by_key(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return the constant torque and the torque against the motion."""
        return {(CrankTorque, "torque"): (self.torque,), (CrankTorque, "resistance"): (self.resistance,)}

    @property
    def never_drives(self) -> bool:
        """Whether there is no constant torque."""
        return not self.torque

    @property
    def magnitude_text(self) -> str:
        """The torques and the spring."""
        return "; ".join(size for size, _ in self._magnitudes_and_effects) or "no torque on the crank"

    @property
    def text(self) -> str:
        """Each torque and the spring, with its effect."""
        return "; ".join(f"{size}, {effect}" for size, effect in self._magnitudes_and_effects) or self.magnitude_text

    @property
    def _magnitudes_and_effects(self) -> list[tuple[str, str]]:
        """Magnitudes and effects of the torques and the spring."""
        parts = []
        if self.torque:
            size = f"{force_magnitude_text((self.torque,), 'N m', TURNS)} on the crank"
            parts.append((size, effect_by_direction((self.torque,), TURNS, "rotation")))
        if self.resistance:
            parts.append((f"{self.resistance:.6g} N m on the crank", "resists every motion"))
        if self.crank_stiffness:
            free = math.degrees(self.free_angle)
            size = f"spring on the crank {self.crank_stiffness:.6g} N m/rad, free at {free:.6g} deg"
            parts.append((size, spring_effect(self.crank_stiffness)))
        return parts


CrankTorque.tables = (
    Table(
        "crank_torque",
        "CrankTorqueLoad",
        "torque on the crank",
        "A constant torque on the crank, in addition to the drive torque.",
        (Entry("crank_torque", "Torque", "positive counter-clockwise", "-50 N m"),),
        {"crank_torque": "-50 N m"},
        load_builder(CrankTorque, crank_torque="torque"),
    ),
    Table(
        "crank_resistance",
        "CrankResistanceLoad",
        "torque on the crank against its motion",
        "A torque of constant size on the crank that opposes every motion, such as that of a brake or a seal.",
        (Entry("crank_resistance", "PositiveTorque", "its size", "5 N m"),),
        {"crank_resistance": "5 N m"},
        load_builder(CrankTorque, crank_resistance="resistance"),
    ),
    Table(
        "torque_per_angle",
        "CrankSpringLoad",
        "spring on a swinging crank",
        "A linear torsion spring between the frame and a crank that swings.",
        (
            Entry("torque_per_angle", "AngularStiffness", "torque per angle from the relaxed position", "40 N m/rad"),
            Entry("free_angle", "Angle", "crank angle at which the spring is relaxed", "45 deg"),
        ),
        {"torque_per_angle": "40 N m/rad", "free_angle": "0 deg"},
        load_builder(CrankTorque, torque_per_angle="crank_stiffness"),
        motion="swing",
    ),
)


@dataclass(frozen=True, kw_only=True)
class CrankTorqueTable(AngleTable):
    """A torque on the crank tabulated over the crank angle, interpolated linearly and periodically.

    forces: torques, N m, positive counter-clockwise. The other fields are those of `AngleTable`; it acts throughout the
    cycle.
    """

    on_crank: ClassVar = True
    tabulated: ClassVar = ("torques", "N m")

    def numbers_for_kernel(self) -> tuple[float, float, float, float]:
        """Return unit factors for both strokes."""
        return (1.0, 1.0, 0.0, 0.0)

    def turn_work_by_key(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return the work between knots, which cancels if the mean torque is zero."""
        angles, torques = self.knots()
        pairs = zip(pairwise(angles), pairwise(torques), strict=True)
        return {CrankTorqueTable: tuple(0.5 * (b - a) * (first + second) for (a, b), (first, second) in pairs)}

    def work_deciding_loaded_stroke(self, passage: Passage) -> Any:
        """Return zero, because it loads neither stroke."""
        return 0.0

    @property
    def magnitude_text(self) -> str:
        """The minimum and maximum torque."""
        return f"{force_magnitude_text(self.forces, 'N m', TURNS)} on the crank"

    @property
    def effect_text(self) -> str:
        """Effect on rotation in either direction."""
        return effect_by_direction(self.forces, TURNS, "rotation")


CrankTorqueTable.tables = (
    Table(
        "torque_angles",
        "CrankTorqueTableLoad",
        "table of torques on the crank over the crank angle",
        "A torque on the crank tabulated over the crank angle: linear between the points, periodic; two points at "
        "one angle form a step.",
        (
            increasing_points_entry(
                "torque_angles", "Angle", "increasing crank angles within one cycle", "0 deg", "90 deg"
            ),
            Entry(
                "torques",
                "Torque",
                "torque on the crank at each point, positive counter-clockwise",
                ["-20 N m", "0 N m"],
                several=True,
            ),
            ANGLE_DATUM,
            CYCLE,
        ),
        {"torque_angles": ["0 deg", "180 deg"], "torques": ["0 N m", "-20 N m"]},
        load_builder(CrankTorqueTable, torque_angles="angles", torques="forces", measured_from="datum"),
    ),
)
