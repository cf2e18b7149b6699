"""A problem's quantities as a JAX function with reverse-mode derivatives, mapped over designs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...model.errors import InputError
from ..problem.problem import Problem, require_problem
from .missing_framework import missing_framework_error

if TYPE_CHECKING:
    import jax

    JaxFunction = Callable[[jax.Array], jax.Array]


def jax_function(problem: Problem, quantities: Sequence[str] | None = None) -> JaxFunction:
    """Return a function from designs (..., 3 + k) to quantities (..., q), SI, for `jax.grad`, `jax.vmap`, `jax.jit`.

    quantities: names; by default, the objectives. Supports first derivatives in reverse mode, those of
    `Problem.evaluate` (`jax.custom_vjp`). Raises `InputError` if JAX is missing or not set to double precision.
    """
    require_problem(problem, "jax_function")
    try:
        import jax
    except ImportError as error:
        raise missing_framework_error("jax", error) from None
    if not jax.config.jax_enable_x64:
        raise InputError(
            'designs need double precision; JAX is set to single; first call jax.config.update("jax_enable_x64", '
            "True) first"
        )
    width = 3 + len(problem.mechanism.varying)
    names = [o.quantity for o in problem.objectives] if quantities is None else list(quantities)
    problem.evaluate(np.zeros((1, width)), names)  # raises errors before tracing

    def evaluate_on_host(x: jax.Array) -> jax.Array:
        shape = jax.ShapeDtypeStruct((*x.shape[:-1], len(names)), np.float64)
        return jax.pure_callback(
            lambda y: problem.evaluate(np.asarray(y), names), shape, x, vmap_method="broadcast_all"
        )

    def slopes(x: jax.Array) -> jax.Array:
        shape = jax.ShapeDtypeStruct((*x.shape[:-1], len(names), width), np.float64)
        return jax.pure_callback(
            lambda y: problem.evaluate(np.asarray(y), names, gradients=True)[1], shape, x, vmap_method="broadcast_all"
        )

    differentiable = jax.custom_vjp(evaluate_on_host)
    differentiable.defvjp(
        lambda x: (evaluate_on_host(x), slopes(x)),
        lambda jacobian, pushed: (jax.numpy.einsum("...q,...qd->...d", pushed, jacobian),),
    )

    def function(x: jax.Array) -> jax.Array:
        designs = jax.numpy.asarray(x)
        if designs.shape[-1:] != (width,):
            raise InputError(
                f"the last axis must hold the {width} numbers of a design; got an array of shape {designs.shape}"
            )
        values: jax.Array = differentiable(designs)
        return values

    return function
