"""OpenMDAO: check_partials, and the known optimum by its driver."""

from pathlib import Path
from typing import Any

import pytest

import slidercrank as sc
from tests.optimise.adapters.the_problem import NEAR, RATIO, STROKE, best_angle, degrees_of, problem

om = pytest.importorskip("openmdao.api", reason='openmdao is not installed; pip install "slidercrank[openmdao]"')


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.chdir(tmp_path)  # it writes folders of reports
    stated = problem()
    found = om.Problem(reports=False)
    found.model.add_subsystem("linkage", sc.openmdao_component(stated), promotes=["*"])
    found.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-15, disp=False)
    for name in ("crank", "rod", "offset"):
        ends = getattr(stated, name)
        found.model.add_design_var(name, lower=ends.lower, upper=ends.upper, ref=0.1)
    found.model.add_objective("transmission_angle", scaler=-1.0)
    found.model.add_constraint("stroke", equals=STROKE, ref=STROKE)
    found.model.add_constraint("time_ratio", equals=RATIO)
    found.setup()
    for name, value in zip(("crank", "rod", "offset"), NEAR, strict=True):
        found.set_val(name, value)
    found.run_model()
    return found


def test_partials_pass_the_check_of_openmdao(model: Any) -> None:
    checked = model.check_partials(out_stream=None, form="central", step=1e-7)
    pairs = [pair for part in checked.values() for pair in part.values()]
    assert len(pairs) == 9
    for pair in pairs:
        assert pair["abs error"].forward < 1e-5 * max(1.0, abs(pair["J_fwd"].item()))


def test_values_carry_units(model: Any) -> None:
    assert model.get_val("stroke", units="mm") == pytest.approx(1e3 * model.get_val("stroke"))
    assert model.get_val("transmission_angle", units="deg")[0] == pytest.approx(
        57.29577951308232 * model.get_val("transmission_angle")[0]
    )


def test_it_finds_the_known_optimum(model: Any) -> None:
    model.run_driver()
    design = [model.get_val(name).item() for name in ("crank", "rod", "offset")]
    assert degrees_of(design) == pytest.approx(best_angle(), abs=1e-6)
