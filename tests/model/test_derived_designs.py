"""Designs derived from raw numbers beforehand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.machine import derived_designs
from slidercrank.model.machine.design import DESIGN, LOAD_ROWS
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.raw_machine_vector import load_structure, raw_vector
from tests.model.cases import MACHINES, random_designs


def unset(shape: tuple[int, ...], dtype: Any = float) -> Any:
    """Return memory as it may be found."""
    return np.full(shape, np.inf, dtype)


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_no_row_is_left_as_the_memory_was(machine: Mechanism, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows that a load does not use are set too: sums over whole blocks warned of random memory there."""
    raw, loads = raw_vector(machine), load_structure(machine)
    rows = DESIGN + LOAD_ROWS * len(loads.kind)
    blocks, steps = unset((2, rows, 1)), unset((6, rows, 1), np.complex128)
    monkeypatch.setattr(derived_designs, "np", SimpleNamespace(empty=unset, zeros=np.zeros, complex128=np.complex128))
    columns, designs = np.arange(3), random_designs(2, seed=12)
    derived_designs._fill_derived_blocks.function(raw, columns, designs, loads.kind, loads.datum, blocks, steps)  # type: ignore[attr-defined]
    assert np.isfinite(blocks).all()
    assert np.isfinite(steps).all()
