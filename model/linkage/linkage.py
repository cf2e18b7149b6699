"""The linkage: crank, connecting rod, offset and branch, with its closed forms and its kinematics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import AssemblyError, InputError
from ..kinematics import geometry
from ..kinematics.in_line import in_line
from ..kinematics.position import motion
from ..machine.mechanism import Branch
from ..signals.position_error import Influences, influences

Array = NDArray[np.float64]
SlowStroke = Literal["outward", "inward"]
Stroke = Literal["outward", "inward", "equal"]


@dataclass(frozen=True)
class Kinematics:
    """Motion at given crank angles; arrays of the broadcast shape, SI and radians.

    rod_angle: of the rod from +x, counter-clockwise; near 180 deg on the crossed branch.
    transmission_angle: between rod and the normal of the slider line, 90 deg - |phi| from the slider line.
    """

    crank_angle: Array
    slider_position: Array
    slider_velocity: Array
    slider_acceleration: Array
    rod_angle: Array
    rod_velocity: Array
    rod_acceleration: Array
    transmission_angle: Array


@dataclass(frozen=True)
class PointMotion:
    """Position, velocity and acceleration of a point on a link, each (..., 2): x and y. SI."""

    position: Array
    velocity: Array
    acceleration: Array


@dataclass(frozen=True)
class Linkage:
    """An offset slider-crank: crank, rod and offset in metres (scalars, or arrays that broadcast), and its branch.

    The sketch and the sign conventions are in `slidercrank.model.kinematics.position`. Any linkage that assembles at
    some crank angle is accepted; what needs full rotation says so and raises `AssemblyError` otherwise.

    >>> linkage = Linkage(crank=0.04, rod=0.064, offset=0.02)
    >>> round(float(linkage.stroke) * 1000, 6)
    88.792307
    """

    crank: Any
    rod: Any
    offset: Any = 0.0
    branch: Branch = "open"

    def __post_init__(self) -> None:
        values = []
        for name in ("crank", "rod", "offset"):
            try:
                value = np.asarray(getattr(self, name), dtype=np.float64)
            except (TypeError, ValueError):
                raise InputError(f"{name} must be a length in metres; got {getattr(self, name)!r}") from None
            if not np.all(np.isfinite(value)):
                raise InputError(f"{name} must be finite; got {getattr(self, name)!r}")
            values.append(value)
        try:
            crank, rod, offset = np.broadcast_arrays(*values)
        except ValueError:
            shapes = ", ".join(str(value.shape) for value in values)
            raise InputError(f"crank, rod and offset must broadcast to one shape; got {shapes}") from None
        for name, value in (("crank", crank), ("rod", rod)):
            if np.any(value <= 0.0):
                raise InputError(f"{name} must be longer than zero; got {_first(value, value <= 0.0):g} m")
        if self.branch not in ("open", "crossed"):
            raise InputError(f"branch must be 'open' or 'crossed'; got {self.branch!r}")
        apart = np.abs(offset) >= crank + rod
        if np.any(apart):
            raise AssemblyError(
                "the linkage closes at no crank angle: |offset| must be less than crank + rod; "
                f"got {_mm(crank, rod, offset, apart)}; shorten the offset or lengthen a link"
            )
        rounding = in_line(rod, offset) & (offset != 0.0)
        if np.any(rounding):
            values[2] = np.where(rounding, 0.0, offset)
        for name, value in zip(("crank", "rod", "offset"), values, strict=True):
            value = value.copy()
            value.flags.writeable = False
            object.__setattr__(self, name, value[()])

    @property
    def sign(self) -> float:
        """+1 on the open branch, -1 on the crossed one."""
        return 1.0 if self.branch == "open" else -1.0

    @property
    def rotates_fully(self) -> Any:
        """Whether the crank turns through: rod > crank + |offset|."""
        return self.rod > self.crank + np.abs(self.offset)

    def require_full_rotation(self) -> None:
        """Raise `AssemblyError` unless every linkage turns fully."""
        fails = ~np.asarray(self.rotates_fully)
        if np.any(fails):
            crank, rod, offset = np.broadcast_arrays(self.crank, self.rod, self.offset)
            raise AssemblyError(
                "rod must exceed crank + |offset| for full rotation; "
                f"got {_mm(crank, rod, offset, fails)}; lengthen the rod or reduce the offset"
            )

    @property
    def dead_centres(self) -> tuple[Any, Any]:
        """Slider positions (inner, outer), m: signed as x, so negative on the crossed branch."""
        self.require_full_rotation()
        dimensions = (self.crank, self.rod, self.offset)
        return (
            self.sign * geometry.inner_dead_centre(*dimensions),
            self.sign * geometry.outer_dead_centre(*dimensions),
        )

    @property
    def dead_centre_angles(self) -> tuple[Any, Any]:
        """Crank angles (inner, outer) in [0, 2 pi), rad."""
        self.require_full_rotation()
        dimensions = (self.crank, self.rod, self.offset)
        angles = (geometry.inner_crank_angle(*dimensions), geometry.outer_crank_angle(*dimensions))
        if self.branch == "crossed":
            angles = (np.pi - angles[0], np.pi - angles[1])
        inner, outer = (np.mod(angle, 2.0 * np.pi) for angle in angles)
        # Rounding takes a tiny negative angle to 2 pi itself.
        return np.where(inner < 2.0 * np.pi, inner, 0.0)[()], np.where(outer < 2.0 * np.pi, outer, 0.0)[()]

    @property
    def stroke(self) -> Any:
        """Distance between the dead centres, m: sqrt((l + r)^2 - e^2) - sqrt((l - r)^2 - e^2)."""
        self.require_full_rotation()
        return geometry.stroke(self.crank, self.rod, self.offset)

    @property
    def time_ratio(self) -> Any:
        """Duration of the slower stroke over the faster at constant speed, at least 1."""
        self.require_full_rotation()
        return geometry.time_ratio(self.crank, self.rod, np.abs(self.offset))

    def slow_stroke(self, *, direction: float = 1.0) -> Any:
        """Return which stroke is the slow one: "outward", "inward" or "equal" (no offset).

        direction: positive for a crank that turns counter-clockwise. With e > 0 on the open branch the inner dead
        centre comes pi + b after the outer one counter-clockwise, so the inward stroke is the slow one.
        """
        if not (direction > 0.0 or direction < 0.0):
            raise InputError(
                f"direction must be positive (counter-clockwise) or negative (clockwise); got {direction:g}"
            )
        self.require_full_rotation()
        offset = np.broadcast_to(self.offset, np.shape(self.rotates_fully))
        inward = np.sign(offset) * np.sign(direction) * self.sign
        return np.where(inward > 0.0, "inward", np.where(inward < 0.0, "outward", "equal"))[()]

    @property
    def least_transmission_angle(self) -> Any:
        """Least transmission angle over the cycle, rad: cos(mu_min) = (r + |e|) / l."""
        self.require_full_rotation()
        return geometry.least_transmission_angle(self.crank, self.rod, np.abs(self.offset))

    def at(self, crank_angle: ArrayLike, *, speed: ArrayLike = 0.0, acceleration: ArrayLike = 0.0) -> Kinematics:
        """Return the motion at crank angles (rad) for crank speed (rad/s) and acceleration (rad/s^2).

        All arguments broadcast with the dimensions. Raises `AssemblyError` where the linkage cannot be assembled.
        """
        theta, speed, acceleration = (
            np.asarray(value, dtype=np.float64) for value in (crank_angle, speed, acceleration)
        )
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
            np.arctan2(m.across, m.along),
            m.rod_1 * speed,
            m.rod_2 * w2 + m.rod_1 * acceleration,
            np.arctan2(np.abs(m.along), np.abs(m.across)),
        )
        return Kinematics(*(np.broadcast_to(field, shape) for field in fields))

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
        theta = np.asarray(crank_angle, dtype=np.float64)
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
        """Return the motion of a point on the rod, `along` it from the crank pin and `across` to its left, m."""
        theta = np.asarray(crank_angle, dtype=np.float64)
        m = self._motion(theta)
        pin = self.crank_point(theta, along=1.0, speed=speed, acceleration=acceleration)
        unit = np.stack(np.broadcast_arrays(m.along / self.rod, m.across / self.rod), axis=-1)
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
        """Return the first-order influence of crank, rod, offset (m/m) and crank angle (m/rad) on slider position."""
        theta = np.asarray(crank_angle, dtype=np.float64)
        found: Influences = influences(np.sin(theta), np.cos(theta), self._motion(theta), self.rod)
        return found

    def _motion(self, theta: Array) -> Any:
        if not np.all(np.isfinite(theta)):
            raise InputError("crank angles must be finite")
        reach = np.abs(self.offset - self.crank * np.sin(theta)) - self.rod
        if np.any(reach >= 0.0):
            crank, rod, offset, angle = np.broadcast_arrays(self.crank, self.rod, self.offset, theta)
            worst = np.unravel_index(np.argmax(np.broadcast_to(reach, angle.shape)), angle.shape)
            raise AssemblyError(
                "rod must exceed |offset - crank sin(crank angle)|; "
                f"got {_mm(crank, rod, offset, np.broadcast_to(reach >= 0.0, angle.shape))} "
                f"at {np.degrees(angle[worst]):.3f} deg; lengthen the rod or stay within the reachable angles"
            )
        return motion(np.sin(theta), np.cos(theta), self.crank, self.rod, self.offset, self.sign)


def crank_from_stroke(stroke: ArrayLike, *, rod: ArrayLike, offset: ArrayLike = 0.0) -> Any:
    """Return the crank, m, that gives a stroke with a rod and an offset, m; arrays broadcast.

    r^2 = S^2 (l^2 - e^2 - S^2/4) / (4 l^2 - S^2). Raises `AssemblyError` where no fully turning linkage gives it.
    """
    s, l, e = np.broadcast_arrays(*(np.asarray(value, dtype=np.float64) for value in (stroke, rod, offset)))
    with np.errstate(invalid="ignore", divide="ignore"):
        r = geometry.crank_from_stroke(s, l, e)
        wrong = ~((s > 0.0) & (r > 0.0) & (l > r + np.abs(e)) & (4.0 * l * r >= s * s))
    if np.any(wrong):
        raise AssemblyError(
            "no crank gives this stroke with full rotation; "
            f"got stroke {1e3 * _first(s, wrong):g} mm, rod {1e3 * _first(l, wrong):g} mm, "
            f"offset {1e3 * _first(e, wrong):g} mm; lengthen the rod or reduce the offset"
        )
    return r


def _first(values: Array, where: NDArray[np.bool_]) -> float:
    return float(np.asarray(values)[where].flat[0])


def _mm(crank: Array, rod: Array, offset: Array, where: NDArray[np.bool_]) -> str:
    crank, rod, offset = (np.broadcast_to(value, where.shape) for value in (crank, rod, offset))
    return (
        f"rod {1e3 * _first(rod, where):g} mm, crank {1e3 * _first(crank, where):g} mm, "
        f"offset {1e3 * _first(offset, where):g} mm"
    )
