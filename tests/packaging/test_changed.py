"""The test files that `make check` runs."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.changed import belonging, changed, main


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a small project with a commit on `main`, in which the test stands."""
    for name in (
        *("optimise/solve.py", "optimise/job/__init__.py", "optimise/job/text.py", "optimise/__init__.py"),
        *("tests/optimise/test_solve.py", "tests/optimise/test_solve_robust.py", "tests/optimise/test_other.py"),
        *("tests/optimise/job/test_text.py", "tests/optimise/test_job_box.py", "tests/optimise/problems.py"),
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    git(tmp_path, "init", "--quiet", "--initial-branch=main")
    git(tmp_path, "add", ".")
    git(tmp_path, "-c", "user.name=a", "-c", "user.email=a@b.c", "commit", "--quiet", "--message=first")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def git(folder: Path, *arguments: str) -> None:
    subprocess.run(["git", *arguments], cwd=folder, check=True)


@pytest.mark.parametrize(
    ("file", "tests"),
    [
        ("optimise/solve.py", ["tests/optimise/test_solve.py", "tests/optimise/test_solve_robust.py"]),
        ("optimise/job/__init__.py", ["tests/optimise/test_job_box.py"]),
        ("optimise/job/text.py", ["tests/optimise/job/test_text.py", "tests/optimise/test_job_box.py"]),
        ("tests/optimise/test_other.py", ["tests/optimise/test_other.py"]),
        ("tests/optimise/test_deleted.py", []),
        ("tests/optimise/problems.py", []),
        ("optimise/__init__.py", []),
        ("README.md", []),
    ],
)
def test_a_file_has_its_own_tests_and_those_of_its_name(project: Path, file: str, tests: list[str]) -> None:
    assert [str(found) for found in belonging(Path(file), project)] == tests


def test_what_is_committed_edited_or_new_since_main_was_left_differs(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    git(project, "checkout", "--quiet", "-b", "other")
    (project / "optimise/solve.py").write_text("1\n")
    git(project, "-c", "user.name=a", "-c", "user.email=a@b.c", "commit", "--quiet", "--all", "--message=second")
    (project / "optimise/job/text.py").write_text("2\n")
    (project / "tests/optimise/test_new.py").touch()
    assert {str(file) for file in changed("main", project)} == {
        "optimise/solve.py",
        "optimise/job/text.py",
        "tests/optimise/test_new.py",
    }
    main("main")
    assert capsys.readouterr().out.splitlines() == [
        *("tests/optimise/job/test_text.py", "tests/optimise/test_job_box.py", "tests/optimise/test_new.py"),
        *("tests/optimise/test_solve.py", "tests/optimise/test_solve_robust.py"),
    ]


def test_a_branch_that_is_none_is_said_so(project: Path) -> None:
    with pytest.raises(SystemExit, match=r"git merge-base nowhere HEAD: .*nowhere"):
        changed("nowhere", project)
