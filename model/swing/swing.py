"""A limited swing of the crank, driven at the crank or at the slider.

The linkage need not rotate fully: it only has to close over the whole swing, l > |e - r sin(theta)|. If the slider
drives, it must also pass no dead point, sin(theta - phi) = 0, at which no force on the slider turns the crank.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..checks import require_all_finite, require_numbers, store_as_tuples
from ..errors import AssemblyError, InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_linkage, require_slider
from ..machine.loads.load import require_word
from ..machine.mechanism import Mechanism
from .angle_remedy import remedy_with_nearer_angles
from .angles_from_position import crank_angles_at
from .law import NO_TABLE, law_spline_pieces, travel_speed_acceleration
from .swing_types import Law, Side, Stated, SwingDriver

STARTS = {"crank": "start.angle", "slider": "start.place"}
"""Number of a machine that states the start of a swing, by the link for which the ends are stated."""
_TURN = 2.0 * math.pi
_LEAST, _MOST = 1e-6, 1e9  # s


@dataclass(frozen=True, kw_only=True)
class Swing:
    """A swing from one crank angle to another, rad, and back; or from one slider position to another, m.

    The crank turns from start towards end: clockwise if end is smaller. stated_for: "crank" if start and end are crank
    angles, "slider" if they are slider positions; then `side` says on which side of the line from crank pivot to slider
    pin the crank pin is, and `swing_between_crank_angles` gives the crank angles. follows: whether the end moves along
    with a start that designs choose (`machine.start`). driver: driver of the linkage, a torque on the crank or a force
    on the slider along its line, or the cylinder of a lever, whose angles start and end then are. `CRANK_TURN` is the
    full turn of a lever as a crank. law: law of the driver's motion over time, in each stroke. duration: time of one
    stroke, s; none for slow motion. actuator_tolerance: tolerance of the slider position if the slider drives, m.
    points: points of a tabulated law: fractions of time and travel, see `law.law_spline_pieces`.
    """

    start: float
    end: float
    driver: SwingDriver = "crank"
    law: Law = "slow"
    duration: float | None = None
    actuator_tolerance: float = 0.0
    stated_for: Stated = "crank"
    side: Side = "left"
    follows: bool = False
    points: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        store_as_tuples(self, "points")
        require_all_finite("start and end of a swing", (self.start, self.end))
        require_numbers(self, "duration", phrase="the duration of a swing", above=0.0, unit="s")
        require_numbers(self, "actuator_tolerance", phrase="the tolerance of the actuator", least=0.0, unit="m")
        require_word("driver", self.driver, SwingDriver)
        require_word("law", self.law, Law)
        require_word("stated_for", self.stated_for, Stated)
        require_word("side", self.side, Side)
        angle = abs(self.end - self.start)
        if self.stated_for == "slider" and not angle:
            raise InputError(
                f"a swing needs two different slider positions; got {1e3 * self.start:.6g} mm twice; change one"
            )
        if self.of_full_turn:
            if (self.start, self.end, self.law) != (0.0, _TURN, "slow"):
                raise InputError("a turning crank makes one full turn, slowly; got another motion; use CRANK_TURN")
            return
        if self.stated_for == "crank" and not 0.0 < angle < _TURN:
            raise InputError(
                "a swing needs two different crank angles, less than a turn apart; "
                f"got {math.degrees(self.start):.6g} and {math.degrees(self.end):.6g} deg; "
                "a swing is less than one turn"
            )
        if (self.law == "slow") != (self.duration is None):
            raise InputError(
                f"a slow swing must have no duration, and any other swing must have one; got the law {self.law} "
                f"and {'no duration' if self.duration is None else f'{self.duration:g} s'}; give both a law and a "
                "duration, or neither"
            )
        if self.duration is not None and not _LEAST <= self.duration <= _MOST:
            raise InputError(
                f"one stroke of a swing must take from {_LEAST:g} to {_MOST:g} s; got {self.duration:g} s; check the "
                "unit"
            )
        if (self.law == "table") != bool(self.points):
            raise InputError(
                f"a tabulated motion law must have points, and any other must have none; got the law {self.law} "
                f"and {len(self.points)} points; give both, or neither"
            )
        _ = self.law_pieces
        if self.driver == "cylinder":
            self._require_lever_swing(angle)
        if self.actuator_tolerance and self.driver == "crank":
            raise InputError(
                f"an actuator tolerance needs a slider that drives; got {1e3 * self.actuator_tolerance:g} mm with "
                "the crank driven; let the slider drive, or leave the tolerance out; a cylinder that turns has "
                "length_tolerance in [cylinder]"
            )

    def _require_lever_swing(self, angle: float) -> None:
        """Raise `InputError` for a swing that no lever can make. angle: its size, rad."""
        excluded = {
            "slider positions": self.stated_for == "slider",
            "a table of its law": self.law == "table",
            "a tolerance of the actuator": self.actuator_tolerance > 0.0,
        }
        stated = [name for name, is_stated in excluded.items() if is_stated]
        if stated:
            raise InputError(
                f"the swing of a lever must have two lever angles and a named law; got {' and '.join(stated)}; give "
                "from and to, and the tolerance of the cylinder's length in [cylinder]"
            )
        if angle >= math.pi:
            raise InputError(
                "a cylinder must swing its lever less than 180 deg, from one dead point to the next; got "
                f"{math.degrees(self.start):.6g} to {math.degrees(self.end):.6g} deg; "
                f"{remedy_with_nearer_angles(self.start, self.end)}"
            )

    @property
    def of_lever(self) -> bool:
        """Whether it is a motion of a machine with `lever`."""
        return self.driver in ("cylinder", "turning crank")

    @property
    def of_full_turn(self) -> bool:
        """Whether a crank that rotates fully drives a lever's line."""
        return self.driver == "turning crank"

    @cached_property
    def law_pieces(self) -> Array:
        """Pieces (k, 7) of a tabulated law, see `law.law_spline_pieces`; empty for other laws."""
        return law_spline_pieces(self.points) if self.points else NO_TABLE

    @property
    def greatest_travel_rate(self) -> float:
        """Greatest ds/dt of a law with a name, half-way: all are symmetric and slow down towards their ends."""
        return float(travel_speed_acceleration(self.law, np.array([0.5]))[1][0])

    @property
    def forward_direction(self) -> float:
        """+1 if the crank turns counter-clockwise on the forward stroke, -1 otherwise."""
        return math.copysign(1.0, self.end - self.start)

    def equal_angles_within_swing(self, angle: float) -> list[float]:
        """Return the crank angles within the swing that equal an angle up to whole turns."""
        low, high = sorted((self.start, self.end))
        occurrence = angle + _TURN * math.ceil((low - angle) / _TURN)
        return [occurrence] if occurrence <= high else []


