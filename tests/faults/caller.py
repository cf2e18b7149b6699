"""A client of the API: submits jobs one after the other and follows the events of each to its end."""

from __future__ import annotations

import random
import threading

from slidercrank.service.client import Client

from .api_process import TOKEN
from .jobs import KINDS, tables


class Caller:
    """While entered, a thread that calls. seen: numbers of the events of each job. error: what ended it."""

    def __init__(self, url: str, jobs: dict[int, str], seed: int) -> None:
        """Call an API. jobs: where number and kind of each job go."""
        self.seen: dict[int, list[int]] = {}
        self.error: BaseException | None = None
        self._client = Client(url, TOKEN, patience=3600.0)  # it lives for seconds, and comes back after some
        self._jobs = jobs
        self._chance = random.Random(seed)
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._call, name="caller", daemon=True)

    def __enter__(self) -> Caller:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.finish()
        self._client.close()

    def finish(self) -> None:
        """Wait until the job under way has ended."""
        self._end.set()
        self._thread.join(180.0)

    def _call(self) -> None:
        try:
            while not self._end.is_set():
                kind = self._chance.choice(KINDS)
                number = int(self._client.submit(tables(kind))["id"])
                self._jobs[number] = kind
                self._follow(number)
        except Exception as error:  # noqa: BLE001 - whatever it is, the verdict tells it
            self.error = error

    def _follow(self, number: int) -> None:
        seen = self.seen.setdefault(number, [])
        while True:
            seen.extend(int(event["number"]) for event in self._client.events(number, after=seen[-1] if seen else 0))
            job = self._client.job(number)
            if job["state"] != "failed" or "set aside" not in job["reason"]:
                return
            self._client.resume(number)  # its worker was killed too often in a row, which is meant here
