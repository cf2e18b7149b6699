"""The command line: `slidercrank COMMAND`.

Exit codes: 0 done; 1 fault of this software; 2 wrong input, or an unusable run or location; 3 valid input, but no
feasible design; 4 not proven within the budget; 130 interrupted (Ctrl-C).

A command module is imported only when the command is invoked. Slow imports are avoided here and at the top of the
command modules: `--help`, which lists all commands, stays fast.
"""

import contextlib
import errno
import gc
import os
import sys
import tempfile
import traceback
import warnings
from collections.abc import Iterator
from importlib import import_module
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from ..model.errors import InfeasibleError, InputWarning, OutputLost, SlidercrankError
from .commands.exit_and_interruption import FAULT, INTERRUPTED, NOTHING_FEASIBLE, WRONG_INPUT, print_infeasible_as_json
from .resources.disk import full_places_text, is_disk_full
from .text.options import typer_command
from .text.screen import print_message, print_output
from .text.standard_streams import give_up_output, guard_streams

_DEBUG = "SLIDERCRANK_DEBUG"
_SHORT = ("can't start new thread", "failed to map segment", "Cannot allocate memory", "cannot allocate memory")
_MORE_MEMORY = (
    "slidercrank: not enough memory; close other programs, or raise the limits of this one "
    "(ulimit -v, ulimit -u, a container's memory)"
)


_COMMANDS = (
    *("optimise", "analyse", "inverse", "swing", "lever", "sweep", "allocate", "balance", "law", "sections"),
    *("certify", "compare", "like", "round", "wish"),
    *("check", "schema", "quantities", "front", "export", "report", "cases"),
    *("serve", "submit", "jobs", "watch", "cancel", "resume", "delete", "worker", "mcp", "doctor"),
)
_MODULES = {"watch": "submit"}
_MODULES |= dict.fromkeys(("inverse", "swing", "lever", "allocate", "balance", "law", "sections"), "question_commands")
_MODULES |= dict.fromkeys(("like", "round", "certify", "compare", "sweep"), "front_or_job_commands")
_MODULES |= dict.fromkeys(("check", "schema", "quantities"), "job_files")
_MODULES |= dict.fromkeys(("front", "export", "report"), "front_export_report")
_MODULES |= dict.fromkeys(("serve", "worker", "mcp"), "serving")
_MODULES |= dict.fromkeys(("jobs", "cancel", "resume", "delete"), "queue")
"""Modules of commands that are not named after their module."""


class Commands(TyperGroup):
    """Command group that imports and runs one command, and turns its exceptions into a message and an exit code."""

    def __init__(self, **given: Any) -> None:
        """Accept the arguments of typer and the command names."""
        super().__init__(**given)
        self.commands = dict.fromkeys(_COMMANDS)  # type: ignore[assignment]

    def get_command(self, ctx: typer.Context, cmd_name: str) -> Any:  # type: ignore[override]
        """Return the command of a given name, or None."""
        if cmd_name in self.commands and self.commands[cmd_name] is None:
            module = import_module(f"{__package__}.commands.{_MODULES.get(cmd_name, cmd_name)}")
            alone = typer.Typer(rich_markup_mode=None, add_completion=False)
            alone.command(cmd_name)(typer_command(print_infeasible_as_json(getattr(module, cmd_name))))
            self.commands[cmd_name] = typer.main.get_command(alone)
        return self.commands.get(cmd_name)

    def invoke(self, ctx: typer.Context) -> Any:  # type: ignore[override]
        """Run the named command."""
        try:
            with _print_input_warnings():
                return super().invoke(ctx)
        except SlidercrankError as error:
            if os.environ.get(_DEBUG):
                raise
            print_message(f"slidercrank: {error}")
            raise typer.Exit(NOTHING_FEASIBLE if isinstance(error, InfeasibleError) else WRONG_INPUT) from None
        except KeyboardInterrupt:
            print_message("slidercrank: interrupted")
            raise typer.Exit(INTERRUPTED) from None
        except typer.Abort:
            raise
        except Exception as error:
            if os.environ.get(_DEBUG) or hasattr(error, "exit_code"):  # typer's own: usage errors, Exit
                _reword_option_error(error)
                raise
            if _is_resource_shortage(error):
                print_message(_MORE_MEMORY)
                raise typer.Exit(WRONG_INPUT) from None
            if isinstance(error, OSError) and is_disk_full(error):
                print_message(f"slidercrank: Disk full: {full_places_text(error)}; free some space")
                raise typer.Exit(WRONG_INPUT) from None
            print_message(
                f"slidercrank: unexpected {type(error).__name__}: {error}; this is a bug in slidercrank, not in "
                f"the input; see {_traceback_file(error)}"
            )
            raise typer.Exit(FAULT) from None


