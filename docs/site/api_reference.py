"""The reference of the HTTP API as Markdown, from its OpenAPI description."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from docs.site.schema_tables import cell, definitions, kind, meaning

_METHODS = ("get", "post", "put", "patch", "delete")


def api_reference() -> str:
    """Return the page: operations by subject, then the shapes of requests and responses."""
    description = _description()
    lines = [
        "# HTTP API\n",
        f"Every operation of version {description['info']['version']}, as described by the service at "
        "`/api/v1/openapi.json`. [API](../api.md) shows examples. Requests carry the token as "
        "`Authorization: Bearer TOKEN`; errors are problem documents (RFC 9457).\n",
    ]
    operations = [
        (method, path, operation)
        for path, methods in description["paths"].items()
        for method, operation in methods.items()
        if method in _METHODS
    ]
    for subject in dict.fromkeys(operation.get("tags", ["other"])[0] for _, _, operation in operations):
        lines.append(f"## {subject}\n")
        for method, path, operation in operations:
            if operation.get("tags", ["other"])[0] == subject:
                lines.extend(_operation(method, path, operation))
    return "\n".join([*lines, "## Shapes\n", *definitions(description["components"]["schemas"], 3)])


def _description() -> dict[str, Any]:
    from slidercrank.service.api.app import create_app
    from slidercrank.service.api.settings import Settings
    from slidercrank.service.store import Store

    with tempfile.TemporaryDirectory() as folder, Store(Path(folder) / "store.db") as store:
        found: dict[str, Any] = create_app(store, Settings(token="of-the-reference")).openapi()
    return found


def _operation(method: str, path: str, operation: Mapping[str, Any]) -> Iterator[str]:
    yield f"### {method.upper()} {path}\n"
    yield f"{operation.get('description') or operation.get('summary', '')}\n"
    parameters = operation.get("parameters", ())
    if parameters:
        yield "| parameter | in | value | meaning |\n|---|---|---|---|"
        for one in parameters:
            field = {**one["schema"], **({"description": one["description"]} if "description" in one else {})}
            where = f"{one['in']}{', required' if one.get('required') and one['in'] != 'path' else ''}"
            yield f"| `{one['name']}` | {where} | {cell(kind(field))} | {cell(meaning(field))} |"
        yield ""
    body = operation.get("requestBody", {}).get("content", {})
    if body:
        yield f"Body: {_content(body)}.\n"
    yield "| status | response |\n|---|---|"
    for status, answer in sorted(operation["responses"].items()):
        shown = _content(answer.get("content", {}))
        yield f"| {status} | {cell(answer['description'])}{f': {cell(shown)}' if shown else ''} |"
    yield ""


def _content(content: Mapping[str, Any]) -> str:
    """Return the media types of a body, each with its shape."""
    return " or ".join(
        f"`{media}`, {kind(said['schema'])}" if said.get("schema") and media.endswith("json") else f"`{media}`"
        for media, said in content.items()
    )
