"""Optuna: a study finds the known optimum; trials that meet no requirement are infeasible to it."""

import math

import optuna
import pytest

import slidercrank as sc
from tests.optimise.adapters.the_problem import best_angle, degrees_of, problem


@pytest.mark.filterwarnings("ignore::optuna.exceptions.ExperimentalWarning")
def test_it_finds_the_known_optimum() -> None:
    study = optuna.create_study(direction="minimize", sampler=optuna.samplers.TPESampler(seed=1))
    study.optimize(sc.optuna_objective(problem()), n_trials=250)
    assert degrees_of(study.best_trial.user_attrs["design"]) == pytest.approx(best_angle(), abs=1e-6)
    assert -math.degrees(study.best_value) == pytest.approx(best_angle(), abs=1e-6)


@pytest.mark.filterwarnings("ignore::optuna.exceptions.ExperimentalWarning")
@pytest.mark.parametrize("eliminate", [False, True])
def test_every_trial_has_its_constraints(eliminate: bool) -> None:
    study = optuna.create_study(direction="minimize", sampler=optuna.samplers.RandomSampler(seed=1))
    study.optimize(sc.optuna_objective(problem(), eliminate=eliminate), n_trials=40)
    form = sc.standard_form(problem(), eliminate=eliminate)
    for trial in study.trials:
        assert len(trial.constraints) == len(form.inequalities) + len(form.equalities)
    assert any(max(trial.constraints.values()) > 0.0 for trial in study.trials)
