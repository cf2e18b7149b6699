"""The polish on analytic problems whose Pareto sets are known."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.optimise.search.piece_rows import Rows
from slidercrank.optimise.search.polish import ITERATIONS, make_convex, polish_designs
from slidercrank.optimise.search.polish_programme import FIRM, ROUNDING

Array = NDArray[np.float64]
Function = Callable[[Any, Any], Any]
STARTS = np.random.default_rng(2).random((40, 2))


class Analytic:
    """Objectives and constraints as functions of x and y in the unit square; slopes by complex step.

    goals: pieces by objective. limits: to be zero or less. inside: where points can be evaluated; others are an error.
    """

    def __init__(
        self,
        goals: list[list[Function]],
        limits: list[Function] | None = None,
        inside: Function = lambda x, y: np.ones(len(x), dtype=bool),
    ) -> None:
        self.goals = [(owner, piece) for owner, pieces in enumerate(goals) for piece in pieces]
        self.limits = list(enumerate(limits or []))
        self.inside = inside

    def can_evaluate(self, u: Array) -> NDArray[np.bool_]:
        return np.asarray(self.inside(*u.T))

    def objective_and_constraint_rows(self, u: Array) -> tuple[Rows, Rows]:
        assert self.can_evaluate(u).all()
        return self._rows(self.goals, u), self._rows(self.limits, u)

    @staticmethod
    def _rows(functions: list[tuple[int, Function]], u: Array) -> Rows:
        n, r = len(u), len(functions)
        x, y = u.T.astype(complex)
        values, slopes = np.zeros((n, r)), np.zeros((n, r, 2))
        for row, (_, function) in enumerate(functions):
            values[:, row] = np.broadcast_to(function(x, y), n).real
            slopes[:, row, 0] = np.broadcast_to(function(x + 1e-30j, y), n).imag / 1e-30
            slopes[:, row, 1] = np.broadcast_to(function(x, y + 1e-30j), n).imag / 1e-30
        labels = np.broadcast_to(np.arange(r, dtype=np.float64), (n, r)).copy()
        return Rows(values, slopes, labels, np.array([owner for owner, _ in functions], dtype=np.int64))


def squared(cx: float, cy: float) -> Function:
    """Return the squared distance to a point."""
    return lambda x, y: (x - cx) ** 2 + (y - cy) ** 2


ROUGH = Analytic(
    [
        [lambda x, y: np.sin(5.0 * x) + y * y, lambda x, y: 1.5 * x - y],
        [lambda x, y: np.cos(4.0 * y) * x + (x - 0.4) ** 2],
        [lambda x, y: np.exp(-x) + 0.3 * np.sin(7.0 * y)],
    ],
    [lambda x, y: x * x + y * y - 0.9, lambda x, y: 0.25 - x - y * y, lambda x, y: 0.3 * np.sin(6.0 * x) - y],
)
"""Three objectives, one with two pieces, none convex, with curved constraints."""


def test_designs_reach_the_segment_between_two_centres() -> None:
    """The Pareto set of two squared distances is the segment between their centres."""
    found = polish_designs(Analytic([[squared(0.2, 0.3)], [squared(0.8, 0.7)]]), STARTS, np.ones(2))
    along = np.array([0.6, 0.4]) / np.hypot(0.6, 0.4)
    apart = found.u - [0.2, 0.3]
    assert np.abs(apart @ np.array([-along[1], along[0]])).max() <= 1e-6
    assert (apart @ along).min() >= -1e-6
    assert (apart @ along).max() <= np.hypot(0.6, 0.4) + 1e-6
    assert found.residual.max() <= 1e-6


def test_a_kink_is_found_as_a_minimax() -> None:
    """The greatest of two squared distances is least half-way, where both tie."""
    found = polish_designs(Analytic([[squared(0.2, 0.3), squared(0.8, 0.7)]]), STARTS, np.ones(1))
    assert found.u == pytest.approx(np.tile([0.5, 0.5], (40, 1)), abs=1e-6)
    assert found.residual.max() <= 1e-6
    assert all(len(owner) == 2 for owner, _ in found.goals)


def test_a_kink_of_three_pieces_has_no_smooth_direction_left() -> None:
    """The greatest of x, y and 1 - x - y is least where all are 1/3."""
    pieces: list[Function] = [lambda x, y: x, lambda x, y: y, lambda x, y: 1.0 - x - y]
    found = polish_designs(Analytic([pieces]), STARTS, np.ones(1))
    assert found.u == pytest.approx(np.full((40, 2), 1.0 / 3.0), abs=1e-9)


def test_a_linear_constraint_holds_and_an_infeasible_start_is_led_back() -> None:
    """Least distance to (0.9, 0.9) with x + y <= 1 is at (0.5, 0.5)."""
    found = polish_designs(Analytic([[squared(0.9, 0.9)]], [lambda x, y: x + y - 1.0]), STARTS, np.ones(1))
    assert found.u == pytest.approx(np.tile([0.5, 0.5], (40, 1)), abs=1e-6)
    assert found.violation.max() <= 1e-12


def test_designs_do_not_creep_along_a_curved_constraint() -> None:
    """Greatest x + 2 y on a disc. Steps along the edge leave it to second order, which a merit function refuses."""
    found = polish_designs(
        Analytic([[lambda x, y: -x - 2.0 * y]], [lambda x, y: x * x + y * y - 0.5]), STARTS, np.ones(1), iterations=25
    )
    best = np.array([1.0, 2.0]) * np.sqrt(0.1)
    assert found.u == pytest.approx(np.tile(best, (40, 1)), abs=1e-6)
    assert found.violation.max() <= 1e-12
    assert found.residual.max() <= 1e-6


def test_a_curved_equality_is_met_from_anywhere() -> None:
    """Two rows keep the hyperbola x y = 0.2. Nearest to (0.1, 0.1) on it is x = y = sqrt(0.2)."""
    rows: list[Function] = [lambda x, y: x * y / 0.2 - 1.0, lambda x, y: 1.0 - x * y / 0.2]
    found = polish_designs(Analytic([[squared(0.1, 0.1)]], rows), STARTS, np.ones(1))
    assert found.u == pytest.approx(np.full((40, 2), np.sqrt(0.2)), abs=1e-6)
    assert found.violation.max() <= 1e-12


def test_a_bent_valley_is_followed_to_its_end() -> None:
    """Rosenbrock's function on [-1, 2] x [-1, 2], least at (1, 1)."""

    def valley(x: Any, y: Any) -> Any:
        x, y = 3.0 * x - 1.0, 3.0 * y - 1.0
        return (1.0 - x) ** 2 + 100.0 * (y - x * x) ** 2

    found = polish_designs(Analytic([[valley]]), STARTS, np.array([np.ptp(valley(*STARTS.T))]))
    assert found.u == pytest.approx(np.full((40, 2), 2.0 / 3.0), abs=1e-4)


