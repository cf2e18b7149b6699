"""Best transmission angle at a stroke of 100 mm and a time ratio of 1.25: the problem of every adapter."""

import math

import numpy as np

import slidercrank as sc

STROKE, RATIO = 0.1, 1.25
NAMES = ["transmission_angle", "stroke", "time_ratio"]
NEAR = [0.045, 0.13, 0.03]
"""Where local methods start."""


def problem() -> sc.Problem:
    return sc.problem(
        {
            "name": "Quick return",
            "mechanism": {"speed": "60 rpm"},
            "variables": {"crank": ["20 mm", "80 mm"], "rod": ["60 mm", "400 mm"], "offset": ["0 mm", "200 mm"]},
            "constraints": {"stroke": {"equals": "100 mm"}, "time_ratio": {"equals": RATIO}},
            "objectives": {"transmission_angle": "maximise"},
        }
    )


def best_angle() -> float:
    """Return the greatest least transmission angle, deg, in closed form over the only unknown, the crank.

    With b = pi (Q - 1) / (Q + 1): l^2 (1 - cos b) + r^2 (1 + cos b) = S^2 / 2, e = (l^2 - r^2) sin(b) / S, and
    cos(mu) = (r + e) / l, which is least where its derivative with respect to the crank vanishes.
    """
    b = math.pi * (RATIO - 1.0) / (RATIO + 1.0)

    def cosine(r: np.ndarray[tuple[int], np.dtype[np.float64]]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        l = np.sqrt((0.5 * STROKE**2 - r * r * (1.0 + math.cos(b))) / (1.0 - math.cos(b)))
        return np.asarray((r + (l * l - r * r) * math.sin(b) / STROKE) / l)

    low, high = 0.03, 0.0499
    for _ in range(12):  # each grid a twentieth of the last; flat at its end to the square of that
        grid = np.linspace(low, high, 201)
        at = int(np.argmin(cosine(grid)))
        low, high = grid[max(at - 5, 0)], grid[min(at + 5, 200)]
    return math.degrees(math.acos(float(cosine(grid)[at])))


def degrees_of(design: object) -> float:
    """Return the least transmission angle of a design, deg; it must have the stroke and the time ratio."""
    angle, stroke, ratio = sc.evaluate(sc.Mechanism(), np.asarray(design, dtype=np.float64), NAMES)
    assert abs(stroke / STROKE - 1.0) < 1e-9
    assert abs(ratio / RATIO - 1.0) < 1e-9
    return math.degrees(angle)
