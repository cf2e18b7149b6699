"""`slidercrank mcp`: a server for agents."""

from __future__ import annotations

import os

from ...model.extras import required
from ..jobs.stores import STORE_VARIABLE
from ..runs.run_folder import runs_place
from ..text.options import AllowQuantity, Runs
from ..text.screen import print_message
from .ending import INTERRUPTED
from .optimise import SEARCH


def mcp(runs: Runs = None, allow_quantity: AllowQuantity = None) -> None:
    """Serve agents over the Model Context Protocol, on standard input and output, until the input ends.

    The agent's client starts it. Runs and the store are read and written in the folder of runs; other messages go to
    standard error. Ctrl-C stops it, and a running search keeps the designs found so far.
    """
    required("mcp", "serving agents needs")
    from ...model.kernel.disk import compile_ahead
    from ..agents.server import serve

    compile_ahead(*SEARCH)
    os.environ.pop(STORE_VARIABLE, None)
    serve(runs_place(runs).absolute(), frozenset(allow_quantity or ()), interrupted=_leave)


def _leave() -> None:
    """End immediately: a thread still reads standard input."""
    print_message("slidercrank: interrupted")
    os._exit(INTERRUPTED)
