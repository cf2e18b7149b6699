"""Addresses of stores: the database at an address, and its text without secrets."""

import re
from os import PathLike
from pathlib import Path
from urllib.parse import quote

from sqlalchemy import URL, make_url
from sqlalchemy.exc import ArgumentError

from ...model.errors import InputError, StoreError
from ...model.file_name_encoding import path_from_text, path_text

_OPEN = ("host", "port", "dbname", "user", "service", "sslmode", "application_name", "mode", "uri")
_MANGLED = re.compile(r"[^/\\]*:[^\\]+@|postgres\w*:|.*password\s*=", re.IGNORECASE | re.DOTALL)
"""Mangled server address, for example without its scheme; such a text is never taken as a file name."""
HIDDEN = "***"
"""Replaces a password and any address option not known to be harmless, since it may be a secret."""


def without_secrets(text: str) -> str:
    """Return a command-line word without the secrets of an address, even after `--option=`."""
    option, equals, value = text.partition("=") if text.startswith("--") else ("", "", text)
    scheme, server, _ = value.partition("://")
    if not server:
        return f"{option}{equals}{HIDDEN}" if _MANGLED.match(value) else text
    url = _parse_address(value)
    return option + equals + (f"{scheme}://{HIDDEN}" if url is None else address_without_secrets(url))


def _parse_address(text: str) -> URL | None:
    """Return a parsed address with "://"; None if it is unreadable or the end of its password is ambiguous."""
    try:
        url = make_url(text)
    except (ArgumentError, ValueError):
        return None
    after_user = text.partition("://")[2].partition(":")[2]
    return None if url.password is not None and after_user.count("@") > 1 else url


def address_without_secrets(url: URL) -> str:
    """Return an address without its secrets, for output."""
    hidden = {name: value if name in _OPEN else HIDDEN for name, value in url.query.items()}
    text = url.set(query=hidden, database=url.database and path_text(url.database)).render_as_string(hide_password=True)
    return text.replace(quote(HIDDEN), HIDDEN).replace("+psycopg://", "://", 1)


def secrets_of(url: URL) -> list[str]:
    """Return the secret parts of a database address, longest first."""
    values = [value for name, value in url.query.items() if name not in _OPEN]
    secrets = [url.password, *(secret for value in values for secret in ([value] if isinstance(value, str) else value))]
    return sorted({str(secret) for secret in secrets if secret}, key=len, reverse=True)


def url_of(address: str | PathLike[str]) -> URL:
    """Return the database at an address. Raises `InputError` for any other type of database."""
    text = str(address)
    if "://" not in text and not _MANGLED.match(text):
        return URL.create("sqlite", database=str(path_from_text(text)))
    url = _parse_address(text) or URL.create("unreadable")
    scheme = url.drivername.partition("+")[0]
    if scheme in ("postgresql", "postgres"):
        return url.set(drivername="postgresql+psycopg")
    if scheme == "sqlite" and url.database not in (None, "", ":memory:"):
        return url.set(drivername="sqlite", database=str(path_from_text(url.database)))
    raise InputError(
        "a store must be postgresql://user@host/database, sqlite:///file, or the path of a file; got "
        f'{without_secrets(text)}; give one of these, with %40 for each "@" within a password'
    )


def file_of(address: str | PathLike[str]) -> Path | None:
    """Return the file of a store, or None for a server. Raises `InputError` for an invalid address."""
    url = url_of(address)
    return Path(url.database) if url.database and url.get_backend_name() == "sqlite" else None


def store_file_exists(file: Path) -> bool:
    """Whether the file of a store exists.

    Raises `StoreError` if it cannot be such a file, or was deleted or emptied while its write-ahead log remains. SQLite
    would delete the log too, with the latest jobs in it.
    """
    log = Path(f"{file}-wal")
    logged = False
    try:
        logged = log.exists()  # before the size: SQLite writes a new file first, then creates its log
        size = file.stat().st_size
    except FileNotFoundError:
        size = 0
    except OSError as error:
        raise StoreError(
            f"a store must be in a readable folder; {path_text(file)} gave: {error.strerror}; name another file, "
            "or change its permissions"
        ) from None
    if file.exists() and not file.is_file():
        kind = "a folder" if file.is_dir() else "no regular file"
        raise StoreError(f"a store must be a file; {path_text(file)} is {kind}; name a file")
    if logged and not size:
        raise StoreError(
            f"a write-ahead log must have its store beside it; {path_text(log)} belongs to a store that was deleted "
            f"or truncated; put {path_text(file)} back, restore a backup, see docs/service.md, or move the log away"
        )
    return file.is_file()


def has_content(file: Path) -> bool:
    """Whether the file of a store exists and can be inspected.

    Raises `StoreError` for an empty file, and as `store_file_exists` does.
    """
    exists = store_file_exists(file)
    if exists and not file.stat().st_size:
        raise StoreError(
            f"a store to inspect must have tables; {path_text(file)} is an empty file; submit a job to it, or restore "
            "a backup if it had jobs, see docs/service.md"
        )
    return exists
