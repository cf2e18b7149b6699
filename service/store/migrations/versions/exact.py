"""Exact designs of a front; fronts of earlier releases have only rows, and are read from these as before."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"

_NUMBER = sa.BigInteger().with_variant(sa.Integer, "sqlite")


def upgrade() -> None:
    """Create their table."""
    op.create_table(
        "exact",
        sa.Column("job", _NUMBER, nullable=False),
        sa.Column("content", sa.LargeBinary, nullable=False),
        sa.ForeignKeyConstraint(["job"], ["jobs.id"], name="fk_exact_job", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("job", name="pk_exact"),
    )
