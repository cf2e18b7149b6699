"""Requests to a service, and events of a job: retried if safe; refusals keep the service's wording."""

import json
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any
from urllib.parse import parse_qs, urlsplit

from ...model.errors import InfeasibleError, InputError, NotFound, RunError, ServiceError, SlidercrankError
from ...model.optional_packages import NamingExtra

with NamingExtra("clients of a service need"):
    import httpx

PREFIX = "/api/v1"
_TIMEOUT = 60.0  # s without receiving a byte
_FIRST_PAUSE, _LONGEST_PAUSE = 0.1, 5.0  # s between attempts, doubled each time
_LOOPBACK = ("localhost", "127.0.0.1", "::1")
_NEVER_SENT = (httpx.ConnectError, httpx.ConnectTimeout)
_ENDED, _AWAY = 204, 503
_INFEASIBLE = "infeasible"  # problem type: a valid request, but no feasible design
Record = dict[str, Any]
Event = Record


class Away(ServiceError):
    """Error for a service that is temporarily unavailable."""


class Connection:
    """Connection to a service. Threads may share it."""

    def __init__(self, url: str, token: str | None, patience: float) -> None:
        """Prepare a connection; nothing is sent yet.

        url: "http://host:port", optionally with "?token=...", as the service prints it. patience: time to keep retrying
        a request, s. Raises `InputError` for any other form of address.
        """
        parts = urlsplit(url)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise InputError(
                f"the address of a service must be http://host:port or https://host; got {url[:200]!r}; correct it"
            )
        token = token or next(iter(parse_qs(parts.query).get("token", [])), None)
        # Without the token, since errors show this address.
        self.url = f"{parts.scheme}://{parts.netloc}{parts.path.rstrip('/')}"
        self.patience = patience
        self._http = httpx.Client(
            base_url=f"{self.url}{PREFIX}/",
            headers={} if token is None else {"Authorization": f"Bearer {token}"},
            timeout=_TIMEOUT,
            verify=parts.scheme == "https",  # saves 15 ms for certificates that are not used
            trust_env=parts.hostname not in _LOOPBACK,  # no proxy for this machine
        )

    def close(self) -> None:
        """Close it."""
        self._http.close()

    def request(self, method: str, path: str, *, again: bool, **content: Any) -> httpx.Response:
        """Return the answer to a request. Raises the errors of `error_of_refusal`, or `ServiceError` without an answer.

        again: whether the request may be sent twice. A request that cannot have reached the service is always retried.
        """
        tries = Tries(self)
        while True:
            try:
                response = self._http.request(method, path, **content)
            except httpx.TransportError as error:
                if not (again or isinstance(error, _NEVER_SENT)):
                    raise self.unreachable_error(error) from error
                tries.wait_after_error(error)
                continue
            if response.status_code == _AWAY and again and tries.may_try_again:
                tries.pause()
            elif response.status_code == 404 and method == "DELETE" and tries.made:
                return response  # done by an earlier attempt whose answer was lost
            elif response.is_success:
                return response
            else:
                raise error_of_refusal(response)

    def post(self, path: str, body: Record | None = None, *, again: bool = True, key: str | None = None) -> Record:
        """Return the JSON answer to a request with a body. key: key of a submission."""
        headers = None if key is None else {"Idempotency-Key": key}
        record: Record = self.request("POST", path, again=again, json=body, headers=headers).json()
        return record

    def ask(self, path: str, query: Record | None = None, body: Record | None = None) -> Record:
        """Return the JSON at a path, or the answer to a body posted there."""
        method = "GET" if body is None else "POST"
        record: Record = self.request(method, path, again=True, params=query, json=body).json()
        return record

    def delete(self, path: str) -> None:
        """Delete the resource at a path."""
        self.request("DELETE", path, again=True)

    @contextmanager
    def stream(self, path: str, headers: Mapping[str, str]) -> Iterator[httpx.Response]:
        """Yield the answer to a GET request before its content arrives.

        Raises the errors of httpx and of `error_of_refusal`.
        """
        with self._http.stream("GET", path, headers=dict(headers)) as response:
            if not response.is_success:
                response.read()
                raise error_of_refusal(response)
            yield response

    def unreachable_error(self, error: Exception) -> ServiceError:
        """Return the error for a service that does not respond."""
        return ServiceError(
            f"the service must answer; {self.url} gave: {str(error) or type(error).__name__}; check that "
            "`slidercrank serve` runs there"
        )


