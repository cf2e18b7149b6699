"""Results cached for a machine, and for its designs, while the same ones are requested."""

from collections import OrderedDict
from collections.abc import Callable
from functools import wraps
from threading import Lock
from typing import Concatenate, ParamSpec, TypeVar

from ..arrays import Array
from .mechanism import Mechanism

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")

_BATCHES = 4
_LARGEST = 10_000  # designs in a batch: the largest fronts, whose tables request the same results repeatedly


def memoise_by_machine(
    function: Callable[Concatenate[Mechanism, Parameters], Result],
) -> Callable[Concatenate[Mechanism, Parameters], Result]:
    """Cache a function's result for the latest machine: a search requests it thousands of times.

    Other arguments must be hashable, and results must not be modified.
    """
    last: tuple[Mechanism | None, dict[object, Result]] = (None, {})

    @wraps(function)
    def memoised(mechanism: Mechanism, /, *arguments: Parameters.args, **named: Parameters.kwargs) -> Result:
        nonlocal last
        machine, results = last
        if machine is not mechanism:
            results = {}
            last = mechanism, results
        key = (arguments, *named.items())
        if key not in results:
            results[key] = function(mechanism, *arguments, **named)
        return results[key]

    return memoised


def memoise_by_batch(
    function: Callable[Concatenate[Mechanism, Array, Parameters], Result],
) -> Callable[Concatenate[Mechanism, Array, Parameters], Result]:
    """Cache a function's results for the last few batches of designs (n, 3 + k).

    Several quantities need the same results. Other arguments must be hashable, and results must not be modified.
    Results for larger batches are not cached.
    """
    batches: OrderedDict[object, tuple[Mechanism, dict[object, Result]]] = OrderedDict()
    lock = Lock()

    @wraps(function)
    def memoised(
        mechanism: Mechanism, designs: Array, /, *arguments: Parameters.args, **named: Parameters.kwargs
    ) -> Result:
        if len(designs) > _LARGEST:
            return function(mechanism, designs, *arguments, **named)
        batch, key = (id(mechanism), designs.shape, designs.tobytes()), (arguments, *named.items())
        with lock:
            # Keep a reference to the machine, so that no other machine gets its id.
            _, results = batches.setdefault(batch, (mechanism, {}))
            batches.move_to_end(batch)
            while len(batches) > _BATCHES:
                batches.popitem(last=False)
        if key not in results:
            results[key] = function(mechanism, designs, *arguments, **named)
        return results[key]

    return memoised
