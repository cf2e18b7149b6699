"""The job from which a job was copied and changed; jobs of earlier releases have none."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    """Add the column."""
    op.add_column("jobs", sa.Column("origin", sa.BigInteger().with_variant(sa.Integer, "sqlite")))
