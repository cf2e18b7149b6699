"""The linkage: crank, connecting rod, offset and branch, with closed-form formulas and kinematics."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..arrays import Array, Mask
from ..checks import is_number
from ..errors import AssemblyError, InputError
from ..kernel.arithmetic import magnitude
from ..kinematics import geometry
from ..kinematics.position import Motion, motion
from ..machine.mechanism import Branch
from ..signals.position_error import Influences, influences
from .crank_angles_from_slider import CrankSolution, crank_solutions
from .dimensions import DIMENSIONS
from .linkage_picture import Pose, figure, svg
from .linkage_values import (
    Kinematics,
    PointMotion,
    dimension_arrays,
    dimensions_text,
    direction_angle,
    real_or_complex_array,
    wrap_into_turn,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SlowStroke = Literal["outward", "inward"]
Stroke = Literal["outward", "inward", "equal"]


@dataclass(frozen=True, init=False, eq=False)
class Linkage:
    """An offset slider-crank: crank, rod and offset in metres (scalars, or arrays that broadcast), and its branch.

    Dimensions, crank angles, speeds and accelerations may be complex; the results are then complex, too. The imaginary
    part of a result, divided by that of the stepped number, is the derivative, exact to rounding (complex step). Use a
    step such as 1e-30j, because only its first power is kept. Conditions and limits use the real parts.

    The sketch and the sign conventions are in `slidercrank.model.kinematics.position`. Any linkage that can be
    assembled at some crank angle is accepted. Methods that need full rotation say so and raise `AssemblyError`
    otherwise.

    >>> linkage = Linkage(crank=0.04, rod=0.064, offset=0.02)
    >>> round(float(linkage.stroke) * 1000, 6)
    88.792307
    >>> stepped = Linkage(crank=0.04 + 1e-30j, rod=0.064, offset=0.02)
    >>> round(float(stepped.stroke.imag) / 1e-30, 6)
    2.828088
    """

    crank: Array
    rod: Array
    offset: Array
    branch: Branch

    def __init__(self, crank: ArrayLike, rod: ArrayLike, offset: ArrayLike = 0.0, branch: Branch = "open") -> None:
        """Take lengths, m. Raises `InputError` for other values, `AssemblyError` if no crank angle is possible.

        A linkage by itself has no scale: for pure geometry, lengths in any unit will do.
        """
        values = dimension_arrays(crank, rod, offset)
        if branch not in ("open", "crossed"):
            raise InputError(f"branch must be 'open' or 'crossed'; got {branch!r}")
        for name, value in zip(DIMENSIONS, values, strict=True):
            value = value.copy()
            value.flags.writeable = False
            object.__setattr__(self, name, value[()])
        object.__setattr__(self, "branch", branch)

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Linkage)
            and self.branch == other.branch
            and all(np.array_equal(getattr(self, name), getattr(other, name)) for name in DIMENSIONS)
        )

    def __hash__(self) -> int:
        return hash((self.branch, *(tuple(np.ravel(getattr(self, name)).tolist()) for name in DIMENSIONS)))

    @property
    def sign(self) -> float:
        """+1 on the open branch, -1 on the crossed one."""
        return 1.0 if self.branch == "open" else -1.0

    @property
    def rotates_fully(self) -> Mask:
        """Whether the crank rotates fully: rod > crank + |offset|."""
        turns: Mask = self.rod.real > self.crank.real + np.abs(self.offset.real)
        return turns

    def require_full_rotation(self) -> None:
        """Raise `AssemblyError` unless every linkage rotates fully."""
        fails = ~np.asarray(self.rotates_fully)
        if np.any(fails):
            crank, rod, offset = np.broadcast_arrays(self.crank.real, self.rod.real, self.offset.real)
            raise AssemblyError(
                "rod must exceed crank + |offset| for full rotation; "
                f"got {dimensions_text(crank, rod, offset, fails)}; lengthen the rod or reduce the offset"
            )

    @property
    def dead_centres(self) -> tuple[Array, Array]:
        """Slider positions (inner, outer), m: signed as x, so negative on the crossed branch."""
        self.require_full_rotation()
        dimensions = (self.crank, self.rod, self.offset)
        return (
            self.sign * geometry.inner_dead_centre(*dimensions),
            self.sign * geometry.outer_dead_centre(*dimensions),
        )

    @property
    def dead_centre_angles(self) -> tuple[Array, Array]:
        """Crank angles (inner, outer) in [0, 2 pi), rad."""
        self.require_full_rotation()
        dimensions = (self.crank, self.rod, self.offset)
        angles = (geometry.inner_crank_angle(*dimensions), geometry.outer_crank_angle(*dimensions))
        if self.branch == "crossed":
            angles = (np.pi - angles[0], np.pi - angles[1])
        return wrap_into_turn(angles[0]), wrap_into_turn(angles[1])

    @property
    def stroke(self) -> Array:
        """Distance between the dead centres, m: sqrt((l + r)^2 - e^2) - sqrt((l - r)^2 - e^2)."""
        self.require_full_rotation()
        length: Array = geometry.stroke(self.crank, self.rod, self.offset)
        return length

    @property
    def time_ratio(self) -> Array:
        """Duration of the slower stroke divided by that of the faster one at constant speed, at least 1."""
        self.require_full_rotation()
        ratio: Array = geometry.time_ratio(self.crank, self.rod, magnitude(self.offset))
        return ratio

    def slow_stroke(self, *, direction: float = 1.0) -> NDArray[np.str_]:
        """Return which stroke is slower at constant speed: "outward", "inward" or "equal" (no offset).

        direction: positive for a crank that turns counter-clockwise. With e > 0 on the open branch, the inner dead
        centre is pi + b counter-clockwise from the outer one, so the inward stroke is slow.
        """
        if not is_number(direction) or not (direction > 0.0 or direction < 0.0):
            raise InputError(
                f"direction must be positive (counter-clockwise) or negative (clockwise); got {direction!r}"
            )
        self.require_full_rotation()
        offset = np.broadcast_to(self.offset.real, np.shape(self.rotates_fully))
        inward = np.sign(offset) * np.sign(direction) * self.sign
        stroke: NDArray[np.str_] = np.where(inward > 0.0, "inward", np.where(inward < 0.0, "outward", "equal"))[()]
        return stroke

    @property
    def least_transmission_angle(self) -> Array:
        """Minimum transmission angle over the cycle, rad: cos(mu_min) = (r + |e|) / l."""
        self.require_full_rotation()
        angle: Array = geometry.least_transmission_angle(self.crank, self.rod, magnitude(self.offset))
        return angle

    def at(self, crank_angle: ArrayLike, *, speed: ArrayLike = 0.0, acceleration: ArrayLike = 0.0) -> Kinematics:
        """Return the motion at crank angles (rad) for crank speed (rad/s) and acceleration (rad/s^2).

        All arguments broadcast with the dimensions. Raises `AssemblyError` where the linkage cannot be assembled.
        """
        theta, speed, acceleration = (real_or_complex_array(value) for value in (crank_angle, speed, acceleration))
        if not (np.all(np.isfinite(speed)) and np.all(np.isfinite(acceleration))):
            raise InputError("crank speed and acceleration must be finite")
        m = self._motion(theta)
        w2 = speed * speed
        shape = np.broadcast_shapes(np.shape(m.x), speed.shape, acceleration.shape)
        fields = (
            theta,
            m.x,
            m.x_1 * speed,
            m.x_2 * w2 + m.x_1 * acceleration,
            direction_angle(m.l_sin, m.l_cos),
            m.rod_1 * speed,
            m.rod_2 * w2 + m.rod_1 * acceleration,
            direction_angle(magnitude(m.l_cos), magnitude(m.l_sin)),
        )
        return Kinematics(*(np.broadcast_to(field, shape) for field in fields))

    def from_slider(
        self, position: ArrayLike, *, velocity: ArrayLike | None = None, acceleration: ArrayLike | None = None
    ) -> tuple[CrankSolution, ...]:
        """Return all crank angles that put the slider of one linkage at a position, each with the crank's motion.

        theta = atan2(e, x) -+ beta as in `slidercrank.model.linkage.inverse_kinematics`; speed = v / x', acceleration =
        (a - x'' speed^2) / x'. position: m, signed as x; velocity, m/s, and acceleration, m/s^2: along +x.
        There are two solutions, the outward one first; one at a dead centre, or if the other is on the other branch. At
        a dead centre any crank speed leaves the slider at rest: speed and acceleration are None.

        Raises `AssemblyError` for a position out of reach. Raises `InputError` for an array, an acceleration without
        velocity, and at a dead centre for a velocity other than 0 or an acceleration away from the stroke.

        >>> linkage = Linkage(crank=0.06, rod=0.23, offset=0.07)
        >>> for found in linkage.from_slider(0.24, velocity=-1.0):
        ...     print(found.stroke, round(found.crank_angle, 6), round(found.speed, 6))
        outward 5.451782 -14.815897
        inward 1.398992 17.055897
        """
        return crank_solutions(self, position, velocity, acceleration)

    def crank_point(
        self,
        crank_angle: ArrayLike,
        *,
        along: float,
        across: float = 0.0,
        speed: float = 0.0,
        acceleration: float = 0.0,
    ) -> PointMotion:
        """Return the motion of a point on the crank, `along` it from the pivot and `across` to its left, m."""
        theta = real_or_complex_array(crank_angle)
        sine, cosine = np.sin(theta), np.cos(theta)
        arm = np.stack([along * cosine - across * sine, along * sine + across * cosine], axis=-1)
        normal = np.stack([-arm[..., 1], arm[..., 0]], axis=-1)
        return PointMotion(arm, normal * speed, normal * acceleration - arm * speed**2)

    def rod_point(
        self,
        crank_angle: ArrayLike,
        *,
        along: float,
        across: float = 0.0,
        speed: float = 0.0,
        acceleration: float = 0.0,
    ) -> PointMotion:
        """Return the motion of a rod point, `along` from the crank pin and `across` to the left, m."""
        theta = real_or_complex_array(crank_angle)
        m = self._motion(theta)
        pin = self.crank_point(theta, along=1.0, speed=speed, acceleration=acceleration)
        unit = np.stack(np.broadcast_arrays(m.l_cos / self.rod, m.l_sin / self.rod), axis=-1)
        normal = np.stack([-unit[..., 1], unit[..., 0]], axis=-1)
        arm, turned = along * unit + across * normal, along * normal - across * unit
        crank = np.asarray(self.crank)[..., None]
        rod_speed = (m.rod_1 * speed)[..., None]
        rod_acceleration = (m.rod_2 * speed**2 + m.rod_1 * acceleration)[..., None]
        return PointMotion(
            crank * pin.position + arm,
            crank * pin.velocity + turned * rod_speed,
            crank * pin.acceleration + turned * rod_acceleration - arm * rod_speed**2,
        )

    def error_influences(self, crank_angle: ArrayLike) -> Influences:
        """Return first-order influences of crank, rod, offset (m/m) and crank angle (m/rad) on slider position."""
        theta = real_or_complex_array(crank_angle)
        per_dimension: Influences = influences(np.sin(theta), np.cos(theta), self._motion(theta), self.rod)
        return per_dimension

    def plot(self, crank_angle: float = 1.0) -> Figure:
        """Return a matplotlib figure of one linkage at a crank angle, rad.

        Raises `InputError` for an array of linkages or angles, `AssemblyError` where it cannot be assembled.
        """
        return figure(self._pose(crank_angle), float(self.crank.real), self.label)

    def _repr_html_(self) -> str | None:
        """Picture of one linkage for notebooks; None for an array of linkages."""
        if np.ndim(self.rotates_fully):
            return None
        normal_angle = np.arcsin(np.clip(self.offset.real / self.crank.real, -1.0, 1.0))
        angle = 1.0 if bool(self.rotates_fully) else float(normal_angle)
        return f"<div>{svg(self._pose(angle), float(self.crank.real), self.label)}<p>{self.label}</p></div>"

    @property
    def label(self) -> str:
        """Dimensions of one linkage in words, mm."""
        self._require_single_linkage("a label")
        sizes = (f"{name} {1e3 * float(getattr(self, name).real):.6g} mm" for name in DIMENSIONS)
        return ", ".join(sizes) + ("" if self.branch == "open" else ", crossed")

    def _pose(self, crank_angle: float) -> Pose:
        self._require_single_linkage("a picture")
        theta = real_or_complex_array(crank_angle, "a crank angle")
        if theta.ndim:
            raise InputError(
                f"a picture can only show one crank angle; got an array of shape {theta.shape}; choose one"
            )
        crank_angle = float(theta.real)
        m, crank = self._motion(np.asarray(crank_angle)), float(self.crank.real)
        ends = self.dead_centres if bool(self.rotates_fully) else (np.asarray(np.nan), np.asarray(np.nan))
        return Pose(
            pin=(crank * math.cos(crank_angle), crank * math.sin(crank_angle)),
            slider=(float(m.x.real), float(self.offset.real)),
            stroke=(float(ends[0].real), float(ends[1].real)),
        )

    def _require_single_linkage(self, subject: str) -> None:
        if np.ndim(self.rotates_fully):
            raise InputError(
                f"{subject} can only show one linkage; got an array of shape {np.shape(self.rotates_fully)}; choose one"
            )

    def _motion(self, theta: Array) -> Motion:
        try:
            np.broadcast_shapes(np.shape(theta), np.shape(self.rotates_fully))
        except ValueError:
            raise InputError(
                f"crank angles must broadcast with the linkages; got shapes {np.shape(theta)} and "
                f"{np.shape(self.rotates_fully)}; give the linkages an axis of length 1 for "
                "the angles, as crank[:, None] has"
            ) from None
        if not np.all(np.isfinite(theta)):
            raise InputError("crank angles must be finite")
        excess = np.abs(self.offset.real - self.crank.real * np.sin(theta.real)) - self.rod.real
        if np.any(excess >= 0.0):
            parts = (self.crank, self.rod, self.offset, theta)
            crank, rod, offset, angle = np.broadcast_arrays(*(part.real for part in parts))
            worst = np.unravel_index(np.argmax(np.broadcast_to(excess, angle.shape)), angle.shape)
            raise AssemblyError(
                "rod must exceed |offset - crank sin(crank angle)|; "
                f"got {dimensions_text(crank, rod, offset, np.broadcast_to(excess >= 0.0, angle.shape))} "
                f"at {np.degrees(angle[worst]):.3f} deg; lengthen the rod or stay within the reachable angles"
            )
        return motion(np.sin(theta), np.cos(theta), self.crank, self.rod, self.offset, self.sign)
