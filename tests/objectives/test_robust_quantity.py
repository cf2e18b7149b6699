"""Quantities under tolerances: worst case and percentile, against machines that are drawn one by one."""

import pickle
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Tolerance, Tolerances
from slidercrank.model.tolerance.error_distributions import Spreads, error_distribution, limits_of_sources
from slidercrank.objectives.quantity import Quantity
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.robust.quantity import RobustQuantity, Side
from tests.optimise.problems import MACHINE

DESIGNS = np.array([[0.04, 0.13, 0.035], [0.05, 0.2, -0.02], [0.03, 0.11, 0.05]])
COARSE = replace(
    MACHINE,
    tolerances=Tolerances(
        crank=Tolerance(absolute=1e-4, fraction=1e-3), rod=Tolerance(absolute=3e-4), offset=Tolerance(fraction=0.01)
    ),
)
NAMES = ("peak_torque", "time_ratio", "transmission_angle", "stroke", "rms_torque", "peak_guide_force")
FORMS = (("worst case", 1), ("worst case", 2), ("percentile", 2))


def of(name: str, side: Side, kind: str = "percentile", order: int = 2, **options: object) -> RobustQuantity:
    return RobustQuantity(inner=QUANTITIES[name], side=side, case=kind, order=order, **options)  # type: ignore[arg-type]


def machines(share: NDArray[np.float64], design: NDArray[np.float64]) -> NDArray[np.float64]:
    t = COARSE.tolerances
    reach = [x.absolute + x.fraction * abs(d) for x, d in zip((t.crank, t.rod, t.offset), design, strict=True)]
    return np.asarray(design + share * np.array(reach))


def extrapolated(quantity: Quantity, column: int, size: float) -> NDArray[np.float64]:
    """Central differences at two steps, extrapolated to none: error of the fourth order."""
    slopes = []
    for step in (2.0 * size, size):
        ends = [DESIGNS + sign * step * np.eye(3)[column] for sign in (1.0, -1.0)]
        high, low = (quantity.evaluate(COARSE, end).values for end in ends)
        slopes.append((high - low) / (2.0 * step))
    return np.asarray((4.0 * slopes[1] - slopes[0]) / 3.0)


@pytest.mark.parametrize(("kind", "order"), FORMS)
@pytest.mark.parametrize("side", ["high", "low"])
@pytest.mark.parametrize("name", NAMES)
def test_gradients_agree_with_extrapolated_differences(name: str, side: Side, kind: str, order: int) -> None:
    quantity = of(name, side, kind, order)
    found = quantity.evaluate(COARSE, DESIGNS, gradients=True)
    assert found.gradients is not None
    # Two machines of a percentile that change places within the step are a step of the slope, of 1e-6 or so.
    size, within = (2e-7, 1e-5) if kind == "percentile" else (2e-5, 1e-7)
    slopes = np.stack([extrapolated(quantity, column, size) for column in range(3)], axis=1)
    assert np.abs(found.gradients - slopes).max() <= within * np.abs(slopes).max()


@pytest.mark.parametrize("name", NAMES)
def test_worst_case_is_the_worst_of_the_corners(name: str) -> None:
    for side, worst in (("high", np.max), ("low", np.min)):
        found = of(name, side, "worst case").evaluate(COARSE, DESIGNS).values  # type: ignore[arg-type]
        for design, value in zip(DESIGNS, found, strict=True):
            corners = machines(np.array(list(product((-1.0, 1.0), repeat=3))), design)
            assert value == pytest.approx(worst(QUANTITIES[name].evaluate(COARSE, corners).values), rel=1e-14)


@pytest.mark.parametrize("name", NAMES)
def test_no_machine_within_the_limits_is_worse_than_the_worst_case(name: str) -> None:
    drawn = np.random.default_rng(3).uniform(-1.0, 1.0, (2000, 3))
    for row, design in enumerate(DESIGNS):
        values = QUANTITIES[name].evaluate(COARSE, machines(drawn, design)).values
        high, low = (of(name, side, "worst case").evaluate(COARSE, DESIGNS).values[row] for side in ("high", "low"))
        assert low <= values.min()
        assert values.max() <= high
        assert high - low < 1.5 * (values.max() - values.min())  # and it is no idle bound


@pytest.mark.parametrize("name", NAMES)
def test_first_order_differs_from_the_corners_by_second_order(name: str) -> None:
    differences = []
    for scale in (1.0, 0.5):
        t = COARSE.tolerances
        crank, rod, offset = (
            Tolerance(absolute=scale * x.absolute, fraction=scale * x.fraction) for x in (t.crank, t.rod, t.offset)
        )
        machine = replace(COARSE, tolerances=Tolerances(crank=crank, rod=rod, offset=offset))
        first, exact = (of(name, "high", "worst case", order).evaluate(machine, DESIGNS).values for order in (1, 2))
        differences.append(np.abs(exact - first))
        margin = exact - QUANTITIES[name].evaluate(machine, DESIGNS).values
        assert (differences[-1] < 0.1 * margin).all()
    # Half the tolerances: a quarter of the remainder, but for the third order.
    noise = 1e-9 * QUANTITIES[name].evaluate(COARSE, DESIGNS).values
    assert np.abs(differences[1] - 0.25 * differences[0]) == pytest.approx(
        0.0, abs=float((0.05 * differences[0] + noise).max())
    )


