"""A custom quantity: a Python function that judges designs, named in a job file or passed from Python."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any, Literal, NoReturn, get_args

import numpy as np

from ...model.arrays import IntArray
from ...model.cycle.self_locking import locking_margin
from ...model.errors import InputError
from ...model.kernel.batches import require_full_rotation
from ...model.machine.mechanism import Mechanism
from ..quantity import Array, Pieces, Quantity, Values
from .function_process import Function, FunctionResult, Refused, call_function
from .function_process_client import Worker

Gradient = Literal["complex step", "finite differences", "none"]
GROUP = "slidercrank.quantities"
"""Entry points that provide quantities: each an `OwnQuantity`."""
LIMIT = 30.0
"""s; time limit for a call with at most `_BATCH` designs unless the job gives another"""
_BATCH = 256
_STEP = 2e-5  # of the smaller of crank length and distance to locking: truncation error 4e-10, rounding error 5e-12
_WITNESSES = 3  # designs on which a complex step is compared with differences
_AGREE = 1e-4  # relative to the gradient's magnitude
LONGEST_NAME = 60
_NAME = re.compile(rf"[a-z][a-z0-9_]{{0,{LONGEST_NAME - 1}}}")
FUNCTION = re.compile(r"[A-Za-z_][\w.]*:[A-Za-z_][\w.]*", re.ASCII)

Call = Callable[[Mechanism, Array, int | None], FunctionResult]


class _Session:
    """State kept between calls: the process, and the machines with a checked gradient.

    A copy in another process starts its own function process but does not repeat the check: it may receive only one
    design there, and that may lie at a kink.
    """

    def __init__(self, checked: tuple[Mechanism, ...] = ()) -> None:
        self.call: Call | None = None
        self.validated = list(checked)

    def __reduce__(self) -> tuple[type[_Session], tuple[tuple[Mechanism, ...]]]:
        return _Session, (tuple(self.validated),)

    def __deepcopy__(self, _: object) -> _Session:
        return _Session()


@dataclass(frozen=True, kw_only=True)
class OwnQuantity(Quantity):
    """A Python function of designs as a quantity.

    function: takes `Designs` and returns (n,), or (n, k) whose maximum counts, SI. "module:function" runs in its own
    process, within the limit; a Python function runs in this process, without a limit. kind: a kind in the table, or
    `kinds.kind_displayed_in` for any unit. gradient: "complex step" for a function that accepts complex numbers, else
    "finite differences"; "none" for methods that need no gradient. folders: folders that may contain the module. limit:
    time limit of a call for up to 256 designs, s. longest: upper bound on `limit` set by whoever runs the function, s.

    Every method raises `InputError` with the quantity's name if the function raises, exceeds the time limit, or ends
    the process. It also does so if the result is not finite or has the wrong shape, or if there is no such gradient.
    """

    function: str | Function
    signed: bool = field(default=True, compare=False)
    gradient: Gradient = "complex step"
    folders: tuple[str, ...] = ()
    limit: float = LIMIT
    longest: float = field(default=float("inf"), compare=False)
    _session: _Session = field(default_factory=_Session, init=False, compare=False, repr=False)

    def depends_on_speed(self, mechanism: Mechanism) -> bool:
        """True, because a function is never called before a search."""
        return True

    def __post_init__(self) -> None:
        super().__post_init__()
        require_column_name(self.name)
        if isinstance(self.function, str) and not FUNCTION.fullmatch(self.function):
            raise InputError(
                f'a function must be named like "module:function"; got {self.function!r}; write it in this form'
            )
        if self.gradient not in get_args(Gradient):
            raise InputError(f"gradient must be {' or '.join(map(repr, get_args(Gradient)))}; got {self.gradient!r}")
        if not 0.0 < self.limit < float("inf"):
            raise InputError(f"the time limit must be more than zero and finite; got {self.limit:g} s")

    @property
    def has_gradient(self) -> bool:
        """Whether its derivatives can be computed in a stated way."""
        return self.gradient != "none"

    def undefined_because(self, machines: Iterable[Mechanism]) -> str | None:
        """Return rule, value and remedy for a machine with extra variables: a function receives only the dimensions."""
        varying = next((machine.varying for machine in machines if machine.varying), ())
        if not varying:
            return None
        return (
            "a custom function may only depend on crank, rod and offset; got other variables, "
            f"{', '.join(item.name for item in varying)}; fix them, or use other quantities"
        )

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3); see `Quantity`."""
        if gradients:
            pieces = self.pieces(mechanism, dimensions)
            return Values(pieces.values[:, 0], pieces.gradients[:, 0])
        dimensions = self._rows_without_locking(dimensions)
        self._check_complex_step(mechanism, dimensions)
        values = np.full(len(dimensions), np.inf)
        for rows in self._batches_of_unlocked_rows(mechanism, dimensions):
            values[rows] = self._call_function(mechanism, dimensions[rows], None).values.max(axis=1)
        return Values(values, None)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the maximum of its pieces; see `Quantity`.

        With finite differences there is a single piece. Gradients are zero if the quantity has none.
        """
        dimensions = self._rows_without_locking(dimensions)
        self._check_complex_step(mechanism, dimensions)
        parts = []
        for rows in self._batches_of_unlocked_rows(mechanism, dimensions):
            piece = self._pieces_by_complex_step if self.gradient == "complex step" else self._single_piece
            parts.append((rows, piece(mechanism, dimensions[rows])))
        n, k = len(dimensions), max((part.values.shape[1] for _, part in parts), default=1)
        values, labels = np.full((n, k), -np.inf), np.zeros((n, k))
        values[:, 0] = np.inf  # where friction locks
        gradients = np.zeros((n, k, 3))
        for rows, part in parts:
            count = part.values.shape[1]
            values[rows, :count], labels[rows, :count] = part.values, part.labels
            gradients[rows, :count] = part.gradients
        return Pieces(values, gradients, labels)

    def close(self) -> None:
        """End the function's process, if there is one; the next call starts another."""
        call, self._session.call = self._session.call, None
        if isinstance(call, Worker):
            call.close()

    # ---- calls to the function ------------------------------------------------------------------------------------

    def _call_function(self, mechanism: Mechanism, dimensions: Array, column: int | None) -> FunctionResult:
        session = self._session
        session.call = session.call or self._make_call()
        try:
            return session.call(mechanism, dimensions, column)
        except Refused as error:
            self._raise_refusal(str(error))

    def _make_call(self) -> Call:
        if isinstance(self.function, str):
            return Worker(self.function, list(self.folders), self.limit, self.longest)
        function = self.function
        return lambda mechanism, dimensions, column: call_function(function, mechanism, dimensions, column)

    def require_function(self) -> None:
        """Raise `InputError` if the module in "module:function" is not found or lacks the function; runs nothing."""
        if not isinstance(self.function, str):
            return
        module, _, function = self.function.partition(":")
        places: Sequence[str] | None = [*self.folders, *sys.path]
        spec = None
        for part in module.split("."):
            spec = None if places is None else PathFinder.find_spec(part, places)
            if spec is None:
                self._raise_refusal(
                    f"must be in a module in the folder of the job file or installed; no module {module} was "
                    f"found; put {module.split('.')[0]}.py there, or correct module:function"
                )
            places = spec.submodule_search_locations
        source = Path(spec.origin) if spec is not None and spec.origin else None
        if source is not None and source.suffix == ".py":
            text = source.read_text(encoding="utf-8", errors="replace")
            if not re.search(rf"\b({re.escape(function)}\b|import\s+\*)", text):
                self._raise_refusal(f"must be in its module; {source} has no {function}; correct module:function")

    def _raise_refusal(self, reason: str) -> NoReturn:
        function_name = (
            self.function if isinstance(self.function, str) else getattr(self.function, "__qualname__", "function")
        )
        raise InputError(f"the quantity {self.name} ({function_name}) {reason}") from None

    def _rows_without_locking(self, dimensions: Array) -> Array:
        if dimensions.shape[1] != 3:
            self._raise_refusal(
                "may only depend on crank, rod and offset; got more variables; fix them, or use other quantities"
            )
        return require_full_rotation(dimensions)

    def _batches_of_unlocked_rows(self, mechanism: Mechanism, dimensions: Array) -> Iterator[IntArray]:
        """Yield the rows of designs that friction does not lock; forces in the others are undetermined."""
        rows = np.arange(len(dimensions))
        if mechanism.friction.acts:
            rows = rows[locking_margin(mechanism.friction, dimensions)[0] > 0.0]
        for begin in range(0, len(rows), _BATCH):
            yield rows[begin : begin + _BATCH]

    # ---- gradients ------------------------------------------------------------------------------------------------

    def _pieces_by_complex_step(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        answers = [self._call_function(mechanism, dimensions, column) for column in range(3)]
        values = answers[0].values
        gradients = np.stack([np.asarray(answer.slopes) for answer in answers], axis=2)
        angles = answers[0].angles
        labels = np.tile(np.arange(float(values.shape[1])), (len(values), 1)) if angles is None else angles
        # A curve with fewer peaks repeats its highest peak.
        top = np.argmax(values, axis=1)[:, None]
        same = (values == np.take_along_axis(values, top, axis=1)) & (labels == np.take_along_axis(labels, top, axis=1))
        again = same & (np.arange(values.shape[1]) != top)
        values = np.where(again, -np.inf, values)
        gradients = np.where(again[:, :, None], 0.0, gradients)
        return Pieces(values, gradients, labels).select_pieces(np.argsort(-values, axis=1, kind="stable"))

    def _single_piece(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        values = self._call_function(mechanism, dimensions, None).values.max(axis=1)[:, None]
        slopes = np.zeros((len(dimensions), 3))
        if self.gradient == "finite differences":
            slopes = self._central_differences(mechanism, dimensions, _STEP)
        return Pieces(values, slopes[:, None], np.zeros_like(values))

    def _central_differences(self, mechanism: Mechanism, dimensions: Array, share: float) -> Array:
        """Return central differences (n, 3).

        Steps are a fraction of the crank or, if smaller, of the distance to locking.
        """
        crank, rod, offset = dimensions.T
        step = share * np.minimum(rod - crank - np.abs(offset), crank)
        slopes = np.empty((len(dimensions), 3))
        for column in range(3):
            ends = []
            for sign in (1.0, -1.0):
                moved = dimensions.copy()
                moved[:, column] += sign * step
                ends.append((moved[:, column], self._call_function(mechanism, moved, None).values.max(axis=1)))
            (upper, high), (lower, low) = ends
            slopes[:, column] = (high - low) / (upper - lower)
        return slopes

    def _check_complex_step(self, mechanism: Mechanism, dimensions: Array) -> None:
        """Raise an error before a search uses a complex step that does not give the derivative.

        Compares three designs with finite differences. One of them may lie at a kink; two hardly ever do.
        """
        if self.gradient != "complex step" or mechanism in self._session.validated:
            return
        rows = np.concatenate([np.zeros(0, np.int64), *self._batches_of_unlocked_rows(mechanism, dimensions)])
        if not len(rows):
            return
        witnesses = dimensions[np.unique(rows[np.linspace(0, len(rows) - 1, _WITNESSES).astype(int)])]
        pieces = self._pieces_by_complex_step(mechanism, witnesses)
        coarse, fine = (self._central_differences(mechanism, witnesses, share) for share in (2.0 * _STEP, _STEP))
        size = np.abs(fine).max(axis=1)
        doubt = np.abs(fine - coarse).max(axis=1) + 1e-9 * np.abs(pieces.values[:, 0]) / witnesses[:, 0]
        differences = np.abs(pieces.gradients[:, 0] - fine)
        wrong = differences.max(axis=1) > _AGREE * size + 10.0 * doubt
        if 2 * wrong.sum() > len(witnesses):
            row = int(np.flatnonzero(wrong)[0])
            column = int(np.argmax(differences[row]))
            crank, rod, offset = 1e3 * witnesses[row]
            self._raise_refusal(
                "must have a gradient by complex step that agrees with differences; got "
                f"{pieces.gradients[row, 0, column]:.6g} and {fine[row, column]:.6g} by the "
                f"{('crank', 'rod', 'offset')[column]} for crank {crank:.6g} mm, rod {rod:.6g} mm, offset "
                f"{offset:.6g} mm; write magnitude in place of abs and leave the imaginary parts as they are, "
                'or set gradient = "finite differences"'
            )
        self._session.validated.append(mechanism)


def require_column_name(name: str) -> None:
    """Raise `InputError` for a name that cannot be a table column."""
    if not _NAME.fullmatch(name):
        raise InputError(
            f"the name of a quantity must have 1 to {LONGEST_NAME} lower-case letters, digits and underscores, and "
            f"begin with a letter; got {name!r}" + (f" of {len(name)} characters" if len(name) > LONGEST_NAME else "")
        )


def with_time_limit(quantity: Quantity, longest: float) -> Quantity:
    """Return a quantity whose custom functions, even nested ones, take at most `longest` s per call."""
    if isinstance(quantity, OwnQuantity):
        return replace(quantity, longest=longest)
    return quantity.with_parts(tuple(with_time_limit(part, longest) for part in quantity.component_quantities))


def close_custom_functions(quantity: Quantity) -> None:
    """End the custom function processes that a quantity or one of its parts has started."""
    if isinstance(quantity, OwnQuantity):
        quantity.close()
    for part in quantity.component_quantities:
        close_custom_functions(part)


def runs_custom_function(quantity: Quantity) -> bool:
    """Whether a quantity or one of its parts is a custom function."""
    return isinstance(quantity, OwnQuantity) or any(map(runs_custom_function, quantity.component_quantities))


def quantity_entry_points() -> dict[str, Any]:
    """Return the entry points of installed packages that provide quantities, by name, without loading any."""
    from importlib.metadata import entry_points

    return {entry.name: entry for entry in entry_points(group=GROUP)}


def installed_quantity(name: str) -> OwnQuantity:
    """Return the quantity of this name from an installed package.

    Raises `InputError` if the entry point is not a quantity.
    """
    entry = quantity_entry_points()[name]
    quantity = entry.load()
    if not isinstance(quantity, OwnQuantity) or quantity.name != name:
        raise InputError(
            f"the entry point {name} of {GROUP} must be an OwnQuantity of that name; got {quantity!r}; "
            f"correct {entry.value}"
        )
    return quantity
