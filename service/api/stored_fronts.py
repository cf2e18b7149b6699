"""Fronts of ended jobs and their designs, each with its stored numbers or with others from an address.

Fronts are cached in memory: they never change, and reading 10,000 designs takes a while.
"""

import math
import threading
from collections import OrderedDict
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Annotated

from fastapi import Depends, Path, Query
from pydantic import Field

from ...model.arrays import Array
from ...model.errors import InputError, NotFound
from ...optimise.decisions.wish import Wishes
from ...optimise.front.front import ParetoFront
from ...optimise.problem.problem import Problem
from ..designs.changed_design import Variation, design_with_numbers, judged_variation
from ..designs.columns import Column, all_columns
from ..designs.design_selection_options import minimised_values
from ..designs.stored_designs import StoredDesign, front_of_result, stored_design
from ..drawings.lever_parts import Extent, extent_of_front
from ..jobs.submission import LONGEST_WAIT, parse_with_allowed_functions, with_time_limit_per_call
from ..runs.result import Result, Row
from ..runs.run_folder import slug
from ..store import Job, Store
from ..store.bookmark import Bookmark
from ..store.bookmarks_and_wishes import bookmarks_of
from .settings import PLAIN_DIGITS, JobNumber, StoreDep, state_dependency

MOST_DESIGNS = 40_000
"""Maximum number of cached designs, over all fronts; 140 MB."""
_MOST_CACHED = 10_000_000  # bytes of cached figures, files and columns per front; one larger item is still cached

DesignNumber = Annotated[
    int, Path(ge=1, le=2**31, description="number of a design in its front, counted from 1", examples=[3]), PLAIN_DIGITS
]


class StoredFront:
    """Front of an ended job; derived data is computed when first needed."""

    def __init__(self, job: Job, result: Result, problem: Callable[[], Problem]) -> None:
        self.job = job
        self.result = result
        self._cached: OrderedDict[tuple[str, str], bytes] = OrderedDict()
        self._keeping = threading.Lock()
        self._read = problem

    @cached_property
    def problem(self) -> Problem:
        """Problem that the job stated, with the seed of its search. Raises `JobError`."""
        problem = self._read()
        return replace(problem, settings=replace(problem.settings, seed=self.result.seed))

    @cached_property
    def columns(self) -> list[Column]:
        """Columns of the designs; empty if there are no designs."""
        return all_columns(self.result.designs[0] if self.result.designs else ())

    @cached_property
    def front(self) -> ParetoFront:
        """Front data in the form that figures need."""
        return front_of_result(self.problem, self.result)

    @cached_property
    def extent_of_levers(self) -> Extent | None:
        """Left, bottom, right and top of all levers over their swings, mm; None for other mechanisms."""
        return extent_of_front(self.front)

    @cached_property
    def wish_starts(self) -> Wishes:
        """Starting points for wishes on the front. Raises `InputError` if no wish is possible."""
        return Wishes(self.front)

    @cached_property
    def minimised_objectives(self) -> Array:
        """Objectives of the designs (n, m), all minimised, in display units."""
        return minimised_values(self.result)

    def cached_item(self, name: str, kind: str, make: Callable[[], tuple[Sequence[str], bytes]]) -> bytes:
        """Return a cached item derived from the front, or create and cache it.

        make: function that returns all names of the item, and its content.
        """
        content = self._cached.get((name, kind))
        if content is None:
            names, content = make()
            with self._keeping:
                self._cached.update({(other_name, kind): content for other_name in names})
                while len(self._cached) > 1 and sum(map(len, self._cached.values())) > _MOST_CACHED:
                    self._cached.popitem(last=False)
        return content

    def row_of_design(self, number: int) -> Row:
        """Return a design by its number, counted from 1. Raises `NotFound`."""
        count = len(self.result.designs)
        if number > count:
            designs = f"designs 1 to {count}" if count else "no designs"
            raise NotFound(f"job {self.job.id} has {designs}; got {number}; see the designs of the job")
        return self.result.designs[number - 1]

    def design(self, number: int) -> StoredDesign:
        """Return a design as a machine, by its number."""
        self.row_of_design(number)
        return stored_design(self.problem, self.result, number)


