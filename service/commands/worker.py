"""`slidercrank worker`: workers for a store, on this machine."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from ...model.extras import required
from ..jobs.stores import Address, open_store, store_address
from ..resources.sizes import size_of
from ..workers.engines import Cores, Scheduler, TlsAuthority, TlsCertificate, TlsKey, engine_options
from .worker_options import (
    AllowQuantity,
    Grace,
    Lease,
    LogFormat,
    Logs,
    MostEvaluations,
    MostMemory,
    MostRunning,
    MostSeconds,
)


def worker(
    store: Address = None,
    processes: Annotated[int, typer.Option(min=1, max=256, help="Workers; each solves one job at a time.")] = 1,
    lease: Lease = 30.0,
    allow_quantity: AllowQuantity = None,
    drain: Annotated[bool, typer.Option("--drain", help="End as soon as no job waits.")] = False,
    most_running: MostRunning = None,
    most_seconds: MostSeconds = None,
    most_evaluations: MostEvaluations = None,
    most_memory: MostMemory = None,
    grace: Grace = 10.0,
    cores: Cores = None,
    scheduler: Scheduler = None,
    tls_ca: TlsAuthority = None,
    tls_cert: TlsCertificate = None,
    tls_key: TlsKey = None,
    log_format: Logs = LogFormat.text,
) -> None:
    """Solve the jobs of a store until stopped, in processes of their own; those that end are started again.

    Ctrl-C and SIGTERM let every round end, or hand its job back when that takes longer than --grace: another worker
    goes on from its last round. With a store on PostgreSQL workers may run on any number of machines.
    """
    required("psutil", "workers need")  # they end what a job leaves behind with it
    from ..store import Limits
    from ..workers.logs import set_up_logs
    from ..workers.supervisor import Supervisor
    from ..workers.worker import Terms
    from ..workers.worker_process import WorkerSettings
    from .termination import Termination

    memory = None if most_memory is None else size_of(most_memory, "--most-memory")
    limits = Limits(seconds=most_seconds, evaluations=most_evaluations, memory=memory)
    engine = engine_options(cores, scheduler, tls_ca, tls_cert, tls_key).shared_by(processes)
    settings = WorkerSettings(
        address=store_address(store),
        lease=lease,
        drain=drain,
        most_running=most_running,
        terms=Terms(
            limits=limits, grace=grace, engine=engine, allowed_quantities=tuple(sorted(set(allow_quantity or ())))
        ),
        log_format=log_format.value,
    )
    with Termination() as termination:
        open_store(store).close()  # what is wrong with it is told at once, and by nobody but this process
        set_up_logs(log_format.value)
        with Supervisor(settings, processes) as supervisor:
            while not (termination.asked() or supervisor.finished()):
                time.sleep(0.1)
