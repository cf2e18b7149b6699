"""Figures of a front, drawn on request."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import APIRouter, Depends, Path, Response
from pydantic import BaseModel, Field

from ...model.errors import InputError, NotFound
from ...objectives.kinds import System
from ..runs.run_folder import slug
from ..store.bookmark import Bookmark
from ..store.bookmarks_and_wishes import bookmarks_of
from .computing import LongRoute
from .front_files import SEALED, file_endpoint_options
from .problem_documents import problem_responses
from .settings import SettingsDep, StoreDep, UnitsParameter
from .stored_fronts import AllowedDep, FrontDep, Numbers, NumbersDep, RequestedDesign, StoredFront, requested_design

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..figures.front_figures import FrontFigure

Kind = Literal["png", "svg"]
_MEDIA = {"png": "image/png", "svg": "image/svg+xml"}
_DESIGN = re.compile(r"design_([1-9][0-9]{0,8})")


def require_figures(settings: SettingsDep) -> None:
    """Raise an error if figures are disabled on this service."""
    if not settings.figures:
        raise NotFound("this service cannot draw figures; ask its operator to start it with figures")


router = APIRouter(
    route_class=LongRoute, tags=["figures"], dependencies=[Depends(require_figures)], responses=problem_responses(409)
)

Name = Annotated[
    str,
    Path(
        pattern=r"^[a-z0-9_]+$",
        max_length=100,
        description="name from the list of figures, or design_ and the number of a design",
        examples=["scatter_matrix"],
    ),
]


class FigureModel(BaseModel):
    """Figure. name: in its path, followed by .png or .svg."""

    name: str = Field(examples=["scatter_matrix"])
    title: str = Field(examples=["every pair of objectives"])


class FiguresModel(BaseModel):
    """Figures of a front."""

    job: int = Field(examples=[7])
    figures: list[FigureModel]


@router.get("/jobs/{number}/figures")
def list_figures(stored_front: FrontDep) -> FiguresModel:
    """List the figures of the whole front.

    The datasheet of each design is at `figures/design_{number}.png` or `.svg`.
    """
    from ..figures.front_figures import front_figures

    drawn = front_figures(stored_front.front) if stored_front.result.designs else []
    listed = [FigureModel(name=name, title=item.title) for item in drawn for name in item.names]
    return FiguresModel(job=stored_front.job.id, figures=listed)


@router.get("/jobs/{number}/figures/{name}.png", **file_endpoint_options("image/png"))
def draw_png(
    stored_front: FrontDep,
    name: Name,
    numbers: NumbersDep,
    allowed: AllowedDep,
    store: StoreDep,
    units: UnitsParameter = "metric",
) -> Response:
    """Draw a figure; the datasheet of a design accepts other numbers."""
    bookmarks = bookmarks_of(store, stored_front.job.id)
    return _cached_figure_response(stored_front, name, "png", numbers, allowed, bookmarks, units)


@router.get("/jobs/{number}/figures/{name}.svg", **file_endpoint_options("image/svg+xml"))
def draw_svg(
    stored_front: FrontDep,
    name: Name,
    numbers: NumbersDep,
    allowed: AllowedDep,
    store: StoreDep,
    units: UnitsParameter = "metric",
) -> Response:
    """Draw a figure; the datasheet of a design accepts other numbers."""
    bookmarks = bookmarks_of(store, stored_front.job.id)
    return _cached_figure_response(stored_front, name, "svg", numbers, allowed, bookmarks, units)


def _cached_figure_response(
    stored_front: StoredFront,
    name: str,
    kind: Kind,
    numbers: Numbers | None,
    allowed: Numbers,
    bookmarks: Sequence[Bookmark],
    units: System,
) -> Response:
    """Return a figure; the datasheet of a design is named like its file. Drawn figures are cached."""
    from ..figures.style import figure_bytes

    single = _DESIGN.fullmatch(name)
    if single is None and numbers is not None:
        rule = "other lengths and values only apply to a single design"
        raise InputError(f"{rule}; got figure {name!r}; ask for design_1 and so on")
    cache_kind = f"{kind} {units}"

    def draw() -> tuple[Sequence[str], bytes]:
        figure = _front_figure(stored_front, name, units)
        return figure.names, figure_bytes(figure.draw(), kind)

    if single is None:
        return figure_response(stored_front.cached_item(name, cache_kind, draw), kind)
    request = requested_design(stored_front, int(single[1]), numbers, bookmarks, allowed)
    drawn = request.cached_file(cache_kind, lambda: figure_bytes(_design_datasheet(request, units), kind))
    file = f"{slug(stored_front.result.name)}-{stored_front.job.id}-{request.file_stem}-sheet.{kind}"
    return figure_response(drawn, kind, {"Content-Disposition": f'inline; filename="{file}"'})


def figure_response(content: bytes, kind: Kind, headers: Mapping[str, str] = MappingProxyType({})) -> Response:
    """Return a drawn figure; as SVG it can neither run scripts nor fetch anything."""
    sealed = {"Content-Security-Policy": SEALED} if kind == "svg" else {}
    return Response(content, media_type=_MEDIA[kind], headers={**sealed, **headers})


def _front_figure(stored_front: StoredFront, name: str, units: System) -> FrontFigure:
    """Return a figure of a whole front. Raises `NotFound`, which lists the available names."""
    from ..figures.front_figures import front_figures

    listed = front_figures(stored_front.front, units) if stored_front.result.designs else []
    named = next((item for item in listed if name in item.names), None)
    if named is None:
        names = [name for item in listed for name in item.names]
        choice = f"choose from {', '.join(names)}, design_1 and so on" if names else "the front has no designs to draw"
        raise NotFound(f"the front has no figure {name!r}; {choice}")
    return named


def _design_datasheet(request: RequestedDesign, units: System) -> Figure:
    from ..figures.front_figures import datasheet_of

    return datasheet_of(
        request.stored_front.front, request.number - 1, request.display_name, units, request.variation()
    )
