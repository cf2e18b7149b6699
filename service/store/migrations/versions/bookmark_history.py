"""History of the bookmarks of a front; notes, reasons and decisions of earlier stores become its first entries."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"

_NUMBER = sa.BigInteger().with_variant(sa.Integer, "sqlite")


def upgrade() -> None:
    """Create its table, and record what earlier stores contain."""
    op.create_table(
        "kept_history",
        sa.Column("job", _NUMBER, nullable=False),
        sa.Column("number", sa.Integer, nullable=False),
        sa.Column("bookmark", sa.Integer),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("action", sa.Text, nullable=False),
        sa.Column("text", sa.Text, nullable=False),
        sa.Column("author", sa.Text, nullable=False),
        sa.Column("at", sa.Double, nullable=False),
        sa.ForeignKeyConstraint(["job"], ["jobs.id"], name="fk_kept_history_job", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("job", "number", name="pk_kept_history"),
    )
    for place, (action, text, condition) in enumerate(
        (
            ("note", "note", "note <> ''"),
            ("reason", "reason", "reason <> '' AND NOT decided"),
            ("decided", "reason", "decided"),
        )
    ):
        op.execute(
            "INSERT INTO kept_history (job, number, bookmark, name, action, text, author, at) "
            f"SELECT job, 3 * number + {place}, number, name, '{action}', {text}, '', at FROM kept WHERE {condition}"
        )
