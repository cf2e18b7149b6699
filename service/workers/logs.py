"""Logging of the service, configured in one place: text for people or JSON for machines, with job and worker."""

import contextlib
import logging
import sys
from collections.abc import Iterator
from contextvars import ContextVar
from datetime import UTC, datetime
from typing import Literal, TextIO

from ...model.optional_packages import NamingExtra

Format = Literal["text", "json"]
_SUBJECT: ContextVar[tuple[str | None, int | None]] = ContextVar("subject", default=(None, None))


def set_up_logs(form: Format = "text", *, stream: TextIO | None = None) -> None:
    """Log everything in this process from INFO up to a stream, one line per record; None for standard error.

    json: one object per line with time (UTC, ISO 8601), level, logger, message, and worker, job and exc_info if
    present.
    """
    handler = logging.StreamHandler(stream or sys.stderr)
    handler.addFilter(_with_subject)
    handler.setFormatter(_json_formatter() if form == "json" else _Text())
    root = logging.getLogger()
    root.handlers[:] = [handler]
    root.setLevel(logging.INFO)
    logging.captureWarnings(True)
    for talkative in ("httpx", "alembic", "distributed", "ezdxf", "fontTools", "matplotlib"):
        logging.getLogger(talkative).setLevel(logging.WARNING)


@contextlib.contextmanager
def log_subject(*, job: int | None = None, worker: str | None = None) -> Iterator[None]:
    """Within this context, log lines of this thread name a job, a worker, or both."""
    before = _SUBJECT.get()
    token = _SUBJECT.set((worker or before[0], job or before[1]))
    try:
        yield
    finally:
        _SUBJECT.reset(token)


def _with_subject(record: logging.LogRecord) -> bool:
    record.worker, record.job = _SUBJECT.get()
    return True


class _Text(logging.Formatter):
    """Time (UTC), level, worker and job, message."""

    def __init__(self) -> None:
        super().__init__("%(asctime)s %(levelname)-7s %(subject)s%(message)s")

    def formatTime(self, record: logging.LogRecord, datefmt: str | None = None) -> str:
        """Return the time of logging."""
        return datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds")

    def format(self, record: logging.LogRecord) -> str:
        """Return a record as a line, followed by its traceback."""
        worker, job = getattr(record, "worker", None), getattr(record, "job", None)
        parts = [f"worker {worker}" if worker else "", f"job {job}" if job else ""]
        subject = ", ".join(part for part in parts if part)
        record.subject = f"{subject}: " if subject else ""
        return super().format(record)

    def formatMessage(self, record: logging.LogRecord) -> str:
        """Return a record without its traceback, on one line: text from a job cannot pass for another record."""
        return super().formatMessage(record).replace("\r", "\\r").replace("\n", "\\n")


def _json_formatter() -> logging.Formatter:
    with NamingExtra("logs as JSON need"):
        from pythonjsonlogger.json import JsonFormatter

    class Json(JsonFormatter):
        """JSON lines, without job and worker if a record has none."""

        def process_log_record(self, log_data: dict[str, object]) -> dict[str, object]:
            return {key: value for key, value in log_data.items() if value is not None}

    names = {"levelname": "level", "name": "logger"}
    fields = ["levelname", "name", "message", "worker", "job"]
    return Json(fields, rename_fields=names, timestamp="time", json_ensure_ascii=True)
