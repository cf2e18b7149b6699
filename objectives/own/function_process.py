"""Process that runs a custom function, which may exit, hang or print without harm to others.

Requests arrive pickled on standard input. Results leave as length, kind and raw numbers, so no object from the function
is ever unpickled. Output printed by the function goes to standard error.
"""

from __future__ import annotations

import faulthandler
import importlib
import os
import pickle
import signal
import struct
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ...model.arrays import Array
from ...model.machine.mechanism import Mechanism
from ...model.signals.complex_forces import complex_joint_forces
from .call_function import Function, FunctionResult, Refused, call_function, error_location
from .designs import Designs, Numbers, Reactions

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
