"""Problems in the form of other optimisers: what they take, and that they find what `solve` finds."""

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import check_grad, minimize

import slidercrank as sc
from slidercrank.model.errors import InputError
from tests.optimise.adapters.the_problem import NEAR, best_angle, degrees_of, problem
from tests.optimise.problems import RUNS

pytestmark = pytest.mark.usefixtures("little")


def test_the_known_optimum_is_that_of_solve() -> None:
    front = sc.solve(problem())
    assert len(front) == 1
    assert math.degrees(-front.values[0, 0]) == pytest.approx(best_angle(), abs=1e-9)


@pytest.mark.parametrize("eliminate", [False, True], ids=["all three", "eliminated"])
def test_scipy_finds_it(eliminate: bool) -> None:
    form = sc.standard_form(problem(), eliminate=eliminate)
    found = minimize(**form.scipy()._asdict(), method="SLSQP", options={"ftol": 1e-15, "maxiter": 300})
    assert found.success, found.message
    assert degrees_of(form.designs(found.x)) == pytest.approx(best_angle(), abs=1e-6)


def several() -> sc.Problem:
    return sc.problem(
        {
            "name": "Press",
            "mechanism": {"speed": "-60 rpm", "slider": {"mass": "3 kg"}},
            "load": [{"force": "500 N", "opposes": "outward stroke"}],
            "variables": {"crank": ["20 mm", "80 mm"], "rod": ["60 mm", "400 mm"], "offset": ["0 mm", "80 mm"]},
            "constraints": {
                "stroke": {"equals": "100 mm"},
                "transmission_angle": {"min": "30 deg", "max": "80 deg"},
                "footprint": {"max": "0.08 m^2"},
            },
            "objectives": {"peak_torque": "minimise", "time_ratio": "maximise", "rod_to_crank": {"target": 3.0}},
        }
    )


@pytest.mark.parametrize("eliminate", [False, True], ids=["all three", "eliminated"])
def test_jacobians_are_those_of_differences(eliminate: bool) -> None:
    form = sc.standard_form(several(), eliminate=eliminate)
    x, h = form.start(), 1e-7
    at = form.arrays(x, gradients=True)
    for name in ("F", "G", "H"):
        slopes = getattr(at, f"d{name}")
        for column in range(len(x)):
            ahead, behind = x.copy(), x.copy()
            ahead[column] += h
            behind[column] -= h
            slope = (getattr(form.arrays(ahead), name) - getattr(form.arrays(behind), name)) / (2.0 * h)
            np.testing.assert_allclose(slopes[..., column], slope, rtol=1e-5, atol=1e-5)
    single = form.scipy("peak_torque")
    assert check_grad(single.fun, single.jac, x) < 1e-3 * np.abs(single.jac(x)).max()


@pytest.mark.parametrize("eliminate", [False, True], ids=["all three", "eliminated"])
def test_designs_of_the_front_are_feasible_and_worse_ones_are_not(eliminate: bool) -> None:
    stated = several()
    form = sc.standard_form(stated, eliminate=eliminate)
    assert len(form.inequalities) == form.arrays(form.start()).G.shape[-1]
    front = sc.solve(stated)
    x = front.dimensions
    if eliminate:  # the coordinates of the front's designs
        columns = [("crank", "rod", "offset").index(name) for name in form.names]
        ends = [(stated.crank, stated.rod, stated.offset)[column] for column in columns]
        x = np.column_stack([(x[:, c] - e.lower) / (e.upper - e.lower) for c, e in zip(columns, ends, strict=True)])
        np.testing.assert_allclose(form.designs(x), front.dimensions, rtol=1e-9)
    found = form.arrays(x)
    assert found.G.max() < 1e-8
    assert np.abs(found.H).max(initial=0.0) < 1e-8
    np.testing.assert_allclose(found.F, front.values, rtol=1e-8, atol=1e-12)


