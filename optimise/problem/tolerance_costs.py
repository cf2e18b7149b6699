"""Requests for sizing: costs of making parts to tolerances; safety factors, pins and available sizes of sections."""

import math
from dataclasses import dataclass, fields

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.tolerance.error_distributions import limits_of_sources


@dataclass(frozen=True, kw_only=True)
class Cost:
    """Cost of holding a tolerance t: fixed + cost (at / t)^exponent.

    Exponent 1 gives the reciprocal model a + b / t (b = cost at), others give the power model a + b / t^k; both in M.
    F. Spotts, "Allocation of tolerances to minimize cost of assembly", J. Engineering for Industry 95, 1973, and the
    survey of K. W. Chase and W. H. Greenwood, "Design issues in mechanical tolerance analysis", Manufacturing Review
    1(1), 1988. Any currency, the same in all costs.

    cost: variable cost at the tolerance `at`. at: reference tolerance, m, or rad for the crank angle. fixed: fixed
    cost. least, greatest: range of the process, m or rad.
    """

    cost: float
    at: float
    fixed: float = 0.0
    exponent: float = 1.0
    least: float = 0.0
    greatest: float = math.inf

    def __post_init__(self) -> None:
        for name in ("cost", "at", "exponent"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"the {name} of a tolerance's cost must be positive and finite; got {value:g}")
        if not math.isfinite(self.fixed) or self.fixed < 0.0:
            raise InputError(f"the fixed cost of a tolerance must be zero or more and finite; got {self.fixed:g}")
        if not 0.25 <= self.exponent <= 4.0:
            raise InputError(
                f"the exponent of a tolerance's cost must be from 0.25 to 4; got {self.exponent:g}; "
                "processes have 0.5 to 3"
            )
        if not (math.isfinite(self.least) and 0.0 <= self.least < self.greatest):
            raise InputError(
                "the least tolerance must be zero or more and below the greatest; "
                f"got {self.least:g} to {self.greatest:g}; a given tolerance belongs to the mechanism, without a cost"
            )

    def cost_at(self, tolerance: float) -> float:
        """Return the cost of a tolerance, m or rad; infinite at zero."""
        return self.fixed + self.cost * (self.at / tolerance) ** self.exponent if tolerance > 0.0 else math.inf

    def cost_slope(self, tolerance: float) -> float:
        """Return the derivative of the cost with respect to the tolerance, per m or rad; never positive."""
        return -self.exponent * (self.cost_at(tolerance) - self.fixed) / tolerance


@dataclass(frozen=True, kw_only=True)
class Costs:
    """Costs of the tolerances; None leaves a tolerance at the mechanism's value."""

    crank: Cost | None = None
    rod: Cost | None = None
    offset: Cost | None = None
    crank_angle: Cost | None = None

    def __post_init__(self) -> None:
        if not self.costs_by_name:
            raise InputError("costs must name at least one of crank, rod, offset and crank_angle; got none")

    @property
    def costs_by_name(self) -> dict[str, Cost]:
        """The stated costs by name, in the order of `NAMES`."""
        return {name: cost for name in NAMES if (cost := getattr(self, name)) is not None}


NAMES = (*DIMENSIONS, "crank_angle")
"""Sources whose tolerance can be chosen, in the order of `model.tolerance.sources.SOURCES`."""


def costs_of_tolerances(costs: Costs, linkage: Linkage, before: Mechanism) -> dict[str, float] | None:
    """Return the cost of each tolerance of a mechanism, by name; None if a tolerance with a cost is zero."""
    limits_by_name = dict(zip(NAMES, limits_of_sources(before, linkage)[: len(NAMES)], strict=True))
    if not all(limits_by_name[name] > 0.0 for name in costs.costs_by_name):
        return None
    return {name: cost.cost_at(float(limits_by_name[name])) for name, cost in costs.costs_by_name.items()}


def _require_at_least(subject: str, name: str, value: float, least: float = 0.0) -> None:
    if not math.isfinite(value) or value <= least:
        raise InputError(f"{subject} must have a finite {name} above {least:g}; got {value:g}")


@dataclass(frozen=True, kw_only=True)
class SectionLimits:
    """Safety factors, pins and available sections, SI.

    crank_pivot, crank_pin, slider_pin: pin diameters, m. width, depth: least and greatest, m. criterion: fatigue
    criterion. eye_concentration: ratio of greatest to mean stress in the net section of an eye. The default factors are
    customary for known loads and materials; set your own.
    """

    crank_pivot: float
    crank_pin: float
    slider_pin: float
    width: tuple[float, float] = (5e-3, 0.2)
    depth: tuple[float, float] = (3e-3, 0.1)
    static_safety: float = 2.0
    fatigue_safety: float = 1.5
    buckling_safety: float = 3.0
    criterion: str = "goodman"
    eye_concentration: float = 1.0

    def __post_init__(self) -> None:
        for name in ("crank_pivot", "crank_pin", "slider_pin"):
            _require_at_least("a pin", f"diameter ({name})", getattr(self, name))
        for name in (item.name for item in fields(self) if item.name.endswith("_safety")):
            if not 1.0 <= getattr(self, name) < math.inf:
                raise InputError(f"{name} must be at least 1 and finite; got {getattr(self, name):g}")
        for name in ("width", "depth"):
            low, high = getattr(self, name)
            if not 0.0 < low < high < math.inf:
                raise InputError(f"the {name} must have 0 < least < greatest, both finite; got {low:g} to {high:g} m")
        if not 1.0 <= self.eye_concentration < math.inf:
            raise InputError(f"eye_concentration must be at least 1 and finite; got {self.eye_concentration:g}")
        if self.criterion not in ("goodman", "soderberg"):
            raise InputError(f"the fatigue criterion must be 'goodman' or 'soderberg'; got {self.criterion!r}")
