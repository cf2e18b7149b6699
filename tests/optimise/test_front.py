"""Characteristics of a front: extremes, knee, picks, trade-off rates."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.decisions.similar_design import like
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Sense
from slidercrank.optimise.solve import solve
from tests.optimise.independent import Array
from tests.optimise.problems import Bounds, degrees, problem, shipped_front

pytestmark = pytest.mark.usefixtures("few")

HELD: dict[str, Bounds] = {"stroke": 0.2, "transmission_angle": (degrees(30.0), None)}
WISHES: dict[str, Sense] = {"peak_torque": "minimise", "time_ratio": "maximise"}


@lru_cache(maxsize=1)
def pair() -> ParetoFront:
    """Return a front of two objectives: torque against time ratio."""
    return solve(problem(WISHES, HELD, designs=30))


def with_values(values: list[list[float]]) -> ParetoFront:
    """Return a front with other objective values, as they are minimised."""
    table = np.array(values)
    first = pair()
    return replace(first, values=table, columns={name: column[: len(table)] for name, column in first.columns.items()})


def test_the_table_is_sorted_by_the_first_objective() -> None:
    for front in (pair(), shipped_front("feeder"), shipped_front("turning_support")):
        assert (np.diff(front.values[:, 0]) >= 0.0).all()
        assert len(front) == len(front.designs) == len(front.dimensions) == len(front.goals) == len(front.active)
        assert front.designs["crank_mm"].to_numpy() == pytest.approx(1e3 * front.dimensions[:, 0], rel=1e-15)


def test_extremes_are_the_best_of_each_objective() -> None:
    front = shipped_front("feeder")
    extremes = front.extremes()
    assert list(extremes) == [objective.quantity for objective in front.objectives]
    for column, row in enumerate(extremes.values()):
        assert front.values[row, column] <= front.values[:, column].min() + 1e-9 * np.ptp(front.values[:, column])


def test_a_tie_for_an_extreme_goes_to_the_better_in_the_other_objectives() -> None:
    front = with_values([[0.0, 5.0], [0.0, 3.0], [1.0, 2.0]])
    assert front.extremes() == {"peak_torque": 1, "time_ratio": 2}


def test_the_knee_is_nearest_to_the_ideal() -> None:
    """Scaled by their ranges the designs lie 1, 0.5 sqrt(2) and 1 away, and 0.36 sqrt(2) at the knee."""
    front = with_values([[0.0, 100.0], [4.0, 36.0], [5.0, 50.0], [10.0, 0.0]])
    assert front.knee() == 1


def test_the_best_of_what_lies_within_bounds_is_picked() -> None:
    front = pair()
    row = front.pick("peak_torque", time_ratio=(1.15, 1.25), rod_mm=(None, 400.0))
    table = front.designs
    allowed = table[(table["time_ratio"] >= 1.15) & (table["time_ratio"] <= 1.25) & (table["rod_mm"] <= 400.0)]
    assert table["peak_torque_Nm"][row] == allowed["peak_torque_Nm"].min()
    best = front.pick("time_ratio")
    assert table["time_ratio"][best] == table["time_ratio"].max()


def test_bounds_of_a_pick_may_be_formulas() -> None:
    front = pair()
    lengths = front.dimensions
    for formula, values in (
        ("2 * crank + rod", 2.0 * lengths[:, 0] + lengths[:, 1]),
        ("rod/crank", lengths[:, 1] / lengths[:, 0]),
    ):
        bound = float(np.median(values))
        row = front.pick("peak_torque", **{formula: (bound, None)})
        assert values[row] >= bound
        assert front.values[row, 0] == front.values[values >= bound, 0].min()
    with pytest.raises(InputError, match='is called "crnk"; did you mean crank'):
        front.pick("peak_torque", **{"crnk / rod": (1.0, None)})


def test_a_pick_says_what_is_wrong_with_it() -> None:
    with pytest.raises(InputError, match="one of the objectives peak_torque, time_ratio; got 'stroke'"):
        pair().pick("stroke")
    with pytest.raises(InputError, match="no column 'torque'"):
        pair().pick("peak_torque", torque=(1.0, None))
    with pytest.raises(InputError, match="widen a bound"):
        pair().pick("peak_torque", time_ratio=(9.0, None))


def test_an_empty_front_points_to_its_message() -> None:
    front = replace(pair(), values=np.zeros((0, 2)), columns={}, dimensions=np.zeros((0, 3)))
    for ask in (front.extremes, front.knee):
        with pytest.raises(InputError, match="see its message"):
            ask()


def least_torque(ratio: float) -> float:
    """Return the least peak torque with a time ratio of at least `ratio`, N m."""
    held: dict[str, Bounds] = {**HELD, "time_ratio": (ratio, None)}
    return float(solve(problem({"peak_torque": "minimise"}, held)).values[0, 0])


@pytest.mark.parametrize("share", [0.3, 0.5, 0.7])
def test_rates_of_two_objectives_are_the_slope_of_the_front(share: float) -> None:
    """The slope from the least torques with a little more and a little less time ratio. Its error is a few 1e-6."""
    front = pair()
    row = int(share * len(front))
    ratio, step = float(front.designs["time_ratio"][row]), 1e-4
    if abs(least_torque(ratio) - front.values[row, 0]) > 1e-9 * front.values[row, 0]:
        pytest.fail("the design is not the best with its time ratio")
    slope = (least_torque(ratio + step) - least_torque(ratio - step)) / (2.0 * step)
    rates = front.rates(row)
    assert rates[0, 1] == pytest.approx(slope, rel=1e-3)
    assert rates[1, 0] == pytest.approx(1.0 / slope, rel=1e-3)
    assert np.isnan(np.diag(rates)).all()


def moved(front: ParetoFront, row: int, losses: Array, b: int, gain: float) -> Problem:
    """Return the problem to improve objective b while the others lose at most what they are said to."""
    held: dict[str, Bounds] = {c.quantity: (c.lower, c.upper) for c in front.problem.constraints}
    for column, objective in enumerate(front.objectives):
        if column != b:
            worst = front.values[row, column] + losses[column] * gain
            held[objective.quantity] = (-worst, None) if objective.sense == "maximise" else (None, worst)
    wish: dict[str, Sense | float] = {front.objectives[b].quantity: front.objectives[b].sense}
    return problem(wish, held)


def test_rates_of_three_objectives_say_what_a_gain_takes() -> None:
    """Whoever grants the losses of the rates times a small step gains that step, to second order, and hardly more."""
    wishes: dict[str, Sense] = {"peak_torque": "minimise", "time_ratio": "maximise", "transmission_angle": "maximise"}
    front = solve(problem(wishes, {"stroke": 0.2, "transmission_angle": (degrees(30.0), None)}, designs=40))
    units = np.array([1.0, 1.0, np.degrees(1.0)])
    checked = 0
    for row in (10, 20, 30):
        rates = front.rates(row)
        for b in range(3):
            if np.isnan(rates[:, b]).sum() > 1:
                continue
            losses = np.where(np.arange(3) == b, 0.0, rates[:, b]) * units[b] / units
            gain = 1e-3 * float(np.ptp(front.values[:, b]))
            found = solve(moved(front, row, losses, b, gain))
            assert front.values[row, b] - found.values[0, 0] == pytest.approx(gain, rel=0.05)
            checked += 1
    assert checked >= 6


def test_what_cannot_gain_has_no_rates() -> None:
    front = pair()
    extremes = front.extremes()
    assert np.isnan(front.rates(extremes["peak_torque"])[:, 0]).all()
    assert np.isnan(front.rates(extremes["time_ratio"])[:, 1]).all()
    alone = solve(problem({"peak_torque": "minimise"}, HELD))
    assert np.isnan(alone.rates(0)).all()


CHANGE = re.compile(r"([\d.e+-]+)(?: (?:N m|N|deg|mm|m\^2))? (?:less|more) ([a-z, ]+?)(?= costs| and|$)")


@pytest.mark.parametrize("name", ["pair", "feeder", "sieve", "turning_support"])
def test_trade_offs_stay_within_the_front(name: str) -> None:
    """No step beyond the best value of the front, no cost beyond its worst. At an extreme this is said instead."""
    front = pair() if name == "pair" else shipped_front(name)
    titles = {front.problem.quantity(item.quantity).title: column for column, item in enumerate(front.objectives)}
    units = np.array([front.problem.quantity(item.quantity).unit.factor for item in front.objectives])
    values, best, worst = front.values * units, front.values.min(axis=0) * units, front.values.max(axis=0) * units
    told = 0
    for row in range(0, len(front), max(1, len(front) // 25)):
        for sentence in front.trade_offs(row):
            if "target" in sentence:
                continue
            ended = re.fullmatch(r"no design on the front has (less|more) ([a-z, ]+)", sentence)
            if ended is not None:
                column = titles[ended[2]]
                assert values[row, column] == pytest.approx(best[column], rel=1e-6)
                assert front.objectives[column].sense == {"less": "minimise", "more": "maximise"}[ended[1]]
                continue
            (step, gained), *costs = CHANGE.findall(sentence)
            assert float(step) <= (values[row, titles[gained]] - best[titles[gained]]) * (1.0 + 1e-9)
            seen = [
                payer
                for payer, rate in enumerate(front.rates(row)[:, titles[gained]])
                if float(step) * rate > 1.01e-4 * (worst[payer] - best[payer])
            ]
            assert len(seen) <= len(costs)
            assert costs or sentence.endswith(" costs almost nothing")
            for cost, lost in costs:
                assert float(cost) <= (worst[titles[lost]] - values[row, titles[lost]]) * (1.0 + 5e-3)  # three digits
            told += 1
    assert told > 10
    for quantity, row in front.extremes().items():
        title = front.problem.quantity(quantity).title
        assert any(re.fullmatch(f"no design on the front .* {title}", said) for said in front.trade_offs(row))


def test_what_is_the_same_in_all_designs_is_not_traded() -> None:
    front = pair()
    bits = np.spacing(abs(front.values[0, 1])) * (np.arange(len(front)) % 3)
    flat = replace(front, values=np.column_stack([front.values[:, 0], front.values[0, 1] + bits]))
    assert not any(
        "time ratio" in said.split(" costs ")[0] for row in range(len(flat)) for said in flat.trade_offs(row)
    )


def test_trade_offs_are_the_rates_in_words() -> None:
    front = pair()
    row = len(front) // 2
    rates = front.rates(row)
    sentences = front.trade_offs(row)
    assert len(sentences) == 2
    more = re.fullmatch(r"(\S+) more time ratio costs (\S+) N m more peak torque", sentences[1])
    less = re.fullmatch(r"(\S+) N m less peak torque costs (\S+) less time ratio", sentences[0])
    assert more is not None
    assert less is not None
    assert float(more[2]) == pytest.approx(float(more[1]) * rates[0, 1], rel=5e-3)
    assert float(less[2]) == pytest.approx(float(less[1]) * rates[1, 0], rel=5e-3)


def test_trade_offs_with_a_target_speak_of_the_distance_to_it() -> None:
    wishes: dict[str, Sense | float] = {"time_ratio": 1.4, "transmission_angle": "maximise"}
    front = solve(problem(wishes, HELD))
    text = " ".join(front.trade_offs(len(front) // 2))
    assert "time ratio" in text
    assert "nearer to its target costs" in text
    assert "farther from its target" in text


def test_every_front_says_how_it_was_made() -> None:
    front = pair()
    assert front.seed == front.problem.settings.seed
    assert front.evaluations == front.history[-1].evaluations or front.evaluations > front.history[-1].evaluations
    assert {"python", "numpy", "scipy", "numba", "moocore", "pandas", "slidercrank"} <= set(front.versions)
    assert front.seconds > 0.0
    assert f"{len(front)} designs" in front.message


@pytest.mark.parametrize("row", [999, -999, 1.5, "knee"])
def test_a_row_that_is_none_of_the_front_is_refused_in_a_sentence(row: Any) -> None:
    front = pair()
    asks = (front.part, front.mechanism, front.rates, front.trade_offs, lambda row: like(front, row))
    for ask in asks:
        with pytest.raises(InputError, match=f"a row must be one of the front's rows 0 to 29; got {row!r}"):
            ask(row)