def test_a_design_that_does_not_turn_is_infinite_and_says_by_how_much() -> None:
    found = sc.standard_form(problem()).arrays([[0.08, 0.1, 0.03], NEAR], gradients=True)
    assert np.isinf(found.F[0]).all()
    assert np.isinf(found.H[0]).all()
    assert np.isfinite(found.G[0, :2]).all()
    assert found.G[0, 0] > 0.0
    assert np.isnan(found.dF[0]).all()
    assert np.isfinite(found.dG[:, :2]).all()
    assert np.isfinite(found.F[1]).all()


def test_the_start_turns_fully_where_any_design_does() -> None:
    random = np.random.default_rng(8)
    for _ in range(50):
        low = random.uniform(0.01, 0.1, 3)
        high = low + random.uniform(0.0, 0.3, 3)
        stated = (
            sc.problem(
                {
                    "name": "Any",
                    "mechanism": {"speed": "1 rad/s"},
                    "variables": dict(zip(("crank", "rod", "offset"), np.stack([low, high], axis=1), strict=True)),
                    "constraints": {"transmission_angle": {"min": "12 deg"}},
                    "objectives": {"stroke": "maximise"},
                }
            )
            if low[0] + low[2] < 0.95 * high[1]
            else None
        )
        if stated is not None:
            start = sc.standard_form(stated).start()
            assert np.isfinite(stated.evaluate(start)).all()
            assert ((start >= low) & (start <= high)).all()


def test_what_has_no_standard_form_is_refused() -> None:
    form = sc.standard_form(several())
    with pytest.raises(InputError, match="one objective is needed; got None of time_ratio, peak_torque"):
        form.scipy()
    with pytest.raises(InputError, match="got 'stroke' of"):
        form.scipy("stroke")
    with pytest.raises(InputError, match="got elimination_branch=0 with eliminate=False"):
        sc.standard_form(several(), elimination_branch=0)


def test_a_problem_of_one_branch_says_that_it_is_the_only_one() -> None:
    stated = sc.problem(
        {
            "name": "Press",
            "mechanism": {"speed": "60 rpm", "slider": {"mass": "3 kg"}},
            "variables": {"crank": ["20 mm", "80 mm"], "rod": ["60 mm", "400 mm"], "offset": ["5 mm", "80 mm"]},
            "constraints": {"stroke": {"equals": "100 mm"}},
            "objectives": {"peak_torque": "minimise"},
        }
    )
    with pytest.raises(InputError, match=r"one branch.*; got elimination_branch=1; leave elimination_branch out"):
        sc.standard_form(stated, eliminate=True, elimination_branch=1)


def press_with_offsets_of_both_signs() -> sc.Problem:
    """A press with offsets of either sign. Its least torques are those of 1,000 random designs on each side."""
    tables = {
        "name": "Press",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "3 kg"}, "gravity": "9.81 m/s^2"},
        "load": [{"force": "500 N", "opposes": "outward stroke"}],
        "variables": {"crank": ["20 mm", "80 mm"], "rod": ["60 mm", "400 mm"], "offset": ["-80 mm", "80 mm"]},
        "constraints": {"stroke": {"equals": "100 mm"}, "transmission_angle": {"min": "30 deg"}},
        "objectives": {"peak_torque": "minimise"},
    }
    return sc.problem(tables)


def test_equalities_have_a_form_for_each_sign_of_the_offset_as_the_message_says() -> None:
    stated = press_with_offsets_of_both_signs()
    said = r"got None of 2 \(0: offset above 0; 1: offset below 0\); .* elimination_branch=0 to 1"
    with pytest.raises(InputError, match=said):
        sc.standard_form(stated, eliminate=True)
    with pytest.raises(InputError, match="got 2 of 2"):
        sc.standard_form(stated, eliminate=True, elimination_branch=2)
    best = []
    for branch, side in enumerate((1.0, -1.0)):
        form = sc.standard_form(stated, eliminate=True, elimination_branch=branch)
        x = np.random.default_rng(4).random((1000, len(form.names)))
        designs = form.designs(x)
        there = np.isfinite(form.arrays(x).F[:, 0])
        assert there.sum() > 100
        assert (side * designs[there, 2] >= 0.0).all()
        assert stated.evaluate(designs[there], ["stroke"]) == pytest.approx(0.1, rel=1e-12)
        found = minimize(**form.scipy()._asdict(), method="SLSQP", options={"ftol": 1e-14, "maxiter": 300})
        feasible = form.arrays(x).G.max(axis=1) <= 0.0
        assert found.fun <= form.arrays(x[there & feasible]).F.min()
        best.append(float(found.fun))
    front = sc.solve(stated)
    assert min(best) == pytest.approx(front.values[:, 0].min(), rel=1e-7)