@contextlib.contextmanager
def _print_input_warnings() -> Iterator[None]:
    """Print each input warning once, on its own line, without source file and line."""
    with warnings.catch_warnings():
        show_other, already_said = warnings.showwarning, set[str]()

        def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
            if issubclass(category, InputWarning):
                if str(message) not in already_said:
                    print_message(f"warning: {message}")
                already_said.add(str(message))
            else:
                show_other(message, category, *place, **more)

        warnings.showwarning = show
        warnings.simplefilter("always", InputWarning)
        yield


def _reword_option_error(error: Exception) -> None:
    """Report an option value of the wrong type with the message that a job would give."""
    refused: Any = error.__cause__
    if not (isinstance(error, typer.BadParameter) and hasattr(refused, "errors")):
        return
    from ..objectives.units import quote
    from ..optimise.job.mistake_messages import broken_rule

    details = refused.errors(include_url=False)[0]
    error.message = f"{broken_rule(details)}; got {quote(details['input'])}"


def _is_resource_shortage(error: BaseException | None) -> bool:
    """Whether an error was caused by lack of memory or threads."""
    while error is not None:
        words = str(error)
        if isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno == errno.ENOMEM):
            return True
        if any(sign in words for sign in _SHORT):
            return True
        error = error.__cause__ or error.__context__
    return False


def _traceback_file(error: Exception) -> str:
    """Return the location of the traceback: the log of the run, or a new file if there is none."""
    for note in getattr(error, "__notes__", []):
        if note.startswith("log: "):
            return str(note.removeprefix("log: "))
    options: dict[str, Any] = {
        "prefix": "slidercrank-",
        "suffix": ".log",
        "delete": False,
        "encoding": "utf-8",
        "errors": "backslashreplace",
    }
    try:
        with tempfile.NamedTemporaryFile("w", **options) as file:
            file.write("".join(traceback.format_exception(error)))
    except OSError:
        return f"the traceback, with {_DEBUG}=1"
    return file.name


app = typer.Typer(
    cls=Commands,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    add_completion=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(show: bool) -> None:
    if show:
        from importlib.metadata import PackageNotFoundError, version

        try:
            number = version("slidercrank")
        except PackageNotFoundError:
            number = "(not installed)"
        print_output(f"slidercrank {number}\n")
        raise typer.Exit


@app.callback()
def slidercrank(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Size offset slider-crank mechanisms: from requirements to the Pareto front of designs."""


def main() -> None:
    """Run the command line and exit."""
    # Before NumPy is loaded: its extra threads would only busy-wait, as the matrices are never large enough for them.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Otherwise all installed packages are searched for plugins.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    gc.set_threshold(200_000, 20, 20)  # imports leave no garbage; skipping collection saves a tenth of a short command
    guard_streams()
    try:
        app(prog_name="slidercrank")
    except OutputLost as error:  # used by the help, which no command prints
        print_message(f"slidercrank: {error}")
        sys.exit(WRONG_INPUT)
    except MemoryError:  # while another error is reported
        print_message(_MORE_MEMORY)
        sys.exit(WRONG_INPUT)
    finally:
        try:  # while a failure can still be reported
            sys.stdout.flush()
        except OutputLost:
            give_up_output()
