"""The contract of the search: what it accepts, how it reports, how it stops."""

from __future__ import annotations

import itertools
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest

from slidercrank.model.arrays import Array
from slidercrank.model.errors import InputError
from slidercrank.model.kernel.batches import poll_interruption
from slidercrank.model.machine.links_and_joints import Bar
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.methods.auto import partial_front
from slidercrank.optimise.problem.requirements import Sense
from slidercrank.optimise.search.candidates import COVERED
from slidercrank.optimise.solve import solve

from .problems import MACHINE, Bounds, degrees, problem

HELD: dict[str, Bounds] = {"stroke": 0.2, "transmission_angle": (degrees(35.0), None)}
WISHES: dict[str, Sense] = {
    "peak_torque": "minimise",
    "time_ratio": "maximise",
    "position_error": "minimise",
    "transmission_angle": "maximise",
    "footprint": "minimise",
}


@pytest.mark.usefixtures("little")
@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_any_number_of_objectives(count: int) -> None:
    front = solve(problem(dict(itertools.islice(WISHES.items(), count)), HELD))
    assert front.status == "done"
    assert len(front) == (1 if count == 1 else 16)
    assert front.values.shape == (len(front), count)
    assert 0.0 < front.hypervolume <= 1.0
    assert (front.designs["residual"] <= 1e-6).all()


@pytest.mark.usefixtures("little")
def test_progress_counts_up_and_is_kept() -> None:
    seen: list[Progress] = []
    front = solve(problem({"peak_torque": "minimise", "time_ratio": "maximise"}, HELD), progress=seen.append)
    assert len(seen) == len(front.history)
    assert [entry.round for entry in seen] == list(range(1, len(seen) + 1))
    assert all(one.evaluations <= two.evaluations for one, two in itertools.pairwise(seen))
    assert {entry.stage for entry in seen} >= {"sampling", "zooming", "polishing"}


def test_cancelling_while_kernels_are_waited_for_gives_a_front_without_designs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slidercrank.optimise.solve.require_finite", lambda *_: poll_interruption())
    front = solve(problem(WISHES), cancelled=lambda: True)
    assert (front.status, len(front), front.evaluations) == ("cancelled", 0, 0)


@pytest.mark.usefixtures("little")
@pytest.mark.parametrize("after", [1, 2, 4, 6])
def test_cancelling_keeps_what_was_found(after: int) -> None:
    rounds: list[Progress] = []
    front = solve(
        problem({"peak_torque": "minimise", "time_ratio": "maximise"}, HELD),
        progress=rounds.append,
        cancelled=lambda: len(rounds) >= after,
    )
    assert front.status == "cancelled"
    assert "cancelled" in front.message
    assert len(front) > 0
    assert len(rounds) <= after + 1


@pytest.mark.usefixtures("little")
def test_cancelling_in_the_polish_keeps_every_design_shown_or_a_better_one(monkeypatch: pytest.MonkeyPatch) -> None:
    for limit in ("_LEAST", "_MOST_SECONDS"):
        monkeypatch.setattr(partial_front, limit, 200.0)  # however busy the machine is
    shown: list[Array] = []
    stages: list[str] = []
    front = solve(
        problem({"peak_torque": "minimise", "time_ratio": "maximise"}, HELD, designs=1000, samples=1024),
        progress=lambda at: stages.append(at.stage),
        fronts=shown.append,
        cancelled=lambda: stages.count("polishing") >= 3,  # once the extreme designs are polished
    )
    assert front.status == "cancelled"
    assert len(shown[-1]) > 20
    tolerance = COVERED * np.ptp(shown[-1], axis=0)
    excess = (front.values[None] - shown[-1][:, None] - tolerance).max(axis=2).min(axis=1)
    assert (excess <= 0.0).all()


