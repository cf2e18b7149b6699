"""Distributions of errors within their limits, from which a Monte Carlo simulation draws."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..machine.loads.load import require_word
from .error_sources import GUIDE, PINS

Shape = Literal["normal", "truncated normal", "uniform", "triangular"]
Contact = Literal["along the rod", "any direction", "anywhere"]


def error_distribution(shape: Shape = "normal", *, sigmas: float = 3.0) -> Any:
    """Return the distribution of an error in units of its limit, as a frozen distribution of `scipy.stats`.

    normal: the limit is `sigmas` standard deviations; truncated normal: the same, with nothing beyond the limit.
    uniform and triangular (peak in the middle) end at the limits and ignore `sigmas`.
    """
    from scipy import stats

    require_word("shape", shape, Shape)
    if not (math.isfinite(sigmas) and sigmas > 0.0):
        raise InputError(f"sigmas, standard deviations within the limit, must be positive and finite; got {sigmas:g}")
    match shape:
        case "normal":
            return stats.norm(scale=1.0 / sigmas)
        case "truncated normal":
            return stats.truncnorm(-sigmas, sigmas, scale=1.0 / sigmas)
        case "uniform":
            return stats.uniform(-1.0, 2.0)
        case "triangular":
            return stats.triang(0.5, -1.0, 2.0)


@dataclass(frozen=True, kw_only=True)
class Spreads:
    """The distributions of all sources; errors of different sources are independent.

    crank, rod, offset, crank_angle: distributions in units of the limit, from `error_distribution` or any frozen
    distribution of `scipy.stats`. contact: position of a pin in its clearance c. "along the rod": pressed to either
    side with equal probability by the force in the rod (variance of its addition to the rod: c^2). "any direction": in
    contact, in a uniformly distributed direction (c^2 / 2). "anywhere" within the clearance circle, uniform over its
    area (c^2 / 4). The slider touches either side of its guide (c^2) or, with "anywhere", is uniform between them (c^2
    / 3).
    """

    crank: Any = field(default_factory=error_distribution)
    rod: Any = field(default_factory=error_distribution)
    offset: Any = field(default_factory=error_distribution)
    crank_angle: Any = field(default_factory=error_distribution)
    contact: Contact = "along the rod"

    def __post_init__(self) -> None:
        require_word("contact", self.contact, Contact)
        for name in ("crank", "rod", "offset", "crank_angle"):
            distribution = getattr(self, name)
            if not (hasattr(distribution, "rvs") and hasattr(distribution, "var")):
                raise InputError(
                    f'{name} must be a distribution, such as error_distribution("uniform"); got {distribution!r}'
                )

    @property
    def variances_per_squared_limit(self) -> Array:
        """Variance of each source, (8,), in units of its squared limit; for a pin, the component along the rod."""
        pin, guide = {"along the rod": (1.0, 1.0), "any direction": (0.5, 1.0), "anywhere": (0.25, 1.0 / 3.0)}[
            self.contact
        ]
        dimensions = (
            float(distribution.var()) for distribution in (self.crank, self.rod, self.offset, self.crank_angle)
        )
        return np.array([*dimensions, pin, pin, pin, guide])

    def draw_errors(self, limits: Array, count: int, random: np.random.Generator) -> Draw:
        """Return errors of `count` machines for the limits (8,) of the sources."""
        dimensions = [
            limit * np.asarray(distribution.rvs(count, random_state=random))
            for limit, distribution in zip(limits, (self.crank, self.rod, self.offset, self.crank_angle), strict=False)
        ]
        crank, rod, offset, angle = dimensions
        x, y = np.zeros(count), np.zeros(count)
        gaps = limits[PINS]
        if self.contact == "along the rod":
            rod = rod + gaps @ random.choice([-1.0, 1.0], (3, count))
        else:
            direction = random.uniform(0.0, 2.0 * math.pi, (3, count))
            share = np.sqrt(random.random((3, count))) if self.contact == "anywhere" else np.ones((3, count))
            x, y = gaps @ (share * np.cos(direction)), gaps @ (share * np.sin(direction))
        side = random.uniform(-1.0, 1.0, count) if self.contact == "anywhere" else random.choice([-1.0, 1.0], count)
        return Draw(crank, rod, offset + limits[GUIDE] * side, angle, x, y)


@dataclass(frozen=True)
class Draw:
    """Errors of n machines, each (n,): crank, rod, offset, m; crank angle, rad; crank pin position, m."""

    crank: Array
    rod: Array
    offset: Array
    crank_angle: Array
    pin_x: Array
    pin_y: Array