class Tries:
    """Attempts of one request, with growing pauses, until patience runs out."""

    def __init__(self, connection: Connection) -> None:
        self.made = 0
        self._connection = connection
        self._end = time.monotonic() + connection.patience

    @property
    def may_try_again(self) -> bool:
        """Whether another attempt is allowed."""
        return time.monotonic() < self._end

    def pause(self) -> None:
        """Wait before the next attempt."""
        time.sleep(min(_LONGEST_PAUSE, _FIRST_PAUSE * 2.0**self.made, max(0.0, self._end - time.monotonic())))
        self.made += 1

    def wait_after_error(self, error: Exception) -> None:
        """Wait before the next attempt after an error. Raises `ServiceError` if patience has run out."""
        if not self.may_try_again:
            raise error if isinstance(error, Away) else self._connection.unreachable_error(error) from error
        self.pause()


def error_of_refusal(response: httpx.Response) -> SlidercrankError:
    """Return the exception for a refusal by a service, with the service's sentence.

    `NotFound` for 404, `InputError` for an invalid request, `InfeasibleError` for a valid request without a feasible
    design, `RunError` for a request that the state of a job does not allow. Any other refusal gives a `ServiceError`,
    of which `Away` is temporary.
    """
    kind = None
    try:
        document = response.json()
        detail, kind = str(document["detail"]), document.get("type")
    except (ValueError, KeyError, TypeError, AttributeError):
        detail = f"the service answered {response.status_code} {response.reason_phrase}; see its log"
    if kind == _INFEASIBLE:
        return InfeasibleError(detail)
    kinds: dict[int, type[SlidercrankError]] = {404: NotFound, 409: RunError, _AWAY: Away}
    kinds |= dict.fromkeys((400, 413, 415, 422), InputError)
    return kinds.get(response.status_code, ServiceError)(detail)


def events_until_end(connection: Connection, number: int, after: int) -> Iterator[Event]:
    """Yield the events of a job after a given one as they happen, until the service has no more.

    Each new connection names the last event received, so that none is lost or repeated.
    """
    tries = Tries(connection)
    while True:
        headers = {"Accept": "text/event-stream", "Last-Event-ID": str(after)}
        try:
            with connection.stream(f"jobs/{number}/events", headers) as response:
                if response.status_code == _ENDED:
                    return
                for event in _parse_event_stream(response.iter_lines()):
                    tries = Tries(connection)
                    if event is not None:
                        after = int(event["number"])
                        yield event
        except (httpx.TransportError, Away) as error:
            tries.wait_after_error(error)
        else:
            if tries.made:
                tries.wait_after_error(
                    Away("the events of a job must continue until it ends; the service interrupted them; see its log")
                )
            tries.made += 1


def _parse_event_stream(lines: Iterator[str]) -> Iterator[Event | None]:
    """Yield the data of server-sent events, or None for a keep-alive comment; discard a truncated event.

    WHATWG, HTML standard, 9.2.6.
    """
    data: list[str] = []
    for line in lines:
        if line.startswith(":"):
            yield None
        elif line.startswith("data:"):
            data.append(line.removeprefix("data:").removeprefix(" "))
        elif not line and data:
            yield json.loads("\n".join(data))
            data = []


def without_none(**options: Any) -> Record:
    """Return the options that are not None."""
    return {name: value for name, value in options.items() if value is not None}
