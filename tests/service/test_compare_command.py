"""`slidercrank compare`: what it prints is what the comparison computes, what it draws is what the runs hold."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from slidercrank.model.errors import InputError
from slidercrank.optimise.decisions.price_of_robustness import compare_fronts
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.service.agents.call import Call
from slidercrank.service.agents.server import TOOLS
from slidercrank.service.figures.comparison import MOST_RUNS, PlottedRun, comparison_matrix
from slidercrank.service.runs.result import json_ready, result_of
from slidercrank.service.runs.run_folder import RunFolder
from tests.service import fronts
from tests.service.conftest import Command


def part(rows: slice, seed: int = 1, names: tuple[str, ...] = fronts.FOUR) -> ParetoFront:
    """Return a front of some rows of the usual one."""
    whole = fronts.front(names, designs=30)
    return replace(
        whole,
        columns={name: column[rows] for name, column in whole.columns.items()},
        dimensions=whole.dimensions[rows],
        values=whole.values[rows],
        goals=whole.goals[rows],
        active=whole.active[rows],
        seed=seed,
    )


def keep(runs: Path, name: str, front: ParetoFront, job: Path | None = None) -> str:
    """Keep a front as a run; return its folder's name."""
    with RunFolder(runs, name) as run:
        run.keep_result(result_of(front, str(run.path)), {})
        if job is not None:
            run.keep_files({"job.toml": job.read_bytes()})
    return run.path.name


@pytest.fixture
def names(runs: Path, tmp_path: Path) -> list[str]:
    """Return two runs that share ten designs."""
    job = fronts.job_file(tmp_path)
    return [keep(runs, "one", part(slice(0, 20)), job), keep(runs, "two", part(slice(10, 30), 2))]


def test_json_is_the_comparison(names: list[str], command: Command) -> None:
    record = json.loads(command("compare", *names, "--json").stdout)
    expected = compare_fronts([part(slice(0, 20)).values, part(slice(10, 30)).values])
    assert [run["run"] for run in record["runs"]] == names
    assert [run["method"] for run in record["runs"]] == ["auto", "unknown"]
    assert [run["seed"] for run in record["runs"]] == [1, 2]
    assert [run["designs"] for run in record["runs"]] == [20, 20]
    assert [run["in_union"] for run in record["runs"]] == expected.in_union.tolist()
    assert [run["hypervolume"] for run in record["runs"]] == pytest.approx(expected.hypervolumes, rel=1e-9)
    assert np.array(record["coverage"]) == pytest.approx(expected.coverage, rel=1e-12)
    assert np.array(record["epsilon"]) == pytest.approx(expected.epsilon, rel=1e-9)
    assert record["coverage"][0][1] == 0.5


def test_the_table_says_the_same(names: list[str], command: Command) -> None:
    done = command("compare", *names)
    expected = compare_fronts([part(slice(0, 20)).values, part(slice(10, 30)).values])
    assert done.exit_code == 0
    for index, name in enumerate(names):
        line = next(line for line in done.stdout.splitlines() if line.split()[:2] == [str(index + 1), name])
        assert f"{expected.hypervolumes[index]:.5f}" in line.split()
    assert "Neither of the two dominates" in done.stdout
    assert "50.0" in done.stdout


def test_who_dominates_whom_is_said(runs: Path, command: Command) -> None:
    whole, some, same = (keep(runs, name, part(rows)) for name, rows in
                         (("whole", slice(0, 30)), ("some", slice(0, 12)), ("same", slice(0, 30))))  # fmt: skip
    done = command("compare", whole, some, same)
    assert f"{whole} dominates {some}" in done.stdout
    assert f"{same} dominates {some}" in done.stdout
    assert f"{whole} and {same} have the same front" in done.stdout
    assert "neither" not in done.stdout


def test_objectives_may_come_in_another_order(runs: Path, command: Command) -> None:
    one = keep(runs, "one", part(slice(0, 30), names=("peak_torque", "transmission_angle")))
    two = keep(runs, "two", part(slice(0, 30), names=("transmission_angle", "peak_torque")))
    record = json.loads(command("compare", one, two, "--json").stdout)
    assert record["coverage"] == [[1.0, 1.0], [1.0, 1.0]]


