"""JAX: its own check of derivatives, mapping over designs, and the known optimum by SLSQP on its gradients."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from scipy import optimize

import slidercrank as sc
from slidercrank.model.errors import InputError
from tests.optimise.adapters.the_problem import NAMES, NEAR, RATIO, STROKE, best_angle, degrees_of, problem

minimize: Any = optimize.minimize  # its stubs take no such options
jax = pytest.importorskip("jax", reason='jax is not installed; pip install "slidercrank[jax]"')


@pytest.fixture(autouse=True)
def double() -> Iterator[None]:
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", before)


def test_derivatives_pass_the_check_of_jax() -> None:
    from jax.test_util import check_grads

    function = sc.jax_function(problem(), NAMES)
    check_grads(function, (jax.numpy.asarray(NEAR),), order=1, modes=["rev"], eps=1e-6)


def test_mapped_and_compiled_functions_give_the_same() -> None:
    stated, some = problem(), np.array(NEAR) * np.linspace(0.9, 1.1, 5)[:, None]
    values, jacobian = stated.evaluate(some, NAMES, gradients=True)
    function = sc.jax_function(stated, NAMES)
    np.testing.assert_array_equal(jax.vmap(function)(some), values)
    np.testing.assert_array_equal(jax.jit(function)(some), values)
    np.testing.assert_array_equal(jax.jit(jax.vmap(jax.jacrev(function)))(some), jacobian)


def test_it_finds_the_known_optimum() -> None:
    function = sc.jax_function(problem(), NAMES)
    slopes = jax.jit(jax.jacrev(function))
    ties = {
        "type": "eq",
        "fun": lambda x: np.asarray(function(x))[1:] / [STROKE, RATIO] - 1.0,
        "jac": lambda x: np.asarray(slopes(x))[1:] / np.array([[STROKE], [RATIO]]),
    }
    found = minimize(
        lambda x: -float(function(x)[0]),
        np.array(NEAR),
        jac=lambda x: -np.asarray(slopes(x))[0],
        constraints=[ties],
        method="SLSQP",
        options={"ftol": 1e-15},
    )
    assert degrees_of(found.x) == pytest.approx(best_angle(), abs=1e-6)


def test_single_precision_is_refused() -> None:
    jax.config.update("jax_enable_x64", False)
    with pytest.raises(InputError, match="jax_enable_x64"):
        sc.jax_function(problem())


def test_lists_are_taken_and_other_widths_refused_before_jax_calls_back() -> None:
    function = sc.jax_function(problem(), ["stroke"])
    assert function([0.04, 0.1, 0.02]).shape == (1,)
    with pytest.raises(
        sc.InputError, match=r"the last axis must hold the 3 numbers of a design; got an array of shape \(2,\)"
    ):
        function(np.array([0.04, 0.1]))
