"""Position error of one design over the cycle: worst-case, root-sum-square and Monte Carlo bands, and its sources."""

import contextlib
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from ....model.arrays import Array
from ....model.cycle.cycle import cycle
from ....model.errors import AssemblyError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.tolerance.error_distributions import SOURCES, limits_of_sources
from ....model.tolerance.exact_worst_case import fractions_of_sum, position_deviation_extremes
from ....model.tolerance.monte_carlo import simulate_machines_with_errors, variance_contributions
from ....objectives.kinds import LENGTH, System
from ...figures import style
from ...render.numerals import title_with_unit

SAMPLES, ANGLES = 10_000, 181
PERCENTS = (0.135, 5.0, 95.0, 99.865)


@dataclass(frozen=True)
class Bands:
    """Deviations of the slider over the cycle, m, each (m,), at crank angles, deg.

    least, greatest: exact extremes; None if a linkage within the tolerances does not rotate fully. percentiles: (4, m),
    at `PERCENTS`. shares: fractions of the variance (s, m), percent, for each source. machines: (n,), the maximum error
    of each random machine that rotates fully, over the counted part of the cycle.
    """

    angles: Array
    worst_case: Array
    root_sum_square: Array
    least: Array | None
    greatest: Array | None
    percentiles: Array
    sources: tuple[str, ...]
    shares: Array
    machines: Array


def error_bands(mechanism: Mechanism, linkage: Linkage, *, samples: int = SAMPLES, seed: int = 1) -> Bands:
    """Return the bands of one fully rotating linkage over a full revolution, including parts that do not count."""
    theta = np.linspace(0.0, 2.0 * np.pi, ANGLES)
    least = greatest = None
    with contextlib.suppress(AssemblyError):
        exact = position_deviation_extremes(mechanism, linkage, theta)
        least, greatest = exact.least, exact.greatest
    linear = cycle(mechanism, linkage, theta)
    simulated = simulate_machines_with_errors(mechanism, linkage, theta, samples=samples, seed=seed)
    has_tolerance = limits_of_sources(mechanism, linkage) > 0.0
    return Bands(
        np.degrees(theta),
        linear.position_error,
        linear.position_error_rss,
        least,
        greatest,
        np.nanpercentile(simulated.errors, PERCENTS, axis=0),
        tuple(name for name, is_toleranced in zip(SOURCES, has_tolerance, strict=True) if is_toleranced),
        100.0 * fractions_of_sum(variance_contributions(mechanism, linkage, theta))[has_tolerance],
        simulated.greatest[np.isfinite(simulated.greatest)],
    )


def tolerances_figure(bands: Bands, system: System = "metric") -> Figure:
    """Return the figure in a unit system: the bands, random machines beside them, and sources below."""
    unit = LENGTH.display_unit(system)
    figure = style.new_figure(9.2, 7.2)
    note = "Monte Carlo: normal errors, limits at three standard deviations; pins pressed to either side"
    style.write_heading(figure, "Slider position error from tolerances", note)
    upper, lower = style.add_axes(figure, 0.8, 3.35, 5.9, 3.25), style.add_axes(figure, 0.8, 0.65, 5.9, 2.2)
    for panel in (upper, lower):
        style.style_axes(panel, most_y_ticks=6)
        style.show_full_turn(panel)
    low, inner_low, inner_high, high = unit.factor * bands.percentiles
    upper.fill_between(bands.angles, low, high, color="#e4e4e4", linewidth=0, label="Monte Carlo, 99.73 %")
    upper.fill_between(bands.angles, inner_low, inner_high, color="#bdbdbd", linewidth=0, label="Monte Carlo, 90 %")
    for sign, label in ((1.0, "worst case, first order"), (-1.0, None)):
        upper.plot(bands.angles, sign * unit.factor * bands.worst_case, color=style.BLUE, linewidth=1.6, label=label)
    if bands.least is not None and bands.greatest is not None:
        exact = {"color": style.VERMILION, "linewidth": 1.2, "linestyle": (0, (5, 3))}
        upper.plot(bands.angles, unit.factor * bands.greatest, **exact, label="worst case, exact")  # type: ignore[arg-type]
        upper.plot(bands.angles, unit.factor * bands.least, **exact)  # type: ignore[arg-type]
    for sign, label in ((1.0, "root-sum-square"), (-1.0, None)):
        error = sign * unit.factor * bands.root_sum_square
        upper.plot(bands.angles, error, color=style.INK, linewidth=1.2, linestyle=":", label=label)
    upper.axhline(0.0, color=style.FRAME, linewidth=0.8)
    upper.set_ylabel(title_with_unit("deviation along the line", unit.symbol), fontsize=style.TEXT)
    lower.set_ylabel("share of the variance, %", fontsize=style.TEXT)
    lower.set_xlabel("crank angle, deg", fontsize=style.TEXT)
    lower.set_ylim(0, 100)
    style.draw_stack(lower, bands.angles, bands.shares, bands.sources)
    counts = style.add_axes(figure, 7.25, 3.75, 1.7, 1.3)
    style.style_axes(counts, most_x_ticks=3)
    counts.hist(unit.factor * bands.machines, bins=40, color="#bdbdbd")
    counts.set_yticks([])
    counts.set_xlabel(title_with_unit("greatest error of a machine", unit.symbol), fontsize=style.SMALL)
    style.add_legend_at_right(upper)
    style.add_legend_at_right(lower, stacked=len(bands.sources))
    return figure
