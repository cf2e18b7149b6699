"""Types of the front door: a user's script passes strict mypy, a misspelt name in it does not."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import numpy as np
import slidercrank as sc

problem = sc.load_job("press.toml")
front = sc.solve(problem)
values, jacobian = front.problem.evaluate(front.dimensions, ["stroke"], gradients=True)
analysis = problem.analyse([0.04, 0.1, 0.02])
linkage = sc.Linkage(crank=0.04, rod=[0.1, 0.2], offset=0.02)
form = sc.standard_form(problem)
reveal_type(problem)
reveal_type(problem.evaluate([[0.04, 0.1, 0.02]]))
reveal_type(values)
reveal_type(jacobian)
reveal_type(analysis["stroke"])
reveal_type(analysis.cycle(90))
reveal_type(front.knee())
reveal_type(front.plot())
reveal_type(linkage.stroke)
reveal_type(linkage.at(np.pi).slider_position)
reveal_type(form.arrays([[0.04, 0.1, 0.02]]).dG)
problem.objectivs
front.dezigns
analysis.cicle()
linkage.strok
sc.optimize
"""
SHOWN = (
    *("slidercrank.optimise.problem.problem.Problem", "ndarray", "ndarray", "ndarray", "float"),
    *("pandas.core.frame.DataFrame", "int", "matplotlib.figure.Figure", "ndarray", "ndarray", "ndarray"),
)
WRONG = ("objectivs", "dezigns", "cicle", "strok", "optimize")


def test_misspelt_names_fail_and_the_others_have_types(tmp_path: Path, pytestconfig: pytest.Config) -> None:
    root, script = pytestconfig.rootpath, tmp_path / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    # In the project's folder, so that what it has checked already is not checked again.
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", str(script)], cwd=root, capture_output=True, text=True, check=False
    )
    told = [line for line in done.stdout.splitlines() if "script.py" in line]
    types = [found[1] for line in told if (found := re.search(r'Revealed type is "(.*)"', line))]
    assert len(types) == len(SHOWN), done.stdout + done.stderr
    for shown, wanted in zip(types, SHOWN, strict=True):
        assert wanted in shown
        assert shown != "Any"
    errors = [line for line in told if " error: " in line]
    assert len(errors) == len(WRONG), "\n".join(errors)
    for line, name in zip(errors, WRONG, strict=True):
        assert f'"{name}"' in line
