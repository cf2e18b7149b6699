"""Methods by name: what is refused, what is delivered, how a run tells and stops."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.job.model import Job, schema_of
from slidercrank.optimise.methods.registry import FAMILIES, Method, evaluation_budget, methods_by_name
from slidercrank.optimise.problem.problem import Problem, Settings
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.search.sample_and_zoom import Archive, Run
from slidercrank.optimise.solve import solve
from tests.optimise.methods.asking import asking
from tests.optimise.problems import MACHINE, Bounds, degrees, problem

BOTH = problem({"peak_torque": "minimise", "time_ratio": "maximise"}, {"stroke": 0.2}, designs=20)
POINTS = 512


def scatter(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Sample in two rounds, within a band where equalities remain; the least that a method may be."""
    archive = Archive.empty(len(problem.objectives))
    archive.band = 0.05 if evaluators[0].loose else 0.0
    random = np.random.default_rng(problem.settings.seed)
    run.rounds = 2
    for _ in range(run.rounds):
        archive.screen(0, evaluators[0], random.random((POINTS, evaluators[0].dimension)))
        run.report_round("sampling", evaluators, archive)
    return archive


@pytest.fixture(autouse=True)
def sobol(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put `scatter` in the place of a method's search."""
    monkeypatch.setitem(methods_by_name(), "sobol", replace(methods_by_name()["sobol"], search=scatter))


def test_methods_are_named_family_by_family_the_default_first() -> None:
    assert next(iter(methods_by_name())) == "auto"
    assert [method.family for method in methods_by_name().values()] == sorted(
        (method.family for method in methods_by_name().values()), key=FAMILIES.index
    )


@pytest.mark.parametrize("method", methods_by_name().values(), ids=list(methods_by_name()))
def test_a_method_tells_of_itself(method: Method) -> None:
    assert re.fullmatch("[a-z][a-z0-9_]*", method.name)
    assert method.help.endswith(".")
    assert len(method.help.split()) <= 20
    for package in method.uses:
        assert importlib.util.find_spec(package) is not None


def test_the_schema_of_jobs_names_every_method() -> None:
    assert schema_of(Job)["$defs"]["OptimiserPart"]["properties"]["method"]["enum"] == list(methods_by_name())


def test_the_documentation_lists_every_method_as_it_tells_of_itself(pytestconfig: pytest.Config) -> None:
    page = (pytestconfig.rootpath / "docs" / "optimisers.md").read_text(encoding="utf-8")
    takes = {"one": "one objective", "several": "several objectives", "any": "any"}
    for method in methods_by_name().values():
        assert f"| `{method.name}` | {takes[method.objectives]} | {method.help} |\n" in page


def test_the_budget_is_the_one_asked_or_the_method_s_own() -> None:
    assert evaluation_budget(asking(BOTH, "nbi", evaluations=123)) == 123
    assert evaluation_budget(asking(BOTH, "nbi")) == methods_by_name()["nbi"].budget


def test_a_budget_without_a_method_is_refused() -> None:
    with pytest.raises(InputError, match="auto has no budget of evaluations; got 100"):
        solve(replace(BOTH, settings=Settings(evaluations=100)))


@pytest.mark.parametrize("method", [name for name, method in methods_by_name().items() if method.objectives == "one"])
def test_several_objectives_are_refused_naming_the_methods_that_fit(method: str) -> None:
    wanted = rf"{method} needs one objective; got 2 \(peak_torque, time_ratio\); use one of auto, epsilon_constraint"
    with pytest.raises(InputError, match=wanted):
        solve(asking(BOTH, method))


@pytest.mark.parametrize(
    "method", [name for name, method in methods_by_name().items() if method.objectives == "several"]
)
def test_one_objective_is_refused_naming_the_methods_that_fit(method: str) -> None:
    with pytest.raises(InputError, match=f"{method} needs several objectives; got 1 .*; use one of auto, slsqp"):
        solve(asking(problem({"peak_torque": "minimise"}), method))


@pytest.mark.parametrize("method", [name for name, method in methods_by_name().items() if not method.equalities])
def test_an_equality_that_stays_is_refused_by_methods_that_cannot_hold_it(method: str) -> None:
    given = problem({"transmission_angle": "maximise"}, {"stroke": 0.2, "peak_slider_speed": 4.0})
    with pytest.raises(InputError, match=f"{method} cannot keep peak_slider_speed at one value.*use slsqp or auto"):
        solve(asking(given, method))


def test_designs_are_delivered_as_they_were_found() -> None:
    front = solve(asking(BOTH, "sobol"))
    random = np.random.default_rng(1)
    evaluator = Evaluator(BOTH, elimination_branches(BOTH)[0])
    sampled = evaluator.branch.designs_at_points(random.random((2 * POINTS, 2)))
    assert front.status == "done"
    assert 5 <= len(front) <= 20
    assert all((np.abs(sampled - design).max(axis=1) == 0.0).any() for design in front.dimensions)
    assert "best found" in set(front.designs["status"])
    assert front.evaluations >= 2 * POINTS
    assert front.rates(front.knee()).shape == (2, 2)
    assert "slack_stroke_mm" in front.designs


def test_what_lies_beside_an_equality_is_moved_onto_it() -> None:
    given = problem(
        {"transmission_angle": "maximise", "time_ratio": "maximise"}, {"stroke": 0.2, "peak_slider_speed": 4.0}
    )
    front = solve(asking(given, "sobol"))
    speed = QUANTITIES["peak_slider_speed"].evaluate(MACHINE, front.dimensions).values
    assert len(front) > 0
    assert np.abs(speed / 4.0 - 1.0).max() <= 1e-8


def test_rounds_are_told_and_the_run_stops_between_them() -> None:
    rounds: list[Progress] = []
    whole = solve(asking(BOTH, "sobol"), progress=rounds.append)
    assert [(entry.round, entry.rounds) for entry in rounds] == [(1, 2), (2, 2)]
    assert len(whole.history) == 2
    assert whole.history[0].hypervolume <= whole.history[1].hypervolume
    rounds.clear()
    part = solve(asking(BOTH, "sobol"), progress=rounds.append, cancelled=lambda: len(rounds) >= 1)
    assert part.status == "cancelled"
    assert len(part) > 0
    assert len(part.history) == 1


def test_a_contradiction_is_explained_whatever_the_method() -> None:
    held: dict[str, Bounds] = {"stroke": 0.2, "time_ratio": (1.5, None), "transmission_angle": (degrees(60.0), None)}
    front = solve(asking(problem({"peak_torque": "minimise", "footprint": "minimise"}, held), "sobol"))
    assert front.status == "infeasible"
    assert "is possible with all else met" in front.message


def test_no_package_that_a_method_computes_with_is_imported_before_it_is_used() -> None:
    code = (
        "import sys; from slidercrank import load_job, solve; load_job; solve;"
        "from slidercrank.optimise.methods.registry import methods_by_name;"
        "methods = methods_by_name().values();"
        "used = {name for method in methods for name in method.uses} - {'scipy'};"  # numba imports scipy
        "used |= {'scipy.optimize', 'scipy.stats', 'scipy.spatial', 'pandas'};"
        "print(sorted(used & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "[]"
