"""Bookmarked designs of a front, each with name, note, star and the reasons for a decision."""

from dataclasses import replace
from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Path, Query, Response
from pydantic import BaseModel, Field

from ...model.errors import InputError
from ...objectives.tables.design_input import column_of_variable
from ...optimise.problem.table_columns import choice_field
from ..designs.changed_design import Variation, design_with_numbers, judged_variation
from ..designs.columns import all_columns
from ..designs.display_units import convert_rows
from ..designs.judged_requirements import faults_in_words, ranges_as_requirements
from ..designs.stored_designs import StoredDesign, design_of_row, stored_design
from ..runs.result import csv_text, json_ready
from ..store.bookmark import Action, Bookmark
from ..store.bookmarks_and_wishes import bookmark_design, bookmarks_of, history_of, remove_bookmark, update_bookmark
from .computing import QuickRoute
from .front_files import download_response, file_endpoint_options
from .fronts import Cells, ColumnModel, column_models
from .problem_documents import problem_responses
from .settings import PLAIN_DIGITS, StoreDep, UnitsParameter
from .stored_fronts import LONGEST, SHORTEST, Allowed, FrontDep, StoredFront

router = APIRouter(route_class=QuickRoute, tags=["designs"], responses=problem_responses(409))

_NAME = Annotated[str, Field(max_length=200)]
_TEXT = Annotated[str, Field(max_length=4000)]
_AUTHOR = Annotated[str, Field(max_length=100, examples=["Anna"])]
_LENGTHS = ("crank_mm", "rod_mm", "offset_mm")
BookmarkNumber = Annotated[
    int, Path(ge=1, le=2**31, description="number of a bookmark, from 1", examples=[1]), PLAIN_DIGITS
]


class _Remarks(BaseModel, extra="forbid", strict=True):
    note: _TEXT = Field("", examples=["rod from stock"])
    star: bool = False
    decided: bool = False
    reason: _TEXT = Field("", examples=["the least torque of those with 45 deg"])
    author: _AUTHOR = ""


class NewBookmark(_Remarks):
    """Design to bookmark: one on the front, one with other dimensions, or dimensions alone.

    If the design already has a bookmark, that bookmark takes over the given name, note, star, decision and reason.
    decided: revokes an earlier decision. author: name of the person, for the history.

    design: its number. dimensions: column values from a table of designs that replace those of the design; without a
    design, all lengths, extra variables and choices. Lengths outside the ranges of the job are allowed. allow: allowed
    deviations from requirements, by column.
    """

    design: int | None = Field(None, ge=1, le=2**31, examples=[1])
    dimensions: dict[Annotated[str, Field(max_length=500)], float | Annotated[str, Field(max_length=500)]] = Field(
        {}, max_length=200, examples=[{"rod_mm": 330.0}]
    )
    allow: Allowed = {}
    name: _NAME = Field("", examples=["Round numbers"])


class BookmarkChange(_Remarks):
    """Changes to a bookmark; omitted fields stay unchanged.

    decided: revokes an earlier decision. reason: why, or why not. author: name of the person, for the history. Earlier
    notes, reasons and decisions stay in the history.
    """

    name: Annotated[str, Field(min_length=1, max_length=200)] = Field("", examples=["Round numbers"])


class BookmarkedDesign(BaseModel):
    """Bookmarked design. at: time of bookmarking, seconds since 1970. design: number of its origin on the front.

    changed: whether its dimensions differ from those of its origin. numbers: query that gives the origin these
    dimensions: empty if they are equal, null if none can. decision: its decision in words, or empty. cells: every
    quantity and the slacks. broken: columns of unmet requirements. outside: columns of dimensions outside the job's
    ranges. faults: both in words. allowed: allowed deviations from requirements, by column. deviations: those within
    them, in words.
    """

    number: int = Field(ge=1, examples=[1])
    name: str
    note: str
    star: bool
    decided: bool
    reason: str
    design: int | None
    changed: bool
    numbers: dict[str, float | list[str]] | None = Field(
        examples=[{"crank_mm": 40.0, "rod_mm": 64.0, "offset_mm": 20.0}]
    )
    decision: str = Field(examples=["Decided: Round numbers (least torque)"])
    at: float
    cells: Cells
    broken: list[str]
    outside: list[str]
    faults: list[str] = Field(examples=[["misses stroke"]])
    allowed: Allowed
    deviations: list[str] = Field(examples=[["stroke 180.008 mm, within the allowed ±0.05 mm"]])


