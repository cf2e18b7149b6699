"""Kept designs of a front: with name, note and star, and the reasons of a decision."""

from __future__ import annotations

from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated, Any

from fastapi import APIRouter, Path, Response
from pydantic import BaseModel, Field

from ...model.errors import InputError
from ...objectives.tables.varying_column import varying_column
from ...optimise.problem.table_columns import choice_field
from ..designs.columns import all_columns
from ..designs.requirements import ranges_of
from ..designs.shown_units import rows_in
from ..designs.stored_designs import StoredDesign, design_of, stored_design
from ..designs.variation import Variation, variation_of, with_numbers
from ..runs.result import csv_text, json_ready
from ..store.bookmarks import Bookmark, bookmarks_of, change_kept, drop_kept, keep_design
from .computing import QuickRoute
from .exports import download, of_type
from .fronts import Cells, ColumnModel, column_models
from .models import PLAIN_DIGITS, UnitsAsked
from .problems import problem_responses
from .settings import StoreDep
from .stored_fronts import LONGEST, SHORTEST, FrontDep, StoredFront

if TYPE_CHECKING:
    from ..report.subject import Alternative
    from ..store import Store

router = APIRouter(route_class=QuickRoute, tags=["designs"], responses=problem_responses(409))

_NAME = Annotated[str, Field(max_length=200)]
_TEXT = Annotated[str, Field(max_length=4000)]
_LENGTHS = ("crank_mm", "rod_mm", "offset_mm")
KeptNumber = Annotated[
    int, Path(ge=1, le=2**31, description="number of a kept design, from 1", examples=[1]), PLAIN_DIGITS
]


class KeepAsked(BaseModel, extra="forbid", strict=True):
    """A design to keep: one of the front, that with other dimensions, or one of dimensions alone.

    design: its number. dimensions: of a row of a table of designs, in place of those of the design; without a design
    all of the lengths, varying numbers and choices. Lengths outside of the ranges of the job are allowed.
    """

    design: int | None = Field(None, ge=1, le=2**31, examples=[1])
    dimensions: dict[Annotated[str, Field(max_length=500)], float | Annotated[str, Field(max_length=500)]] = Field(
        {}, max_length=200, examples=[{"rod_mm": 330.0}]
    )
    name: _NAME = Field("", examples=["Round numbers"])
    note: _TEXT = Field("", examples=["rod from stock"])
    star: bool = False


class KeptChange(BaseModel, extra="forbid", strict=True):
    """Changes of a kept design; what is missing stays. decided: taken from the others. reason: why, or why not."""

    name: Annotated[str, Field(min_length=1, max_length=200)] = Field("", examples=["Round numbers"])
    note: _TEXT = Field("", examples=["rod from stock"])
    star: bool = Field(False, examples=[True])
    decided: bool = Field(False, examples=[True])
    reason: _TEXT = Field("", examples=["the least torque of those with 45 deg"])


class KeptDesign(BaseModel):
    """A kept design. at: when it was kept, seconds since 1970. design: of the front, that it is or began as.

    changed: whether its dimensions are others than those of that design. cells: every quantity and the slacks. broken:
    columns of the requirements that it does not meet. outside: of dimensions that are outside the job.
    """

    number: int = Field(ge=1, examples=[1])
    name: str
    note: str
    star: bool
    decided: bool
    reason: str
    design: int | None
    changed: bool
    at: float
    cells: Cells
    broken: list[str]
    outside: list[str]


class KeptModel(BaseModel):
    """The kept designs of a job, as they were kept one after the other."""

    job: int = Field(examples=[7])
    columns: list[ColumnModel]
    designs: list[KeptDesign]


@router.get("/jobs/{number}/kept")
def list_kept(found: FrontDep, store: StoreDep) -> KeptModel:
    """Give the kept designs of a job with all their numbers."""
    designs = [_shown(found, one) for one in bookmarks_of(store, found.job.id)]
    columns = column_models(all_columns(designs[0].cells if designs else ()))
    return KeptModel(job=found.job.id, columns=columns, designs=designs)


@router.post("/jobs/{number}/kept", status_code=HTTPStatus.CREATED)
def keep(found: FrontDep, asked: KeepAsked, store: StoreDep) -> KeptDesign:
    """Keep a design with a name, a note and a star."""
    design = _asked(found, asked)
    _varied(found, design)  # what cannot be computed is refused before it is kept
    told: dict[str, Any] = {"name": asked.name, "note": asked.note, "star": asked.star, "design": asked.design}
    one = keep_design(store, found.job.id, dimensions=design.values, variant=design.variant, **told)
    return _shown(found, one)


