"""`slidercrank worker`: workers for a store, on this machine."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.extras import required
from ..jobs.stores import Address, open_store, store_address
from ..resources.memory import size_of
from ..text.options import AllowQuantity
from ..workers.engines import EngineOptions
from ..workers.logs import Format, set_up_logs
from .ending import Interruption

if TYPE_CHECKING:
    from ..workers.worker_process import WorkerSettings


@dataclass(frozen=True)
class WorkOptions:
    """Options of workers, and permissions and limits of their jobs."""

    lease: Annotated[
        float,
        typer.Option(min=1.0, max=3600.0),
        "Seconds after which a job whose worker has died goes to another worker.",
    ] = 30.0
    grace: Annotated[
        float, typer.Option(min=0.0, max=600.0), "Seconds that a job has to finish its round when the worker stops."
    ] = 10.0
    allow_quantity: AllowQuantity = None
    most_running: Annotated[
        int | None, typer.Option(min=1), "Maximum number of jobs in the store that are solved at a time."
    ] = None
    most_seconds: Annotated[
        float | None, "Time limit for the search of every job, s; the designs found so far are kept."
    ] = None
    most_evaluations: Annotated[
        int | None, "Maximum number of designs evaluated for every job; those found so far are kept."
    ] = None
    most_memory: Annotated[
        str | None, typer.Option(metavar="SIZE"), 'Fail a job whose worker uses more memory than this, such as "2 GB".'
    ] = None

    log_format: Annotated[Format, "Log format on standard error: text, or one JSON object per line."] = "text"

    def settings(self, address: str, engine: EngineOptions, processes: int, *, drain: bool = False) -> WorkerSettings:
        """Return the settings of each worker of a store. drain: whether to end as soon as no job waits."""
        from ..store import Limits
        from ..workers.worker import Terms
        from ..workers.worker_process import WorkerSettings

        memory = None if self.most_memory is None else size_of(self.most_memory, "--most-memory")
        return WorkerSettings(
            address=address,
            lease=self.lease,
            drain=drain,
            most_running=self.most_running,
            terms=Terms(
                limits=Limits(seconds=self.most_seconds, evaluations=self.most_evaluations, memory=memory),
                grace=self.grace,
                engine=engine.checked().shared_by(max(1, processes)),
                allowed_quantities=tuple(sorted(set(self.allow_quantity or ()))),
            ),
            log_format=self.log_format,
        )


def worker(
    store: Address = None,
    processes: Annotated[int, typer.Option(min=1, max=256), "Number of workers; each solves one job at a time."] = 1,
    drain: Annotated[bool, "Exit as soon as no job is waiting."] = False,
    *,
    options: WorkOptions,
    engine: EngineOptions,
) -> None:
    """Solve the jobs in a store until stopped. Each worker is a process, which is restarted if it dies.

    Ctrl-C and SIGTERM let each job finish its round, or hand it back if that takes longer than --grace; another worker
    then continues after its last round. With a store on PostgreSQL workers may run on any number of machines.
    """
    required("psutil", "workers need")  # it is used to end processes that a job leaves behind
    from ..workers.supervisor import Supervisor

    settings = options.settings(store_address(store), engine, processes, drain=drain)
    with Interruption(service=True) as termination:
        with open_store(store) as opened:  # only this process reports faults, immediately
            opened.require_writable()
        set_up_logs(options.log_format)
        with Supervisor(settings, processes) as supervisor:
            while not (termination.requested() or supervisor.finished()):
                time.sleep(0.1)
