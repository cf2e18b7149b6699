"""A problem's quantities as a differentiable PyTorch function."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...model.errors import InputError
from ..problem.problem import Problem, require_problem
from .missing_framework import missing_framework_error

if TYPE_CHECKING:
    import torch
    from torch.autograd.function import FunctionCtx

    TorchFunction = Callable[[torch.Tensor], torch.Tensor]


def torch_function(problem: Problem, quantities: Sequence[str] | None = None) -> TorchFunction:
    """Return a function from a tensor of designs (..., 3 + k) to quantities (..., q), SI, for `backward`.

    quantities: names; by default, the objectives. Supports first derivatives, those of `Problem.evaluate`. Tensors must
    have double precision and be on the CPU. Raises `InputError` for any other tensor, or if PyTorch is not installed.
    """
    require_problem(problem, "torch_function")
    try:
        import torch
    except ImportError as error:
        raise missing_framework_error("torch", error) from None
    names = [objective.quantity for objective in problem.objectives] if quantities is None else list(quantities)
    problem.evaluate(np.zeros((1, 3 + len(problem.mechanism.varying))), names)  # raises errors early

    class Quantities(torch.autograd.Function):  # type: ignore[misc]
        @staticmethod
        def forward(ctx: FunctionCtx, x: torch.Tensor) -> torch.Tensor:
            designs = x.detach().numpy()
            if not ctx.needs_input_grad[0]:
                return torch.from_numpy(problem.evaluate(designs, names))
            values, jacobian = problem.evaluate(designs, names, gradients=True)
            ctx.save_for_backward(torch.from_numpy(jacobian))
            return torch.from_numpy(values)

        @staticmethod
        @torch.autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: FunctionCtx, pushed: torch.Tensor) -> torch.Tensor:
            (jacobian,) = ctx.saved_tensors
            return torch.einsum("...q,...qd->...d", pushed, jacobian)

    def apply(x: torch.Tensor) -> torch.Tensor:
        if x.dtype != torch.float64 or x.device.type != "cpu":
            raise InputError(
                f"designs must be double-precision tensors on the CPU; got {x.dtype} on {x.device}; write "
                "x.double().cpu()"
            )
        quantities_of_x: torch.Tensor = Quantities.apply(x)
        return quantities_of_x

    return apply
