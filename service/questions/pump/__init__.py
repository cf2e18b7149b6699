"""Delivery of a pump or compressor: numbers, text and figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..design_question import DesignQuestion, Premise

if TYPE_CHECKING:
    from ....model.machine.mechanism import Mechanism
    from ....optimise.problem.problem import Problem


def _has_compressor(_: Problem, machine: Mechanism) -> bool:
    from ....model.cycle.gas_work import compressors

    return bool(compressors(machine))


QUESTION = DesignQuestion(
    __name__,
    44,
    "delivered flow of pumps and compressors, its ripple, pressure torque",
    title="Pump flow",
    premise=Premise("a compressor or pump", _has_compressor),
)
