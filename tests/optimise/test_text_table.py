"""Tables in files of any dialect: read back bit for bit, refused if a number could be 1000 times larger."""

from __future__ import annotations

import itertools
import math
import re
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.job.text_table import decode_file_text, read_file_bytes, read_table

SEPARATORS = {";": ".,", "\t": ".,", "|": ".,", " ": ".,", ",": "."}
"""Each with the decimal signs that go with it."""
ENCODINGS = ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1"]
EXTRAS = ["", "sep", "comments", "empty lines", "CR LF", "quotes", "thousands", "trailing blanks"]
DIALECTS = [
    (separator, sign, ENCODINGS[n % 6], EXTRAS[n % 8])
    for n, (separator, sign, _) in enumerate(
        (separator, sign, again) for again in range(4) for separator, signs in SEPARATORS.items() for sign in signs
    )
][:30]


def grouped(text: str, sign: str, group: str) -> str:
    """Return a number with its thousands parted, where it has no exponent and four digits or more."""
    whole, point, rest = text.partition(sign)
    parts = re.fullmatch(r"(-?)(\d{4,})", whole)
    if "e" in text or parts is None:
        return text
    return f"{parts[1]}{int(parts[2]):,}".replace(",", group) + point + rest


def written(numbers: np.ndarray, dialect: tuple[str, str, str, str]) -> bytes:
    """Return a table as a file in one of the dialects; its second heading has a non-ASCII letter."""
    separator, sign, encoding, extra = dialect
    cells = [[repr(float(number)).replace(".", sign) for number in row] for row in numbers]
    if extra == "thousands" and separator != ",":
        group = {",": ".", ".": ","}[sign]
        cells = [[grouped(cell, sign, group) for cell in row] for row in cells]
    heads = ["angle_deg", "Weg_µm", *(f"F{n}_N" for n in range(numbers.shape[1] - 2))]
    if separator not in " |":
        heads[0] = "crank angle (deg)"
    rows = [heads, *cells]
    if extra == "quotes":
        rows = [[f'"{cell}"' for cell in row] for row in rows]
    lines = [separator.join(row) for row in rows]
    if extra == "sep" and separator != " ":
        lines.insert(0, f"sep={separator}")
    if extra == "comments":
        lines = ["# logger 7, 1.5; 2", *lines[:3], "% stopped", *lines[3:], "// end"]
    if extra == "empty lines":
        lines = ["", *itertools.chain.from_iterable((line, "  ") for line in lines)]
    if extra == "trailing blanks":
        lines = [f"{line}   " for line in lines]
    return (("\r\n" if extra == "CR LF" else "\n").join(lines) + "\n").encode(encoding)


def test_200_random_tables_in_30_dialects_are_read_back_to_the_bit() -> None:
    random = np.random.default_rng(35)
    assert len(set(DIALECTS)) == 30
    for case in range(200):
        shape = (int(random.integers(2, 20)), int(random.integers(2, 5)))
        numbers = random.normal(size=shape) * 10.0 ** random.integers(-9, 9, shape)
        if case % 3 == 0:
            numbers = np.round(numbers, int(random.integers(0, 4)))
        numbers[0, 0] = 0.25  # says the decimal sign
        dialect = DIALECTS[case % 30]
        content = written(numbers, dialect)
        table = read_table(decode_file_text(content, "the file"), "the file")
        assert len(table.heads) == shape[1], (dialect, table.heads)
        assert table.heads[1] == "Weg_µm", dialect
        np.testing.assert_array_equal(
            np.column_stack(table.number_columns(range(shape[1]))), numbers, err_msg=str(dialect)
        )


