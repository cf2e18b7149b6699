"""The client, against a service on loopback: what it asks, what it refuses, and what it does when connections break."""

from __future__ import annotations

import socket
import threading
import time
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from slidercrank.model.errors import InputError, JobError, NotFound, RunError, ServiceError
from slidercrank.service.api import events
from slidercrank.service.api.settings import Settings
from slidercrank.service.client import Client
from slidercrank.service.client.connection import Connection
from slidercrank.service.runs.result import row_from_json
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import Solved, served
from tests.service.store.contents import progress

TABLES = tomllib.loads(fronts.JOB)


@pytest.fixture(scope="module")
def reader(solved: Solved) -> Iterator[Client]:
    """Return a client of its service."""
    with served(solved.store) as address, Client(address) as client:
        yield client


@pytest.fixture
def client(store: Store) -> Iterator[Client]:
    """Return a client of a service of the empty store."""
    with served(store) as address, Client(address) as found:
        yield found


def test_a_job_comes_as_a_file_a_text_or_tables(client: Client, store: Store, tmp_path: Path) -> None:
    file = fronts.job_file(tmp_path)
    numbers = [client.submit(job)["id"] for job in (file, str(file), fronts.JOB, TABLES)]
    assert numbers == [1, 2, 3, 4]
    assert all(store.job_tables(number) == TABLES for number in numbers)


def test_the_points_of_a_target_motion_come_along(client: Client, store: Store, tmp_path: Path) -> None:
    (tmp_path / "wanted.csv").write_text("crank_angle_deg,position_mm\n0,240\n90,200\n180,160\n")
    file = tmp_path / "job.toml"
    file.write_text(f'{fronts.JOB}\n[target_motion]\nfile = "wanted.csv"\n', encoding="utf-8")
    number = client.submit(file)["id"]
    assert len(store.job_tables(number)["target_motion"]["positions"]) == 3


def test_priority_limits_and_key_come_along(client: Client, store: Store) -> None:
    client.submit(TABLES, priority=3, limits={"seconds": 60.0, "evaluations": 1000}, key="mine")
    job = store.job(1)
    assert (job.priority, job.key, job.limits.seconds, job.limits.evaluations) == (3, "mine", 60.0, 1000)
    assert client.submit(TABLES, key="mine")["id"] == 1


def test_jobs_are_listed_shown_changed_and_deleted(client: Client) -> None:
    first, second = client.submit(TABLES)["id"], client.submit({**TABLES, "name": "Another"}, priority=2)["id"]
    assert [job["id"] for job in client.jobs()] == [second, first]
    assert [job["id"] for job in client.jobs(name="nothe", states=["queued"], before=99, limit=5)] == [second]
    assert client.cancel(first)["state"] == "cancelled"
    assert client.resume(first)["state"] == "queued"
    copy = client.clone(second, {"name": "Copy"}, priority=5)
    assert (copy["name"], copy["priority"], client.tables(copy["id"])["name"]) == ("Copy", 5, "Copy")
    client.cancel(first)
    client.delete(first)
    with pytest.raises(NotFound, match="there is no job 1; list the jobs"):
        client.job(first)


def test_refusals_are_exceptions_with_the_sentence_of_the_service(client: Client, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"variables\.crank"):
        client.submit({**TABLES, "variables": {"crank": "long"}})
    with pytest.raises(InputError, match="priority"):
        client.submit(TABLES, priority=5000)
    with pytest.raises(JobError, match="a: must be a line like"):
        client.submit("a =\n")
    with pytest.raises(JobError, match="no such file"):
        client.submit(tmp_path / "none.toml")
    number = client.submit(TABLES)["id"]
    with pytest.raises(RunError, match="has no result: it is queued"):
        client.front(number)
    with pytest.raises(RunError, match="only a cancelled or failed job can continue"):
        client.resume(number)
    with pytest.raises(RunError, match="only a job that has ended can be deleted"):
        client.delete(number)


