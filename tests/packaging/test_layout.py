"""The installed packages are the folders on disk, and the folders depend on each other one way."""

import ast
import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import slidercrank
from slidercrank.service.store import Store

ORDER = ("model", "objectives", "optimise", "service")  # each may import itself and those before it
SLOW = (
    *("numba", "numpy", "numpy.ma", "pandas", "matplotlib", "cvxpy", "optuna", "scipy", "scipy.stats", "pint"),
    *("pydantic", "sqlalchemy", "alembic", "fastapi", "uvicorn", "httpx", "distributed", "psutil", "rich"),
)


@pytest.fixture(scope="module")
def root(pytestconfig: pytest.Config) -> Path:
    return pytestconfig.rootpath


@cache
def import_statements(file: Path) -> list[ast.Import | ast.ImportFrom]:
    return [node for node in ast.walk(ast.parse(file.read_bytes())) if isinstance(node, ast.Import | ast.ImportFrom)]


def test_listed_packages_are_the_folders_on_disk(root: Path) -> None:
    with (root / "pyproject.toml").open("rb") as file:
        listed = tomllib.load(file)["tool"]["setuptools"]
    folders = {file.parent.relative_to(root) for top in ORDER for file in (root / top).rglob("*.py")}
    assert sorted(listed["packages"]) == sorted(
        ["slidercrank", *(".".join(["slidercrank", *folder.parts]) for folder in folders)]
    )
    assert [folder for folder in folders if not (root / folder / "__init__.py").is_file()] == []
    assert listed["package-dir"] == {
        "slidercrank": ".package/slidercrank",
        **{f"slidercrank.{top}": top for top in ORDER},
    }


def test_the_distribution_says_who_made_it_and_under_which_licence(root: Path) -> None:
    """Check the licence, as the citation does; no typeface is installed, so its licence is not needed."""
    with (root / "pyproject.toml").open("rb") as file:
        project = tomllib.load(file)["project"]
    citation = (root / "CITATION.cff").read_text(encoding="utf-8")
    assert project["authors"] == [{"name": name} for name in re.findall(r"^  - name: (.+)$", citation, re.MULTILINE)]
    for key in ("version", "license"):
        assert re.findall(rf"^{key}: (.+)$", citation, re.MULTILINE) == [project[key]]
    texts = [(root / name).read_text(encoding="utf-8") for name in project["license-files"]]
    assert ["Apache License" in text for text in texts] == [True]
    fonts = [
        file for top in ORDER for file in (root / top).rglob("*") if file.suffix in (".ttf", ".otf", ".woff", ".woff2")
    ]
    assert fonts == []


def test_links_for_type_checkers_lead_to_the_same_files(root: Path, tmp_path: Path) -> None:
    for _ in range(2):  # again, with links that are there
        subprocess.run([sys.executable, root / ".package/links.py", tmp_path], check=True)
    links = {link.name: link for link in (tmp_path / "slidercrank").iterdir()}
    front_door = (root / ".package/slidercrank").resolve()
    expected = {name: front_door / name for name in ("__init__.py", "__main__.py", "py.typed")}
    expected |= {top: (root / top).resolve() for top in ORDER}
    assert links.keys() == expected.keys()
    for name, link in links.items():  # on Windows, files are copies
        assert link.resolve() == expected[name] or link.read_bytes() == expected[name].read_bytes()


def test_checkout_holds_no_symbolic_links(root: Path) -> None:
    if not (root / ".git").exists():
        pytest.skip("no checkout of git")
    tracked = subprocess.run(["git", "ls-files", "--stage"], cwd=root, capture_output=True, text=True, check=True)
    assert [line for line in tracked.stdout.splitlines() if line.startswith("120000")] == []


def test_nothing_that_is_ignored_is_in_the_checkout(root: Path) -> None:
    if not (root / ".git").exists():
        pytest.skip("no checkout of git")
    command = ["git", "ls-files", "--cached", "--ignored", "--exclude-standard"]
    assert subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout == ""


@pytest.mark.parametrize("folder", ORDER)
def test_imports_point_one_way(root: Path, folder: str) -> None:
    allowed = ORDER[: ORDER.index(folder) + 1]
    wrong = [
        f"{file.relative_to(root)}:{line} imports {target}"
        for file in sorted((root / folder).rglob("*.py"))
        for line, target in imports_within_the_project(file, root)
        if target not in allowed
    ]
    assert not wrong, "\n".join(wrong)


def imports_within_the_project(file: Path, root: Path) -> Iterator[tuple[int, str]]:
    """Yield line and folder of every import of project code, wherever it stands in the file.

    Absolute imports of it are given as they are written: inside the folders none is allowed.
    """
    package = file.relative_to(root).parent.parts
    for node in import_statements(file):
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.split(".")[0] in ("slidercrank", *ORDER):
                    yield node.lineno, f"{alias.name} (absolute)"
        elif isinstance(node, ast.ImportFrom):
            path = node.module.split(".") if node.module else []
            if node.level == 0:
                if path[0] in ("slidercrank", *ORDER):
                    yield node.lineno, f"{node.module} (absolute)"
                continue
            path = [*package[: len(package) + 1 - node.level], *path]
            for target in path[:1] or [alias.name for alias in node.names]:
                yield node.lineno, target


