"""The HTTP API of the service."""

from ...model.optional_packages import import_extra

import_extra("fastapi", "the service needs")
