"""Wishes that people made on a front; earlier stores have none."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"

_NUMBER = sa.BigInteger().with_variant(sa.Integer, "sqlite")


def upgrade() -> None:
    """Create their table."""
    op.create_table(
        "wishes",
        sa.Column("job", _NUMBER, nullable=False),
        sa.Column("number", sa.Integer, nullable=False),
        sa.Column("wishes", sa.Text, nullable=False),
        sa.Column("design", sa.Integer),
        sa.Column("at", sa.Double, nullable=False),
        sa.ForeignKeyConstraint(["job"], ["jobs.id"], name="fk_wishes_job", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("job", "number", name="pk_wishes"),
    )
