"""Crank angles that put the slider at a position, with the crank pin on a given side."""

from typing import Any

import numpy as np

from ..kinematics.position import motion

_OFF = 1e-9


def crank_angles_at(x: Any, sign: float, side: float, designs: Any) -> Any:
    """Return the crank angles (n,) of designs that put the slider at x (n,); NaN where there is none.

    sign: +1 on the open branch, -1 on the crossed one. side: +1 if the crank pin is left of the line from crank pivot
    to slider pin, -1 if it is right of it. Complex if the designs are complex.
    """
    r, l, e = (designs[:, column] + 0.0 for column in range(3))  # -0 counts as 0
    plain = [np.real(number) for number in (x, r, l, e)]
    x_0, r_0, l_0, e_0 = plain
    d = np.hypot(x_0, e_0)
    with np.errstate(divide="ignore", invalid="ignore"):
        theta = np.arctan2(e_0, x_0) + side * np.arccos((r_0 * r_0 + d * d - l_0 * l_0) / (2.0 * r_0 * d))
        for _ in range(2):  # acos is inaccurate near the ends of its domain
            m = motion(np.sin(theta), np.cos(theta), r_0, l_0, e_0, sign)
            theta = np.where(np.abs(m.x - x_0) < _OFF * r_0, theta - (m.x - x_0) / m.x_1, np.nan)
        if not np.iscomplexobj(designs):
            return theta
        m = motion(np.sin(theta), np.cos(theta), r, l, e, sign)
        return theta + 1j * (np.imag(x) - m.x.imag) / m.x_1.real
