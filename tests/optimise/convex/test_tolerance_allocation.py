"""Tolerance allocation against closed forms of Lagrange multipliers, against SLSQP, and by its own prices."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
import scipy.optimize
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch, Clearances, Mechanism, Tolerance, Tolerances, Window
from slidercrank.model.tolerance.error_distributions import angle_ranges_where_error_counts
from slidercrank.model.tolerance.exact_worst_case import first_order_position_errors
from slidercrank.optimise.problem.tolerance_costs import NAMES, Cost, Costs
from slidercrank.optimise.sizing.input_words import Kind
from slidercrank.optimise.sizing.tolerance_allocation import Allocation, allocate_tolerances
from tests.model.cases import linkage_of, random_designs

Array = NDArray[np.float64]
search: Any = scipy.optimize.minimize  # its stubs have no array of constraints
KINDS: tuple[Kind, ...] = ("worst case", "rss")
SIEVE = Linkage(0.14, 0.31, 0.06)
PLAIN = Costs(
    crank=Cost(cost=4.0, at=5e-5),
    rod=Cost(cost=3.0, at=1e-4),
    offset=Cost(cost=2.0, at=1e-4),
    crank_angle=Cost(cost=5.0, at=1e-3),
)
WINDOWS = (Window(), Window(during="outward stroke", start=0.2, end=0.7), Window(start=0.1, end=0.4))


def random_costs(random: np.random.Generator, *, free: bool = False) -> Costs:
    def cost(at: float) -> Cost:
        if free:
            return Cost(cost=10.0 ** random.uniform(-1.0, 1.0), at=at, fixed=random.random())
        return Cost(
            cost=10.0 ** random.uniform(-1.0, 1.0),
            at=at,
            exponent=random.uniform(0.5, 3.0),
            least=float(random.choice([0.0, 0.5])) * at,
            greatest=float(random.choice([np.inf, 2.0])) * at,
        )

    return Costs(crank=cost(1e-4), rod=cost(1e-4), offset=cost(1e-4), crank_angle=cost(1e-3))


def values_of(found: Allocation) -> Array:
    return np.array([part.tolerance for part in found.parts])


def influence_sizes(linkage: Linkage, theta: Any) -> Array:
    sizes: Array = np.abs(np.stack(np.broadcast_arrays(*linkage.error_influences(theta))))
    return sizes


@pytest.mark.parametrize("kind", KINDS)
def test_with_one_active_angle_it_is_the_dearest_of_the_closed_forms_of_single_angles(kind: Kind) -> None:
    """An angle alone costs no more than all of them. With one active angle the cost is the greatest of theirs.

    Cost a + b / t, one angle: t_i ~ sqrt(b_i / |s_i|), the cost (sum sqrt(b_i |s_i|))^2 / limit (worst case), and
    t_i ~ (b_i / s_i^2)^(1/3), (sum (b_i |s_i|)^(2/3))^(3/2) / limit (root-sum-square).
    """
    random, limit, single = np.random.default_rng(1), 2e-4, 0
    power, root = (0.5, 2.0) if kind == "worst case" else (2.0 / 3.0, 1.5)
    for design in random_designs(9, seed=2, least_margin=0.05):
        linkage, costs = linkage_of(design), random_costs(random, free=True)
        found = allocate_tolerances(linkage, costs, limit, kind)
        b = np.array([cost.cost * cost.at for cost in costs.costs_by_name.values()])
        fixed = sum(cost.fixed for cost in costs.costs_by_name.values())

        def alone(theta: Any, b: Array = b, linkage: Linkage = linkage) -> Any:
            return np.sum((b * influence_sizes(linkage, theta).T) ** power, axis=-1) ** root / limit

        theta = np.linspace(0.0, 2.0 * np.pi, 3001)
        start = theta[alone(theta).argmax()]
        near = (start - 3e-3, start + 3e-3)
        top = minimize_scalar(lambda x: -alone(x), bounds=near, method="bounded", options={"xatol": 1e-10})
        assert found.cost >= (fixed - top.fun) * (1.0 - 1e-12)
        if len(found.angles) == 1:
            single += 1
            assert found.cost == pytest.approx(fixed - top.fun, rel=1e-10)
            s = influence_sizes(linkage, found.angles[0])
            shape = np.sqrt(b / s) if kind == "worst case" else (b / s**2) ** (1.0 / 3.0)
            size = np.sum(s * shape) if kind == "worst case" else np.sqrt(np.sum((s * shape) ** 2))
            np.testing.assert_allclose(values_of(found), limit * shape / size, rtol=1e-9)
            assert found.saving == pytest.approx(-top.fun / limit, rel=1e-9)  # the variable cost goes with 1 / limit
    assert single >= 5


def by_slsqp(mechanism: Mechanism, linkage: Linkage, costs: Costs, limit: float, found: Allocation) -> Array:
    """Return the tolerances of a sequential quadratic programme on many angles, from a start of its own."""
    power = 1 if found.kind == "worst case" else 2
    theta = np.concatenate(angle_ranges_where_error_counts(mechanism, linkage, count=300))
    near = np.concatenate([[angle + np.linspace(-2e-3, 2e-3, 41)] for angle in found.angles], axis=None)
    inside = [(part[0], part[-1]) for part in angle_ranges_where_error_counts(mechanism, linkage)]
    turns = near[:, None] + 2.0 * np.pi * np.array([-1.0, 0.0, 1.0])
    near = turns[np.any([(turns >= low) & (turns <= high) for low, high in inside], axis=0)]
    s = influence_sizes(linkage, np.concatenate([theta, near])) ** power / limit**power
    gap = mechanism.tolerances.clearances
    pins = np.array([gap.crank_pivot, gap.crank_pin, gap.slider_pin])
    room = 1.0 - np.sum(pins**power) * s[1] - gap.guide**power * s[2]
    each = list(costs.costs_by_name.values())
    unit = np.array([cost.at for cost in each])

    def cost(z: Array) -> float:
        return float(sum(c.cost_at(float(t)) for c, t in zip(each, unit * np.exp(z), strict=True)))

    def slope(z: Array) -> Array:
        return np.array([c.cost_slope(float(t)) * t for c, t in zip(each, unit * np.exp(z), strict=True)])

    start = np.full(4, np.log(0.5 * room.min() / (4.0 * s.max(axis=1) @ unit**power)) / power)
    bounds = [
        (np.log(c.least / c.at) if c.least else -12.0, np.log(c.greatest / c.at) if np.isfinite(c.greatest) else 12.0)
        for c in each
    ]
    scale = 1.0 / cost(start)
    done = search(
        lambda z: scale * cost(z),
        np.clip(start, *np.array(bounds).T),
        jac=lambda z: scale * slope(z),
        method="SLSQP",
        bounds=bounds,
        constraints={
            "type": "ineq",
            "fun": lambda z: room - (unit * np.exp(z)) ** power @ s,
            "jac": lambda z: -power * s.T * (unit * np.exp(z)) ** power,
        },
        options={"ftol": 1e-16, "maxiter": 500},
    )
    assert done.success or done.status == 8, done.message  # 8: no descent left within rounding
    found_there: Array = unit * np.exp(done.x)
    return found_there


@pytest.mark.parametrize("kind", KINDS)
def test_slsqp_on_many_angles_finds_the_same_tolerances(kind: Kind) -> None:
    """With bounds, clearances, exponents and windows."""
    random, limit, compared = np.random.default_rng(3), 3e-4, 0
    for n, design in enumerate(random_designs(7, seed=4, least_margin=0.1)):
        branch: Branch = "open" if n % 2 else "crossed"
        gap = Clearances(crank_pin=1e-5 * random.random(), slider_pin=1e-5 * random.random(), guide=1e-5)
        tolerances = Tolerances(clearances=gap, window=WINDOWS[n % 3])
        mechanism = Mechanism(speed=float(random.choice([-1.0, 1.0])), branch=branch, tolerances=tolerances)
        linkage, costs = linkage_of(design, branch), random_costs(random)
        try:
            found = allocate_tolerances(linkage, costs, limit, kind, mechanism=mechanism)
        except InputError:
            continue
        compared += 1
        there = by_slsqp(mechanism, linkage, costs, limit, found)
        cost = sum(c.cost_at(float(t)) for c, t in zip(costs.costs_by_name.values(), there, strict=True))
        assert found.cost == pytest.approx(cost, rel=1e-8)
        np.testing.assert_allclose(values_of(found), there, rtol=1e-6)
    assert compared >= 5


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("window", WINDOWS)
def test_the_error_reaches_the_limit_and_never_exceeds_it_in_the_working_stroke(kind: Kind, window: Window) -> None:
    for offset in (0.0, -0.02):
        found = allocate_tolerances(Linkage(SIEVE.crank, SIEVE.rod, offset), PLAIN, 1e-4, kind, window)
        linkage = Linkage(0.14, 0.31, offset)
        assert found.converged
        assert found.residual <= 1e-10
        assert found.error == pytest.approx(1e-4, rel=1e-10)
        theta = np.concatenate(angle_ranges_where_error_counts(found.mechanism, linkage, count=20_000))
        linear = first_order_position_errors(found.mechanism, linkage, theta)
        error = linear.worst_case if kind == "worst case" else linear.root_sum_square
        assert error.max() <= 1e-4 * (1.0 + 1e-10)
        assert error.max() >= 1e-4 * (1.0 - 1e-6)  # between samples 3e-4 rad apart
        linear = first_order_position_errors(found.mechanism, linkage, found.angles)
        error = linear.worst_case if kind == "worst case" else linear.root_sum_square
        np.testing.assert_allclose(error, 1e-4, rtol=1e-10)
    assert len(found.angles) == len(found.savings) >= 1


@pytest.mark.parametrize("kind", KINDS)
def test_prices_predict_what_loosening_a_limit_or_a_bound_by_one_percent_saves(kind: Kind) -> None:
    """To first order: what remains shrinks with the square of the step, tenfold relative to it."""
    costs = dataclasses.replace(
        PLAIN, rod=Cost(cost=3.0, at=1e-4, exponent=2.0, greatest=3e-5), offset=Cost(cost=0.01, at=1e-4, least=4e-5)
    )
    base = allocate_tolerances(SIEVE, costs, 2e-4, kind)
    assert [part.bound for part in base.parts] == [None, "greatest", "least", None]
    assert base.saving == pytest.approx(base.savings.sum(), rel=1e-14)

    def saved(share: float, which: str) -> tuple[float, float]:
        if which == "limit":
            return base.cost - allocate_tolerances(
                SIEVE, costs, 2e-4 * (1.0 + share), kind
            ).cost, base.saving * 2e-4 * share
        part = next(part for part in base.parts if part.name == which)
        cost = costs.costs_by_name[which]
        end = {"greatest": cost.greatest * (1.0 + share)} if which == "rod" else {"least": cost.least * (1.0 - share)}
        moved = dataclasses.replace(costs, **{which: dataclasses.replace(cost, **end)})
        return base.cost - allocate_tolerances(SIEVE, moved, 2e-4, kind).cost, part.saving * part.tolerance * share

    for which in ("limit", "rod", "offset"):
        coarse, fine = saved(1e-2, which), saved(1e-3, which)
        assert coarse[0] > 0.0
        assert coarse[0] == pytest.approx(coarse[1], rel=0.05)
        assert abs(fine[0] / fine[1] - 1.0) == pytest.approx(0.1 * abs(coarse[0] / coarse[1] - 1.0), rel=0.2)


@pytest.mark.parametrize("kind", KINDS)
def test_where_the_limit_is_wide_every_tolerance_is_the_greatest_and_only_its_bound_has_a_price(kind: Kind) -> None:
    cost = Cost(cost=3.0, at=1e-5, exponent=1.5, greatest=1e-5)
    found = allocate_tolerances(SIEVE, Costs(crank=cost, rod=cost), 1e-3, kind)
    assert [(part.tolerance, part.bound) for part in found.parts] == [(1e-5, "greatest")] * 2
    assert found.saving == 0.0
    assert len(found.angles) == 0
    assert found.error < 1e-3
    for part in found.parts:
        assert part.saving == pytest.approx(-cost.cost_slope(1e-5), rel=1e-12)


def test_a_tolerance_without_a_cost_is_given_and_takes_its_part_of_the_limit() -> None:
    """At the dead centres of a linkage in line dx = dr + dl. The crank has what the rod leaves of the limit."""
    given = Mechanism(tolerances=Tolerances(rod=Tolerance(fraction=1e-3), clearances=Clearances(crank_pin=1e-5)))
    tiny = Window(start=0.0, end=1e-9)
    costs = Costs(crank=Cost(cost=1.0, at=1e-4))
    found = allocate_tolerances(Linkage(0.05, 0.1), costs, 3e-4, "worst case", tiny, mechanism=given)
    assert found.parts[0].tolerance == pytest.approx(3e-4 - 1e-4 - 1e-5, rel=1e-6)
    assert found.mechanism.tolerances.rod == Tolerance(fraction=1e-3)
    square = allocate_tolerances(Linkage(0.05, 0.1), costs, 3e-4, "rss", tiny, mechanism=given)
    assert square.parts[0].tolerance == pytest.approx(np.sqrt(3e-4**2 - 1e-4**2 - 1e-5**2), rel=1e-6)


def test_squares_cost_less_than_sums() -> None:
    assert allocate_tolerances(SIEVE, PLAIN, 1e-4, "rss").cost < 0.75 * allocate_tolerances(SIEVE, PLAIN, 1e-4).cost


def test_what_can_not_be_met_or_makes_no_sense_is_refused() -> None:
    cost = Cost(cost=1.0, at=1e-4)
    wide = Costs(crank=Cost(cost=1.0, at=1e-4, least=1e-3))
    loose = Mechanism(tolerances=Tolerances(clearances=Clearances(crank_pin=2e-4)))
    for wrong, message in (
        (
            lambda: allocate_tolerances(SIEVE, wide, 1e-4),
            "the limit must exceed .* got 0.1 mm, below 1.*raise the limit",
        ),
        (lambda: allocate_tolerances(SIEVE, PLAIN, 1e-4, mechanism=loose), "the limit must exceed"),
        (lambda: allocate_tolerances(SIEVE, PLAIN, 0.0), "must be positive and finite; got 0 m"),
        (lambda: allocate_tolerances(SIEVE, PLAIN, 1e-4, "rms"), "kind must be"),  # type: ignore[arg-type]
        (lambda: allocate_tolerances(SIEVE, PLAIN, 1e-4, mechanism=Mechanism(branch="crossed")), "same branch"),
        (lambda: allocate_tolerances(Linkage(0.3, 0.31, 0.06), PLAIN, 1e-4), "full rotation"),
        (lambda: Costs(), "at least one of crank, rod"),
        (lambda: Cost(cost=0.0, at=1.0), "the cost of a tolerance's cost must be positive"),
        (lambda: Cost(cost=1.0, at=1.0, exponent=9.0), "exponent .* from 0.25 to 4; got 9"),
        (lambda: Cost(cost=1.0, at=1.0, fixed=-1.0), "fixed cost"),
        (lambda: Cost(cost=1.0, at=1.0, least=2.0, greatest=2.0), "below the greatest; got 2 to 2"),
    ):
        with pytest.raises(InputError, match=message):
            wrong()
    assert cost.cost_at(0.0) == np.inf
    assert list(PLAIN.costs_by_name) == list(NAMES)
