"""Table of all questions in `questions.csv`: where each is declared, its interfaces, and its size.

`python -m tests.service.table_of_questions` writes it anew; scripts of the page and the reason for them stay.
"""

from __future__ import annotations

import ast
import csv
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

from typer.main import get_command

import slidercrank as sc
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.problem.questions import questions as announced
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
COLUMNS = ("question", "file", "subject", "doors", "statements", "javascript", "scripts", "why")
FORMS = {"round": "rounded", "certify": "certificate", "compare": "comparison"}
"""Names in the API and its client, where they are not those of the commands."""
UNDECLARED = {
    "compare": ("runs", "service/designs/front_comparison.py service/commands/compare.py service/api/comparison.py"),
    "check": ("job", "service/preview/preview.py service/commands/job.py service/api/preview.py"),
    "what-if": ("design", "service/designs/variation.py service/api/what_if.py"),
    "trade-offs": ("design", "service/designs/trade_offs.py"),
}
"""Subject and files of what is asked without a declaration of its own."""
SHOWN = ("certify", "trade-offs")
"""What the page shows as it shows questions to a design, from the blocks of their answers."""
_STATEMENT = re.compile(r";$|^(if|for|while|switch|try|do|(export )?(default )?(async )?(function|class))\b")


def python_statements(file: Path) -> int:
    """Return the statements of a module without docstrings."""
    nodes = list(ast.walk(ast.parse(file.read_text(encoding="utf-8"))))
    docs = sum(isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) for node in nodes)
    return sum(isinstance(node, ast.stmt) for node in nodes) - docs


def script_statements(file: Path) -> int:
    """Return the statements of a formatted module of JavaScript: lines that end one, or begin one with a block."""
    text = re.sub(r"/\*.*?\*/", "", file.read_text(encoding="utf-8"), flags=re.DOTALL)
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


def _doors(name: str, paths: list[str], commands: set[str], drawn: bool) -> Iterator[str]:
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
    if name in announced() or hasattr(ParetoFront, name) or hasattr(sc.Problem, name):
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
    by_hand = {row["question"]: (row["scripts"], row["why"]) for row in known}
    asked: dict[str, tuple[str, str]] = {
        name: (getattr(question, "subject", "design"), f"service/questions/{name}")
        for name, question in declared().items()
    }
    asked |= {name: of for name, of in UNDECLARED.items() if name not in asked}
    found = []
    for name, (subject, place) in asked.items():
        scripts, why = by_hand.get(name, ("", ""))
        modules = [file for part in place.split() for file in _modules(ROOT / part)]
        found.append(
            {
                "question": name,
                "file": place,
                "subject": subject,
                "doors": ", ".join(_doors(name, paths, commands, bool(scripts))),
                "statements": str(sum(map(python_statements, modules))),
                "javascript": str(sum(script_statements(PAGE / script) for script in scripts.split())),
                "scripts": scripts,
                "why": why,
            }
        )
    return found


def _modules(place: Path) -> list[Path]:
    return sorted(place.glob("*.py")) if place.is_dir() else [place]


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
