"""Scrambled Sobol points, equal to those of `scipy.stats.qmc` but without its import, which takes as long as a search.

I. M. Sobol, USSR Comput. Math. Math. Phys. 7(4), 1967; primitive polynomials and first direction numbers of S. Joe and
F. Y. Kuo, SIAM J. Sci. Comput. 30(5), 2008; scrambled by a random lower triangular matrix and a digital shift,
J. Matousek, J. Complexity 14, 1998.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array

_BITS = 30
# For each dimension: inner coefficients of the polynomial as a number, and the first direction numbers.
_FIRST: tuple[tuple[int, tuple[int, ...]], ...] = (
    (0, (1,) * _BITS),
    (0, (1,)),
    (1, (1, 3)),
    (1, (1, 3, 1)),
    (2, (1, 1, 1)),
    (1, (1, 1, 3, 3)),
    (4, (1, 3, 5, 13)),
    (2, (1, 1, 5, 5, 17)),
    (4, (1, 1, 5, 5, 5)),
    (7, (1, 1, 7, 11, 19)),
)


def sobol(power: int, dimension: int, random: np.random.Generator) -> Array:
    """Return 2^power points in the unit box (n, k). random: spawns the generator that scrambles them."""
    if dimension > len(_FIRST):
        from scipy.stats import qmc

        return np.asarray(qmc.Sobol(dimension, rng=random).random_base2(power))
    random = random.spawn(1)[0]
    places = np.arange(_BITS, dtype=np.uint32)
    shift = random.integers(2, size=(dimension, _BITS), dtype=np.uint32) @ (np.uint32(1) << places)
    lower = np.tril(random.integers(2, size=(dimension, _BITS, _BITS), dtype=np.uint32), -1)
    lower += np.eye(_BITS, dtype=np.uint32)
    digits = _direction_numbers(dimension)[:, :, None] >> places[::-1] & 1  # most significant digit first
    mixed = np.einsum("dpk,djk->djp", lower, digits) & 1
    numbers = (mixed << places[::-1]).sum(axis=2, dtype=np.uint32)
    count = np.arange(1, 2**power)
    points = np.empty((2**power, dimension), dtype=np.uint32)
    points[0] = shift
    points[1:] = numbers.T[np.log2(count & -count).astype(np.int64)]  # the digit that changes in Gray code
    return np.asarray(np.bitwise_xor.accumulate(points) * 2.0**-_BITS)


def _direction_numbers(dimension: int) -> NDArray[np.uint32]:
    """Return the direction numbers (k, bits)."""
    rows = []
    for inner, first in _FIRST[:dimension]:
        numbers, degree = list(first), len(first)
        for j in range(degree, _BITS):
            new = numbers[j - degree] ^ numbers[j - degree] << degree
            for k in range(1, degree):
                new ^= (inner >> degree - 1 - k & 1) * numbers[j - k] << k
            numbers.append(new)
        rows.append([number << _BITS - 1 - j for j, number in enumerate(numbers)])
    return np.array(rows, dtype=np.uint32)
