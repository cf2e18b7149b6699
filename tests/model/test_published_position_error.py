"""Chetana and Vineeth Kumar, Analysis of Position Error in Offset Slider Crank Mechanism, Table 1.

The paper does not state its mechanism; crank 1400, rod 1800, offset 50 mm reproduce x, rod angle and the columns of
crank, rod and offset to print rounding. Its offset is the mirror image of the one here. The crank-angle column is a
misprint: the exact contributions times -(2 pi - q), with q the crank angle in rad.
"""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage

CRANK, ROD, OFFSET = 1400.0, 1800.0, 50.0
LINKAGE = Linkage(CRANK, ROD, -OFFSET)  # in mm: every quantity here is a length or an angle
SHARE = 1e-3  # the errors of the table: 0.1 % of each length, 0.1 deg
ANGLE = math.radians(0.1)
EXACT_ANGLE_COLUMN = (
    *(-0.9074, -1.7059, -2.4047, -2.7875, -3.1912),
    *(-3.3303, -3.1488, -2.6591, -2.0042, -1.7861),
)


@pytest.fixture(scope="module")
def printed(request: pytest.FixtureRequest) -> dict[str, list[str]]:
    path = request.config.rootpath / "tests" / "data" / "position_error_table1.csv"
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert len(rows) == 10
    return {name: [row[name] for row in rows] for name in rows[0]}


def angles(printed: dict[str, list[str]]) -> np.ndarray:
    return np.radians([float(value) for value in printed["crank_angle_deg"]])


def rounding(text: str) -> float:
    """Return one unit in the last of at least two printed decimals: the table also cuts, and drops zeros."""
    decimals = len(text.partition(".")[2])
    return 10.0 ** -max(decimals, 2)


def agrees(printed: list[str], exact: np.ndarray) -> None:
    for text, value in zip(printed, exact, strict=True):
        assert float(text) == pytest.approx(value, rel=0.0, abs=rounding(text))


def test_positions_and_rod_angles_are_the_printed_ones(printed: dict[str, list[str]]) -> None:
    at = LINKAGE.at(angles(printed))
    agrees(printed["slider_position_mm"], at.slider_position)
    agrees(printed["rod_angle_deg"], -np.degrees(at.rod_angle))


def test_columns_of_crank_rod_and_offset_are_the_printed_ones(printed: dict[str, list[str]]) -> None:
    i = LINKAGE.error_influences(angles(printed))
    agrees(printed["error_from_crank_0p1pct_mm"], i.crank * SHARE * CRANK)
    agrees(printed["error_from_rod_0p1pct_mm"], i.rod * SHARE * ROD)
    agrees(printed["error_from_offset_0p1pct_mm"], i.offset * SHARE * -OFFSET)


def test_crank_angle_column_has_its_exact_values(printed: dict[str, list[str]]) -> None:
    exact = LINKAGE.error_influences(angles(printed)).crank_angle * ANGLE
    np.testing.assert_allclose(exact, EXACT_ANGLE_COLUMN, rtol=0, atol=5e-5)  # given with four decimals


def test_printed_crank_angle_column_is_the_exact_one_times_a_misprinted_factor(
    printed: dict[str, list[str]],
) -> None:
    q = angles(printed)
    misprint = LINKAGE.error_influences(q).crank_angle * ANGLE * -(2.0 * math.pi - q)
    agrees(printed["error_from_crank_angle_printed_mm"], misprint)


def test_printed_total_is_the_plain_signed_sum_of_the_printed_columns(printed: dict[str, list[str]]) -> None:
    columns = [name for name in printed if name.startswith("error_from")]
    assert len(columns) == 4
    for n, total in enumerate(printed["total_printed_mm"]):
        parts = [printed[name][n] for name in columns]
        slack = sum(rounding(text) for text in (*parts, total))
        assert float(total) == pytest.approx(sum(float(text) for text in parts), rel=0.0, abs=slack)
