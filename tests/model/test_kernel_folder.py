"""Where compiled kernels are kept: which places are taken, and which are refused."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import pytest

from slidercrank.model.kernel import kernel_digest
from slidercrank.model.kernel.kernel_digest import Chosen, choose_folder

pytestmark = pytest.mark.skipif(sys.platform in ("darwin", "win32"), reason="caches are where Linux keeps them")


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a home of its own, with a folder for temporary files of its own."""
    for name in ("home", "temporary"):
        (tmp_path / name).mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    return tmp_path / "home"


def cannot_be_written(place: Path) -> None:
    """Put a file where the folder would have to be: that stops root too."""
    place.write_text("")


def test_kernels_are_kept_with_the_caches_of_the_user(home: Path) -> None:
    found = choose_folder()
    assert found.folder is not None
    assert (found.folder.parent, found.empty, found.refused) == (home / "slidercrank", True, "")
    (found.folder / "kernel").touch()
    assert choose_folder() == Chosen(found.folder, False, "")


def test_a_folder_that_is_asked_for_comes_first(home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "asked"))
    found = choose_folder()
    assert found.folder is not None
    assert found.folder.parent == tmp_path / "asked/slidercrank"
    assert list(home.iterdir()) == []


def test_without_a_home_that_can_be_written_they_are_private_temporary_files(home: Path, tmp_path: Path) -> None:
    cannot_be_written(home / "slidercrank")
    found = choose_folder()
    assert found.folder is not None
    assert found.folder.parent == tmp_path / f"temporary/slidercrank-{os.getuid()}"
    assert found.folder.parent.stat().st_mode & 0o777 == 0o700
    assert str(home / "slidercrank") in found.refused


@pytest.mark.parametrize("kind", ["open to others", "a link", "of someone else"])
def test_machine_code_of_strangers_is_not_run(
    kind: str, home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cannot_be_written(home / "slidercrank")
    place = tmp_path / f"temporary/slidercrank-{os.getuid()}"
    if kind == "a link":
        (tmp_path / "elsewhere").mkdir(mode=0o700)
        place.symlink_to(tmp_path / "elsewhere")
    else:
        place.mkdir(mode=0o700)
        if kind == "open to others":
            place.chmod(0o777)
        else:
            stranger = os.getuid() + 1
            monkeypatch.setattr(os, "getuid", lambda: stranger)
            place.rename(place.with_name(f"slidercrank-{stranger}"))
    found = choose_folder()
    assert found.folder is None
    assert "is not a folder that only this user can write" in found.refused


def test_a_user_without_a_home_keeps_nothing_in_the_current_folder(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    monkeypatch.setattr(os.path, "expanduser", lambda path: path)
    monkeypatch.chdir(home)
    found = choose_folder()
    assert found.folder is not None
    assert found.folder.parent.parent == tmp_path / "temporary"
    assert list(home.iterdir()) == []


def test_a_place_that_cannot_even_be_looked_at_is_refused_like_others(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / ("long" * 100)))  # stat raises
    found = choose_folder()
    assert found.folder == home / "slidercrank/kernels"
    assert "cannot be written" in found.refused
    assert found.readable == ()


@pytest.mark.parametrize("open_to_others", [False, True])
def test_kernels_that_nobody_else_can_have_put_there_are_read_where_nothing_can_be_written(
    open_to_others: bool, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kernels = home / "slidercrank/kernels"
    kernels.mkdir(parents=True)
    kernels.parent.chmod(0o777 if open_to_others else 0o755)
    refusal = kernel_digest._refusal_reason
    monkeypatch.setattr(
        kernel_digest, "_refusal_reason", lambda of: "cannot be written" if of == kernels else refusal(of)
    )
    found = choose_folder()
    assert found.folder is not None
    assert found.folder.parent.name == f"slidercrank-{os.getuid()}"
    assert found.readable == (() if open_to_others else (kernels,))
