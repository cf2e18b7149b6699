"""Files of a single design, unchanged or with other numbers: linkage for CAD, animation, report for a review."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Annotated

from fastapi import APIRouter, Depends, Query, Response

from ...objectives.kinds import System
from ..designs.design_curves import design_csv
from ..drawings.design_drawing import design_drawing
from ..drawings.dxf import dxf_file
from ..drawings.shapes import Drawing
from ..drawings.svg import svg_file
from ..runs.run_folder import slug
from ..store import Store
from ..store.bookmarks_and_wishes import bookmarks_of
from .computing import LongRoute
from .figures import require_figures
from .front_files import SEALED, download_response, file_endpoint_options
from .problem_documents import problem_responses
from .settings import StoreDep, UnitsParameter
from .stored_fronts import RequestedDesign, RequestedDesignDep

if TYPE_CHECKING:
    from ..report.document import Report

router = APIRouter(
    route_class=LongRoute, prefix="/jobs/{number}/designs/{design}", tags=["designs"], responses=problem_responses(409)
)

_PLAYING = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; sandbox allow-scripts"
"""The animation runs its own script, but as a document without an origin."""

CrankAngle = Annotated[
    float | None,
    Query(
        ge=-360.0,
        le=360.0,
        allow_inf_nan=False,
        description="crank angle of the drawing; default: 60 deg, the middle of a swing; an arm: 90 deg to the frame",
        examples=[60.0],
    ),
]


def _file_response(
    request: RequestedDesign, ending: str, media_type: str, content: bytes, *, policy: str = SEALED, label: str = ""
) -> Response:
    name = f"{slug(request.stored_front.result.name)}-{request.stored_front.job.id}-{request.file_stem}{label}.{ending}"
    return download_response(content, media_type, name, policy=policy)


def _design_drawing(request: RequestedDesign, crank_angle_deg: float | None, system: System = "metric") -> Drawing:
    angle = None if crank_angle_deg is None else math.radians(crank_angle_deg)
    name = request.stored_front.result.name
    return design_drawing(request.design, name=name, design=request.display_name, crank_angle=angle, system=system)


@router.get("/linkage.dxf", **file_endpoint_options("image/vnd.dxf"))
def draw_dxf(request: RequestedDesignDep, crank_angle_deg: CrankAngle = None) -> Response:
    """Return the linkage of a design at true scale for CAD, in millimetres; docs/drawings.md lists its layers."""
    return _file_response(request, "dxf", "image/vnd.dxf", dxf_file(_design_drawing(request, crank_angle_deg)))


@router.get("/linkage.svg", **file_endpoint_options("image/svg+xml"))
def draw_linkage(
    request: RequestedDesignDep, crank_angle_deg: CrankAngle = None, units: UnitsParameter = "metric"
) -> Response:
    """Return the same drawing as SVG, with its dimensions in a unit system."""
    return _file_response(request, "svg", "image/svg+xml", svg_file(_design_drawing(request, crank_angle_deg, units)))


@router.get("/motion.html", **file_endpoint_options("text/html"))
def show_animation(request: RequestedDesignDep, units: UnitsParameter = "metric") -> Response:
    """Return an animation of the linkage as one HTML file with its own script; it fetches nothing."""
    from ..motion.player_page import player_page

    design = request.design
    named = {"name": request.stored_front.result.name, "design": request.display_name}
    content = player_page(design.mechanism, design.linkage, swing=design.part.motion, system=units, **named)
    return _file_response(request, "html", "text/html; charset=utf-8", content, policy=_PLAYING, label="-motion")


@router.get("/motion.gif", dependencies=[Depends(require_figures)], **file_endpoint_options("image/gif"))
def animate_linkage(request: RequestedDesignDep, units: UnitsParameter = "metric") -> Response:
    """Return an animated GIF of the linkage: one crank revolution, or a swing back and forth."""
    from ..motion.animated_gif import animated_gif

    design, named = request.design, {"name": request.stored_front.result.name, "design": request.display_name}
    swing = design.part.motion
    content = request.cached_file(
        f"gif {units}",
        lambda: animated_gif(design.mechanism, design.linkage, swing=swing, system=units, **named),
    )
    return _file_response(request, "gif", "image/gif", content, label="-motion")


@router.get("/report.html", dependencies=[Depends(require_figures)], **file_endpoint_options("text/html"))
def report_design(request: RequestedDesignDep, store: StoreDep, units: UnitsParameter = "metric") -> Response:
    """Return a design-review report as one HTML file without scripts; it fetches nothing."""
    from ..report.html import html_file

    content = request.cached_file(
        f"report {units} {_bookmarks_revision(request, store)}",
        lambda: html_file(_design_report(request, store, units)),
    )
    return _file_response(request, "html", "text/html; charset=utf-8", content, label="-report")


@router.get("/report.pdf", dependencies=[Depends(require_figures)], **file_endpoint_options("application/pdf"))
def print_report(request: RequestedDesignDep, store: StoreDep, units: UnitsParameter = "metric") -> Response:
    """Return the same report as PDF."""
    from ..report.pdf import pdf_file

    content = request.cached_file(
        f"pdf {units} {_bookmarks_revision(request, store)}", lambda: pdf_file(_design_report(request, store, units))
    )
    return _file_response(request, "pdf", "application/pdf", content, label="-report")


@router.get("/cycle.csv", **file_endpoint_options("text/csv"))
def export_cycle(request: RequestedDesignDep, units: UnitsParameter = "metric") -> Response:
    """Return the curves of a design as `export --cycle` does: per degree, or for both directions of a swing."""
    content = design_csv(request.design, units)
    return _file_response(request, "csv", "text/csv; charset=utf-8", content.encode(), label="-cycle")


def _design_report(request: RequestedDesign, store: Store, units: System) -> Report:
    """Return the report on a design, with additional data from the store."""
    from ..report.design_report import design_report
    from ..report.subject import Subject, alternatives_of

    stored_front = request.stored_front
    job = stored_front.job.id
    file_names = set(store.artefact_names(job))
    versions, certificate = (
        json.loads(store.artefact(job, name).content) if name in file_names else None
        for name in ("versions.json", "certificate.json")
    )
    subject = Subject(
        stored_front.problem,
        stored_front.result,
        request.number,
        run=stored_front.job.run,
        versions=versions or {},
        certificate=certificate,
        loaded_front=stored_front.front,
        changed=request.variation(),
        system=units,
        alternatives=alternatives_of(bookmarks_of(store, job), stored_front.problem, stored_front.result),
    )
    return design_report(subject)


def _bookmarks_revision(request: RequestedDesign, store: Store) -> int:
    """Return a number that changes with each edit of a job's bookmarks, which reports contain."""
    return hash(repr(bookmarks_of(store, request.stored_front.job.id)))
