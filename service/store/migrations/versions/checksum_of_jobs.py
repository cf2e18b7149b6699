"""Checksums of results and their jobs; older checksums are dropped, and such results are read without checks."""

from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    """Drop the checksums that do not cover the job."""
    op.execute("UPDATE jobs SET checksum = NULL")
