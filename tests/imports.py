"""Imports between the Python and JavaScript files of the project, also within functions and for types."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

FRONT_DOOR = Path(".package/slidercrank/__init__.py")
FOLDERS = ("model", "objectives", "optimise", "service", "benchmarks", "tests", FRONT_DOOR.parent.as_posix())
APP, PAGE_TESTS = Path("service/page/static/app.js"), Path("tests/service/page")

_FROM = re.compile(r"^[ \t]*from[ \t]+(\.*)([\w.]*)[ \t]+import[ \t]+(\([^)]*\)|[^\n]*)", re.MULTILINE)
_IMPORT = re.compile(r"^[ \t]*import[ \t]+([\w.]+)(?:[ \t]+as[ \t]+(\w+))?", re.MULTILINE)
_COMMENT = re.compile(r"#[^\n]*")
_SCRIPT = re.compile(r"""(?:\bfrom|\bimport)\s*\(?\s*["'](\.{1,2}/[^"']+)["']""")
_VIEW = re.compile(r"match: \(parts\) => (.*?),\s+load: \(\) => import\(\"\./(.*?)\"\)")


def files_of(root: Path, *suffixes: str) -> list[Path]:
    """Return the files of the project, only those with the suffixes if given, by paths from the top."""
    every = (file for folder in FOLDERS for file in (root / folder).rglob("*") if file.is_file())
    found = (file for file in every if not suffixes or file.suffix in suffixes)
    return sorted(file.relative_to(root) for file in found)


def importers(root: Path) -> dict[Path, set[Path]]:
    """Return the files that import each file.

    A module that no other module imports is loaded by its folder, as quantities and commands are: its importers are the
    modules that call `import_module` in the nearest folder above it that has any. Data is read by the modules in the
    nearest folder above it. A view of the page is opened by the tests that name its address.
    """
    texts = {file: (root / file).read_text(encoding="utf-8") for file in files_of(root, ".py", ".js", ".mjs")}
    python = {file: text for file, text in texts.items() if file.suffix == ".py"}
    modules = {_module_name(file): file for file in python}
    names = {file: dict(_imported(text, file, modules)) for file, text in python.items()}
    found: dict[Path, set[Path]] = defaultdict(set)
    for file, text in python.items():
        for target in {*names[file].values(), *_reexported_from(text, names[file], names)} - {file}:
            found[target].add(file)
    sources = [file for file in python if file.parts[0] != "tests"]
    finders = [file for file in sources if "import_module(" in python[file]]
    for file in sources:
        if not found[file] and file.name != "__init__.py":
            found[file] |= _nearest(file, finders)
    for file in [file for file in found if file.name != "__init__.py"]:  # importing a module runs its package first
        for folder in file.parents[:-1]:
            found[folder / "__init__.py"] |= found[file]
    for file in texts.keys() - python.keys():
        for path in _SCRIPT.findall(texts[file]):
            found[(root / file.parent / path).resolve().relative_to(root.resolve())].add(file)
    for view, address in _addresses(texts.get(APP, "")):
        found[view] |= {file for file in python if file.is_relative_to(PAGE_TESTS) and address.search(python[file])}
    for file in files_of(root):
        if not found[file] and file.parts[0] != "tests" and file.suffix not in (".py", ".pyc"):
            found[file] |= _nearest(file, sources)
    return found


def _module_name(file: Path) -> str:
    """Return the name by which a module is imported."""
    parts = (file.parent if file.name == "__init__.py" else file.with_suffix("")).parts
    if file.is_relative_to(FRONT_DOOR.parent):
        return ".".join(parts[1:])
    return ".".join(parts if parts[0] in ("tests", "benchmarks") else ("slidercrank", *parts))


def _imported(text: str, file: Path, modules: dict[str, Path]) -> Iterator[tuple[str, Path]]:
    """Yield the names under which a module imports from the project, and the files that they come from."""
    package = _module_name(file).split(".")[: None if file.name == "__init__.py" else -1]
    for name, alias in _IMPORT.findall(text):
        if name in modules:
            yield alias or name, modules[name]
    for dots, module, taken in _FROM.findall(text):
        above = package[: len(package) + 1 - len(dots)] if dots else []
        source = ".".join(filter(None, [*above, module]))
        for item in _COMMENT.sub("", taken).strip("()\n ").split(","):
            name, _, alias = item.strip().partition(" as ")
            target = modules.get(f"{source}.{name}") or modules.get(source)
            if name and target is not None:
                yield alias or name, target


def _reexported_from(text: str, own: dict[str, Path], names: dict[Path, dict[str, Path]]) -> Iterator[Path]:
    """Yield the files that define the names that a module imports from packages that re-export them."""
    for name, source in own.items():
        if source.name == "__init__.py":
            taken = [name, *re.findall(rf"\b{re.escape(name)}\.(\w+)", text)]
            yield from (names[source][inner] for inner in taken if inner in names[source])


def _nearest(file: Path, others: list[Path]) -> set[Path]:
    """Return the other files in the nearest folder above a file that has any."""
    folders = ({other for other in others if other.parent == folder} - {file} for folder in file.parents)
    return next(filter(None, folders), set())


def _addresses(app: str) -> Iterator[tuple[Path, re.Pattern[str]]]:
    """Yield the views of the page and patterns of their addresses, as in "#/jobs/1/designs/2"."""
    for rule, view in _VIEW.findall(app):
        given = dict(re.findall(r'parts\[(\d)\] === "(\w+)"', rule))
        way, most = re.findall(r"length (===|<=) (\d)", rule)[0]
        parts = [rf"/{given.get(str(k), '[^/?#]+')}" for k in range(int(most))]
        sure = len(parts) if way == "===" else len(given)
        address = "".join(parts[:sure]) + "".join(f"(?:{part})?" for part in parts[sure:])
        yield APP.parent / view, re.compile(rf"#{address or '/'}(?=[\"'?{{$]|$)", re.MULTILINE)
