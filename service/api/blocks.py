"""Sentences and tables of an answer as data: the client chooses the units and formats the numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

from pydantic import BaseModel, Field

from ...objectives.kinds import Kind, System, unit_text
from ..render.blocks import Block, Part, Phrase, Sentence, Text, Unit, Value, note, sentence
from ..render.formatting import digits_of
from ..runs.result import json_ready

_SYSTEMS: tuple[System, ...] = ("metric", "inch")


class NumberModel(BaseModel):
    """A number in a system of units. digits: significant ones. decimals: digits after the point instead."""

    number: float | Literal["inf", "-inf"] | None = Field(
        description="value; null where it is not defined", examples=[280.0]
    )
    unit: str = Field(examples=["mm"])
    digits: int = Field(examples=[6])
    decimals: int | None = Field(examples=[None])


class NumberPart(BaseModel):
    """A number within a text, in both systems of units. sign: whether a positive one gets a plus.

    missing: what stands for one that is not defined.
    """

    metric: NumberModel
    inch: NumberModel
    sign: bool
    missing: str = Field(examples=["undefined"])


class PhrasePart(BaseModel):
    """A unit, or words that name units, in both systems."""

    metric: str = Field(examples=["mm"])
    inch: str = Field(examples=["in"])


Parts = list[str | NumberPart | PhrasePart]
"""A text: words, numbers and units, one after the other."""


class ColumnPart(BaseModel):
    """A column of a table. title: its head. right: whether it is aligned to the right."""

    title: Parts = Field(examples=[["force, ", {"metric": "N", "inch": "lbf"}]])
    right: bool


class AnswerBlock(BaseModel):
    """A sentence, or a table where there are columns.

    style: of a sentence: a heading, plain text, or a note on what precedes it. rows: the texts of the cells.
    """

    text: Parts = Field([], examples=[["Motor"]])
    style: Literal["heading", "plain", "note"] = "plain"
    columns: list[ColumnPart] = []
    rows: list[list[Parts]] = Field([], examples=[[]])


def block_models(blocks: Sequence[Block], notes: Sequence[str] = ()) -> list[AnswerBlock]:
    """Return blocks as data. notes: sentences after them, as notes without a capital and a full stop."""
    note_blocks = (note(f"{text[:1].upper()}{text[1:]}.") for text in notes)
    return [_block(text) for text in (*blocks, *note_blocks)]


def sentence_blocks(sentences: Sequence[str]) -> list[AnswerBlock]:
    """Return sentences as data, with unchanged numbers."""
    return block_models([sentence("{text}", text=text) for text in sentences])


def _block(block: Block) -> AnswerBlock:
    if isinstance(block, Sentence):
        return AnswerBlock(text=_parts(block.text), style=block.style)
    columns = []
    for column in block.columns:
        title = _parts(column.title)
        unit = [] if column.kind is None else [*([", "] if title else []), _unit(column.kind)]
        columns.append(ColumnPart(title=[*title, *unit], right=column.right_aligned))
    rows = [[_parts(cell, bare=isinstance(cell, Value)) for cell in row] for row in block.rows]
    return AnswerBlock(columns=columns, rows=rows)


def _parts(text: Text, *, bare: bool = False) -> Parts:
    parts = text if isinstance(text, tuple) else (text,) if text != "" else ()
    return [_part(part, bare) for part in parts]


def _part(part: Part, bare: bool) -> str | NumberPart | PhrasePart:
    if isinstance(part, Value):
        return _number(part, bare)
    if isinstance(part, Phrase):
        return PhrasePart(metric=part.metric, inch=part.inch)
    return _unit(part.kind) if isinstance(part, Unit) else part


def _unit(kind: Kind) -> PhrasePart:
    return PhrasePart(**{system: unit_text(kind.display_unit(system).symbol) for system in _SYSTEMS})


def _number(value: Value, bare: bool) -> NumberPart:
    def number_in(system: System) -> dict[str, Any]:
        unit_in_system = value.kind.display_unit(system)
        number = None if value.number is None else json_ready(unit_in_system.factor * value.number)
        digits, decimals = digits_of(value, system)
        unit = "" if bare or value.bare else unit_text(unit_in_system.symbol)
        return {"number": number, "unit": unit, "digits": digits, "decimals": decimals}

    return NumberPart(**{system: number_in(system) for system in _SYSTEMS}, sign=value.sign, missing=value.missing)