@pytest.mark.slow
def test_a_process_with_one_core_gives_the_same_front_bit_for_bit() -> None:
    if not hasattr(os, "sched_setaffinity"):
        pytest.skip("this system cannot bind a process to one core")
    code = (
        "import os, sys; os.sched_setaffinity(0, {sorted(os.sched_getaffinity(0))[0]});"
        "import pickle; from slidercrank import solve;"
        "sys.stdout.buffer.write(solve(pickle.load(sys.stdin.buffer)).dimensions.tobytes())"
    )
    given = problem({"peak_torque": "minimise", "time_ratio": "maximise"}, HELD)
    command = [sys.executable, "-c", code]
    finished = subprocess.run(command, input=pickle.dumps(given), check=True, stdout=subprocess.PIPE)
    assert finished.stdout == solve(given).dimensions.tobytes()


@pytest.mark.usefixtures("little")
def test_constraints_on_peaks_hold_exactly_and_bind() -> None:
    wishes: dict[str, Sense] = {"time_ratio": "maximise", "peak_torque": "minimise"}
    free = solve(problem(wishes, HELD, samples=2048))
    limit = float(np.median(free.designs["peak_pivot_force_N"]))
    limited = solve(problem(wishes, HELD | {"peak_pivot_force": (None, limit)}, samples=2048))
    forces = QUANTITIES["peak_pivot_force"].evaluate(MACHINE, limited.dimensions).values
    assert forces.max() <= limit * (1.0 + 1e-8)
    assert forces.max() == pytest.approx(limit, rel=1e-6)
    assert "slack_peak_pivot_force_N" in limited.designs


def test_a_target_is_met_where_it_can_be() -> None:
    front = solve(problem({"time_ratio": 1.15}, HELD))
    assert front.designs["time_ratio"][0] == pytest.approx(1.15, abs=1e-8)


def test_all_dimensions_given_leave_one_design() -> None:
    wishes: dict[str, Sense] = {"peak_torque": "minimise", "time_ratio": "maximise"}
    front = solve(problem(wishes, crank=0.1, rod=0.3, offset=0.05))
    assert front.dimensions.tolist() == [[0.1, 0.3, 0.05]]


@pytest.mark.usefixtures("little")
def test_an_equality_that_no_rule_eliminates_is_met_by_the_solver() -> None:
    front = solve(problem({"transmission_angle": "maximise"}, {"stroke": 0.2, "peak_slider_speed": 4.0}))
    speed = QUANTITIES["peak_slider_speed"].evaluate(MACHINE, front.dimensions).values
    assert speed == pytest.approx(np.array([4.0]), rel=1e-8)


@pytest.mark.usefixtures("little")
def test_direction_of_rotation_matters_when_the_strokes_are_loaded_differently() -> None:
    bar = Bar(width=0.03, depth=0.02, density=7800.0)

    def best(speed: float) -> float:
        load = StrokeForce(outward=-900.0, inward=0.0)
        mechanism = Mechanism(speed=speed, crank=bar, rod=bar, slider_mass=1.0, loads=(load,))
        given = problem({"peak_torque": "minimise"}, {"stroke": 0.2, "time_ratio": 1.3}, mechanism=mechanism)
        return float(solve(given).designs["peak_torque_Nm"][0])

    # With a positive offset the outward stroke is the slow one clockwise: pushing slowly takes less torque.
    assert best(-2.0) < best(2.0)


def test_no_crank_turns_fully() -> None:
    front = solve(problem({"transmission_angle": "maximise"}, crank=(0.15, 0.2), rod=(0.06, 0.1)))
    assert front.status == "infeasible"
    assert "no crank rotates fully" in front.message


def test_tables_of_a_job_are_no_problem_yet() -> None:
    with pytest.raises(InputError, match="solve needs a problem; got dict; make one with problem or load_job"):
        solve({})  # type: ignore[arg-type]


@pytest.mark.usefixtures("little")
def test_a_bar_shows_a_search_and_leaves_the_front_as_it_is(capsys: pytest.CaptureFixture[str]) -> None:
    given = problem({"peak_torque": "minimise", "time_ratio": "maximise"}, {"stroke": 0.2}, designs=8, samples=128)
    silent = solve(given)
    assert capsys.readouterr().err == ""
    shown = solve(given, progress=True)
    told = capsys.readouterr().err
    assert "feasible, hypervolume" in told
    assert "polishing" in told
    assert shown.designs.equals(silent.designs)
