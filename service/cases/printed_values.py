"""Printed numbers of publications, and the verdict on each.

The data file of each case has its printed numbers as text, since the printed digits state the claimed accuracy. The
model supplies the exact value for the row's key. A number that the model contradicts needs a reason in `why`, written
by the project. Only this module decides whether a number is confirmed.
"""

import csv
import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from typing import Any, Literal

CASES = (1, 2, 3, 4, 5)
_SAME = 1e-9
"""Relative error allowed in a printed formula: covers only the rounding of either value."""
Verdict = Literal["agrees", "misprint", "differs", "not checkable", "not printed"]


@dataclass(frozen=True)
class Numbers:
    """Values by row key, in the units of the rows: exact values, and values from published formulas."""

    exact: Mapping[str, float]
    formulas: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Row:
    """A number of a publication.

    where: its place there. printed: number as printed, None if there is none; if `formula` is set, the value of a
    printed formula. exact: exact value in the same unit, None if it cannot be computed. why: reason if the two
    disagree.
    """

    key: str
    what: str
    unit: str
    where: str
    printed: str | None
    formula: bool
    exact: float | None
    verdict: Verdict
    why: str

    @property
    def key_without_row_number(self) -> str:
        """Key without the row number in a printed table; for any other number the whole key."""
        return self.key.rpartition("_")[0] if ", row " in self.where else self.key


@dataclass(frozen=True, kw_only=True)
class Case:
    """Publication with all its numbers. given: the mechanism, in words."""

    number: int
    title: str
    source: str
    given: str
    rows: tuple[Row, ...]


def read_case(number: int, computed: Numbers) -> Case:
    """Return a case from its data file and the values by key."""
    text = files(__package__).joinpath("data", f"case_{number}.toml").read_text(encoding="utf-8")
    data = tomllib.loads(text)
    rows = tuple(_row_of_entry(entry, computed) for entry in (*data["row"], *_table_rows(data)))
    return Case(number=number, title=data["title"], source=data["source"], given=data["given"], rows=rows)


def read_printed_table(name: str) -> list[dict[str, str]]:
    """Return the rows of a printed table, every cell as printed."""
    text = files(__package__).joinpath("data", name).read_text(encoding="utf-8")
    return list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))


def _table_rows(data: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the cells of a printed table as rows; keys consist of column and row number."""
    if "table" not in data:
        return []
    table = data["table"]
    return [
        {
            **column,
            "key": f"{column['key']}_{row_number}",
            "what": f"{column['what']} at {line[table['at']]} deg",
            "where": f"{table['where']}, row {row_number}",
            "printed": line[column["column"]],
        }
        for column in table["columns"]
        for row_number, line in enumerate(read_printed_table(table["file"]), start=1)
    ]


def _row_of_entry(entry: Mapping[str, Any], computed: Numbers) -> Row:
    key, why = entry["key"], entry.get("why", "")
    exact, formula = computed.exact.get(key), entry.get("formula", False)
    printed = f"{computed.formulas[key]:.10g}" if formula else entry.get("printed")
    verdict: Verdict
    if printed is None:
        verdict = "not printed"
    elif exact is None:
        verdict = "not checkable"
    elif math.isclose(computed.formulas[key], exact, rel_tol=_SAME) if formula else is_confirmed(entry, exact):
        verdict, why = "agrees", ""
    else:
        verdict = "misprint" if why.startswith("misprint") else "differs"
    return Row(
        key=key,
        what=entry["what"],
        unit=entry.get("unit", ""),
        where=entry.get("where", ""),
        printed=printed,
        formula=formula,
        exact=exact,
        verdict=verdict,
        why=why.partition(": ")[2],
    )


def is_confirmed(entry: Mapping[str, Any], exact: float) -> bool:
    """Return whether a printed number equals the exact one to its printed accuracy.

    tolerance: allowed difference; by default one unit of the last printed digit, because sources truncate as well as
    round. decimals: digits printed after the decimal point, if the source drops trailing zeros.
    """
    printed = str(entry["printed"])
    if printed.startswith("< "):
        return exact < parse_printed_number(printed)
    decimals = int(entry.get("decimals", len(printed.partition(".")[2])))
    tolerance = float(entry.get("within", 10.0**-decimals))
    # Rounding errors in the difference itself must not decide the verdict.
    return abs(exact - parse_printed_number(printed)) <= tolerance * (1.0 + 1e-9) + 1e-9 * abs(exact)


def parse_printed_number(printed: str) -> float:
    """Return the number in a printed text such as "about 80" or "< 50"."""
    return float(printed.removeprefix("about ").removeprefix("< ").replace("−", "-"))
