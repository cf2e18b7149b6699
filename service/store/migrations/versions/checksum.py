"""Checksums of results; those of earlier releases have none, and are read without checks."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"


def upgrade() -> None:
    """Add the column."""
    op.add_column("jobs", sa.Column("checksum", sa.String(128)))
