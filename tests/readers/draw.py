"""Draw what readers and editors judge: `python -m tests.readers.draw names SEED`, or `sentences SEED`, from the root.

A reader says from path and signature alone what each of 60 functions does and what each of 20 modules has. An editor
marks each of 200 sentences that a native speaker would not write.
"""

from __future__ import annotations

import ast
import random
import re
import sys
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

FOLDERS = ("model", "objectives", "optimise", "service")
FUNCTIONS, MODULES, SENTENCES = 60, 20, 200
LEAST_WORDS = 5  # of a sentence


def modules() -> list[Path]:
    """Return the modules of the product, without the generated migrations."""
    found = chain.from_iterable(Path(folder).rglob("*.py") for folder in FOLDERS)
    return sorted(path for path in found if "versions" not in path.parts)


def signatures(path: Path) -> Iterator[str]:
    """Yield the functions of a module by path, class and signature; nested ones are of their function alone."""

    def within(node: ast.AST, prefix: str) -> Iterator[str]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.ClassDef):
                yield from within(child, f"{prefix}{child.name}.")
            elif isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef) and not child.name.startswith("__"):
                returned = f" -> {ast.unparse(child.returns)}" if child.returns else ""
                yield f"{path}  {prefix}{child.name}({ast.unparse(child.args)}){returned}"

    yield from within(ast.parse(path.read_text()), "")


def sentences_of(text: str) -> Iterator[str]:
    """Yield the sentences of a text, without headings and code."""
    prose = re.sub(r"(?ms)^```.*?^```|^#[^\n]*", "", text)
    for paragraph in re.split(r"\n\s*\n|\n\s*[-*|] | \| ", prose):
        for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z`])", " ".join(paragraph.split())):
            if len(re.findall(r"[A-Za-z]{2,}", sentence)) >= LEAST_WORDS and "__" not in sentence:
                yield sentence


def texts_of(path: Path) -> Iterator[tuple[str, str]]:
    """Yield the docstrings and messages of a module, each with its kind."""
    tree = ast.parse(path.read_text())
    nodes = list(ast.walk(tree))
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    pieces = {id(part) for node in nodes if isinstance(node, ast.JoinedStr) for part in node.values}
    for node in nodes:
        if isinstance(node, ast.JoinedStr):
            filled = (part.value if isinstance(part, ast.Constant) else "{…}" for part in node.values)
            yield "message", "".join(map(str, filled))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in pieces:
            yield ("docstring" if id(node) in docstrings else "message"), node.value


def sentences() -> dict[str, list[str]]:
    """Return all sentences of the product by where they stand."""
    found: dict[str, list[str]] = {"docs": [], "docstring": [], "message": [], "page": []}
    for page in [Path("README.md"), *sorted(Path("docs").glob("*.md"))]:
        found["docs"] += [f"{page}: {sentence}" for sentence in sentences_of(page.read_text())]
    for path in modules():
        for kind, text in texts_of(path):
            found[kind] += [f"{path}: {sentence}" for sentence in sentences_of(text)]
    for script in sorted(Path("service/page/static").rglob("*.js")):
        texts = re.findall(r'["`>]([A-Z][^"`<\n]{20,})["`<]', script.read_text())
        found["page"] += [f"{script}: {sentence}" for text in texts for sentence in sentences_of(text)]
    return found


def main(what: str, seed: int) -> None:
    """Print what is drawn, numbered."""
    draw = random.Random(seed)
    if what == "names":
        functions = draw.sample([line for path in modules() for line in signatures(path)], FUNCTIONS)
        drawn = sorted(functions) + sorted(map(str, draw.sample(modules(), MODULES)))
    else:
        by_kind = sentences()
        drawn = [line for kind in by_kind for line in sorted(draw.sample(by_kind[kind], SENTENCES // len(by_kind)))]
    sys.stdout.writelines(f"{number}\t{line}\n" for number, line in enumerate(drawn, 1))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
