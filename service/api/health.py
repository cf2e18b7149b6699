"""Whether the service answers, whether it can do its work, and its figures for Prometheus."""

from __future__ import annotations

from typing import Literal

from fastapi import APIRouter, Request, Response
from prometheus_client.exposition import CONTENT_TYPE_LATEST

from .metrics import Metrics
from .models import Count, Shown
from .state import StoreDep

router = APIRouter(tags=["service"])


class Live(Shown):
    """The service answers."""

    status: Literal["live"] = "live"


class Ready(Shown):
    """The service has its database. takes_jobs: whether a worker was heard of lately, be it busy."""

    status: Literal["ready"] = "ready"
    takes_jobs: bool
    workers: Count
    waiting: Count


@router.get("/health/live", openapi_extra={"security": []})
async def show_live() -> Live:
    """Return that the service answers; needs no token."""
    return Live()


@router.get("/health/ready")
def show_ready(store: StoreDep) -> Ready:
    """Return that the database can be read and written, how many workers there are, and how many jobs wait."""
    store.require_ready()
    workers = store.workers_at_work()
    return Ready(takes_jobs=workers > 0, workers=workers, waiting=store.counts().get("queued", 0))


@router.get(
    "/metrics",
    response_class=Response,
    responses={200: {"content": {"text/plain": {"schema": {"type": "string"}}}}},
)
def show_metrics(request: Request) -> Response:
    """Return figures in the text format of Prometheus: jobs by state, age of the queue, workers, times of requests."""
    metrics: Metrics = request.app.state.metrics
    return Response(metrics.text(), media_type=CONTENT_TYPE_LATEST)
