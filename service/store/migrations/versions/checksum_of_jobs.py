"""Checksums of results with their jobs; those without are forgotten, and such results are read without."""

from __future__ import annotations

from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    """Forget the checksums that do not cover the job."""
    op.execute("UPDATE jobs SET checksum = NULL")
