"""Table of all questions in `questions.csv`: where each is declared, its interfaces, and its size.

`python -m tests.service.table_of_questions` writes it anew; scripts of the page, the reason for them, and the names of
former files stay.
"""

from __future__ import annotations

import ast
import csv
import re
import shutil
import subprocess
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

from typer.main import get_command

import slidercrank as sc
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.problem.question_registry import questions as announced
from slidercrank.service import questions as folder
from slidercrank.service.agents.server import TOOLS
from slidercrank.service.api.app import create_app
from slidercrank.service.cli import app
from slidercrank.service.client import Client
from slidercrank.service.questions.discovery import QUESTION_COMMANDS, QUESTIONS, TOPICS
from slidercrank.service.store import Store

FILE = Path(__file__).with_name("questions.csv")
ROOT = Path(__file__).parents[2]
PAGE = ROOT / "service" / "page" / "static"
_FORMER = ("files_before", "statements_before", "scripts_before", "javascript_before")
COLUMNS = ("question", "file", "subject", "doors", "statements", "javascript", "scripts", "why", *_FORMER)
BEFORE = "87b2afbe"
"""Commit before questions were declared, with the page's JavaScript formatted as now."""
FORMS = {"round": "rounded", "certify": "certificate", "compare": "comparison"}
"""Names in the API and its client, where they are not those of the commands."""
BESIDE = {
    "compare": "service/designs/front_comparison.py",
    "wish": "service/commands/wish.py service/api/wish.py service/jobs/front_wish_history.py",
}
"""Modules that serve a single question, beside its folder. What serves several ones is in the row of the service."""
UNDECLARED = {
    "check": ("job", "service/preview/preview.py service/commands/job_files.py service/api/preview.py"),
    "what-if": ("design", "service/designs/changed_design.py service/api/what_if.py"),
    "trade-offs": ("design", "service/designs/trade_offs.py"),
}
"""Subject and files of what is asked without a declaration of its own.

A check is about tables that may be wrong or half written, which are no subject of a question; its interfaces share
`look_at` and `job_in_words`. What-if is asked while a slider moves, and links to the designs that are better.
"""
EVERYTHING = "(all of the service)"
"""Row with all modules of the service, also those that serve several questions or none."""
SHOWN = ("certify", "compare", "like", "trade-offs")
"""What the page shows as it shows questions to a design, from the blocks of their answers."""
_STATEMENT = re.compile(r";$|^(if|for|while|switch|try|do|(export )?(default )?(async )?(function|class))\b")


def python_statements(module: str) -> int:
    """Return the statements of a module without docstrings."""
    nodes = list(ast.walk(ast.parse(module)))
    docs = sum(isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) for node in nodes)
    return sum(isinstance(node, ast.stmt) for node in nodes) - docs


def script_statements(module: str) -> int:
    """Return the statements of a formatted module of JavaScript: lines that end one, or begin one with a block."""
    text = re.sub(r"/\*.*?\*/", "", module, flags=re.DOTALL)
    return sum(bool(_STATEMENT.search(line.strip())) for line in text.splitlines())


def declared() -> dict[str, Any]:
    """Return the questions that are declared by a folder, by name, those of designs first."""
    package = folder.__name__
    found = {}
    for name in sorted(item.name for item in iter_modules(folder.__path__) if item.ispkg):
        module = import_module(f"{package}.{name}")
        question = getattr(module, "QUESTION", getattr(module, name.upper(), None))
        if question is not None:
            found[name] = question
    return dict(sorted(found.items(), key=lambda item: getattr(item[1], "subject", "") != ""))


def _paths(store: Path) -> list[str]:
    with Store(store / "empty.db") as opened:
        return list(create_app(opened).openapi()["paths"])


