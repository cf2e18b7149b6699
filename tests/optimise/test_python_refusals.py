"""Slips of those who use the front door of Python: each is refused in one sentence that says what serves."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import pytest

import slidercrank as sc

TABLES: dict[str, object] = {
    "name": "Press",
    "mechanism": {"speed": "60 rpm", "slider": {"mass": "2 kg"}},
    "variables": {"crank": ["20 mm", "60 mm"], "rod": ["80 mm", "250 mm"], "offset": ["0 mm", "60 mm"]},
    "constraints": {"stroke": {"equals": "80 mm"}},
    "objectives": {"time_ratio": "maximise", "peak_torque": "minimise"},
    "optimiser": {"designs": 8, "samples": 256},
}


@cache
def front() -> Any:
    return sc.solve(sc.problem(TABLES))


@cache
def nothing() -> Any:
    wishes = (("time_ratio", 1.5), ("transmission_angle", 1.0))
    asked = tuple(sc.Constraint(quantity=name, lower=least) for name, least in wishes)
    return sc.solve(replace(sc.problem(TABLES), constraints=asked))


door: Any = sc
NO_PROBLEM: Any = {"name": "Press"}
NO_FRONT: Any = door.problem(TABLES)
SLIPS: dict[str, tuple[Any, str]] = {
    "form": (
        lambda: door.standard_form(NO_PROBLEM),
        "standard_form needs a problem; got dict; make one with problem or",
    ),
    "openmdao": (lambda: door.openmdao_component(NO_PROBLEM), "openmdao_component needs a problem; got dict"),
    "jax": (lambda: door.jax_function(NO_PROBLEM), "jax_function needs a problem; got dict"),
    "torch": (lambda: door.torch_function(NO_PROBLEM), "torch_function needs a problem; got dict"),
    "quantities": (lambda: door.quantities(NO_PROBLEM), "quantities needs a problem; got dict"),
    "progress": (lambda: door.solve(NO_FRONT, progress="yes"), "progress must be True, for a bar, or a function;"),
    "like": (lambda: door.like(NO_FRONT, 0), "like needs a front; got Problem; solve(problem) returns one"),
    "wish": (lambda: door.wish(NO_FRONT, {"peak_torque": 1.0}), "a wish needs a front; got Problem"),
    "like by text": (
        lambda: door.like(front(), 0, "time_ratio >= 1.2"),
        "a requirement passed to like() must be a Constraint; got 'time",
    ),
    "range": (
        lambda: door.like(front(), 0, ranges={"rod": 0.1}),
        "bounds of rod must be (least, greatest), numbers or None",
    ),
    "one bound": (
        lambda: front().pick("peak_torque", crank_mm=40),
        "bounds of crank_mm must be (least, greatest), numbers",
    ),
    "short bound": (lambda: front().pick("peak_torque", crank_mm=(40,)), "got (40,); for example, write (1.0, None)"),
    "bound as text": (lambda: front().pick("peak_torque", crank_mm=("40 mm", None)), "bounds of crank_mm must be"),
    "bound nan": (lambda: front().pick("peak_torque", crank_mm=(float("nan"), None)), "bounds of crank_mm must be"),
    "weight": (
        lambda: front().topsis({"peak_torque": "high"}),
        "the weight of peak_torque must be a number; got 'high'",
    ),
    "ranking": (lambda: front().lexicographic(3), "a ranking may only contain names and Priority(...); got 3"),
    "share": (lambda: door.Priority(quantity="peak_torque", share="10 %"), "zero or more; got '10 %'"),
    "units": (lambda: front().trade_offs(0, "imperial"), "system must be 'metric' or 'inch'; got 'imperial'"),
    "bound of a constraint": (
        lambda: door.Constraint(quantity="stroke", lower="80 mm"),
        "the constraint on stroke must be a finite number in SI units; got '80 mm'",
    ),
    "degrees": (
        lambda: front().pick("peak_torque", transmission_angle=(40, None)),
        "is within {'transmission_angle': (40, None)}, whose transmission_angle is ",
    ),
    "words": (
        lambda: front().pick("peak_torque", status=(1, None)),
        "bounds may only be on numbers; got status, a column of words",
    ),
    "no designs": (
        lambda: nothing().pick("peak_torque"),
        "a pick needs a front with designs; this one is empty: no design",
    ),
    "direction": (
        lambda: door.Linkage(0.04, 0.1, 0.02).slow_stroke(direction="clockwise"),
        "direction must be positive (counter-clockwise) or negative (clockwise); got 'clockwise'",
    ),
    "angle": (lambda: door.Linkage(0.04, 0.1).plot("30 deg"), "a crank angle must be a number"),
    "shapes": (
        lambda: door.Linkage([0.04, 0.05], 0.1).at([0.0, 1.0, 2.0]),
        "crank angles must broadcast with the linkages; got shapes (3,) and (2,)",
    ),
    "label": (
        lambda: door.Linkage([0.04, 0.05], 0.1).label,
        "a label can only show one linkage; got an array of shape (2,)",
    ),
    "measured": (
        lambda: NO_FRONT.analyse([0.04, 0.1, 0.02]).deviations(None),
        "a measured table must have named columns; got NoneType; give a dict or a DataFrame",
    ),
}


@pytest.mark.parametrize(("call", "said"), SLIPS.values(), ids=SLIPS)
def test_a_slip_is_refused_in_a_sentence(call: Any, said: str) -> None:
    with pytest.raises(sc.InputError) as refused:
        call()
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_linkages_are_compared_by_all_their_numbers() -> None:
    several = sc.Linkage([0.04, 0.05], 0.1, 0.02)
    assert several == sc.Linkage([0.04, 0.05], 0.1, 0.02)
    assert hash(several) == hash(sc.Linkage([0.04, 0.05], 0.1, 0.02))
    assert several != sc.Linkage([0.04, 0.06], 0.1, 0.02)
    assert several != sc.Linkage([0.04, 0.05], 0.1, 0.02, "crossed")
    assert sc.Linkage(0.04, 0.1) == sc.Linkage(0.04, 0.1, -0.0)


def test_fronts_are_compared_without_a_question_of_truth() -> None:
    assert front() == front()
    assert front() != nothing()


def test_a_torque_without_speed_says_what_is_missing() -> None:
    reason = sc.analyse(sc.Mechanism(slider_mass=1.0), [0.04, 0.1, 0.02]).undefined["peak_torque"]
    assert reason == (
        "it needs masses that move or have weight, or loads; got none, or only zeros; for example, add "
        '[mechanism] slider = { mass = "0.8 kg" } with a speed, or a [[load]]'
    )
    assert "peak_torque" in sc.analyse(sc.Mechanism(slider_mass=1.0, speed=3.0), [0.04, 0.1, 0.02])


def test_public_functions_are_called_what_they_are_called() -> None:
    for name in sc.__all__:
        found = getattr(sc, name)
        assert getattr(found, "__name__", name) == name


def test_tables_that_hold_themselves_are_refused() -> None:
    endless: dict[str, object] = dict(TABLES)
    endless["load"] = [endless]
    with pytest.raises(sc.JobError, match="got one that contains itself"):
        sc.problem(endless)
