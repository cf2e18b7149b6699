"""Speed of evaluating four objectives with gradients, against NumPy on the same angles, and the memory it takes."""

from __future__ import annotations

import subprocess
import sys
from time import perf_counter, process_time
from timeit import timeit

import numpy as np

from slidercrank.model.kinematics.closed_forms import ClosedForm, evaluate_closed_form
from slidercrank.model.signals.fast_torque_and_error import screened_maxima
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.optimise.job import load_job

from . import numpy_peer
from .machines import MECHANISM, Array, random_designs
from .report import Row, peak_memory

_SIGNALS = (Signal.TORQUE, Signal.POSITION_ERROR)
_CHUNKS = (32, 64, 128, 256, 512)
_BLOCK = 16_384  # designs


def evaluate(designs: Array, *, angles: int, crowd: bool) -> tuple[Array, Array]:
    """Return values (n, 4) and gradients (n, 4, 3) of the four objectives, block by block: no whole array twice."""
    values, gradients = np.empty((len(designs), 4)), np.empty((len(designs), 4, 3))
    for begin in range(0, len(designs), _BLOCK):
        block = slice(begin, begin + _BLOCK)
        part = designs[block]
        torque, error = screened_maxima(MECHANISM, _SIGNALS, part, gradients=True, angles=angles, crowd=crowd)
        found = (
            evaluate_closed_form(ClosedForm.TIME_RATIO, part, gradients=True),
            (torque.values, torque.gradients),
            evaluate_closed_form(ClosedForm.TRANSMISSION_ANGLE, part, gradients=True),
            (error.values, error.gradients),
        )
        for q, (value, slope) in enumerate(found):
            values[block, q], gradients[block, q] = value, slope
    return values, gradients


def _seconds(work: object, *args: object, **options: object) -> float:
    begin = perf_counter()
    work(*args, **options)  # type: ignore[operator]
    return perf_counter() - begin


def speed(count: int = 100_000, pairs: int = 7) -> list[Row]:
    """Return the ratios of times on 360 equidistant angles and with the default crowded ones, pair by pair."""
    designs = random_designs(count)
    part = designs[: count // 10]  # the peer is timed on a tenth; it is linear in the number of designs
    evaluate(designs, angles=360, crowd=False)
    chunk = min(_CHUNKS, key=lambda size: _seconds(numpy_peer.evaluate, part, angles=360, chunk=size))
    same, default = [], []
    for _ in range(pairs):
        peer = 10.0 * _seconds(numpy_peer.evaluate, part, angles=360, chunk=chunk)
        same.append(peer / _seconds(evaluate, designs, angles=360, crowd=False))
        default.append(peer / _seconds(evaluate, designs, angles=64, crowd=True))
    return [
        Row("values + gradients, 4 objectives, 360 angles: NumPy (best chunks) / ours", same, at_least=20.0),
        Row("the same, ours on the default 64 crowded angles", default, at_least=45.0),
    ]


def public(count: int = 100_000, pairs: int = 7) -> list[Row]:
    """Return the rate of a problem's own `evaluate` over that of the kernels, and its time for a single design."""
    problem, designs = load_job("runs/feeder.toml"), random_designs(count)
    one = designs[:1]
    problem.evaluate(designs, gradients=True)
    shares = [
        _seconds(evaluate, designs, angles=64, crowd=True) / _seconds(problem.evaluate, designs, gradients=True)
        for _ in range(pairs)
    ]
    single = [
        1e6 * timeit(lambda: problem.evaluate(one, gradients=True), timer=process_time, number=1_000) / 1_000
        for _ in range(pairs)
    ]
    return [
        Row("problem.evaluate with gradients: rate over that of the kernels alone", shares, at_least=0.7),
        Row("a single design by problem.evaluate with gradients, processor's microseconds", single, at_most=100.0),
    ]


def accuracy(count: int = 2_000) -> list[Row]:
    """Return the greatest relative errors of the peak torque; reference: all local maxima, refined from 512 angles."""
    designs = random_designs(count, seed=2)
    exact = find_peaks(MECHANISM, Signal.TORQUE, designs, limit=1, angles=512).values[:, 0]
    peer, _ = numpy_peer.evaluate(designs, angles=360, chunk=128)
    ours, _ = evaluate(designs, angles=64, crowd=True)
    return [
        Row(
            "greatest relative error of peak torque: NumPy, 360 angles",
            [float(np.max(np.abs(peer[:, 1] / exact - 1)))],
        ),
        Row("the same: ours, 64 crowded angles", [float(np.max(np.abs(ours[:, 1] / exact - 1)))], at_most=1e-9),
    ]


def memory() -> list[Row]:
    """Return the peak memory of a process that evaluates a million designs, MB."""
    command = [sys.executable, "-c", "from benchmarks.evaluation import million; million()"]
    finished = subprocess.run(command, check=True, capture_output=True, text=True)
    return [Row("peak memory of 1,000,000 designs with gradients, MB", [float(finished.stdout)], at_most=300.0)]


def million() -> None:
    """Evaluate a million designs and print the process's peak memory, MB."""
    evaluate(random_designs(1_000_000), angles=64, crowd=True)
    print(peak_memory())
