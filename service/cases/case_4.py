"""Case 4: position error of the tilting support. Lengths fitted to its Table 1, with the offset of the mirror image."""

import math

import numpy as np
from numpy.typing import ArrayLike

from ...model.arrays import Array
from ...model.linkage.linkage import Linkage
from .printed_values import Numbers, read_printed_table

LINKAGE = Linkage(1.400, 1.800, -0.050)
SHARE, ANGLE_ERROR = 1e-3, math.radians(0.1)
COLUMNS = ("crank", "rod", "offset", "crank_angle", "total")


def printed_table() -> dict[str, Array]:
    """Return Table 1 as numbers, by the column names of its file."""
    lines = read_printed_table("position_error_table1.csv")
    return {name: np.array([float(line[name]) for line in lines]) for name in lines[0]}


def position_error_contributions(crank_angle: ArrayLike) -> dict[str, Array]:
    """Return the exact first-order contributions, mm, by `COLUMNS`, at crank angles, rad; the total is signed.

    The paper's offset error is positive if its offset, which is the negative of ours, grows.
    """
    i = LINKAGE.error_influences(crank_angle)
    r, l, e = float(LINKAGE.crank), float(LINKAGE.rod), float(LINKAGE.offset)
    parts = {
        "crank": 1e3 * i.crank * SHARE * r,
        "rod": 1e3 * i.rod * SHARE * l,
        "offset": 1e3 * i.offset * SHARE * e,
        "crank_angle": 1e3 * i.crank_angle * ANGLE_ERROR,
    }
    return parts | {"total": sum(parts.values())}


def computed_values() -> Numbers:
    """Return the exact values by key."""
    theta = np.radians(printed_table()["crank_angle_deg"])
    at = LINKAGE.at(theta)
    columns = {
        "rod_angle": -np.degrees(at.rod_angle),
        "position": 1e3 * at.slider_position,
        **position_error_contributions(theta),
    }
    exact = {
        f"{name}_{row}": float(value) for name, values in columns.items() for row, value in enumerate(values, start=1)
    }
    first, last = columns["rod_angle"][[0, -1]]
    return Numbers(exact | {"first_rod_angle": float(first), "last_rod_angle": float(last)})
