"""The decision in the report of a run on the disk, taken on the page or over the API."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path

from slidercrank.service.store import Store
from slidercrank.service.store.bookmarks_and_wishes import bookmark_design, update_bookmark
from slidercrank.service.store.damage_check_and_backup import back_up
from tests.service.api.fixed_front import Solved
from tests.service.conftest import Command


def test_the_report_of_a_command_has_the_decision_of_the_store(
    solved: Solved, tmp_path: Path, command: Command
) -> None:
    runs, out = tmp_path / "runs", tmp_path / "report.html"
    runs.mkdir()
    back_up(solved.store, runs / "slidercrank.db")
    with Store(runs / "slidercrank.db") as store:
        run = store.job(solved.number).run
        arguments = ("report", run, "--design", 2, "--runs", runs, "--out", out)
        assert command(*arguments).exit_code == 0
        assert "Decided: " not in out.read_text(encoding="utf-8")
        for name, number in (("Stock rod", 1), ("Least torque", 2)):
            row = solved.result.designs[number - 1]
            crank, rod, offset = (float(row[key] or 0.0) / 1e3 for key in ("crank_mm", "rod_mm", "offset_mm"))
            bookmark_design(store, solved.number, dimensions=(crank, rod, offset), design=number, name=name)
        update_bookmark(store, solved.number, 1, reason="too tall")
        update_bookmark(store, solved.number, 1, decided=True, note="in stock", author="Anna")
        update_bookmark(store, solved.number, 1, note="ordered", author="Ben")
        update_bookmark(store, solved.number, 2, decided=True, reason="fits the gearmotor", author="Ben")
    assert command(*arguments).exit_code == 0
    text = unescape(re.sub(r"<[^>]+>", " ", out.read_text(encoding="utf-8")))
    assert "Decided: Least torque (fits the gearmotor)." in text
    assert re.search(r"gearmotor\)\. Ben, \d{4}-\d\d-\d\d \d\d:\d\d UTC\.", text)
    assert "too tall; note: Anna: in stock; note: Ben: ordered" in text
    assert re.search(r"Anna, \S+ \S+ UTC\s+for Stock rod\s+too tall\s+Ben, \S+ \S+ UTC\s+for Least torque", text)
    assert "This report is about another design." not in text
    assert "Short test [job]: Least torque" in text
    assert "Chosen design for review" in text
    assert command("report", run, "--design", 1, "--runs", runs, "--out", out).exit_code == 0
    assert "This report is about another design." in out.read_text(encoding="utf-8")
