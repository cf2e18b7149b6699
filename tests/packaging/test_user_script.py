"""Types of the front door: a user's script passes strict mypy and pyright, a misspelt name in it does not."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
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
    *("Problem", "ndarray", "ndarray", "ndarray", "float"),
    *("DataFrame", "int", "Figure", "ndarray", "ndarray", "ndarray"),
)
WRONG = ("objectivs", "dezigns", "cicle", "strok", "optimize")


def mypy(script: Path, root: Path) -> list[str]:
    # In the project's folder, so that what it has checked already is not checked again.
    command = [sys.executable, "-m", "mypy", "--strict", str(script)]
    return subprocess.run(command, cwd=root, capture_output=True, text=True, check=False).stdout.splitlines()


def pyright(script: Path, root: Path) -> list[str]:
    program = root / ".javascript/node_modules/.bin/pyright"
    if not program.exists():
        pytest.skip("pyright is not installed; make lint installs it where there is npm")
    # It does not see what is installed in place, hence the folder for type checkers.
    settings = {"extraPaths": [str(root / ".package/typing")], "include": [script.name], "reportAny": True}
    (script.parent / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
    command = [str(program), "--pythonpath", sys.executable, "--project", str(script.parent)]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines()


@pytest.mark.parametrize("checker", [mypy, pyright])
def test_misspelt_names_fail_and_the_others_have_types(
    checker: Callable[[Path, Path], list[str]], tmp_path: Path, pytestconfig: pytest.Config
) -> None:
    script = tmp_path / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    told = checker(script, pytestconfig.rootpath)
    types = [found[1] for line in told if (found := re.search(r'(?:Revealed type|Type of ".*") is "(.*)"', line))]
    assert len(types) == len(SHOWN), "\n".join(told)
    for shown, wanted in zip(types, SHOWN, strict=True):
        assert re.search(rf"\b{wanted}\b", shown)
        assert shown not in ("Any", "Unknown")
    errors = [line for line in told if " error: " in line]
    assert len(errors) == len(WRONG), "\n".join(errors)
    for line, name in zip(errors, WRONG, strict=True):
        assert f'"{name}"' in line
