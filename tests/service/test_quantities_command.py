"""`slidercrank quantities`: every quantity is listed, and explained as it says itself."""

from __future__ import annotations

import json
import re

import pytest

import slidercrank as sc
from slidercrank.objectives.registry import FACTS
from slidercrank.objectives.tables.swing_columns import OF_A_TURN
from slidercrank.optimise.problem.table_columns import RESIDUAL
from slidercrank.service.commands.job_files import TERMS
from tests.service.conftest import Command


def test_every_quantity_is_listed_once_with_its_unit(command: Command) -> None:
    lines = [line.split() for line in command("quantities").stdout.splitlines() if line.startswith("  ")]
    listed = [words[0] for words in lines]
    assert sorted(listed) == sorted(["crank", "rod", "offset", *FACTS])
    for words in lines:
        unit = FACTS[words[0]].unit.symbol.split() if words[0] in FACTS else ["mm"]
        assert words[1 : 1 + len(unit)] == unit


def test_the_json_has_what_python_has(command: Command) -> None:
    listed = {item["name"]: item for item in json.loads(command("quantities", "--json").stdout)["quantities"]}
    table = sc.quantities()
    for key in ("title", "unit", "column", "better", "needs"):
        assert {name: listed[name][key] for name in table.index} == table[key].to_dict()


@pytest.mark.parametrize("name", ["peak_torque", "position_error", "swing_angle"])
def test_a_named_quantity_is_explained(name: str, command: Command) -> None:
    text, quantity = command("quantities", name).stdout, FACTS[name]
    for fact in (quantity.sentence, quantity.formula, quantity.field, quantity.job_requirements_text.split("; ")[0]):
        assert fact in text
    assert json.loads(command("quantities", name, "--json").stdout)["quantities"][0]["formula"] == quantity.formula


def test_an_unknown_quantity_is_refused_with_the_nearest_name(command: Command) -> None:
    done = command("quantities", "peaktorque")
    assert done.exit_code == 2
    assert done.stderr == "slidercrank: no quantity is called 'peaktorque'; did you mean peak_torque?\n"


@pytest.mark.parametrize("name", TERMS)
def test_a_word_of_the_results_is_explained_and_leads_to_the_glossary(
    name: str, command: Command, pytestconfig: pytest.Config
) -> None:
    done = command("quantities", name)
    assert done.exit_code == 2
    assert done.stderr == f"slidercrank: no quantity is called '{name}'; {TERMS[name]}; see docs/glossary.md\n"
    glossary = (pytestconfig.rootpath / "docs/glossary.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([^|]+) \|", glossary, re.MULTILINE)
    assert name.replace("_", " ") in {term.strip() for row in rows for term in row.split(",")}
    assert ("this column" in TERMS[name]) == (name in {*OF_A_TURN, RESIDUAL})
