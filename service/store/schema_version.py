"""The version of a store's tables: brought up to date when a store is opened, refused when newer than this software."""

from __future__ import annotations

from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, text

from ...model.errors import StoreError
from .database import Database

LOCK = 0x51C7  # PostgreSQL's advisory lock of whoever changes the tables


def upgrade(database: Database) -> None:
    """Create the tables, or bring those of an earlier release up to date, in one transaction.

    Raises `StoreError` if they are of a later release.
    """
    config = _config()
    scripts = ScriptDirectory.from_config(config)
    latest = scripts.get_current_head()
    with database.reading() as connection:
        if _version(connection) == latest:
            return
    with database.writing() as connection:
        if not database.sqlite:
            connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": LOCK})
        version = _version(connection)
        if version is not None and version not in {script.revision for script in scripts.walk_revisions()}:
            raise StoreError(
                f"the tables of a store must be of this release or an earlier one; {database.name} has version "
                f"{version}, this software knows {latest}; install the release that made it"
            )
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def versions(database: Database) -> tuple[str | None, str | None, bool]:
    """Return the version of the tables, None without any, the one of this software, and whether it knows the first."""
    scripts = ScriptDirectory.from_config(_config())
    with database.reading() as connection:
        version = _version(connection)
    known = version is None or version in {script.revision for script in scripts.walk_revisions()}
    return version, scripts.get_current_head(), known


def _config() -> Config:
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent / "migrations").replace("%", "%%"))
    return config


def _version(connection: Connection) -> str | None:
    return MigrationContext.configure(connection).get_current_revision()
