"""Problems in the form of other optimisers: what they take, and that they find what `solve` finds."""

import math
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
            "mechanism": {"speed": "60 rpm", "slider": {"mass": "3 kg"}},
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
                    "mechanism": {"speed": 1.0},
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
    both = {"crank": ["20 mm", "80 mm"], "rod": "400 mm", "offset": ["-50 mm", "50 mm"]}
    stated = sc.problem(
        {
            "name": "Any",
            "mechanism": {"speed": 1.0},
            "variables": both,
            "constraints": {"stroke": {"equals": 0.1}},
            "objectives": {"footprint": "minimise"},
        }
    )
    with pytest.raises(InputError, match="one sign of the offset"):
        sc.standard_form(stated, eliminate=True)


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
    tables = {"name": "both", "mechanism": {"speed": 3.0}, "objectives": {"time_ratio": "maximise"}}
    tables |= {"variables": {"crank": [0.02, 0.06], "rod": [0.1, 0.3], "offset": [-0.05, 0.05]}}
    with pytest.raises(InputError, match="keep it on one side, or leave them in, with eliminate=False"):
        sc.standard_form(sc.problem(tables | {"constraints": {"stroke": {"equals": 0.08}}}), eliminate=True)