CRANK_TURN = Swing(start=0.0, end=_TURN, driver="turning crank")
"""The motion of a machine with `lever` whose crank rotates fully, at the speed of the machine."""


def slow_swing(swing: Swing) -> Swing:
    """Return a swing without inertia."""
    return replace(swing, law="slow", duration=None, points=())


def dead_point_angles(linkage: Linkage) -> tuple[float, ...]:
    """Return the crank angles of one linkage at which crank and rod are in line, rad.

    Stretched: (r + l) sin(theta) = e; folded: (r - l) sin(theta) = e; each on its own branch.
    """
    r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    angles = []
    for span, ahead in ((r + l, True), (r - l, False)):
        if abs(e) < abs(span):
            angle = math.asin(e / span)
            angles.append(angle if ahead == (linkage.branch == "open") else math.pi - angle)
    return tuple(angles)


def with_start_set_by_machine(mechanism: Mechanism, swing: Swing) -> Swing:
    """Return the swing from the start that a machine for one design sets, if any."""
    start = getattr(mechanism.start, "angle" if swing.stated_for == "crank" else "place")
    if start is None:
        return swing
    return replace(swing, start=start, end=start + (swing.end - swing.start) if swing.follows else swing.end)


def swing_between_crank_angles(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> Swing:
    """Return the swing of one linkage between two crank angles. Raises `AssemblyError` if it cannot reach an end."""
    swing = with_start_set_by_machine(mechanism, swing)
    if swing.stated_for == "crank":
        return swing
    r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    places, side = np.array([swing.start, swing.end]), 1.0 if swing.side == "left" else -1.0
    angles = crank_angles_at(places, linkage.sign, side, np.array([[r, l, e], [r, l, e]])).tolist()
    for place, angle in zip(places.tolist(), angles, strict=True):
        if math.isnan(angle):
            raise AssemblyError(_unreachable_end_text(place, linkage, swing))
    return replace(swing, start=angles[0], end=angles[1], stated_for="crank", follows=False)


def _unreachable_end_text(place: float, linkage: Linkage, swing: Swing) -> str:
    r, l, e = (1e3 * float(size) for size in (linkage.crank, linkage.rod, linkage.offset))
    near, far = abs(l - r), l + r
    away = math.hypot(1e3 * place, e)
    if not near < away < far:
        return (
            f"the slider must reach both ends of the swing, between {near:.6g} and {far:.6g} mm from the crank pivot; "
            f"got a slider position of {1e3 * place:.6g} mm, {away:.6g} mm away; move it, or change a length"
        )
    other_branch = "crossed" if linkage.branch == "open" else "open"
    return (
        f"the slider must reach both ends of the swing on the {linkage.branch} branch, with the crank pin on the "
        f"{swing.side} of the line to the slider pin; got a slider position of {1e3 * place:.6g} mm, which is on "
        f"the {other_branch} branch there; move it, or choose the other side or branch"
    )


def require_swing(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> Linkage:
    """Return one linkage that can make the swing, with dimensions as floats.

    Raises `InputError` for arrays, another branch than the mechanism's, a dead point if the slider drives, and loads
    counted from a dead centre that the linkage does not have; `AssemblyError` where it does not close.
    """
    require_slider(mechanism)
    checked = require_single_linkage(mechanism, linkage)
    if swing.driver == "cylinder":
        raise InputError(
            "a cylinder drives a lever; got one as the driver of a slider-crank; drive the crank or the slider, or set "
            '[mechanism] inversion = "turning cylinder"'
        )
    _require_swing_without_dead_point(mechanism, checked, swing_between_crank_angles(mechanism, checked, swing))
    return checked


def _require_swing_without_dead_point(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> None:
    _require_closing(linkage, swing)
    passed = sorted(angle for dead in dead_point_angles(linkage) for angle in swing.equal_angles_within_swing(dead))
    if swing.driver == "slider" and passed:
        raise InputError(
            "a slider drives the crank only between dead points, where crank and rod are in line; "
            f"the swing from {_degrees_text(swing.start)} to {_degrees_text(swing.end)} has one at "
            f"{_degrees_text(passed[0])}; "
            "stay on one side of it, change the dimensions, or drive the crank"
        )
    if swing.driver == "slider" and _has_overlapping_links(linkage, swing):
        raise InputError(
            "a slider drives the crank only where crank and rod are not in line; got a rod as long as the crank, no "
            f"offset, and both folded at {_degrees_text(0.5 * (swing.start + swing.end))}, the slider on the crank "
            "pivot; "
            "swing on the other side, or change a length"
        )
    for load in mechanism.loads:
        datum = getattr(load, "datum", "")
        if datum.endswith("dead centre") and not bool(linkage.rotates_fully):
            raise InputError(
                f"a load must not be measured from the {datum}, as this linkage makes no full turn; measure it "
                "from the crank pivot"
            )


def _has_overlapping_links(linkage: Linkage, swing: Swing) -> bool:
    """Return whether the crank and the rod overlap over a whole swing that has no single dead point."""
    r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    return r == l and e == 0.0 and linkage.sign * math.cos(0.5 * (swing.start + swing.end)) < 0.0


def extreme_angles(swing: Swing) -> list[float]:
    """Return the ends of a swing, and its crank angles normal to the slider line."""
    return [
        swing.start,
        swing.end,
        *swing.equal_angles_within_swing(0.5 * math.pi),
        *swing.equal_angles_within_swing(1.5 * math.pi),
    ]


def _require_closing(linkage: Linkage, swing: Swing) -> None:
    r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    worst = max(extreme_angles(swing), key=lambda angle: abs(e - r * math.sin(angle)))
    pin_distance = abs(e - r * math.sin(worst))
    if pin_distance >= l:
        raise AssemblyError(
            "the linkage must close over the whole swing: rod > |offset - crank sin(crank angle)|; "
            f"got a rod of {1e3 * l:.6g} mm and {1e3 * pin_distance:.6g} mm at {_degrees_text(worst)}; "
            "lengthen the rod, change the offset, or reduce the swing"
        )


def _degrees_text(angle: float) -> str:
    return f"{math.degrees(angle):.6g} deg"
