"""Notes on content of a job that is allowed, yet often not meant: told, not refused."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from .model import Job, job_with
from .own import declared
from .plain_numbers import plain_numbers

_MOST = 6  # plain numbers that are told one by one
_OF_GAS = "compression_exponent", "expansion_exponent"
_SPEED_WORDS = {"speed": "speed", "cycle_time": "time", "strokes_per_minute": "strokes", "direction": "direction"}


def notes_of(data: Mapping[str, Any]) -> list[str]:
    """Return notes on the tables of a valid job, each a sentence: plain numbers, masses without gravity, screening.

    And on a speed and tables that a swing does not have, and exponents of a liquid. What probably is another machine
    than the one meant is among the warnings of the problem instead.
    """
    model = job_with(declared(data, allowed=True))
    job = model.model_validate(data)
    told = [item.note for item in plain_numbers(model, data) if not item.warning]
    notes = []
    if told:
        more = f", and {len(told) - _MOST} more" if len(told) > _MOST else ""
        notes.append(f"a number without a unit is in SI: {', '.join(told[:_MOST])}{more}")
    notes += [
        f"{part.name}: of {part.rows} rows of the file {len(part.option)} {'is' if len(part.option) == 1 else 'are'} "
        "solved; each of the others is beaten in every limit, or equalled, by one of these"
        for part in job.choice
        if part.rows is not None and part.rows > len(part.option)
    ]
    machine = job.machine()
    moving = machine.crank, machine.rod
    if job.mechanism.gravity is None and (machine.slider_mass or any(getattr(link, "mass", 1.0) for link in moving)):
        notes.append(
            'masses are given but no gravity, so that nothing weighs; add gravity = "9.81 m/s^2", or gravity = 0'
        )
    notes += _pins(job)
    if job.motion.build() is not None:
        notes += [
            f"mechanism.{key}: a swing follows [motion] instead; leave out the {words}"
            for key, words in _SPEED_WORDS.items()
            if getattr(job.mechanism, key) is not None
        ]
        notes += [
            f"{name}: it is of a crank that turns through, and says nothing of a swing; leave it out"
            for name in ("drive", "clearance")
            if name in job.model_fields_set
        ]
    for k, load in enumerate(data.get("load", ()), start=1):
        idle = [key for key in _OF_GAS if key in load and load.get("medium") == "liquid"]
        if idle:
            notes.append(f"load #{k}: a liquid is not compressed: no use of {' and '.join(idle)}; leave it out")
    return notes


def _pins(job: Job) -> list[str]:
    """Return notes on pins that rub at another radius than [sections] has them, or that vary while that stays."""
    notes: list[str] = []
    if job.sections is None:
        return notes
    for name in type(job.sections.pins).model_fields:
        rubs, diameter = getattr(job.friction, name), getattr(job.sections.pins, name)
        radius = None if rubs is None else rubs.radius
        if radius is None:
            continue
        path = f"sections.pins.{name}"
        varies = path in job.variables.paths or any(path in of.paths for part in job.choice for of in part.option)
        if varies or not math.isclose(2.0 * radius, diameter, rel_tol=1e-6):
            notes.append(
                f"friction.{name}.radius: stays {1e3 * radius:.6g} mm, while {path} "
                f"{'varies' if varies else f'is a diameter of {1e3 * diameter:.6g} mm'}; leave the radius out, and it "
                "is half of that"
            )
    return notes
