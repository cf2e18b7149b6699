"""Imported by the process that workers are forked from, so that what takes seconds is done once and not by each.

The exception to the rule that nothing works at import: a fork server has no other place for it.
"""

from __future__ import annotations

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve

from .jobs import KINDS, tables

for _kind in KINDS:
    solve(parse_job(tables(_kind)))
