"""The tables of docs/motions.md are true: asked again of the code."""

from __future__ import annotations

import pytest

from tests.service.table_of_motions import FILE, TABLES, section, table

AGAIN = "write the tables anew: python -m tests.service.table_of_motions"


@pytest.mark.slow
@pytest.mark.parametrize("name", TABLES)
def test_the_page_tells_what_is_refused_on_which_motion(name: str) -> None:
    _, told, _ = section(name, FILE.read_text(encoding="utf-8"))
    assert told == table(TABLES[name]), AGAIN
