"""`slidercrank serve` and `worker`: what they refuse before anything listens."""

from __future__ import annotations

import socket
import sqlite3
from pathlib import Path

import pytest

from slidercrank.model.errors import InputError
from slidercrank.service.api.server import accepted_host_names, browser_url, is_loopback, listening_socket
from slidercrank.service.store import Store
from tests.service.conftest import Command

TOKEN = "0123456789abcdef"


def refusal_sentence(command: Command, *arguments: object) -> str:
    """Return the one sentence by which a command refuses."""
    done = command(*arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith("slidercrank: ")
    assert done.stderr.count("\n") == 1
    return done.stderr


def test_a_port_that_is_taken_is_refused_and_no_store_is_made(command: Command, runs: Path) -> None:
    with listening_socket("127.0.0.1", 0) as taken:
        port = taken.getsockname()[1]
        message = refusal_sentence(command, "serve", "--port", port)
    assert f"127.0.0.1 port {port} gave: Address already in use; choose another one with --port" in message
    assert not runs.exists()


def test_an_address_of_another_machine_is_refused(command: Command) -> None:
    message = refusal_sentence(command, "serve", "--host", "192.0.2.1", "--port", 0)
    assert "the service needs an address of this machine and a free port; 192.0.2.1 port 0 gave:" in message


def test_without_a_token_only_this_machine_is_let_in(command: Command) -> None:
    for host in ("0.0.0.0", "::", "192.168.1.2", "jobs.example.org"):
        message = refusal_sentence(command, "serve", "--no-token", "--host", host)
        assert (
            f"without a token the service may only listen on this machine; got --no-token and --host {host}" in message
        )


@pytest.mark.parametrize("token", ["short", "with spaces in between", "with-ümlauts-in-it", ""])
def test_a_token_that_protects_nothing_is_refused(
    token: str, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "a token must have at least 16 printable ASCII characters" in refusal_sentence(
        command, "serve", "--token", token
    )
    monkeypatch.setenv("SLIDERCRANK_TOKEN", token)
    assert "a token must have at least 16 printable ASCII characters" in refusal_sentence(command, "serve")


def test_a_token_and_none_contradict_each_other(command: Command) -> None:
    assert "--token and --no-token exclude each other; got both" in refusal_sentence(
        command, "serve", "--token", TOKEN, "--no-token"
    )


@pytest.mark.parametrize("name", ["serve", "worker"])
def test_what_is_no_store_is_refused(name: str, command: Command, tmp_path: Path) -> None:
    port = ("--port", 0) if name == "serve" else ()
    (tmp_path / "no.db").write_text("no database")
    assert "file is not a database" in refusal_sentence(command, name, *port, "--store", tmp_path / "no.db")
    assert "a store must be postgresql://" in refusal_sentence(command, name, *port, "--store", "mysql://here/jobs")
    Store(tmp_path / "later.db").close()
    with sqlite3.connect(tmp_path / "later.db") as connection:
        connection.execute("UPDATE alembic_version SET version_num = '9999'")
    connection.close()
    message = refusal_sentence(command, name, *port, "--store", tmp_path / "later.db")
    assert "has version 9999" in message
    assert "install the release that created it" in message


@pytest.mark.parametrize("name", ["serve", "worker"])
def test_limits_that_are_none_are_refused(name: str, command: Command) -> None:
    assert "--most-memory must be an amount of memory" in refusal_sentence(command, name, "--most-memory", "much")
    assert "a limit on seconds must be a positive number" in refusal_sentence(command, name, "--most-seconds", "-1")


def test_the_service_answers_to_the_names_of_this_machine_only() -> None:
    assert accepted_host_names("127.0.0.1") == accepted_host_names("localhost") == ("127.0.0.1", "localhost", "[::1]")
    assert accepted_host_names("10.0.0.5") == ("127.0.0.1", "localhost", "[::1]", "10.0.0.5")
    assert accepted_host_names("0.0.0.0")[-1] == socket.gethostname()
    assert accepted_host_names("fe80::1")[-1] == "[fe80::1]"


def test_the_address_has_the_port_that_was_free_and_the_token_once_it_is_made() -> None:
    with listening_socket("127.0.0.1", 0) as listening:
        port = listening.getsockname()[1]
        assert port > 0
        assert browser_url("127.0.0.1", listening, None) == f"http://127.0.0.1:{port}/"
        assert browser_url("::1", listening, TOKEN) == f"http://[::1]:{port}/?token={TOKEN}"


def test_loopback_is_told_from_other_addresses() -> None:
    assert all(map(is_loopback, ("127.0.0.1", "127.8.9.1", "::1", "localhost")))
    assert not any(map(is_loopback, ("0.0.0.0", "::", "10.0.0.1", "example.org", "localhost.example.org")))


def test_a_name_that_leads_nowhere_is_refused() -> None:
    with pytest.raises(InputError, match="the service needs an address of this machine"):
        listening_socket("no such name", 8765)
