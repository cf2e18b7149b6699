"""Imports of the process that workers are forked from: slow work is done once, not by each.

The exception to the rule that nothing works at import: a fork server has no other place for it.
"""

from __future__ import annotations

import importlib
import tempfile
from contextlib import suppress
from pathlib import Path

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.store import Store

from .jobs import KINDS, tables

with suppress(ImportError):
    importlib.import_module("psycopg")
for _kind in KINDS:
    solve(parse_job(tables(_kind)))
with tempfile.TemporaryDirectory() as _folder:
    Store(Path(_folder) / "store.db").close()
