"""Progress of a search, in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def standing(progress: Mapping[str, Any]) -> str:
    """Return the stage of a search and how far it is: "polishing 12/66", "selecting designs 1,200/3,000".

    progress: fields of `Progress`; those of early stores have no steps.
    """
    of = progress.get("steps", 0)
    done, of = (progress["step"], of) if of else (progress["round"], progress["rounds"])
    return f"{progress['stage']} {done:,}/{of:,}"