def test_results_are_read(solved: Solved, reader: Client, tmp_path: Path) -> None:
    number = solved.number
    front = reader.front(number)
    assert (front.designs, front.knee, front.objectives) == (
        [row_from_json(row) for row in solved.store.result(number).record()["designs"]],
        solved.result.knee,
        solved.result.objectives,
    )
    table = reader.designs(number, where=["transmission_angle >= 45 deg"], sort="rod", columns="rod,peak_torque")
    assert list(table.columns) == ["rod_mm", "peak_torque_Nm"]
    assert table["rod_mm"].is_monotonic_increasing
    assert all(solved.result.designs[at - 1]["rod_mm"] == rod for at, rod in table["rod_mm"].items())  # type: ignore[operator]
    knee = reader.pick(number, knee=True)
    assert knee["number"] - 1 == front.knee
    assert reader.analysis(number, 1, show=["motor"])["motor"]
    assert len(reader.curves(number, 1, angles=12)) == 12
    middle = float(reader.curves(number, 1)["slider_position_mm"].mean())
    assert len(reader.inverse(number, 1, position_mm=middle, velocity_m_s=0.5)["solutions"]) == 2
    assert reader.swing(number, 1, start_deg=40.0, end_deg=80.0)["swing_angle_deg"] == pytest.approx(40.0)
    assert "knee" in reader.figures(number)
    assert reader.figure(number, "knee", tmp_path / "a.svg").read_bytes().startswith(b"<?xml")
    assert reader.analyse(TABLES, crank="120 mm", rod="400 mm", offset="50 mm")["crank_mm"] == 120.0
    assert reader.check(TABLES)["name"] == TABLES["name"]
    listed = [[row["time_ratio"], row["least_transmission_angle_deg"]] for row in front.designs]
    assert reader.front_points([number, 99]) == [
        {"job": number, "columns": ["time_ratio", "least_transmission_angle_deg"], "points": listed}
    ]
    assert reader.schema()["$schema"].endswith("2020-12/schema")
    with pytest.raises(NotFound, match="no figure 'none'; choose from"):
        reader.figure(number, "none", tmp_path / "b.png")
    with pytest.raises(InputError, match=r"must end in \.csv or \.json or \.parquet"):
        reader.export(number, tmp_path / "front.xls")


def test_a_table_is_read_page_by_page(solved: Solved, reader: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = reader.designs(solved.number, sort="rod")
    monkeypatch.setattr("slidercrank.service.client._PAGE", 3)
    assert reader.designs(solved.number, sort="rod").equals(whole)


def test_a_table_without_designs_keeps_its_columns(solved: Solved, reader: Client) -> None:
    table = reader.designs(solved.number, where=["rod > 99 m"])
    assert len(table) == 0
    assert "rod_mm" in table.columns


def test_the_token_is_sent_but_never_shown(store: Store) -> None:
    with served(store, Settings(token="secret")) as address:
        with Client(address, "secret") as client:
            assert client.jobs() == []
        with Client(f"{address}/?token=secret") as client:
            assert client.jobs() == []
        with Client(address) as client, pytest.raises(ServiceError, match="must carry the token"):
            client.jobs()
    with Client(f"{address}/?token=secret", patience=0.0) as client, pytest.raises(ServiceError) as away:
        client.jobs()
    assert "secret" not in str(away.value)
    assert address in str(away.value)


@pytest.mark.parametrize("url", ["", "localhost:8765", "ftp://x", "http://", "file:///etc/passwd"])
def test_an_address_of_another_kind_is_refused(url: str) -> None:
    with pytest.raises(InputError, match="the address of a service must be http://host:port"):
        Client(url)


def test_a_service_that_comes_late_is_waited_for(store: Store) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    found: list[Any] = []
    with Client(f"http://127.0.0.1:{port}") as client:
        asking = threading.Thread(target=lambda: found.append(client.submit(TABLES)["id"]))
        asking.start()
        time.sleep(0.3)
        with served(store, port=port):
            asking.join()
    assert found == [1]


class Broken(httpx.HTTPTransport):
    """A transport that loses what comes back, the first times."""

    def __init__(self, lost: int) -> None:
        super().__init__()
        self.lost = lost
        self.sent = 0

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        """Send, and perhaps lose the answer."""
        answer = super().handle_request(request)
        self.sent += 1
        if self.sent <= self.lost:
            answer.close()
            raise httpx.ReadError("connection reset")
        return answer


@pytest.fixture
def losing(store: Store, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[int], Client]]:
    """Return a maker of clients that lose their first answers."""
    with served(store) as address:
        made: list[Client] = []

        def lose(count: int) -> Client:
            http = httpx.Client
            monkeypatch.setattr(httpx, "Client", lambda **options: http(**options, transport=Broken(count)))
            made.append(Client(address, patience=2.0))
            return made[-1]

        yield lose
        for client in made:
            client.close()


def test_a_submission_whose_answer_is_lost_makes_one_job(losing: Callable[[int], Client], store: Store) -> None:
    client = losing(2)
    assert client.submit(TABLES)["id"] == 1
    assert len(store.jobs()) == 1


def test_a_deletion_whose_answer_is_lost_is_done(losing: Callable[[int], Client], store: Store) -> None:
    store.submit(TABLES, name="x")
    store.cancel(1)
    losing(1).delete(1)
    assert store.jobs() == []


def test_what_cannot_be_sent_twice_is_not(losing: Callable[[int], Client], store: Store) -> None:
    store.submit(TABLES, name="x")
    store.cancel(1)
    with pytest.raises(ServiceError, match="connection reset"):
        losing(1).resume(1)
    assert store.job(1).state == "queued"


def test_patience_ends(losing: Callable[[int], Client], store: Store) -> None:
    started = time.monotonic()
    with pytest.raises(ServiceError, match="the service must answer"):
        losing(99).jobs()
    assert 1.0 < time.monotonic() - started < 20.0


