"""Designs that pass a swing: many at once against each one alone."""

from __future__ import annotations

import math

import numpy as np

from slidercrank.model.errors import SlidercrankError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.swing.closure import swings_without_dead_point
from slidercrank.model.swing.swing import Swing, require_swing
from slidercrank.model.swing.swing_types import Driver


def test_designs_pass_where_each_alone_is_taken() -> None:
    """Swings up to a turn have up to two dead points, and designs need not turn through."""
    random, ends = np.random.default_rng(17), {True: 0, False: 0}
    for _ in range(60):
        start, span = random.uniform(-math.pi, math.pi), random.uniform(0.1, 6.2) * random.choice([-1.0, 1.0])
        branch: Branch = "open" if random.random() < 0.5 else "crossed"
        driver: Driver = "slider" if random.random() < 0.8 else "crank"
        swing = Swing(start=start, end=start + span, driver=driver)
        designs = np.column_stack(
            [random.uniform(0.5, 1.5, 40), random.uniform(0.5, 3.0, 40), random.uniform(-0.8, 0.8, 40)]
        )
        found = swings_without_dead_point(Mechanism(branch=branch), swing, designs)
        for (crank, rod, offset), passed in zip(designs, found.tolist(), strict=True):
            try:
                require_swing(Mechanism(branch=branch), Linkage(crank, rod, offset, branch), swing)
                alone = True
            except SlidercrankError:
                alone = False
            assert passed == alone, (swing, crank, rod, offset, branch)
            ends[alone] += 1
    assert min(ends.values()) > 200