def test_the_box_holds() -> None:
    found = polish_designs(Analytic([[squared(1.5, 0.4)]]), STARTS, np.ones(1))
    assert found.u == pytest.approx(np.tile([1.0, 0.4], (40, 1)), abs=1e-9)
    assert found.residual.max() <= 1e-9


def test_objectives_that_oppose_each_other_exactly_leave_designs_where_they_are() -> None:
    found = polish_designs(Analytic([[lambda x, y: x * y], [lambda x, y: -x * y]]), STARTS, np.ones(2))
    start = np.prod(STARTS, axis=1)
    assert found.values[:, 0] == pytest.approx(start, abs=1e-8)
    assert found.residual.max() <= 1e-12


def test_what_can_be_had_for_nothing_is_taken() -> None:
    """Two objectives that oppose each other make every design stationary, yet the third is still to be had."""
    found = polish_designs(Analytic([[lambda x, y: x], [lambda x, y: -x], [squared(0.5, 0.7)]]), STARTS, np.ones(3))
    assert found.u[:, 0] == pytest.approx(STARTS[:, 0], abs=1e-7)
    assert found.u[:, 1] == pytest.approx(np.full(40, 0.7), abs=1e-7)


def test_only_the_chosen_objective_is_improved() -> None:
    found = polish_designs(Analytic([[squared(0.2, 0.3)], [squared(0.8, 0.7)]]), STARTS, np.ones(2), chosen=(1,))
    assert found.u == pytest.approx(np.tile([0.8, 0.7], (40, 1)), abs=1e-6)
    assert found.residual.max() <= 1e-6


def test_no_objective_gets_worse_from_a_feasible_start() -> None:
    """By more than a thousandth of what the others gain: so much more does the merit weigh a loss."""
    _, limits = ROUGH.objective_and_constraint_rows(STARTS)
    start = STARTS[limits.values.max(axis=1) <= 0.0]
    assert len(start) >= 10
    before = polish_designs(ROUGH, start, np.ones(3), iterations=0)
    after = polish_designs(ROUGH, start, np.ones(3))
    change = after.values - before.values
    assert (change.sum(axis=1) <= 0.0).all()
    assert change.max() <= 1e-3
    assert after.violation.max() <= 1e-12
    assert after.residual.max() <= 1e-6


@pytest.mark.parametrize("iterations", [1, 2, 3, 5, 8])
def test_a_feasible_design_is_feasible_whenever_the_polish_ends(iterations: int) -> None:
    _, limits = ROUGH.objective_and_constraint_rows(STARTS)
    start = STARTS[limits.values.max(axis=1) <= 0.0]
    assert polish_designs(ROUGH, start, np.ones(3), iterations=iterations).violation.max() <= 1e-12