class StoredFronts:
    """Cache of the most recently requested fronts, with a bounded number of designs. Threads may share it."""

    def __init__(self, store: Store, *, allowed: Collection[str] = (), most_designs: int = MOST_DESIGNS) -> None:
        """Read from a store. allowed: functions, "module:function", that its jobs may name as quantities."""
        self._store = store
        self._allowed = allowed
        self._most = most_designs
        self._cached: OrderedDict[tuple[int, float | None], StoredFront] = OrderedDict()
        self._reading = threading.Lock()

    def front_of_job(self, number: int) -> StoredFront:
        """Return the front of a job. Raises `NotFound` for a missing job, `RunError` if it has no result."""
        job = self._store.job(number)
        key = (job.id, job.finished)
        with self._reading:  # simultaneous requests for the same front wait for it instead of reading it again
            front = self._cached.get(key)
            if front is None:
                front = StoredFront(
                    job,
                    self._store.result(number),
                    lambda: with_time_limit_per_call(
                        parse_with_allowed_functions(self._store.job_tables(number), self._allowed), LONGEST_WAIT
                    ),
                )
                if job.finished is not None:
                    self._cache_front(key, front)
            else:
                self._cached.move_to_end(key)
        return front

    def _cache_front(self, key: tuple[int, float | None], front: StoredFront) -> None:
        self._cached[key] = front
        while (
            len(self._cached) > 1
            and sum(len(front_in_memory.result.designs) for front_in_memory in self._cached.values()) > self._most
        ):
            self._cached.popitem(last=False)


FrontsDep = Annotated[StoredFronts, state_dependency("fronts")]
"""Fronts of all jobs."""


def _stored_front_dependency(number: JobNumber, fronts: FrontsDep) -> StoredFront:
    return fronts.front_of_job(number)


FrontDep = Annotated[StoredFront, Depends(_stored_front_dependency)]
"""Front of the job in the path, with its designs."""


LONGEST = 1e7  # mm
SHORTEST = 1e-4  # mm
_SAME = 1e-9  # relative tolerance of a length: an address may repeat the length of the design

Length = Annotated[float, Field(ge=SHORTEST, le=LONGEST, allow_inf_nan=False)]
Allowed = Annotated[
    dict[Annotated[str, Field(max_length=500)], Annotated[float, Field(gt=0.0, allow_inf_nan=False)]],
    Field(max_length=200, examples=[{}]),
]
"""Allowed deviations from requirements, by column and in its unit."""
Numbers = Mapping[str, float]
"""Numbers of a design by column, each in the column's unit."""
_LENGTHS = ("crank_mm", "rod_mm", "offset_mm")

_OTHER = "mm, replaces the design's value; crank_mm, rod_mm and offset_mm must be given together"
_VALUE = "another number that varies, by column, such as slider_mass_kg=1.2; repeatable"
_ALLOW = "allowed deviation from a requirement, by column, such as stroke_mm=0.05; repeatable"


def _changed_numbers_dependency(
    crank_mm: Annotated[Length | None, Query(description=_OTHER, examples=[40.0])] = None,
    rod_mm: Annotated[Length | None, Query(description=_OTHER, examples=[64.0])] = None,
    offset_mm: Annotated[
        float | None, Query(ge=-LONGEST, le=LONGEST, allow_inf_nan=False, description=_OTHER, examples=[20.0])
    ] = None,
    value: Annotated[list[Annotated[str, Field(max_length=500)]], Query(max_length=200, description=_VALUE)] = [],  # noqa: B006
) -> Numbers | None:
    lengths = dict(zip(_LENGTHS, (crank_mm, rod_mm, offset_mm), strict=True))
    numbers = {name: length for name, length in lengths.items() if length is not None}
    missing = [name for name in lengths if name not in numbers]
    if len(missing) in (0, 3):
        return numbers | dict(map(_parse_column_value, value)) or None
    raise InputError(
        f"other lengths must be given together, crank_mm, rod_mm and offset_mm; got none for {' and '.join(missing)}; "
        "give all three, or none for the design as it is"
    )


def _parse_column_value(text: str) -> tuple[str, float]:
    """Return column and number from a text such as "slider_mass_kg=1.2"."""
    column, _, number = text.partition("=")
    try:
        value = float(number)
    except ValueError:
        value = math.nan
    if not (column and math.isfinite(value)):
        raise InputError(f"a value must be COLUMN=NUMBER; got {text!r}; write it like slider_mass_kg=1.2")
    return column, value


