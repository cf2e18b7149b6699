"""Order of tests for several workers of pytest-xdist, which begin with equal shares and steal from the ends of others.

Files with slow tests begin every share, or some worker would be at them when the others have ended. Others follow in a
mixed order: tests of the service wait for processes and pages, and the others fill their pauses. At the end only short
tests are left.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from itertools import chain, groupby, islice
from typing import TypeVar
from zlib import crc32

Test = TypeVar("Test")

_WAITING = ("tests/service/", "tests/packaging/", "tests/benchmarks/", "tests/optimise/engine/")
_EARLY = 0.7  # of the way: where the last file that waits stands


def shared_out(tests: Sequence[Test], workers: int, file: Callable[[Test], str], slow: Collection[Test]) -> list[Test]:
    """Return the tests so that each worker's share begins with as many files that have slow ones; files stay together.

    slow: those of the tests that are.
    """
    first = {file(test) for test in slow}
    ordered = sorted(tests, key=lambda test: (file(test) not in first, _place(file(test))))
    files = [list(group) for _, group in groupby(ordered, key=file)]
    shares = [[*chain(*files[n::workers])] for n in range(workers)]
    sizes = [(len(tests) + n) // workers for n in range(workers)]  # as the scheduler of worksteal hands them out
    found = [share[:size] for share, size in zip(shares, sizes, strict=True)]
    over = chain(*(share[size:] for share, size in zip(shares, sizes, strict=True)))
    for share, size in zip(found, sizes, strict=True):
        share += islice(over, size - len(share))
    return [*chain(*found)]


def _place(file: str) -> tuple[float, str]:
    """Return where a file stands from 0 to 1, the same in every worker, and the file."""
    share = crc32(file.encode()) / 2**32
    return (_EARLY * share if file.startswith(_WAITING) else share), file
