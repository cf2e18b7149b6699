"""Kernels of packages, compiled: `python -m slidercrank.model.kernel.compile_all [PACKAGE...]`; else the model's."""

from __future__ import annotations

import contextlib
import gc
import os
import pkgutil
import sys
from importlib import import_module
from pathlib import Path

from .closure import size
from .disk import INTO, MODEL, building, compile_beside, keep, locked, read, wanted_files
from .folder import kernel_folder
from .kernel import KERNELS


def compile_missing(folder: Path, package: str) -> None:
    """Compile the kernels of a package, or module, that are missing and that no other process is at.

    What somebody waits for comes first, then what else a machine of that kind needs. How far it is stands in the
    file of `building`.
    """
    module = import_module(package)
    for found in pkgutil.walk_packages(getattr(module, "__path__", []), f"{package}."):
        import_module(found.name)
    asked = [kernel for kernel in KERNELS if kernel.function.__module__.startswith(package)]
    tasks = [(wanted, wanted.file(folder)) for kernel in asked for wanted in kernel.variants().values()]
    # First variants before second ones, and of these what takes long.
    tasks.sort(key=lambda task: (task[0].name.count("-1"), -size(task[0].function)))
    count, parent = len(tasks), os.getppid()
    while tasks and os.getppid() == parent:  # it may have been killed
        names = wanted_files(folder)
        variants = [name.rpartition(".")[0][-2:] for name in names]
        others = {"-0", "-1"} - {next((each for each in reversed(variants) if each.startswith("-")), "-0")}
        wanted, file = min(tasks, key=lambda task: (task[1].name not in names, task[0].name[-2:] in others))
        tasks.remove((wanted, file))
        with locked(file.with_suffix(".lock")) as lock:
            if lock is not None and read(file) is None:
                with contextlib.suppress(OSError):
                    progress = f"{count - len(tasks)} of {count}, {wanted.name.rpartition('.')[2]}"
                    building(folder, package).write_text(progress)
                keep(file, wanted.compile())


if __name__ == "__main__":
    if sys.argv[1:2] == [INTO]:
        gc.set_threshold(50_000, 20, 20)  # a fifth sooner, for 60 MB
        compile_missing(Path(sys.argv[2]), sys.argv[3])
    elif (place := kernel_folder()) is not None:
        for name in sys.argv[1:] or [MODEL]:
            compile_beside(place, name)