@pytest.mark.parametrize("folder", ORDER)
def test_no_modules_and_no_rooms_import_each_other_in_a_circle(root: Path, folder: str) -> None:
    """Imports for types and deferred ones count. A room is a folder of the first level, or a module beside them."""
    imports = imports_between_modules(root, folder)
    assert circles(imports) == []

    def room(module: str) -> str:
        return ".".join(module.split(".")[:2])

    rooms: dict[str, set[str]] = {}
    for module, targets in imports.items():
        rooms.setdefault(room(module), set()).update(room(target) for target in targets if room(target) != room(module))
    assert circles(rooms) == []


def test_only_the_command_line_imports_commands(root: Path) -> None:
    importers = {
        module
        for module, targets in imports_between_modules(root, "service").items()
        if not module.startswith("service.commands.") and any(t.startswith("service.commands.") for t in targets)
    }
    assert importers == {"service.cli"}


def imports_between_modules(root: Path, folder: str) -> dict[str, set[str]]:
    """Return the modules of a folder by their dotted names, each with the modules of the folder that it imports."""
    files = {
        ".".join((path.parent if path.name == "__init__.py" else path.with_suffix("")).parts): path
        for path in (file.relative_to(root) for file in (root / folder).rglob("*.py"))
    }
    found: dict[str, set[str]] = {}
    for module, path in files.items():
        package = path.parent.parts
        targets = found.setdefault(module, set())
        for node in import_statements(root / path):
            if not (isinstance(node, ast.ImportFrom) and node.level):
                continue
            source = ".".join([*package[: len(package) + 1 - node.level], *(node.module or "").split(".")]).rstrip(".")
            for alias in node.names:
                inner = f"{source}.{alias.name}"
                targets.add(inner if inner in files else source)
        targets &= files.keys() - {module}
    return found


def circles(imports: dict[str, set[str]]) -> list[list[str]]:
    """Return a circle of imports, as its modules in order, or none."""
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return [error.args[1]]
    return []


def test_circles_of_imports_are_found() -> None:
    assert circles({"a": {"b"}, "b": {"c"}, "c": set()}) == []
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}})


def test_public_names_are_listed_and_importable() -> None:
    assert {"Linkage", "__version__", "load_job", "problem", "solve"} <= set(slidercrank.__all__)
    assert sorted(slidercrank.__all__) == slidercrank.__all__
    assert set(slidercrank.__all__) <= set(dir(slidercrank))
    for name in slidercrank.__all__:
        assert getattr(slidercrank, name) is not None


def test_unknown_public_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="'slidercrank' has no attribute 'optimize'"):
        getattr(slidercrank, "optimize")  # noqa: B009 - mypy knows that it is not there


DESIGN = ("--crank", "60 mm", "--rod", "230 mm", "--offset", "70 mm")
OPTIMISE = ("optimise", "JOB", "--no-figures", "--designs", "6")


def imported(command: tuple[str, ...], folder: Path, root: Path) -> set[str]:
    """Slow modules that a command has imported at its end."""
    line = ["slidercrank", *(str(root / "runs/feeder.toml") if word == "JOB" else word for word in command)]
    code = f"from slidercrank.service.cli import main; sys.argv = {line}; main()" if command else "import slidercrank"
    report = f"sys.stderr.write(json.dumps([name for name in {SLOW} if name in sys.modules]))"
    script = f"import atexit, json, sys; atexit.register(lambda: {report}); {code}"
    done = subprocess.run([sys.executable, "-c", script], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return set(json.loads(done.stderr.splitlines()[-1]))


@pytest.fixture(scope="module")
def solved(root: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, set[str]]:
    """Folder with a run in its `runs`, and what was imported for it; to make the store takes alembic."""
    folder = tmp_path_factory.mktemp("solved")
    (folder / "runs").mkdir()
    Store(folder / "runs/slidercrank.db").close()
    return folder, imported(OPTIMISE, folder, root)


@pytest.mark.parametrize(
    ("command", "needed"),
    [
        ((), set()),
        (("--help",), set()),
        (("check", "JOB"), {"numpy", "pydantic", "rich"}),
        (("analyse", "JOB", *DESIGN), {"numpy", "pydantic", "rich"}),
        (OPTIMISE, {"numpy", "pydantic", "rich", "psutil", "sqlalchemy"}),
        (("front", "latest"), {"numpy", "pydantic", "rich", "psutil", "sqlalchemy"}),
        (("jobs", "--store", "runs/slidercrank.db"), {"pydantic", "rich", "psutil", "sqlalchemy"}),
    ],
    ids=["import", "help", "check", "analyse", "optimise", "front", "jobs"],
)
def test_nothing_slow_is_imported_before_it_is_needed(
    command: tuple[str, ...], needed: set[str], solved: tuple[Path, set[str]], root: Path
) -> None:
    folder, while_solving = solved
    assert (while_solving if command == OPTIMISE else imported(command, folder, root)) <= needed
