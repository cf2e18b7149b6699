"""Allowed deviations of bookmarked designs; earlier stores have none."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0009"
down_revision = "0008"


def upgrade() -> None:
    """Add their column."""
    op.add_column("kept", sa.Column("allowed", sa.Text, nullable=False, server_default="{}"))