def _doors(name: str, paths: list[str], commands: set[str], drawn: bool, subject: str) -> Iterator[str]:
    """Yield the doors at which a question is had, as far as these tell themselves."""
    form = FORMS.get(name, name)
    called = (QUESTION_COMMANDS[name].called or name) if name in QUESTION_COMMANDS else name
    if name in TOPICS:
        yield "analyse --show"
    elif called in commands:
        yield called
    elif name == "measured":
        yield "analyse --measured"
    if name in TOPICS or any(path.endswith(f"/{form}") for path in paths):
        yield "API"
    if (name in announced() and subject != "runs") or hasattr(ParetoFront, name) or hasattr(sc.Problem, name):
        yield "Python"
    served = name in QUESTIONS and bool(getattr(QUESTIONS[name], "path", True))
    if served or hasattr(Client, form.replace("-", "_")):
        yield "client"
    if name in TOPICS or name in QUESTION_COMMANDS or name in SHOWN or drawn:
        yield "page"
    reported = (file.read_text(encoding="utf-8") for file in (ROOT / "service" / "report").glob("*.py"))
    if any(f"questions.{name}." in text for text in reported):
        yield "report"
    if name in QUESTIONS or name in {tool.name for tool in TOOLS}:
        yield "MCP"


def rows(store: Path, known: list[dict[str, str]]) -> list[dict[str, str]]:
    """Return the table as the code has it now. store: a folder for an empty one. known: for scripts and reasons."""
    paths, commands = _paths(store), set(get_command(app).commands)  # type: ignore[attr-defined]
    by_hand = {row["question"]: row for row in known}
    asked: dict[str, tuple[str, str]] = {
        name: (getattr(question, "subject", "design"), f"service/questions/{name} {BESIDE.get(name, '')}".strip())
        for name, question in declared().items()
    }
    asked |= {name: of for name, of in UNDECLARED.items() if name not in asked}
    asked[EVERYTHING] = ("", "service")
    found: list[dict[str, str]] = []
    for name, (subject, place) in asked.items():
        written = by_hand.get(name, dict.fromkeys(COLUMNS, ""))
        scripts = written["scripts"]
        found.append(
            {
                "question": name,
                "file": place,
                "subject": subject,
                "doors": ", ".join(_doors(name, paths, commands, bool(scripts), subject)),
                "statements": str(_statements(place)),
                "javascript": str(_script_statements(scripts)),
                **{column: written[column] for column in ("scripts", "why", *_FORMER)},
            }
        )
        if name == EVERYTHING:
            found[-1]["javascript"] = str(_script_statements(_all_scripts("")))
        if _has_commit():
            scripts = _all_scripts(BEFORE) if name == EVERYTHING else written["scripts_before"]
            found[-1]["statements_before"] = str(_statements(written["files_before"], BEFORE))
            found[-1]["javascript_before"] = str(_script_statements(scripts, BEFORE))
    return found


def _all_scripts(commit: str) -> str:
    folder = "service/page/static/"
    files = _files([folder.rstrip("/")], commit)
    return " ".join(file.removeprefix(folder) for file in files if file.endswith(".js"))


def _statements(places: str, commit: str = "") -> int:
    """Return the statements of Python modules and folders. commit: now if empty."""
    files = _files([place for place in places.split() if place], commit) if places else []
    return sum(python_statements(_text(file, commit)) for file in files if file.endswith(".py"))


def _script_statements(scripts: str, commit: str = "") -> int:
    return sum(script_statements(_text(f"service/page/static/{script}", commit)) for script in scripts.split())


def _files(places: list[str], commit: str) -> list[str]:
    if commit:
        return _git("ls-tree", "-r", "--name-only", commit, *places).splitlines()
    found = (sorted((ROOT / place).rglob("*")) if (ROOT / place).is_dir() else [ROOT / place] for place in places)
    return [str(file.relative_to(ROOT)) for files in found for file in files]


def _text(file: str, commit: str) -> str:
    return _git("show", f"{commit}:{file}") if commit else (ROOT / file).read_text(encoding="utf-8")


def _git(*words: str) -> str:
    return subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True, check=True).stdout


@cache
def _has_commit() -> bool:
    """Whether this copy has the commit from before: an archive or a shallow clone has not."""
    words = ["git", "-C", str(ROOT), "cat-file", "-e", f"{BEFORE}^{{commit}}"]
    return shutil.which("git") is not None and subprocess.run(words, capture_output=True, check=False).returncode == 0


def read() -> list[dict[str, str]]:
    """Return the table as it is written."""
    with FILE.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def main() -> None:
    """Write the table anew."""
    import tempfile

    with tempfile.TemporaryDirectory() as store:
        now = rows(Path(store), read() if FILE.is_file() else [])
    with FILE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(now)


if __name__ == "__main__":
    main()
