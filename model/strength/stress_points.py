"""Stress along crank and rod at many crank angles of many designs, with derivatives, in a single kernel for forces.

The search for the maximum stress (`stress_cycle`) then needs no forces.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, IntArray, Mask
from ..dynamics.breakpoints import Breakpoints, breakpoints_of
from ..dynamics.segments import (
    Cuts,
    CycleWindow,
    Segment,
    angle_identifying_segment,
    crank_angle_from_crowded,
    crowded_from_crank_angle,
    crowding_parameter,
    find_segment_pieces,
    load_on_slider,
)
from ..dynamics.torque_with_friction import (
    cut_imaginary_shift,
    friction_signs_in_segment,
    joint_forces_with_optional_friction,
    needs_friction_kernel,
)
from ..kernel.arithmetic import STEP
from ..kernel.kernel import ComplexCube, Cube, Flags, Integers, Row, Table, rarely_used_kernel
from ..machine.derived_designs import derived_blocks
from ..machine.design import design_at
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import Loads, Raw
from ..machine.raw_numbers_of_designs import RawNumbers, raw_machine_numbers
from ..signals.signal_inputs import cycle_window, signal_inputs
from ..signals.signals import Signal, design_motion
from .section_forces import stress_coefficients_of_link

ANGLES = 128
"""Samples per turn, at least three per segment."""
WIDE = 14
"""Columns for a link: seven coefficients of its `Stress`, and their derivatives."""
_TURN = 2.0 * math.pi
_SHORTEST = 1e-13  # rad: breakpoints closer than this count as one
_SLOTS = (*range(Raw.ROD_WIDTH, Raw.ROD_WIDTH + 3), *range(Raw.CRANK_WIDTH, Raw.CRANK_WIDTH + 3))


class Points(NamedTuple):
    """Crank angles of designs, p in total; all fields (p,).

    design: index of the design. probe: an angle within the segment, which identifies its pieces. angle: rad. column:
    column of the design number for the derivatives, -1 for derivatives with respect to the crank angle. cut: breakpoint
    at which the angle lies, -1 if there is none.
    """

    design: Integers
    probe: Row
    angle: Row
    column: Integers
    cut: Integers


class Samples(NamedTuple):
    """Samples over the cycles of n designs, one design after the other.

    start: (n + 1,), index at which each design begins. theta: (s,), rad. begins_segment: (s,), whether a segment
    begins.
    segment: (s,). stress: (s, 2 WIDE), for rod and crank.
    """

    start: Integers
    theta: Row
    begins_segment: Flags
    segment: Integers
    stress: Table


class Bars(NamedTuple):
    """Width, depth, density of rod and crank (n, 6), derivatives (v, 6); 0 without a bar."""

    sizes: Table
    rates: Table


@rarely_used_kernel
def _fill_stress(
    blocks: Cube,
    steps: ComplexCube,
    bars: Bars,
    points: Points,
    cuts: Breakpoints,
    loads: Loads,
    rubbing: bool,
    out: Table,
) -> None:
    watch = CycleWindow(0, 0.0, 1.0, False)
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    rows, nv, sizes = blocks.shape[1], bars.rates.shape[0], bars.sizes
    block, z_block = np.empty((rows, 1)), np.empty((rows, 1), np.complex128)
    last, last_column, last_probe, outward = -1, -2, 0.0, False
    d = design_at(block, 0)
    segment = Segment(block, loads, outward, piece, shift)
    sides = friction_signs_in_segment(0.0, d, segment, False)
    for p in range(points.design.shape[0]):
        n, v, probe, angle = points.design[p], points.column[p], points.probe[p], points.angle[p]
        if n != last:
            for i in range(rows):
                block[i, 0] = blocks[n, i, 0]
            d = design_at(block, 0)
        if n != last or probe != last_probe:
            _, outward = find_segment_pieces(d, block, 0, probe, loads, watch, piece, shift)
            segment = Segment(block, loads, outward, piece, shift)
            sides = friction_signs_in_segment(probe, d, segment, rubbing)
        if n != last or v != last_column:
            for i in range(rows):
                z_block[i, 0] = complex(block[i, 0], 0.0) if v < 0 else steps[n * nv + v, i, 0]
        last, last_column, last_probe = n, v, probe
        z, stepped = design_at(z_block, 0), Segment(z_block, loads, outward, piece, shift)
        slip = STEP if v < 0 else 0.0
        if v >= 0 and points.cut[p] >= 0:
            mine = Cuts(cuts.angle[n], cuts.code[n], cuts.number[n], cuts.load[n])
            slip = cut_imaginary_shift(z, stepped, d, segment, angle, mine, points.cut[p], sides)
        sine, cosine = math.sin(angle), math.cos(angle)
        zs, zc = complex(sine, cosine * slip), complex(cosine, -sine * slip)
        m = design_motion(zs, zc, z)
        load = load_on_slider(m, z, complex(angle, slip), stepped)
        f = joint_forces_with_optional_friction(zs, zc, m, z, load, sides)
        for part in range(2):
            w, t, rho = sizes[n, 3 * part], sizes[n, 3 * part + 1], sizes[n, 3 * part + 2]
            if not w > 0.0:  # no bar
                continue
            zw, zt, z_rho = complex(w, 0.0), complex(t, 0.0), complex(rho, 0.0)
            if v >= 0:
                zw = complex(w, STEP * bars.rates[v, 3 * part])
                zt = complex(t, STEP * bars.rates[v, 3 * part + 1])
                z_rho = complex(rho, STEP * bars.rates[v, 3 * part + 2])
            c = stress_coefficients_of_link(part, zs, zc, m, z, f, sides.turn, (zw, zt, z_rho))
            k = 2 * 7 * part
            for i in range(7):
                out[p, k + i], out[p, k + 7 + i] = c[i].real, c[i].imag / STEP


@rarely_used_kernel
def _sample_segments(
    designs: Table,
    cuts: Breakpoints,
    start: Integers,
    theta: Row,
    probe: Row,
    first: Flags,
    segment: Integers,
    kappas: Row,
) -> int:
    """Sample every segment at crowded angles; return the number of samples."""
    total = 0
    for n in range(designs.shape[0]):
        start[n] = total
        kappa = crowding_parameter(designs[n, 0], designs[n, 1], designs[n, 2])
        kappas[n] = kappa
        count = cuts.many[n]
        for s in range(count):
            a = cuts.angle[n, s]
            b = cuts.angle[n, s + 1] if s + 1 < count else cuts.angle[n, 0] + _TURN
            if b - a < _SHORTEST:
                continue
            low, high = crowded_from_crank_angle(a, kappa), crowded_from_crank_angle(b, kappa)
            points = max(3, int(ANGLES * (high - low) / _TURN) + 2)
            for i in range(points):
                angle = crank_angle_from_crowded(low + (high - low) * i / (points - 1), kappa)
                theta[total] = a if i == 0 else b if i == points - 1 else angle
                probe[total], first[total], segment[total] = angle_identifying_segment(a, b), i == 0, s
                total += 1
    start[designs.shape[0]] = total
    return total


@dataclass(frozen=True)
class StressField:
    """Stress over the cycles of n designs: their samples, and the data to evaluate it at any crank angle.

    kappa: (n,), parameter kappa of the crowded angle. locked: (n,), whether friction locks the design.
    """

    mechanism: Mechanism
    numbers: RawNumbers
    blocks: Array
    sizes: Array
    loads: Loads
    cuts: Breakpoints
    kappa: Array
    samples: Samples

    @property
    def locked_designs(self) -> Mask:
        """Return whether friction locks each design, (n,)."""
        is_locked: Mask = self.cuts.many == 0
        return is_locked

    def segment_end_angles(self, design: IntArray, segment: IntArray) -> tuple[Array, Array]:
        """Return where segments (p,) of designs (p,) begin and end, rad."""
        angle, count = self.cuts.angle, self.cuts.many[design]
        last = segment + 1 == count
        return angle[design, segment], angle[design, np.where(last, 0, segment + 1)] + np.where(last, _TURN, 0.0)

    def stress_at(self, design: IntArray, segment: IntArray, angle: Array) -> Array:
        """Return stress and its derivatives with respect to the crank angle, (p, 2 WIDE)."""
        begin, end = self.segment_end_angles(design, segment)
        no_number = np.full(len(design), -1)
        points = Points(design, _angles_within(begin, end), angle, no_number, no_number)
        return _stress_at_points(
            self.blocks,
            _NO_STEPS,
            self.sizes,
            _NO_TURN,
            points,
            self.cuts,
            self.loads,
            needs_friction_kernel(self.mechanism),
        )

    def design_slopes(self, design: IntArray, segment: IntArray, angle: Array, cut: IntArray) -> tuple[Array, Array]:
        """Return stress (p, 2 WIDE), and its derivatives by the numbers of the design, (p, 3 + k, 2 WIDE).

        cut: (p,), the breakpoint with which the angle moves, -1 if there is none.
        """
        begin, end = self.segment_end_angles(design, segment)
        columns = self.numbers.columns
        number_count = len(columns)
        raw, _ = signal_inputs(self.mechanism, Signal.CRANK_PIN_FORCE)
        _, steps = derived_blocks(raw, self.loads, columns, self.numbers.values, steps=True)
        turned = np.ascontiguousarray((columns[:, None] == np.array(_SLOTS)) * 1.0)
        points = Points(
            np.repeat(design, number_count),
            np.repeat(_angles_within(begin, end), number_count),
            np.repeat(angle, number_count),
            np.tile(np.arange(number_count), len(design)),
            np.repeat(cut, number_count),
        )
        stress = _stress_at_points(
            self.blocks, steps, self.sizes, turned, points, self.cuts, self.loads, needs_friction_kernel(self.mechanism)
        )
        stress = stress.reshape(len(design), number_count, 2 * WIDE)
        if self.numbers.slopes is None:
            return stress[:, 0], stress
        return stress[:, 0], np.einsum("pcx,pck->pkx", stress, self.numbers.slopes[design])


def _angles_within(begin: Array, end: Array) -> Array:
    """Return `angle_identifying_segment` for many segments."""
    angles: Array = angle_identifying_segment(begin, end)  # type: ignore[arg-type, assignment]
    return angles


_NO_STEPS, _NO_TURN = np.zeros((0, 0, 1), np.complex128), np.zeros((0, len(_SLOTS)))


def _stress_at_points(
    blocks: Array,
    steps: NDArray[np.complex128],
    sizes: Array,
    turned: Array,
    points: Points,
    cuts: Breakpoints,
    loads: Loads,
    rubbing: bool,
) -> Array:
    out = np.zeros((len(points.design), 2 * WIDE))
    _fill_stress(blocks, steps, Bars(sizes, turned), points, cuts, loads, rubbing, out)
    return out


def stress_field_of(mechanism: Mechanism, designs: Array) -> StressField:
    """Return the `StressField` for designs (n, 3 + k), each rotating fully."""
    raw, loads = signal_inputs(mechanism, Signal.CRANK_PIN_FORCE)
    numbers = raw_machine_numbers(mechanism, designs, slot_count=len(raw), gradients=True)
    values, n = numbers.values, len(designs)
    blocks, _ = derived_blocks(raw, loads, numbers.columns, values)
    sizes = np.empty((n, len(_SLOTS)))
    for index, slot in enumerate(_SLOTS):
        column = np.flatnonzero(numbers.columns == slot)
        sizes[:, index] = values[:, column[0]] if len(column) else raw[slot]
    cuts = breakpoints_of(
        blocks, loads, cycle_window(mechanism, Signal.CRANK_PIN_FORCE), rubbing=needs_friction_kernel(mechanism)
    )
    sample_limit = (ANGLES + 8) * n + 4 * int(cuts.many.sum())
    start, theta, probe = np.empty(n + 1, np.int64), np.empty(sample_limit), np.empty(sample_limit)
    first, segment, kappa = np.empty(sample_limit, np.bool_), np.empty(sample_limit, np.int64), np.empty(n)
    total = _sample_segments(np.ascontiguousarray(values[:, :3]), cuts, start, theta, probe, first, segment, kappa)
    theta, probe, first, segment = theta[:total], probe[:total], first[:total], segment[:total]
    no_number = np.full(total, -1)
    design = np.repeat(np.arange(n), np.diff(start))
    points = Points(design, probe, theta, no_number, no_number)
    stress = _stress_at_points(
        blocks, _NO_STEPS, sizes, _NO_TURN, points, cuts, loads, needs_friction_kernel(mechanism)
    )
    samples = Samples(start, theta, first, segment, stress)
    return StressField(mechanism, numbers, blocks, sizes, loads, cuts, kappa, samples)
