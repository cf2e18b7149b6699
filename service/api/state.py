"""Objects of the application that its requests use: the store and the settings."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request

from ..store import Store
from .settings import Settings


async def _store(request: Request) -> Store:
    store: Store = request.app.state.store
    return store


async def _settings(request: Request) -> Settings:
    settings: Settings = request.app.state.settings
    return settings


StoreDep = Annotated[Store, Depends(_store)]
"""The store; its calls block, so endpoints that use it are plain functions, which run in a thread of their own."""

SettingsDep = Annotated[Settings, Depends(_settings)]
"""Settings of the API, chosen by its operator."""
