"""Optional parts of the software: packages that an extra installs, `pip install "slidercrank[EXTRA]"`.

The installed metadata, derived from pyproject.toml, says which extra installs a package.
"""

import re
from importlib import import_module
from importlib.util import find_spec
from types import TracebackType
from typing import Any

from .errors import MissingExtra

_REQUIREMENT = re.compile(r"""(?P<name>[\w.-]+).*;.*\bextra\s*==\s*["'](?P<extra>[\w-]+)["'].*""")
_SEPARATORS = re.compile(r"[-_.]")  # python-json-logger is imported as pythonjsonlogger


class NamingExtra:
    """Context for an import that needs an extra; a failed import raises `MissingExtra` with the extra's name."""

    def __init__(self, use: str) -> None:
        """Take the beginning of the message: "figures need"."""
        self._use = use

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if not isinstance(error, ModuleNotFoundError) or error.name is None:
            return
        extra = extra_for_package(error.name)
        if extra is not None:
            raise MissingExtra(
                f'{self._use} the extra "{extra}", which is not installed; install it: pip install '
                f'"slidercrank[{extra}]"',
                name=error.name,
            ) from None


def import_extra(module: str, use: str) -> Any:
    """Import a module that an extra installs, and return it untyped. use: as in `NamingExtra`."""
    with NamingExtra(use):
        return import_module(module)


def is_installed(package: str) -> bool:
    """Whether a package can be imported."""
    try:
        return find_spec(package) is not None
    except (ModuleNotFoundError, ValueError):  # the latter if its import is in progress or forbidden
        return False


def extra_for_package(package: str) -> str | None:
    """Return the extra that installs a package, from the package's import name; None if there is none."""
    from importlib.metadata import PackageNotFoundError, requires

    try:
        lines = requires("slidercrank") or []
    except PackageNotFoundError:  # the sources are used in place, without an installation
        return None
    for line in lines:
        match = _REQUIREMENT.fullmatch(line)
        if match is not None and _SEPARATORS.sub("", match["name"]) == _SEPARATORS.sub("", package):
            return match["extra"]
    return None


with NamingExtra("figures need"):
    pass