def test_roots_of_a_swing_are_told_as_roots_where_the_offset_has_one_sign() -> None:
    tables = tomllib.loads((RUNS / "support.toml").read_text())
    tables["constraints"]["actuator_travel"] = {"equals": "2.3 m"}
    tables["variables"]["offset"] = ["-600 mm", "-10 mm"]
    stated = sc.problem(tables)
    with pytest.raises(
        InputError, match=r"got None of \d \(0: offset below 0, root 1 for \w+; 1: offset below 0, root 2"
    ):
        sc.standard_form(stated, eliminate=True)
    counts = []
    for branch in range(2):
        form = sc.standard_form(stated, eliminate=True, elimination_branch=branch)
        x = np.random.default_rng(4).random((2000, len(form.names)))
        there = np.isfinite(form.arrays(x).F).all(axis=1)
        travels = stated.evaluate(form.designs(x[there]), ["actuator_travel"])
        assert travels == pytest.approx(2.3, rel=1e-9)
        counts.append(int(there.sum()))
    assert max(counts) > 10  # a root may have no design in the ranges


def test_a_swing_need_not_turn_and_its_form_says_so() -> None:
    support = sc.load_job(RUNS / "support.toml")
    form = sc.standard_form(support)
    assert "turning" not in form.inequalities
    assert np.isfinite(form.arrays(form.start()).F).all()
    x = np.random.default_rng(5).uniform(form.lower, form.upper, (4000, 3))
    found = form.arrays(x)
    feasible = np.isfinite(found.F).all(axis=1) & (found.G <= 0.0).all(axis=1)
    makes_it = np.isfinite(support.evaluate(x)).all(axis=1)
    margin, travel = support.evaluate(x, ["swing_transmission_angle", "actuator_travel"]).T
    np.testing.assert_array_equal(feasible, makes_it & (margin >= np.radians(15.0)) & (travel <= 2.4))
    turns = x[:, 1] > x[:, 0] + np.abs(x[:, 2])
    assert (feasible & ~turns).any()


def test_slsqp_finds_the_best_swing_that_solve_finds() -> None:
    support = sc.load_job(RUNS / "support.toml")
    one = replace(support, objectives=support.objectives[:1])
    found = minimize(**sc.standard_form(one).scipy()._asdict(), method="SLSQP", options={"ftol": 1e-12})
    assert found.fun == pytest.approx(one.evaluate(sc.solve(one).dimensions)[0, 0], rel=1e-5)


def test_offsets_of_both_signs_need_no_elimination_where_there_are_no_equalities() -> None:
    support = sc.load_job(RUNS / "support.toml")
    form = sc.standard_form(support, eliminate=True)
    assert form.names == ("crank", "rod", "offset")
    x = np.random.default_rng(6).uniform(form.lower, form.upper, (50, 3))
    np.testing.assert_array_equal(form.designs(x), x)
    np.testing.assert_array_equal(form.arrays(x).F, sc.standard_form(support).arrays(x).F)
    tables = {"name": "both", "mechanism": {"speed": "3 rad/s"}, "objectives": {"time_ratio": "maximise"}}
    tables |= {"variables": {"crank": [0.02, 0.06], "rod": [0.1, 0.3], "offset": [-0.05, 0.05]}}
    with pytest.raises(InputError, match="elimination_branch=0 to 1, or keep the equalities, with eliminate=False"):
        sc.standard_form(sc.problem(tables | {"constraints": {"stroke": {"equals": 0.08}}}), eliminate=True)
