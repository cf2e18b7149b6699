"""Server for agents: the Model Context Protocol over standard input and output."""

import asyncio
import logging
import math
import os
import signal
import threading
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from anyio.streams.memory import MemoryObjectReceiveStream
from mcp.server.session import ServerSession

from ...model.errors import SlidercrankError
from ...model.optional_packages import NamingExtra
from ...optimise.front.progress import Progress, stage_text
from ...optimise.search.checkpoints import version_of
from ..resources.disk import full_places_text, is_disk_full
from ..runs.result import json_ready
from . import questions, runs
from .call import Call, ToolResult
from .tool import Tool

with NamingExtra("serving agents needs"):
    import anyio
    from mcp.server import Server, ServerRequestContext
    from mcp.server.stdio import stdio_server
    from mcp_types import CallToolRequestParams, CallToolResult, ListToolsResult, TextContent, ToolAnnotations
    from mcp_types import PaginatedRequestParams as Page
    from mcp_types import Tool as Declared


_log = logging.getLogger(__name__)
TOOLS = (
    Tool("list", questions.list_jobs_quantities_topics_and_runs),
    Tool("describe", questions.describe),
    Tool("check", questions.check),
    Tool("optimise", runs.optimise, writes=True),
    Tool("front", runs.front),
    Tool("ask", questions.ask),
    Tool("files", runs.files, writes=True),
)
_BY_NAME = {tool.name: tool for tool in TOOLS}
INSTRUCTIONS = """Designs offset slider-crank mechanisms: feeders, presses, pumps, compressors, sieves, tilting
supports.
Describe what a machine must do as a job, and get the Pareto front of designs with all their quantities.

1. list: included jobs, quantities, topics. describe a similar job, such as feeder, and its keys; write your job.
2. check the job: reports how it is understood and which requirements conflict.
3. optimise it. This creates a run with numbered designs.
4. front shows and chooses designs of a run; ask analyses one; files writes report, drawing and tables.

Values have units in quotes: "2400 rpm", "80 mm", "0.8 kg". Columns of answers end with their unit: crank_mm."""


def serve(runs_folder: Path, allowed_functions: frozenset[str], *, on_signal: Callable[[], None]) -> None:
    """Serve agents until standard input ends.

    place: the only folder read and written. allowed: functions that jobs may use.

    interrupted: function called after SIGINT or SIGTERM once no call is running; must end the process.

    Raises `MissingExtra` at import without the package `mcp`.
    """
    anyio.run(_serve_until_stopped, runs_folder, allowed_functions, on_signal)


async def _serve_until_stopped(
    runs_folder: Path, allowed_functions: frozenset[str], on_signal: Callable[[], None]
) -> None:
    searches, other_calls, stopping = anyio.CapacityLimiter(1), anyio.CapacityLimiter(1), threading.Event()

    async def end_on_signal() -> None:
        with anyio.open_signal_receiver(signal.SIGINT, signal.SIGTERM) as signals:
            async for _ in signals:
                stopping.set()
                async with searches, other_calls:
                    on_signal()

    async def on_list_tools(_: ServerRequestContext, __: Page | None) -> ListToolsResult:
        return ListToolsResult(tools=[_tool_declaration(tool) for tool in TOOLS])

    async def on_call_tool(ctx: ServerRequestContext, params: CallToolRequestParams) -> CallToolResult:
        limiter = searches if params.name == "optimise" else other_calls
        tool_result = await _execute_call(
            ctx.session, partial(Call, runs_folder, allowed_functions), params, limiter, stopping
        )
        content = [TextContent(type="text", text=tool_result.text)]
        record = json_ready(tool_result.record) or None
        return CallToolResult(content=[*content], structured_content=record, is_error=tool_result.is_error)

    server: Server[Any] = Server(
        "slidercrank",
        version=version_of("slidercrank"),
        instructions=INSTRUCTIONS,
        on_list_tools=on_list_tools,
        on_call_tool=on_call_tool,
    )
    async with anyio.create_task_group() as group, stdio_server() as (read, write):
        if os.name == "posix":  # event loops on other systems have no signals
            group.start_soon(end_on_signal)
        await server.run(read, write, server.create_initialization_options())
        group.cancel_scope.cancel()


async def _execute_call(
    session: ServerSession,
    make_call: Callable[[Callable[[], bool], Callable[[Progress], None]], Call],
    params: CallToolRequestParams,
    limiter: anyio.CapacityLimiter,
    stopping: threading.Event,
) -> ToolResult:
    """Answer a call in a thread that responds to cancellation and reports progress.

    make: creates the call from its cancellation check and its progress listener. stopping: set when the server stops.
    """
    cancelled, loop = threading.Event(), asyncio.get_running_loop()
    send, receive = anyio.create_memory_object_stream[Progress](math.inf)
    with send, receive:
        async with anyio.create_task_group() as group:
            group.start_soon(_relay_progress, receive, session)
            group.start_soon(_set_event_when_cancelled, cancelled)

            def report(at: Progress) -> None:
                loop.call_soon_threadsafe(partial(send.send_nowait, at))

            call = make_call(lambda: cancelled.is_set() or stopping.is_set(), report)
            run = partial(_run_tool, params.name, params.arguments or {}, call)
            tool_result = await anyio.to_thread.run_sync(run, limiter=limiter)
            group.cancel_scope.cancel()
    return tool_result


async def _relay_progress(progress: MemoryObjectReceiveStream[Progress], session: ServerSession) -> None:
    async for at in progress:
        message = f"{stage_text(vars(at))}: {at.evaluations:,} evaluated, {at.feasible:,} feasible"
        await session.report_progress(at.seconds, None, message)


async def _set_event_when_cancelled(cancelled: threading.Event) -> None:
    try:
        await anyio.sleep_forever()
    finally:
        cancelled.set()


def _run_tool(name: str, arguments: Mapping[str, Any], call: Call) -> ToolResult:
    """Return the answer of a tool, or one sentence that says why there is none."""
    try:
        if name not in _BY_NAME:
            return _error_result(f"there is no tool {name[:60]!r}; choose from {', '.join(_BY_NAME)}")
        return _BY_NAME[name].execute(call, arguments)
    except SlidercrankError as error:
        return _error_result(str(error))
    except MemoryError:
        return _error_result("not enough memory for this request; close other programs, or request less")
    except Exception as error:  # noqa: BLE001 - whatever it is, the call and not the server ends
        if isinstance(error, OSError) and is_disk_full(error):
            return _error_result(f"Disk full: {full_places_text(error)}; free some space")
        _log.exception("the tool %s failed", name)
        return _error_result(
            f"unexpected {type(error).__name__}: {error}; this is a bug in slidercrank, not in the input; see its "
            "standard error for details"
        )


def _error_result(sentence: str) -> ToolResult:
    return ToolResult({}, sentence, is_error=True)


def _tool_declaration(tool: Tool) -> Declared:
    hints = ToolAnnotations(read_only_hint=not tool.writes, destructive_hint=False, open_world_hint=False)
    return Declared(name=tool.name, description=tool.description, input_schema=tool.schema, annotations=hints)
