"""Figures of a front, drawn when they are asked for."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import APIRouter, Depends, Path, Response
from pydantic import BaseModel, Field

from ...model.errors import InputError, NotFound
from ...objectives.kinds import System
from ..runs.run_folder import slug
from .computing import LongRoute
from .exports import SEALED, of_type
from .models import UnitsAsked
from .problems import problem_responses
from .settings import SettingsDep
from .stored_fronts import FrontDep, Numbers, NumbersDep, ShownDesign, StoredFront, shown_design

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..figures.front import FrontFigure

Kind = Literal["png", "svg"]
_MEDIA = {"png": "image/png", "svg": "image/svg+xml"}
_DESIGN = re.compile(r"design_([1-9][0-9]{0,8})")


def require_figures(settings: SettingsDep) -> None:
    """Refuse where the service draws no figures."""
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
    from ..figures.front import front_figures

    drawn = front_figures(found.front) if found.result.designs else []
    listed = [FigureModel(name=name, title=item.title) for item in drawn for name in item.names]
    return FiguresModel(job=found.job.id, figures=listed)


@router.get("/jobs/{number}/figures/{name}.png", **of_type("image/png"))
def draw_png(found: FrontDep, name: Name, numbers: NumbersDep, units: UnitsAsked = "metric") -> Response:
    """Draw a figure; the sheet of a design also with other numbers."""
    return _image(found, name, "png", numbers, units)


@router.get("/jobs/{number}/figures/{name}.svg", **of_type("image/svg+xml"))
def draw_svg(found: FrontDep, name: Name, numbers: NumbersDep, units: UnitsAsked = "metric") -> Response:
    """Draw a figure; the sheet of a design also with other numbers."""
    return _image(found, name, "svg", numbers, units)


def _image(found: StoredFront, name: str, kind: Kind, numbers: Numbers | None, units: System) -> Response:
    """Return a figure; the sheet of a design has the name of its file. Drawn ones are kept."""
    from ..figures.style import image

    single = _DESIGN.fullmatch(name)
    if single is None and numbers is not None:
        rule = "other lengths and values only apply to a single design"
        raise InputError(f"{rule}; got figure {name!r}; ask for design_1 and so on")
    shown = None if single is None else shown_design(found, int(single[1]), numbers)
    key, headers = shown.key if shown else name, dict[str, str]()

    def draw() -> tuple[Sequence[str], bytes]:
        if shown:
            return (key,), image(_sheet(shown, units), kind)
        figure = _of_front(found, name, units)
        return figure.names, image(figure.draw(), kind)

    drawn = found.made(key, f"{kind} {units}", draw)
    if shown:
        file = f"{slug(found.result.name)}-{found.job.id}-{shown.stem}-sheet.{kind}"
        headers = {"Content-Disposition": f'inline; filename="{file}"'}
    if kind == "svg":
        headers["Content-Security-Policy"] = SEALED
    return Response(drawn, media_type=_MEDIA[kind], headers=headers)


def _of_front(found: StoredFront, name: str, units: System) -> FrontFigure:
    """Return a figure of a whole front. Raises `NotFound` with those that there are."""
    from ..figures.front import front_figures

    listed = front_figures(found.front, units) if found.result.designs else []
    named = next((item for item in listed if name in item.names), None)
    if named is None:
        names = [name for item in listed for name in item.names]
        choice = f"choose from {', '.join(names)}, design_1 and so on" if names else "the front has no designs to draw"
        raise NotFound(f"the front has no figure {name!r}; {choice}")
    return named


def _sheet(shown: ShownDesign, units: System) -> Figure:
    from ..figures.front import sheet_of

    return sheet_of(shown.found.front, shown.number - 1, shown.words, units, shown.variation())
