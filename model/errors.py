"""The exceptions of the project.

    SlidercrankError
    |-- InputError          a value that breaks a rule; also a ValueError
    |   |-- AssemblyError   the linkage cannot be assembled, or not turned fully
    |   `-- JobError        a job file that cannot be used
    `-- RunError            a stored run that cannot be read or written

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


class RunError(SlidercrankError):
    """A stored run that cannot be read or written."""
