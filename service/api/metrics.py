"""Figures for Prometheus: of the store, looked up when they are asked for, and of the requests served here."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import get_args

from prometheus_client import CollectorRegistry, Histogram, generate_latest
from prometheus_client.core import GaugeMetricFamily
from prometheus_client.registry import Collector
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from ..store import State, Store

_BOUNDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0)


class Metrics(Collector):
    """The figures of one application, in a registry of its own."""

    def __init__(self, store: Store) -> None:
        """Tell of a store."""
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
        """Return nothing, so that registering does not ask the store."""
        return []

    def collect(self) -> Iterator[GaugeMetricFamily]:
        """Yield the figures of the store."""
        counts = self._store.counts()
        jobs = GaugeMetricFamily("slidercrank_jobs", "Jobs in each state", labels=["state"])
        for state in get_args(State):
            jobs.add_metric([state], counts.get(state, 0))
        yield jobs
        wait = self._store.longest_wait()
        yield GaugeMetricFamily("slidercrank_queue_seconds", "How long the oldest job in the queue waits, s", wait)
        yield GaugeMetricFamily("slidercrank_workers", "Workers heard of lately", self._store.workers_at_work())

    def text(self) -> bytes:
        """Return all figures in the text format. Raises `StoreError`."""
        return generate_latest(self._registry)


class Timed:
    """ASGI middleware: takes the time of every request until its answer begins."""

    def __init__(self, app: ASGIApp) -> None:
        """Stand before an application."""
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on and take its time."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        start = time.perf_counter()

        async def timed(message: Message) -> None:
            if message["type"] == "http.response.start":
                # By the name of the endpoint: paths that clients make up must not become series.
                operation = getattr(scope.get("route"), "name", "none")
                method = scope["method"] if operation != "none" else "any"
                metrics: Metrics = scope["app"].state.metrics
                labelled = metrics.requests.labels(operation, method, message["status"])
                labelled.observe(time.perf_counter() - start)
            await send(message)

        await self.app(scope, receive, timed)
