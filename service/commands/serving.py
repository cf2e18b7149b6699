"""`slidercrank serve`, `worker` and `mcp`: the API with its workers, workers alone, and a server for agents."""

from __future__ import annotations

import logging
import os
import sys
import threading
import time
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.errors import InputError
from ...model.optional_packages import import_extra
from ..jobs.stores import STORE_VARIABLE, Address, open_store, store_address
from ..resources.memory import parse_size
from ..runs.run_folder import runs_folder
from ..text.options import AllowQuantity, Runs
from ..text.screen import print_message, print_output
from ..workers.engines import EngineOptions
from ..workers.logs import Format, set_up_logs
from .exit_and_interruption import INTERRUPTED, Interruption
from .optimise import SEARCH

if TYPE_CHECKING:
    from ..workers.worker_process import WorkerSettings


TOKEN_VARIABLE = "SLIDERCRANK_TOKEN"
_SHORTEST = 16


@dataclass(frozen=True)
class WorkOptions:
    """Options of workers, with permissions and limits for their jobs."""

    lease: Annotated[
        float,
        typer.Option(min=1.0, max=3600.0),
        "Seconds after which a job whose worker has died is given to another worker.",
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

    def worker_settings(
        self, address: str, engine: EngineOptions, processes: int, *, drain: bool = False
    ) -> WorkerSettings:
        """Return the settings for each worker of a store. drain: whether to exit as soon as no job waits."""
        from ..store import Limits
        from ..workers.worker import Terms
        from ..workers.worker_process import WorkerSettings

        memory = None if self.most_memory is None else parse_size(self.most_memory, "--most-memory")
        return WorkerSettings(
            address=address,
            lease=self.lease,
            drain=drain,
            most_running=self.most_running,
            terms=Terms(
                limits=Limits(seconds=self.most_seconds, evaluations=self.most_evaluations, memory=memory),
                grace=self.grace,
                engine=engine.validated().divided_among(max(1, processes)),
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
    """Solve the jobs in a store until stopped. Each worker is a separate process, which is restarted if it dies.

    Ctrl-C and SIGTERM let each job finish its round, or return it to the queue if that takes longer than --grace;
    another worker then continues after its last round. With a PostgreSQL store, workers may run on any number of
    machines.
    """
    import_extra("psutil", "workers need")  # needed to end processes that a job leaves behind
    from ..workers.supervisor import Supervisor

    settings = options.worker_settings(store_address(store), engine, processes, drain=drain)
    with Interruption(service=True) as termination:
        with open_store(store) as opened:  # faults are reported immediately, by this process only
            opened.require_writable()
        set_up_logs(options.log_format)
        with Supervisor(settings, processes) as supervisor:
            while not (termination.is_requested() or supervisor.is_finished()):
                time.sleep(0.1)


@dataclass(frozen=True)
class Access:
    """Access to the service: token, host names, and limits on requests."""

    token: Annotated[
        str | None,
        "Token that every request must carry. On the command line other users can read it in the process list; in "
        f"{TOKEN_VARIABLE} they cannot. [default: {TOKEN_VARIABLE}, else a random one, printed once]",
    ] = None
    no_token: Annotated[bool, "Admit all users of this machine without a token."] = False
    allow_host: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME"),
        "Further host name under which the service may be called. May be repeated.",
    ] = None
    submissions: Annotated[
        int, typer.Option("--submissions-per-minute", min=0), "Total over all clients; 0 means no limit."
    ] = 600
    most_queued: Annotated[int, typer.Option(min=1), "Maximum number of waiting jobs."] = 10_000


def serve(
    store: Address = None,
    host: Annotated[str, "Address of this machine to listen on."] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535), "Port to listen on; 0 takes any free port."] = 8765,
    workers: Annotated[
        int | None,
        typer.Option(min=0, max=256),
        "Number of jobs solved at a time on this machine. [default: one per processor, at most 4]",
    ] = None,
    *,
    access: Access,
    options: WorkOptions,
    engine: EngineOptions,
) -> None:
    """Serve the API and solve its jobs until stopped.

    Prints the address, including the token, once the service is listening. Ctrl-C and SIGTERM let each job finish its
    round, or return it to the queue if that takes longer than --grace. After a restart the service continues it.
    """
    from ..api.app import MODULES, computing_app, create_app
    from ..api.computing import Computing
    from ..api.server import accepted_host_names, browser_url, listening_socket, run_server
    from ..api.settings import Settings
    from ..workers.heartbeat import end_children
    from ..workers.supervisor import Supervisor

    secret, is_generated = _choose_token(access.token, access.no_token, host)
    processes = min(os.cpu_count() or 1, 4) if workers is None else workers
    work = options.worker_settings(store_address(store), engine, processes)
    settings = Settings(
        token=secret,
        hosts=(*accepted_host_names(host), *(access.allow_host or ())),
        submissions_per_minute=access.submissions,
        allowed_quantities=frozenset(work.terms.allowed_quantities),
        limits=work.terms.limits,
    )
    with Interruption(service=True) as termination, listening_socket(host, port) as socket, open_store(store) as opened:
        opened.require_writable()
        analysing = partial(
            computing_app, work.address, settings, most_queued=access.most_queued, log_format=work.log_format
        )
        computing = Computing(analysing, modules=MODULES)
        app = create_app(opened, settings, computing)
        print_output(
            f"slidercrank serves the jobs of {opened.name} at\n"
            f"  {browser_url(host, socket, secret if is_generated else None)}\n"
        )
        set_up_logs(work.log_format)
        with closing(computing), Supervisor(work, processes) as supervisor:
            run_server(app, socket, stop_requested=termination.is_requested, stopping=supervisor.request_stop)
    end_children()  # the fork server takes half a second to exit on its own
    _exit_despite_requests()


