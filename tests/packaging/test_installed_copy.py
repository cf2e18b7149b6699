"""An installed copy of the software: where it may not write, and what it leaves behind."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.packaging.test_layout import ORDER

USE = """
import numpy as np
from slidercrank.model.kinematics.closed_forms import ClosedForm, evaluate_closed_form
import slidercrank
stroke = evaluate_closed_form(ClosedForm.STROKE, np.array([[0.1, 0.3, 0.0]]))[0]
print(slidercrank.__file__, round(float(stroke[0]), 12))
"""

ALONE = f"import os; os.cpu_count = lambda: 1{USE}"
"""The same with one process that compiles: a second one would only begin what these tests do not wait for."""

FirstUse = tuple[Path, str, str]
"""A copy, and what its first use put out and said."""

COMPILES = "slidercrank is compiling its formulas (only once after installation)\n"

pytestmark = pytest.mark.slow


def installed_copy(root: Path, place: Path) -> Path:
    """Return a copy as pip would install it, which compiles to byte code."""
    package = place / "site/slidercrank"
    for folder, to in ((".package/slidercrank", package), *((name, package / name) for name in ORDER)):
        shutil.copytree(root / folder, to, ignore=_needless_files)
    return package


def _needless_files(folder: str, names: list[str]) -> set[str]:
    return {name for name in names if folder.endswith("__pycache__") and not name.endswith(".pyc")}


@pytest.fixture
def copy(tmp_path: Path, pytestconfig: pytest.Config) -> Path:
    return installed_copy(pytestconfig.rootpath, tmp_path)


@pytest.fixture(scope="module")
def first_use(tmp_path_factory: pytest.TempPathFactory, pytestconfig: pytest.Config) -> FirstUse:
    """Use a copy for the first time."""
    copy = installed_copy(pytestconfig.rootpath, tmp_path_factory.mktemp("installed"))
    return copy, *run_in_copy(copy, ALONE)


def run_in_copy(package: Path, code: str = USE, *, before: tuple[str, ...] = (), **environment: str) -> tuple[str, str]:
    """Return standard output and standard error of a process that uses the copy."""
    known = {name: value for name, value in os.environ.items() if name not in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME")}
    home = package.parent.parent / "home"
    done = subprocess.run(
        [*before, sys.executable, "-c", code],
        env=known | {"PYTHONPATH": str(package.parent), "HOME": str(home)} | environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr


def test_nothing_is_kept_beside_the_sources_that_an_uninstallation_would_leave(first_use: FirstUse) -> None:
    copy, printed, said = first_use
    assert printed == f"{copy / '__init__.py'} 0.2\n"
    assert said.startswith(COMPILES)
    assert {file.suffix for file in copy.rglob("__pycache__/*")} <= {".pyc"}


def test_a_damaged_kernel_is_compiled_anew(first_use: FirstUse) -> None:
    copy, printed, _ = first_use
    kernels = [file for file in (copy.parent.parent / "home").rglob("*kernels/*.closed_forms.*") if file.stat().st_size]
    assert kernels
    for file in kernels:
        file.write_bytes(file.read_bytes()[:100])
    again, said = run_in_copy(copy, ALONE)
    assert again == printed
    assert said.startswith(COMPILES)
    assert 100 not in {file.stat().st_size for file in kernels}
    assert run_in_copy(copy) == (printed, "")


@pytest.mark.skipif(os.name == "nt", reason="permissions as in POSIX")
def test_a_copy_that_cannot_be_written_in_a_home_that_cannot_says_so_once(copy: Path, tmp_path: Path) -> None:
    home, temporary = tmp_path / "home", tmp_path / "temporary"
    for folder in (home, temporary):
        folder.mkdir()
    for folder in (home, copy, *(found for found in copy.rglob("*") if found.is_dir())):
        folder.chmod(0o555)
    # Root may write everywhere unless it gives that up.
    before = ("setpriv", "--inh-caps=-all", "--bounding-set=-all") if os.getuid() == 0 else ()
    printed, said = run_in_copy(copy, ALONE, before=before, TMPDIR=str(temporary))
    assert printed == f"{copy / '__init__.py'} 0.2\n"
    assert said.startswith(f"slidercrank keeps compiled kernels in {temporary}/slidercrank-{os.getuid()}: {home}")
    assert f"set NUMBA_CACHE_DIR to a writable folder\n{COMPILES}" in said
    assert run_in_copy(copy, before=before, TMPDIR=str(temporary)) == (printed, "")


@pytest.mark.skipif(os.name == "nt", reason="permissions as in POSIX")
def test_kernels_are_read_from_a_home_that_cannot_be_written_and_none_from_one_that_cannot_be_read(
    first_use: FirstUse, tmp_path: Path
) -> None:
    copy, printed, _ = first_use
    home = copy.parent.parent / "home"
    folders = [home, *(found for found in home.rglob("*") if found.is_dir())]
    before = ("setpriv", "--inh-caps=-all", "--bounding-set=-all") if os.getuid() == 0 else ()
    try:
        for folder in folders:
            folder.chmod(0o555)
        assert run_in_copy(copy, before=before, TMPDIR=str(tmp_path)) == (printed, "")
        home.chmod(0o000)
        again, said = run_in_copy(copy, ALONE, before=before, TMPDIR=str(tmp_path))
        assert again == printed
        assert said.startswith(f"slidercrank keeps compiled kernels in {tmp_path}/slidercrank-{os.getuid()}: {home}")
    finally:
        for folder in folders:
            folder.chmod(0o755)
