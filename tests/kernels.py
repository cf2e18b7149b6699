"""Compile the kernels that tests need, several at a time: `python -m tests.kernels`.

Workers of a test run would come to the same kernel together, and all but one would wait for it. What is missing here
is compiled by the first test that needs it.
"""

from __future__ import annotations

import os
from concurrent.futures import ProcessPoolExecutor
from hashlib import sha256
from importlib.metadata import version
from multiprocessing import get_context
from pathlib import Path

from slidercrank.model.kernel.folder import kernel_folder

PARTS = Path(__file__).with_name("kernel_parts.py")


def main() -> None:
    """Run the parts at the same time, as many as there are processors; again only where something has changed."""
    folder = kernel_folder()  # that of one state of the sources
    state = f"{version('numba')} {os.environ.get('NUMBA_CPU_NAME')}".encode() + PARTS.read_bytes()
    done = None if folder is None else folder / f"tests-{sha256(state).hexdigest()[:16]}"
    if done is not None and done.exists():
        return
    with ProcessPoolExecutor(os.cpu_count(), get_context("spawn")) as pool:
        for part in [pool.submit(run, number) for number in range(3)]:
            part.result()
    if done is not None:
        done.touch()


def run(number: int) -> None:
    """Compile a part. Its imports take seconds, so that they come only where something is missing."""
    from tests.kernel_parts import PARTS

    PARTS[number]()


if __name__ == "__main__":
    main()
