"""Compilation of the kernels in packages: `python -m slidercrank.model.kernel.compile_all [PACKAGE...]`.

Without a package, those of the model.
"""

from __future__ import annotations

import contextlib
import gc
import os
import pkgutil
import sys
import time
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from threading import Thread
from typing import NamedTuple

from .disk_cache import (
    INTO,
    MODEL,
    KernelSource,
    awaited_file_names,
    compilation_lock_file,
    compile_in_processes,
    hold_lock,
    read_from_any_folder,
    store_machine_code,
)
from .kernel import KERNELS, Kernel
from .kernel_digest import code_lengths, kernel_folder

_MOSTLY = 0.7
"""Fraction of formulas shared with another kernel above which a kernel is cheap to compile after that one."""


class _CompilationTask(NamedTuple):
    source: KernelSource
    file: Path
    codes: dict[int, int]
    seldom: bool

    def code_length(self) -> int:
        return sum(self.codes.values())

    def is_cheap_after(self, compiled: Iterable[int]) -> bool:
        return sum(self.codes.get(formula, 0) for formula in compiled) >= _MOSTLY * self.code_length()

    def is_compiled_along_with(self, larger: _CompilationTask) -> bool:
        """Whether the process that compiles the larger set also compiles this one."""
        return self.code_length() < larger.code_length() and self.is_cheap_after(larger.codes)

    def rank(self, tasks: list[_CompilationTask]) -> tuple[bool, int]:
        """Return a rank, lowest first: long tasks with their followers, then small tasks."""
        if 2 * self.code_length() < max(task.code_length() for task in tasks):
            return True, self.code_length()
        return False, -sum(task.code_length() for task in tasks if task is self or task.is_compiled_along_with(self))


def compile_missing(folder: Path, packages: str, modules: Iterable[str] = ()) -> None:
    """Compile the missing kernels in packages or modules that no other process is compiling.

    Kernels that a process waits for come first, then those in `modules` that many jobs need. Among these, kernels with
    mostly formulas that this process has already compiled come first, then urgent kernels. The file of
    `compilation_lock_file` records the progress. Ends if nothing can be stored.
    """
    names = awaited_file_names(folder)
    tasks_found = _tasks_of_packages(folder, packages, modules)
    everything = [task for task in tasks_found if not task.seldom or task.file.name in names]
    tasks, awaited = [*everything], {task.file.name for task in everything}
    compiled: set[int] = set()
    complete = False
    while True:
        names = awaited_file_names(folder)
        listed = {task.file.name for task in everything}
        if not complete and (not tasks or not listed.issuperset(names)):
            tasks_found = _tasks_of_packages(
                folder, packages, [name for package in packages.split() for name in _module_names(package)]
            )
            new = [task for task in tasks_found if task.file.name not in listed]
            tasks, everything, complete = [*tasks, *new], [*everything, *new], True
        if not tasks:
            return
        task = min(
            tasks,
            key=lambda task: (
                task.file.name not in names,
                task.seldom,
                not task.is_cheap_after(compiled),
                any(task.is_compiled_along_with(larger) for larger in everything),
                task.rank(everything),
            ),
        )
        tasks.remove(task)
        with hold_lock(task.file.with_suffix(".lock")) as lock:
            if lock is not None and read_from_any_folder(task.file.name, folder) is None:
                reported = [job for job in everything if job.file.name in awaited.union(names)]
                if task in reported:  # nobody waits for kernels that are compiled ahead
                    number, name = sum(job.file.exists() for job in reported), task.source.name.rpartition(".")[2]
                    with contextlib.suppress(OSError):
                        compilation_lock_file(folder, packages).write_text(
                            f"{number} of {len(reported)} done, now {name}"
                        )
                if not store_machine_code(task.file, task.source.compile()):
                    return
                compiled.update(task.codes)


def end_with_parent(parent: int) -> None:
    """End this process, even in the middle of a kernel, once its parent has ended."""
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)  # stored files are complete


def _module_names(package: str) -> list[str]:
    """Return the names of a package and of all its submodules."""
    parts = getattr(import_module(package), "__path__", [])
    return [package, *(module.name for module in pkgutil.walk_packages(parts, f"{package}."))]


def _tasks_of_packages(folder: Path, packages: str, modules: Iterable[str]) -> list[_CompilationTask]:
    """Return the kernels in packages that the modules contain, or import."""
    for name in modules:
        import_module(name)
    prefixes = tuple(packages.split())
    return [_task_of_kernel(kernel, folder) for kernel in KERNELS if kernel.function.__module__.startswith(prefixes)]


def _task_of_kernel(kernel: Kernel, folder: Path) -> _CompilationTask:
    source = kernel.compilation_source()
    return _CompilationTask(source, source.machine_code_file(folder), code_lengths(source.function), kernel.seldom)


if __name__ == "__main__":
    if sys.argv[1:2] == [INTO]:
        Thread(target=end_with_parent, args=(os.getppid(),), daemon=True).start()
        gc.set_threshold(50_000, 1000, 1000)  # a fifth faster, for 80 MB more
        compile_missing(Path(sys.argv[2]), sys.argv[3], sys.argv[4:])
    elif (place := kernel_folder()) is not None:
        compile_in_processes(place, " ".join(sys.argv[1:]) or MODEL)
