"""Sentences and tables of an answer as data: the client selects the units and formats the numbers."""

from collections.abc import Sequence
from typing import Any, Literal

from pydantic import BaseModel, Field

from ...objectives.kinds import Kind, System, unit_text
from ..render.blocks import Block, Part, Phrase, Sentence, Text, Unit, Value, note, sentence
from ..render.formatting import digits_of
from ..runs.result import json_ready

_SYSTEMS: tuple[System, ...] = ("metric", "inch")


class NumberModel(BaseModel):
    """Number in one unit system. digits: significant digits. decimals: digits after the decimal point instead."""

    number: float | Literal["inf", "-inf"] | None = Field(
        description="value; null where it is not defined", examples=[280.0]
    )
    unit: str = Field(examples=["mm"])
    digits: int = Field(examples=[6])
    decimals: int | None = Field(examples=[None])


class NumberPart(BaseModel):
    """Number within a text, in both unit systems. sign: whether a positive number gets a plus sign.

    missing: text for an undefined number.
    """

    metric: NumberModel
    inch: NumberModel
    sign: bool
    missing: str = Field(examples=["undefined"])


class PhrasePart(BaseModel):
    """Unit, or words that name units, in both unit systems."""

    metric: str = Field(examples=["mm"])
    inch: str = Field(examples=["in"])


Parts = list[str | NumberPart | PhrasePart]
"""Text: a sequence of words, numbers and units."""


class ColumnPart(BaseModel):
    """Table column. title: its heading. right: whether it is right-aligned."""

    title: Parts = Field(examples=[["force, ", {"metric": "N", "inch": "lbf"}]])
    right: bool


class AnswerBlock(BaseModel):
    """Sentence, or a table if there are columns.

    style: whether a sentence is a heading, plain text, or a note on the preceding block. rows: cell texts.
    """

    text: Parts = Field([], examples=[["Motor"]])
    style: Literal["heading", "plain", "note"] = "plain"
    columns: list[ColumnPart] = []
    rows: list[list[Parts]] = Field([], examples=[[]])


def block_models(blocks: Sequence[Block], notes: Sequence[str] = ()) -> list[AnswerBlock]:
    """Return blocks as data. notes: sentences to append as notes, without an initial capital or a full stop."""
    note_blocks = (note(f"{text[:1].upper()}{text[1:]}.") for text in notes)
    return [_block_model(text) for text in (*blocks, *note_blocks)]


def sentence_blocks(sentences: Sequence[str]) -> list[AnswerBlock]:
    """Return sentences as data; numbers in them stay as text."""
    return block_models([sentence("{text}", text=text) for text in sentences])


def _block_model(block: Block) -> AnswerBlock:
    if isinstance(block, Sentence):
        return AnswerBlock(text=_text_parts(block.text), style=block.style)
    columns = []
    for column in block.columns:
        title = _text_parts(column.title)
        unit = [] if column.kind is None else [*([", "] if title else []), _unit_part(column.kind)]
        columns.append(ColumnPart(title=[*title, *unit], right=column.right_aligned))
    rows = [[_text_parts(cell, bare=isinstance(cell, Value)) for cell in row] for row in block.rows]
    return AnswerBlock(columns=columns, rows=rows)


def _text_parts(text: Text, *, bare: bool = False) -> Parts:
    parts = text if isinstance(text, tuple) else (text,) if text != "" else ()
    return [_part_model(part, bare) for part in parts]


def _part_model(part: Part, bare: bool) -> str | NumberPart | PhrasePart:
    if isinstance(part, Value):
        return _number_part(part, bare)
    if isinstance(part, Phrase):
        return PhrasePart(metric=part.metric, inch=part.inch)
    return _unit_part(part.kind) if isinstance(part, Unit) else part


def _unit_part(kind: Kind) -> PhrasePart:
    return PhrasePart(**{system: unit_text(kind.display_unit(system).symbol) for system in _SYSTEMS})


def _number_part(value: Value, bare: bool) -> NumberPart:
    def number_in(system: System) -> dict[str, Any]:
        unit_in_system = value.kind.display_unit(system)
        number = None if value.number is None else json_ready(unit_in_system.factor * value.number)
        digits, decimals = digits_of(value, system)
        unit = "" if bare or value.bare else unit_text(unit_in_system.symbol)
        return {"number": number, "unit": unit, "digits": digits, "decimals": decimals}

    return NumberPart(**{system: number_in(system) for system in _SYSTEMS}, sign=value.sign, missing=value.missing)
