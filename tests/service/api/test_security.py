"""Who is let in, and which requests are refused before anything reads them."""

from __future__ import annotations

import logging
import os
import socket
from pathlib import Path

import httpx
import pytest

from slidercrank.objectives.units import quote
from slidercrank.service.api.job_requests import EXAMPLE
from slidercrank.service.store import Artefact, Store
from tests.service.api.conftest import Serve
from tests.service.api.serving import TOKEN, refusal_sentence
from tests.service.store.contents import add

RIGHT = {"Authorization": f"Bearer {TOKEN}"}


@pytest.mark.parametrize("host", ["attacker.example", "127.0.0.1.attacker.example", "localhost.:80", ""])
def test_a_foreign_host_is_refused(guarded: httpx.Client, host: str) -> None:
    response = guarded.get("/jobs", headers={"Host": host, **RIGHT})
    assert "called by one of its names" in refusal_sentence(response, 403)


@pytest.mark.parametrize("host", ["127.0.0.1", "LOCALHOST:8000", "localhost", "[::1]:80"])
def test_every_name_of_this_machine_is_known(guarded: httpx.Client, host: str) -> None:
    assert guarded.get("/jobs", headers={"Host": host, **RIGHT}).status_code == 200


def test_the_operator_gives_the_service_other_names(serve: Serve) -> None:
    client = serve(hosts=("jobs.example",))
    assert client.get("/jobs", headers={"Host": "jobs.example:8443"}).status_code == 200
    refusal_sentence(client.get("/jobs"), 403)


@pytest.mark.parametrize("origin", ["http://attacker.example", "null", "http://127.0.0.1:1", "file://", "http://["])
def test_a_foreign_origin_is_refused_even_with_the_token(guarded: httpx.Client, origin: str) -> None:
    for method in ("GET", "POST", "DELETE"):
        response = guarded.request(method, "/jobs/1", headers={"Origin": origin, **RIGHT})
        assert "pages of other sites may not" in refusal_sentence(response, 403)


def test_its_own_origin_is_let_in(guarded: httpx.Client) -> None:
    own = f"http://127.0.0.1:{guarded.base_url.port}"
    assert guarded.get("/jobs", headers={"Origin": own, **RIGHT}).status_code == 200


@pytest.mark.parametrize(
    "given",
    ["", "Bearer", f"Bearer {TOKEN}x", f"Bearer {TOKEN[:-1]}", f"Basic {TOKEN}", TOKEN, "Bearer \xe9"],
)
def test_a_missing_or_wrong_token_is_refused(guarded: httpx.Client, given: str) -> None:
    headers = [(b"Authorization", given.encode("latin-1"))] if given else []
    for path in ("/jobs", "/metrics", "/health/ready", "/openapi.json", "/nothing", "/jobs/1/events"):
        response = guarded.get(path, headers=headers)
        assert "must carry the token" in refusal_sentence(response, 401)
        assert response.headers["www-authenticate"] == "Bearer"


def test_only_the_sign_of_life_needs_no_token(guarded: httpx.Client) -> None:
    assert guarded.get("/health/live").json() == {"status": "live"}


def root(client: httpx.Client) -> str:
    """Return the address that a browser opens."""
    return f"http://127.0.0.1:{client.base_url.port}/"


def test_the_printed_address_lets_a_browser_in_and_hides_the_token(guarded: httpx.Client) -> None:
    refusal_sentence(guarded.get(root(guarded)), 401)
    response = guarded.get(root(guarded), params={"token": TOKEN})
    assert response.status_code == 303
    assert response.headers["location"] == "/"
    assert response.headers["referrer-policy"] == "no-referrer"
    cookie = response.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=strict" in cookie
    assert TOKEN not in cookie
    session = guarded.cookies[cookie.partition("=")[0]]
    refusal_sentence(httpx.get(f"{guarded.base_url}jobs", headers={"Authorization": f"Bearer {session}"}), 401)
    assert guarded.get("/jobs").status_code == 200  # by the cookie that the client has now
    assert guarded.get(root(guarded)).status_code == 200


@pytest.mark.parametrize("token", ["", "wrong", f"{TOKEN}&token={TOKEN}"])
def test_an_address_with_another_token_sets_no_cookie(guarded: httpx.Client, token: str) -> None:
    response = guarded.get(f"{root(guarded)}?token={token}")
    refusal_sentence(response, 401)
    assert "set-cookie" not in response.headers


def test_a_cookie_of_another_service_on_this_machine_does_not_count(serve: Serve, guarded: httpx.Client) -> None:
    other = serve(token="another-long-random-text")
    set_by_other = other.get(root(other), params={"token": "another-long-random-text"}).cookies
    guarded.cookies.update(set_by_other)
    refusal_sentence(guarded.get("/jobs"), 401)
    guarded.get(root(guarded), params={"token": TOKEN})
    guarded.cookies.update(set_by_other)
    assert guarded.get("/jobs").status_code == 200, "both are sent by a browser; neither hides the other"


def test_browsers_are_told_to_show_keep_and_embed_nothing(guarded: httpx.Client) -> None:
    for response in (
        guarded.get("/jobs", headers=RIGHT),
        guarded.get("/jobs"),
        guarded.get("/jobs", headers={"Host": "x"}),
    ):
        assert response.headers["x-content-type-options"] == "nosniff"
        assert response.headers["x-frame-options"] == "DENY"
        assert response.headers["cache-control"] == "no-store"
        assert "default-src 'none'" in response.headers["content-security-policy"]
        assert "access-control-allow-origin" not in response.headers


