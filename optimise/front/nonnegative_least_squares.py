"""Non-negative least squares: the active-set method of Lawson and Hanson, compiled.

Solves min |A x - b| with x >= 0 (C. L. Lawson and R. J. Hanson, "Solving Least Squares Problems", 1974, algorithm
23.10). Every polishing step, multiplier and trade-off rate is such a problem, with a few dozen rows and columns.
"""

import numpy as np

from ...model.arrays import Array
from ...model.kernel.arithmetic import analytic
from ...model.kernel.kernel import Integers, Row, Table, kernel

_STEPS = 50
"""Maximum number of changes in the active set, per column."""
_INDEPENDENT = 1e-2  # a column counts as independent of others if this fraction of its remainder changes their length


def nonnegative_least_squares(matrix: Array, target: Array) -> Array | None:
    """Return the x >= 0 (n,) that minimises |A x - b|; None if rounding prevents convergence.

    matrix: matrix: A (m, n). target: b (m,).
    """
    columns = np.array(matrix.T, order="C")
    solution = np.zeros(len(columns))
    ended = _solve_nonnegative(columns, target.astype(np.float64), _STEPS * len(columns), solution)
    return solution if ended else None


@analytic
def _reflect_column(mirror: Row, pivot: int, up: float, column: Row) -> None:
    """Reflect a column by the Householder mirror whose entry at `pivot` is `up`.

    The mirror's later entries are stored in it.
    """
    scale = up * mirror[pivot]
    if scale >= 0.0:
        return
    share = column[pivot] * up
    for row in range(pivot + 1, len(column)):
        share += column[row] * mirror[row]
    share /= scale
    column[pivot] += share * up
    for row in range(pivot + 1, len(column)):
        column[row] += share * mirror[row]


@analytic
def _remove_free_column(columns: Table, target: Row, order: Integers, free: int, leaving: int) -> None:
    """Fix the column at position `leaving` among the `free` columns; rotations of row pairs restore the triangle."""
    column = order[leaving]
    for place in range(leaving + 1, free):
        moved = order[place]
        order[place - 1] = moved
        head, tail = columns[moved, place - 1], columns[moved, place]
        length = np.hypot(head, tail)
        if length > 0.0:
            cosine, sine = head / length, tail / length
            for row_of_pair in range(columns.shape[0]):
                head, tail = columns[row_of_pair, place - 1], columns[row_of_pair, place]
                columns[row_of_pair, place - 1] = cosine * head + sine * tail
                columns[row_of_pair, place] = cosine * tail - sine * head
            head, tail = target[place - 1], target[place]
            target[place - 1], target[place] = cosine * head + sine * tail, cosine * tail - sine * head
            columns[moved, place] = 0.0
    order[free - 1] = column


@kernel
def _solve_nonnegative(columns: Table, target: Row, max_steps: int, solution: Row) -> bool:
    n, m = columns.shape
    order = np.arange(n)  # first the columns with possibly positive x, in triangular form
    free, steps = 0, 0
    trial, slope, unconstrained = np.zeros(m), np.zeros(n), np.zeros(m)
    while free < min(n, m):
        for place in range(free, n):
            column = order[place]
            slope[column] = 0.0
            for row in range(free, m):
                slope[column] += columns[column, row] * target[row]
        entered = False
        while not entered:
            chosen, steepest = -1, 0.0
            for place in range(free, n):
                if slope[order[place]] > steepest:
                    chosen, steepest = place, slope[order[place]]
            if chosen < 0:
                return True
            column = order[chosen]
            mirror = columns[column]
            largest = 0.0
            for row in range(free, m):
                largest = max(largest, abs(mirror[row]))
            head, tail = 0.0, 0.0
            for row in range(free):
                head += mirror[row] * mirror[row]
            head = np.sqrt(head)
            if largest > 0.0:
                for row in range(free, m):
                    tail += (mirror[row] / largest) * (mirror[row] / largest)
            pivot = mirror[free]
            mirror[free] = -largest * np.sqrt(tail) if pivot > 0.0 else largest * np.sqrt(tail)
            up = pivot - mirror[free]
            if head + abs(mirror[free]) * _INDEPENDENT > head:
                for row in range(m):
                    trial[row] = target[row]
                _reflect_column(mirror, free, up, trial)
                entered = trial[free] / mirror[free] > 0.0
            if not entered:
                mirror[free] = pivot
                slope[column] = 0.0
        for row in range(m):
            target[row] = trial[row]
        order[chosen], order[free] = order[free], column
        for place in range(free + 1, n):
            _reflect_column(mirror, free, up, columns[order[place]])
        for row in range(free + 1, m):
            mirror[row] = 0.0
        slope[column] = 0.0
        free += 1
        while True:
            steps += 1
            if steps > max_steps:
                return False
            for row in range(free):
                unconstrained[row] = target[row]
            for place in range(free - 1, -1, -1):
                unconstrained[place] /= columns[order[place], place]
                for row in range(place):
                    unconstrained[row] -= unconstrained[place] * columns[order[place], row]
            share, leaving = 2.0, -1
            for place in range(free):
                if unconstrained[place] <= 0.0:
                    old = solution[order[place]]
                    part = old / (old - unconstrained[place])
                    if part < share:
                        share, leaving = part, place
            if leaving < 0:
                break
            for place in range(free):
                column = order[place]
                solution[column] += share * (unconstrained[place] - solution[column])
            while leaving >= 0:
                solution[order[leaving]] = 0.0
                _remove_free_column(columns, target, order, free, leaving)
                free -= 1
                leaving = -1
                for place in range(free):
                    if solution[order[place]] <= 0.0:
                        leaving = place
                        break
        for place in range(free):
            solution[order[place]] = unconstrained[place]
    return True
