"""All data of a machine except its three dimensions: speed, masses, gravity, loads, tolerances."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

from ..checks import require_all_finite, require_field_types, require_numbers, store_as_tuples
from ..errors import InputError
from .arrangement import Arrangement
from .drive import Drive
from .lever import Lever, require_lever_alone
from .links_and_joints import Bar, Clearance, Counterweight, Friction, Link, RigidLink
from .loads.load import During, Load, require_word
from .loads.load_text import join_range_ends
from .speed_profile import Profile
from .varying_numbers import Varying, require_valid_variables, with_variable_values

Criterion = Literal["goodman", "soderberg"]


@dataclass(frozen=True, kw_only=True)
class Material:
    """Material of the crank and the rod, SI.

    endurance: fully reversed strength of the finished bar, with all corrections except stress concentration in the eyes
    (Shigley eq. 6-18). bearing_pressure: allowable pressure at the pins, on the projected area.
    """

    density: float
    elasticity: float
    yield_strength: float
    ultimate_strength: float
    endurance: float
    bearing_pressure: float

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            if not math.isfinite(value) or value <= 0.0:
                raise InputError(f"a material's {name.replace('_', ' ')} must be positive and finite; got {value:g}")
        if not self.endurance <= self.yield_strength <= self.ultimate_strength:
            raise InputError(
                "a material must have endurance strength <= yield strength <= ultimate strength; got "
                f"{1e-6 * self.endurance:g}, {1e-6 * self.yield_strength:g} and {1e-6 * self.ultimate_strength:g} "
                "MPa; swap them if they were interchanged, or use the lower value for both"
            )


@dataclass(frozen=True, kw_only=True)
class Strength:
    """Material of a machine's bars, and its pins.

    crank_pivot, crank_pin, slider_pin: diameters of the pins, m. eye_concentration: maximum stress divided by mean
    stress in the net section of an eye. criterion: fatigue criterion for mean stresses. wear_coefficient: worn volume
    divided by force and sliding distance, m^2/N (Archard); None if unknown.
    """

    material: Material
    crank_pivot: float
    crank_pin: float
    slider_pin: float
    eye_concentration: float = 1.0
    criterion: Criterion = "goodman"
    wear_coefficient: float | None = None

    def __post_init__(self) -> None:
        names = ("crank_pivot", "crank_pin", "slider_pin")
        require_numbers(self, *names, phrase="the diameter of the {}", above=0.0, unit="m")
        require_numbers(self, "eye_concentration", phrase="{}", least=1.0)
        require_numbers(self, "wear_coefficient", phrase="the {}", above=0.0, unit="m^2/N")
        require_word("criterion", self.criterion, Criterion)

    @property
    def mean_stress_reference_strength(self) -> float:
        """Reference strength for mean stresses: ultimate (Goodman) or yield (Soderberg), Pa."""
        return self.material.ultimate_strength if self.criterion == "goodman" else self.material.yield_strength


@dataclass(frozen=True, kw_only=True)
class Start:
    """Start of a swing: crank angle, rad, or slider position, m. None keeps the start stated for the swing itself."""

    angle: float | None = None
    place: float | None = None

    def __post_init__(self) -> None:
        require_numbers(self, "angle", "place", phrase="the {} at which a swing starts")


DeadCentre = Literal["outer", "inner"]


@dataclass(frozen=True, kw_only=True)
class SliderDistances:
    """Distances of the slider from a dead centre, m.

    touch: distance at which it meets the workpiece. dwell: distance within which it counts as at rest. guide: outward
    distance from the slider pin at its outer dead centre to the centre of the guide, which is fixed to the frame.
    """

    dead_centre: DeadCentre = "outer"
    touch: float | None = None
    dwell: float | None = None
    guide: float | None = None

    def __post_init__(self) -> None:
        require_word("dead_centre", self.dead_centre, DeadCentre)
        require_numbers(self, "touch", "dwell", phrase="the {} distance of the slider", above=0.0, unit="m")
        require_numbers(self, "guide", phrase="the {} distance of the slider")

    @property
    def text(self) -> str:
        """The stated distances, as text after the slider's mass; empty if there are none."""
        distances = {
            f"meets the workpiece {{}} before the {self.dead_centre} dead centre": self.touch,
            f"dwells within {{}} of the {self.dead_centre} dead centre": self.dwell,
            "guide centre {} outward from the outer dead centre": self.guide,
        }
        stated = ((words, distance) for words, distance in distances.items() if distance is not None)
        return "".join(f", {words.format(f'{1e3 * distance:.6g} mm')}" for words, distance in stated)


