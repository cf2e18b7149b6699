"""Bookmarked designs of a front; earlier stores have none."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"

_NUMBER = sa.BigInteger().with_variant(sa.Integer, "sqlite")


def upgrade() -> None:
    """Create their table."""
    op.create_table(
        "kept",
        sa.Column("job", _NUMBER, nullable=False),
        sa.Column("number", sa.Integer, nullable=False),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("note", sa.Text, nullable=False),
        sa.Column("star", sa.Boolean, nullable=False),
        sa.Column("decided", sa.Boolean, nullable=False),
        sa.Column("reason", sa.Text, nullable=False),
        sa.Column("design", sa.Integer),
        sa.Column("variant", sa.Integer, nullable=False),
        sa.Column("dimensions", sa.Text, nullable=False),
        sa.Column("at", sa.Double, nullable=False),
        sa.ForeignKeyConstraint(["job"], ["jobs.id"], name="fk_kept_job", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("job", "number", name="pk_kept"),
    )
