"""Work that the tests of the engines give out: functions that another process can import."""

from __future__ import annotations

import os
import secrets
import time
from pathlib import Path

import numpy as np
import psutil
from numpy.typing import NDArray

from slidercrank.model.errors import InputError
from slidercrank.optimise.engine.engine import Shared

Array = NDArray[np.float64]


def square(item: int) -> int:
    return item * item


def later_ones_first(item: int) -> int:
    time.sleep(0.02 * (4 - item % 4))
    return item


def process(item: int) -> int:
    time.sleep(0.05)
    return os.getpid()


def refuse_three(item: int) -> int:
    if item == 3:
        raise InputError("it must not be three; got 3; take another one")
    return item


def slow(item: int) -> int:
    time.sleep(0.2)
    return item


def end_once(item: tuple[int, str]) -> int:
    """End this process, as the kernel does for lack of memory, unless the file is there already."""
    number, path = item
    if number == 2 and not Path(path).exists():
        Path(path).touch()
        psutil.Process().kill()
    return number


def end_always(item: int) -> int:
    if item == 2:
        psutil.Process().kill()
    return item


def doubled(subject: float, asked: str, rows: Array) -> tuple[int, Array]:
    """Work on rows that takes 2 ms each."""
    time.sleep(0.002 * len(rows))
    return os.getpid(), subject * rows


class Made:
    """A value whose every copy is another one."""

    def __init__(self) -> None:
        self.number = secrets.randbits(60)

    def __reduce__(self) -> tuple[type, tuple[()]]:
        return Made, ()


def made(item: tuple[Shared[Made], int]) -> int:
    """Return the number of the value, with time for the other processes to take some."""
    time.sleep(0.05)
    return item[0].value.number


def light(subject: float, asked: str, rows: Array) -> tuple[int, Array]:
    return os.getpid(), subject * rows
