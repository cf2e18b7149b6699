"""Mountings of a cylinder."""

from typing import Literal

Mounting = Literal["clevis", "trunnion"]
