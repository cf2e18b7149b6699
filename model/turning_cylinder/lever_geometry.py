"""A lever on a fixed pivot, moved by a cylinder that turns about another: the slider-crank with its rod fixed.

The lever turns about O, the cylinder about A; B is the pin of the piston rod on the lever:

    crank  r = OB        frame  f = OA        offset  e: distance of the cylinder's line through B from A
    psi: angle from OA to OB, counter-clockwise        gamma: direction of the cylinder's line, from A's side to B

The chain is that of the offset slider-crank: the rod is fixed as the frame, and the slider position is the length L of
the cylinder along its line. The law of cosines gives

    D^2 = AB^2 = r^2 + f^2 - 2 r f cos(psi),   L^2 = D^2 - e^2,   L dL/dpsi = r f sin(psi).

B lies at A + e n + L u, with u = (cos(gamma), sin(gamma)) and n = u turned by +90 deg: for e > 0 the line passes A on
the side that is left of the way to B. Where O, A and B are in line, sin(psi) = 0, no force of the cylinder turns the
lever: a dead point.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..checks import require_numbers
from ..errors import AssemblyError, InputError
from ..kernel.arithmetic import analytic, arctangent, inverse, magnitude, root
from ..swing.angle_remedy import remedy_with_nearer_angles

_TURN = 2.0 * math.pi
Vectors = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class TurningCylinder:
    """The fixed dimensions of a lever and its turning cylinder, m and rad.

    crank: OB. frame: OA. frame_angle: direction of OA from +x. offset: distance of the cylinder's line from A, signed.
    pin_angle: angle from the lever's own line, whose angle is the lever angle, to OB.
    """

    crank: float
    frame: float
    frame_angle: float
    offset: float = 0.0
    pin_angle: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "crank", phrase="the crank OB of a lever", above=0.0, unit="m")
        if self.frame == 0.0:
            raise InputError(
                "lever and cylinder must turn about two different pivots; got pivots 0 mm apart; move one of them"
            )
        require_numbers(self, "frame", phrase="the frame OA of a lever", above=0.0, unit="m")
        require_numbers(self, "frame_angle", "offset", "pin_angle", phrase="the {} of a lever")

    def angle_from_frame_to_crank(self, lever_angle: Any) -> Any:
        """Return psi, rad, for lever angles, rad from +x."""
        return lever_angle + (self.pin_angle - self.frame_angle)

    def cylinder_length(self, lever_angle: Any) -> Any:
        """Return the length of the cylinder, m, at lever angles, rad; NaN where |offset| exceeds AB."""
        return cylinder_length(self.crank, self.frame, self.offset, self.angle_from_frame_to_crank(lever_angle))

    def lever_angle_at_length(self, length: Any, *, near: float) -> Any:
        """Return the lever angles, rad, at lengths of the cylinder, m; NaN for lengths out of reach.

        near: a lever angle on the same side of the dead points, at most half a turn from the results.
        """
        with np.errstate(invalid="ignore", divide="ignore"):
            return lever_angle_at(self, length, near)

    @property
    def closable_length_range(self) -> tuple[float, float]:
        """Least and greatest length, m, over all lever angles at which the linkage closes."""
        near, far = (self.crank - self.frame) ** 2, (self.crank + self.frame) ** 2
        least, greatest = (math.sqrt(max(square - self.offset**2, 0.0)) for square in (near, far))
        return least, greatest

    def dead_points(self, start: float, end: float) -> list[float]:
        """Return the lever angles, rad, between two at which O, A and B are in line, ends included."""
        low, high = sorted((self.angle_from_frame_to_crank(start), self.angle_from_frame_to_crank(end)))
        first, last = math.ceil(low / math.pi), math.floor(high / math.pi)
        return [math.pi * k - self.angle_from_frame_to_crank(0.0) for k in range(first, last + 1)]

    def dead_point_margin(self, start: float, end: float) -> float:
        """Return the least angle, rad, between the lever and a dead point, from one lever angle to another."""
        if self.dead_points(start, end):
            return 0.0
        return min(abs(math.remainder(self.angle_from_frame_to_crank(angle), math.pi)) for angle in (start, end))

    def require_swing(self, start: float, end: float) -> None:
        """Raise an error unless the cylinder moves the lever all the way between two angles, rad.

        `InputError` for equal ends and for a dead point, `AssemblyError` where the linkage does not close.
        """
        if not math.isfinite(start) or not math.isfinite(end) or start == end:
            raise InputError(
                f"a swing needs two different lever angles; got {_degrees_text(start)} and {_degrees_text(end)}; "
                "change one"
            )
        if abs(end - start) >= math.pi:
            raise InputError(
                "a cylinder must swing its lever less than 180 deg, from one dead point to the next; got "
                f"{_degrees_text(start)} to {_degrees_text(end)}; {remedy_with_nearer_angles(start, end)}"
            )
        dead = self.dead_points(start, end)
        if dead:
            raise InputError(
                "a cylinder moves the lever only between dead points, where both pivots and the pin are in line; the "
                f"swing from {_degrees_text(start)} to {_degrees_text(end)} has one at {_degrees_text(dead[0])}; swing "
                "on one side of it, or turn the frame"
            )
        lengths = self.cylinder_length(np.array([start, end]))
        if np.isnan(lengths).any() or not np.all(lengths > 0.0):
            angle = start if not lengths[0] > 0.0 else end
            distance = float(pin_distance(self.crank, self.frame, self.angle_from_frame_to_crank(angle)))
            raise AssemblyError(
                "the cylinder must reach the lever over the whole swing: |offset| < distance from A to B; got an "
                f"offset of {1e3 * self.offset:.6g} mm and {1e3 * distance:.6g} mm at {_degrees_text(angle)}; reduce "
                "the offset, or reduce the swing"
            )

    def require_turn(self) -> None:
        """Raise `AssemblyError` unless the crank rotates fully."""
        if abs(self.crank - self.frame) <= abs(self.offset):
            raise AssemblyError(
                "the crank rotates fully only if |offset| < |frame - crank|, the rod being the frame; got a crank of "
                f"{1e3 * self.crank:.6g} mm, a frame of {1e3 * self.frame:.6g} mm and an offset of "
                f"{1e3 * self.offset:.6g} mm; change the crank or the frame, or reduce the offset"
            )

    def motion_at(self, lever_angle: Array) -> LeverMotion:
        """Return the motion of lever and cylinder at lever angles (n,), rad."""
        motion = motion_at(self, lever_angle)
        radial, span, line = (part[0] + 1j * part[1] for part in (motion.radial, motion.span, motion.line))
        sine = np.abs((span.conj() * radial).imag) / np.abs(span)
        return LeverMotion(radial, span, line, *motion[3:], np.arcsin(np.minimum(sine, 1.0)))

    def worst_lever_angle_error(self, lever_angle: Array, errors: DimensionErrors) -> Array:
        """Return the worst-case error of the lever angle, rad, to first order.

        L^2 = r^2 + f^2 - 2 r f cos(psi) - e^2 at a given length: r f sin(psi) dpsi = L dL + e de - (r - f cos(psi)) dr
        - (f - r cos(psi)) df. Without bound at a dead point.
        """
        return np.asarray(
            angle_error_at(self, self.angle_from_frame_to_crank(lever_angle), self.cylinder_length(lever_angle), errors)
        )

    @property
    def time_ratio_of_full_turn(self) -> float | None:
        """Time ratio of the cylinder's turn where the lever turns fully at constant speed; None where it cannot.

        With m the lesser and M the greater of crank and frame, the crank turns by c on the fast stroke,
        c = acos((m - e) / M) + acos((m + e) / M), and the ratio is (2 pi - c) / c. Crank < frame: the cylinder swings
        between two reversals (shaper, oscillating pump). Frame < crank: it turns fully too (Whitworth), and a stroke
        lasts from one crossing of the normal of OA through A to the other.
        """
        lesser, greater = sorted((self.crank, self.frame))
        if lesser + abs(self.offset) >= greater:
            return None
        fast = sum(math.acos((lesser + side * self.offset) / greater) for side in (-1.0, 1.0))
        return (_TURN - fast) / fast


class DimensionErrors(NamedTuple):
    """Tolerances, m, of OB, OA, offset and length of the cylinder."""

    crank: float = 0.0
    frame: float = 0.0
    offset: float = 0.0
    length: float = 0.0


class LeverMotion(NamedTuple):
    """Motion at lever angles (n,). Vectors are complex numbers x + i y; primes mean d / d(lever angle).

    radial: direction of OB. span: AB, m. line: direction of the cylinder, towards B. length: L, m, with its
    derivatives. turn_1, turn_2: derivatives of the cylinder's angle gamma. transmission: angle between AB and the lever
    OB, rad, 0 to pi/2; along AB a cylinder without mass pushes.
    """

    radial: Vectors
    span: Vectors
    line: Vectors
    length: Array
    length_1: Array
    length_2: Array
    turn_1: Array
    turn_2: Array
    transmission: Array


class Motion(NamedTuple):
    """Motion of the lever and the cylinder as `LeverMotion` has it; vectors by their components x and y."""

    radial: tuple[Any, Any]
    span: tuple[Any, Any]
    line: tuple[Any, Any]
    length: Any
    length_1: Any
    length_2: Any
    turn_1: Any
    turn_2: Any


@analytic
def motion_at(sizes: Any, lever_angle: Any) -> Motion:
    """Return the motion at lever angles, rad; complex for complex steps. sizes: numbers of `TurningCylinder`."""
    r, f, e = sizes.crank, sizes.frame, sizes.offset
    pin_direction = lever_angle + sizes.pin_angle
    rx, ry = np.cos(pin_direction), np.sin(pin_direction)
    sx, sy = r * rx - f * np.cos(sizes.frame_angle), r * ry - f * np.sin(sizes.frame_angle)
    square = sx * sx + sy * sy
    length = root(square - e * e)
    per_square, per_length = inverse(square), inverse(length)
    lx, ly = (sx * length + sy * e) * per_square, (sy * length - sx * e) * per_square
    along, across = rx * lx + ry * ly, ry * lx - rx * ly
    turn_1 = r * along * per_length
    length_1 = e * turn_1 - r * across
    turn_2 = (-r * across * (1.0 - turn_1) - turn_1 * length_1) * per_length
    length_2 = (r * f * np.cos(pin_direction - sizes.frame_angle) - length_1 * length_1) * per_length
    return Motion((rx, ry), (sx, sy), (lx, ly), length, length_1, length_2, turn_1, turn_2)


@analytic
def lever_angle_at(sizes: Any, length: Any, near: Any) -> Any:
    """Return the lever angles of `TurningCylinder.lever_angle` for many levers; complex for complex steps."""
    shift = sizes.pin_angle - sizes.frame_angle
    psi = (near + shift).real
    turns = np.floor(psi / _TURN + 0.5)
    side = 2.0 * (psi >= _TURN * turns) - 1.0
    return side * angle_at_length(sizes.crank, sizes.frame, sizes.offset, length) + (_TURN * turns - shift)


@analytic
def angle_error_at(sizes: Any, psi: Any, length: Any, errors: Any) -> Any:
    """Return the errors of `TurningCylinder.worst_lever_angle_error` at angles psi, rad; complex for complex steps."""
    r, f, cosine = sizes.crank, sizes.frame, np.cos(psi)
    total = length * errors.length + magnitude(sizes.offset) * errors.offset
    total = total + magnitude(r - f * cosine) * errors.crank + magnitude(f - r * cosine) * errors.frame
    return total * inverse(r * f * magnitude(np.sin(psi)))


def pin_distance(crank: Any, frame: Any, psi: Any) -> Any:
    """Return AB, m, at angles psi from OA to OB, rad; complex for complex steps."""
    return np.sqrt(crank * crank + frame * frame - 2.0 * crank * frame * np.cos(psi))


def cylinder_length(crank: Any, frame: Any, offset: Any, psi: Any) -> Any:
    """Return the length L of the cylinder, m, at angles psi, rad; NaN where |offset| exceeds AB."""
    with np.errstate(invalid="ignore"):
        return closing_length(crank, frame, offset, psi)


@analytic
def closing_length(crank: Any, frame: Any, offset: Any, psi: Any) -> Any:
    """Return the length L of the cylinder, m, at angles psi, rad, at which the linkage closes."""
    return root(crank * crank + frame * frame - 2.0 * crank * frame * np.cos(psi) - offset * offset)


@analytic
def angle_at_length(crank: Any, frame: Any, offset: Any, length: Any) -> Any:
    """Return psi in [0, pi], rad, at lengths of the cylinder, m; NaN out of reach; complex for complex steps.

    The law of cosines in tangent form: tan(psi / 2)^2 = (D^2 - (r - f)^2) / ((r + f)^2 - D^2).
    """
    square, less, more = length * length + offset * offset, crank - frame, crank + frame
    return 2.0 * arctangent(root((square - less * less) * inverse(more * more - square)))


def crank_and_frame_for_stroke(
    lengths: tuple[float, float], angles: tuple[float, float], offset: float = 0.0
) -> tuple[float, float] | None:
    """Return the lesser and the greater of OB and OA, m, from cylinder lengths at two angles psi.

    Either may be the lever. r f = (L2^2 - L1^2) / (2 (cos(psi1) - cos(psi2))), and r^2 + f^2 follows from either end;
    None where no linkage has these.
    """
    (first, second), (psi_1, psi_2) = lengths, angles
    fall = math.cos(psi_1) - math.cos(psi_2)
    if fall == 0.0:
        return None
    product = (second**2 - first**2) / (2.0 * fall)
    squares = first**2 + offset**2 + 2.0 * product * math.cos(psi_1)
    if product <= 0.0 or squares < 2.0 * product:
        return None
    total, difference = math.sqrt(squares + 2.0 * product), math.sqrt(squares - 2.0 * product)
    return 0.5 * (total - difference), 0.5 * (total + difference)


def _degrees_text(angle: float) -> str:
    return f"{math.degrees(angle):.6g} deg"
