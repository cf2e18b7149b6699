"""Tables of a job file for sizing: [sections] with material, pins, safety factors, [costs] of tolerances, [robust]."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from ...model.errors import InputError, JobError
from ...model.machine.mechanism import Criterion, Material, Strength
from ...model.tolerance.error_distributions import Shape
from ...objectives import kinds
from ...objectives.force_transmission import TRANSMISSION_ANGLE
from ...objectives.kinds import PRESSURE
from ...objectives.robust.quantity import SAMPLES, Case
from ...objectives.robust.worst_points import toleranced_columns
from ...objectives.torque_and_power import PEAK_TORQUE
from ..problem.problem import Problem
from ..problem.robust_problem import Robust, robust_problem
from ..problem.tolerance_costs import Cost, Costs, SectionLimits
from .value_types import (
    AngleTolerance,
    Built,
    Checked,
    Density,
    Fraction,
    Limited,
    Part,
    Physical,
    PhysicalWithin,
    PositiveLength,
    PositiveRange,
    PositiveRatio,
    Radius,
    WearCoefficient,
    optional_entry,
    required_entry,
)

EXAMPLE = {
    "material": {
        "density": "7850 kg/m^3",
        "elasticity": "207 GPa",
        "yield_strength": "350 MPa",
        "ultimate_strength": "520 MPa",
        "endurance": "150 MPa",
        "bearing_pressure": "20 MPa",
    },
    "pins": dict.fromkeys(("crank_pivot", "crank_pin", "slider_pin"), "15 mm"),
}
"""Minimum content of the table. The pins are half as wide as their bars, which are 30 mm wide in the other examples."""


_OF_STRENGTH = ("criterion", "eye_concentration", "wear_coefficient")


_Raised = Annotated[
    PositiveRatio, Limited("at least 1, the mean stress", "a pin in an eye has about 2.5 to 4", least=1.0)
]
_Safety = Annotated[PositiveRatio, Limited("at least 1", "below 1 the part fails", least=1.0)]


_CORRECT = "correct the number or its unit"
_Elasticity = Annotated[
    float,
    PhysicalWithin(
        PRESSURE,
        "positive",
        rule="from 10 MPa to 2 TPa",
        hint=f"steel has 207 GPa; {_CORRECT}",
        least=1e7,
        greatest=2e12,
    ),
]
_Strength = Annotated[
    float,
    PhysicalWithin(
        PRESSURE,
        "positive",
        rule="from 1 MPa to 20 GPa",
        hint=f"steels have 200 to 2,000 MPa; {_CORRECT}",
        least=1e6,
        greatest=2e10,
    ),
]
_Bearing = Annotated[
    float,
    PhysicalWithin(
        PRESSURE,
        "positive",
        rule="from 10 kPa to 5 GPa",
        hint=f"bushes bear 1 to 100 MPa; {_CORRECT}",
        least=1e4,
        greatest=5e9,
    ),
]
"""Solid bars of any material, from soft plastics to fibres, lie well within; a value outside has the wrong unit."""


class MaterialPart(Checked[Material]):
    """Material of the crank and the rod."""

    makes = Material

    density: Density = required_entry("of the material", "7850 kg/m^3")
    elasticity: _Elasticity = required_entry("Young's modulus", "207 GPa")
    yield_strength: _Strength = required_entry("in tension and compression", "350 MPa")
    ultimate_strength: _Strength = required_entry("in tension", "520 MPa")
    endurance: _Strength = required_entry(
        "fully reversed strength of the finished bar, without eye_concentration", "150 MPa"
    )
    bearing_pressure: _Bearing = required_entry("permissible at the pins, on their projected area", "20 MPa")


class PinsPart(Part):
    """Diameters of the three pins. Half the bar's width is a usual start."""

    crank_pivot: PositiveLength = required_entry("between frame and crank", "15 mm")
    crank_pin: PositiveLength = required_entry("between crank and connecting rod", "15 mm")
    slider_pin: PositiveLength = required_entry("between connecting rod and slider", "15 mm")


class SectionsPart(Checked[SectionLimits]):
    """Material, pins, available sizes and safety factors of crank and rod as rectangular bars."""

    material: MaterialPart = required_entry("of crank and rod", EXAMPLE["material"])
    pins: PinsPart = required_entry("diameters, usually about half the width of the bar", EXAMPLE["pins"])
    width: PositiveRange = optional_entry(
        "in the plane of motion: range that can be made", ["10 mm", "80 mm"], default=(5e-3, 0.2)
    )
    depth: PositiveRange = optional_entry("normal to the plane", ["5 mm", "40 mm"], default=(3e-3, 0.1))
    static_safety: _Safety = optional_entry("against yield", 2.0, default=2.0)
    fatigue_safety: _Safety = optional_entry("against fatigue", 1.5, default=1.5)
    buckling_safety: _Safety = optional_entry("against Euler's load", 3.0, default=3.0)
    criterion: Criterion = optional_entry("fatigue criterion for mean stresses", "goodman", default="goodman")
    eye_concentration: _Raised = optional_entry(
        "greatest divided by mean stress in the net section of an eye; see a chart such as Shigley's fig. A-15-12",
        2.5,
        default=1.0,
    )

    wear_coefficient: WearCoefficient | None = optional_entry(
        "wear coefficient: worn volume per force and sliding distance, for the softer of pin and bearing",
        "1e-9 mm^2/N",
    )

    def build(self) -> SectionLimits:
        """Return the limits in the form that the sizing uses."""
        entries = dict(self)
        for name in ("material", "pins", "wear_coefficient"):
            entries.pop(name)
        return SectionLimits(**dict(self.pins), **entries)

    def strength(self) -> Strength:
        """Return material and pins in the form that quantities use."""
        return Strength(
            material=self.material.build(), **dict(self.pins), **{name: getattr(self, name) for name in _OF_STRENGTH}
        )