@router.patch("/jobs/{number}/kept/{kept}")
def change(found: FrontDep, kept: KeptNumber, asked: KeptChange, store: StoreDep) -> KeptDesign:
    """Change a kept design, or decide for it."""
    return _shown(found, change_kept(store, found.job.id, kept, **asked.model_dump(exclude_unset=True)))


@router.delete("/jobs/{number}/kept/{kept}", status_code=HTTPStatus.NO_CONTENT)
def drop(found: FrontDep, kept: KeptNumber, store: StoreDep) -> None:
    """Delete a kept design."""
    drop_kept(store, found.job.id, kept)


@router.get("/jobs/{number}/kept.csv", **of_type("text/csv"))
def export_kept(found: FrontDep, store: StoreDep, units: UnitsAsked = "metric") -> Response:
    """Give the kept designs as a table: names, notes and reasons, then all their quantities at full precision."""
    rows: list[Any] = []
    for one in bookmarks_of(store, found.job.id):
        varied = _varied(found, _design(found, one))
        head = {"number": one.number, "name": one.name, "star": one.star, "decided": one.decided}
        head |= {"note": one.note, "reason": one.reason, "outside_the_job": ", ".join(varied.outside)}
        rows.append(head | rows_in([varied.row], units)[0])
    return download(csv_text(rows, spreadsheet=True), "text/csv; charset=utf-8", f"{found.result.run}-kept.csv")


def alternatives_of(found: StoredFront, store: Store) -> list[Alternative]:
    """Return the kept designs of a job as a report has them."""
    from ..report.subject import Alternative

    said = []
    for one in bookmarks_of(store, found.job.id):
        varied = _varied(found, _design(found, one))
        words: dict[str, Any] = {"name": one.name, "note": one.note, "decided": one.decided, "reason": one.reason}
        said.append(Alternative(**words, row=varied.row, broken=varied.broken, outside=varied.outside))
    return said


def _asked(found: StoredFront, asked: KeepAsked) -> StoredDesign:
    """Return the design that is to be kept. Raises `InputError` for dimensions that are none of the job's."""
    if asked.design is None and not asked.dimensions:
        raise InputError("a bookmark needs a design of the front or dimensions; got neither; give a design, or lengths")
    own = {} if asked.design is None else found.row(asked.design)
    if asked.design is not None and not asked.dimensions:
        return stored_design(found.problem, found.result, asked.design)
    known = {*_LENGTHS, *(rule.column for rule in ranges_of(found.problem.parts()[0]))}
    known |= {choice_field(name) for name in found.problem.choices}
    for key, value in asked.dimensions.items():
        if key not in known:
            raise InputError(f"dimensions must be {', '.join(sorted(known))}; got {key!r}; leave it out")
        if key in _LENGTHS and not (isinstance(value, float) and -LONGEST <= value <= LONGEST):
            raise InputError(f"{key} must be a number up to {LONGEST:g}; got {value!r}; correct it")
        if key in _LENGTHS[:2] and isinstance(value, float) and value < SHORTEST:
            raise InputError(f"{key} must be at least {SHORTEST:g}; got {value:g}; correct it")
    missing = sorted(known - {*own, *asked.dimensions})
    if missing:
        raise InputError(
            f"a design without a number needs all dimensions; got none for {', '.join(missing)}; give them"
        )
    design = design_of(found.problem, {**own, **asked.dimensions})
    varying = {varying_column(item)[0] for item in design.part.mechanism.varying}
    values = {key: value for key, value in asked.dimensions.items() if key in varying and isinstance(value, float)}
    return with_numbers(design, design.values[:3], values)


def _design(found: StoredFront, one: Bookmark) -> StoredDesign:
    return StoredDesign(found.problem.part(one.variant), one.dimensions, one.variant)


def _varied(found: StoredFront, design: StoredDesign) -> Variation:
    return variation_of(design, found.result, found.minimised)


def _shown(found: StoredFront, one: Bookmark) -> KeptDesign:
    design = _design(found, one)
    varied = _varied(found, design)
    same = one.design is not None and stored_design(found.problem, found.result, one.design).values == one.dimensions
    told = {name: value for name, value in vars(one).items() if name not in ("job", "variant", "dimensions")}
    return KeptDesign(
        **told, changed=not same, cells=json_ready(varied.row), broken=varied.broken, outside=varied.outside
    )
