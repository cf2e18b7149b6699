"""Designs by wishing: least achievement function, stationary, undominated; wishes that make no sense are refused."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

from slidercrank.model.arrays import Array
from slidercrank.model.errors import InputError
from slidercrank.optimise.decisions.wish import Wishes, wish
from slidercrank.optimise.decisions.wishes import Wished, minimised_aim
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job.problem_from_tables import problem as stated
from slidercrank.optimise.methods.scalar_objective import SUM
from slidercrank.optimise.problem.table_columns import choice_field
from slidercrank.optimise.solve import solve
from tests.case_count import case_count
from tests.optimise.achievement import Independent, StoredObjective
from tests.optimise.problems import JOBS, Bounds, degrees, problem, shipped_front

pytestmark = pytest.mark.usefixtures("little")

HELD: dict[str, Bounds] = {"stroke": 0.2, "transmission_angle": (degrees(30.0), None)}
LOOSE: dict[str, Bounds] = {"stroke": (0.19, 0.21), "transmission_angle": (degrees(30.0), None)}
CHOICE = {
    "name": "choice",
    "mechanism": {
        "speed": "60 rpm",
        "slider": {"mass": "2 kg"},
    },
    "load": [{"force": "40 N", "opposes": "motion"}],
    "variables": {
        "crank": ["20 mm", "200 mm"],
        "rod": ["60 mm", "600 mm"],
        "offset": ["0 mm", "100 mm"],
        "mechanism.slider.mass": ["1 kg", "4 kg"],
    },
    "constraints": {"stroke": {"equals": "150 mm"}},
    "objectives": {"peak_torque": "minimise", "moving_mass": "maximise", "time_ratio": "maximise"},
    "choice": [
        {
            "name": "speed",
            "option": [
                {"name": "slow", "values": {"mechanism.speed": "60 rpm", "rod": ["60 mm", "240 mm"]}},
                {"name": "fast", "values": {"mechanism.speed": "66 rpm"}},
            ],
        }
    ],
    "optimiser": {"designs": 12},
}


@lru_cache(maxsize=4)
def front(kind: str = "torque") -> ParetoFront:
    """Return a small front: with a torque, a choice and a varying number, or a target and nothing eliminated."""
    if kind == "torque":
        wanted = problem({"peak_torque": "minimise", "time_ratio": "maximise", "footprint": "minimise"}, HELD)
    elif kind == "choice":
        wanted = stated(CHOICE)
    else:
        wanted = problem({"time_ratio": 1.2, "peak_torque": "minimise", "footprint": "minimise"}, LOOSE)
    return solve(wanted)


def random_wish(of: ParetoFront, random: np.random.Generator) -> tuple[dict[str, object], int | None]:
    """Return a wish for some objectives, values within and around the front, or classes relative to a design."""
    names = [objective.quantity for objective in of.objectives]
    values = {}
    for name in names:
        unit = of.problem.quantity(name).unit
        column = of.columns[of.problem.quantity(name).field]
        values[name] = float(column.min() + random.uniform(-0.2, 1.2) * np.ptp(column)) / unit.factor
    if random.random() < 0.6:
        some = [name for name in names if random.random() < 0.7] or names[:1]
        return {name: values[name] for name in some}, None
    row = int(random.integers(len(of)))
    given: dict[str, object] = {name: str(random.choice(["improve", "keep", "free"])) for name in names}
    given[names[0]] = "improve"
    given[names[-1]] = str(random.choice(["free", "limit"]))
    if given[names[-1]] == "limit":
        quantity = of.problem.quantity(names[-1])
        worst = of.columns[quantity.field][int(np.argmax(of.values[:, -1]))]
        given[names[-1]] = f"may worsen to {float(worst)!r} {quantity.unit.symbol}"
    return given, row


def independent(of: ParetoFront, answer: Wished) -> list[Independent]:
    """Return the achievement function of a wish for every option of the problem, stated anew."""
    ideal, m = of.values.min(axis=0), len(of.objectives)
    span = np.ptp(of.values, axis=0)
    weights, reference, ceilings = np.zeros(m), np.zeros(m), np.full(m, np.inf)
    for column, item in enumerate(answer.wishes):
        own = np.inf if answer.row is None else (of.values[answer.row, column] - ideal[column]) / span[column]
        if item.kind in ("value", "limit"):
            scaled = (minimised_aim(of, column, item) - ideal[column]) / span[column]
            if item.kind == "value":
                weights[column], reference[column] = 1.0, scaled
            else:
                ceilings[column] = scaled
        elif item.kind != "free":
            weights[column], ceilings[column] = float(item.kind == "improve"), own
    wanted = StoredObjective(weights, reference, ceilings, SUM, ideal, span)
    return [Independent(part, wanted) for part in of.problem.parts()]


def compare(of: ParetoFront, wishes: int, starts: int, seed: int) -> None:
    """Compare random wishes with the independent solve, and ask for stationarity."""
    random, asked = np.random.default_rng(seed), Wishes(of)
    for _ in range(wishes):
        given, row = random_wish(of, random)
        answer = asked.design_nearest_to_wishes(given, row=row)
        assert answer.found.columns["residual"][0] <= 1e-6
        others = independent(of, answer)
        assert answer.value == pytest.approx(_least(others, answer.found.dimensions[0]), abs=1e-7), given
        near = np.argsort([_least(others, design) for design in of.dimensions])[:3]
        some = np.union1d(near, random.choice(len(of), min(starts, len(of)), replace=False))
        best = min(other.minimum(of.dimensions[some]) for other in others)
        assert answer.value == pytest.approx(best, abs=1e-6), (given, row)


def _least(options: list[Independent], design: Array) -> float:
    """Return the least value of the achievement function of a design over the options."""
    return min(option.value(design) for option in options)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["torque", "target", "choice"])
def test_a_wish_is_the_least_of_the_achievement_function(kind: str) -> None:
    """SLSQP from many starts, on the public `evaluate`, finds no less."""
    compare(front(kind), case_count(1, 2), 1, 3)


@pytest.mark.slow
@pytest.mark.parametrize("job", JOBS[:2])
def test_wishes_of_a_shipped_job(job: str) -> None:
    compare(shipped_front(job), case_count(1, 2), 2, 5)


def test_a_wish_at_a_design_of_the_front_gives_it_back() -> None:
    of = front()
    span = np.ptp(of.values, axis=0)
    for row in range(0, len(of), 5):
        given = {
            objective.quantity: float(of.columns[of.problem.quantity(objective.quantity).field][row])
            / of.problem.quantity(objective.quantity).unit.factor
            for objective in of.objectives
        }
        answer = wish(of, given)
        assert ((answer.found.values[0] - of.values[row]) / span).max() <= 1e-6


def test_what_can_be_had_is_had_and_better() -> None:
    of = front()
    worse = of.values[len(of) // 2] + 0.05 * np.ptp(of.values, axis=0)
    answer = wish(of, {"peak_torque": worse[0], "time_ratio": -worse[1], "footprint": worse[2]})
    assert answer.possible
    assert (answer.found.values[0] < worse).all()
    assert answer.sentences()[0] == "the wish can be met and exceeded in every objective"
    assert "better than the" in answer.sentences()[1]


def test_what_cannot_be_had_gives_way_evenly() -> None:
    of = front()
    span, ideal = np.ptp(of.values, axis=0), of.values.min(axis=0)
    aim = ideal - 0.1 * span
    answer = wish(of, {"peak_torque": aim[0], "time_ratio": -aim[1]})
    short = (answer.found.values[0] - aim)[:2] / span[:2]
    assert not answer.possible
    assert short[0] == pytest.approx(short[1], abs=1e-6)
    assert "it must be relaxed by" in answer.sentences()[1]


def test_a_choice_is_free_again() -> None:
    """Wishes for a job with a choice lead to the option that a front of each option has best."""
    light = {"name": "light", "values": {"rod": ["60 mm", "200 mm"]}}
    heavy = {"name": "heavy", "values": {"mechanism.slider.mass": "4 kg"}}
    tables = {
        "name": "choice",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "2 kg"}},
        "variables": {"crank": ["20 mm", "200 mm"], "rod": ["60 mm", "600 mm"], "offset": ["0 mm", "100 mm"]},
        "constraints": {"stroke": {"equals": "150 mm"}},
        "objectives": {"peak_torque": "minimise", "time_ratio": "maximise"},
        "choice": [{"name": "slider", "option": [light, heavy]}],
        "optimiser": {"designs": 12},
    }
    of = solve(stated(tables))
    asked, labels = Wishes(of), set()
    for row in range(len(of)):
        given = {"time_ratio": -of.values[row, 0], "peak_torque": of.values[row, 1]}
        answer = asked.design_nearest_to_wishes(given)
        labels.add(answer.found.columns[choice_field("slider")][0])
        assert ((answer.found.values[0] - of.values[row]) / np.ptp(of.values, axis=0)).max() <= 1e-6
    assert labels == set(of.columns[choice_field("slider")])


def test_nothing_within_what_is_allowed_is_said() -> None:
    answer = wish(front(), {"time_ratio": 1.3, "footprint": "may worsen to 1 mm^2"})
    assert (len(answer), answer.possible) == (0, False)
    assert "no design was found with footprint" in answer.sentences()[0]


REFUSED: dict[str, tuple[object, int | None, str]] = {
    "nothing": ({}, None, "no wish was given"),
    "all free": ({"peak_torque": "free"}, None, "no wish was given"),
    "no number": ({"peak_torque": float("nan")}, None, "must be a finite number; got nan"),
    "infinite": ({"peak_torque": "inf"}, None, "must be a finite number"),
    "another unit": ({"peak_torque": "5 mm"}, None, 'must be a torque; got "5 mm", which is a length'),
    "no unit": ({"peak_torque": "110"}, None, "with its unit"),
    "no word": ({"peak_torque": "better"}, None, 'a wish must be a value such as "25 N m", "improve"'),
    "no objective": ({"stroke": 0.2}, None, "one of the objectives peak_torque, time_ratio, footprint; got 'stroke'"),
    "twice": ({"time_ratio": 1.2, " time_ratio": "free"}, None, "got two for time_ratio"),
    "no table": ("peak_torque", None, "wishes must be a dict by objective"),
    "of no design": ({"peak_torque": "improve"}, None, "got none; name one of the front"),
    "all at once": (dict.fromkeys(("peak_torque", "time_ratio", "footprint"), "improve"), 3, "is Pareto-optimal"),
    "only kept": ({"peak_torque": "keep"}, 3, "no wish was given"),
    "better as worse": ({"time_ratio": "improve", "peak_torque": "may worsen to 1 mN m"}, 3, "which is better"),
    "no row": ({"time_ratio": "improve"}, 99, "a row must be one of the front"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_wishes_that_make_no_sense_are_refused(case: str) -> None:
    given, row, words = REFUSED[case]
    with pytest.raises(InputError) as refused:
        wish(front(), given, row=row)  # type: ignore[arg-type]
    assert words in str(refused.value)


def test_an_angle_in_degrees_without_its_unit_is_refused() -> None:
    of = solve(problem({"transmission_angle": "maximise", "time_ratio": "maximise"}, HELD, samples=256, designs=4))
    with pytest.raises(
        InputError, match=r"must lie between 0 and 90 deg.*; got 2578\.31 deg; .*plain number is in rad"
    ):
        wish(of, {"transmission_angle": 45.0})
    assert wish(of, {"transmission_angle": "89 deg"}).possible is False


def test_a_front_of_one_design_takes_wishes() -> None:
    """Without a range over the front, objectives are counted in their size."""
    of = solve(problem({"peak_torque": "minimise", "time_ratio": "maximise"}, HELD, samples=256, designs=1))
    answer = wish(of, {"peak_torque": 0.5 * of.values[0, 0]})
    assert len(of) == 1
    assert answer.found.columns["residual"][0] <= 1e-6
    assert answer.found.values[0, 0] <= of.values[0, 0] * (1.0 + 1e-9)


def test_one_objective_or_no_design_is_refused() -> None:
    alone = solve(problem({"peak_torque": "minimise"}, HELD, samples=256))
    with pytest.raises(InputError, match="needs at least two objectives; got one, peak_torque"):
        wish(alone, {"peak_torque": 1.0})
    none = solve(problem({"peak_torque": "minimise", "time_ratio": "maximise"}, {"stroke": 0.9}, samples=256))
    with pytest.raises(InputError, match="needs a front with designs; this one is empty: "):
        wish(none, {"peak_torque": 1.0})
