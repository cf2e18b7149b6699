"""The HTTP API of the service."""

from ...model.extras import required

required("fastapi", "the service needs")
