"""Notes on valid content in a job that is often a mistake: reported without an error."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ...model.swing.swing import CRANK_TURN
from ...objectives.kinds import count_with_noun
from ...objectives.registry import FACTS
from ...objectives.units import quote
from .catalogue import Catalogue, with_options
from .custom_quantities import declared_quantities
from .mistake_messages import key_of_location, toml_text
from .model import Job, job_type_with_quantities
from .named_files import SOURCE
from .plain_numbers import read_and_note_plain_numbers

_MOST = 6  # plain numbers to report one by one
_OF_GAS = "compression_exponent", "expansion_exponent"
_SPEED_WORDS = {"speed": "speed", "cycle_time": "time", "strokes_per_minute": "strokes", "direction": "direction"}


def job_notes(data: Mapping[str, Any]) -> list[str]:
    """Return notes on the tables of a valid job, one sentence each: plain numbers, masses without gravity, screening.

    Also on a speed or tables that a swing ignores, and on a liquid's exponents. If signs suggest another machine than
    the intended one, the problem has a warning instead.
    """
    data, tables = with_options(data)
    job, plain = read_and_note_plain_numbers(job_type_with_quantities(declared_quantities(data, allowed=True)), data)
    plain_notes = [item.interpretation_text for item in plain if not item.warning_text]
    notes = []
    if plain_notes:
        left_over = f", and {len(plain_notes) - _MOST} more" if len(plain_notes) > _MOST else ""
        notes.append(f"numbers without a unit are read in SI: {', '.join(plain_notes[:_MOST])}{left_over}")
    notes += [note for table in tables for note in _catalogue_notes(table)]
    notes += [
        f"constraints.{name}: larger is better, but max = {toml_text(bounds['max'])} excludes larger values; for a "
        f"minimum write {{ min = {toml_text(bounds['max'])} }}"
        for name, bounds in data.get("constraints", {}).items()
        if name in FACTS and FACTS[name].better == "high" and isinstance(bounds, Mapping) and set(bounds) == {"max"}
    ]
    machine = job.machine()
    moving = machine.crank, machine.rod
    if job.mechanism.gravity is None and (machine.slider_mass or any(getattr(link, "mass", 1.0) for link in moving)):
        notes.append(
            'masses are given without gravity, so nothing has weight; add gravity = "9.81 m/s^2", or gravity = 0'
        )
    notes += _pin_notes(job)
    if job.swing() not in (None, CRANK_TURN):
        notes += [
            f"mechanism.{key}: a swing is set by [motion] instead; leave out the {words}"
            for key, words in _SPEED_WORDS.items()
            if getattr(job.mechanism, key) is not None
        ]
        notes += [
            f"{name}: only applies to a rotating crank and is ignored for a swing; leave it out"
            for name in ("drive", "clearance")
            if name in job.model_fields_set
        ]
    for k, load in enumerate(data.get("load", ()), start=1):
        idle = [key for key in _OF_GAS if key in load and load.get("medium") == "liquid"]
        if idle:
            notes.append(f"load #{k}: a liquid is not compressed, so it has no {' and '.join(idle)}; leave it out")
    return notes


def _catalogue_notes(table: Catalogue) -> Iterator[str]:
    """Yield notes on catalogue rows that are not searched and why, and on columns that may mean something else."""
    few = [f"{row} to {better}" for row, better in table.lost.items()]
    left = table.rows - len(table.lost) - len(table.excluded)
    has_omissions = bool(table.lost or table.excluded)
    sentences = (
        [f"of {count_with_noun(table.rows, 'row')} {left} {'is' if left == 1 else 'are'} searched"]
        if has_omissions
        else []
    )
    sentences += (
        [f"omitted: {_join_first_of_many([f'{row} ({why})' for row, why in table.excluded.items()])}"]
        if table.excluded
        else []
    )
    if few:
        sentences += [
            f"{'others' if table.excluded else 'the others'} lose in {_join_with_and(table.compared)}: "
            f"{_join_first_of_many(few)}"
        ]
        sentences += ["each design names the smallest row of the catalogue that suffices"]
    sentences += [f"not used, but stored with each design: {_join_with_and(table.idle)}"] if table.idle else []
    if sentences:
        yield f"{table.name}: {'; '.join(sentences)}"
    yield from (
        f"{table.name}: the column {header} is read as {sentences}" for header, sentences in table.added.items()
    )


def _join_with_and(names: Sequence[str]) -> str:
    return ", ".join(names[:-1]) + f" and {names[-1]}" if len(names) > 1 else "".join(names) or "nothing that differs"


def _join_first_of_many(lines: Sequence[str]) -> str:
    return ", ".join(lines[:_MOST]) + (f" and {len(lines) - _MOST} more" if len(lines) > _MOST else "")


def file_summaries(data: Mapping[str, Any]) -> list[str]:
    """Return a summary of each file of a valid job, after its table's key."""
    mechanism = data["mechanism"]
    places: list[tuple[list[object], Any]] = [
        (["mechanism", "speed_profile"], mechanism.get("speed_profile")),
        (["target_motion"], data.get("target_motion")),
        *((["load", n], part) for n, part in enumerate(data.get("load", ()))),
    ]
    return [
        *(
            f"{key_of_location(path)}, {part[SOURCE]}"
            for path, part in places
            if isinstance(part, Mapping) and part.get(SOURCE)
        ),
        *(f"choice {quote(table.name)}: {table.understood}" for table in with_options(data)[1]),
    ]


def _pin_notes(job: Job) -> list[str]:
    """Return notes on pins whose friction radius differs from [sections], or varies while [sections] stays fixed."""
    notes: list[str] = []
    if job.sections is None:
        return notes
    for name in type(job.sections.pins).model_fields:
        rubs, diameter = getattr(job.friction, name), getattr(job.sections.pins, name)
        radius = None if rubs is None else rubs.radius
        if radius is None:
            continue
        path = f"sections.pins.{name}"
        varies = path in job.variables.stated_values_by_path or any(
            path in option.values_by_path for part in job.choice for option in part.option
        )
        if varies or not math.isclose(2.0 * radius, diameter, rel_tol=1e-6):
            how = "varies" if varies else f"is a diameter of {1e3 * diameter:.6g} mm"
            notes.append(
                f"friction.{name}.radius: stays {1e3 * radius:.6g} mm, while {path} {how}; "
                "leave the radius out, and it is half of that"
            )
    return notes
