"""A front of many designs, real linkages with all their quantities; only that they are a front is made up."""

from __future__ import annotations

import math
import tomllib

import numpy as np

from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.service.runs.result import Result, StoredObjective, rows_of_columns
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import store_result

_OBJECTIVES = (
    ("time_ratio", "maximise", "time_ratio", "time ratio", ""),
    ("peak_torque", "minimise", "peak_torque_Nm", "peak drive torque", "N m"),
    ("transmission_angle", "maximise", "least_transmission_angle_deg", "least transmission angle", "deg"),
    ("position_error", "minimise", "position_error_mm", "position error", "mm"),
)


def large_result(count: int = 10_000) -> Result:
    """Return a plausible result of a search: `count` designs that turn fully, best time ratio first."""
    random = np.random.default_rng(11)
    box = np.array([[0.05, 0.2, 0.0], [0.16, 0.6, 0.15]])
    dimensions = box[0] + (box[1] - box[0]) * random.random((8 * count, 3))
    turning = dimensions[:, 1] * math.cos(math.radians(20.0)) > dimensions[:, 0] + dimensions[:, 2]
    dimensions = dimensions[turning][:count]
    assert len(dimensions) == count
    table = analyse(fronts.MACHINE, dimensions).sort_values("time_ratio", ascending=False, ignore_index=True)
    table["status"] = "stationary"
    wanted = tuple(
        StoredObjective(quantity=name, sense=sense, column=key, title=title, unit=unit)
        for name, sense, key, title, unit in _OBJECTIVES
    )
    rows = rows_of_columns(table.to_dict("list"))
    extremes = {item.quantity: min(range(count), key=lambda row: item.minimised_value(rows[row])) for item in wanted}
    return Result(
        run="",
        name="Large front",
        status="done",
        message=f"{count} designs, 50000 evaluated",
        objectives=wanted,
        designs=rows,
        hypervolume=0.5,
        evaluations=50_000,
        seconds=12.0,
        seed=1,
        extremes=extremes,
        knee=count // 2,
        trade_offs=["1 deg more least transmission angle costs 0.8 N m more peak drive torque"],
    )


def put_large(store: Store, count: int = 10_000) -> int:
    """Put such a front into a store; return the number of its job."""
    return store_result(store, large_result(count), tomllib.loads(fronts.JOB))
