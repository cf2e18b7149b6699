"""Pressure of the gas in a cylinder over a turn: expansion, valve events and compression in closed form.

Let z be the distance of the piston from its top, S the stroke, h the height of the clearance (its volume divided by the
piston area), p_l and p_h the low and the high pressure. The gas follows p V^n = const while the valves are closed:

- away from the top: p_h (h / (h + z))^n_e, until it has fallen to p_l at z_e = h ((p_h / p_l)^(1/n_e) - 1); then p_l;
- towards the top: p_l ((h + S) / (h + z))^n_c, until it has risen to p_h at z_c = (h + S) (p_l / p_h)^(1/n_c) - h;
  then p_h.

The pressure is continuous, with kinks at the valve events z_e and z_c. A liquid, given by zero exponents, has z_e = 0
and z_c = S: the pressure jumps at the dead centres.

Gas that burns at limited pressure stays at p_h from the top to z_b, where burning ends, and expands from there: p_h ((h
+ z_b) / (h + z))^n_e. It has no valve events.
"""

from typing import Any

from ..kernel.arithmetic import analytic, inverse, power
from ..machine.design import AREA, DESIGN, LOAD_ROWS
from ..machine.loads.load import Enters

_BURNING_CYLINDER = int(Enters.BURNING_CYLINDER)

_NEAR = 1e-12
"""Fraction of the stroke: closer to a valve event than this, a position counts as beyond it."""


@analytic
def expansion_end_position(h: Any, ratio: Any, exponent: Any) -> Any:
    """Return z_e, m, for a ratio p_h / p_l: where the gas has expanded to low pressure."""
    return h * (power(ratio, inverse(exponent)) - 1.0)


@analytic
def compression_end_position(stroke: Any, h: Any, ratio: Any, exponent: Any) -> Any:
    """Return z_c, m, for a ratio p_h / p_l: where the gas has been compressed to high pressure."""
    return (h + stroke) * inverse(power(ratio, inverse(exponent))) - h


@analytic
def valve_event_positions(d: Any, block: Any, j: int, k: int, kind: int) -> Any:
    """Return z_e and z_c for the cylinder that is load k in a derived block.

    If gas burns, the first is z_b, and there is no second event.
    """
    q = DESIGN + LOAD_ROWS * k + AREA
    if kind == _BURNING_CYLINDER:
        return block[q + 7, j], -block[q + 1, j]  # at z = -h, which the piston never reaches
    stroke, h, ratio = d.outer - d.inner, block[q + 1, j], block[q + 3, j] * inverse(block[q + 2, j])
    if block[q + 4, j].real == 0.0:
        return 0.0 * h, stroke + 0.0 * h
    return expansion_end_position(h, ratio, block[q + 5, j]), compression_end_position(
        stroke, h, ratio, block[q + 4, j]
    )


@analytic
def pressure_piece_at(d: Any, block: Any, j: int, k: int, kind: int, x: float) -> int:
    """Return 1 beyond z_e or z_b, plus 2 beyond z_c, for a slider distance x from the crank pivot."""
    q = DESIGN + LOAD_ROWS * k
    expanded, compressed = valve_event_positions(d, block, j, k, kind)
    z, near = block[q, j] * (x - block[q + 1, j]), _NEAR * (d.outer - d.inner)
    return (1 if z >= expanded - near else 0) + (2 if z > compressed + near else 0)


@analytic
def gas_force(m: Any, d: Any, block: Any, j: int, k: int, outward: bool, piece: int) -> Any:
    """Return the force from gas and back pressure on the piston, N outward, on a piece from `pressure_piece_at`."""
    q = DESIGN + LOAD_ROWS * k
    # Selected, as in `segments.add_formula_loads`, so that results without a cylinder are unchanged to the last digit.
    position = m.x if d.branch.real > 0.0 else -m.x
    sign, z = block[q, j], block[q, j] * (position - block[q + 1, j])
    area, h, low, high = block[q + 2, j], block[q + 3, j], block[q + 4, j], block[q + 5, j]
    back = block[q + 8, j]
    if outward == (sign.real > 0.0):  # away from the top
        if piece == 1 or piece == 3:
            return sign * area * (low - back)
        return sign * area * (high * power(h * inverse(h + z), block[q + 7, j]) - back)
    if piece < 2:
        return sign * area * (high - back)
    full = h + (d.outer - d.inner)
    return sign * area * (low * power(full * inverse(h + z), block[q + 6, j]) - back)


@analytic
def burning_force(m: Any, d: Any, block: Any, j: int, k: int, outward: bool, piece: int) -> Any:
    """Return the force from gas burning at limited pressure, like `gas_force`."""
    q = DESIGN + LOAD_ROWS * k
    position = m.x if d.branch.real > 0.0 else -m.x
    sign, z = block[q, j], block[q, j] * (position - block[q + 1, j])
    area, h, low, high = block[q + 2, j], block[q + 3, j], block[q + 4, j], block[q + 5, j]
    back = block[q + 8, j]
    if outward == (sign.real > 0.0):  # away from the top
        if piece == 0 or piece == 2:
            return sign * area * (high - back)
        return sign * area * (high * power((h + block[q + 9, j]) * inverse(h + z), block[q + 7, j]) - back)
    full = h + (d.outer - d.inner)
    return sign * area * (low * power(full * inverse(h + z), block[q + 6, j]) - back)
