"""Version of a store's tables: upgraded when a store is opened, rejected if newer than this software."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from sqlalchemy import Connection, inspect, text

from ...model.errors import StoreError
from .database import Database
from .schema import metadata

if TYPE_CHECKING:
    from alembic.config import Config
    from alembic.script import ScriptDirectory

LATEST = "0009"
"""Table version of this software, so that an up-to-date store opens without Alembic."""
LOCK = 0x51C7  # PostgreSQL advisory lock for changing the tables


def create_or_upgrade_tables(database: Database) -> None:
    """Create the tables, or upgrade those of an earlier release, in one transaction.

    Raises `StoreError` if they come from a later release.
    """
    with database.reading() as connection:
        if _stored_version(connection) == LATEST:
            return
    from alembic import command

    config, scripts = _alembic_config_and_scripts()
    with database.writing() as connection:
        if not database.sqlite:
            connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": LOCK})
        version = _stored_version(connection)
        foreign = _foreign_tables(connection, scripts)
        if foreign:
            raise StoreError(
                f"a store must be a database of its own; {database.name} has tables of another program "
                f"({foreign}); name another one with --store"
            )
        if not _knows_version(scripts, version):
            raise StoreError(
                f"the tables of a store must be of this release or an earlier one; {database.name} has version "
                f"{version}, this release supports {LATEST}; install the release that created it"
            )
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def stored_and_known_version(database: Database) -> tuple[str | None, str | None, bool]:
    """Return the version of the tables (or None), that of this software, and whether this software knows the former."""
    with database.reading() as connection:
        version = _stored_version(connection)
    return version, LATEST, version == LATEST or _knows_version(_alembic_config_and_scripts()[1], version)


def _alembic_config_and_scripts() -> tuple[Config, ScriptDirectory]:
    """Return Alembic's configuration, and the scripts of all versions."""
    from alembic.config import Config
    from alembic.script import ScriptDirectory

    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent / "migrations").replace("%", "%%"))
    return config, ScriptDirectory.from_config(config)


def foreign_tables_text(database: Database) -> str:
    """Return, in words, the tables of a foreign database; empty for a store or an empty database."""
    with database.reading() as connection:
        return _foreign_tables(connection, _alembic_config_and_scripts()[1])


def _foreign_tables(connection: Connection, scripts: ScriptDirectory) -> str:
    version, names = _stored_version(connection), set(inspect(connection).get_table_names())
    if version is not None:
        strangers = set() if "jobs" in names or _knows_version(scripts, version) else names
    else:  # a database on a server may be shared, a file is not
        strangers = names if connection.dialect.name == "sqlite" else names & set(metadata.tables)
    listed = sorted(strangers)[:3]
    return ", ".join(listed) + (" and more" if len(strangers) > 3 else "")


def _knows_version(scripts: ScriptDirectory, version: str | None) -> bool:
    return version is None or version in {script.revision for script in scripts.walk_revisions()}


def _stored_version(connection: Connection) -> str | None:
    if not inspect(connection).has_table("alembic_version"):
        return None
    return connection.execute(text("SELECT version_num FROM alembic_version")).scalar()
