"""Entry point for Alembic: runs the migrations on the connection that `create_or_upgrade_tables` passes to it."""

from alembic import context

context.configure(connection=context.config.attributes["connection"])
context.run_migrations()
