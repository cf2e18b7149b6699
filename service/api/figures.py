"""Figures of a front, drawn when they are asked for."""

from __future__ import annotations

import re
from typing import Annotated, Literal

from fastapi import APIRouter, Depends, Path, Response
from pydantic import BaseModel, Field

from ...model.errors import NotFound
from ...objectives.kinds import System
from .models import UnitsAsked
from .problems import problem_responses
from .state import SettingsDep
from .stored_fronts import FrontDep, StoredFront
from .turns import DRAWING

_DESIGN = re.compile(r"design_([1-9][0-9]{0,8})")


def require_figures(settings: SettingsDep) -> None:
    """Refuse where the service draws no figures."""
    if not settings.figures:
        raise NotFound("this service draws no figures; ask whoever runs it to start it with figures")


router = APIRouter(tags=["figures"], dependencies=[Depends(require_figures)], responses=problem_responses(409))

Name = Annotated[
    str,
    Path(
        pattern=r"^[a-z0-9_]+$",
        max_length=100,
        description="of the list of figures, or design_ and the number of a design",
        examples=["scatter_matrix"],
    ),
]


class FigureModel(BaseModel):
    """A figure. name: in its path, with .png or .svg."""

    name: str = Field(examples=["scatter_matrix"])
    title: str = Field(examples=["every pair of objectives"])


class FiguresModel(BaseModel):
    """The figures of a front."""

    job: int = Field(examples=[7])
    figures: list[FigureModel]


@router.get("/jobs/{number}/figures")
def list_figures(found: FrontDep) -> FiguresModel:
    """List the figures of the whole front; the sheet of every design is at `figures/design_{number}.png` or `.svg`."""
    from ..figures.of_front import front_figures

    drawn = front_figures(found.front) if found.result.designs else []
    listed = [FigureModel(name=name, title=item.title) for item in drawn for name in item.names]
    return FiguresModel(job=found.job.id, figures=listed)


@router.get(
    "/jobs/{number}/figures/{name}.png",
    response_class=Response,
    responses={200: {"content": {"image/png": {}}}},
)
def draw_png(found: FrontDep, name: Name, units: UnitsAsked = "metric") -> Response:
    """Draw a figure."""
    return Response(_image(found, name, "png", units), media_type="image/png")


@router.get(
    "/jobs/{number}/figures/{name}.svg",
    response_class=Response,
    responses={200: {"content": {"image/svg+xml": {}}}},
)
def draw_svg(found: FrontDep, name: Name, units: UnitsAsked = "metric") -> Response:
    """Draw a figure."""
    # Opened by itself it is a document: it runs nothing and fetches nothing.
    policy = {"Content-Security-Policy": "default-src 'none'; style-src 'unsafe-inline'; sandbox"}
    return Response(_image(found, name, "svg", units), media_type="image/svg+xml", headers=policy)


def _image(found: StoredFront, name: str, kind: Literal["png", "svg"], units: System) -> bytes:
    """Return a figure as a file; what was drawn before is kept with the front."""
    from ..figures.of_front import FrontFigure, front_figures, sheet_of
    from ..figures.style import image

    single = _DESIGN.fullmatch(name)
    if single is not None:
        row = int(single[1]) - 1
        found.row(row + 1)
    elif not found.result.designs:
        raise _unknown(name, [])
    kept = f"{kind} {units}"
    drawn = found.image(name, kept)
    if drawn is not None:
        return drawn
    with DRAWING.turn():
        drawn = found.image(name, kept)  # by whoever was first
        if drawn is not None:
            return drawn
        if single is not None:
            figure = FrontFigure((name,), "", lambda: sheet_of(found.front, row, f"design {row + 1}", units))
        else:
            listed = front_figures(found.front, units)
            named = next((item for item in listed if name in item.names), None)
            if named is None:
                raise _unknown(name, [name for item in listed for name in item.names])
            figure = named
        content = image(figure.draw(), kind)
        found.keep_image(figure.names, kept, content)
        return content


def _unknown(name: str, names: list[str]) -> NotFound:
    choice = f"choose from {', '.join(names)}, design_1 and so on" if names else "the front has no designs to draw"
    return NotFound(f"the front has no figure {name!r}; {choice}")
