"""`slidercrank optimise --resume`: a run that was stopped goes on in its folder and ends as if it had not been."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError, RunError
from slidercrank.optimise.front import ParetoFront
from slidercrank.optimise.methods.generation import Generation
from slidercrank.optimise.problem import Settings
from slidercrank.optimise.solve import solve
from slidercrank.service.run_folder import MARK, RunFolder
from slidercrank.service.stored_generations import FILE, GenerationsFile, read_generations
from tests.service import fronts
from tests.service.conftest import Command

METHOD = 'method = "nsga2"\nsamples = 16\nevaluations = 96\n'


class Killed(BaseException):
    """Stands for the end of the process."""


@pytest.fixture
def job(tmp_path: Path) -> Path:
    """Return a small job for an evolutionary method."""
    file = tmp_path / "short.toml"
    file.write_text(fronts.JOB.replace("samples = 512\n", METHOD), encoding="utf-8")
    return file


@pytest.fixture
def stop(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return what lets the next search end after some generations: cancelled, or killed."""

    def after(count: int, *, killed: bool) -> None:
        def stopped(*given: Any, keep: Any, **options: Any) -> ParetoFront:
            seen: list[Generation] = []

            def counted(generation: Generation) -> None:
                keep(generation)
                seen.append(generation)
                if killed and len(seen) == count:
                    raise Killed

            options["cancelled"] = lambda: len(seen) >= count
            return solve(*given, keep=counted, **options)

        monkeypatch.setattr("slidercrank.optimise.solve.solve", stopped)
        monkeypatch.setattr("slidercrank.service.stored_generations._PAUSE", 0.0)

    return after


def only(runs: Path) -> Path:
    (run,) = runs.iterdir()
    return run


def designs(run: Path) -> str:
    return (run / "front.csv").read_text()


@pytest.fixture
def whole(job: Path, tmp_path: Path, command: Command) -> str:
    """Return the front of the job without a stop, as it is stored."""
    done = command("optimise", job, "--no-figures", "--seed", 4, "--designs", 6, "--runs", tmp_path / "whole")
    assert done.exit_code == 0, done.output
    run = only(tmp_path / "whole")
    assert not (run / FILE).exists()
    return designs(run)


@pytest.mark.parametrize("killed", [False, True])
def test_a_stopped_run_goes_on_and_ends_as_if_it_had_not_been(
    killed: bool, job: Path, runs: Path, whole: str, stop: Any, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    stop(3, killed=killed)
    arguments = ("optimise", job, "--no-figures", "--seed", 4, "--designs", 6)
    if killed:
        with pytest.raises(Killed):
            command(*arguments)
        run = only(runs)
        assert (run / MARK).exists()
        assert f"go on with `slidercrank optimise --resume {run.name}`" in command("front", run.name).stderr
    else:
        stopped = command(*arguments)
        run = only(runs)
        assert stopped.exit_code == 130
        assert f"go on with: slidercrank optimise --resume {run.name}" in stopped.stderr
    monkeypatch.setattr("slidercrank.optimise.solve.solve", solve)
    assert len(read_generations(run)[1]) == 3
    again = command("optimise", "--resume", run.name, "--json", "--no-figures")
    assert again.exit_code == 0, again.output
    assert only(runs) == run
    assert designs(run) == whole
    record = json.loads(again.stdout)
    assert (record["status"], record["seed"], record["run"]) == ("done", 4, str(run))
    assert {file.name for file in run.iterdir()} == {
        *("job.toml", "front.csv", "front.json", "versions.json", "log.txt")
    }
    assert "goes on" in (run / "log.txt").read_text()
    refused = command("optimise", "--resume", run.name)
    assert refused.exit_code == 2
    assert "only an interrupted or cancelled run can go on" in refused.stderr


def test_what_cannot_go_on_is_refused_and_left_as_it_is(
    job: Path, runs: Path, stop: Any, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    stop(2, killed=False)
    command("optimise", job, "--no-figures")
    monkeypatch.setattr("slidercrank.optimise.solve.solve", solve)
    run = only(runs)
    before = designs(run)
    for arguments, words in (
        ((), "needs a job file, or a run to go on with"),
        ((job, "--resume", "latest"), "got both"),
        (("--resume", "latest", "--seed", 5), "the designs and the seed that it began with"),
        (("--resume", "nothing"), "there is no run 'nothing'"),
    ):
        done = command("optimise", *arguments)
        assert (done.exit_code, done.stdout) == (2, "")
        assert words in done.stderr
    kept = (run / "job.toml").read_text()
    (run / "job.toml").write_text(kept.replace('"2 kg"', '"3 kg"').replace("40 deg", "41 deg"))
    changed = command("optimise", "--resume", "latest")
    assert changed.exit_code == 2
    assert "goes on only from its own generations" in changed.stderr
    assert designs(run) == before
    assert not (run / MARK).exists()
    (run / FILE).write_bytes((run / FILE).read_bytes()[:-200])
    assert "is damaged" in command("optimise", "--resume", "latest").stderr
    (run / FILE).unlink()
    assert "has none" in command("optimise", "--resume", "latest").stderr


@pytest.mark.skipif(os.name == "nt", reason="locks of Unix")
def test_a_run_that_still_goes_on_is_not_taken_up(tmp_path: Path) -> None:
    with RunFolder(tmp_path, "x") as run, pytest.raises(InputError, match="another process is at work on the run"):
        RunFolder.again(run.path)
    with RunFolder.again(run.path) as again:
        assert (again.path / MARK).exists()
    assert not (again.path / MARK).exists()


def test_generations_are_read_as_they_were_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slidercrank.service.stored_generations._PAUSE", 0.0)
    random = np.random.default_rng(1)
    settings = Settings(method="nsga2", seed=2**62 + 1, samples=7)
    file = GenerationsFile(tmp_path, settings, [])
    written = []
    for count, bred in ((7, 0), (7, 5), (3, 7)):
        violation = np.array([0.0, np.inf, 1e-300, *random.random(count - 3)])
        values = np.where((violation > 0.0)[:, None], np.nan, random.random((count, 2)))
        parents = np.arange(bred)
        written.append(Generation(random.integers(0, 2, count), random.random((count, 3)), parents, values, violation))
        file.keep(written[-1])
        read_settings, read = read_generations(tmp_path)
        assert read_settings == settings
        assert len(read) == len(written)
        for one, two in zip(read, written, strict=True):
            for name in ("sheet", "u", "parents", "values", "violation"):
                assert getattr(one, name).dtype == getattr(two, name).dtype
                assert getattr(one, name).tobytes() == getattr(two, name).tobytes()
    file.remove()
    with pytest.raises(RunError, match="has none"):
        read_generations(tmp_path)


def test_a_file_with_code_in_it_is_not_run(tmp_path: Path) -> None:
    np.savez(tmp_path / FILE, allow_pickle=True, form=np.array(1), settings=np.array([{}], dtype=object))
    with pytest.raises(RunError, match="is damaged"):
        read_generations(tmp_path)
