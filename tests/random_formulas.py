"""Random formulas of the right dimensions, each as a job writes it and as a Python expression of SI numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np

from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.formula.formulas import Formulas
from slidercrank.optimise.problem.requirements import Range

MACHINE = Mechanism(
    speed=10.0,
    crank=RigidLink(mass=0.2),
    rod=RigidLink(mass=0.5),
    slider_mass=0.8,
    gravity=(0.0, -9.81),
    loads=(StrokeForce(outward=-200.0, inward=50.0),),
    varying=(Varying(name="mechanism.slider.mass", sets=(("slider_mass", 1.0),), lower=0.5, upper=2.0),),
)
RANGES = {
    "crank": Range(lower=0.02, upper=0.06),
    "rod": Range(lower=0.15, upper=0.3),
    "offset": Range(lower=-0.05, upper=0.08),
}
NAMES = {
    "length": ("crank", "rod", "offset", "stroke"),
    "angle": ("transmission_angle",),
    "mass": ("mechanism.slider.mass",),
    "torque": ("peak_torque", "peak_torque_outward", "rms_torque", "mean_torque"),
    "ratio": ("time_ratio", "rod_to_crank"),
    "area": ("footprint",),
}
POSITIVE = {
    "length": ("crank", "rod", "stroke"),
    "angle": ("transmission_angle",),
    "mass": ("mechanism.slider.mass",),
    "torque": ("peak_torque", "rms_torque"),
    "ratio": ("time_ratio", "rod_to_crank"),
    "area": ("footprint",),
}
UNITS = {
    "length": {"mm": Fraction(1, 1000), "cm": Fraction(1, 100), "m": Fraction(1), "inch": Fraction(254, 10000)},
    "angle": {"rad": Fraction(1)},
    "mass": {"kg": Fraction(1), "g": Fraction(1, 1000)},
    "torque": {"N m": Fraction(1), "Nmm": Fraction(1, 1000), "kN cm": Fraction(10)},
    "ratio": {"": Fraction(1)},
    "area": {"mm^2": Fraction(1, 10**6), "m²": Fraction(1), "cm^2": Fraction(1, 10**4)},
}
Texts = tuple[str, str]


def formulas() -> Formulas:
    """Return the formulas of the machine and its ranges, none yet."""
    return Formulas((), MACHINE, RANGES, {})


def designs(count: int, seed: int) -> np.ndarray:
    """Return designs (n, 4) within the ranges, all of which turn fully."""
    random = np.random.default_rng(seed)
    ends = [*((of.lower, of.upper) for of in RANGES.values()), (0.5, 2.0)]
    return np.stack([random.uniform(*pair, count) for pair in ends], axis=1)


@dataclass
class Writer:
    """Writes random formulas. names: that any was written with."""

    random: np.random.Generator
    names: set[str] = field(default_factory=set)

    def one_of(self, items: object) -> str:
        """Return one of some texts."""
        return str(self.random.choice(list(items)))  # type: ignore[call-overload]

    def any_of(self, kind: str, depth: int) -> Texts:
        """Return a formula of a kind with functions within each other, as a job writes it and as Python does."""
        ways: list[Callable[[str, int], Texts]] = [self.name, self.number]
        if depth:
            ways = [self.sum, self.sum, self.scaled, self.extreme, self.sign, self.name]
            ways += {"ratio": [self.quotient, self.power, self.wave], "angle": [self.inverse]}.get(kind, [])
            ways += {"area": [self.product], "length": [self.root]}.get(kind, [])
        return ways[int(self.random.integers(len(ways)))](kind, depth)

    def name(self, kind: str, _: int) -> Texts:
        """Return a name."""
        return self._named(self.one_of(NAMES[kind]))

    def positive(self, kind: str) -> Texts:
        """Return a name of what is never zero, or more of it."""
        text, source = self._named(self.one_of(POSITIVE[kind]))
        if self.random.random() < 0.5:
            return text, source
        other, same = self.any_of(kind, 1)
        return f"({text} + abs({other}))", f"({source} + fabs({same}))"

    def _named(self, name: str) -> Texts:
        self.names.add(name)
        return name, name.replace(".", "_")

    def number(self, kind: str, _: int) -> Texts:
        """Return a number with one of its units."""
        unit = self.one_of(UNITS[kind])
        digits = self.one_of(["1", "2.5", ".75", "3e-1", "12", "0.125"])
        si = float(Fraction(digits) * UNITS[kind][unit])
        return f"{digits} {unit}".rstrip(), repr(si)

    def sum(self, kind: str, depth: int) -> Texts:
        """Return a sum or a difference."""
        (one, own), (other, same), sign = self.any_of(kind, depth - 1), self.any_of(kind, depth - 1), self.one_of("+-")
        space = self.one_of(["", " "])
        return f"({one}{space}{sign}{space}({other}))", f"({own} {sign} ({same}))"

    def scaled(self, kind: str, depth: int) -> Texts:
        """Return a ratio times a value, or a value over a ratio."""
        one, own = self.any_of(kind, depth - 1)
        if self.random.random() < 0.5:
            other, same = self.any_of("ratio", depth - 1)
            return f"({other}) * ({one})", f"(({same}) * ({own}))"
        other, same = self.positive("ratio")
        return f"({one} / {other})", f"(({own}) / {same})"

    def extreme(self, kind: str, depth: int) -> Texts:
        """Return the least or the greatest of some."""
        parts = [self.any_of(kind, depth - 1) for _ in range(int(self.random.integers(2, 4)))]
        which = self.one_of(["min", "max"])
        return f"{which}({', '.join(text for text, _ in parts)})", f"{which}({', '.join(own for _, own in parts)})"

    def sign(self, kind: str, depth: int) -> Texts:
        """Return a size or the negative of a value."""
        one, own = self.any_of(kind, depth - 1)
        return (f"abs({one})", f"fabs({own})") if self.random.random() < 0.6 else (f"-({one})", f"(-({own}))")

    def quotient(self, _: str, depth: int) -> Texts:
        """Return a value over another one of its kind."""
        kind = self.one_of(NAMES)
        (one, own), (other, same) = self.any_of(kind, depth - 1), self.positive(kind)
        return f"(({one}) / {other})", f"(({own}) / {same})"

    def power(self, _: str, depth: int) -> Texts:
        """Return a power of a ratio, of whatever sign a plain number allows."""
        if self.random.random() < 0.5:
            one, own = self.any_of("ratio", depth - 1)
            sign = self.one_of(["**", "^"])
            return f"({one}){sign}2", f"(({own}) ** 2)"
        one, own = self.positive("ratio")
        return f"({one})**(-1.5)", f"(({own}) ** -1.5)"

    def wave(self, _: str, depth: int) -> Texts:
        """Return a function of an angle."""
        one, own = self.any_of("angle", depth - 1)
        which = self.one_of(["sin", "cos"])
        return f"{which}({one})", f"{which}({own})"

    def inverse(self, _: str, depth: int) -> Texts:
        """Return an angle of a ratio, of a size below one where that is asked."""
        one, own = self.any_of("ratio", depth - 1)
        which = self.one_of(["atan", "asin", "acos"])
        if which == "atan":
            return f"atan({one})", f"atan({own})"
        return f"{which}(sin(1 rad * ({one})))", f"{which}(sin(1.0 * ({own})))"

    def root(self, _: str, depth: int) -> Texts:
        """Return a length whose square is an area."""
        one, own = self.any_of("area", depth - 1)
        return f"sqrt(1 mm^2 + abs({one}))", f"sqrt(1e-06 + fabs({own}))"

    def product(self, _: str, depth: int) -> Texts:
        """Return an area."""
        (one, own), (other, same) = self.any_of("length", depth - 1), self.any_of("length", depth - 1)
        return f"({one}) * ({other})", f"(({own}) * ({same}))"


def random_formula(random: np.random.Generator, *, depth: int = 3) -> tuple[str, str, tuple[str, ...]]:
    """Return a formula that fits, its Python expression, and its names; shorter than formulas may be."""
    while True:
        writer = Writer(random)
        text, source = writer.any_of(writer.one_of(NAMES), depth)
        if len(text) <= 300:
            return text, source, tuple(sorted(writer.names))
