"""Arguments for a custom function: designs, with their motion and forces over the cycle."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array
from ...model.cycle.stroke_times import scaled_stroke_times
from ...model.errors import InputError
from ...model.kernel.arithmetic import magnitude as _magnitude
from ...model.kinematics import geometry
from ...model.kinematics.position import Motion, motion, third_slider_derivative
from ...model.machine.mechanism import Mechanism
from ...model.signals.complex_forces import complex_joint_forces
from ..machine_needs import ONE_TIMING

Numbers = NDArray[Any]
Curve = Callable[[Numbers], Numbers]

_GRID = 128  # crank angles per turn, denser where the linkage is close to locking
_MEAN = 192
_ZOOMS = 4
_WITHIN = 9  # angles per zoom step
_PEAKS = 3
_TURN = 2.0 * np.pi
_SIDE_STEP = 1e-9  # rad, from a dead centre, on the side that counts
_FIFTH = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0  # first and second derivatives from five points
_SECOND = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / 12.0


class Peaks(np.ndarray[Any, np.dtype[Any]]):
    """Local peaks (n, k) with their crank angles, which arithmetic preserves.

    The search follows peaks by these angles.
    """

    angles: Array | None = None

    def __array_finalize__(self, of: object) -> None:
        """Copy the angles from the source array."""
        self.angles = getattr(of, "angles", None)


class PinForce(NamedTuple):
    """Joint force, (n, k), N: components along x and y, and magnitude."""

    x: Numbers
    y: Numbers

    @property
    def size(self) -> Numbers:
        """Return the magnitude, N."""
        return cast(Numbers, np.sqrt(self.x * self.x + self.y * self.y))


class Reactions(NamedTuple):
    """Drive torque (N m) and forces (N) over the crank angle, each (n, k); signs as in `model.dynamics`.

    load: load on the slider, positive outward. guide: force from the guide on the slider, along +y.
    """

    torque: Numbers
    pivot: PinForce
    crank_pin: PinForce
    slider_pin: PinForce
    guide: Numbers
    load: Numbers


class Designs:
    """A batch of n designs for one machine, in real or complex numbers.

    crank, rod, offset: (n, 1), m. mechanism: speed, masses, loads. Functions of the crank angle are methods; they take
    angles (k,) or (n, k), rad, and return (n, k). SI throughout. The imaginary part of a complex number carries a
    derivative. Write formulas with operators and numpy's sqrt, sin, exp ..., and `magnitude` in place of abs.
    """

    def __init__(self, mechanism: Mechanism, dimensions: Numbers) -> None:
        """Take designs (n, 3)."""
        self.mechanism = mechanism
        self._branch = mechanism.sign
        self._set_dimensions(dimensions)

    def __len__(self) -> int:
        return len(self._dimensions)

    @property
    def angles(self) -> Array:
        """Crank angles (n, 128) around the cycle, denser where the linkage is close to locking."""
        return self._crank_angles_from_crowded(np.linspace(-np.pi, np.pi, _GRID, endpoint=False))[0]

    # ---- closed forms ---------------------------------------------------------------------------------------------

    @property
    def stroke(self) -> Numbers:
        """Distance between the dead centres, m, (n, 1)."""
        return cast(Numbers, geometry.stroke(self.crank, self.rod, self.offset))

    @property
    def time_ratio(self) -> Numbers:
        """Duration of the slower stroke divided by that of the faster stroke, (n, 1).

        Raises `InputError` if cylinders differ.
        """
        if self.mechanism.speed_profile is None:
            return self.crank_angle_ratio
        if not ONE_TIMING.is_met(self.mechanism):
            raise InputError(f"time_ratio: {ONE_TIMING.missing}")
        ratio = scaled_stroke_times(self.mechanism, self.crank, self.rod, self.offset).outward_to_inward_ratio
        return cast(Numbers, np.where(np.real(ratio) >= 1.0, ratio, 1.0 / ratio))

    @property
    def crank_angle_ratio(self) -> Numbers:
        """Crank angle of the longer stroke divided by that of the shorter stroke, (n, 1)."""
        return cast(Numbers, geometry.time_ratio(self.crank, self.rod, magnitude(self.offset)))

    @property
    def least_transmission_angle(self) -> Numbers:
        """Minimum transmission angle over the cycle, rad, (n, 1)."""
        return cast(Numbers, geometry.least_transmission_angle(self.crank, self.rod, magnitude(self.offset)))

    # ---- over the crank angle -------------------------------------------------------------------------------------

    def position(self, angle: Numbers) -> Numbers:
        """Return the slider position x, m."""
        return cast(Numbers, self._motion(angle).x.copy())

    def velocity(self, angle: Numbers) -> Numbers:
        """Return the slider velocity along x, m/s."""
        return cast(Numbers, self._motion(angle).x_1 * self._speed_acceleration_and_slope(angle)[0])

    def acceleration(self, angle: Numbers) -> Numbers:
        """Return the slider acceleration along x, m/s^2."""
        m, (speed, acceleration, _) = self._motion(angle), self._speed_acceleration_and_slope(angle)
        return cast(Numbers, m.x_2 * speed**2 + m.x_1 * acceleration)

    def jerk(self, angle: Numbers) -> Numbers:
        """Return the slider jerk along x, m/s^3."""
        m, (speed, acceleration, bend) = self._motion(angle), self._speed_acceleration_and_slope(angle)
        third = third_slider_derivative(np.sin(angle), np.cos(angle), m, self.crank)
        return cast(Numbers, third * speed**3 + 3.0 * m.x_2 * speed * acceleration + m.x_1 * speed * bend)

    def rod_angle(self, angle: Numbers) -> Numbers:
        """Return the angle between rod and slider line, rad, positive if the rod rises outward."""
        m = self._motion(angle)
        return cast(Numbers, np.arcsin(m.l_sin / self.rod))

    def transmission_angle(self, angle: Numbers) -> Numbers:
        """Return the angle between rod and the normal of the slider line, rad."""
        return cast(Numbers, 0.5 * np.pi - magnitude(self.rod_angle(angle)))

    def forces(self, angle: Numbers) -> Reactions:
        """Return drive torque and joint forces for one cylinder, friction included.

        NaN where friction locks the linkage.

        Raises `InputError` with a speed profile, and for a cycle of two turns.
        """
        if self.mechanism.speed_profile is not None:
            raise InputError(
                "forces in a custom function need a constant speed; got a speed profile; leave it out, or use the "
                "included quantities or formulas of them"
            )
        shape = np.broadcast_shapes(np.shape(angle), (len(self), 1))
        reactions, load = complex_joint_forces(self.mechanism, self._dimensions, np.broadcast_to(angle, shape))
        parts: list[Numbers] = [*reactions, load]
        if not (np.iscomplexobj(self._dimensions) or np.iscomplexobj(angle)):
            parts = [part.real for part in parts]
        torque, pivot_x, pivot_y, pin_x, pin_y, end_x, end_y, guide, force = parts
        pins = PinForce(pivot_x, pivot_y), PinForce(pin_x, pin_y), PinForce(end_x, end_y)
        return Reactions(torque, *pins, guide, force)

    # ---- over the cycle -------------------------------------------------------------------------------------------

    def greatest(self, curve: Curve) -> Numbers:
        """Return the maximum of a curve over the cycle, (n, 1): the first of the `peaks`."""
        return self.peaks(curve).view(np.ndarray)[:, :1]

    def mean(self, curve: Curve) -> Numbers:
        """Return the mean of a curve over the crank angle, (n, 1); exact to rounding for smooth curves."""
        angle, share = self._crank_angles_from_crowded(np.linspace(-np.pi, np.pi, _MEAN, endpoint=False))
        return cast(Numbers, np.mean(curve(angle) * share, axis=1, keepdims=True))

    def peaks(self, curve: Curve) -> Peaks:
        """Return the three highest local peaks of a curve over the cycle, (n, 3), highest first.

        Return them from your function unchanged, or scaled and shifted by terms that do not depend on the crank angle.
        The maximum is the quantity; the other peaks let the search handle ties. curve: takes angles (n, k) and returns
        (n, k). Peaks are located to rounding if the curve is smooth or jumps at the dead centres, and to about 1e-5 of
        a turn at other jumps and kinks.
        """
        tau = np.broadcast_to(np.linspace(-np.pi, np.pi, _GRID, endpoint=False), (len(self), _GRID))
        spacing = _TURN / _GRID
        samples = self._sample_curve(curve, tau)
        local = (samples >= np.roll(samples, 1, axis=1)) & (samples >= np.roll(samples, -1, axis=1))
        order = np.argsort(np.where(local, -samples, np.inf), axis=1, kind="stable")[:, :_PEAKS]
        is_peak = np.take_along_axis(local, order, axis=1)
        order = np.where(is_peak, order, order[:, :1])  # with fewer peaks, repeat the highest
        centre, half = np.take_along_axis(tau, order, axis=1), spacing
        for _ in range(_ZOOMS):
            steps = np.linspace(-half, half, _WITHIN)
            centre = centre + steps[np.argmax(self._sample_near(curve, centre, steps), axis=2)]
            half *= 2.0 / (_WITHIN - 1)
        centre = self._peak_angle_near(curve, centre, half)
        angle = self._crank_angles_from_crowded(centre)[0]
        values = np.array(curve(angle))
        values, angle = self._move_peaks_onto_jumps(curve, values, angle)
        order = np.argsort(-values.real, axis=1, kind="stable")
        result = np.take_along_axis(values, order, axis=1).view(Peaks)
        result.angles = np.take_along_axis(angle, order, axis=1)
        return result

    def _set_dimensions(self, dimensions: Numbers) -> None:
        self.crank, self.rod, self.offset = (dimensions[:, v, None] for v in range(3))
        self._dimensions = dimensions
        self._known: tuple[Numbers, Motion] | None = None

    @contextmanager
    def _with_real_designs(self) -> Iterator[None]:
        """Use real numbers in the meantime: they are faster, and locating a peak needs no derivative."""
        designs = self._dimensions
        self._set_dimensions(designs.real)
        try:
            yield
        finally:
            self._set_dimensions(designs)

    def _motion(self, angle: Numbers) -> Motion:
        """Return the motion, reused from the previous call for the same angles: a curve needs it several times."""
        if self._known is None or not np.array_equal(self._known[0], angle):
            sine, cosine = np.sin(angle), np.cos(angle)
            found = motion(sine, cosine, self.crank, self.rod, self.offset, self._branch)
            self._known = np.array(angle), found
        return self._known[1]

    def _speed_acceleration_and_slope(self, angle: Numbers) -> tuple[Any, Any, Any]:
        """Return crank speed, crank acceleration, and the derivative of the acceleration with respect to the angle."""
        profile, mean = self.mechanism.speed_profile, self.mechanism.speed
        if profile is None:
            return mean, self.mechanism.acceleration, 0.0
        at = np.real(angle)
        ratio: Any = profile.speed_ratio(at)
        slope: Any = profile.speed_ratio_slope(at)
        curvature = profile.speed_ratio_curvature(at)
        if np.iscomplexobj(angle):
            step = 1j * np.imag(angle)
            ratio, slope = ratio + step * slope, slope + step * curvature
        return mean * ratio, mean**2 * ratio * slope, mean**2 * (slope**2 + ratio * curvature)

    def _crank_angles_from_crowded(self, tau: Numbers) -> tuple[Array, Array]:
        """Return crank angles (n, k) for crowded angles, with their derivative; see `segments.crowding_parameter`."""
        q = (self.crank / (self.rod - magnitude(self.offset))).real
        kappa = np.sqrt(np.sqrt(np.maximum(1.0 - q * q, 1e-12)))
        sine, cosine = np.sin(tau), np.cos(tau)
        turn = np.arctan2(kappa * sine, cosine) - tau
        angle = 0.5 * np.pi + tau + turn - _TURN * np.round(turn / _TURN)
        return angle, kappa / (cosine**2 + (kappa * sine) ** 2)

    def _sample_curve(self, curve: Curve, tau: Numbers) -> Array:
        with self._with_real_designs():
            values = np.asarray(curve(self._crank_angles_from_crowded(tau)[0]))
        if values.shape != tau.shape:
            raise ValueError(
                f"a curve must return one value for each crank angle, {tau.shape}; got {values.shape}; use the "
                "angles that it receives, and do not sum over them"
            )
        return cast(Array, values.real)

    def _sample_near(self, curve: Curve, centre: Numbers, steps: Numbers) -> Array:
        """Return the curve (n, p, s) at steps (s,) from crowded angles (n, p)."""
        tau = centre[:, :, None] + steps
        return self._sample_curve(curve, tau.reshape(len(centre), -1)).reshape(tau.shape)

    def _peak_angle_near(self, curve: Curve, centre: Numbers, half: float) -> Numbers:
        """Return the zero of the derivative after one Newton step; the centre itself if there is no smooth peak."""
        samples = self._sample_near(curve, centre, np.arange(-2.0, 3.0) * half)
        first, second = samples @ _FIFTH, samples @ _SECOND
        smooth = second < 0.0
        step = np.where(smooth, -first / np.where(smooth, second, 1.0), 0.0)
        return centre + np.where(np.abs(step) <= 2.0, step * half, 0.0)

    def _move_peaks_onto_jumps(self, curve: Curve, values: Numbers, angle: Numbers) -> tuple[Numbers, Array]:
        """Return peaks and angles; a peak near a jump moves onto it, because dead centres move with the design."""
        dimensions = (self.crank, self.rod, self.offset)
        outer, inner = geometry.outer_crank_angle(*dimensions), geometry.inner_crank_angle(*dimensions)
        ends = np.concatenate([outer, inner], axis=1)
        ends = ends if self._branch > 0.0 else np.pi - ends
        sides = np.concatenate([ends - _SIDE_STEP, ends + _SIDE_STEP], axis=1)
        jumps = curve(sides)
        for k in range(angle.shape[1]):
            distance = np.abs(np.angle(np.exp(1j * (sides.real - angle[:, k : k + 1]))))
            near = np.where((distance < 1e-2) & (jumps.real > values[:, k : k + 1].real), jumps.real, -np.inf)
            at = np.argmax(near, axis=1)[:, None]
            onto = np.isfinite(np.take_along_axis(near, at, axis=1))[:, 0]
            values[onto, k] = np.take_along_axis(jumps, at, axis=1)[onto, 0]
            angle[onto, k] = np.take_along_axis(sides.real, at, axis=1)[onto, 0]
        return values, angle


def magnitude(values: Numbers) -> Numbers:
    """Return the magnitudes of numbers: `abs` that preserves the derivative carried by a complex number."""
    return cast(Numbers, _magnitude(values))