@pytest.mark.parametrize(
    "name", ["../../etc/passwd", "..%2F..%2Fetc%2Fpasswd", "%2Fetc%2Fpasswd", "..", "%2e%2e%2fstore.db", "..\\store.db"]
)
def test_a_name_of_a_file_leads_nowhere_else(shared: httpx.Client, name: str) -> None:
    assert b"secret" in shared.get("/jobs/1/files/job.toml").content
    with socket.create_connection(("127.0.0.1", shared.base_url.port or 0)) as raw:  # httpx would tidy the path up
        path = f"/api/v1/jobs/1/files/{name}"
        raw.sendall(f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
        answer = b"".join(iter(lambda: raw.recv(65536), b""))
    assert answer.startswith((b"HTTP/1.1 404", b"HTTP/1.1 422")), answer
    assert b"secret" not in answer
    assert b"root:" not in answer


def test_a_file_is_saved_and_not_shown(client: httpx.Client, store: Store) -> None:
    job = add(store, files=[Artefact(name='a"b\r\n.html', media_type="text/html", content=b"<script>")])
    response = client.get(f"/jobs/{job.id}/files/a%22b%0D%0A.html")
    assert response.content == b"<script>"
    assert response.headers["content-disposition"] == 'attachment; filename="a_b__.html"'


def test_what_goes_wrong_unexpectedly_is_logged_and_not_shown(
    client: httpx.Client, store: Store, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def broken(number: int) -> None:
        raise RuntimeError(f"the password of job {number} is secret")

    monkeypatch.setattr(store, "job", broken)
    with caplog.at_level(logging.ERROR):
        response = client.get("/jobs/1")
    assert "secret" not in refusal_sentence(response, 500)
    assert "the password of job 1 is secret" in caplog.text
    assert response.headers["x-content-type-options"] == "nosniff"


def test_a_store_deleted_or_replaced_while_it_is_served_is_noticed_at_once(
    client: httpx.Client, store: Store, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    assert client.post("/jobs", json={"job": EXAMPLE}).status_code == 201
    file = tmp_path / "store.db"
    away = file.rename(tmp_path / "away.db")
    assert "was deleted, moved or replaced" in refusal_sentence(client.get("/health/ready"), 503)
    refusal_sentence(client.post("/jobs", json={"job": EXAMPLE}), 503)
    assert not file.exists(), "no empty one is made in its place"
    assert caplog.text.count("was deleted, moved or replaced") == 1, "told once, not at every request"
    file.touch()
    refusal_sentence(client.get("/jobs"), 503)
    away.replace(file)
    assert client.get("/jobs/1").json()["state"] == "queued"


def test_a_store_that_may_no_longer_be_written_is_noticed_and_used_again_once_it_may(
    client: httpx.Client, tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "store.db"
    # Of root, too, the bits of the file count here.
    monkeypatch.setattr(os, "access", lambda path, _mode: Path(path).stat().st_mode & 0o600 == 0o600)
    assert client.get("/health/ready").status_code == 200
    for mode in (0o400, 0o000):
        file.chmod(mode)
        for _ in range(3):
            sentence = refusal_sentence(client.get("/health/ready"), 503)
            refusal_sentence(client.post("/jobs", json={"job": EXAMPLE}), 503)
        assert f"is no longer; chmod u+rw {file}" in sentence
        assert caplog.text.count("must stay readable and writable") == 1
        file.chmod(0o600)
        assert client.get("/health/ready").status_code == 200


def test_a_function_that_is_no_text_is_refused(serve: Serve) -> None:
    for allowed in ((), ("own:jerk",)):
        client = serve(allowed_quantities=frozenset(allowed))
        functions: list[object] = [["os:system"], {"os": 1}, None, 1, True, {}, [[]]]
        for function in functions:
            job = {**EXAMPLE, "quantity": {"x": {"function": function}}}
            for path in ("/jobs", "/check"):
                sentence = refusal_sentence(client.post(path, json={"job": job}), 422)
                assert sentence.startswith("quantity.x.function: must "), sentence
                assert f"got {quote(function)}; " in sentence


def test_a_database_that_is_gone_is_told_with_when_to_come_again(
    client: httpx.Client, store: Store, tmp_path: Path
) -> None:
    store.close()
    for file in tmp_path.iterdir():
        file.unlink()
    for path in ("/jobs", "/jobs/1", "/health/ready", "/metrics"):
        response = client.get(path)
        assert "was deleted, moved or replaced" in refusal_sentence(response, 503)
        assert int(response.headers["retry-after"]) > 0
    assert client.get("/health/live").status_code == 200


def test_submissions_beyond_the_rate_are_told_when_to_come_again(serve: Serve, store: Store) -> None:
    client = serve(submissions_per_minute=2)
    answers = [client.post("/jobs", json={"job": EXAMPLE}) for _ in range(3)]
    assert [answer.status_code for answer in answers] == [201, 201, 429]
    assert "at most 2 jobs" in refusal_sentence(answers[2], 429)
    assert 1 <= int(answers[2].headers["retry-after"]) <= 30
    assert client.get("/jobs").status_code == 200, "reading goes on"
    refusal_sentence(client.post("/jobs/1/clone", json={}), 429)
    assert store.count_by_state() == {"queued": 2}
