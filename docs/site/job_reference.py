"""The reference of job files as Markdown, from their JSON schema."""

from __future__ import annotations

from docs.site.schema_tables import cell, definitions, kind, meaning
from slidercrank.optimise.job import job_schema


def job_reference() -> str:
    """Return the page: the tables of a job, then the parts that they are made of."""
    schema = job_schema()
    required = schema["required"]
    lines = [
        "# Job file\n",
        "Every table and key of a job file, from the schema that `slidercrank schema` prints. "
        "[Jobs](../jobs.md) explains them with examples. A quantity is a number with its unit in a string, or a plain "
        "number in SI.\n",
        "| table or key | value | meaning | |\n|---|---|---|---|",
    ]
    for name, field in schema["properties"].items():
        lines.append(
            f"| `{name}` | {cell(kind(field))} | {cell(meaning(field))} | {'required' if name in required else ''} |"
        )
    return "\n".join([*lines, "\n## Parts\n", *definitions(schema["$defs"], 3)])
