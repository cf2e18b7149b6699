"""The exceptions of the project.

    SlidercrankError
    |-- InputError          a value that breaks a rule; also a ValueError
    |   |-- AssemblyError   the linkage cannot be assembled, or cannot rotate fully
    |   |-- ForeignRecords  records of another search, from which this one cannot continue
    |   |-- JobError        a job file that cannot be used
    |   |   `-- InfeasibleError     a valid job whose requirements no design can meet
    |   `-- NotFound        nothing has the requested name or number
    |-- MissingExtra        an optional part of the software is not installed; also an ImportError
    |-- OutputLost          standard output that is closed or full
    |-- EngineError         processes or a cluster that cannot evaluate
    `-- RunError            a stored run that cannot be read or written
        |-- StoreError      the database of jobs refuses, or cannot be reached
        |-- LeaseLost       a job that now belongs to another worker
        |-- QueueFull       the queue contains the maximum number of jobs
        `-- ServiceError    an external service refuses, or does not answer

Every message states the rule, the value and the remedy. `InputWarning` warns of a valid input that is probably a
mistake, attributed to the user's line.
"""

import inspect
import warnings


class SlidercrankError(Exception):
    """Base class of all errors of this software."""


class InputError(SlidercrankError, ValueError):
    """A value that breaks a rule."""


class AssemblyError(InputError):
    """A linkage that cannot be assembled at a requested crank angle."""


class ForeignRecords(InputError):
    """Records from another search, or from other versions, with which this search cannot continue."""


class JobError(InputError):
    """A job file that cannot be used."""


class InfeasibleError(JobError):
    """The input is valid, but no design can meet it.

    problem: the stated problem, as far as it could be built; None if there is no job.
    """

    def __init__(self, message: str, problem: object = None) -> None:
        super().__init__(message)
        self.problem = problem


class NotFound(InputError):
    """No object has this name or number."""


class MissingExtra(SlidercrankError, ImportError):
    """An optional part of the software is not installed; see the extras in pyproject.toml."""


class OutputLost(SlidercrankError):
    """Standard output is closed, or its destination is full."""


class EngineError(SlidercrankError):
    """The processes or the cluster for evaluating designs cannot be used, or are lost."""


class RunError(SlidercrankError):
    """A stored run that cannot be read or written."""


class StoreError(RunError):
    """The job database refuses a request, or cannot be reached."""


class LeaseLost(RunError):
    """A job that now belongs, or may belong, to another worker; nothing was written for it."""


class QueueFull(RunError):
    """The queue already contains the maximum number of jobs."""


class ServiceError(RunError):
    """An external service refuses a request, or does not answer."""


class InputWarning(UserWarning):
    """A valid input that probably describes a different machine than intended."""


LONGEST = 10.0
"""m. A longer link, given without a unit, was probably meant in mm."""
_OURS = __name__.partition(".")[0]
_MAKERS = ("dataclasses", "copy")
"""Python modules that create objects again on behalf of callers."""


def warn_user(sentence: str, *, through_callers: bool = False) -> None:
    """Issue an `InputWarning` at the line that calls the caller's module, if that line is in user code.

    No warning is issued if this software itself is the caller: its numbers come from values with units, or have already
    been checked. through_callers: whether to look past its modules, which may only pass on the user's values.
    """
    frame, modules = inspect.currentframe(), list[str]()
    while frame is not None:
        modules.append(frame.f_globals.get("__name__", ""))
        frame = frame.f_back
    passed = {*modules[:2], *_MAKERS}
    if through_callers:
        passed |= {name for name in modules if name.partition(".")[0] == _OURS}
    level, module = next(((n, name) for n, name in enumerate(modules, 1) if name not in passed), (1, _OURS))
    if module.partition(".")[0] != _OURS:
        warnings.warn(sentence, InputWarning, stacklevel=level)


def number_in_si_and_usual_unit(name: str, number: float, unit: str, usual: str, factor: float) -> str:
    """Return a number as read in SI, and as probably meant in a usual unit.

    unit: SI unit. usual: usual unit for such values. factor: one SI unit in the usual unit.

    >>> number_in_si_and_usual_unit("crank", 40.0, "m", "mm", 1e3)
    'crank 40 is 40 m = 40000 mm; write 0.04 for 40 mm'
    """
    return (
        f"{name} {number:g} is {number:g} {unit} = {factor * number:.6g} {usual}; write {number / factor:g} for "
        f"{number:g} {usual}"
    )
