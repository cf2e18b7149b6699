"""Pieces of the quantities that judge crank and rod as bars: joined, multiplied by closed forms, inverted."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..model.machine.links_and_joints import Bar
from ..model.machine.mechanism import Mechanism, Strength
from ..model.machine.memoise import memoise_by_batch
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import PINS, evaluate_formula_of_raw_numbers
from ..model.signals.peaks import STORED_PEAKS, find_peaks
from ..model.signals.signals import Signal
from ..model.strength.section_forces import CRANK, ROD
from ..model.strength.stress_cycle import CLASSES, LABEL_STEP, stress_peaks
from ..model.strength.stress_locations import Eye, StressLocation
from .quantity import Array, Formula, Group, Pieces, Quantity, Values, display_only_field, undefined_values


class Link(NamedTuple):
    """A link in a machine's raw numbers: its part, slots of length, width and depth, and its far pin."""

    part: int
    length: int
    width: int
    depth: int
    far: str
    end_condition: float
    """End condition C for buckling in the plane of motion."""


LINKS = {
    "rod": Link(ROD, Raw.ROD, Raw.ROD_WIDTH, Raw.ROD_WIDTH + 1, "slider_pin", 1.0),
    "crank": Link(CRANK, Raw.CRANK, Raw.CRANK_WIDTH, Raw.CRANK_WIDTH + 1, "crank_pivot", 0.25),
}
NEAR = "crank_pin"
"""The pin that the crank and the rod share."""
FORCE = {
    "crank_pivot": Signal.PIVOT_FORCE,
    "crank_pin": Signal.CRANK_PIN_FORCE,
    "slider_pin": Signal.SLIDER_PIN_FORCE,
}


Criteria = tuple[tuple[float, float], ...]
STATIC: Criteria = ((1.0, 0.0), (0.0, 1.0))
"""Maximum tension and maximum compression."""


class BarPieces(NamedTuple):
    """Smooth pieces for n designs: values (n, k), gradients (n, k, 3 + v) if requested, labels (n, k)."""

    values: Array
    gradients: Array | None
    labels: Array

    def multiplied_by(self, factor: tuple[Array, Array | None]) -> BarPieces:
        """Return the pieces multiplied by a positive closed form (n,) with its gradients."""
        values, slopes = factor
        return self._with_chained_slopes(values[:, None] * self.values, values[:, None], slopes, self.values)

    def closed_form_divided_by_pieces(self, factor: tuple[Array, Array | None]) -> BarPieces:
        """Return a closed form (n,) divided by the pieces, highest piece first.

        The result is +inf where a piece is absent or not positive.

        If the closed form is negative, only the highest piece counts.
        """
        values, slopes = factor
        counts = self.values > 0.0
        counts[:, 1:] &= values[:, None] > 0.0
        inverse = np.where(counts, 1.0 / np.where(counts, self.values, 1.0), 0.0)
        quotients = np.where(counts, values[:, None] * inverse, np.inf)
        part = self._with_chained_slopes(quotients, -values[:, None] * inverse**2, slopes, inverse)
        return part

    def _with_chained_slopes(self, values: Array, outer: Array, slopes: Array | None, inner: Array) -> BarPieces:
        """Return values with gradients, from `outer` derivatives for the pieces and `inner` ones for the factor."""
        if self.gradients is None or slopes is None:
            return BarPieces(values, None, self.labels)
        finite = np.isfinite(self.values) & np.isfinite(values)
        outer, inner = np.where(finite, outer, 0.0), np.where(finite, inner, 0.0)
        gradients = outer[:, :, None] * self.gradients + inner[:, :, None] * slopes[:, None, :]
        return BarPieces(values, gradients, self.labels)


@dataclass(frozen=True, kw_only=True)
class BarQuantity(Quantity):
    """A quantity that is the maximum or minimum over several parts of the crank and the rod."""

    group: Group = display_only_field(Group.STRENGTH)
    section: str = display_only_field("22. Strength of crank and rod")
    links: tuple[str, ...] = ("rod", "crank")
    least: bool = False

    def allowable_value(self, mechanism: Mechanism) -> float:
        """Return 1, the limit below which a safety factor fails; other quantities override this; see `Quantity`."""
        return 1.0

    @abstractmethod
    def pieces_by_part(
        self, mechanism: Mechanism, designs: Array, piece_count: int, gradients: bool
    ) -> Sequence[BarPieces]:
        """Return the parts that count for designs (n, 3 + k). piece_count: number of pieces per part."""

    def links_with_bars(self, mechanism: Mechanism) -> list[str]:
        """Return those of its links that have a bar section."""
        return [name for name in self.links if isinstance(getattr(mechanism, name), Bar)]

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); NaN if no link is a bar; see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        all_parts = self.join_parts(mechanism, dimensions, 1, gradients)
        first = (np.argmin if self.least else np.argmax)(all_parts.values, axis=1)
        rows = np.arange(len(first))
        return Values(
            all_parts.values[rows, first], None if all_parts.gradients is None else all_parts.gradients[rows, first]
        )

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the local peaks of every part; see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return super().pieces(mechanism, dimensions)
        all_parts = self.join_parts(mechanism, dimensions, STORED_PEAKS, True)
        assert all_parts.gradients is not None
        order = np.argsort(all_parts.values if self.least else -all_parts.values, axis=1, kind="stable")
        return Pieces(all_parts.values, all_parts.gradients, all_parts.labels, self.least).select_pieces(order)

    def join_parts(self, mechanism: Mechanism, designs: Array, piece_count: int, gradients: bool) -> BarPieces:
        """Return all parts side by side, with labels that distinguish them; see `parts`."""
        parts = self.pieces_by_part(mechanism, designs, piece_count, gradients)
        return BarPieces(
            np.concatenate([part.values for part in parts], axis=1),
            np.concatenate([part.gradients for part in parts if part.gradients is not None], axis=1)
            if gradients
            else None,
            np.concatenate([part.labels + CLASSES * LABEL_STEP * n for n, part in enumerate(parts)], axis=1),
        )


