"""A problem that asks for a method."""

from __future__ import annotations

from dataclasses import replace

from slidercrank.optimise.problem.problem import Problem


def asking(given: Problem, method: str, **settings: int) -> Problem:
    """Return the problem with another method and other settings."""
    return replace(given, settings=replace(given.settings, method=method, **settings))
