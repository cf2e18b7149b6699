"""The record of what the doors answer leaves nothing out, and masks what differs each time and nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from slidercrank.service.questions.discovery import TOPICS
from tests.doors.comparing import Allowance, compare, data_of, read_allowances
from tests.doors.contents import text_of
from tests.doors.coverage import untried_operations, untried_options
from tests.doors.masks import masked
from tests.doors.scripts import Case, all_scripts

CASES = [case for cases in all_scripts().values() for case in cases.values()]


def test_every_option_of_every_command_is_recorded() -> None:
    assert list(untried_options(CASES)) == []


def test_an_option_that_no_case_has_is_named() -> None:
    left = [case for case in CASES if "--lexicographic" not in case.typed]
    assert {f"{name} --lexicographic" for name in ("export", "front", "report")} <= set(untried_options(left))


def test_every_operation_and_every_topic_of_the_api_is_recorded_answered_and_refused() -> None:
    assert list(untried_operations(CASES)) == []
    for topic in TOPICS:
        assert any(f"/topics/{topic}" in case.typed and case.code == 200 for case in CASES), topic
        assert any(f"--show {topic}" in case.typed and case.code == 0 for case in CASES), topic


def test_an_operation_that_no_case_asks_is_named() -> None:
    left = [case for case in CASES if "/wishes" not in case.typed]
    path = "GET /api/v1/jobs/{number}/wishes"
    assert list(untried_operations(left)) == [f"{path} answered", f"{path} refused"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("runs/20260131-142501-feeder/front.csv", "runs/<run>-feeder/front.csv"),
        ('"submitted": 1795375800.25, "run": ""', '"submitted": <time>, "run": ""'),
        ('{"at": {"time_ratio": "1.2"}}', '{"at": {"time_ratio": "1.2"}}'),
        ("Made 2026-01-31 14:25 UTC", "Made <time>"),
        ('"seconds": 600', '"seconds": 600'),
        ("http://127.0.0.1:41233/", "http://127.0.0.1:<port>/"),
        ("/tmp/doors-x1/turn/runs and 12.5 mm", "<folder>/runs and 12.5 mm"),
        (
            "00:00:00  loading 0/2: 0 evaluated\n00:00:00  sampling 1/6: 256 evaluated\n",
            "<time>  sampling 1/6: 256 evaluated\n",
        ),
        (
            "".join(
                f'    {{\n      "data": {{\n        "stage": "{stage}"\n      }}\n    }}\n'
                for stage in ("loading", "end")
            ),
            '    {\n      "data": {\n        "stage": "end"\n      }\n    }\n',
        ),
        ("peak torque 110.25 N m at 120.5 deg", "peak torque 110.25 N m at 120.5 deg"),
    ],
)
def test_what_differs_each_time_is_masked_and_numbers_are_not(text: str, expected: str) -> None:
    assert masked(text, ["/tmp/doors-x1/turn"]) == expected


def test_a_digit_a_key_and_a_missing_case_are_told_and_what_may_differ_is_not(tmp_path: Path) -> None:
    for folder, digit, key in (("before", 5, "a"), ("after", 6, "c")):
        record = text_of(f'{{"b": 1, "{key}": [1, 2]}}'.encode(), "application/json")
        (tmp_path / folder).mkdir()
        for name, text in (("same", "a"), ("digit", f"rod 12.2{digit} mm"), ("key", record)):
            (tmp_path / folder / f"{name}.txt").write_text(text, encoding="utf-8")
    (tmp_path / "before" / "gone.txt").touch()
    found = compare(tmp_path / "before", tmp_path / "after", [])
    assert list(found.differences) == ["digit", "gone", "key"]
    assert "- rod 12.25 mm" in found.differences["digit"]
    assert '+   "c": [1, 2]' in found.differences["key"]
    some = [Allowance("d*", "four digits", "rod"), Allowance("gone", "left out"), Allowance("key", "other", "rod")]
    assert list(compare(tmp_path / "before", tmp_path / "after", some).differences) == ["key"]
    assert [one.used for one in some] == [2, 1, 0]


def test_data_of_a_record_are_the_same_for_other_words_and_differ_for_other_numbers_keys_and_options(
    tmp_path: Path,
) -> None:
    lines = [
        "front latest --json",
        "exit code 0",
        "--- standard output",
        '{"a sentence": 1}',
        '  "status": "done",',
        '  "message": "6 designs, 0.50 m^2, none better",',
        "Peak torque of 9.10e-03 N m at \u22124.5 deg, as --limit asks",
        '<svg viewBox="0 0 10 20">',
        "M 1 2",
        "</svg>",
    ]
    data = data_of(lines)
    read = ["--json", "exit code 0", "--- standard output", "1", '"status": "done"', '"message": 6', '"message": 0.5']
    assert data == [*read, "0.0091", "-4.5", "--limit"]
    reworded = [
        line.replace("designs", "of them").replace("9.10e-03", "0.0091").replace("M 1", "M 3") for line in lines
    ]
    assert data_of(reworded) == data
    for place, other in (
        (1, "exit code 2"),
        (4, '  "status": "failed",'),
        (5, '  "note": "6 designs, 0.5 m^2"'),
        (6, "Peak torque of 0.0092 N m at -4.5 deg, as --limit asks"),
        (6, "Peak torque"),
    ):
        assert data_of([*lines[:place], other, *lines[place + 1 :]]) != data
    for name, number in (("before", 5), ("after", 6)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "case.txt").write_text(f'"key": 1\nrod {number} mm\n', encoding="utf-8")
    new = [Allowance("*", "new numbers only", added=True)]
    found = compare(tmp_path / "before", tmp_path / "after", new, data=True)
    assert (found.differences, found.allowed) == ({"case": "  - 5"}, 1)


def test_differences_that_are_meant_have_a_reason() -> None:
    allowances = read_allowances(Path(__file__).with_name("differences.toml"))
    assert allowances
    assert all(len(one.reason.split()) > 2 for one in allowances)


def test_a_body_has_the_tables_and_the_texts_that_it_names() -> None:
    case = Case(200, 'POST /check Accept=text/plain {"job": "@plain.toml", "files": {"m": "@@measured.csv"}}')
    kind, content = case.body() or ("", b"")
    assert case.rest[0] == {"Accept": "text/plain"}
    assert kind == "application/json"
    assert b'"name": "Feeder"' in content
    assert b"crank_angle_deg,slider_position_mm" in content
