"""The recipe of docs/architecture.md, followed: a load in one file acts in the kernels and is known to job files."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from slidercrank.model.machine.loads.load import Entry, Table, load_builder
from slidercrank.model.machine.loads.viscous import Viscous
from tests.recipes import code_of

# Without compilation: the kernels are the same Python functions, and no machine code is made for a load of one test.
FOLLOWED = """
import slidercrank.model.machine.loads as package
package.__path__.append({folder!r})

import numpy as np
from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.work_absorption import may_do_work_over_a_turn
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.optimise.job import parse_job

job = {{
    "name": "press",
    "mechanism": {{"speed": "60 rpm"}},
    "load": [{{"cushion": "50 N", "free_position": "200 mm"}}],
    "variables": {{"crank": "50 mm", "rod": "200 mm", "offset": "30 mm"}},
    "objectives": {{"peak_torque": "minimise"}},
}}
machine = parse_job(job).mechanism
linkage = Linkage(0.05, 0.2, 0.03)
angles = np.linspace(0.0, 2.0 * np.pi, 721)
curves = cycle(machine, linkage, angles)
wanted = -50.0 * ((curves.slider_position - 0.2) / 0.01) ** 3
assert np.abs(curves.load - wanted).max() <= 1e-12 * np.abs(wanted).max()
power = curves.torque * machine.speed + curves.load * curves.slider_velocity
assert np.abs(power).max() <= 1e-12 * np.abs(curves.load * curves.slider_velocity).max()
peak = find_peaks(machine, Signal.TORQUE, np.array([[0.05, 0.2, 0.03]])).values[0, 0]
swept = np.abs(curves.torque).max()
assert swept <= peak <= 1.001 * swept
assert not may_do_work_over_a_turn(machine)
print("followed")
"""


def test_a_load_in_one_file_is_taken_up_by_kernels_and_job_files(pytestconfig: pytest.Config, tmp_path: Path) -> None:
    root = pytestconfig.rootpath
    (tmp_path / "cushion.py").write_text(code_of(root, "A new load"), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", FOLLOWED.format(folder=str(tmp_path))],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout == "followed\n", done.stderr


def test_a_table_whose_build_takes_other_names_is_refused_where_it_is_declared() -> None:
    """Otherwise a job with such a load ends in a TypeError."""
    resistance = Entry("resistance", "Resistance", "force at 1 m/s", "20 N")
    with pytest.raises(ValueError, match="got resistance, which Drag does not take, and no coefficient"):
        Table("resistance", "Drag", "drag", "A drag.", (resistance,), {}, Viscous)
    table = Table(
        "resistance", "Drag", "drag", "A drag.", (resistance,), {}, load_builder(Viscous, resistance="coefficient")
    )
    assert table.build(resistance=20.0) == Viscous(coefficient=20.0)
