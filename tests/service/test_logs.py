"""Logs of the service: a line a record, with worker and job, as text or as JSON."""

from __future__ import annotations

import io
import json
import logging
import warnings
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta

import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.service.drawings.design_drawing import linkage_drawing
from slidercrank.service.drawings.dxf import dxf_file
from slidercrank.service.page.router import _subset_font
from slidercrank.service.workers.logs import log_subject, set_up_logs

_log = logging.getLogger("slidercrank.service.workers.worker")


@pytest.fixture
def stream() -> Iterator[io.StringIO]:
    """Return where logs go, and leave logging as it was."""
    root = logging.getLogger()
    before = root.handlers[:], root.level
    yield io.StringIO()
    root.handlers[:], level = before
    root.setLevel(level)
    logging.captureWarnings(False)


def test_a_json_log_has_an_object_a_line_with_worker_and_job(stream: io.StringIO) -> None:
    set_up_logs("json", stream=stream)
    with log_subject(worker="one"), log_subject(job=7):
        _log.info("claimed %s", "it")
    _log.warning("two\nlines")
    first, second = (json.loads(line) for line in stream.getvalue().splitlines())
    assert abs(datetime.fromisoformat(first.pop("time")) - datetime.now(UTC)) < timedelta(minutes=1)
    logger = "slidercrank.service.workers.worker"
    assert first == {"level": "INFO", "logger": logger, "message": "claimed it", "worker": "one", "job": 7}
    del second["time"]
    assert second == {"level": "WARNING", "logger": logger, "message": "two\nlines"}


def test_a_json_log_has_tracebacks_in_the_object(stream: io.StringIO) -> None:
    set_up_logs("json", stream=stream)
    _log.warning("failed", exc_info=ValueError("wrong"))
    (line,) = stream.getvalue().splitlines()
    assert "ValueError: wrong" in json.loads(line)["exc_info"]


def test_a_text_log_names_worker_and_job_before_the_message(stream: io.StringIO) -> None:
    set_up_logs("text", stream=stream)
    with log_subject(worker="one"):
        with log_subject(job=7):
            _log.info("claimed")
        _log.info("waits")
    _log.info("ends")
    ends = [line.split(" ", 1)[1] for line in stream.getvalue().splitlines()]
    assert ends == ["INFO    worker one, job 7: claimed", "INFO    worker one: waits", "INFO    ends"]


def test_what_a_job_says_cannot_pass_for_another_line_of_a_text_log(stream: io.StringIO) -> None:
    set_up_logs("text", stream=stream)
    _log.info("name\r\n2026-01-01T00:00:00.000+00:00 INFO    job 1: done")
    assert len(stream.getvalue().splitlines()) == 1


def test_debugging_is_left_out_and_warnings_are_logged(stream: io.StringIO) -> None:
    set_up_logs("text", stream=stream)
    _log.debug("detail")
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.warn("old name", DeprecationWarning, stacklevel=1)
    assert "detail" not in stream.getvalue()
    assert "old name" in stream.getvalue()


def test_setting_up_twice_writes_each_record_once(stream: io.StringIO) -> None:
    set_up_logs("text", stream=stream)
    set_up_logs("text", stream=stream)
    _log.info("once")
    assert stream.getvalue().count("once") == 1


def test_files_of_a_design_are_written_without_a_word(stream: io.StringIO) -> None:
    set_up_logs(stream=stream)
    assert _subset_font.__wrapped__()  # the typeface of the page and of reports
    assert dxf_file(linkage_drawing(Mechanism(), Linkage(0.04, 0.064, 0.02), name="x"))
    assert stream.getvalue() == ""
