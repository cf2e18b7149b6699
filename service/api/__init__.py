"""The HTTP API of the service."""

from ...model.extras import import_extra

import_extra("fastapi", "the service needs")
