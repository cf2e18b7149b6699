"""Tolerances and sensitivity as numbers, text and figures: what they show is what the model gives."""

from __future__ import annotations

import dataclasses
import io
import json
import math
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread
from rich.console import Console

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.dimensions import DIMENSIONS
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Clearances, Mechanism, Tolerance, Tolerances
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.tolerance.exact_worst_case import (
    first_order_position_errors,
    fractions_of_sum,
    position_deviation_extremes,
    worst_position_error,
)
from slidercrank.model.tolerance.monte_carlo import simulate_machines_with_errors, variance_contributions
from slidercrank.objectives.tables.sensitivity import sensitivity
from slidercrank.service.questions.discovery import TOPICS
from slidercrank.service.questions.sensitivity import analysis as sensitivity_analysis
from slidercrank.service.questions.sensitivity.figure import tornado_figure, tornado_rows
from slidercrank.service.questions.tolerances import analysis as tolerance_analysis
from slidercrank.service.questions.tolerances.figure import PERCENTS, error_bands, tolerances_figure
from slidercrank.service.render.terminal import print_blocks
from tests.model.cases import SMOOTH
from tests.model.tolerance.machines import PUBLISHED, SUPPORT
from tests.service.test_figures import overlaps

GAPPED = dataclasses.replace(
    PUBLISHED,
    tolerances=dataclasses.replace(
        PUBLISHED.tolerances,
        clearances=Clearances(crank_pivot=1e-3, crank_pin=1e-3, slider_pin=1e-3, guide=2e-3),
    ),
)
SIEVE = Linkage(0.14, 0.31, 0.06)
CLOSE = Linkage(0.04, 0.0601, 0.02)
TIGHT = Mechanism(tolerances=Tolerances(rod=Tolerance(absolute=2e-4)))
"""Of `CLOSE` some linkages within the tolerance do not turn."""


def text_of(topic: ModuleType, numbers: Any) -> str:
    console = Console(width=100, file=io.StringIO(), markup=False, highlight=False)
    print_blocks(console, topic.blocks(numbers))
    return console.file.getvalue()  # type: ignore[attr-defined,no-any-return]


def lines_of(figure: Figure, panel: int) -> list[np.ndarray]:
    return [np.asarray(line.get_ydata(), dtype=float) for line in figure.axes[panel].lines]


@pytest.mark.parametrize("mechanism", [PUBLISHED, GAPPED], ids=["case 4", "with clearances"])
def test_numbers_of_the_tolerances_are_those_of_the_model(mechanism: Mechanism) -> None:
    found: Any = tolerance_analysis.numbers(mechanism, SUPPORT, limit=3e-3, samples=2000, seed=4)
    json.dumps(found, allow_nan=False)
    design = np.array([[1.4, 1.8, -0.05]])
    for key, signal in (("worst_case", Signal.POSITION_ERROR), ("root_sum_square", Signal.POSITION_ERROR_RSS)):
        peak = find_peaks(mechanism, signal, design, limit=1)
        assert found[f"{key}_mm"] == 1e3 * peak.values[0, 0]
        assert found[f"{key}_angle_deg"] == pytest.approx(np.degrees(peak.angles[0, 0]))
    exact = worst_position_error(mechanism, SUPPORT)
    assert found["exact_worst_case_mm"] == 1e3 * exact.size
    at = math.radians(found["worst_case_angle_deg"])
    linear = first_order_position_errors(mechanism, SUPPORT, at)
    rows = found["contributions"]
    assert sum(row["contribution_mm"] for row in rows) == pytest.approx(found["worst_case_mm"], rel=1e-12)
    there = linear.contributions[:, 0] > 0.0
    np.testing.assert_allclose(
        [row["share_of_worst_case_percent"] for row in rows], 100.0 * linear.share_of_worst_case[there, 0], rtol=1e-9
    )
    of_variance = fractions_of_sum(variance_contributions(mechanism, SUPPORT, at))[there, 0]
    np.testing.assert_allclose([row["share_of_variance_percent"] for row in rows], 100.0 * of_variance, rtol=1e-9)
    for share in ("worst_case", "variance"):
        assert sum(row[f"share_of_{share}_percent"] for row in rows) == pytest.approx(100.0, rel=1e-12)
    simulation = simulate_machines_with_errors(mechanism, SUPPORT, samples=2000, seed=4)
    within = 100.0 * np.mean(simulation.greatest <= 3e-3)
    (only,) = found["yields"]
    assert only["yield_percent"] == pytest.approx(within, rel=1e-12)
    assert only["yield_low_percent"] < within < only["yield_high_percent"]
    assert found["monte_carlo"]["percentiles_greatest_mm"]["95"] == pytest.approx(
        1e3 * np.percentile(simulation.greatest, 95.0)
    )


