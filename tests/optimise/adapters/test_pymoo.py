"""pymoo: arrays as it wants them, and the known optimum by its genetic algorithm."""

import pickle

import numpy as np
import pytest

import slidercrank as sc
from tests.optimise.adapters.the_problem import best_angle, degrees_of, problem

pytest.importorskip("pymoo", reason='pymoo is not installed; pip install "slidercrank[pymoo]"')


def test_it_finds_the_known_optimum() -> None:
    from pymoo.algorithms.soo.nonconvex.ga import GA
    from pymoo.optimize import minimize

    stated = sc.pymoo_problem(problem())
    found = minimize(stated, GA(pop_size=50), ("n_gen", 60), seed=1)
    assert degrees_of(sc.standard_form(problem(), eliminate=True).designs(found.X)) == pytest.approx(
        best_angle(), abs=1e-6
    )


@pytest.mark.parametrize("eliminate", [False, True])
def test_populations_are_evaluated_as_the_standard_form_says(eliminate: bool) -> None:
    stated = sc.pymoo_problem(problem(), eliminate=eliminate)
    form = sc.standard_form(problem(), eliminate=eliminate)
    x = np.random.default_rng(2).uniform(form.lower, form.upper, (40, len(form.names)))
    f, g, h = stated.evaluate(x, return_values_of=["F", "G", "H"])
    found = form.arrays(x)
    for given, wanted in ((f, found.F), (g, found.G), (h, found.H)):
        np.testing.assert_array_equal(given, np.minimum(wanted, 1e30))
    assert np.isinf(found.F).any()


@pytest.mark.parametrize("eliminate", [False, True])
def test_it_goes_to_other_processes_and_into_files(eliminate: bool) -> None:
    stated = sc.pymoo_problem(problem(), eliminate=eliminate)
    again = pickle.loads(pickle.dumps(stated))
    x = np.random.default_rng(3).uniform(stated.xl, stated.xu, (8, stated.n_var))
    np.testing.assert_array_equal(again.evaluate(x, return_values_of=["F"]), stated.evaluate(x, return_values_of=["F"]))
