"""Coulomb friction in a machine: joints with friction, and their coefficients.

In the guide the friction force is the coefficient times the magnitude of the guide force, against the slider's
velocity. In a pin the friction moment is coefficient times radius times the magnitude of the pin force, against the
relative rotation of the parts. The line of action of the pin force passes the pin's centre at a distance equal
to coefficient times radius, the radius of the pin's *friction circle*.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..checks import require_numbers
from ..errors import InputError


@dataclass(frozen=True, kw_only=True)
class Pin:
    """A pin in its bearing. radius: m. coefficient: friction moment divided by radius times force."""

    radius: float = 0.0
    coefficient: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "radius", "coefficient", phrase="the {} of a pin", least=0.0)

    @property
    def friction_circle_radius(self) -> float:
        """Radius of the friction circle, m: coefficient times radius."""
        return self.coefficient * self.radius


@dataclass(frozen=True, kw_only=True)
class Friction:
    """Friction in a machine; none unless given.

    guide: coefficient of friction of the slider in its guide. crank_pivot: pin between frame and crank. crank_pin: pin
    between crank and rod. slider_pin: pin between rod and slider.

    The guide carries a single normal force N at the slider pin and rubs with mu |N|; the guide absorbs the moment of
    the slider pin's friction without additional friction. If a joint does not move (the slider at a dead centre,
    everything at zero crank speed), friction acts against the motion that follows in the crank's sense of rotation. A
    crank at zero speed is assumed to turn counter-clockwise, as for loads that change with the stroke.
    """

    guide: float = 0.0
    crank_pivot: Pin = Pin()
    crank_pin: Pin = Pin()
    slider_pin: Pin = Pin()

    def __post_init__(self) -> None:
        require_numbers(self, "guide", phrase="the {}'s coefficient of friction", least=0.0)

    @property
    def acts(self) -> bool:
        """Whether any joint has friction."""
        return self.guide > 0.0 or any(
            pin.friction_circle_radius > 0.0 for pin in (self.crank_pivot, self.crank_pin, self.slider_pin)
        )


def require_frictionless(friction: Friction, subject: str) -> None:
    """Raise an error for friction if an analysis ignores it. subject: the analysis, as the subject of a sentence."""
    if friction.acts:
        raise InputError(
            f"{subject} only takes joints and guide without friction; got friction that has an effect; leave "
            "[friction] out"
        )