@pytest.mark.parametrize("shape", ["normal", "uniform"])
def test_percentile_of_the_stroke_is_that_of_the_monte_carlo_simulation(shape: str) -> None:
    """Independent: the simulation's own draws, the linkage's own stroke, the sorted sample's own rank."""
    count = 400_000
    dimension = error_distribution(shape)  # type: ignore[arg-type]
    spreads = Spreads(crank=dimension, rod=dimension, offset=dimension)
    for row, (crank, rod, offset) in enumerate(DESIGNS):
        reach = limits_of_sources(COARSE, Linkage(crank, rod, offset))
        drawn = spreads.draw_errors(reach, count, np.random.default_rng([5, row]))
        stroke = np.sort(Linkage(crank + drawn.crank, rod + drawn.rod, offset + drawn.offset).stroke)
        for side, share in (("high", 0.99), ("low", 0.01)):
            found = of("stroke", side, shape=shape).evaluate(COARSE, DESIGNS).values[row]  # type: ignore[arg-type]
            # Five deviations of the simulation, and of uniform errors the sampling error of 2048 Sobol points.
            slack = 5.0 * np.sqrt(0.99 * 0.01 / count) + (0.0 if shape == "normal" else 2e-3)
            assert abs(np.searchsorted(stroke, found) / count - share) < slack


def test_seeds_of_a_percentile_agree() -> None:
    found = np.array([of("peak_torque", "high", seed=seed).evaluate(COARSE, DESIGNS).values for seed in range(6)])
    margin = found.mean(axis=0) - QUANTITIES["peak_torque"].evaluate(COARSE, DESIGNS).values
    assert (np.ptp(found, axis=0) < 0.01 * margin).all()
    assert (np.ptp(found, axis=0) > 0.0).all()


def test_percentile_across_the_kink_at_zero_offset_counts_machines() -> None:
    """There no quadratic serves: with zero offset the time ratio is 1 at best and more on both sides."""
    design = np.array([[0.05, 0.2, 1e-5]])
    machine = replace(COARSE, tolerances=Tolerances(offset=Tolerance(absolute=1e-3)))
    value = of("time_ratio", "high").evaluate(machine, design).values[0]
    errors = np.random.default_rng(7).normal(scale=1e-3 / 3.0, size=400_000)
    many = np.repeat(design, len(errors), axis=0) + np.outer(errors, [0.0, 0.0, 1.0])
    kept = (QUANTITIES["time_ratio"].evaluate(machine, many).values <= value).mean()
    assert kept == pytest.approx(0.99, abs=1e-3)  # 2048 points on one axis: half a point each end, 2.5e-4


@pytest.mark.parametrize(("kind", "order"), FORMS)
def test_without_tolerances_it_is_the_quantity_itself(kind: str, order: int) -> None:
    exact = replace(COARSE, tolerances=Tolerances(crank_angle=Tolerance(absolute=0.01)))
    for name in NAMES:
        plain = QUANTITIES[name].evaluate(exact, DESIGNS).values
        for side in ("high", "low"):
            assert np.array_equal(of(name, side, kind, order).evaluate(exact, DESIGNS).values, plain)


@pytest.mark.parametrize(("kind", "order"), FORMS)
def test_it_is_infinite_to_the_bad_side_where_tolerances_reach_locking(kind: str, order: int) -> None:
    tight = np.array([[0.05, 0.1003, 0.05]])
    assert of("peak_torque", "high", kind, order).evaluate(COARSE, tight).values[0] == np.inf
    assert of("transmission_angle", "low", kind, order).evaluate(COARSE, tight).values[0] == -np.inf


def test_it_is_the_same_where_another_process_takes_it_up() -> None:
    for inner in QUANTITIES.values():
        robust = RobustQuantity(inner=inner, side="low", case="worst case", order=1, suffix="low")
        taken = pickle.loads(pickle.dumps(robust))
        assert taken == robust
        assert (taken.inner, taken.title, taken.needs) == (inner, robust.title, inner.needs)


def test_names_and_fields_say_robust_before_the_unit() -> None:
    assert of("peak_torque", "high").name == "peak_torque_robust"
    assert of("peak_torque", "high").field == "peak_torque_robust_Nm"
    assert of("peak_slider_acceleration", "high").field.endswith("_robust_m_s2")
    assert of("time_ratio", "low").field == "time_ratio_robust"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"share": 1.0}, "below 1"),
        ({"share": 0.3}, "at least 0.5"),
        ({"samples": 10}, "64 to 65536"),
        ({"share": 0.9999}, "raise samples"),
        ({"order": 3}, "1 or 2"),
        ({"case": "best"}, "case"),
    ],
)
def test_options_out_of_range_are_refused(options: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        RobustQuantity(inner=QUANTITIES["stroke"], side="high", **options)  # type: ignore[arg-type]