def test_an_infeasible_start_is_moved_onto_curved_constraints() -> None:
    _, limits = ROUGH.objective_and_constraint_rows(STARTS)
    start = STARTS[limits.values.max(axis=1) > 1e-3]
    assert len(start) >= 10
    assert (polish_designs(ROUGH, start, np.ones(3)).violation <= 1e-12).all()


def test_contradicting_constraints_end_without_an_error() -> None:
    limits: list[Function] = [lambda x, y: x - 0.3, lambda x, y: 0.6 - x]
    found = polish_designs(Analytic([[squared(0.5, 0.5)]], limits), STARTS, np.ones(1))
    assert found.violation.min() >= 0.15 - 1e-9
    assert np.isfinite(found.u).all()


def test_designs_without_room_to_move_stay() -> None:
    found = polish_designs(Analytic([[squared(0.2, 0.3)]]), STARTS, np.ones(1), iterations=0)
    assert np.array_equal(found.u, STARTS)
    assert found.values[:, 0] == pytest.approx(((STARTS - [0.2, 0.3]) ** 2).sum(axis=1), rel=1e-14)


@pytest.mark.parametrize("size", [1e-8, 1e8])
def test_the_size_of_an_objective_does_not_matter_beside_its_scale(size: float) -> None:
    """Same steps but for rounding of the multiplication, which the way to a kink does not amplify."""
    pieces: list[Function] = [squared(0.2, 0.3), squared(0.8, 0.7)]
    large: list[Function] = [lambda x, y: size * squared(0.2, 0.3)(x, y), lambda x, y: size * squared(0.8, 0.7)(x, y)]
    one = polish_designs(Analytic([pieces, [squared(0.9, 0.1)]]), STARTS, np.ones(2))
    other = polish_designs(Analytic([large, [squared(0.9, 0.1)]]), STARTS, np.array([size, 1.0]))
    assert other.values == pytest.approx(one.values, abs=1e-6)


def test_points_that_cannot_be_evaluated_are_never_asked_for() -> None:
    """The optimum lies beyond the edge of what can be evaluated, as where a linkage locks."""

    def inside(x: Any, y: Any) -> Any:
        return x + y < 1.1

    start = STARTS[STARTS.sum(axis=1) < 1.0]
    found = polish_designs(Analytic([[squared(0.9, 0.9)]], inside=inside), start, np.ones(1))
    assert inside(*found.u.T).all()
    assert (found.values[:, 0] <= ((start - 0.9) ** 2).sum(axis=1)).all()


def test_a_direction_that_nothing_depends_on_stiffens_no_other() -> None:
    """A pin's diameter that no row has leaves the Hessian of all else as it is."""
    random = np.random.default_rng(5)
    for _ in range(20):
        root = random.standard_normal((4, 4))
        hessian, normals = np.zeros((5, 5)), np.zeros((2, 5))
        hessian[:4, :4], normals[:, :4] = root @ root.T + 0.1 * np.eye(4), random.standard_normal((2, 4))
        np.testing.assert_allclose(make_convex(hessian, normals)[:4, :4], hessian[:4, :4], rtol=1e-9, atol=1e-9)
        # What bends down across the rows is mended there alone, with the flat direction beside it.
        along = np.linalg.svd(normals)[2][2:]
        held = normals.T @ np.diag(random.uniform(-30.0, -10.0, 2)) @ normals
        mended = make_convex(hessian + held, normals)
        assert np.linalg.eigvalsh(mended)[0] > 0.0
        np.testing.assert_allclose(along @ mended @ along.T, along @ hessian @ along.T, rtol=1e-3, atol=1e-3)


def test_a_design_that_is_best_in_an_objective_stays_so_where_its_slope_vanishes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """At the minimum of c x**2 only curvature holds it: weight K permits a loss of 1/(4 K**2 c).

    Each step may also lose the amount that counts as rounding, and on some processors it does.
    """
    goals = Analytic([[lambda x, y: 0.1 * (x - 0.5) ** 2], [lambda x, y: -x]])
    given = (goals, np.array([[0.5, 0.0]]), np.ones(2))
    loose, firm = polish_designs(*given), polish_designs(*given, best_in=np.array([0]))
    assert 1e-7 < loose.values[0, 0] < 3e-6
    assert firm.values[0, 0] < 1.0 / (4.0 * FIRM**2 * 0.1) + ITERATIONS * ROUNDING
    monkeypatch.setattr("slidercrank.optimise.search.polish_programme.ROUNDING", 1e-14)
    assert polish_designs(*given, best_in=np.array([0])).values[0, 0] < 1e-11


def test_a_design_that_is_best_in_an_objective_gains_in_others_where_that_costs_nothing() -> None:
    goals = Analytic([[lambda x, y: (x - 0.5) ** 2], [lambda x, y: (y - 0.8) ** 2 - 0.1 * x]])
    found = polish_designs(goals, np.array([[0.5, 0.1]]), np.ones(2), best_in=np.array([0]))
    np.testing.assert_allclose(found.u, [[0.5, 0.8]], atol=1e-5)
