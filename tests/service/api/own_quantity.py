"""A function as an operator may allow it; no test runs it."""

from __future__ import annotations

from typing import Any


def rod_over_crank(design: Any) -> Any:
    """Return the ratio of two lengths."""
    return design.rod / design.crank
