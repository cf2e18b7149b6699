"""All kernels of the model, compiled: `python -m slidercrank.model.kernel.compile_all [FOLDER PACKAGE]`."""

from __future__ import annotations

import pkgutil
import sys
from importlib import import_module
from pathlib import Path

from .disk import MODEL, build, keep, locked, read
from .folder import kernel_folder
from .kernel import KERNELS


def compile_missing(folder: Path, package: str) -> None:
    """Compile the kernels of a package, or module, that are missing and that no other process is at.

    Each one done is told in a line: its name, and how many were missing.
    """
    module = import_module(package)
    for found in pkgutil.walk_packages(getattr(module, "__path__", []), f"{package}."):
        import_module(found.name)
    asked = [kernel for kernel in KERNELS if kernel.function.__module__.startswith(package)]
    asked.sort(key=lambda kernel: -len(kernel.function.__code__.co_code))  # those that take long first
    files = [(wanted, wanted.file(folder)) for kernel in asked for wanted in kernel.variants().values()]
    missing = [(wanted, file) for wanted, file in files if read(file) is None]
    for wanted, file in missing:
        with locked(file.with_suffix(".lock"), wait=False) as alone:
            if alone and read(file) is None:
                keep(file, wanted.compile())
                sys.stdout.write(f"{wanted.name.removeprefix(f'{MODEL}.')} {len(missing)}\n")
                sys.stdout.flush()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        compile_missing(Path(sys.argv[1]), sys.argv[2])
    elif (place := kernel_folder()) is not None:
        build(place, MODEL, place / "all of them")
