"""Script of a user, never run: `make lint` checks its types, and a test has pyright check them as well.

A name that is misspelt must be an error: a comment that ignores none is an error itself.
"""

from typing import assert_type

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

import slidercrank as sc
from slidercrank.optimise.problem.problem import Problem

problem = sc.load_job("press.toml")
front = sc.solve(problem)
values, jacobian = front.problem.evaluate(front.dimensions, ["stroke"], gradients=True)
analysis = problem.analyse([0.04, 0.1, 0.02])
linkage = sc.Linkage(crank=0.04, rod=[0.1, 0.2], offset=0.02)
form = sc.standard_form(problem)

assert_type(problem, Problem)
assert_type(problem.evaluate([[0.04, 0.1, 0.02]]), NDArray[np.float64])
assert_type(values, NDArray[np.float64])
assert_type(jacobian, NDArray[np.float64])
assert_type(analysis["stroke"], float)
assert_type(analysis.cycle(90), pd.DataFrame)
assert_type(front.knee(), int)
assert_type(front.plot(), Figure)
assert_type(linkage.stroke, NDArray[np.float64])
assert_type(linkage.at(np.pi).slider_position, NDArray[np.float64])
assert_type(form.arrays([[0.04, 0.1, 0.02]]).dG, NDArray[np.float64])

problem.objectivs.keys()  # type: ignore[attr-defined]
front.dezigns.head()  # type: ignore[attr-defined]
analysis.cicle()  # type: ignore[attr-defined]
linkage.strok.max()  # type: ignore[attr-defined]
sc.optimize(problem)  # type: ignore[attr-defined]
