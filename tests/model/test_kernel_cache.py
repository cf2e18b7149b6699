"""Kernels that several processes need at the same moment."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

SOURCE = """
import os, sys, time
from pathlib import Path
import numpy as np
from numba import njit, types
from numba.extending import overload
from slidercrank.model.kernel.cache import KernelCache

def slow(x):
    return 2.0 * x

@overload(slow)
def compiled_slow(x):
    time.sleep(0.5)  # as long as a real kernel takes to compile
    return lambda x: 2.0 * x

def twice(x):
    return slow(x)

kernel = njit(twice)
kernel._cache = KernelCache(twice, Path(sys.argv[1]))
njit(lambda x: x)(1.0)  # so that numba is set up before
forks = []
for _ in range(3):
    forks.append(os.fork())
    if not forks[-1]:
        forks.clear()
        break
values, missed = sum(kernel(float(x)) for x in range(3)), sum(kernel.stats.cache_misses.values())
os.write(1, f"{values} {missed}\\n".encode())  # in one piece
sys.exit(any([os.waitpid(fork, 0)[1] for fork in forks]))
"""


def test_a_kernel_that_several_processes_need_is_compiled_and_told_once(tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(SOURCE)
    command = [sys.executable, str(tmp_path / "program.py"), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == "slidercrank compiles its formulas, once after installation: up to a minute\n"
    said = [line.split() for line in done.stdout.splitlines()]
    assert [value for value, _ in said] == ["6.0"] * 4
    assert sum(int(missed) for _, missed in said) == 1
