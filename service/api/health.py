"""Health of the service: whether it answers and is ready for work, and its metrics for Prometheus."""

import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Literal, get_args

from fastapi import APIRouter, Response
from prometheus_client import CONTENT_TYPE_LATEST, CollectorRegistry, Histogram, generate_latest
from prometheus_client.core import GaugeMetricFamily
from prometheus_client.registry import Collector
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from ..store import State, Store
from .models import Count, ResponseModel
from .settings import StoreDep, state_dependency

router = APIRouter(tags=["service"])
_BOUNDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0)


class Live(ResponseModel):
    """The service answers."""

    status: Literal["live"] = "live"


class Ready(ResponseModel):
    """Readiness: the database is available. takes_jobs: whether a worker, idle or busy, sent a recent heartbeat.

    busy: number of workers with a job. waiting: number of jobs without a worker.
    """

    status: Literal["ready"] = "ready"
    takes_jobs: bool
    workers: Count
    busy: Count
    waiting: Count


@router.get("/health/live", openapi_extra={"security": []})
async def show_live() -> Live:
    """Report that the service answers; needs no token."""
    return Live()


@router.get("/health/ready")
def show_ready(store: StoreDep) -> Ready:
    """Report whether the database can be read and written, the number of workers, and the number of waiting jobs."""
    store.require_ready()
    crew = store.count_workers_and_waiting_jobs()
    return Ready(takes_jobs=crew.workers > 0, **vars(crew))


class Metrics(Collector):
    """Metrics of one application, in a separate registry."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._registry = CollectorRegistry(auto_describe=False)
        self._registry.register(self)
        self.requests = Histogram(
            "slidercrank_request_seconds",
            "Time until the first byte of an answer, s",
            ["operation", "method", "status"],
            registry=self._registry,
            buckets=_BOUNDS,
        )

    def describe(self) -> list[GaugeMetricFamily]:
        """Return nothing, so that registering does not query the store."""
        return []

    def collect(self) -> Iterator[GaugeMetricFamily]:
        """Yield the metrics of the store."""
        counts = self._store.count_by_state()
        jobs = GaugeMetricFamily("slidercrank_jobs", "Jobs in each state", labels=["state"])
        for state in get_args(State):
            jobs.add_metric([state], counts.get(state, 0))
        yield jobs
        wait = self._store.longest_wait()
        yield GaugeMetricFamily("slidercrank_queue_seconds", "Waiting time of the oldest job in the queue, s", wait)
        yield GaugeMetricFamily(
            "slidercrank_workers", "Workers heard from recently", self._store.count_present_workers()
        )

    def prometheus_text(self) -> bytes:
        """Return all metrics in the text format. Raises `StoreError`."""
        return generate_latest(self._registry)


@router.get(
    "/metrics",
    response_class=Response,
    responses={200: {"content": {"text/plain": {"schema": {"type": "string"}}}}},
)
def show_metrics(metrics: Annotated[Metrics, state_dependency("metrics")]) -> Response:
    """Return metrics in the Prometheus text format: jobs by state, age of the queue, workers, request times."""
    return Response(metrics.prometheus_text(), media_type=CONTENT_TYPE_LATEST)


@dataclass
class Timed:
    """ASGI middleware: measures the time from each request to the start of its answer."""

    app: ASGIApp

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on and measure its time."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        start = time.perf_counter()

        async def send_timed(message: Message) -> None:
            if message["type"] == "http.response.start":
                # Labelled with the endpoint name: paths invented by clients must not become time series.
                operation = getattr(scope.get("route"), "name", "none")
                method = scope["method"] if operation != "none" else "any"
                metrics: Metrics = scope["app"].state.metrics
                labelled = metrics.requests.labels(operation, method, message["status"])
                labelled.observe(time.perf_counter() - start)
            await send(message)

        await self.app(scope, receive, send_timed)
