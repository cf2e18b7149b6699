"""Slider near a dead centre: its speed when it meets the workpiece, and the crank angle of its dwell."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from ..model.kernel.arithmetic import arcsine, magnitude, root
from ..model.kinematics.geometry import inner_dead_centre, outer_dead_centre
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from .closed_form import GreatestOfFormulas
from .kinds import ANGLE, SPEED
from .lengths_and_time_ratio import STROKE
from .machine_needs import EVEN_SPEED, Need
from .machine_needs import SPEED as TURNS
from .quantity import Array, Formula, Group, Number


@dataclass(frozen=True, kw_only=True)
class NearDeadCentre(GreatestOfFormulas):
    """A closed form evaluated at a distance from a dead centre; NaN unless the stroke exceeds the distance.

    closed_form: its function.
    """

    closed_form: Callable[[Mechanism, Number], Any] = field(repr=False)

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return the formula if the machine defines the quantity; see `Quantity`."""
        return () if self.unmet_need(mechanism, "undefined") else (partial(self.closed_form, mechanism),)

    @property
    def no_value_reason(self) -> str:
        """Reason why a design has no value."""
        return "its stroke is not longer than the distance from the dead centre"


def _squared_distances_near_dead_centre(number: Number, distance: float, outer: bool) -> tuple[Any, ...]:
    """Return x, B^2, (l + r)^2 - B^2 and B^2 - (l - r)^2 near a dead centre.

    B: distance between the slider pin and the crank pivot. The results are products, so nothing cancels near the dead
    centre.
    """
    lengths = number(Raw.CRANK), number(Raw.ROD), number(Raw.OFFSET)
    far, near = outer_dead_centre(*lengths), inner_dead_centre(*lengths)
    if outer:
        x, outer_product = far - distance, distance * (2.0 * far - distance)
        inner_product = (x - near) * (x + near)
    else:
        x, inner_product = near + distance, distance * (2.0 * near + distance)
        outer_product = (far - x) * (far + x)
    return x, x * x + lengths[2] * lengths[2], outer_product, inner_product


def _travel_per_crank_angle(machine: Mechanism, number: Number, distance: Any) -> Any:
    """Return |x'|, m, before the dead centre: the area of the parallelogram of crank and rod divided by l cos(phi)."""
    r, l, e = number(Raw.CRANK), number(Raw.ROD), number(Raw.OFFSET)
    outer = machine.slider.dead_centre == "outer"
    x, square, outer_product, inner_product = _squared_distances_near_dead_centre(number, distance, outer)
    area = 0.5 * root(outer_product * inner_product)
    side = machine.sign * machine.direction * (1.0 if outer else -1.0)  # for the crank pin
    lever = (0.5 * x * (square + (l + r) * (l - r)) - side * area * e) / square
    return area / lever


def _crank_angle_from_pin_line(machine: Mechanism, number: Number, distance: Any) -> Any:
    """Return the angle between the crank and the line from crank pivot to slider pin, rad, by the half-angle."""
    r, l = number(Raw.CRANK), number(Raw.ROD)
    outer = machine.slider.dead_centre == "outer"
    _, square, outer_product, inner_product = _squared_distances_near_dead_centre(number, distance, outer)
    b = root(square)
    share = outer_product / (l + r + b) * (l + b - r) if outer else inner_product / (b + l - r) * (b + l + r)
    return 2.0 * arcsine(root(share / (4.0 * r * b)))


def angle_and_travel_rate_before_dead_centre(
    machine: Mechanism, design: Array, distances: Array
) -> tuple[Array, Array]:
    """Return the crank angle before a dead centre, rad, and |x'|, m, at distances from it, m.

    design: crank, rod, offset, m; its stroke exceeds the distances. Small distances lose no accuracy.
    """
    lengths = dict(zip((int(Raw.CRANK), int(Raw.ROD), int(Raw.OFFSET)), design, strict=True))
    number: Number = lengths.__getitem__
    outer, e = machine.slider.dead_centre == "outer", design[2]
    dead = (outer_dead_centre if outer else inner_dead_centre)(*design)
    way = 1.0 if outer else -1.0
    turned = way * np.arctan2(
        e * distances, (dead - way * distances) * dead + e * e
    )  # angle of the line, measured from there
    angles = _crank_angle_from_pin_line(machine, number, distances) - machine.sign * machine.direction * turned
    return angles, _travel_per_crank_angle(machine, number, distances)


def _touch_speed(machine: Mechanism, number: Number) -> Any:
    return _travel_per_crank_angle(machine, number, machine.slider.touch or 0.0) * magnitude(number(Raw.SPEED))


def _dwell_angle(machine: Mechanism, number: Number) -> Any:
    return 2.0 * _crank_angle_from_pin_line(machine, number, machine.slider.dwell or 0.0)


def _need_of_slider_distance(name: str) -> Need:
    return Need(
        lambda machine: getattr(machine.slider, name) is not None,
        f"it needs a {name} distance of the slider; got none; for example, add "
        f'[mechanism] slider = {{ mass = "0.8 kg", {name}_distance = "5 mm" }}',
        consequence="undefined",
    )


TOUCH_SPEED = NearDeadCentre(
    name="touch_speed",
    kind=SPEED,
    closed_form=_touch_speed,
    place=235,
    group=Group.MOTION,
    sentence="The slider speed on contact with the workpiece, a given distance before a dead centre.",
    advice="A press should touch its workpiece gently: 0.1 to 0.5 m/s are usual. The length of the rod and the "
    "offset affect it.",
    formula="|x'| |omega| at x_out - d, or at x_in + d, in the stroke towards the dead centre",
    section="2. Closed forms",
    picture="speed",
    example="0.3 m/s",
    needs=(TURNS, _need_of_slider_distance("touch"), EVEN_SPEED),
)
DWELL_ANGLE = NearDeadCentre(
    name="dwell_angle",
    kind=ANGLE,
    closed_form=_dwell_angle,
    place=236,
    group=Group.MOTION,
    sentence="The crank angle over which the slider stays within a given distance of a dead centre.",
    advice="At constant speed the dwell takes this fraction of the time of a turn.",
    formula=(
        "2 alpha with cos(alpha) = (r^2 + B^2 - l^2) / (2 r B), B^2 = x^2 + e^2 at x = x_out - d; 360 deg less that at "
        "x = x_in + d"
    ),
    section="2. Closed forms",
    picture=STROKE.picture,
    example="30 deg",
    better="high",
    needs=(_need_of_slider_distance("dwell"),),
)
