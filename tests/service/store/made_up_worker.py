"""A worker with a made-up search, for a process of its own that can be killed.

Its search makes `ROUNDS` records that are the same every time, and finds one design a record.
"""

from __future__ import annotations

import time

import numpy as np

from slidercrank.model.errors import LeaseLost, StoreError
from slidercrank.optimise.search.checkpoints import Record
from slidercrank.service.runs.result import Row
from slidercrank.service.store import Claim, Store
from slidercrank.service.workers.worker import worker_name
from tests.service.store.contents import progress, result, search_record

ROUNDS = 12
_ROUND = 0.02  # s that one takes


def found(records: list[Record]) -> list[Row]:
    """Return the designs of the records."""
    return [{"time_ratio": float(one.words.view(np.float64)[:9].sum())} for one in records]


def solve(claim: Claim) -> None:
    """Go on with a job, to its end."""
    records = claim.evaluation_records()
    for number in range(len(records), ROUNDS):
        time.sleep(_ROUND)
        records.append(search_record(number))
        claim.keep_record(records[-1])
        claim.report(progress(number + 1))
    claim.finish(result(rows=found(records)))


def main(address: str, lease: float) -> None:
    """Solve jobs for ever."""
    store = Store(address)
    name = worker_name()
    while True:
        try:
            claim = store.claim(name, lease=lease)
            if claim is not None:
                solve(claim)
                continue
        except (LeaseLost, StoreError):
            pass
        time.sleep(_ROUND)
