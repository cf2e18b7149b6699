"""Random formulas against Python's own evaluation and a complex step; mutated ones against everything else."""

from __future__ import annotations

import cmath
import contextlib
import math
import string
import time
from typing import Any

import numpy as np

from slidercrank.model.errors import JobError
from slidercrank.objectives.formula.quantity import FormulaQuantity

from ..random_formulas import MACHINE, designs, formulas, random_formula

STEP = 1e-30
LONGEST = 0.05  # s


def real(number: Any) -> float:
    return complex(number).real


MEANINGS = {
    "min": lambda *given: min(given, key=real),
    "max": lambda *given: max(given, key=real),
    "fabs": lambda x: -x if real(x) < 0.0 else x,
    **{name: getattr(cmath, name) for name in ("sqrt", "sin", "cos", "atan")},
}


def arcsine(x: complex) -> complex:
    """Return the inverse sine to first order in a small imaginary part: the cut of cmath's lies within rounding."""
    size = max(-1.0, min(1.0, x.real))
    return complex(math.asin(size), x.imag / math.sqrt(max((1.0 - size) * (1.0 + size), 5e-324)))


MEANINGS |= {"asin": arcsine, "acos": lambda x: 0.5 * math.pi - arcsine(x)}


def python_value(source: str, leaves: dict[str, complex]) -> complex:
    return complex(eval(source, {"__builtins__": {}}, MEANINGS | leaves))


def check_formulas(count: int, seed: int) -> tuple[int, float, float]:
    """Return the numbers compared and the greatest relative errors of values and slopes of random formulas."""
    random = np.random.default_rng(seed)
    x = designs(3, seed)
    compared, off, steep = 0, 0.0, 0.0
    for _ in range(count):
        text, source, names = random_formula(random)
        if not names:
            continue
        known = formulas()
        of = known.quantity_of_text(text, "here")
        found = of.evaluate(MACHINE, x, gradients=True)
        assert found.gradients is not None
        parts = dict(zip(("crank", "rod", "offset", "mechanism.slider.mass"), range(4), strict=True))
        leaves: dict[str, tuple[Any, Any]] = {}
        for name in names:
            if name in parts:
                leaves[name] = x[:, parts[name]], np.tile(np.eye(4)[parts[name]], (len(x), 1))
            else:
                part = known.quantity_of_text(name, "here").evaluate(MACHINE, x, gradients=True)
                leaves[name] = part.values, part.gradients
        for row in range(len(x)):
            for column in range(4):
                stepped = {
                    name.replace(".", "_"): complex(values[row], STEP * slopes[row, column])
                    for name, (values, slopes) in leaves.items()
                }
                expected = python_value(source, stepped)
                slope = expected.imag / STEP
                off = max(off, abs(found.values[row] - expected.real) / max(abs(expected.real), 1e-6))
                # Where terms cancel, relative to a millionth of what a slope of such a value is like.
                usual = np.abs(found.gradients[row]).max() + abs(expected.real / x[row, column])
                apart = abs(found.gradients[row, column] - slope)
                steep = max(steep, apart / max(abs(slope), 1e-6 * usual, 1e-300))
                compared += 1
    return compared, off, steep


def test_random_formulas_have_python_s_values_and_the_slopes_of_a_complex_step() -> None:
    compared, off, steep = check_formulas(60, 1)
    assert compared == 60 * 12
    assert off < 1e-9
    assert steep < 1e-9


PIECES = (
    *(
        "+",
        "-",
        "*",
        "/",
        "**",
        "^",
        "(",
        ")",
        ",",
        " ",
        ".",
        "e9",
        "1",
        "0",
        "mm",
        "N m",
        "deg",
        "_",
        "\0",
        "\n",
        "é",
        "²",
    ),
    *("min(", "sqrt(", "crank", "offset", "peak_torque", "__import__", "lambda", "[", "]", "{", ";", "=", "'", '"'),
)


def mutated(random: np.random.Generator, text: str) -> str:
    for _ in range(int(random.integers(1, 5))):
        place, end = sorted(random.integers(0, len(text) + 1, 2))
        piece = str(random.choice(PIECES)) if random.random() < 0.8 else str(random.choice(list(string.printable)))
        kind = random.integers(4)
        if kind == 0:
            text = text[:place] + piece + text[place:]
        elif kind == 1:
            text = text[:place] + text[place + 1 :]
        elif kind == 2:
            text = text[:place] + text[place:end] * int(random.integers(0, 4)) + text[end:]
        else:
            text = text[:place] + piece + text[min(place + 1, len(text)) :]
    return text


def check_mutations(count: int, seed: int) -> tuple[int, float]:
    """Return how many mutated formulas were taken for formulas, and the longest processor time of one, s."""
    random = np.random.default_rng(seed)
    taken, longest = 0, 0.0
    known = formulas()
    known.quantity_of_text("1 lbf * crank", "here")  # the units library is read once
    for place in range(count):
        known = formulas() if place % 1000 == 0 else known
        text = mutated(random, random_formula(random, depth=2)[0])
        begin = time.process_time()
        try:
            assert known.quantity_of_text(text, "here").name
            taken += 1
        except JobError as error:
            message = str(error)
            assert message.startswith("here: ")
            assert message.isprintable(), ascii(message)
            assert ";" in message, message
        taken_time = time.process_time() - begin
        if taken_time > 0.5 * LONGEST:  # the collector of garbage may have come in between
            begin = time.process_time()
            with contextlib.suppress(JobError):
                formulas().quantity_of_text(text, "here")
            taken_time = min(taken_time, time.process_time() - begin)
        longest = max(longest, taken_time)
    return taken, longest


def test_mutated_formulas_are_formulas_or_refused_with_a_sentence_and_quickly() -> None:
    taken, longest = check_mutations(1500, 2)
    assert 0 < taken < 1500
    assert longest < LONGEST


def test_pieces_of_random_formulas_are_the_greatest_and_the_least_of_them() -> None:
    random = np.random.default_rng(3)
    x = designs(20, 4)
    both = 0
    for _ in range(60):
        text, _, names = random_formula(random)
        if not names:
            continue
        of = formulas().quantity_of_text(text, "here")
        found, values = of.pieces(MACHINE, x), of.evaluate(MACHINE, x, gradients=True)
        assert values.gradients is not None
        np.testing.assert_allclose(found.values.max(axis=1), values.values, rtol=1e-12, atol=1e-12)
        if found.opposite is not None:
            both += 1
            assert found.opposite.least
            np.testing.assert_allclose(found.opposite.values.min(axis=1), values.values, rtol=1e-12, atol=1e-12)
        assert not isinstance(of, FormulaQuantity) or found.values.shape[1] == of.pieces(MACHINE, x[:1]).values.shape[1]
    assert both > 5