def test_text_of_the_tolerances_is_short_and_has_their_numbers() -> None:
    found: Any = tolerance_analysis.numbers(GAPPED, SUPPORT, samples=2000)
    text = text_of(tolerance_analysis, found)
    assert len(text.splitlines()) <= 30
    for key in ("worst_case_mm", "exact_worst_case_mm", "root_sum_square_mm"):
        assert f"{found[key]:.4g} mm" in text
    assert "crank pin clearance" in text
    assert "scatter more widely" in text
    assert "scatter more widely" not in text_of(tolerance_analysis, tolerance_analysis.numbers(PUBLISHED, SUPPORT))


def test_where_a_linkage_within_the_tolerances_does_not_turn_the_exact_worst_case_is_not_given() -> None:
    found: Any = tolerance_analysis.numbers(TIGHT, CLOSE, samples=2000)
    json.dumps(found, allow_nan=False)
    assert found["exact_worst_case_mm"] is None
    assert found["monte_carlo"]["stuck"] > 0
    text = text_of(tolerance_analysis, found)
    assert "does not rotate fully" in text
    bands = error_bands(TIGHT, CLOSE, samples=500)
    assert bands.least is None
    assert len(lines_of(tolerances_figure(bands), 0)) == 5  # two each of worst case and root-sum-square, and zero


def test_without_tolerances_there_is_nothing_to_analyse() -> None:
    with pytest.raises(InputError, match="needs tolerances; got none; for example, add"):
        tolerance_analysis.numbers(Mechanism(speed=1.0), SUPPORT)


def test_error_bands_are_those_of_the_model() -> None:
    bands = error_bands(GAPPED, SUPPORT, samples=1000, seed=3)
    theta = np.radians(bands.angles)
    linear, exact = (
        first_order_position_errors(GAPPED, SUPPORT, theta),
        position_deviation_extremes(GAPPED, SUPPORT, theta),
    )
    np.testing.assert_allclose(bands.worst_case, linear.worst_case, rtol=1e-9)
    np.testing.assert_allclose(bands.root_sum_square, linear.root_sum_square, rtol=1e-9)
    assert bands.least is not None
    assert bands.greatest is not None
    np.testing.assert_allclose(bands.least, exact.least, rtol=1e-9)
    np.testing.assert_allclose(bands.greatest, exact.greatest, rtol=1e-9)
    errors = simulate_machines_with_errors(GAPPED, SUPPORT, theta, samples=1000, seed=3).errors
    np.testing.assert_allclose(bands.percentiles, np.percentile(errors, PERCENTS, axis=0), rtol=1e-9)
    np.testing.assert_allclose(bands.shares.sum(axis=0), 100.0, rtol=1e-12)
    assert len(bands.sources) == 8
    figure = tolerances_figure(bands)
    curves = (bands.worst_case, -bands.worst_case, bands.greatest, bands.least, bands.root_sum_square)
    inch = tolerances_figure(bands, "inch")
    for drawn, factor in ((figure, 1e3), (inch, 1.0 / 0.0254)):
        for line, curve in zip(lines_of(drawn, 0), curves, strict=False):
            np.testing.assert_allclose(line, factor * curve, rtol=1e-12)
        assert overlaps(drawn) == []
    assert inch.axes[0].get_ylabel() == "deviation along the line, in"