def _allowed_deviations(
    allow: Annotated[list[Annotated[str, Field(max_length=500)]], Query(max_length=200, description=_ALLOW)] = [],  # noqa: B006
) -> Numbers:
    return dict(map(_parse_column_value, allow))


AllowedDep = Annotated[Numbers, Depends(_allowed_deviations)]
"""Allowed deviations in an address, by column."""

NumbersDep = Annotated[Numbers | None, Depends(_changed_numbers_dependency)]
"""Numbers that an address sets for a design, None for those of the design itself. Raises `InputError` if it sets only
one or two lengths."""


@dataclass(frozen=True)
class RequestedDesign:
    """Design on a front, perhaps with other numbers. changed: whether its numbers differ from the stored ones.

    bookmarks: bookmarks of the job, which may name the design.
    """

    stored_front: StoredFront
    number: int
    design: StoredDesign
    changed: bool
    bookmarks: Sequence[Bookmark] = ()

    @property
    def bookmark(self) -> Bookmark | None:
        """Bookmark of the design, if it has one."""
        variant, values = self.design.variant, self.design.values
        return next((bookmark for bookmark in self.bookmarks if bookmark.is_of(variant, values)), None)

    @property
    def display_name(self) -> str:
        """Name of the design in titles: that of its bookmark, or its number."""
        if self.bookmark:
            return self.bookmark.name
        return f"design {self.number}" + (", changed" if self.changed else "")

    @property
    def file_stem(self) -> str:
        """Name of the design in file names."""
        return slug(self.display_name)

    @property
    def cache_key(self) -> str:
        """Key of the design in the cache of the front."""
        return f"design_{self.number}" + (f" {self.design.values} {self.design.allowed}" if self.changed else "")

    def cached_file(self, kind: str, make: Callable[[], bytes]) -> bytes:
        """Return a cached file of the design that shows its name, or create and cache it."""
        key = f"{self.cache_key} {self.display_name}"
        return self.stored_front.cached_item(key, kind, lambda: ((key,), make()))

    def variation(self) -> Variation | None:
        """Return the variation with other numbers; None for the unchanged design."""
        return (
            judged_variation(self.design, self.stored_front.result, self.stored_front.minimised_objectives)
            if self.changed
            else None
        )


def requested_design(
    stored_front: StoredFront,
    number: int,
    numbers: Numbers | None,
    bookmarks: Sequence[Bookmark] = (),
    allowed: Numbers = MappingProxyType({}),
) -> RequestedDesign:
    """Return a design on a front with other numbers.

    allowed: allowed deviations from requirements, by column; without any, those of its bookmark.

    Raises `NotFound`, and `InputError` if it does not rotate fully.
    """
    stored, row = stored_front.design(number), stored_front.row_of_design(number)
    cells = {column: row.get(column) for column in numbers or ()}
    stored_numbers = {column: cell if isinstance(cell, float) else math.nan for column, cell in cells.items()}
    if all(
        abs(value - stored_numbers[column]) <= _SAME * abs(stored_numbers[column])
        for column, value in (numbers or {}).items()
    ):
        return RequestedDesign(stored_front, number, stored, False, bookmarks)
    values = dict(numbers or {})
    lengths = [
        values.pop(name) / 1e3 if name in values else value
        for name, value in zip(_LENGTHS, stored.values[:3], strict=True)
    ]
    changed = replace(design_with_numbers(stored, lengths, values), allowed=allowed)
    request = RequestedDesign(stored_front, number, changed, True, bookmarks)
    if allowed or not request.bookmark:
        return request
    return replace(request, design=replace(changed, allowed=request.bookmark.allowed))


def _requested_design_dependency(
    stored_front: FrontDep, design: DesignNumber, numbers: NumbersDep, allowed: AllowedDep, store: StoreDep
) -> RequestedDesign:
    return requested_design(stored_front, design, numbers, bookmarks_of(store, stored_front.job.id), allowed)


RequestedDesignDep = Annotated[RequestedDesign, Depends(_requested_design_dependency)]
"""Design in the path, with the numbers in the query."""