def test_wrong_comparisons_are_exit_code_2(names: list[str], runs: Path, command: Command) -> None:
    other = keep(runs, "other", part(slice(0, 9), names=("peak_torque", "transmission_angle")))
    for arguments, message in (
        (names[:1], "a comparison needs at least two runs; got one"),
        ([names[0], names[0]], "a run may be named only once"),
        ([names[0], other], f"{other} has minimise peak_torque, maximise transmission_angle"),
        ([names[0], "absent"], "there is no run 'absent'"),
    ):
        done = command("compare", *arguments)
        assert done.exit_code == 2
        assert message in done.stderr


def test_the_figure_is_written(names: list[str], tmp_path: Path, command: Command) -> None:
    done = command("compare", *names, "--figures", tmp_path / "drawn")
    assert done.exit_code == 0
    assert (tmp_path / "drawn" / "comparison.png").read_bytes().startswith(b"\x89PNG")
    assert "comparison.png" in done.stderr


def test_the_figure_draws_the_designs_of_every_run() -> None:
    parts = [part(slice(0, 20)), part(slice(10, 30))]
    wanted = result_of(parts[0], "").objectives
    columns = [item.column for item in wanted]
    drawn = [PlottedRun(f"run {n}", one.designs[columns].to_numpy(dtype=np.float64)) for n, one in enumerate(parts)]
    figure = comparison_matrix(drawn, wanted)
    panels = figure.axes
    assert len(panels) == 6
    places = [(row, column) for row in range(3) for column in range(row + 1)]
    for panel, (row, column) in zip(panels, places, strict=True):
        for line, run in zip(panel.lines, drawn, strict=True):
            assert np.array_equal(line.get_xydata(), run.values[:, [column, row + 1]])
    assert "peak torque, N m" in panels[0].get_ylabel()
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["run 0, 20 designs", "run 1, 20 designs"]


def test_runs_are_told_apart_without_colour() -> None:
    """No two runs share a marker, and neighbours differ in fill by much in grey (luminance by ITU-R BT.601)."""
    values = np.array([[0.0, 1.0], [1.0, 0.0]])
    wanted = result_of(part(slice(0, 5), names=("peak_torque", "transmission_angle")), "").objectives
    figure = comparison_matrix([PlottedRun(f"{n}", values) for n in range(MOST_RUNS)], wanted)
    lines = figure.axes[0].lines
    assert len({line.get_marker() for line in lines}) == MOST_RUNS
    fills = ["white" if fill == "none" else fill for fill in (line.get_markerfacecolor() for line in lines)]
    greys = [float(np.dot(to_rgb(fill), (0.299, 0.587, 0.114))) for fill in fills]
    assert min(abs(a - b) for a, b in pairwise(greys)) > 0.2


def test_agents_receive_what_the_command_prints(names: list[str], runs: Path, command: Command) -> None:
    (ask,) = (tool for tool in TOOLS if tool.name == "ask")
    call = Call(runs, frozenset(), lambda: False, lambda _: None)
    for units in ("metric", "inch"):
        inputs = {"runs": names, "topics": ["compare"], "inputs": {"tolerance": 0.01}, "units": units}
        answer = ask.execute(call, inputs)
        asked = ("compare", *names, "--tolerance", 0.01, "--units", units)
        assert json_ready(answer.record) == json.loads(command(*asked, "--json").stdout)
        assert answer.text.split() == command(*asked).stdout.split()
    for wrong, rule in (
        ({"run": names[0]}, "this topic needs runs; got a run; "),
        ({"runs": names[:1]}, "a comparison needs at least two runs; got one; "),
        ({"runs": [names[0], names[0]]}, "a run may be named only once; "),
        ({"runs": names, "inputs": {"tolerance": -1.0}}, "tolerance must be at least 0.0; got -1.0; "),
    ):
        with pytest.raises(InputError, match=rule):
            ask.execute(call, {"topics": ["compare"], **wrong})


def test_the_command_says_what_differs_between_the_jobs(runs: Path, tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    other = tmp_path / "other.toml"
    other.write_text(job.read_text(encoding="utf-8").replace('"600 mm"', '"700 mm"'), encoding="utf-8")
    one, two = keep(runs, "one", part(slice(0, 20)), job), keep(runs, "two", part(slice(10, 30), 2), other)
    record = json.loads(command("compare", one, two, "--json").stdout)
    assert record["differences"] == [{"place": "variables.rod", "values": ["60 mm to 600 mm", "60 mm to 700 mm"]}]
    table = command("compare", one, two).stdout.partition("What differs between the jobs")[2]
    assert table.split() == f"Place in the job {one} {two} variables rod 60 mm to 600 mm 60 mm to 700 mm".split()
