"""The test files that `make check` runs."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.changed import MOST, PRODUCT, belonging, changed, main
from tests.imports import files_of, importers

FILES = {
    "optimise/solve.py": "from .job import text\n",
    "optimise/job/__init__.py": "from .inner import FACT\n",
    "optimise/job/inner.py": "FACT = 1\n",
    "optimise/job/text.py": "import os\n",
    "optimise/job/typed.py": "def typed() -> int:\n    from . import (\n        text,  # later\n    )\n    return 1\n",
    "optimise/__init__.py": "",
    "optimise/alone.py": "LONELY = 1\n",
    "optimise/methods/registry.py": "import_module('optimise.methods')\n",
    "optimise/methods/sobol.py": "METHOD = 1\n",
    "optimise/data/series.csv": "1, 2\n",
    "optimise/data/reader.py": "def read() -> None: ...\n",
    "service/page/static/app.js": 'import { h } from "./lib/dom.js";\nconst VIEWS = [\n'
    '  { match: (parts) => parts[0] === "new" && parts.length === 1, load: () => import("./views/new_run.js") },\n'
    '  {\n    match: (parts) => parts[0] === "jobs" && parts[2] === "designs" && parts.length === 4,\n'
    '    load: () => import("./views/design.js"),\n  },\n];\n',
    "service/page/static/views/new_run.js": 'import { h } from "../lib/dom.js";\n',
    "service/page/static/views/design.js": 'import "../lib/dom.js";\nimport { lines } from "../charts/lines.js";\n',
    "service/page/static/lib/dom.js": "export const h = 1;\n",
    "service/page/static/charts/lines.js": "export const lines = 1;\n",
    "tests/optimise/test_solve.py": "",
    "tests/optimise/test_solve_robust.py": "from slidercrank.optimise.solve import solve\n",
    "tests/optimise/test_slow.py": "pytestmark = pytest.mark.slow\nfrom slidercrank.optimise.job import text\n",
    "tests/optimise/test_other.py": "from slidercrank.optimise import job\n\njob.FACT\n",
    "tests/optimise/test_methods.py": "from slidercrank.optimise.methods.registry import methods\n",
    "tests/optimise/job/test_text.py": "from slidercrank.optimise.job.text import text\n",
    "tests/optimise/test_job_box.py": "from slidercrank.optimise.job.typed import typed\n"
    "from tests.optimise import problems\n",
    "tests/optimise/test_data.py": "from slidercrank.optimise.data.reader import read\n",
    "tests/optimise/problems.py": "",
    "tests/service/page/test_form.py": 'open_page(store, "#/new")\n',
    "tests/service/page/test_bars.py": 'page.goto(f"{address}/#/jobs/{number}/designs/2?{query}")\n',
}


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a small project with a commit on `main`, in which the test stands."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
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
        ("optimise/solve.py", ["test_solve.py", "test_solve_robust.py"]),
        ("optimise/job/text.py", ["job/test_text.py", "test_job_box.py", "test_solve_robust.py"]),
        ("optimise/job/typed.py", ["test_job_box.py"]),
        ("optimise/job/inner.py", ["test_job_box.py", "test_other.py", "job/test_text.py"]),
        ("optimise/job/__init__.py", ["test_job_box.py", "job/test_text.py", "test_other.py"]),
        ("optimise/methods/sobol.py", ["test_methods.py"]),
        ("optimise/data/series.csv", ["test_data.py"]),
        ("optimise/alone.py", []),
        ("tests/optimise/test_other.py", ["test_other.py"]),
        ("tests/optimise/problems.py", ["test_job_box.py"]),
        ("service/page/static/views/design.js", ["test_bars.py"]),
        ("service/page/static/charts/lines.js", ["test_bars.py"]),
        ("service/page/static/lib/dom.js", ["test_bars.py", "test_form.py"]),
    ],
)
def test_a_file_has_tests_of_its_name_and_those_that_import_it_or_what_imports_it(
    project: Path, file: str, tests: list[str]
) -> None:
    folder = project / Path("tests", *Path(file).parts[:2] if file.startswith("service") else ["optimise"])
    found = belonging(Path(file), project, importers(project))
    assert [(project / test).relative_to(folder).as_posix() for test in found] == tests


def test_what_is_committed_edited_or_new_since_main_was_left_differs(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    git(project, "checkout", "--quiet", "-b", "other")
    (project / "optimise/solve.py").write_text("1\n")
    git(project, "-c", "user.name=a", "-c", "user.email=a@b.c", "commit", "--quiet", "--all", "--message=second")
    (project / "service/page/static/charts/lines.js").write_text("2\n")
    (project / "tests/optimise/test_new.py").touch()
    (project / "README.md").touch()
    (project / "optimise/job/typed.py").unlink()
    assert {str(file) for file in changed("main", project)} == {
        "optimise/solve.py",
        "service/page/static/charts/lines.js",
        "tests/optimise/test_new.py",
        "README.md",
    }
    main("main")
    assert capsys.readouterr().out.splitlines() == [
        *("tests/optimise/test_new.py", "tests/optimise/test_solve.py", "tests/optimise/test_solve_robust.py"),
        "tests/service/page/test_bars.py",
    ]


def test_a_source_file_that_no_test_belongs_to_is_an_error(project: Path) -> None:
    (project / "optimise/alone.py").write_text("LONELY = 2\n")
    with pytest.raises(
        SystemExit, match=r"needs a test that runs it; got none for optimise/alone\.py; import it in one"
    ):
        main("main")


def test_a_branch_that_is_none_is_said_so(project: Path) -> None:
    with pytest.raises(SystemExit, match=r"git merge-base nowhere HEAD: .*nowhere"):
        changed("nowhere", project)


@pytest.mark.slow
def test_every_file_of_the_product_has_some_tests_and_few(pytestconfig: pytest.Config) -> None:
    root = pytestconfig.rootpath
    graph = importers(root)
    files = [file for file in files_of(root, ".py", ".js", ".css", ".html") if file.parts[0] in PRODUCT]
    found = {file: belonging(file, root, graph) for file in files if (root / file).stat().st_size}
    assert [str(file) for file, tests in found.items() if not tests] == []
    assert len(found) > 600
    assert sum(len(tests) > MOST for tests in found.values()) < 0.1 * len(found)
