"""Process that runs a custom function, which may exit, hang or print without harm to others.

Requests arrive pickled on standard input. Results leave as length, kind and raw numbers, so no object from the function
is ever unpickled. Output printed by the function goes to standard error.

`call_function` calls it with designs and checks its return value.
"""

import faulthandler
import importlib
import os
import pickle
import re
import signal
import struct
import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array
from ...model.errors import InputError
from ...model.kernel.arithmetic import STEP
from ...model.machine.mechanism import Mechanism
from ...model.signals.complex_forces import complex_joint_forces
from .designs import Designs, Numbers, Peaks, Reactions

_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")
"""Unicode control characters, including those for lines and writing direction, and lone surrogates."""


def escape_control_characters(text: str, *, allowed: str = "") -> str:
    r"""Return a text with every control character except allowed ones escaped as in Python: "\x1b"."""
    return _CONTROL.sub(lambda found: found[0] if found[0] in allowed else ascii(found[0])[1:-1], text)


Function = Callable[[Designs], Any]

PIECES = 32
"""Maximum number of columns that a function may return."""


class Refused(Exception):
    """Fault of a function in words: rule, value, location and remedy; printable, whatever the function raised."""

    def __init__(self, reason: str) -> None:
        """Take the reason."""
        super().__init__(escape_control_characters(reason))


@dataclass(frozen=True)
class FunctionResult:
    """Result of a function for n designs, as the maximum of k pieces.

    values: (n, k), SI. slopes: derivatives with respect to the stepped dimension, or None. angles: crank angles of
    peaks, or None.
    """

    values: Array
    slopes: Array | None
    angles: Array | None


def call_function(
    function: Function,
    mechanism: Mechanism,
    dimensions: Array,
    column: int | None,
    *,
    make: Callable[[Mechanism, NDArray[Any]], Designs] = Designs,
) -> FunctionResult:
    """Return the result for designs (n, 3). column: the dimension that carries a complex step, or None.

    Raises `Refused` for a function that raises, or that returns anything but finite numbers of the right shape and
    kind.
    """
    designs: NDArray[Any] = dimensions.copy()
    if column is not None:
        designs = designs.astype(np.complex128)
        designs[:, column] += STEP * 1j
    designs.flags.writeable = False
    try:
        with np.errstate(all="ignore"):
            returned = np.asanyarray(function(make(mechanism, designs)))
    except InputError as error:  # for an attribute that this machine's designs do not have
        raise Refused(f"is not available for this machine: {error}{error_location(error, function)}") from None
    except BaseException as error:  # noqa: BLE001 - whatever it raises is what it did wrong
        kind = f"in complex numbers, for the gradient, {type(error).__name__}" if column is not None else ""
        remedy = _NOT_COMPLEX if column is not None and isinstance(error, TypeError) else "correct the function"
        error_text = f"{kind or type(error).__name__}: {error}".rstrip(": ")
        raise Refused(f"must not raise; got {error_text}{error_location(error, function)}; {remedy}") from None
    return _checked_result(returned, dimensions, column)


_NOT_COMPLEX = (
    "write it with functions that take complex numbers (magnitude in place of abs, no comparisons), "
    'or set gradient = "finite differences"'
)


def error_location(error: BaseException, function: Callable[..., Any]) -> str:
    """Return where an error was raised: the last line in the function's own file, else in the traceback."""
    frames = traceback.extract_tb(error.__traceback__)
    source_file = getattr(getattr(function, "__code__", None), "co_filename", "")
    frames_of_function = [frame for frame in frames if frame.filename == source_file] or list(frames)[-1:]
    return (
        f" ({Path(frames_of_function[-1].filename).name}:{frames_of_function[-1].lineno})" if frames_of_function else ""
    )


def _checked_result(returned: NDArray[Any], dimensions: Array, column: int | None) -> FunctionResult:
    n = len(dimensions)
    if returned.dtype.kind not in "fiuc":
        raise Refused(
            f"must return an array of numbers; got one of {returned.dtype}; return one number for each design"
        )
    angles = returned.angles if isinstance(returned, Peaks) else None
    angles = angles if angles is not None and angles.shape == returned.shape else None
    if returned.ndim == 1:
        returned = returned[:, None]
    if returned.ndim != 2 or len(returned) != n or not 1 <= returned.shape[1] <= PIECES:
        raise Refused(
            f"must return one number for each design, or up to {PIECES} numbers, of which the greatest is used, "
            f"with shape ({n},) or ({n}, k); got shape {returned.shape}; reduce a curve over the cycle with peaks, "
            "greatest or mean"
        )
    if (column is not None) != np.iscomplexobj(returned):
        lost = "must keep the complex numbers that carry the gradient; got real ones; " + _NOT_COMPLEX
        raise Refused(lost if column is not None else "must return real numbers for real designs; got complex ones")
    values = np.array(returned.real, dtype=np.float64)
    slopes = None if column is None else np.array(returned.imag / STEP, dtype=np.float64)
    bad = ~np.isfinite(values).all(axis=1)
    if slopes is not None:
        bad |= ~np.isfinite(slopes).all(axis=1)
    if bad.any():
        row = int(np.flatnonzero(bad)[0])
        wrong = values[row][~np.isfinite(values[row])]
        wrong_value = f"{wrong[0]:g}" if len(wrong) else "a gradient that is not finite"
        crank, rod, offset = 1e3 * dimensions[row]
        raise Refused(
            f"must return a finite number for every design; got {wrong_value} for crank {crank:.6g} mm, "
            f"rod {rod:.6g} mm, offset {offset:.6g} mm; correct the function"
        )
    return FunctionResult(values, slopes, None if angles is None else np.array(angles, dtype=np.float64))


