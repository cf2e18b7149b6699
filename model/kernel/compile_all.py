"""Kernels of packages, compiled: `python -m slidercrank.model.kernel.compile_all [PACKAGE...]`; else the model's."""

from __future__ import annotations

import contextlib
import gc
import os
import pkgutil
import sys
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from .closure import codes
from .disk import INTO, MODEL, Wanted, building, compile_beside, keep, locked, read, wanted_files
from .folder import kernel_folder
from .kernel import KERNELS

_MOSTLY = 0.7
"""Share of a kernel's formulas that are compiled with another one, from which on it is cheap to compile after that."""


class _Task(NamedTuple):
    wanted: Wanted
    file: Path
    codes: dict[int, int]

    def size(self) -> int:
        return sum(self.codes.values())

    def cheap_after(self, compiled: Iterable[int]) -> bool:
        return sum(self.codes.get(formula, 0) for formula in compiled) >= _MOSTLY * self.size()


def compile_missing(folder: Path, packages: str) -> None:
    """Compile the kernels of packages, or modules, that are missing and that no other process is at.

    What somebody waits for comes first, then what has mostly formulas of kernels that this process has compiled, then
    one package after the other. How far it is stands in the file of `building`.
    """
    tasks: list[_Task] = []
    for package in packages.split():
        module = import_module(package)
        for found in pkgutil.walk_packages(getattr(module, "__path__", []), f"{package}."):
            import_module(found.name)
        asked = [kernel.wanted() for kernel in KERNELS if kernel.function.__module__.startswith(package)]
        own = [_Task(wanted, wanted.file(folder), codes(wanted.function)) for wanted in asked]
        tasks += sorted(own, key=lambda task: -task.size())  # first what takes long
    # Left to who compiles the larger one.
    later = {one.file for one in tasks for other in tasks if other.size() > one.size() and one.cheap_after(other.codes)}
    compiled: set[int] = set()
    count, parent = len(tasks), os.getppid()
    while tasks and os.getppid() == parent:  # it may have been killed
        names = wanted_files(folder)
        task = min(
            tasks,
            key=lambda task: (task.file.name not in names, not task.cheap_after(compiled), task.file in later),
        )
        tasks.remove(task)
        with locked(task.file.with_suffix(".lock")) as lock:
            if lock is not None and read(task.file) is None:
                with contextlib.suppress(OSError):
                    progress = f"{count - len(tasks)} of {count}, {task.wanted.name.rpartition('.')[2]}"
                    building(folder, packages).write_text(progress)
                keep(task.file, task.wanted.compile())
                compiled.update(task.codes)


if __name__ == "__main__":
    if sys.argv[1:2] == [INTO]:
        gc.set_threshold(50_000, 20, 20)  # a fifth sooner, for 60 MB
        compile_missing(Path(sys.argv[2]), sys.argv[3])
    elif (place := kernel_folder()) is not None:
        compile_beside(place, " ".join(sys.argv[1:]) or MODEL)
