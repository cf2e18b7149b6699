"""Files of a single design, as found or with other numbers: linkage for CAD, motion, report for a review."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
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
from ..store.bookmarks import bookmarks_of
from .computing import LongRoute
from .exports import SEALED, download, of_type
from .figures import require_figures
from .kept import alternatives_of
from .models import UnitsAsked
from .problems import problem_responses
from .settings import StoreDep
from .stored_fronts import ShownDep, ShownDesign

if TYPE_CHECKING:
    from ..report.document import Report

router = APIRouter(
    route_class=LongRoute, prefix="/jobs/{number}/designs/{design}", tags=["designs"], responses=problem_responses(409)
)

_PLAYING = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; sandbox allow-scripts"
"""The motion runs its own script, but as a document of no origin."""

CrankAngle = Annotated[
    float | None,
    Query(
        ge=-360.0,
        le=360.0,
        allow_inf_nan=False,
        description="where the linkage is drawn: at 60 deg if left out, half-way where it swings",
        examples=[60.0],
    ),
]


def _file(
    shown: ShownDesign, ending: str, media_type: str, content: bytes, *, policy: str = SEALED, label: str = ""
) -> Response:
    name = f"{slug(shown.found.result.name)}-{shown.found.job.id}-{shown.stem}{label}.{ending}"
    return download(content, media_type, name, policy=policy)


def _drawing(shown: ShownDesign, crank_angle_deg: float | None) -> Drawing:
    angle = None if crank_angle_deg is None else math.radians(crank_angle_deg)
    return design_drawing(shown.design, name=shown.found.result.name, design=shown.words, crank_angle=angle)


@router.get("/linkage.dxf", **of_type("image/vnd.dxf"))
def draw_dxf(shown: ShownDep, crank_angle_deg: CrankAngle = None) -> Response:
    """Give the linkage of a design at true scale for CAD, in millimetres: see docs/drawings.md for its layers."""
    return _file(shown, "dxf", "image/vnd.dxf", dxf_file(_drawing(shown, crank_angle_deg)))


@router.get("/linkage.svg", **of_type("image/svg+xml"))
def draw_linkage(shown: ShownDep, crank_angle_deg: CrankAngle = None) -> Response:
    """Give the same drawing as SVG."""
    return _file(shown, "svg", "image/svg+xml", svg_file(_drawing(shown, crank_angle_deg)))


@router.get("/motion.html", **of_type("text/html"))
def show_motion(shown: ShownDep) -> Response:
    """Give the moving linkage as one HTML file with its own script, which fetches nothing."""
    from ..motion.player_page import player_page

    of = shown.design
    named = {"name": shown.found.result.name, "design": shown.words}
    content = player_page(of.mechanism, of.linkage, swing=of.part.motion, **named)
    return _file(shown, "html", "text/html; charset=utf-8", content, policy=_PLAYING, label="-motion")


@router.get("/motion.gif", dependencies=[Depends(require_figures)], **of_type("image/gif"))
def animate_linkage(shown: ShownDep) -> Response:
    """Give the moving linkage as an animated GIF: a turn of the crank, or a swing forth and back."""
    from ..motion.animated_gif import animated_gif

    of, named = shown.design, {"name": shown.found.result.name, "design": shown.words}
    swing = of.part.motion
    content = _made(shown, "gif", lambda: animated_gif(of.mechanism, of.linkage, swing=swing, **named))
    return _file(shown, "gif", "image/gif", content, label="-motion")


@router.get("/report.html", dependencies=[Depends(require_figures)], **of_type("text/html"))
def report_design(shown: ShownDep, store: StoreDep, units: UnitsAsked = "metric") -> Response:
    """Give the report of a design for a review as one HTML file without script, which fetches nothing."""
    from ..report.html import html_file

    content = _made(shown, f"report {units} {_kept(shown, store)}", lambda: html_file(_report(shown, store, units)))
    return _file(shown, "html", "text/html; charset=utf-8", content, label="-report")


@router.get("/report.pdf", dependencies=[Depends(require_figures)], **of_type("application/pdf"))
def print_report(shown: ShownDep, store: StoreDep, units: UnitsAsked = "metric") -> Response:
    """Give the same report as PDF."""
    from ..report.pdf import pdf_file

    content = _made(shown, f"pdf {units} {_kept(shown, store)}", lambda: pdf_file(_report(shown, store, units)))
    return _file(shown, "pdf", "application/pdf", content, label="-report")


@router.get("/cycle.csv", **of_type("text/csv"))
def export_cycle(shown: ShownDep, units: UnitsAsked = "metric") -> Response:
    """Give the curves of a design as a table, as `export --cycle`: each degree, or both ways of a swing."""
    content = design_csv(shown.design, units)
    return _file(shown, "csv", "text/csv; charset=utf-8", content.encode(), label="-cycle")


def _report(shown: ShownDesign, store: Store, units: System) -> Report:
    """Return the report of a design, with what the store keeps besides the result."""
    from ..report.design_report import design_report
    from ..report.subject import Subject

    found = shown.found
    job = found.job.id
    kept = set(store.artefacts(job))
    versions, certificate = (
        json.loads(store.artefact(job, name).content) if name in kept else None
        for name in ("versions.json", "certificate.json")
    )
    subject = Subject(
        found.problem,
        found.result,
        shown.number,
        run=found.job.run,
        versions=versions or {},
        certificate=certificate,
        known=found.front,
        changed=shown.variation(),
        system=units,
        alternatives=alternatives_of(found, store),
    )
    return design_report(subject)


def _kept(shown: ShownDesign, store: Store) -> int:
    """Return a number of the state of a job's kept designs, which reports tell of: another one after each change."""
    return hash(tuple(bookmarks_of(store, shown.found.job.id)))


def _made(shown: ShownDesign, kind: str, make: Callable[[], bytes]) -> bytes:
    return shown.found.made(shown.key, kind, lambda: ([shown.key], make()))
