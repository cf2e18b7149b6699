"""Averages, searches of peaks and interval arithmetic have one module each; others say why they are beside it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

FOLDERS = ("model", "objectives")
QUADRATURES = {
    "model/quadrature.py": "nodes, weights, and panels that are halved until curves are resolved",
    "model/signals/turn_means.py": "the same rule, compiled with the curves of one crank",
    "model/transient/steady_cycle.py": "collocation: the unknown is the motion itself",
    "model/motion_law/law_turn.py": "values and integrals within the cells of a turn, of polynomials through its nodes",
    "model/signals/panel_polynomials.py": "extremes of the polynomials that quadrature has fitted",
    "model/machine/speed_profile.py": "the series of an integral that quadrature has fitted",
}
ITERATIONS = {
    "model/signals/turn_peaks.py": "peaks of one crank, compiled with the curves",
    "model/signals/roots.py": "peaks of all else, and places where a curve changes its sign",
    "model/signals/fast_torque_and_error.py": "peaks of very many designs in vector instructions, without breakpoints",
    "model/strength/stress_points.py": "samples a segment evenly; no iteration",
    "model/strength/stress_search.py": "over the place along a link, with the peak over the angle in closed form",
    "model/dynamics/torque_with_friction.py": "solves for a force, not for an angle",
    "model/motion_law/motion_law.py": "inverts the time elapsed within a cell",
    "model/swing/angles_from_position.py": "inverts the position of the slider",
    "model/swing/forces.py": "inverts the position of the slider",
    "model/swing/swing_states.py": "inverts the position of the slider, compiled",
    "model/swing/swing_batch.py": "places where a guide changes sides, by the complex step",
}
QUADRATURE_CALLS = {"leggauss", "laggauss", "chebgauss", "legvander", "trapezoid", "simpson", "quad", "fixed_quad"}
OPERATORS = {"__add__", "__mul__", "__truediv__", "__pow__"}


@pytest.fixture(scope="module")
def modules(pytestconfig: pytest.Config) -> dict[str, ast.Module]:
    root = pytestconfig.rootpath
    files = [file for folder in FOLDERS for file in sorted((root / folder).rglob("*.py"))]
    return {Path(file).relative_to(root).as_posix(): ast.parse(file.read_bytes()) for file in files}


def names_in(node: ast.AST) -> set[str]:
    return {item.id for item in ast.walk(node) if isinstance(item, ast.Name)}


def flows(loop: ast.For | ast.While) -> list[tuple[set[str], set[str], ast.expr]]:
    """Return the assignments in a loop: names that change, names that they are made of, and the expression."""
    statements = [node for node in ast.walk(loop) if isinstance(node, ast.Assign)]
    return [
        ({name for target in node.targets for name in names_in(target)}, names_in(node.value), node.value)
        for node in statements
    ]


def reached(start: set[str], loop: ast.For | ast.While) -> set[str]:
    """Return the names in a loop that depend on others, directly or through further ones."""
    names = set(start)
    for _ in range(9):
        names |= {name for changed, used, _ in flows(loop) if used & names for name in changed}
    return names


def newton_steps(tree: ast.AST) -> Iterator[ast.BinOp]:
    """Yield Newton and secant steps that are assigned in loops.

    They are x - f / g and x + (b - a) * (f / (f - g)), which give x this value.
    """
    for loop in ast.walk(tree):
        if not isinstance(loop, ast.For | ast.While):
            continue
        all_changed = {name for changed, _, _ in flows(loop) for name in changed}
        for changed, _, value in flows(loop):
            for node in ast.walk(value):
                if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Add | ast.Sub):
                    continue
                ratio = node.right
                if isinstance(ratio, ast.BinOp) and isinstance(ratio.op, ast.Mult):
                    ratio = ratio.right
                is_ratio = (
                    isinstance(ratio, ast.BinOp)
                    and isinstance(ratio.op, ast.Div)
                    and names_in(ratio.right) & all_changed
                )
                if is_ratio and names_in(node.left) & reached(changed, loop):
                    yield node


def uses_quadrature(tree: ast.AST) -> bool:
    return any(
        isinstance(node, ast.Attribute | ast.Name | ast.alias)
        and (getattr(node, "attr", None) or getattr(node, "id", None) or getattr(node, "name", "")) in QUADRATURE_CALLS
        for node in ast.walk(tree)
    )


def test_quadrature_is_in_one_module(modules: dict[str, ast.Module]) -> None:
    found = {name for name, tree in modules.items() if uses_quadrature(tree)}
    imported = {
        name
        for name, tree in modules.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and any(alias.name == "legendre" for alias in node.names)
    }
    assert found | imported <= QUADRATURES.keys()
    assert found | imported | {"model/signals/turn_means.py"} == QUADRATURES.keys(), "a reason is left over"


def test_searches_for_peaks_are_in_one_module_for_each_way_of_running(modules: dict[str, ast.Module]) -> None:
    found = {name for name, tree in modules.items() if next(newton_steps(tree), None) is not None}
    assert found == ITERATIONS.keys()


def test_neither_model_nor_objectives_have_interval_arithmetic_of_their_own(modules: dict[str, ast.Module]) -> None:
    """It is that of `optimise.certificate.enclosure`."""
    classes = {
        (name, node.name)
        for name, tree in modules.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
        and OPERATORS & {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
    }
    assert classes == set()


@pytest.mark.parametrize(
    "source",
    [
        "for _ in range(9):\n    v, s = f(x)\n    x = x - v / s",
        "while True:\n    v, s = f(x)\n    new = x - v * (x - old) / (v - before)\n    old, before, x = x, v, new",
        "for _ in range(9):\n    a, rise, fall = f(a)\n    at = a + (b - a) * (rise / (rise - fall))\n    a = at",
    ],
)
def test_an_iteration_of_newton_or_by_secants_is_noticed(source: str) -> None:
    assert next(newton_steps(ast.parse(source)), None) is not None


@pytest.mark.parametrize(
    "source", ["np.polynomial.legendre.leggauss(4)", "from scipy.integrate import quad", "np.trapezoid(y, x)"]
)
def test_a_quadrature_is_noticed(source: str) -> None:
    assert uses_quadrature(ast.parse(source))