def _exit_despite_requests() -> None:
    """Exit immediately despite running requests: no client waits for answers, and all jobs are back in the queue."""
    from ..workers.heartbeat import end_process_tree

    if any(not thread.daemon and thread is not threading.main_thread() for thread in threading.enumerate()):
        logging.shutdown()
        sys.stdout.flush()
        end_process_tree(0)


def _choose_token(token: str | None, without_token: bool, host: str) -> tuple[str | None, bool]:
    """Return the token, and whether it was generated here. Raises `InputError` for a token that is too weak."""
    import secrets

    from ..api.server import is_loopback

    if without_token:
        if token is not None:
            raise InputError("--token and --no-token exclude each other; got both; leave one out")
        if not is_loopback(host):
            raise InputError(
                f"without a token the service may only listen on this machine; got --no-token and --host {host}; "
                "leave --no-token out, or listen on 127.0.0.1"
            )
        return None, False
    token = token if token is not None else os.environ.get(TOKEN_VARIABLE)
    if token is None:
        return secrets.token_urlsafe(32), True
    if len(token) < _SHORTEST or not (token.isascii() and token.isprintable()) or " " in token:
        raise InputError(
            f"a token must have at least {_SHORTEST} printable ASCII characters and no spaces; got {len(token)} "
            "characters; leave it out for a random one"
        )
    return token, False


def mcp(runs: Runs = None, allow_quantity: AllowQuantity = None) -> None:
    """Serve agents over the Model Context Protocol, on standard input and output, until the input ends.

    The agent's client starts this command. It reads and writes runs and the store in the folder of runs; other messages
    go to standard error. Ctrl-C stops it, and a running search keeps the designs found so far.
    """
    import_extra("mcp", "serving agents needs")
    from ...model.kernel.disk_cache import compile_ahead
    from ..agents.server import serve

    compile_ahead(*SEARCH)
    os.environ.pop(STORE_VARIABLE, None)
    serve(runs_folder(runs).absolute(), frozenset(allow_quantity or ()), on_signal=_exit_despite_input)


def _exit_despite_input() -> None:
    """Exit immediately, even if a thread is still reading standard input."""
    print_message("slidercrank: interrupted")
    os._exit(INTERRUPTED)
