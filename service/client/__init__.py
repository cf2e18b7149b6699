"""Python client of a service: submit and watch jobs, read fronts.

with Client("http://127.0.0.1:8765", token) as client:
    job = client.submit("feeder.toml")
    for event in client.events(job["id"]):
        print(event["kind"], event["data"])
    print(client.designs(job["id"], where=["transmission_angle >= 45 deg"], sort="peak_torque"))
"""

from __future__ import annotations

import time
import uuid
from collections.abc import Collection, Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError, ServiceError
from ...model.file_name_encoding import path_from_text
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..runs.result import Result, Row, row_from_json
from ..runs.run_folder import write_file
from ..runs.runs_on_disk import result_from
from .connection import Connection, Record, events_until_end, without_none
from .designs import Designs

if TYPE_CHECKING:
    import pandas as pd

JobSource = str | PathLike[str] | Mapping[str, Any]
"""Job: path of its file, its TOML text, or its tables. Text is recognised by its line breaks."""

_PAGE = 1000
_ENDED = ("done", "infeasible", "cancelled", "failed")
_PAUSES = (0.1, 1.0)  # s between two checks of an awaited job: initial, maximum


class Client(Designs):
    """A service. Threads may share it. Can be used as a context manager, which closes it.

    Every method raises `NotFound` for a missing job, design or figure and `InputError` for an invalid request. It
    raises `RunError` if the state of a job does not allow the request, and `ServiceError` if the service refuses or
    does not answer. All error messages are those of the service. Requests that are safe to send twice are retried while
    the service does not answer.
    """

    def __init__(self, url: str, token: str | None = None, *, patience: float = 30.0) -> None:
        """Prepare the client; nothing is sent yet.

        url: address of the service, which may contain the token, as the service prints it. patience: time to keep
        retrying, s.
        """
        super().__init__(Connection(url, token, patience))

    def close(self) -> None:
        """Close the connection."""
        self._connection.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def submit(
        self,
        job: JobSource,
        *,
        priority: int = 0,
        limits: Mapping[str, float] | None = None,
        key: str | None = None,
    ) -> Record:
        """Queue a job and return it.

        limits: seconds, evaluations, memory_bytes. key: key of this submission; repeating an earlier key queues nothing
        and returns the earlier job. By default a key is generated, so that a retry after a lost answer does not create
        a second job. Raises `InputError` for an invalid job.
        """
        body = {"job": tables_of(job), "priority": priority, "limits": dict(limits or {})}
        return self._connection.post("jobs", body, key=key or uuid.uuid4().hex)

    def clone(
        self,
        number: int,
        changes: Mapping[str, Any] | None = None,
        *,
        priority: int | None = None,
        limits: Mapping[str, float] | None = None,
        key: str | None = None,
    ) -> Record:
        """Queue a copy of a job and return it. changes: changes to its tables, as a merge patch; None removes a key."""
        body = without_none(priority=priority, limits=None if limits is None else dict(limits))
        body["changes"] = dict(changes or {})
        return self._connection.post(f"jobs/{number}/clone", body, key=key or uuid.uuid4().hex)

    def jobs(
        self,
        *,
        states: Collection[str] = (),
        name: str = "",
        before: int | None = None,
        limit: int = 100,
        sort: str = "newest",
    ) -> list[Record]:
        """Return jobs. states: all if empty. name: part of the name. sort: newest, oldest, name, state or decided.

        before: number of a job; returns only jobs that follow it in the list.

        Each has the fields of a list entry; `job` returns all fields of one job, `front_points` some designs of
        several.
        """
        query = {"state": list(states), "name": name, "limit": limit, "sort": sort, **without_none(before=before)}
        listed: list[Record] = self._connection.ask("jobs", query)["jobs"]
        return listed

    def job(self, number: int) -> Record:
        """Return the state of a job."""
        return self._connection.ask(f"jobs/{number}")

    def front_points(self, numbers: Collection[int]) -> list[Record]:
        """Return some designs on the fronts (so far) of at most 100 jobs: job, columns, points.

        At most 64 designs of each, in the first two objectives. Jobs are in order of number; deleted jobs are omitted.
        """
        fronts: list[Record] = self._connection.ask("front-points", {"job": list(numbers)})["fronts"]
        return fronts

    def tables(self, number: int) -> Record:
        """Return the tables of a job's file."""
        return self._connection.ask(f"jobs/{number}/job")

    def cancel(self, number: int) -> Record:
        """Cancel a job and return it; its results are kept, and it can be resumed."""
        return self._connection.post(f"jobs/{number}/cancel")

    def resume(self, number: int) -> Record:
        """Queue a cancelled or failed job again, to continue where it stopped, and return it."""
        return self._connection.post(f"jobs/{number}/resume", again=False)

    def delete(self, number: int) -> None:
        """Delete an ended job and all its data."""
        self._connection.delete(f"jobs/{number}")

    def events(self, number: int, *, after: int = 0) -> Iterator[Record]:
        """Yield the events of a job as they happen, until it has ended: number, at, kind and data of each.

        after: number of an event; returns only later events. After a broken connection it continues with the next
        event.
        """
        return events_until_end(self._connection, number, after)

    def wait(self, number: int, *, seconds: float | None = None) -> Record:
        """Wait until a job has ended, and return it. Raises `ServiceError` after a timeout, s."""
        end = None if seconds is None else time.monotonic() + seconds
        pause, longest = _PAUSES
        while (job := self.job(number))["state"] not in _ENDED:
            if end is not None and time.monotonic() + pause > end:
                raise ServiceError(
                    f"job {number} must end within {seconds:g} s; it is {job['state']}; wait longer, or cancel it"
                )
            time.sleep(pause)
            pause = min(longest, 1.5 * pause)
        return job

    def front(self, number: int) -> Result:
        """Return the result of a job with all designs; undefined values are None."""
        record = self._connection.ask(f"jobs/{number}/export.json")
        rows = [row_from_json(row) for row in record["designs"]]
        return result_from(record, rows, str(record["run"]))

    def designs(
        self,
        number: int,
        *,
        where: Collection[str] = (),
        sort: str | None = None,
        reverse: bool = False,
        columns: str | None = None,
    ) -> pd.DataFrame:
        """Return designs of a front as a table, indexed by their numbers.

        where: conditions such as "transmission_angle >= 45 deg". sort: quantity or column, best or smallest first.
        columns: comma-separated names, all if None.
        """
        import pandas as pd

        query = {"where": list(where), "reverse": reverse, "limit": _PAGE, **without_none(sort=sort, columns=columns)}
        rows: list[Row] = []
        numbers: list[int] = []
        while True:
            page = self._connection.ask(f"jobs/{number}/designs", {**query, "offset": len(rows)})
            rows += map(row_from_json, page["designs"])
            numbers += page["numbers"]
            if not page["designs"] or len(rows) >= page["chosen"]:
                break
        keys = [column["key"] for column in page["columns"]]
        table = pd.DataFrame(rows, index=pd.Index(numbers, name="number"), columns=keys)
        undefined = [key for key in keys if rows and table[key].isna().all()]
        return table.astype(dict.fromkeys(undefined, "float64"))  # JSON represents them as null, which is not a number

    def design(self, number: int, design: int) -> Row:
        """Return a design by its number on the front, counted from 1; the number comes first."""
        row = self._connection.ask(f"jobs/{number}/designs/{design}")["design"]
        return {"number": design, **row_from_json(row)}

    def pick(
        self,
        number: int,
        *,
        knee: bool = False,
        topsis: str | None = None,
        lexicographic: str | None = None,
        where: Collection[str] = (),
    ) -> Record:
        """Return one selected design as `number` and `design`; conditions restrict the designs, as in `front`.

        topsis: weights, "peak_torque=2, transmission_angle=1". lexicographic: a ranking, "peak_torque: 5 %, crank".
        """
        ways = without_none(knee=knee or None, topsis=topsis, lexicographic=lexicographic)
        return self._connection.ask(f"jobs/{number}/pick", {"where": list(where), **ways})

    def comparison(self, numbers: Collection[int], **inputs: float) -> Record:
        """Return the comparison of the fronts of several jobs, as printed by `slidercrank compare --json`.

        inputs: tolerance, the fraction of an objective's range that counts as equal.
        """
        question = FRONT_OR_JOB_QUESTIONS["compare"]
        query = {"job": list(numbers), **question.read(inputs, None)}
        record: Record = self._connection.ask(question.path, query)[question.key]
        return record

    def figures(self, number: int) -> list[str]:
        """Return the names of the figures of a front; each design has one too, such as design_1."""
        return [figure["name"] for figure in self._connection.ask(f"jobs/{number}/figures")["figures"]]

    def figure(self, number: int, name: str, path: str | PathLike[str]) -> Path:
        """Write a figure to a PNG or SVG file, depending on its ending, and return the file."""
        return self._download(f"jobs/{number}/figures/{name}", Path(path), ("png", "svg"))

    def export(self, number: int, path: str | PathLike[str]) -> Path:
        """Write all designs of a front to a file and return it: CSV, JSON or Parquet, depending on its ending."""
        return self._download(f"jobs/{number}/export", Path(path), ("csv", "json", "parquet"))

    def _download(self, path: str, file: Path, kinds: tuple[str, ...]) -> Path:
        kind = file.suffix.lower().removeprefix(".")
        if kind not in kinds:
            raise InputError(
                f"the file must end in {' or '.join(f'.{name}' for name in kinds)}; got {file.name}; rename it"
            )
        write_file(file, self._connection.request("GET", f"{path}.{kind}", again=True).content)
        return file

    def schema(self) -> Record:
        """Return the JSON Schema of jobs."""
        return self._connection.ask("schema")

    def check(self, job: JobSource) -> Record:
        """Return a job in words, as the service understood it; nothing is queued.

        Raises `InputError` for an invalid job.
        """
        return self._connection.post("check", {"job": tables_of(job)})

    def analyse(
        self,
        job: JobSource,
        *,
        crank: str | None = None,
        rod: str | None = None,
        offset: str | None = None,
        show: Collection[str] = (),
    ) -> Record:
        """Return all numbers for any design of a job.

        Lengths are texts such as "40 mm"; those fixed by the job may be omitted.
        """
        body = {"job": tables_of(job), "crank": crank, "rod": rod, "offset": offset, "show": list(show)}
        numbers: Record = self._connection.post("analyse", body)["analysis"]
        return numbers


def tables_of(job: JobSource) -> Record:
    """Return the tables of a job file, including the contents of the files beside it. Raises `JobError`."""
    from ...optimise.job import with_file_contents
    from ...optimise.job.job_file import read_job_file, toml_tables

    if isinstance(job, Mapping):
        return dict(job)
    if isinstance(job, str) and "\n" in job:
        return toml_tables(job)
    file = path_from_text(job)
    return with_file_contents(read_job_file(file), file.parent)
