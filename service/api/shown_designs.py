"""A design of a front, with its own lengths or with others given in the address of a request."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Query
from pydantic import Field

from ...model.errors import InputError
from ..designs.stored_designs import StoredDesign
from ..designs.variation import Variation, variation_of, with_lengths
from .stored_fronts import DesignNumber, FrontDep, StoredFront

LONGEST = 1e7  # mm
SHORTEST = 1e-4  # mm
_SAME = 1e-9  # of a length: an address has the design's own

Length = Annotated[float, Field(ge=SHORTEST, le=LONGEST, allow_inf_nan=False)]
Lengths = tuple[float, float, float]
"""Crank, rod, offset, mm."""

_OTHER = "mm, instead of that of the design; crank_mm, rod_mm and offset_mm come together"


def _lengths(
    crank_mm: Annotated[Length | None, Query(description=_OTHER, examples=[40.0])] = None,
    rod_mm: Annotated[Length | None, Query(description=_OTHER, examples=[64.0])] = None,
    offset_mm: Annotated[
        float | None, Query(ge=-LONGEST, le=LONGEST, allow_inf_nan=False, description=_OTHER, examples=[20.0])
    ] = None,
) -> Lengths | None:
    given = {"crank_mm": crank_mm, "rod_mm": rod_mm, "offset_mm": offset_mm}
    if crank_mm is not None and rod_mm is not None and offset_mm is not None:
        return crank_mm, rod_mm, offset_mm
    missing = [name for name, value in given.items() if value is None]
    if len(missing) == 3:
        return None
    raise InputError(
        f"other lengths come together, crank_mm, rod_mm and offset_mm; got none for {' and '.join(missing)}; "
        "give all three, or none for the design as it is"
    )


LengthsDep = Annotated[Lengths | None, Depends(_lengths)]
"""Lengths that an address gives a design, None for its own. Raises `InputError` for some of them."""


@dataclass(frozen=True)
class ShownDesign:
    """A design of a front, or what became of it. lengths: m, if they are others than its own."""

    found: StoredFront
    number: int
    design: StoredDesign
    lengths: Lengths | None

    @property
    def words(self) -> str:
        """The design in titles."""
        return f"design {self.number}" + (", changed" if self.lengths else "")

    @property
    def stem(self) -> str:
        """The design in the names of files."""
        return f"design-{self.number}" + ("-changed" if self.lengths else "")

    @property
    def key(self) -> str:
        """The design among what is kept with the front."""
        return f"design_{self.number}" + (f" {self.lengths}" if self.lengths else "")

    def variation(self) -> Variation | None:
        """Return all about other lengths; None for the design as it is."""
        return variation_of(self.design, self.found.result, self.found.minimised) if self.lengths else None


def shown_design(found: StoredFront, number: int, lengths: Lengths | None) -> ShownDesign:
    """Return a design of a front with lengths, mm. Raises `NotFound`; `InputError` if it does not turn fully."""
    stored = found.design(number)
    if lengths is None:
        return ShownDesign(found, number, stored, None)
    own = (float(found.row(number)[key] or 0.0) for key in ("crank_mm", "rod_mm", "offset_mm"))
    if all(abs(one - other) <= _SAME * abs(other) for one, other in zip(lengths, own, strict=True)):
        return ShownDesign(found, number, stored, None)
    crank, rod, offset = (length / 1e3 for length in lengths)
    return ShownDesign(found, number, with_lengths(stored, (crank, rod, offset)), (crank, rod, offset))


def _shown(found: FrontDep, design: DesignNumber, lengths: LengthsDep) -> ShownDesign:
    return shown_design(found, design, lengths)


ShownDep = Annotated[ShownDesign, Depends(_shown)]
"""The design in the path, with the lengths in the query."""