Branch = Literal["open", "crossed"]


@dataclass(frozen=True, kw_only=True)
class Tolerance:
    """Tolerance of a dimension: `absolute + fraction |dimension|`. absolute: m (rad for an angle)."""

    absolute: float = 0.0
    fraction: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "absolute", "fraction", phrase="the {} part of a tolerance", least=0.0)

    def deviation_limit(self, length: float) -> float:
        """Return the maximum deviation of a length, m, from its nominal value, m."""
        return self.absolute + self.fraction * abs(length)


@dataclass(frozen=True, kw_only=True)
class Window:
    """The part of the cycle over which the position error counts.

    during: stroke that counts. start, end: fractions of the stroke, outward from the inner dead centre, 0 to 1.
    """

    during: During = "cycle"
    start: float = 0.0
    end: float = 1.0

    def __post_init__(self) -> None:
        require_word("during", self.during, During)
        if not 0.0 <= self.start < self.end <= 1.0:
            raise InputError(
                "a part of the stroke must have 0 <= start < end <= 1, as fractions from the inner dead centre; "
                f"got start {self.start:g}, end {self.end:g}"
            )


@dataclass(frozen=True, kw_only=True)
class Clearances:
    """Radial clearances of the joints, m: half the difference between the diameters of bearing and pin.

    crank_pivot, crank_pin, slider_pin: clearances of the three pins. guide: play of the slider to either side of its
    line (its tilt within the guide is not considered). `position_error` describes their effect on the slider position.
    """

    crank_pivot: float = 0.0
    crank_pin: float = 0.0
    slider_pin: float = 0.0
    guide: float = 0.0

    def __post_init__(self) -> None:
        names = ("crank_pivot", "crank_pin", "slider_pin", "guide")
        require_numbers(self, *names, phrase="the {} clearance", least=0.0, unit="m")


@dataclass(frozen=True, kw_only=True)
class Tolerances:
    """Tolerances of dimensions and crank angle, clearances, and the range in which the position error counts."""

    crank: Tolerance = Tolerance()
    rod: Tolerance = Tolerance()
    offset: Tolerance = Tolerance()
    crank_angle: Tolerance = Tolerance()
    clearances: Clearances = Clearances()
    window: Window = Window()

    def __post_init__(self) -> None:
        if self.crank_angle.fraction:
            raise InputError("a tolerance of the crank angle must be an angle, not a fraction; give it in rad or deg")

    @property
    def are_stated(self) -> bool:
        """Whether there is any tolerance or clearance; otherwise a position error is undefined."""
        sizes = (self.crank, self.rod, self.offset, self.crank_angle)
        return any(size.absolute or size.fraction for size in sizes) or self.clearances != Clearances()


_TABLES = "the tables of a job state it: `problem({...}).mechanism`"
_KINDS = {
    **{"crank": Bar | RigidLink, "rod": Bar | RigidLink, "counterweight": Counterweight, "tolerances": Tolerances},
    **{"friction": Friction, "drive": Drive | None, "clearance": Clearance | None, "arrangement": Arrangement | None},
    **{"speed_profile": Profile | None, "strength": Strength | None, "start": Start},
    **{"slider": SliderDistances, "lever": Lever | None},
}


