"""The shipped jobs: the files of runs/, which every installation carries."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any


@dataclass(frozen=True)
class Preset:
    """A shipped job. name: of its file. title, sentence: what it is. job: its tables, not to be changed."""

    name: str
    title: str
    sentence: str
    job: Mapping[str, Any]


@cache
def presets() -> tuple[Preset, ...]:
    """Return the shipped jobs by name."""
    found = [file for file in files(__package__).iterdir() if file.name.endswith(".toml")]
    return tuple(
        _preset(file.name.removesuffix(".toml"), tomllib.loads(file.read_text(encoding="utf-8")))
        for file in sorted(found, key=lambda file: file.name)
    )


def _preset(name: str, job: dict[str, Any]) -> Preset:
    return Preset(name, job["name"], job.get("description", ""), job)
