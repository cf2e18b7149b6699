"""Where the table begins in a file: titles above the names of its columns are skipped where they are certain."""

from __future__ import annotations

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.job.text_table import read_table
from slidercrank.optimise.job.text_table_layout import title_line_count

TITLES = ["Measurement", "Press 7", "2026-05-01", "Müller", "1000 Hz", "", "Kistler 9311B", "12", "ok"]


@pytest.mark.parametrize("separator", [";", "\t", "|", ","])
def test_random_titles_above_random_tables_are_skipped_and_counted(separator: str) -> None:
    random = np.random.default_rng(7)
    for case in range(40):
        width, titles = int(random.integers(2, 5)), int(random.integers(1, 6))
        numbers = np.round(random.uniform(0.1, 9.9, (int(random.integers(2, 30)), width)), 1)
        above = [["Test", *random.choice(TITLES, random.integers(0, 4))] for _ in range(titles)]
        below = [["ms", *["N"] * (width - 1)]] if case % 3 == 0 else []
        heads = ["time", *(f"force {n}" for n in range(1, width))]
        heads = heads if below else [f"{head} ({'N' if n else 'ms'})" for n, head in enumerate(heads)]
        rows = [*above, heads, *below, *numbers.astype(str).tolist()]
        text = "\n".join(separator.join(row) + "\n" * int(random.integers(1, 3)) for row in rows)
        table = read_table(text, "the file")
        assert table.heads == ("time (ms)", *(f"force {n} (N)" for n in range(1, width))), text
        np.testing.assert_array_equal(np.column_stack(table.number_columns(range(width))), numbers)
        said = f"{titles} title line{'s' if titles > 1 else ''} above the column names skipped"
        assert said in table.summary_text(range(width))


@pytest.mark.parametrize(
    ("text", "titles", "heads"),
    [
        ("Motors of 2026\nname,peak_torque max (N m)\nA,30\nB,45\n", 1, ("name", "peak_torque max (N m)")),
        ("Rig;A;;\nTime (s);Force (N);;\n0;1;;\n1;2;;\n", 1, ("Time (s)", "Force (N)", "", "")),
        ("Test of a press\nangle_deg force_N\n0 1\n90 2\n", 1, ("angle_deg", "force_N")),
        ("a;b\n-;n/a\n1;2\n", 0, ("a", "b")),
        ("time;force\nstart;\n0;1\n1;2\n", 0, ("time", "force")),
        ("Press;7\n12;1000\nTime (s);Force (N)\n0;1\n", 0, ("Press", "7")),
        ("name,maker\nA,B\nC,D\n", 0, ("name", "maker")),
    ],
)
def test_what_may_be_a_row_or_the_names_is_no_title(text: str, titles: int, heads: tuple[str, ...]) -> None:
    table = read_table(text, "the file")
    assert table.heads == heads
    assert ("title line" in table.summary_text([0])) == (titles > 0)


def test_a_row_of_more_cells_names_the_lines_above_as_a_cause() -> None:
    with pytest.raises(InputError, match=r"row 2 must have 2 cells.*or delete lines above the column names"):
        read_table("Press 7,a\n1,2,3\n4,5,6\n", "the file")


def test_rows_of_texts_alone_have_no_titles() -> None:
    assert title_line_count([]) == title_line_count([["a"]]) == title_line_count([["a", "b"], ["c", "d"]]) == 0
