"""Contents of a catalogue besides limits: prices as quantities, texts, and the least row that serves."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import JobError
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import load_job, parse_job
from slidercrank.optimise.job.catalogue import read_catalogue
from slidercrank.optimise.job.job_notes import job_notes
from slidercrank.optimise.job.linear_contradictions import impossible_option_notes
from tests.optimise.catalogues import front_of

SIX = """name,peak_torque max (N m),price (EUR),maker
GM 150,150,830,Acme
GM 30,30,280,Acme
GM 45,45,340,Bolt
GM 60,60,430,Bolt
GM 80,80,520,Bolt
GM 110,110,660,Acme
"""
PUSHER: dict[str, Any] = {
    "name": "pusher",
    "mechanism": {"speed": "60 rpm", "slider": {"mass": "4 kg"}},
    "load": [{"force": "300 N", "opposes": "motion"}],
    "variables": {
        "crank": {"choices": ["75 mm", "90 mm", "110 mm"]},
        "rod": {"choices": ["320 mm", "400 mm"]},
        "offset": "20 mm",
    },
    "choice": [{"name": "gearmotor", "table": SIX}],
    "objectives": {"peak_torque": "minimise", "stroke": "maximise"},
}


def pusher(table: str = SIX, **more: Any) -> dict[str, Any]:
    return PUSHER | {"choice": [{"name": "gearmotor", "table": table}]} | more


def named(front: ParetoFront, column: str) -> list[Any]:
    values: list[Any] = front.columns[column].tolist()
    return values


def test_each_design_has_maker_and_price_of_its_row_and_names_the_cheapest_that_also_serves() -> None:
    front = sc.solve(sc.problem(PUSHER))
    torques = front.columns["peak_torque_Nm"]
    assert len(front) > 3
    assert set(named(front, "choice_gearmotor")) == {"GM 150"}
    assert set(named(front, "price_EUR")) == {830.0}
    assert set(named(front, "choice_gearmotor_maker")) == {"Acme"}
    serving = ["GM 30" if torque <= 30.0 else "GM 45" for torque in torques]
    assert named(front, "choice_least_gearmotor") == serving
    assert set(serving) <= {"GM 30"} or torques.max() > 30.0
    rows = [dict(zip(["price", "maker"], line.split(",")[2:], strict=True)) for line in SIX.splitlines()]
    own = {line.split(",")[0]: row for line, row in zip(SIX.splitlines(), rows, strict=True)}
    assert named(front, "least_gearmotor_price_EUR") == [float(own[name]["price"]) for name in serving]
    assert named(front, "choice_least_gearmotor_maker") == [own[name]["maker"] for name in serving]


def test_rounding_says_which_row_also_serves() -> None:
    tables = pusher(variables={"crank": "75 mm", "rod": ["320 mm", "400 mm"], "offset": "20 mm"})
    front = sc.solve(sc.problem(tables | {"optimiser": {"samples": 8, "method": "random", "evaluations": 20}}))
    least = front.columns["choice_least_gearmotor"][0]
    assert least in ("GM 30", "GM 45")
    said = f"gearmotor stays GM 150; the smallest one that suffices for the given design is {least}"
    assert said in front.rounded(0, 1e-3).notes


def test_a_price_is_an_objective_a_constraint_and_part_of_a_formula() -> None:
    cheap = sc.solve(sc.problem(pusher(objectives={"price": "minimise", "stroke": "maximise"})))
    assert set(named(cheap, "choice_gearmotor")) <= {"GM 30", "GM 45"}
    assert named(cheap, "price_EUR") == [{"GM 30": 280.0, "GM 45": 340.0}[m] for m in named(cheap, "choice_gearmotor")]
    bounded = sc.problem(pusher(constraints={"price": {"max": "400 EUR"}}))
    assert {variant.labels for variant in bounded.variants} == {("GM 45",)}
    assert bounded.left_out == ()
    front = sc.solve(bounded)
    assert set(named(front, "slack_price_EUR")) == {60.0}
    formula = "price / 2 + 0 * price"
    halved = sc.solve(sc.problem(pusher(objectives={formula: "minimise", "stroke": "maximise"})))
    assert sorted(2.0 * halved.values[:, 1 if halved.objectives[1].quantity != "stroke" else 0]) == sorted(
        named(halved, "price_EUR")
    )
    dear = sc.solve(sc.problem(pusher(objectives={"price": "maximise"})))
    assert named(dear, "choice_gearmotor") == ["GM 150"]


def test_an_amount_is_no_direction_in_which_a_design_counts_as_stationary() -> None:
    tables = pusher(objectives={"price": "minimise", "peak_torque": "minimise", "transmission_angle": "maximise"})
    tables["variables"] = {"crank": ["40 mm", "120 mm"], "rod": ["200 mm", "400 mm"], "offset": ["5 mm", "60 mm"]}
    tables["constraints"] = {"stroke": {"min": "150 mm"}}
    tables["optimiser"] = {"designs": 5, "samples": 64, "method": "random", "evaluations": 200}
    front = sc.solve(sc.problem(tables))
    place = [objective.quantity for objective in front.objectives].index("price")
    assert all(place not in owner.tolist() for owner, _ in front.goals)
    assert np.isnan(front.rates(0)[:, place]).all()


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"price": {"max": "400 USD"}}, 'must be an amount in EUR; got "400 USD"'),
        (
            {"price": {"max": "200 EUR"}},
            "none does: GM 30 has price 280 EUR, more than the 200 EUR allowed; relax the constraint",
        ),
        ({"prize": {"max": 3}}, "did you mean price"),
        ({"price + crank": {"max": 3}}, "adds EUR and mm; only values of one kind can be combined"),
    ],
)
def test_what_is_wrong_with_an_amount_that_is_asked_for_is_told(more: dict[str, Any], words: str) -> None:
    with pytest.raises(JobError, match=re.escape(words)):
        parse_job(pusher(constraints=more))


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"objectives": {"price": "minimise"}}, 'objectives.price: unknown key "price"; possible here: mass, life, '),
        ({"constraints": {"price": {"max": "3 EUR"}}}, 'unknown key "price"; possible here: mass, life, '),
        ({"objectives": {"2 * price": "minimise"}}, 'is called "price"; the names are mass, life, '),
    ],
)
def test_the_refusal_of_a_price_that_a_catalogue_lacks_begins_with_the_columns_that_it_has(
    more: dict[str, Any], words: str
) -> None:
    table = "name,peak_torque max (N m),mass (kg),life (h),maker\nA,30,3.1,9000,Acme\nB,45,4.2,7000,Bolt\n"
    with pytest.raises(JobError, match=re.escape(words)):
        parse_job(pusher(table, **more))


def test_notes_say_which_rows_lose_in_what_and_what_limits_nothing() -> None:
    text = "\n".join(job_notes(pusher()))
    assert "gearmotor: of 6 rows 1 is searched; the others lose in peak_torque max: GM 30 to GM 150, GM 45 to" in text
    assert "not used, but stored with each design: price (EUR) and maker" in text
    text = "\n".join(job_notes(pusher(objectives={"price": "minimise"})))
    assert "gearmotor: not used, but stored with each design: maker" in text
    table = "name,Peak torque (N m),price (EUR)\nA,40,\nB,40,3\n"
    text = "\n".join(job_notes(pusher(table, objectives={"price": "minimise"})))
    assert "of 2 rows 1 is searched; omitted: A (no price, which the job requires)" in text
    assert "the column Peak torque (N m) is read as peak_torque max (N m)" in text
    with pytest.raises(JobError, match="must have a row with price, which the job requires; got none"):
        parse_job(pusher("name,peak_torque max (N m),price (EUR)\nA,40,\n" + "B,,\n", objectives={"price": "minimise"}))


def test_a_column_called_as_a_number_of_the_mechanism_is_asked_about() -> None:
    with pytest.raises(
        JobError, match=re.escape('"speed (rpm)": it would be stored with designs but have no effect; did')
    ):
        parse_job(pusher("name,peak_torque max (N m),speed (rpm)\nA,40,30\n"))
    found = parse_job(pusher("name,peak_torque max (N m),mechanism.speed (rpm)\nA,40,30\n"))
    assert found.variants[0].mechanism.speed == pytest.approx(np.pi)


def test_rows_beyond_the_jobs_own_limit_on_an_amount_are_left_out_in_a_note_and_counted_once() -> None:
    for bound in ("400 EUR", "430 EUR"):
        found = parse_job(tables := pusher(constraints={"price": {"max": bound}}))
        (note,) = [line for line in job_notes(tables) if line.startswith("gearmotor: of")]
        (label,) = {variant.labels[0] for variant in found.variants}
        dear = ["GM 150", "GM 110", "GM 80", *(["GM 60"] if bound == "400 EUR" else [])]
        assert note.startswith("gearmotor: of 6 rows 1 is searched; omitted: ")
        assert all(f"{name} (price " in note for name in dear)
        assert note.count(f"more than the {bound} allowed") == len(dear)
        assert label == ("GM 45" if bound == "400 EUR" else "GM 60")
        assert not impossible_option_notes(found)


def test_rows_that_the_jobs_own_limit_makes_equal_leave_the_least() -> None:
    def searched(**more: Any) -> list[str]:
        found = read_catalogue(SIX, "file", tables=pusher(**more))
        return [option["name"] for option in found.options if option.get("searched", True)]

    assert searched() == ["GM 150"]
    assert searched(constraints={"peak_torque": {"max": "40 N m"}}) == ["GM 45"]
    assert searched(constraints={"peak_torque": {"max": "40 N m"}, "price": {"min": "500 EUR"}}) == ["GM 80"]
    assert searched(objectives={"price": "minimise"}, constraints={"peak_torque": {"max": "45 N m"}}) == [
        "GM 30",
        "GM 45",
    ]


def test_a_blank_limit_is_none_and_texts_and_numbers_are_told_apart() -> None:
    text = (
        "name;peak_torque max (N m);rms_torque max (N m);price (EUR);article;stages;part number\n"
        "A;30;;280;00123;2;4711-1\nB;;20;300;00124;3;12345678\n"
    )
    found = read_catalogue(text, "file")
    first, second = found.options
    assert first["constraints"] == {"peak_torque": {"max": "30 N m"}}
    assert second["constraints"] == {"rms_torque": {"max": "20 N m"}}
    assert first["amounts"] == {"price": "280 EUR", "stages": 2.0}
    assert first["notes"] == {"article": "00123", "part_number": "4711-1"}
    with pytest.raises(JobError, match=re.escape('row 2, column "price (EUR)": must be a number; got "on request"')):
        read_catalogue("name,peak_torque max (N m),price (EUR)\nA,3,on request", "file")


def test_amounts_of_two_catalogues_have_names_of_their_own_and_a_formula_adds_them() -> None:
    other = "name,peak_slider_acceleration max (m/s^2),bearing price (EUR)\nX,90,20\nY,900,50\n"
    both = [{"name": "gearmotor", "table": SIX}, {"name": "bearing", "table": other}]
    total = "price + bearing_price"
    front = sc.solve(sc.problem(pusher(choice=both, objectives={total: "minimise", "stroke": "maximise"})))
    assert set(named(front, "choice_bearing")) == {"X"}
    assert set(named(front, "choice_least_bearing")) == {"X"}
    same = [both[0], {"name": "bearing", "table": other.replace("bearing price", "price")}]
    with pytest.raises(JobError, match='got price, which the choice "gearmotor" has too; rename one'):
        sc.problem(pusher(choice=same))


def test_options_that_are_written_out_have_amounts_and_notes_too() -> None:
    option = [
        {"name": "A", "amounts": {"price": "280 EUR"}, "notes": {"maker": "Acme"}},
        {"name": "B", "amounts": {"price": "300 EUR"}, "constraints": {"peak_torque": {"max": "1 kN m"}}},
    ]
    front = sc.solve(sc.problem(pusher(choice=[{"name": "motor", "option": option}], objectives={"price": "minimise"})))
    assert (named(front, "choice_motor"), named(front, "price_EUR"), named(front, "choice_motor_maker")) == (
        ["A"],
        [280.0],
        ["Acme"],
    )
    option[1]["amounts"] = {"price": "300 USD"}
    with pytest.raises(JobError, match='choice "motor", option "B": amounts of one name must have one unit'):
        sc.problem(pusher(choice=[{"name": "motor", "option": option}]))


def test_a_file_stays_in_its_job_by_name_and_text(tmp_path: Path) -> None:
    (tmp_path / "motors.csv").write_text(SIX)
    tables = pusher(choice=[{"name": "gearmotor", "file": "motors.csv"}])
    assert sc.problem(tables, folder=tmp_path) == parse_job(pusher())
    (tmp_path / "job.json").write_text(json.dumps(tables))
    assert load_job(tmp_path / "job.json") == parse_job(pusher())
    with pytest.raises(JobError, match=r"choice #1\.table: must not be combined with options; got both"):
        parse_job(pusher(choice=[{"name": "g", "table": SIX, "option": []}]))


def rows_of(random: np.random.Generator, *, masses: bool) -> list[dict[str, Any]]:
    """Return random rows, some blank, some equal; with masses, of a number of the job too."""
    rows: list[dict[str, Any]] = []
    for k in range(int(random.integers(4, 14))):
        row: dict[str, Any] = {"name": f"M {k}"}
        row["peak_torque max (N m)"] = "" if random.random() < 0.15 else float(random.choice([18, 22, 26, 30, 40]))
        row["rms_torque max (N m)"] = "" if random.random() < 0.15 else float(random.choice([12, 14, 16, 20]))
        row["price (EUR)"] = "" if random.random() < 0.1 else float(random.choice([100, 120, 150, 200, 300]))
        row["mass (kg)"] = float(random.choice([2, 3, 5]))
        if masses:
            row["mechanism.slider.mass (kg)"] = float(random.choice([2, 6]))
        rows.append(row)
    return rows


QUESTIONS: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"peak_torque": "minimise", "stroke": "maximise"}, {}),
    ({"price": "minimise", "stroke": "maximise"}, {}),
    ({"price": "minimise", "mass": "minimise", "transmission_angle": "maximise"}, {}),
    ({"stroke": "maximise", "rms_torque": "minimise"}, {"price": {"max": "150 EUR"}}),
    ({"stroke": "maximise", "mass": "maximise"}, {"price": {"min": "120 EUR"}, "mass": {"max": "4 kg"}}),
    ({"stroke": "maximise"}, {"price": {"max": "200 EUR"}, "peak_torque": {"max": "27 N m"}}),
    ({"stroke": "maximise", "mass": {"target": "3 kg"}}, {"2 * price": {"max": "400 EUR"}}),
]


@pytest.mark.parametrize("masses", [False, True])
@pytest.mark.parametrize("place", range(len(QUESTIONS)))
def test_the_front_and_the_least_rows_are_those_of_judging_every_row_alone(place: int, masses: bool) -> None:
    random = np.random.default_rng([35, place, masses])
    objectives, constraints = QUESTIONS[place]
    rows = rows_of(random, masses=masses)
    table = "\n".join([",".join(rows[0]), *(",".join(map(str, row.values())) for row in rows)])
    problem = parse_job(pusher(table, objectives=objectives, constraints=constraints))
    front = sc.solve(problem)
    designs = [(c, r, 0.02) for c in (0.075, 0.09, 0.11) for r in (0.32, 0.4)]
    plain = parse_job({key: item for key, item in PUSHER.items() if key != "choice"} | {"variables": FREE})
    asked = ["peak_torque", "rms_torque", "stroke", "transmission_angle"]
    judged: dict[float, dict[tuple[float, ...], dict[str, float]]] = {}
    for mass in (4.0, 2.0, 6.0):
        part = parse_job(
            {key: item for key, item in PUSHER.items() if key != "choice"}
            | {"variables": FREE, "mechanism": {"speed": "60 rpm", "slider": {"mass": f"{mass} kg"}}}
        )
        values = part.evaluate(np.array(designs), asked)
        judged[mass] = {d: dict(zip(asked, row, strict=True)) for d, row in zip(designs, values.tolist(), strict=True)}
    assert plain.objectives

    def of(row: dict[str, Any], design: tuple[float, ...]) -> dict[str, float]:
        numbers = dict(judged[row.get("mechanism.slider.mass (kg)", 4.0)][design])
        numbers["price"] = math.nan if row["price (EUR)"] == "" else row["price (EUR)"]
        numbers["mass"] = row["mass (kg)"]
        numbers["2 * price"] = 2.0 * numbers["price"]
        return numbers

    def serves(row: dict[str, Any], design: tuple[float, ...]) -> bool:
        numbers = of(row, design)
        for name in ("peak_torque", "rms_torque"):
            limit = row[f"{name} max (N m)"]
            if limit != "" and numbers[name] > limit * (1 + 1e-9):
                return False
        for name, bounds in constraints.items():
            for word, text in bounds.items():
                bound = float(text.split()[0])
                if not (numbers[name] <= bound * (1 + 1e-9) if word == "max" else numbers[name] >= bound * (1 - 1e-9)):
                    return False
        return not any(math.isnan(numbers[name]) for name in objectives)

    def costs(row: dict[str, Any], design: tuple[float, ...]) -> list[float]:
        signs = {"minimise": 1.0, "maximise": -1.0}
        numbers = of(row, design)
        return [
            signs[wish] * numbers[name] if isinstance(wish, str) else abs(numbers[name] / 3.0 - 1.0)
            for name, wish in ((item.quantity, objectives[item.quantity]) for item in problem.objectives)
        ]

    every = [costs(row, design) for row in rows for design in designs if serves(row, design)]
    expected = front_of(np.array(every).reshape(-1, len(objectives)))
    assert len(front) == len(expected)
    if not len(front):
        return
    own = np.array([costs(row, d) for row, d in chosen_in(front, rows, designs)])
    np.testing.assert_allclose(np.unique(np.round(own, 9), axis=0), np.unique(np.round(expected, 9), axis=0), rtol=1e-9)

    def least(row: dict[str, Any]) -> tuple[float, ...]:
        keys = ["price (EUR)", "mass (kg)", "peak_torque max (N m)", "rms_torque max (N m)"]
        return (*(math.inf if row[key] == "" else row[key] for key in keys), rows.index(row))

    named_ = named(front, "choice_least_gearmotor") if "choice_least_gearmotor" in front.columns else []
    for place_, (row, design) in enumerate(chosen_in(front, rows, designs)):
        cheapest = min((one for one in rows if serves(one, design)), key=least)
        assert not named_ or named_[place_] == cheapest["name"]
        assert named_ or row is cheapest


FREE = {"crank": ["50 mm", "120 mm"], "rod": ["300 mm", "420 mm"], "offset": ["10 mm", "30 mm"]}


def chosen_in(
    front: ParetoFront, rows: list[dict[str, Any]], designs: Sequence[tuple[float, ...]]
) -> list[tuple[dict[str, Any], tuple[float, ...]]]:
    """Return row and design of each design of a front."""
    by_name = {row["name"]: row for row in rows}
    near = [min(designs, key=lambda d: float(np.abs(np.array(d) - own).sum())) for own in front.dimensions]
    return [(by_name[label], d) for label, d in zip(named(front, "choice_gearmotor"), near, strict=True)]
