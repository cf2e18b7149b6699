"""Answers about a machine are kept for that object and these arguments alone."""

from __future__ import annotations

from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.memoise import memoise_by_machine


def test_an_answer_is_kept_for_the_same_object_and_arguments_alone() -> None:
    asked: list[tuple[float, str, bool]] = []

    @memoise_by_machine
    def answer(mechanism: Mechanism, kind: str, *, whole: bool = True) -> float:
        asked.append((mechanism.speed, kind, whole))
        return mechanism.speed

    first, second, equal = Mechanism(speed=1.0), Mechanism(speed=2.0), Mechanism(speed=2.0)
    for machine in (first, first, second, second, equal, first):
        assert answer(machine, "a") == answer(machine, "a") == machine.speed
    assert asked == [(speed, "a", True) for speed in (1.0, 2.0, 2.0, 1.0)]
    for kind, whole in (("a", False), ("b", True), ("a", False)):
        answer(first, kind, whole=whole)
    assert asked[4:] == [(1.0, "a", False), (1.0, "b", True)]
