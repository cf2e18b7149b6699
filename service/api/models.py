"""JSON models for the API's answers about jobs; the API schema follows from them."""

from typing import Annotated, Any

from pydantic import BaseModel, Field

from ..store import State

Count = Annotated[int, Field(ge=0)]


class ResponseModel(BaseModel, frozen=True):
    """Part of an answer."""


class JobLimits(ResponseModel):
    """Limits of a job on time, evaluations and memory; null means no limit."""

    seconds: float | None = Field(description="time limit of the search, s")
    evaluations: int | None = Field(description="maximum number of designs that the search evaluates")
    memory_bytes: int | None = Field(description="memory limit of the worker, bytes")


class FrontProgress(ResponseModel):
    """Some designs of a search's front so far, objectives only."""

    columns: list[str] = Field(description="columns of the objectives, as the designs will have them")
    points: list[list[float | None]] = Field(
        description="values for at most 64 designs, by column; for an objective with a target, the distance from it"
    )


class RowProgress(ResponseModel):
    """Progress of a search, as in a list."""

    stage: str
    round: int
    rounds: int = Field(description="number of planned rounds")
    feasible: int = Field(description="designs that meet every constraint")
    step: int = Field(default=0, description="current step of the stage, in a long one between two rounds")
    steps: int = Field(default=0, description="number of steps of the stage; 0 at the end of a round")


class JobProgress(RowProgress):
    """Progress of a search."""

    evaluations: int
    hypervolume: float | None = Field(
        description="volume that the feasible designs so far dominate, relative to the box that the first of them "
        "span; it never falls; not comparable between jobs"
    )
    seconds: float | None
    front: FrontProgress | None = Field(
        default=None, description="front after the latest round; null where none is known"
    )


class RowSummary(ResponseModel):
    """Summary of a job's result, as in a list."""

    designs: Count
    best: dict[str, float | str | None] = Field(description="the best value of each objective, by column")
    seconds: float | None = Field(None, description="duration of the search, s")


class JobSummary(RowSummary):
    """Summary of a job's result."""

    hypervolume: float | None
    evaluations: Count
    axes: list[str] = Field(description="the columns of the points")
    points: list[list[float | str | None]] = Field(description="values for at most 64 designs on the front, by column")


class JobRow(ResponseModel):
    """State of a job, as in a list. Times are in seconds since 1970, UTC."""

    id: int = Field(ge=1, description="number of the job", examples=[1])
    name: str = Field(examples=["Feeder"])
    state: State
    reason: str = Field(description="reason for this state, a sentence; may be empty")
    priority: int = Field(description="priority; jobs with higher ones are solved first")
    cancel_asked: bool
    submitted: float
    started: float | None
    finished: float | None
    worker: str | None = Field(description="name of the worker that solves it")
    events: Count = Field(description="the number of its last event")
    progress: RowProgress | None = Field(description="progress while it runs")
    summary: RowSummary | None
    decision: str | None = Field(None, description="name of the chosen design", examples=["Round numbers"])


class JobStateModel(JobRow, title="Job"):
    """State of a job. Times are in seconds since 1970, UTC."""

    key: str | None = Field(description="key of its submission")
    run: str = Field(description="the name of its run folder, wherever it is exported")
    attempts: Count = Field(description="number of attempts since it last progressed")
    most_attempts: Count
    limits: JobLimits
    due: float = Field(description="time before which it is not started")
    lease_until: float | None
    records: Count = Field(description="number of records from which it can continue")
    progress: JobProgress | None
    summary: JobSummary | None
    origin: int | None = Field(
        None, description="number of the original job if this is a modified copy; the original may have been deleted"
    )


class JobPage(ResponseModel):
    """Some jobs in the requested order."""

    jobs: list[JobRow]
    workers: str = Field(description="summary of the workers", examples=["2 workers, 1 busy, 3 waiting"])
    next: int | None = Field(description="number to give as `before` for the next page; null on the last one")


class FrontPoints(ResponseModel):
    """Some designs of a job's front, for a small picture; empty if no front is known."""

    job: int = Field(examples=[1])
    columns: list[str] = Field(
        description="columns of the first two objectives, or of the only one", examples=[["time_ratio"]]
    )
    points: list[list[float | str | None]] = Field(
        description="values for at most 64 designs, by column; while a job runs, those of its progress",
        examples=[[[1.25]]],
    )


class FrontPointsList(ResponseModel):
    """Points of the fronts of jobs, in order of job number; deleted jobs are omitted."""

    fronts: list[FrontPoints]


class EventModel(ResponseModel, title="Event"):
    """Event in the life of a job."""

    number: int = Field(ge=1, description="1, 2, 3, ... without gaps")
    at: float = Field(description="seconds since 1970, UTC")
    kind: str = Field(description="state, progress or message", examples=["state"])
    data: dict[str, Any] = Field(examples=[{"state": "queued", "reason": ""}])


class EventPage(ResponseModel):
    """Some events of a job, in order."""

    events: list[EventModel]
    last: Count = Field(description="number to give as `after` for the next page")


class JobFiles(ResponseModel):
    """The files of a job."""

    files: list[str] = Field(examples=[["job.toml", "versions.json"]])
    exports: list[str] = Field(
        description="formats in which its front is exported, as at /jobs/{number}/export.csv", examples=[["csv"]]
    )
