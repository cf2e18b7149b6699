"""A worker process with a made-up search, which does what the name of its job says.

    rounds   `ROUNDS` rounds of 0.05 s, the same records every time
    loads    no round: it hears nothing from the beginning, as while kernels are compiled
    stuck    one round, then it hears nothing any more
    greedy   one round, then it takes 300 MB and hears nothing any more
    leaves   it ends after its rounds and leaves 300 MB in its process
    loops    one round, then it loops and hears nothing, as an own function in this process may

Run as `python -m tests.service.made_up_process` in place of `slidercrank.service.workers.worker_process`. It imports
little, so that it starts within a second.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.search.checkpoints import Identity, Record
from slidercrank.service.runs.result import Result, StoredObjective
from slidercrank.service.store import Claim, Store
from slidercrank.service.workers import heartbeat as pulses
from slidercrank.service.workers import worker
from slidercrank.service.workers.heartbeat import Budget, Heartbeat, Stop
from slidercrank.service.workers.worker_process import main

ROUNDS = 20
_LEFT: list[object] = []
_SENSES = StoredObjective(quantity="time_ratio", sense="maximise", column="time_ratio", title="Time ratio", unit="")


def solve(
    store: Store, claim: Claim, budget: Budget, terms: worker.Terms, engine: object, heartbeat: Heartbeat, stop: Stop
) -> None:
    """Go on with a job, to its end."""
    for number in range(claim.job.records, ROUNDS):
        if claim.job.name == "loads":
            time.sleep(1000.0)
        if worker._must_end(claim, heartbeat, stop):
            claim.finish(_result("cancelled"))
            return
        time.sleep(0.05)
        claim.keep_record(_record(number))
        claim.report(Progress("evolving", number + 1, ROUNDS, 4 * number, number, 0.5, 0.05 * number))
        if claim.job.name == "greedy":
            taken = np.ones(300_000_000, dtype=np.uint8)
            time.sleep(float(taken.sum()))
        if claim.job.name == "leaves" and not _LEFT:
            _LEFT.append(np.ones(300_000_000, dtype=np.uint8))
        if claim.job.name in ("stuck", "loops"):
            time.sleep(1000.0)
    claim.finish(_result("done"))


def _record(number: int) -> Record:
    return Record(Identity("0f" * 16, "{}"), number, number, 0.05 * number, np.arange(4, dtype=np.int64))


def _result(status: str) -> Result:
    return Result(
        run="made up",
        name="made up",
        status=status,
        message="1 design",
        objectives=(_SENSES,),
        designs=[{"time_ratio": 1.5}],
        hypervolume=0.5,
        evaluations=4 * ROUNDS,
        seconds=1.0,
        seed=1,
        extremes={"time_ratio": 0},
        knee=0,
        trade_offs=[],
    )


if __name__ == "__main__":
    worker._solve = solve
    pulses._STOP_PATIENCE = 1.0
    sys.exit(main())