def test_sensitivity_numbers_are_those_of_the_table_with_none_for_nan() -> None:
    found: Any = sensitivity_analysis.numbers(SMOOTH, SIEVE)
    json.dumps(found, allow_nan=False)
    table = sensitivity(SMOOTH, np.array([0.14, 0.31, 0.06]))
    assert [row["quantity"] for row in found["quantities"]] == list(table["quantity"])
    for row, (_, expected) in zip(found["quantities"], table.iterrows(), strict=True):
        for name in DIMENSIONS:
            slope = expected[f"{name}_per_mm"]
            assert row[f"{name}_per_mm"] == (None if np.isnan(slope) else slope)
    in_line: Any = sensitivity_analysis.numbers(SMOOTH, Linkage(0.14, 0.31))
    json.dumps(in_line, allow_nan=False)
    assert all(row["offset_percent"] is None for row in in_line["quantities"])
    each, within = text_of(sensitivity_analysis, found).split("Change of each quantity for the tolerance")
    assert max(len(part.splitlines()) for part in (each, within)) <= 32
    (line,) = (line for line in within.splitlines() if line.startswith("peak torque "))
    (row,) = (row for row in found["quantities"] if row["title"] == "peak torque")
    changes = [row[f"{name}_tolerance"] for name in DIMENSIONS]
    assert [float(one) for one in line.split()[2:5]] == pytest.approx(changes, rel=5e-4)
    assert "peak torque" in text_of(sensitivity_analysis, in_line)


@pytest.mark.parametrize("offset", [0.06, 0.0])
def test_tornado_draws_the_percentages_most_sensitive_first(offset: float) -> None:
    linkage = Linkage(0.14, 0.31, offset)
    rows = tornado_rows(SMOOTH, linkage)
    table = sensitivity(SMOOTH, np.array([0.14, 0.31, offset])).set_index("title")
    columns = [f"{name}_percent" for name in DIMENSIONS]
    for _, row in rows.iterrows():
        expected = table.loc[row["title"], columns].to_numpy(dtype=float, copy=True)
        if not offset and not np.isnan(expected[0]):  # of no offset there is no percent: for 1 mm
            expected[2] = 100.0 * float(table.loc[row["title"], "offset_per_mm"] / table.loc[row["title"], "value"])
        np.testing.assert_allclose(row[columns].to_numpy(dtype=float), expected, rtol=1e-15)
    both = [*columns, *(f"{column}_below" for column in columns)]
    assert rows[both].abs().max(axis=1).is_monotonic_decreasing
    inch = tornado_figure(rows, "inch")
    assert inch.axes[2].get_title() == ("offset" if offset else "offset, for 0.01 in")
    figure = tornado_figure(rows)
    offsets = [[bar.get_width() for bar in each.axes[2].patches] for each in (inch, figure)]  # type: ignore[attr-defined]
    np.testing.assert_allclose(offsets[0], np.array(offsets[1]) * (1.0 if offset else 0.254))
    for panel, column in zip(figure.axes, columns, strict=True):
        widths = [bar.get_width() for bar in panel.patches]  # type: ignore[attr-defined]
        drawn: list[float] = []
        for below, above in rows[[f"{column}_below", column]].dropna().to_numpy():
            drawn += [above] if math.isclose(below, above, rel_tol=1e-9) else [below, above]
        np.testing.assert_allclose(widths, drawn, rtol=1e-12)
    assert overlaps(figure) == []


def test_figures_are_written_where_they_are_wanted(tmp_path: Path) -> None:
    for name in ("tolerances", "sensitivity"):
        file = TOPICS[name].bind_to_design(PUBLISHED, SUPPORT).draw(tmp_path)
        assert file == tmp_path / f"{name}.png"
        assert imread(file).shape[1] > 800
