"""Lengths with the digits that their tolerances justify: 73.33 ± 0.05 for 73.33253 mm."""

from decimal import Decimal

from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism

_DIGITS = 2
"""Significant digits of a tolerance; more convey nothing."""


def tolerances_of(mechanism: Mechanism, linkage: Linkage) -> dict[str, float]:
    """Return the tolerance of each dimension that has one, mm, including relative tolerances."""
    limits = {
        name: getattr(mechanism.tolerances, name).deviation_limit(float(getattr(linkage, name))) for name in DIMENSIONS
    }
    return {name: 1e3 * limit for name, limit in limits.items() if limit > 0.0}


def decimals_of_tolerance(tolerance: float) -> int:
    """Return the decimals of a tolerance with at most two significant digits. They are 2 for 0.05, 0 for 12."""
    exponent = Decimal(f"{tolerance:.{_DIGITS}g}").normalize().as_tuple().exponent
    return max(0, -exponent) if isinstance(exponent, int) else 0


def format_length(length: float, tolerance: float) -> str:
    """Return a length with its tolerance, or with five significant digits if it has none."""
    return format_toleranced(length, tolerance) if tolerance else f"{length:.5g}"


def format_toleranced(length: float, tolerance: float) -> str:
    """Return a length with as many decimals as its tolerance, and the tolerance."""
    decimals = decimals_of_tolerance(tolerance)
    text = f"{length:.{decimals}f}"
    text = text if float(text) else f"{0.0:.{decimals}f}"  # avoids a minus sign before zero
    return f"{text} ± {Decimal(f'{tolerance:.{_DIGITS}g}').normalize():f}"
