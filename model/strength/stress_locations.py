"""Locations searched together for stress over the cycle: all along crank and rod, and the net sections of eyes.

Let N and M be axial force and moment in the section through a pin's centre, w and d width and depth, D the pin
diameter, and K the stress concentration factor of the eye. The stress in its net section at the bore and at the outer
edge is

    K N / ((w - D) d) +- min(K, 2) 6 M D / (d (w^3 - D^3))      and      N / ((w - D) d) +- 6 M w / (d (w^3 - D^3)):

from the area and second moment that remain without the hole. A hole in a bent bar at most doubles this stress at the
bore (W. D. Pilkey, "Peterson's Stress Concentration Factors", 3rd ed., sec. 4.6). The factor 1 / (w - D), common to
both, is left out here, so that a pin as wide as its bar needs no special case: stress times w - D, N/m.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array, IntArray, Mask
from ..kernel.kernel import Integers, IntegerTable, Table, rarely_used_kernel
from ..machine.mechanism import Mechanism
from ..machine.raw_numbers_of_designs import evaluate_formula_of_raw_numbers
from .section_forces import CRANK
from .stress_points import WIDE, Samples, StressField

_MANY = WIDE // 2


class LinkBody(NamedTuple):
    """A whole link. part: `ROD` or `CRANK`. bent: whether moments count."""

    part: int
    bent: bool = True


class Eye(NamedTuple):
    """An edge of the net section in an eye.

    part: `ROD` or `CRANK`. far: whether it is at the end opposite the crank pin. width, pin: slots of the raw numbers.
    bent: whether moments count. outer: whether it is the outer edge, else the bore.
    """

    part: int
    far: bool
    width: int
    pin: int
    bent: bool
    outer: bool


StressLocation = LinkBody | Eye
Formula = Callable[[Callable[[int], Any]], Any]
"""A number as a function of the raw numbers of a machine."""


@dataclass(frozen=True)
class StressLocations:
    """Stress over the cycle at m locations of n designs, given as m n bars, first location first.

    An eye is treated as a bar whose stress falls linearly from the eye's value to zero at the other end, so the maximum
    along it is the eye's value. Without bending, half of the axial stress counts as bending: all of it is on one side,
    none on the other. fields: one for each turn of the cycle. Segments are numbered over the whole cycle, crank angles
    within the turn of their segment. samples: their stress (m s, WIDE). factors: (m n, 2), of axial stress and bending;
    rates: (m n, 3 + k, 2), their derivatives with respect to the numbers of the design.
    """

    fields: tuple[StressField, ...]
    places: tuple[StressLocation, ...]
    samples: Samples
    factors: Array
    rates: Array

    @property
    def bar_count(self) -> int:
        """Return the number of bars, m n."""
        return len(self.factors)

    @property
    def locked_bars(self) -> Mask:
        """Return whether friction locks the design of each bar, (m n,)."""
        return np.tile(self.fields[0].locked_designs, len(self.places))

    def turns_of_segments(self, segment: IntArray) -> IntArray:
        """Return the turns of the cycle, from 0, that contain segments."""
        turns: IntArray = segment // _segments_per_turn(self.fields)
        return turns

    def next_segments(self, bars: IntArray, segment: IntArray) -> IntArray:
        """Return the segments that follow segments (p,) of bars (p,) within their turn."""
        following = np.empty_like(segment)
        for field, rows, design, local in self._by_turn(bars, segment):
            following[rows] = segment[rows] + np.where(local + 1 == field.cuts.many[design], -local, 1)
        return following

    def segment_end_angles(self, bars: IntArray, segment: IntArray) -> tuple[Array, Array]:
        """Return where segments (p,) of bars (p,) begin and end, rad."""
        ends = np.empty((2, len(bars)))
        for field, rows, design, local in self._by_turn(bars, segment):
            ends[:, rows] = field.segment_end_angles(design, local)
        return ends[0], ends[1]

    def stress_at(self, bars: IntArray, segment: IntArray, angle: Array) -> Array:
        """Return stress and its derivatives with respect to the crank angle, (p, WIDE)."""
        stress = np.empty((len(bars), 2 * WIDE))
        for field, rows, design, local in self._by_turn(bars, segment):
            stress[rows] = field.stress_at(design, local, angle[rows])
        return _stress_at_locations(
            self.places, stress, np.arange(len(bars)), self._locations_of_bars(bars), self.factors[bars]
        )

    def design_slopes(self, bars: IntArray, segment: IntArray, angle: Array, cut: IntArray) -> Array:
        """Return the derivatives with respect to the numbers of the design, (p, 3 + k, WIDE / 2).

        cut: (p,), the segment whose beginning moves the angle, -1 if there is none.
        """
        p, k = len(bars), self.rates.shape[1]
        values, stress = np.empty((p, 2 * WIDE)), np.empty((p, k, 2 * WIDE))
        cut = np.where(cut < 0, cut, cut % _segments_per_turn(self.fields))
        for field, rows, design, local in self._by_turn(bars, segment):
            values[rows], stress[rows] = field.design_slopes(design, local, angle[rows], cut[rows])
        place, row = np.repeat(self._locations_of_bars(bars), k), np.repeat(np.arange(p), k)
        factors, rates = np.repeat(self.factors[bars], k, axis=0), self.rates[bars].reshape(p * k, 2)
        spread = _stress_at_locations(self.places, stress.reshape(p * k, -1), np.arange(p * k), place, factors)[
            :, _MANY:
        ]
        eyes = np.array([isinstance(location, Eye) for location in self.places])[place]
        spread[eyes] += _stress_at_locations(self.places, values, row[eyes], place[eyes], rates[eyes])[:, :_MANY]
        return spread.reshape(p, k, _MANY)

    def designs_of_bars(self, bars: IntArray) -> IntArray:
        """Return the designs that bars belong to."""
        return bars % (self.bar_count // len(self.places))

    def _locations_of_bars(self, bars: IntArray) -> IntArray:
        return bars // (self.bar_count // len(self.places))

    def _by_turn(self, bars: IntArray, segment: IntArray) -> Iterator[tuple[StressField, IntArray, IntArray, IntArray]]:
        """Yield for each turn its field, and the rows within it with their designs and the segments in the turn."""
        turn, local = np.divmod(segment, _segments_per_turn(self.fields))
        for number, field in enumerate(self.fields):
            rows = np.flatnonzero(turn == number)
            yield field, rows, self.designs_of_bars(bars[rows]), local[rows]


def _segments_per_turn(fields: Sequence[StressField]) -> int:
    return int(max(field.cuts.angle.shape[1] for field in fields))


def _samples_of_cycle(fields: Sequence[StressField]) -> Samples:
    """Return the samples of all turns, design by design, with segments numbered over the cycle."""
    parts = [field.samples for field in fields]
    if len(parts) == 1:
        return parts[0]
    design = np.concatenate([np.repeat(np.arange(len(part.start) - 1), np.diff(part.start)) for part in parts])
    order = np.argsort(design, kind="stable")
    segments = [part.segment + turn * _segments_per_turn(fields) for turn, part in enumerate(parts)]
    return Samples(
        np.sum([part.start for part in parts], axis=0),
        np.concatenate([part.theta for part in parts])[order],
        np.concatenate([part.begins_segment for part in parts])[order],
        np.concatenate(segments)[order],
        np.concatenate([part.stress for part in parts])[order],
    )


def _stress_at_locations(
    places: Sequence[StressLocation], stress: Array, row: IntArray, place: IntArray, factors: Array
) -> Array:
    """Return the stress at locations (p, WIDE) from rows (p,) of the stress in both links (r, 2 WIDE)."""
    codes = np.array(
        [
            (
                WIDE * (location.part == CRANK),
                isinstance(location, Eye),
                isinstance(location, Eye) and location.far,
                location.bent,
            )
            for location in places
        ],
        dtype=np.int64,
    )
    spread = np.empty((len(row), WIDE))
    _fill_location_stress(np.ascontiguousarray(stress), row, place, codes, np.ascontiguousarray(factors), spread)
    return spread


@rarely_used_kernel
def _fill_location_stress(
    stress: Table, row: Integers, place: Integers, codes: IntegerTable, factors: Table, out: Table
) -> None:
    """Fill stresses.

    codes: (m, 4), link's first column, whether it is an eye, whether far, whether bent. factors: (p, 2).
    """
    for i in range(row.shape[0]):
        base, eye = codes[place[i], 0], codes[place[i], 1] == 1
        far, bent = codes[place[i], 2] == 1, codes[place[i], 3] == 1
        for half in range(2):
            source, target = base + half * _MANY, half * _MANY
            for j in range(_MANY):
                out[i, target + j] = 0.0 if eye else stress[row[i], source + j]
            for part in range(2 if eye else 0):
                begin = 3 * part
                value = stress[row[i], source + begin]
                for column in range(begin + 1, begin + 3 + part if far else begin + 1):
                    value += stress[row[i], source + column]
                value *= factors[i, part]
                if not far:
                    out[i, target + begin] = value
                out[i, target + begin + 1] = value if far else -value
            if not bent:
                for j in range(3):
                    out[i, target + j] *= 0.5
                    out[i, target + 3 + j] = out[i, target + j]
                out[i, target + 6] = 0.0


def stress_at_locations(
    fields: Sequence[StressField], mechanism: Mechanism, designs: Array, places: Sequence[StressLocation]
) -> StressLocations:
    """Return the `StressLocations` for designs (n, 3 + k) whose links have a field for each turn of the cycle."""
    cycle_samples, n, many = _samples_of_cycle(fields), len(designs), len(places)
    factors, rates = np.ones((many * n, 2)), np.zeros((many * n, designs.shape[1], 2))
    for number, place in enumerate(places):
        if isinstance(place, Eye):
            mine = slice(n * number, n * number + n)
            factors[mine], rates[mine] = _eye_stress_factors(mechanism, designs, place)
    count = len(cycle_samples.theta)
    row, of_place = np.tile(np.arange(count), many), np.repeat(np.arange(many), count)
    of_bar = np.tile(np.repeat(np.arange(n), np.diff(cycle_samples.start)), many) + n * of_place
    samples = Samples(
        np.append((cycle_samples.start[:-1] + count * np.arange(many)[:, None]).ravel(), many * count),
        np.tile(cycle_samples.theta, many),
        np.tile(cycle_samples.begins_segment, many),
        np.tile(cycle_samples.segment, many),
        _stress_at_locations(places, cycle_samples.stress, row, of_place, factors[of_bar]),
    )
    return StressLocations(tuple(fields), tuple(places), samples, factors, rates)


def eye_stress_factor_formulas(mechanism: Mechanism, eye: Eye) -> tuple[Formula, Formula]:
    """Return the formulas for the factors of axial stress and bending in the whole section."""
    assert mechanism.strength is not None
    raised = mechanism.strength.eye_concentration

    def axial(number: Callable[[int], Any]) -> Any:
        return (1.0 if eye.outer else raised) * number(eye.width)

    def bending(number: Callable[[int], Any]) -> Any:
        w, hole = number(eye.width), number(eye.pin)
        return (w if eye.outer else min(raised, 2.0) * hole) * w**2 / (w**2 + w * hole + hole**2)

    return axial, bending


def _eye_stress_factors(mechanism: Mechanism, designs: Array, eye: Eye) -> tuple[Array, Array]:
    """Return the factors of axial stress and bending in the whole section, (n, 2), and their derivatives."""
    factors, rates = np.empty((len(designs), 2)), np.empty((*designs.shape, 2))
    for number, formula in enumerate(eye_stress_factor_formulas(mechanism, eye)):
        factors[:, number], rates[:, :, number] = evaluate_formula_of_raw_numbers(
            mechanism, designs, formula, gradients=True
        )
    return factors, rates
