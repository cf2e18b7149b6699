"""The robust front against the nominal one of the same job."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from ...objectives.kinds import unit_text
from ...optimise.front.front import ParetoFront
from ...optimise.problem.robust import robust_quantities
from ...optimise.questions.price_of_robustness import robust_cost
from ..runs.result import wanted_of
from .comparison import Drawn, comparison_matrix


def robustness_figure(front: ParetoFront) -> Figure | None:
    """Return nominal and robust front in one scatter matrix, with what robustness costs below.

    None without a nominal front to compare with.
    """
    found = robust_cost(front)
    if found is None:
        return None
    first = robust_quantities(front.problem)[0]
    kind = first.case if first.case == "worst case" else f"{100.0 * first.share:.6g} % of machines"
    inner = {quantity.name: quantity.inner.title for quantity in robust_quantities(front.problem)}
    axes = [replace(item, title=inner.get(item.quantity, item.title)) for item in wanted_of(front)]
    runs = [
        Drawn("nominal front, without errors", found.nominal),
        Drawn(f"robust front, within tolerances ({kind})", found.robust),
        Drawn(
            f"nominal front's designs within tolerances, {found.keeps} keep all requirements",
            np.where(np.isfinite(found.within), found.within, np.nan),
        ),
    ]
    notes = ["What robustness costs, best of each front:"]
    for column, item in enumerate(axes):
        if item.target is not None:
            continue
        best = np.max if item.sense == "maximise" else np.min
        unit = unit_text(item.unit)
        before, after = float(best(found.nominal[:, column])), float(best(found.robust[:, column]))
        cost = found.cost(column, maximised=item.sense == "maximise")
        title = item.title.removesuffix(", worst case")
        change = f"{before:.5g} → {after:.5g} {unit}".rstrip()
        notes.append(f"   {title}: {change}, cost {cost:.2g} {unit}".rstrip())
    return comparison_matrix(runs, axes, title=f"{front.problem.name}: nominal and robust front", notes=notes)
