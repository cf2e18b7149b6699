"""Indicator diagram of the cylinders: numbers, text and figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..design_question import DesignQuestion, Premise

if TYPE_CHECKING:
    from ....model.machine.mechanism import Mechanism
    from ....optimise.problem.problem import Problem


def _has_cylinder(_: Problem, machine: Mechanism) -> bool:
    from ....model.cycle.gas_work import cylinder_loads

    return bool(cylinder_loads(machine))


QUESTION = DesignQuestion(
    __name__,
    45,
    "cylinder pressure against volume and crank angle, valve events",
    title="Cylinder pressures",
    premise=Premise("a cylinder with pressure", _has_cylinder),
)
