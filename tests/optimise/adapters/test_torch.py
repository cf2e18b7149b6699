"""PyTorch: gradcheck, and the known optimum by Newton steps on its gradients."""

from typing import Any

import numpy as np
import pytest
from scipy import optimize

import slidercrank as sc
from slidercrank.model.errors import InputError
from tests.optimise.adapters.the_problem import NAMES, NEAR, RATIO, STROKE, best_angle, degrees_of, problem

minimize: Any = optimize.minimize  # its stubs take no such options
torch = pytest.importorskip("torch", reason='torch is not installed; pip install "slidercrank[torch]"')


def test_derivatives_pass_gradcheck() -> None:
    function = sc.torch_function(problem(), NAMES)
    some = torch.tensor(np.array([NEAR, NEAR]) * [[1.0], [1.05]], requires_grad=True)
    assert torch.autograd.gradcheck(function, (some,))


def test_it_finds_the_known_optimum() -> None:
    function = sc.torch_function(problem(), NAMES)

    def slopes(x: object) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        return np.asarray(torch.autograd.functional.jacobian(function, torch.tensor(x)).numpy())

    ties = {
        "type": "eq",
        "fun": lambda x: function(torch.tensor(x)).numpy()[1:] / [STROKE, RATIO] - 1.0,
        "jac": lambda x: slopes(x)[1:] / np.array([[STROKE], [RATIO]]),
    }
    found = minimize(
        lambda x: -function(torch.tensor(x))[0].item(),
        np.array(NEAR),
        jac=lambda x: -slopes(x)[0],
        constraints=[ties],
        method="SLSQP",
        options={"ftol": 1e-15},
    )
    assert degrees_of(found.x) == pytest.approx(best_angle(), abs=1e-6)


def test_single_precision_is_refused() -> None:
    with pytest.raises(InputError, match=r"got torch.float32 on cpu; write x.double\(\).cpu\(\)"):
        sc.torch_function(problem())(torch.tensor(NEAR, dtype=torch.float32))