class SectionLoad(NamedTuple):
    """Maximum stress at a location or maximum force on a pin, and the section that carries it.

    section: formula for an area or a width, None for 1. scale: see `BarPeak`. eye: link and pin of an eye.
    """

    peak: StressLocation | str
    section: Formula | None
    scale: float = 1.0
    eye: tuple[str, str] | None = None


@dataclass(frozen=True, kw_only=True)
class BarPeak(BarQuantity):
    """Maximum of scale peak / section or, if `least`, minimum of scale section / peak over all demands."""

    @abstractmethod
    def section_loads(self, mechanism: Mechanism) -> list[SectionLoad]:
        """Return the loads on the bars."""

    def criteria(self, mechanism: Mechanism) -> Criteria:
        """Return p and q for each criterion max(p sigma - q sigma): by default maximum tension and compression."""
        return STATIC

    def stress_locations(self, mechanism: Mechanism) -> tuple[StressLocation, ...]:
        """Return the stress locations that one search covers."""
        return tuple(demand.peak for demand in self.section_loads(mechanism) if not isinstance(demand.peak, str))

    def pieces_by_part(
        self, mechanism: Mechanism, designs: Array, piece_count: int, gradients: bool
    ) -> Sequence[BarPieces]:
        """Return a part for each demand; see `BarQuantity`."""
        locations = self.stress_locations(mechanism)
        found: dict[StressLocation | str, BarPieces] = {}
        if locations:
            searched = stress_pieces(mechanism, designs, locations, self.criteria(mechanism), piece_count, gradients)
            found.update(zip(locations, searched, strict=True))
        parts = []
        for peak, section, scale, _ in self.section_loads(mechanism):
            part = (
                pin_force_pieces(mechanism, designs, peak, piece_count, gradients)
                if isinstance(peak, str)
                else found[peak]
            )
            size = (
                (np.ones(len(designs)), np.zeros(designs.shape) if gradients else None)
                if section is None
                else evaluate_formula_of_raw_numbers(mechanism, designs, section, gradients=gradients)
            )
            parts.append(
                part.closed_form_divided_by_pieces(_scale_closed_form(size, scale))
                if self.least
                else pieces_of_force_over_area(part, size, scale)
            )
        return parts


def material_and_pins(mechanism: Mechanism) -> Strength:
    """Return the bars' material and the pins of a machine that has both."""
    assert mechanism.strength is not None
    return mechanism.strength


@memoise_by_batch
def stress_pieces(
    mechanism: Mechanism,
    designs: Array,
    places: tuple[StressLocation, ...],
    criteria: Criteria,
    piece_count: int,
    gradients: bool,
) -> list[BarPieces]:
    """Return the maximum of p sigma - q sigma at each location for each criterion; see `stress_peaks`."""
    peaks = stress_peaks(mechanism, places, designs, np.array(criteria), gradients=gradients, limit=piece_count)
    return [BarPieces(each.values, each.gradients, each.labels) for each in peaks]


@memoise_by_batch
def pin_force_pieces(mechanism: Mechanism, designs: Array, pin: str, piece_count: int, gradients: bool) -> BarPieces:
    """Return the maximum force on a pin over the cycle, N."""
    peaks = find_peaks(mechanism, FORCE[pin], designs, gradients=gradients, limit=piece_count)
    return BarPieces(peaks.values, peaks.gradients, np.nan_to_num(peaks.angles))


def critical_eye_edges(link: str, pin: str) -> list[Eye]:
    """Return the critical edges of a link's eye: the bore, and both edges if the torque bends it.

    The torque bends the eye at the crank pivot. Bending of an eye by the friction of its pin is neglected.
    """
    sizes = LINKS[link]
    bent = sizes.part == CRANK and pin == sizes.far
    edges = (False, True) if bent else (False,)
    return [Eye(sizes.part, pin != NEAR, sizes.width, PINS[pin], bent, outer) for outer in edges]


def net_width_formula(eye: Eye) -> Formula:
    """Return the formula for the net width of an eye, w - D, m."""
    return lambda number: number(eye.width) - number(eye.pin)


def net_section_formula(link: str, pin: str) -> Formula:
    """Return the formula for the net section of a link's eye, (w - D) t, m^2."""
    sizes = LINKS[link]
    return lambda number: (number(sizes.width) - number(PINS[pin])) * number(sizes.depth)


def _scale_closed_form(factor: tuple[Array, Array | None], scale: float) -> tuple[Array, Array | None]:
    values, slopes = factor
    return scale * values, None if slopes is None else scale * slopes


def pieces_of_force_over_area(force: BarPieces, area: tuple[Array, Array | None], factor: float = 1.0) -> BarPieces:
    """Return a scaled force divided by an area; infinite if the area is zero."""
    values, slopes = area
    has_area = values > 0.0
    safe = np.where(has_area, values, 1.0)
    inverse = factor / safe
    stress = force.multiplied_by((inverse, None if slopes is None else -(inverse / safe)[:, None] * slopes))
    filled = np.where(has_area[:, None] | ~np.isfinite(stress.values), stress.values, np.inf)
    gradients = None if stress.gradients is None else np.where(has_area[:, None, None], stress.gradients, 0.0)
    return BarPieces(filled, gradients, stress.labels)
