"""Options that the interfaces offer, by the program's own description, and the cases that exercise them."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import typer

from slidercrank.service.api.app import create_app
from slidercrank.service.cli import app
from slidercrank.service.store import Store
from tests.doors.scripts import Case

Operation = tuple[str, str]
"""Method and path of the description of the API."""


def commands() -> dict[str, list[Any]]:
    """Return the options of every command, as the command line has them; "" is the program itself."""
    program: Any = typer.main.get_command(app)
    context = program.make_context("slidercrank", ["--help"], resilient_parsing=True)
    found = {"": program.get_params(context)}
    for name in program.list_commands(context):
        command = program.get_command(context, name)
        found[name] = command.get_params(command.make_context(name, [], parent=context, resilient_parsing=True))
    return {name: [one for one in given if one.param_type_name == "option"] for name, given in found.items()}


def names_of(option: Any) -> list[str]:
    """Return the long names of an option, that which turns it off included."""
    return [name for name in (*option.opts, *option.secondary_opts) if name.startswith("--")]


def untried_options(cases: Iterable[Case]) -> Iterator[str]:
    """Yield every option, system of units and kind of output that no case has."""
    typed = [case.words for case in cases if case.is_command]
    for command, options in commands().items():
        lines = [words for words in typed if (words[0] if words and not words[0].startswith("-") else "") == command]
        known = {name for option in options for name in names_of(option)}
        for name in sorted(known):
            if not any(name in words for words in lines):
                yield f"{command} {name}"
        if "--json" in known and all("--json" in words for words in lines if "--help" not in words):
            yield f"{command} without --json"
        if "--units" in known:
            for system in ("inch", "metric"):
                if not any(("inch" if "inch" in words else "metric") == system for words in lines):
                    yield f"{command} in {system} units"


def described() -> dict[Operation, Any]:
    """Return every operation of the description of the API."""
    with tempfile.TemporaryDirectory() as folder, Store(Path(folder) / "empty.db") as store:
        description = create_app(store).openapi()
    shapes = description["components"]["schemas"]
    found = {}
    for path, methods in description["paths"].items():
        for method, operation in methods.items():
            found[method.upper(), path] = operation
            for content in operation.get("requestBody", {}).get("content", {}).values():
                name = content["schema"].get("$ref", "").rpartition("/")[2]
                operation["keys"] = sorted({*operation.get("keys", ()), *shapes.get(name, {}).get("properties", {})})
    return found


def operation_of(case: Case, operations: Iterable[Operation]) -> Operation | None:
    """Return the operation that a request asks for: of several paths that fit, the one with most of its letters."""
    fitting = [one for one in operations if one[0] == case.method and case.asks(one[1])]
    return max(fitting, key=lambda one: len(re.sub(r"\{[^}]+\}", "", one[1])), default=None)


def untried_operations(cases: Iterable[Case]) -> Iterator[str]:
    """Yield every operation that no case succeeds at, or none is refused at; and each parameter that none sends."""
    operations = described()
    asked: dict[Operation, list[Case]] = {one: [] for one in operations}
    for case in cases:
        operation = None if case.is_command else operation_of(case, operations)
        if operation is not None:
            asked[operation].append(case)
    for operation, requests in asked.items():
        name = " ".join(operation)
        answered = [case for case in requests if case.code < 400]
        if not answered:
            yield f"{name} answered"
        if len(answered) == len(requests):
            yield f"{name} refused"
        sent = {key.lower() for case in answered for key in (*case.parameters, *case.rest[0])}
        sent |= {key for case in answered for key in case.keys_sent}
        wanted = [one["name"] for one in operations[operation].get("parameters", []) if one["in"] != "path"]
        for key in (*wanted, *operations[operation].get("keys", ())):
            if key.lower() not in sent:
                yield f"{name} with {key}"