@pytest.mark.parametrize(
    ("text", "numbers", "said"),
    [
        (
            "a;b\n1.300;2\n",
            [1.3, 2.0],
            "the point is read as a decimal point, so 1.300 is 1.3; if it separates thousands, write 1300",
        ),
        (
            "a,b\n1.300,0.5\n",
            [1.3, 0.5],
            "the point is read as a decimal point, so 1.300 is 1.3; if it separates thousands, write 1300",
        ),
        (
            "a;b\n1,300;2\n",
            [1.3, 2.0],
            "the comma is read as a decimal comma, so 1,300 is 1.3; if it separates thousands, write 1300",
        ),
        ("a;b\n1.300;0,5\n", [1300.0, 0.5], "decimal comma"),
        ("a;b\n1.000,5;30,5\n", [1000.5, 30.5], "decimal comma"),
        ("a;b\n1.000.000;2\n", [1e6, 2.0], "decimal comma"),
        ('a,b\n"1,300",0.5\n', [1300.0, 0.5], "separated by commas"),
        ("a\tb\n1\u202f300,5\t\u22122\n", [1300.5, -2.0], "decimal comma"),
        ("a;b\n1'300.5;2\n", [1300.5, 2.0], "separated by semicolons"),
        ("a;b\n-999.526;2\n", [-999.526, 2.0], "semicolons; decimal point"),
    ],
)
def test_the_decimal_sign_is_that_of_the_whole_file_and_is_said(text: str, numbers: list[float], said: str) -> None:
    table = read_table(text, "the file")
    assert [float(column[0]) for column in table.number_columns([0, 1])] == numbers
    assert table.summary_text([0, 1]).endswith(said)
    assert f"first {numbers[0]:.6g}, {numbers[1]:.6g};" in table.summary_text([0, 1])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a;b\n1,5;2.5\n", "must use one decimal sign; got 1,5 and 2.5; write all numbers the same way"),
        (
            'a,b\n"1,300",5\n',
            "must have an unambiguous decimal sign; got 1,300, which may mean a thousand times as much",
        ),
        ("a;b\n1,300;2.500\n", "must have an unambiguous decimal sign; got 1,300 and 2.500"),
        ("a;b\n12.34,5;2\n", 'row 2, column "a": must be a number; got "12.34,5"'),
        ("a;b\n1;2 mm\n", 'row 2, column "b": must be a number; got "2 mm"; write 2, as the unit belongs'),
        ("a;b\n1;=A2\n", 'got the formula "=A2"; save values instead of formulas'),
        ("a,b\n0,5,1\n", "row 2 must have 2 cells, like the first line; got 3; .* separate them by semicolons"),
        ("a,b\n\n1\n", "row 3 must have 2 cells, like the first line; got 1"),
        ("sep=;\na,b\n1,2\n", 'must separate its cells as its line "sep=;" states; got "a,b"; correct that line'),
        ("1;2\n3;4\n", "must begin with a line of column names with units; got '1, 2'"),
    ],
)
def test_a_number_that_could_be_another_one_is_refused_with_row_and_remedy(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_table(text, "the file").number_columns([0, 1])


@pytest.mark.parametrize(
    "text",
    [
        "# angle (deg); force (N)\n0;1\n90;2\n",
        "% logger\n% angle (deg)   force (N)\n0   1\n90   2\n",
        "angle (deg)   force (N)\n0.0   1\n 90   2\n",
        "angle (deg) force (N)\n0 1\n90 2\n",
        "sep=\\t\nangle (deg)\tforce (N)\n0\t1\n90\t2\n",
        "sep=\t\nangle (deg)\tforce (N)\n0\t1\n90\t2\n",
        "# logger 7\nsep=;\nangle (deg);force (N)\n0;1\n90;2\n",
        "# angle (deg);force (N)\r0;1\r90;2\r",
        "# angle (deg) force (N)\n0,0 1,00\n90,0 2,00\n",
        "angle;force\ndeg;N\n0;1\n90;2\n",
        "angle\tforce\r\n[deg]\t[N]\r\n0\t1\r\n90\t2\r\n",
        "angle force\ndeg N\n0 1\n90 2\n",
        "# angle,force\n# deg,N\n0,1\n90,2\n",
    ],
)
def test_names_of_columns_may_be_commented_and_have_blanks_between_blanks(text: str) -> None:
    table = read_table(text, "the file")
    assert table.heads == ("angle (deg)", "force (N)")
    assert [column.tolist() for column in table.number_columns([0, 1])] == [[0.0, 90.0], [1.0, 2.0]]


def test_one_row_and_a_negative_zero_are_reported_as_people_write_them() -> None:
    assert read_table("a;b\n-0;2\n", "f").summary_text([0, 1]).startswith("1 row of a, b; first 0, 2; last 0, 2;")


def test_a_folder_is_refused_once(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"^the file must be a file; got a folder; name a file in it$"):
        read_file_bytes(tmp_path, "the file", 10)


def test_a_line_of_texts_and_units_is_a_row() -> None:
    table = read_table("name;size;note\nM;;\nL;4;m\n", "the file")
    assert table.column_cells(0) == ["M", "L"]
    assert table.heads == ("name", "size", "note")


def test_cells_of_text_and_missing_ones_stay_in_other_columns() -> None:
    table = read_table("name;limit;note\nGM 1,5;1,5;so; \nGM 2;;a.b\n".replace("so; ", "so"), "the file")
    assert table.column_cells(0) == ["GM 1,5", "GM 2"]
    assert table.number_texts([1], missing=[1]) == [["1.5", ""]]
    assert math.isnan(table.number_columns([1], missing=[1])[0][1])
    with pytest.raises(InputError, match='row 3, column "limit": must be a number; got an empty cell'):
        table.number_columns([1])