class HistoryEntryModel(BaseModel, from_attributes=True):
    """Change to a bookmark. number: increases within the job. bookmark: its number, null once it is deleted.

    name: name of the design at that time. text: the note or reason, if any. author: name that was given, or empty. at:
    seconds since 1970.
    """

    number: int = Field(examples=[1])
    bookmark: int | None
    name: str
    action: Action
    text: str
    author: str
    at: float


class BookmarkList(BaseModel):
    """Bookmarks of a job, oldest first. history: all notes, reasons, decisions and deletions, oldest first."""

    job: int = Field(examples=[7])
    columns: list[ColumnModel]
    designs: list[BookmarkedDesign]
    history: list[HistoryEntryModel]


@router.get("/jobs/{number}/kept")
def list_bookmarks(stored_front: FrontDep, store: StoreDep) -> BookmarkList:
    """Return the bookmarked designs of a job with all their numbers."""
    designs = [_bookmark_model(stored_front, bookmark) for bookmark in bookmarks_of(store, stored_front.job.id)]
    columns = column_models(all_columns(designs[0].cells if designs else ()))
    history = [HistoryEntryModel.model_validate(entry) for entry in history_of(store, stored_front.job.id)]
    return BookmarkList(job=stored_front.job.id, columns=columns, designs=designs, history=history)


@router.post("/jobs/{number}/kept", status_code=HTTPStatus.CREATED)
def add_bookmark(stored_front: FrontDep, request: NewBookmark, store: StoreDep) -> BookmarkedDesign:
    """Bookmark a design with a name, a note and a star."""
    design = _design_to_bookmark(stored_front, request)
    _variation_of_design(
        stored_front, replace(design, allowed=request.allow)
    )  # reject what cannot be computed before it is stored
    fields: dict[str, Any] = request.model_dump(exclude={"dimensions", "allow"})
    fields |= {"dimensions": design.values, "variant": design.variant, "allowed": request.allow}
    bookmark = bookmark_design(store, stored_front.job.id, **fields)
    return _bookmark_model(stored_front, bookmark)


@router.patch("/jobs/{number}/kept/{kept}")
def change_bookmark(
    stored_front: FrontDep, kept: BookmarkNumber, change: BookmarkChange, store: StoreDep
) -> BookmarkedDesign:
    """Change a bookmark, or decide on its design."""
    return _bookmark_model(
        stored_front,
        update_bookmark(store, stored_front.job.id, kept, **change.model_dump(exclude_unset=True)),
    )


@router.delete("/jobs/{number}/kept/{kept}", status_code=HTTPStatus.NO_CONTENT)
def delete_bookmark(
    stored_front: FrontDep, kept: BookmarkNumber, store: StoreDep, author: Annotated[_AUTHOR, Query()] = ""
) -> None:
    """Delete a bookmark; the history keeps its notes, reasons and decisions."""
    remove_bookmark(store, stored_front.job.id, kept, author)


@router.get("/jobs/{number}/kept.csv", **file_endpoint_options("text/csv"))
def export_bookmarks(stored_front: FrontDep, store: StoreDep, units: UnitsParameter = "metric") -> Response:
    """Return the bookmarks as a table: names, notes and reasons, then all quantities at full precision."""
    rows: list[Any] = []
    for bookmark in bookmarks_of(store, stored_front.job.id):
        varied = _variation_of_design(stored_front, _design_of_bookmark(stored_front, bookmark))
        head = {
            "design": bookmark.design,
            "bookmark": bookmark.number,
            "name": bookmark.name,
            "star": bookmark.star,
            "decided": bookmark.decided,
        }
        head |= {
            "note": "; ".join(bookmark.notes),
            "reason": bookmark.reason,
            "allowed": "; ".join(varied.deviations),
            "outside_the_job": ", ".join(varied.outside),
        }
        rows.append(head | convert_rows([varied.row], units)[0])
    return download_response(
        csv_text(rows, spreadsheet=True), "text/csv; charset=utf-8", f"{stored_front.result.run}-kept.csv"
    )