PositiveAngle = Annotated[float, Physical(kinds.ANGLE, "positive")]


_Exponent = Annotated[PositiveRatio, Limited("from 0.25 to 4", "processes have 0.5 to 3", least=0.25, greatest=4.0)]


class _CostPart(Checked[Cost]):
    """Fields common to all costs. Any currency, the same for all."""

    makes = Cost
    renamed: ClassVar = {"min": "least", "max": "greatest"}

    cost: PositiveRatio = required_entry("of the part that depends on the tolerance, at the tolerance `at`", 8.0)
    fixed: Fraction = optional_entry("the rest of the cost", 5.0, default=0.0)
    exponent: _Exponent = optional_entry(
        "k of fixed + cost (at / tolerance)^k, 0.25 to 4; 1: reciprocal", 1.0, default=1.0
    )


class LengthCostPart(_CostPart):
    """Cost of the tolerance of a length: fixed + cost (at / tolerance)^exponent."""

    at: PositiveLength = required_entry("the tolerance at which `cost` applies", "0.05 mm")
    min: Radius = optional_entry("smallest tolerance that can be made", "0.005 mm", default=0.0)
    max: PositiveLength | None = optional_entry("greatest permissible tolerance", "0.2 mm")


class AngleCostPart(_CostPart):
    """Cost of the tolerance of the crank angle: fixed + cost (at / tolerance)^exponent."""

    at: PositiveAngle = required_entry("the tolerance at which `cost` applies", "0.1 deg")
    min: AngleTolerance = optional_entry("smallest tolerance that can be made", "0.01 deg", default=0.0)
    max: PositiveAngle | None = optional_entry("greatest permissible tolerance", "1 deg")


class CostsPart(Built[Costs]):
    """Costs of holding each tolerance, for the allocation of tolerances; a tolerance without a cost stays unchanged."""

    makes = Costs

    crank: LengthCostPart | None = optional_entry("of the crank", {"cost": 8.0, "at": "0.05 mm", "min": "0.005 mm"})
    rod: LengthCostPart | None = optional_entry("of the rod", {"cost": 6.0, "at": "0.05 mm", "fixed": 2.0})
    offset: LengthCostPart | None = optional_entry("of the offset", {"cost": 4.0, "at": "0.1 mm", "exponent": 2.0})
    crank_angle: AngleCostPart | None = optional_entry(
        "of the crank angle", {"cost": 10.0, "at": "0.1 deg", "max": "1 deg"}
    )

    @model_validator(mode="after")
    def _require_any_cost(self) -> CostsPart:
        if not self.model_fields_set:
            raise InputError(
                "must name at least one of crank, rod, offset and crank_angle; got an empty table; "
                'for example, add crank = { cost = 8.0, at = "0.05 mm" }'
            )
        return self


class RobustPart(Checked[Robust]):
    """Tolerances within the optimisation, per quantity; equalities, targets and position errors stay unchanged."""

    makes = Robust
    renamed: ClassVar = {"spread": "shape"}

    kind: Case = optional_entry(
        "percentile: value met by a percentage of all machines; worst case: value met by all machines within the "
        "limits",
        "percentile",
        default="percentile",
    )
    share: Annotated[float, Field(strict=True, ge=0.5, lt=1.0)] = optional_entry(
        "percentage of the machines, for a percentile", 0.99, default=0.99
    )
    order: Literal[1, 2] = optional_entry(
        "order of a worst case. 1: linear in the errors; 2: exact at the worst corner", 2, default=2
    )
    spread: Shape = optional_entry(
        "of the errors within the limits, for a percentile; normal: the limit is three standard deviations",
        "normal",
        default="normal",
    )
    samples: Annotated[int, Field(strict=True, ge=64, le=65536)] = optional_entry(
        "machines drawn for a percentile, the same for all designs", SAMPLES, default=SAMPLES
    )
    quantities: Annotated[tuple[str, ...], Field(min_length=1, max_length=50)] | None = optional_entry(
        "objectives and constraints to make robust; default: all for which this is possible",
        [PEAK_TORQUE.name, TRANSMISSION_ANGLE.name],
    )


def make_robust(problem: Problem, part: RobustPart | None) -> Problem:
    """Return the problem made robust if the job requests it. Raises JobError if that is impossible."""
    if part is None:
        return problem
    if problem.motion is not None and not problem.motion.of_lever:
        raise JobError("robust: needs a rotating crank, or a lever; got a crank that swings; leave the table out")
    if not toleranced_columns(problem.part(0).mechanism):
        raise JobError(
            "robust: needs tolerances of crank, rod or offset; got none (that of the crank angle affects no quantity "
            'of a whole cycle); for example, add [tolerances] crank = "0.05 mm"'
        )
    try:
        return robust_problem(problem, part.build())
    except InputError as error:
        raise JobError(f"robust: {error}") from None
