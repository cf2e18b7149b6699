"""The table of all questions is true: counted again from the code."""

from __future__ import annotations

from pathlib import Path

from tests.service.table_of_questions import PAGE, declared, read, rows

NEAR = 0.1
"""Share by which counts may be off before the table is to be written anew."""
AGAIN = "write the table anew: python -m tests.service.table_of_questions"


def test_the_table_has_every_question_with_its_doors_and_its_size(tmp_path: Path) -> None:
    table = read()
    for told, now in zip(table, rows(tmp_path, table), strict=True):
        for key, value in now.items():
            if key in ("statements", "javascript", "statements_before", "javascript_before"):
                assert abs(int(told[key]) - int(value)) <= 2 + NEAR * int(value), f"{now['question']}: {AGAIN}"
            else:
                assert told[key] == value, AGAIN


def test_scripts_of_the_page_have_a_reason_and_are_those_that_it_draws_with() -> None:
    table = {row["question"]: row for row in read()}
    assert all(bool(row["scripts"]) == bool(row["why"]) for row in table.values())
    drawn = [name for name in table if (PAGE / "design" / f"{name}.js").is_file()]
    own = [name for name, row in table.items() if f"design/{name}.js" in row["scripts"].split()]
    assert own == drawn
    modules = [script for row in table.values() for script in row["scripts"].split()]
    assert all(int(row["javascript"]) > 0 for row in table.values() if row["scripts"])
    assert len(set(modules)) == len(modules)


def test_every_declared_question_is_in_the_table() -> None:
    assert declared().keys() <= {row["question"] for row in read()}
