"""The constant crank speed of a job before validation, for files over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from ...model.errors import InputError
from .crank_speed import SPEED_KEYS, CrankSpeedPart
from .raw_tables import table_in, tables_in
from .variables import paths_set_by_options, stated_variables


def stated_speed(data: Mapping[str, Any], name: str) -> float:
    """Return the constant speed that a job's tables state, rad/s, for a file over time. Raises `InputError`.

    name: file name for messages.
    """
    stated_mechanism = table_in(data, "mechanism")
    varies = {f"mechanism.{key}" for key in SPEED_KEYS} & (set(stated_variables(data)) | paths_set_by_options(data))
    if "speed_profile" in stated_mechanism or stated_mechanism.get("acceleration") or varies:
        raise InputError(f"{name} is given over time, which needs a constant crank speed; give crank angles instead")
    stated = {key: stated_mechanism[key] for key in (*SPEED_KEYS, "direction") if key in stated_mechanism}
    try:
        part = CrankSpeedPart.model_validate(stated)
    except ValidationError:
        stated = {}
    if not stated:
        raise InputError(f"{name} is given over time, which needs the crank speed; got none; give speed in [mechanism]")
    return part.crank_speed(2 if any(load.get("cycle") == "720 deg" for load in tables_in(data, "load")) else 1)
