"""Mountings of a cylinder."""

from __future__ import annotations

from typing import Literal

Mounting = Literal["clevis", "trunnion"]