def follow_events_in_thread(client: Client, number: int, after: int = 0) -> tuple[threading.Thread, list[int]]:
    """Begin to follow the events of a job in a thread."""
    seen: list[int] = []

    def run() -> None:
        seen.extend(event["number"] for event in client.events(number, after=after))

    thread = threading.Thread(target=run)
    thread.start()
    return thread, seen


def rounds(store: Store, count: int) -> int:
    """Have a job of a few rounds, and return how many events it has."""
    claim = store.claim("worker")
    assert claim is not None
    for number in range(count):
        claim.report(progress(number + 1))
        time.sleep(0.03)
    claim.fail("enough", again=False)
    return store.job(claim.job.id).events


def test_events_of_a_resumed_job_end_with_its_last_end(client: Client, store: Store) -> None:
    number = client.submit(TABLES)["id"]
    client.cancel(number)
    client.resume(number)
    thread, seen = follow_events_in_thread(client, number)
    last = rounds(store, 3)
    thread.join(30.0)
    assert seen == list(range(1, last + 1))


def test_events_end_with_the_job(client: Client, store: Store) -> None:
    number = client.submit(TABLES)["id"]
    thread, seen = follow_events_in_thread(client, number)
    last = rounds(store, 5)
    thread.join(30.0)
    assert seen == list(range(1, last + 1))
    assert [event["number"] for event in client.events(number, after=last - 2)] == [last - 1, last]
    assert list(client.events(number, after=last)) == []


def test_events_go_on_where_a_connection_broke(client: Client, store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = Connection.stream
    broken: list[str] = []

    def stream(self: Connection, path: str, headers: Any) -> Any:
        answer = whole(self, path, headers)
        if len(broken) < 4:
            broken.append(headers["Last-Event-ID"])
            return _CutOff(answer)
        return answer

    monkeypatch.setattr(Connection, "stream", stream)
    number = client.submit(TABLES)["id"]
    thread, seen = follow_events_in_thread(client, number)
    last = rounds(store, 10)
    thread.join(30.0)
    assert seen == list(range(1, last + 1))
    assert len(broken) == 4
    assert broken == sorted(broken, key=int)


class _CutOff:
    """An answer that breaks off in the middle of its third event."""

    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def __enter__(self) -> Any:
        self.inner = self.answer.__enter__()
        return self

    def __exit__(self, *error: Any) -> Any:
        return self.answer.__exit__(*error)

    @property
    def status_code(self) -> int:
        """Of the answer."""
        return int(self.inner.status_code)

    def iter_lines(self) -> Iterator[str]:
        """Yield lines until the third event."""
        events = 0
        for line in self.inner.iter_lines():
            events += line.startswith("data:")
            if events == 3:
                yield line[:20]
                raise httpx.RemoteProtocolError("peer closed connection")
            yield line


def test_events_outlast_a_restart_of_the_service(store: Store) -> None:
    with served(store) as address:
        port = int(address.rpartition(":")[2])
        client = Client(address)
        number = client.submit(TABLES)["id"]
        thread, seen = follow_events_in_thread(client, number)
        claim = store.claim("worker")
        assert claim is not None
        while len(seen) < 2:
            time.sleep(0.02)
    claim.report(progress(1))
    with served(store, port=port):
        claim.fail("enough", again=False)
        thread.join(30.0)
        client.close()
    assert seen == [1, 2, 3, 4]


def test_patience_begins_anew_with_every_sign_of_life(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(events, "HEARTBEAT", 0.1)
    with served(store) as address:
        port = int(address.rpartition(":")[2])
        client = Client(address, patience=20.0)
        number = client.submit(TABLES)["id"]
        client._connection.patience = 0.6
        thread, seen = follow_events_in_thread(client, number)
        time.sleep(1.2)  # longer than the patience, and no event
        client._connection.patience = 20.0
        time.sleep(0.5)  # a sign of life, and with it that patience
    with served(store, port=port):
        store.cancel(number)
        thread.join(30.0)
        client.close()
    assert seen == [1, 2]


def test_a_wrong_token_is_no_reason_to_wait(store: Store) -> None:
    job = store.submit(TABLES, name="x")
    started = time.monotonic()
    with (
        served(store, Settings(token="secret")) as address,
        Client(address, "wrong") as client,
        pytest.raises(ServiceError, match="must carry the token"),
    ):
        list(client.events(job.id))
    assert time.monotonic() - started < 15.0


def test_events_of_a_job_that_is_not_there_are_not_found(client: Client) -> None:
    with pytest.raises(NotFound, match="there is no job 9"):
        list(client.events(9))


def test_waiting_ends_with_the_job_or_the_time(client: Client, store: Store) -> None:
    number = client.submit(TABLES)["id"]
    with pytest.raises(ServiceError, match=r"must end within 0\.3 s; it is queued"):
        client.wait(number, seconds=0.3)
    threading.Timer(0.2, store.cancel, (number,)).start()
    assert client.wait(number)["state"] == "cancelled"
