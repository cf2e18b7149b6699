"""The exceptions of the project.

    SlidercrankError
    |-- InputError          a value that breaks a rule; also a ValueError
    |   |-- AssemblyError   the linkage cannot be assembled, or not turned fully
    |   `-- JobError        a job file that cannot be used
    |-- EngineError         processes or a cluster that cannot evaluate
    `-- RunError            a stored run that cannot be read or written
        |-- StoreError      the database of jobs refuses, or cannot be reached
        |-- LeaseLost       a job that is another worker's by now
        `-- QueueFull       as many jobs wait as may wait

Every message says the rule, the value and the remedy.
"""

from __future__ import annotations


class SlidercrankError(Exception):
    """Anything that this software refuses or cannot do."""


class InputError(SlidercrankError, ValueError):
    """A value that breaks a rule."""


class AssemblyError(InputError):
    """A linkage that cannot be assembled at some crank angle that is asked for."""


class JobError(InputError):
    """A job file that cannot be used."""


class EngineError(SlidercrankError):
    """The processes or the cluster that evaluate designs cannot be used, or are lost."""


class RunError(SlidercrankError):
    """A stored run that cannot be read or written."""


class StoreError(RunError):
    """The database of jobs refuses, or cannot be reached."""


class LeaseLost(RunError):
    """A job that is another worker's by now, or may be: nothing was written of it."""


class QueueFull(RunError):
    """As many jobs wait as may wait."""
