"""A front is saved and loaded without losing a bit; other files and other problems are refused."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputError

ROOT = Path(__file__).resolve().parents[2]


@cache
def solved(name: str) -> sc.ParetoFront:
    """Return a small front of a job that ships: with choices, with a swing, or with neither."""
    problem = sc.load_job(ROOT / "runs" / f"{name}.toml")
    settings = replace(problem.settings, method="sobol", evaluations=600, designs=4)
    return sc.solve(replace(problem, settings=settings))


def parts(value: Any) -> Any:
    """Return a value whose arrays compare by their bits."""
    if isinstance(value, np.ndarray):
        return value.dtype.kind, value.shape, value.tobytes() if value.dtype.kind == "f" else value.tolist()
    if isinstance(value, dict):
        return {key: parts(item) for key, item in value.items()}
    if isinstance(value, tuple):
        return tuple(map(parts, value))
    return value


@pytest.mark.parametrize("name", ["press", "support", "feeder"])
@pytest.mark.filterwarnings("ignore::slidercrank.model.errors.InputWarning")
def test_a_loaded_front_is_the_saved_one_to_the_last_bit(name: str, tmp_path: Path) -> None:
    front, file = solved(name), tmp_path / "front.json"
    assert len(front) > 1
    front.save(file)
    loaded = sc.ParetoFront.load(file, front.problem)
    for field in fields(front):
        if field.name != "problem":
            assert parts(getattr(loaded, field.name)) == parts(getattr(front, field.name)), field.name
    np.testing.assert_array_equal(loaded.rates(0), front.rates(0))
    assert [path.name for path in tmp_path.iterdir()] == ["front.json"]


def test_an_empty_front_and_infinite_numbers_survive(tmp_path: Path) -> None:
    front, file = solved("feeder"), tmp_path / "front.json"
    columns = front.columns | {"residual": np.array([np.inf, -np.inf, np.nan, -0.0][: len(front)])}
    replace(front, columns=columns).save(file)
    assert "Infinity" not in file.read_text(encoding="utf-8")
    loaded = sc.ParetoFront.load(str(file), front.problem)
    assert parts(loaded.columns) == parts(columns)
    nothing = {name: column[:0] for name, column in front.columns.items()}
    empty = replace(
        front, columns=nothing, dimensions=front.dimensions[:0], values=front.values[:0], goals=(), active=()
    )
    empty.save(file)
    assert sc.ParetoFront.load(file, front.problem).dimensions.shape == empty.dimensions.shape


def test_the_front_of_another_problem_is_refused(tmp_path: Path) -> None:
    front, file = solved("feeder"), tmp_path / "front.json"
    front.save(file)
    heavier = replace(front.problem, mechanism=replace(front.problem.mechanism, slider_mass=30.0))
    with pytest.raises(InputError, match="the front of another problem: peak_torque of its first design is"):
        sc.ParetoFront.load(file, heavier)
    fewer = replace(front.problem, objectives=front.problem.objectives[:1])
    with pytest.raises(InputError, match="those of the problem are maximise time_ratio; load it with the problem"):
        sc.ParetoFront.load(file, fewer)


@pytest.mark.parametrize("content", ["", "{}", "[]", "null", "\x00", '{"form": 2}'])
def test_a_file_that_is_not_a_front_is_refused(content: str, tmp_path: Path) -> None:
    file = tmp_path / "front.json"
    file.write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match=r"must be a front that `save` wrote"):
        sc.ParetoFront.load(file, solved("feeder").problem)


@pytest.mark.parametrize("key", ["values", "columns", "dimensions", "goals", "unknowns", "history"])
def test_a_damaged_front_is_refused(key: str, tmp_path: Path) -> None:
    front, file = solved("feeder"), tmp_path / "front.json"
    front.save(file)
    record = json.loads(file.read_text(encoding="utf-8"))
    record[key] = record[key][:-1] if isinstance(record[key], list) and key != "history" else [{"stage": 1}]
    file.write_text(json.dumps(record), encoding="utf-8")
    with pytest.raises(InputError, match=r"must be a front that `save` wrote"):
        sc.ParetoFront.load(file, front.problem)


def test_a_missing_file_is_refused_in_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read: No such file or directory; name a file that `save` wrote"):
        sc.ParetoFront.load(tmp_path / "none.json", solved("feeder").problem)
