"""Print the description of the API (OpenAPI), from which the types of the page's modules are made."""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path

from slidercrank.service.api.app import create_app
from slidercrank.service.store import Store

with tempfile.TemporaryDirectory() as folder, Store(Path(folder) / "empty.db") as store:
    json.dump(create_app(store).openapi(), sys.stdout)
