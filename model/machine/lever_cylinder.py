"""Size of a single-stage cylinder, and the lengths, pressures and buckling margin that a swing requires of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import require_numbers
from ..errors import InputError
from .loads.load import require_word
from .mounting import Mounting

STEEL = 210e9
"""Modulus of elasticity of steel, Pa."""
_ROUNDING = 1e-8
"""Fraction by which a design that uses a whole limit may exceed it."""


@dataclass(frozen=True, kw_only=True)
class Cylinder:
    """A single-stage hydraulic or pneumatic cylinder; None for unknown values.

    Each number is checked by itself; `require_sizes_to_agree` compares them. closed_length: least length between the
    pins A and B along the line, m. stroke: m. dead_length: closed length minus stroke, m. mounting: a clevis or an eye
    at the end of the barrel, or a trunnion along it, beyond which the barrel extends, so that the stroke may exceed the
    closed length; the cylinder pivots on either. bore, rod: diameters, m. supply_pressure: Pa above the pressure on the
    other side. seal_friction: N, against the motion. modulus: modulus of elasticity of the piston rod, Pa. barrel_mass,
    piston_rod_mass: kg, uniform bars as long as the closed cylinder, or as its least length in the swing.
    length_tolerance: of its length, m.
    """

    closed_length: float | None = None
    stroke: float | None = None
    bore: float | None = None
    rod: float | None = None
    supply_pressure: float | None = None
    seal_friction: float = 0.0
    modulus: float = STEEL
    barrel_mass: float = 0.0
    piston_rod_mass: float = 0.0
    length_tolerance: float = 0.0
    dead_length: float | None = None
    mounting: Mounting = "clevis"

    def __post_init__(self) -> None:
        require_word("mounting", self.mounting, Mounting)
        for name in (*tuple(self.__dataclass_fields__)[:4], "dead_length"):
            require_numbers(self, name, phrase=f"the {name.replace('_', ' ')} of a cylinder", above=0.0, unit="m")
        require_numbers(self, "supply_pressure", "modulus", phrase="the {} of a cylinder", above=0.0, unit="Pa")
        require_numbers(self, "seal_friction", phrase="the friction of a seal", least=0.0, unit="N")
        require_numbers(self, "barrel_mass", "piston_rod_mass", phrase="the {} of a cylinder", least=0.0, unit="kg")
        require_numbers(self, "length_tolerance", phrase="the {} of a cylinder", least=0.0, unit="m")

    def require_sizes_to_agree(self, least: Cylinder) -> None:
        """Raise `InputError` unless some sizes between the smallest cylinder's and these belong to one cylinder."""
        self._require_lengths_to_agree(least)
        if self.bore is not None and least.rod is not None and least.rod >= self.bore:
            raise InputError(
                f"the bore must exceed the piston rod; got a bore of {1e3 * self.bore:.6g} mm and a piston rod of "
                f"{1e3 * least.rod:.6g} mm; enlarge the bore"
            )
        if self.supply_pressure is not None and self.bore is None:
            raise InputError(
                f"a supply pressure needs a cylinder bore; got {1e-5 * self.supply_pressure:.6g} bar and no bore; "
                "give the bore"
            )

    def _require_lengths_to_agree(self, least: Cylinder) -> None:
        """Raise `InputError` for lengths that do not belong to one cylinder, or of which one is missing."""
        if self.dead_length is not None and self.mounting == "trunnion":
            raise InputError(
                "a dead length belongs to a cylinder on a clevis, as a barrel extends beyond its trunnion; got "
                f"{1e3 * self.dead_length:.6g} mm with a trunnion; give closed_length and stroke"
            )
        if self.closed_length is not None and self.dead_length is not None:
            raise InputError(
                "the closed length is stroke plus dead length; got both a closed length and a dead length; leave out "
                "one of the two"
            )
        if (self.closed_length is None) != (self.stroke is None) and self.dead_length is None:
            given = "no stroke" if self.stroke is None else "no closed length"
            raise InputError(
                f"a cylinder needs both a closed length and a stroke, or neither; got {given}; give both, or neither"
            )
        if least.stroke is None or self.closed_length is None or self.mounting == "trunnion":
            return
        if least.stroke >= self.closed_length:
            raise InputError(
                "the stroke of a single-stage cylinder must be less than its closed length; got a stroke of "
                f"{1e3 * least.stroke:.6g} mm and a closed length of {1e3 * self.closed_length:.6g} mm; shorten the "
                'stroke, or for a barrel that extends beyond its pivot set mounting = "trunnion"'
            )

    def closed_length_and_stroke(self, travel: float) -> tuple[float, float] | None:
        """Return closed length and stroke, m; with a dead length alone, those of a cylinder for a travel, m.

        None if neither is known.
        """
        stroke = travel if self.stroke is None else self.stroke
        if self.dead_length is not None:
            return stroke + self.dead_length, stroke
        return None if self.closed_length is None else (self.closed_length, stroke)

    @property
    def text(self) -> str:
        """Known data of the cylinder, as text."""
        lengths = (*tuple(self.__dataclass_fields__)[:4], "dead_length", "length_tolerance")
        given = [(name, 1e3, "mm") for name in lengths] + [("supply_pressure", 1e-5, "bar")]
        given += [("seal_friction", 1.0, "N"), ("barrel_mass", 1.0, "kg"), ("piston_rod_mass", 1.0, "kg")]
        numbers = ((name, getattr(self, name), factor, unit) for name, factor, unit in given)
        texts = [
            f"{name.replace('_', ' ')} {factor * number:.6g} {unit}" for name, number, factor, unit in numbers if number
        ]
        return ", ".join([*texts, *(["on a trunnion"] if self.mounting == "trunnion" else [])])

    @property
    def areas(self) -> tuple[float, float] | None:
        """Full area, which pushes, and annular area, which pulls, m^2; None without a bore, both full without a rod."""
        return None if self.bore is None else piston_areas(self.bore, self.rod or 0.0)

    def require_lengths(self, shortest: float, longest: float, remedy: str) -> None:
        """Raise `InputError` unless the cylinder has all lengths between two, m. remedy: last part of the sentence."""
        known = self.closed_length_and_stroke(longest - shortest)
        if known is None:
            return
        closed_length, open_length = known[0], sum(known)
        rounding = _ROUNDING * closed_length
        if shortest < closed_length - rounding:
            raise InputError(
                "the swing must not need a cylinder shorter than its closed length; got a closed length of "
                f"{1e3 * closed_length:.6g} mm, and the swing needs {1e3 * shortest:.6g} mm, "
                f"{1e3 * (closed_length - shortest):.6g} mm less; {remedy}"
            )
        if self.stroke is not None and longest > open_length + rounding:
            raise InputError(
                "the swing must not need a cylinder longer than closed length plus stroke; got "
                f"{1e3 * open_length:.6g} mm, and the swing needs {1e3 * longest:.6g} mm, "
                f"{1e3 * (longest - open_length):.6g} mm more; {remedy}"
            )

    def pressures(self, push: float, pull: float) -> tuple[float, float] | None:
        """Return the pressures, Pa, that push and pull, N, need on the full and on the annular area."""
        return None if self.areas is None else (push / self.areas[0], pull / self.areas[1])

    def require_pressure(self, push: float, pull: float) -> None:
        """Raise `InputError` if the supply pressure cannot push or pull with these forces, N."""
        needed = self.pressures(push, pull)
        if needed is None or self.supply_pressure is None:
            return
        for way, pressure, force in zip(("push", "pull"), needed, (push, pull), strict=True):
            if pressure > self.supply_pressure * (1.0 + _ROUNDING):
                raise InputError(
                    f"the supply pressure must hold the lever: a {way} of {force:.6g} N needs "
                    f"{_rounded_up(1e-5 * pressure):.5g} bar; got {1e-5 * self.supply_pressure:.6g} bar; raise it, "
                    "enlarge the bore, or move a pivot"
                )

    def require_no_buckling(self, margin: float, length: float) -> None:
        """Raise `InputError` for a margin against buckling below 1, which occurs at a length, m."""
        if self.rod is None or margin >= 1.0 - _ROUNDING:
            return
        needed = _rounded_up(1e3 * self.rod * margin**-0.25)
        raise InputError(
            f"the piston rod must not buckle: {1e3 * length:.6g} mm long between its pins, it carries {margin:.4g} "
            f"times the push of the cylinder; got a piston rod of {1e3 * self.rod:.6g} mm; use at least "
            f"{needed:.5g} mm, or move a pivot"
        )

    def buckling_margin(self, length: Array, push: Array) -> Array | None:
        """Return Euler's load over the push at lengths between the pins, m; inf where nothing pushes.

        pi^2 E I / L^2, I = pi d^4 / 64 of the piston rod, for both mountings: both ends pinned, and the whole length
        between pivot and pin as slender as the piston rod, so that a stiffer barrel is on the safe side. None without
        the piston rod. Source: S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, chapter 2, fundamental
        case of buckling of a prismatic bar.
        """
        if self.rod is None:
            return None
        load = euler_load_times_squared_length(self.rod, self.modulus) / length**2
        margin: Array = np.divide(load, push, out=np.full(np.shape(push), np.inf), where=push > 0.0)
        return margin


def piston_areas(bore: Any, rod: Any) -> tuple[Any, Any]:
    """Return full area, which pushes, and annular area, which pulls, m^2."""
    return 0.25 * math.pi * bore * bore, 0.25 * math.pi * (bore * bore - rod * rod)


def euler_load_times_squared_length(rod: Any, modulus: float) -> Any:
    """Return Euler's load times length^2, N m^2; see `Cylinder.buckling_margin`."""
    return math.pi**2 * modulus * (math.pi * rod**4 / 64.0)


def _rounded_up(amount: float) -> float:
    """Return a positive need rounded up to five digits, so that it suffices as reported."""
    step = 10.0 ** (math.floor(math.log10(amount)) - 4)
    return math.ceil(amount / step) * step
