"""Remedy for the two angles of a swing of half a turn or more."""

import math

_TURN = 2.0 * math.pi


def remedy_with_nearer_angles(start: float, end: float) -> str:
    """Return the remedy for a swing of half a turn or more, rad: nearer angles of the same ends."""
    near = [math.remainder(angle, _TURN) for angle in (start, end)]
    pairs = zip((start, end), near, strict=True)
    wrapped = [
        f"{math.degrees(other):.6g} deg for {math.degrees(angle):.6g} deg"
        for angle, other in pairs
        if abs(other - angle) > 1.0
    ]
    if wrapped and 0.0 < abs(near[1] - near[0]) < math.pi:
        return f"angles must be written without wrapping at a full turn: write {' and '.join(wrapped)}"
    return "reduce the swing"
