"""Reference for the Python interface as Markdown, with the objects whose docstrings it includes."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import slidercrank

_ROOT = Path(__file__).resolve().parents[2]


def front_door_reference() -> str:
    """Return the page on the public names: `import slidercrank` is all that a user needs."""
    parts = ["# Python\n\n`import slidercrank` provides these names. Other names may change at any time.\n"]
    for name in slidercrank.__all__:
        home = _home(getattr(slidercrank, name))
        if home is not None:
            parts.append(f"::: {home}\n    options:\n      heading: {name}\n      inherited_members: true\n")
    return "\n".join(parts)


def folder_reference(top: str) -> str:
    """Return the page on one top-level folder: every module with its docstrings."""
    said = (import_module(f"slidercrank.{top}").__doc__ or "").strip()
    parts = [f"# {top}\n\n{said}\n"]
    for file in sorted((_ROOT / top).rglob("*.py")):
        module = ".".join(file.relative_to(_ROOT).with_suffix("").parts).removesuffix(".__init__")
        if file.name != "__init__.py":
            parts.append(f"::: slidercrank.{module}\n")
    return "\n".join(parts)


def _home(found: object) -> str | None:
    """Return the place where a public name is defined; None for a plain value."""
    module, name = getattr(found, "__module__", None), getattr(found, "__qualname__", None)
    return f"{module}.{name}" if module and name else None
