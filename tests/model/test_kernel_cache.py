"""Kernels that several processes need at the same moment."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

SOURCE = """
import sys, time
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
print(sum(kernel(float(x)) for x in range(3)), sum(kernel.stats.cache_misses.values()))
"""


def test_a_kernel_that_several_processes_need_is_compiled_and_told_once(tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(SOURCE)
    command = [sys.executable, str(tmp_path / "program.py"), str(tmp_path)]
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    running = [subprocess.Popen(command, **pipes) for _ in range(4)]
    outputs = [process.communicate() for process in running]
    said = [output.split() for output, _ in outputs]
    told = "".join(messages for _, messages in outputs)
    assert told == "slidercrank compiles its formulas, once after installation: up to a minute\n"
    assert [process.returncode for process in running] == [0] * 4
    assert {value for value, _ in said} == {"6.0"}
    assert sum(int(missed) for _, missed in said) == 1
