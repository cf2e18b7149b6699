"""Position error of one design from tolerances: worst case, root-sum-square, exact, Monte Carlo, contributions."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Annotated

import numpy as np

from ....model.arrays import Array
from ....model.errors import AssemblyError, InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.signals.first_peak import first_peaks
from ....model.signals.signals import Signal
from ....model.tolerance.error_distributions import SOURCES, limits_of_sources, source_influences
from ....model.tolerance.exact_worst_case import fractions_of_sum, worst_position_error
from ....model.tolerance.monte_carlo import (
    simulate_machines_with_errors,
    summarise_sample,
    variance_contributions,
    yield_within,
)
from ....objectives.kinds import LENGTH, System
from ...render.blocks import Block, Table, Text, Value, column, heading, joined, note, value_from_record, words
from ..peaks import lengths_row
from ..record_types import Note, Record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Turning = Annotated[float | None, Note("null unless at least two of the machines rotate fully")]
Exact = Annotated[float | None, Note("null where a linkage within the tolerances does not rotate fully")]
SAMPLES = 20_000
_ERRORS = (Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS)
BINS = 40  # of the histogram


class Contribution(Record):
    """Contribution of one tolerance to the position error at the crank angle of the worst case."""

    source: str
    limit_mm: Annotated[float | None, Note("null for the crank angle")]
    limit_deg: Annotated[float | None, Note("of the crank angle; null for lengths")]
    contribution_mm: float
    share_of_worst_case_percent: float
    share_of_variance_percent: float


class Histogram(Record):
    """Machines by maximum error, in equal bins from 0."""

    edges_mm: list[float]
    counts: list[int]


class MonteCarlo(Record):
    """Maximum errors of random machines within the tolerances."""

    samples: int
    seed: int
    stuck: int
    """Machines that do not rotate fully."""
    mean_greatest_mm: Turning
    standard_deviation_greatest_mm: Turning
    percentiles_greatest_mm: dict[str, float]
    """By percentage of machines; empty if at most one machine rotates fully."""
    histogram: Annotated[Histogram | None, Note("null if no machine rotates, or none has an error")]


class Yield(Record):
    """Fraction of random machines within a limit, with its confidence interval."""

    limit: str
    """Origin of the limit: root-sum-square, worst case, or given."""
    limit_mm: float
    yield_percent: float
    yield_low_percent: float
    yield_high_percent: float
    confidence_percent: float


class PositionError(Record):
    """Maximum position error over the counted part of the cycle, and its sources."""

    worst_case_mm: float
    """To first order."""
    worst_case_angle_deg: float
    exact_worst_case_mm: Exact
    exact_worst_case_angle_deg: Exact
    root_sum_square_mm: float
    root_sum_square_angle_deg: float
    contributions: list[Contribution]
    monte_carlo: MonteCarlo
    yields: list[Yield]
    """At the given limit, or else at the root-sum-square and at the worst case."""


def numbers(
    mechanism: Mechanism, linkage: Linkage, *, limit: float | None = None, samples: int = SAMPLES, seed: int = 1
) -> PositionError:
    """Return the effect of a mechanism's tolerances on the slider position of one linkage, ready for JSON.

    limit: position tolerance for the yield, m; None gives the yields at the root-sum-square and at the worst case.
    Contributions are fractions of the simulated variance, at the crank angle of the first-order worst case. The exact
    worst case is None if a linkage within the tolerances does not rotate fully. The histogram counts machines by
    maximum error, in equal bins from 0. Raises `InputError` if there are no tolerances.
    """
    source_limits = limits_of_sources(mechanism, linkage)
    if not np.any(source_limits):
        raise InputError('a position error needs tolerances; got none; for example, add [tolerances] crank = "0.05 mm"')
    design = lengths_row(linkage)
    (worst_case, at), (rss, at_square) = (
        (float(values[0]), angles) for values, angles in (first_peaks(mechanism, signal, design) for signal in _ERRORS)
    )
    try:
        exact = worst_position_error(mechanism, linkage)
    except AssemblyError:
        exact = None
    parts = (np.abs(source_influences(mechanism, linkage, at)) * source_limits[:, None])[:, :1]
    of_worst = 100.0 * fractions_of_sum(parts)[:, 0]
    of_variance = 100.0 * fractions_of_sum(variance_contributions(mechanism, linkage, at))[:, 0]
    simulation = simulate_machines_with_errors(mechanism, linkage, samples=samples, seed=seed)
    spread = (
        summarise_sample(simulation.greatest, percents=(50.0, 95.0, 99.73)) if samples > 1 + simulation.stuck else None
    )
    deviation_limits = {"root-sum-square": rss, "worst case": worst_case} if limit is None else {"given": limit}
    return {
        "worst_case_mm": 1e3 * worst_case,
        "worst_case_angle_deg": float(np.degrees(at[0])),
        "exact_worst_case_mm": None if exact is None else 1e3 * exact.size,
        "exact_worst_case_angle_deg": None if exact is None else float(np.degrees(exact.crank_angle)),
        "root_sum_square_mm": 1e3 * rss,
        "root_sum_square_angle_deg": float(np.degrees(at_square[0])),
        "contributions": [
            {
                "source": name,
                "limit_mm": None if name == "crank angle" else 1e3 * float(source_limits[n]),
                "limit_deg": float(np.degrees(source_limits[n])) if name == "crank angle" else None,
                "contribution_mm": 1e3 * float(parts[n, 0]),
                "share_of_worst_case_percent": float(of_worst[n]),
                "share_of_variance_percent": float(of_variance[n]),
            }
            for n, name in enumerate(SOURCES)
            if source_limits[n] > 0.0
        ],
        "monte_carlo": {
            "samples": len(simulation.greatest),
            "seed": seed,
            "stuck": simulation.stuck,
            "mean_greatest_mm": None if spread is None else 1e3 * spread.mean,
            "standard_deviation_greatest_mm": None if spread is None else 1e3 * spread.deviation,
            "percentiles_greatest_mm": {
                f"{percent:g}": 1e3 * value for percent, value in (() if spread is None else spread.percentiles)
            },
            "histogram": _error_histogram(simulation.greatest),
        },
        "yields": [_yield_record(simulation.greatest, name, value) for name, value in deviation_limits.items()],
    }


def _yield_record(greatest: Array, name: str, value: float) -> Yield:
    """Return the fraction of machines with errors within a limit, m, and its confidence interval."""
    share = yield_within(greatest, value)
    return {
        "limit": name,
        "limit_mm": 1e3 * value,
        "yield_percent": 100.0 * share.share,
        "yield_low_percent": 100.0 * share.low,
        "yield_high_percent": 100.0 * share.high,
        "confidence_percent": 100.0 * share.confidence,
    }


def _error_histogram(greatest: np.ndarray) -> Histogram | None:
    """Return bin edges, mm, and counts of the machines that rotate fully; None if there are none."""
    turning = 1e3 * greatest[np.isfinite(greatest)]
    if not len(turning) or not turning.max() > 0.0:
        return None
    counts, edges = np.histogram(turning, bins=BINS, range=(0.0, float(turning.max())))
    return {"edges_mm": edges.tolist(), "counts": counts.tolist()}


def blocks(numbers: PositionError) -> list[Block]:
    """Return the answer in human-readable form."""

    def size_and_angle(name: str) -> Text:
        size, angle = (value_from_record(numbers, f"{name}_{unit}", digits=4) for unit in ("mm", "angle_deg"))
        if size.number is None:
            return "undefined: a linkage within the tolerances does not rotate fully"
        return words("{size} at {angle}", size=size, angle=angle)

    simulation = numbers["monte_carlo"]
    spread = [
        words(f"{percent} % within {{size}}", size=Value(1e-3 * value, LENGTH, 4))
        for percent, value in simulation["percentiles_greatest_mm"].items()
    ]
    rows: list[tuple[Text, ...]] = [
        ("worst case, first order", size_and_angle("worst_case")),
        ("worst case, exact", size_and_angle("exact_worst_case")),
        ("root-sum-square", size_and_angle("root_sum_square")),
        (f"{simulation['samples']:,} random machines", joined(spread) or "-"),
    ]
    if simulation["stuck"]:
        rows.append(("", f"{simulation['stuck']:,} of them do not rotate fully"))
    for yield_record in numbers["yields"]:
        low, high = yield_record["yield_low_percent"], yield_record["yield_high_percent"]
        share = f"{yield_record['yield_percent']:.2f} %, between {low:.2f} and {high:.2f} %"
        limit = words(
            "yield at {size} ({name})",
            size=value_from_record(yield_record, "limit_mm", digits=4),
            name=yield_record["limit"],
        )
        rows.append((limit, f"{share} at {yield_record['confidence_percent']:g} % confidence"))
    result_blocks: list[Block] = [
        heading("Position error from tolerances: greatest over the counted part of the cycle"),
        Table((column(left=True), column(left=True)), tuple(rows)),
    ]
    if any(row["source"].endswith("clearance") for row in numbers["contributions"]):
        result_blocks.append(
            note(
                "Root-sum-square treats a clearance as three standard deviations; pins pressed to either side scatter "
                "more widely, as the random machines show."
            )
        )
    return [*result_blocks, _source_table(numbers["contributions"])]


def _source_table(contributions: list[Contribution]) -> Table:
    rows = []
    for row in contributions:
        limit = value_from_record(row, "limit_deg" if row["limit_mm"] is None else "limit_mm", digits=4)
        of_worst, of_variance = row["share_of_worst_case_percent"], row["share_of_variance_percent"]
        adds = value_from_record(row, "contribution_mm", digits=4)
        rows.append((row["source"], (limit,), adds, f"{of_worst:.1f} %", f"{of_variance:.1f} %"))
    heads = column("limit"), column("adds", LENGTH), column("of worst case"), column("of variance")
    return Table((column("contributions", left=True), *heads), tuple(rows))


def figure(mechanism: Mechanism, linkage: Linkage) -> Callable[[System], Figure]:
    """Return the bands of the error over the cycle, and their sources."""
    from .figure import error_bands, tolerances_figure

    return partial(tolerances_figure, error_bands(mechanism, linkage))