HEAD = struct.Struct("<cQ")
"""Kind of a message (A numbers, E fault, R ready, W wait: time that does not count in the limit) and its length."""
SHAPE = struct.Struct("<QQQ")


def load_function(function: str, folders: list[str]) -> Function:
    """Return the function "module:name" from a module in one of the folders or from an installed module.

    Raises `Refused`. The folders come first during the import, so that modules beside the job are found. Afterwards
    they come last, so that none hides a library.
    """
    module, _, name = function.partition(":")
    before = list(sys.path)
    sys.path[:0] = folders
    try:
        target: Any = importlib.import_module(module)
        for part in name.split("."):
            target = getattr(target, part)
    except BaseException as error:  # noqa: BLE001 - whatever the module does when imported
        error_text = f"{type(error).__name__}: {error}".rstrip(": ")
        raise Refused(
            f"must be a function in a module in the folder of the job file or installed; got "
            f"{error_text}{error_location(error, load_function)}; correct module:function"
        ) from None
    finally:
        sys.path[:] = [*before, *folders]
    if not callable(target):
        raise Refused(f"must be a function; got {type(target).__name__}; name a function after the colon")
    return target  # type: ignore[no-any-return]


class Watch:
    """Time limit of a call: on expiry the process ends, even in a loop that never returns to Python."""

    def __init__(self, limit: float, log: BinaryIO) -> None:
        """Take the limit, s, and the file that receives the line on which the function was running."""
        self.limit, self.log = limit, log

    def __enter__(self) -> None:
        faulthandler.dump_traceback_later(self.limit, exit=True, file=self.log)

    def __exit__(self, *_: object) -> None:
        faulthandler.cancel_dump_traceback_later()


class Timed(Designs):
    """Designs whose first forces do not count in the time limit, because a kernel may have to be compiled."""

    watch: Watch
    wait: Callable[[], None]
    compiled: set[bool] = set()  # noqa: RUF012 - of this process, which has one function

    def forces(self, angle: Numbers) -> Reactions:
        """Return drive torque and joint forces; see `Designs`."""
        rubs = self.mechanism.friction.acts
        if rubs not in self.compiled:
            self.watch.__exit__()
            type(self).wait()
            complex_joint_forces(self.mechanism, self._dimensions[:1].astype(complex), np.zeros((1, 1), complex))
            self.compiled.add(rubs)
            self.watch.__enter__()
        return super().forces(angle)


def pack_result(result: FunctionResult) -> bytes:
    """Return a result as bytes: shape, then values, slopes and angles, NaN where there are none."""
    blank = np.full(result.values.shape, np.nan)
    parts = [blank if part is None else part for part in (result.values, result.slopes, result.angles)]
    return SHAPE.pack(3, *result.values.shape) + np.stack(parts).tobytes()


def unpack_result(data: bytes) -> FunctionResult:
    """Return the result that `pack_result` wrote."""
    shape = SHAPE.unpack_from(data)
    values, slopes, angles = np.frombuffer(data, offset=SHAPE.size).reshape(shape).copy()
    return FunctionResult(values, *(None if np.isnan(part).all() else part for part in (slopes, angles)))


def main() -> None:
    """Serve requests until standard input ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the calling process
    requests, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    sys.stdout = sys.stderr  # write each line immediately, in case the function is killed
    path, limit, name, folders = pickle.load(requests)
    with open(path, "wb", buffering=0) as log:  # noqa: PTH123 - its descriptor is what faulthandler needs
        faulthandler.enable(file=log)
        watch = Watch(limit, log)
        Timed.watch = watch

        def send(kind: bytes, content: bytes = b"") -> None:
            answers.write(HEAD.pack(kind, len(content)) + content)
            answers.flush()

        Timed.wait = staticmethod(lambda: send(b"W"))
        try:
            with watch:
                function = load_function(name, folders)
            send(b"R")
        except Refused as error:
            send(b"E", str(error).encode())
            return
        mechanism = Mechanism()
        while True:
            try:
                machine, data, column = pickle.load(requests)
            except EOFError:
                Path(path).unlink(missing_ok=True)  # the calling process may have been killed
                return
            mechanism = machine or mechanism
            dimensions: Array = np.frombuffer(data).reshape(-1, 3)
            try:
                with watch:
                    result = call_function(function, mechanism, dimensions, column, make=Timed)
            except Refused as error:
                send(b"E", str(error).encode())
            else:
                send(b"A", pack_result(result))


if __name__ == "__main__":
    main()
