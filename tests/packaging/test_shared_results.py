"""Results that the workers of the tests share: one computes them, all have the same."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.solve import solve
from tests import shared
from tests.optimise.problems import problem

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs locks of files")

WORKER = """
import sys, time
from pathlib import Path
from tests import shared
shared.folders.append(Path(sys.argv[1]))

def counted(name):
    time.sleep(0.2)  # so that the others come while it computes
    with Path(sys.argv[1], "calls").open("a") as calls:
        calls.write(name)
    return {name: 0.1 + 0.2}

print(shared.computed_once(counted)("first"))
"""


def test_workers_that_ask_at_once_compute_a_result_once(tmp_path: Path, pytestconfig: pytest.Config) -> None:
    command = [sys.executable, "-c", WORKER, str(tmp_path)]
    workers = [
        subprocess.Popen(command, cwd=pytestconfig.rootpath, stdout=subprocess.PIPE, text=True) for _ in range(3)
    ]
    said = [worker.communicate()[0].strip() for worker in workers]
    assert [worker.returncode for worker in workers] == [0, 0, 0]
    assert said == ["{'first': 0.30000000000000004}"] * 3
    assert (tmp_path / "calls").read_text() == "first"


def test_a_front_that_was_read_is_the_one_that_was_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def front_of(name: str) -> ParetoFront:
        return solve(problem({name: "maximise", "footprint": "minimise"}, designs=4, samples=64))

    monkeypatch.setattr(shared, "folders", [tmp_path])
    read, found = shared.computed_once(front_of)("time_ratio"), front_of("time_ratio")
    assert read.problem == found.problem
    for name in ("values", "dimensions"):
        assert getattr(read, name).tobytes() == getattr(found, name).tobytes()
    assert read.designs.equals(found.designs)