def _design_to_bookmark(stored_front: StoredFront, request: NewBookmark) -> StoredDesign:
    """Return the design to bookmark. Raises `InputError` for dimensions that the job does not define."""
    if request.design is None and not request.dimensions:
        raise InputError("a bookmark needs a design on the front, or dimensions; got neither; give one of them")
    row = {} if request.design is None else stored_front.row_of_design(request.design)
    if request.design is not None and not request.dimensions:
        return stored_design(stored_front.problem, stored_front.result, request.design)
    allowed_keys = {*_LENGTHS, *(rule.column for rule in ranges_as_requirements(stored_front.problem.parts()[0]))}
    allowed_keys |= {choice_field(name) for name in stored_front.problem.choices}
    for key, value in request.dimensions.items():
        if key not in allowed_keys:
            raise InputError(f"dimensions must be {', '.join(sorted(allowed_keys))}; got {key!r}; leave it out")
        if key in _LENGTHS and not (isinstance(value, float) and -LONGEST <= value <= LONGEST):
            raise InputError(f"{key} must be a number up to {LONGEST:g}; got {value!r}; correct it")
        if key in _LENGTHS[:2] and isinstance(value, float) and value < SHORTEST:
            raise InputError(f"{key} must be at least {SHORTEST:g}; got {value:g}; correct it")
    missing = sorted(allowed_keys - {*row, *request.dimensions})
    if missing:
        raise InputError(
            f"a design without a number needs all dimensions; got none for {', '.join(missing)}; give them"
        )
    design = design_of_row(stored_front.problem, {**row, **request.dimensions})
    varying = {column_of_variable(item)[0] for item in design.part.mechanism.varying}
    values = {key: value for key, value in request.dimensions.items() if key in varying and isinstance(value, float)}
    return design_with_numbers(design, design.values[:3], values)


def _design_of_bookmark(stored_front: StoredFront, bookmark: Bookmark) -> StoredDesign:
    return StoredDesign(
        stored_front.problem.part(bookmark.variant), bookmark.dimensions, bookmark.variant, bookmark.allowed
    )


def _variation_of_design(stored_front: StoredFront, design: StoredDesign) -> Variation:
    return judged_variation(design, stored_front.result, stored_front.minimised_objectives)


def _bookmark_model(stored_front: StoredFront, bookmark: Bookmark) -> BookmarkedDesign:
    design = _design_of_bookmark(stored_front, bookmark)
    varied = _variation_of_design(stored_front, design)
    origin = stored_design(stored_front.problem, stored_front.result, bookmark.design) if bookmark.design else None
    same = origin is not None and bookmark.is_of(origin.variant, origin.values)
    fields = {
        name: value for name, value in vars(bookmark).items() if name not in ("job", "variant", "dimensions", "history")
    }
    faults = faults_in_words(varied.row, varied.broken, varied.outside)
    return BookmarkedDesign(
        **fields,
        changed=not same,
        numbers={} if same else _query_for_design(design) if origin and origin.variant == design.variant else None,
        decision=bookmark.decision(faults),
        cells=json_ready(varied.row),
        broken=varied.broken,
        outside=varied.outside,
        faults=faults,
        deviations=varied.deviations,
    )


def _query_for_design(design: StoredDesign) -> dict[str, float | list[str]]:
    """Return the query that changes a reference design, which has the same choices, to the dimensions of this one."""
    lengths = {key: 1e3 * value for key, value in zip(_LENGTHS, design.values[:3], strict=True)}
    pairs = zip(map(column_of_variable, design.part.mechanism.varying), design.values[3:], strict=True)
    values = [f"{column}={value * unit.factor!r}" for (column, unit), value in pairs]
    allow = [f"{column}={amount!r}" for column, amount in design.allowed.items()]
    return {**lengths, **({"value": values} if values else {}), **({"allow": allow} if allow else {})}