@dataclass(frozen=True, kw_only=True)
class Mechanism:
    """A slider-crank without its crank, rod and offset lengths.

    `problem({...}).mechanism` gives the mechanism for the tables of a job.

    speed: crank speed, rad/s, positive counter-clockwise. acceleration: crank acceleration, rad/s^2, the same at every
    crank angle. crank, rod: `Bar` or `RigidLink`. slider_mass: kg. gravity: components along x and y, m/s^2. drive:
    motor and flywheel, for analyses of a free motion; the speed then only gives the direction. speed_profile: speed
    over the crank angle; a motion under a motor has its own. arrangement: identical cylinders on one crankshaft;
    `signals.shaft_statistics` says which signals add up and which belong to one cylinder. clearance: a loose joint, for
    `clearance.run.simulate`; all other analyses treat every joint as ideal. strength: material and pins, used only to
    judge the strength of bars. start: start of a swing if designs choose it; used only for that. slider: distances from
    a dead centre, used only by slider quantities defined there. lever: frame and cylinder if the rod is fixed as the
    frame and a turning cylinder moves the crank; None for a slider-crank. varying: numbers that differ from design to
    design. Such a machine is evaluated for designs (n, 3 + k): crank, rod, offset and the value of each variable.
    Analyses of one machine use `at(values)` or `nominal`.
    """

    speed: float = 0.0
    acceleration: float = 0.0
    crank: Link = RigidLink(mass=0.0)
    rod: Link = RigidLink(mass=0.0)
    counterweight: Counterweight = Counterweight(mass=0.0, radius=0.0)
    slider_mass: float = 0.0
    gravity: tuple[float, float] = (0.0, 0.0)
    loads: tuple[Load, ...] = ()
    tolerances: Tolerances = field(default_factory=Tolerances)
    friction: Friction = Friction()
    branch: Branch = "open"
    drive: Drive | None = None
    clearance: Clearance | None = None
    arrangement: Arrangement | None = None
    speed_profile: Profile | None = None
    strength: Strength | None = None
    start: Start = Start()
    slider: SliderDistances = SliderDistances()
    lever: Lever | None = None
    varying: tuple[Varying, ...] = ()

    def __post_init__(self) -> None:
        store_as_tuples(self, "gravity", "loads", "varying")
        require_field_types(self, _KINDS, _TABLES)
        require_field_types(self, {"varying": Varying}, _TABLES, item_by_item=True)
        require_numbers(self, "speed", "acceleration", phrase="{}")
        require_numbers(self, "slider_mass", phrase="the slider mass", least=0.0, unit="kg")
        gravity: object = self.gravity
        if not isinstance(gravity, tuple) or len(gravity) != 2:
            raise InputError(
                f"gravity must have components along x and y, in m/s^2; got {gravity!r}; for example, write (0.0, "
                "-9.81)"
            )
        require_all_finite("gravity", gravity)
        require_word("branch", self.branch, Branch)
        loads: object = self.loads
        if not isinstance(loads, Sequence) or not all(isinstance(load, Load) for load in loads):
            raise InputError(f"loads must be a tuple of loads; got {loads!r}; in a job, write [[load]] tables")
        for name in ("speed", "acceleration", "slider_mass"):
            if getattr(self, name) is None:
                raise InputError(f"{name} must be a number in SI units; got None; leave it out for 0")
        if self.speed_profile is not None and self.acceleration:
            raise InputError(
                "a speed that repeats every turn must not have a constant acceleration too; got "
                f"{self.acceleration:g} rad/s^2 with a profile; leave out one of the two"
            )
        if self.lever is not None:
            require_lever_alone(self)
        if self.varying:
            require_valid_variables(self)

    @cached_property
    def nominal(self) -> Mechanism:
        """The machine as stated, with nothing varying."""
        return replace(self, varying=()) if self.varying else self

    @property
    def sign(self) -> float:
        """+1 on the open branch, -1 on the crossed one."""
        return 1.0 if self.branch == "open" else -1.0

    @property
    def direction(self) -> float:
        """Sense of rotation: +1 counter-clockwise, -1 clockwise; +1 at rest, as for loads that change with the stroke.

        A varying speed has one sign, which counts whatever the nominal speed is.
        """
        return -1.0 if self.with_largest_variables.speed < 0.0 else 1.0

    @cached_property
    def with_largest_variables(self) -> Mechanism:
        """The machine with each variable at its bound of larger magnitude: it has all features of any design."""
        return self.with_values([item.largest_magnitude_bound for item in self.varying]) if self.varying else self

    @cached_property
    def at_bounds_of_variables(self) -> tuple[Mechanism, Mechanism]:
        """The machines with all variables at their lower and at their upper bounds."""
        lower, upper = ([getattr(item, end) for item in self.varying] for end in ("lower", "upper"))
        return self.with_values(lower), self.with_values(upper)

    @property
    def load_texts(self) -> list[str]:
        """Each load in a sentence, with the ranges of its variables."""
        low, high = self.at_bounds_of_variables
        return [
            join_range_ends(at_low.text, at_high.text) for at_low, at_high in zip(low.loads, high.loads, strict=True)
        ]

    def with_values(self, values: Sequence[float]) -> Mechanism:
        """Return the machine with these values, SI, for its variables (k,)."""
        machine: Mechanism = with_variable_values(self.nominal, self.varying, values)
        return machine
