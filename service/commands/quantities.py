"""`slidercrank quantities`: the numbers that objectives and constraints may name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ..text.options import Json
from ..text.screen import print_record

if TYPE_CHECKING:
    from rich.console import Console


def quantities(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="NAME", help="Quantities to explain. [default: list all]")
    ] = None,
    *,
    json: Json = False,
) -> None:
    """List the quantities for objectives and constraints, or explain some.

    Explains meaning, formula, unit and column, and what a job must have.
    """
    from ..designs.quantity_facts import facts_of_all

    facts = {item["name"]: item for item in facts_of_all()}
    for name in names or ():
        if name not in facts:
            from ...objectives.units import closest

            near = closest(name, facts)
            remedy = f"did you mean {near}?" if near else "list all with `slidercrank quantities`"
            raise InputError(f"no quantity is called {name!r}; {remedy}")
    chosen = [facts[name] for name in dict.fromkeys(names or facts)]
    print_record(json, {"quantities": chosen}, lambda screen: (_explain if names else _list)(screen, chosen))


def _list(screen: Console, facts: list[dict[str, Any]]) -> None:
    """Print name, unit and title of quantities, by group."""
    widths = [max(len(item[key]) for item in facts) for key in ("name", "unit")]
    for group in dict.fromkeys(item["group"] for item in facts):
        screen.print(f"{group}:", style="bold", soft_wrap=True)
        for item in facts:
            if item["group"] == group:
                name, unit = (item[key].ljust(width) for key, width in zip(("name", "unit"), widths, strict=True))
                screen.print(f"  {name}  {unit}  {item['title']}", soft_wrap=True)


def _explain(screen: Console, facts: list[dict[str, Any]]) -> None:
    for item in facts:
        screen.print(f"{item['name']}: {item['title']}", style="bold", soft_wrap=True)
        screen.print(" ".join(filter(None, (item["sentence"], item["advice"]))), soft_wrap=True)
        lines = {
            "formula": item["formula"],
            "unit": item["unit"] or "none",
            "column": item["column"],
            "good side": item["better"],
            "needs": item["needs"].replace("; ", "\n             "),
        }
        for label, text in lines.items():
            if text:
                screen.print(f"  {label:<11}{text}", soft_wrap=True)
