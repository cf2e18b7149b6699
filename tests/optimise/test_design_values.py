"""Values and derivatives of many designs: those of each quantity, and nothing plausible where there is no linkage."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

import slidercrank as sc
from slidercrank.model.errors import InputError
from slidercrank.model.machine.drive import Drive
from slidercrank.model.machine.links_and_joints import Bar
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism, SliderDistances
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.objectives.kinds import RATIO
from slidercrank.objectives.own.quantity import OwnQuantity
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import AIR, STRENGTH

Array = NDArray[np.float64]
FOUR = ["time_ratio", "peak_torque", "transmission_angle", "position_error"]


def machine() -> Mechanism:
    found = sc.problem(
        {
            "name": "Press",
            "mechanism": {
                "speed": "-200 rpm",
                "crank": {"mass": "0.4 kg"},
                "rod": {"mass": "0.6 kg"},
                "slider": {"mass": 0.8},
                "gravity": 9.81,
            },
            "load": [{"force": "200 N", "opposes": "outward stroke"}],
            "friction": {"guide": 0.1},
            "tolerances": {"crank": "0.05 mm", "crank_angle": "0.1 deg"},
            "variables": {"crank": ["20 mm", "80 mm"], "rod": ["60 mm", "400 mm"], "offset": ["0 mm", "60 mm"]},
            "objectives": {"stroke": "maximise"},
        }
    )
    return found.mechanism


def designs(count: int, seed: int = 1) -> Array:
    """Return random designs, near locking and far from it."""
    random = np.random.default_rng(seed)
    crank, offset = random.uniform(0.02, 0.2, count), random.uniform(-0.1, 0.1, count)
    rod = (crank + np.abs(offset)) * (1.0 + 10.0 ** random.uniform(-1.5, 0.5, count))
    return np.stack([crank, rod, offset], axis=1)


def test_every_quantity_is_that_of_its_own_evaluation() -> None:
    bar = Bar(width=0.03, depth=0.02, density=7800.0)
    slider = SliderDistances(touch=0.01, dwell=0.005, guide=0.1)
    drive = Drive(gear_ratio=8.0, gear_efficiency=0.9, rated_torque=3.0, greatest_torque=9.0, greatest_speed=300.0)
    of = replace(machine(), loads=(*machine().loads, AIR), crank=bar, rod=bar, strength=STRENGTH, slider=slider)
    of = replace(of, drive=replace(drive, motor_inertia=1e-3))
    some, names = (
        designs(40),
        [name for name, quantity in QUANTITIES.items() if not quantity.unmet_need(of, "undefined")],
    )
    assert len(names) > len(QUANTITIES) - 5
    values, jacobian = sc.evaluate(of, some, names, gradients=True)
    assert values.shape == (40, len(names))
    assert jacobian.shape == (40, len(names), 3)
    for column, name in enumerate(names):
        alone = QUANTITIES[name].evaluate(of, some, gradients=True)
        assert alone.gradients is not None
        np.testing.assert_allclose(values[:, column], alone.values, rtol=1e-12, atol=0.0, err_msg=name)
        size = np.abs(alone.gradients).max(axis=1, keepdims=True)
        assert np.all(np.abs(jacobian[:, column] - alone.gradients) <= 1e-6 * size + 1e-12), name


def test_quick_peaks_are_exact_ones_where_loads_change_at_the_dead_centres() -> None:
    # Helping loads give peaks on the kinks there, which the vectorised search alone misses.
    random, kinks = np.random.default_rng(3), 0
    plain = replace(machine(), friction=Mechanism().friction)
    exact = QUANTITIES["peak_torque"]
    for trial, branch in zip(range(16), itertools.cycle(("open", "crossed"))):
        forces = 10.0 ** random.uniform(-1.0, 0.5, 2) * random.choice([-1.0, 1.0], 2)
        of = replace(
            plain,
            speed=float(random.choice([0.0, 2.0, -30.0])),
            branch="open" if branch == "open" else "crossed",
            loads=(StrokeForce(outward=forces[0], inward=forces[1]),),
        )
        some = designs(400, trial)
        found = sc.evaluate(of, some, ["peak_torque"])[:, 0]
        wanted = exact.evaluate(of, some).values
        np.testing.assert_allclose(found, wanted, rtol=1e-10)
        at = find_peaks(of, Signal.TORQUE, some, limit=1).angles[:, 0]
        r, l, e = some.T
        for angle in (np.arcsin(e / (l + r)), np.pi + np.arcsin(e / (l - r))):
            kinks += int((np.abs(np.sin(0.5 * (at - (angle if branch == "open" else np.pi - angle)))) < 1e-9).sum())
    assert kinks > 10


def test_jacobian_is_the_limit_of_differences() -> None:
    of, some, step = replace(machine(), friction=Mechanism().friction), designs(60, 5), 1e-7
    _, jacobian = sc.evaluate(of, some, FOUR, gradients=True)
    for column in range(3):
        ahead, behind = some.copy(), some.copy()
        ahead[:, column] += step
        behind[:, column] -= step
        slope = (sc.evaluate(of, ahead, FOUR) - sc.evaluate(of, behind, FOUR)) / (2.0 * step)
        apart = np.abs(jacobian[:, :, column] - slope) / np.abs(jacobian).max(axis=2)
        # A kink within the step is rare: a tie of two peaks.
        assert np.quantile(apart, 0.98) < 1e-4


def test_a_varying_number_has_a_column_of_the_jacobian() -> None:
    item = Varying(name="slider", sets=(("slider_mass", 1.0),), lower=0.1, upper=5.0)
    of = replace(machine(), friction=Mechanism().friction, varying=(item,))
    some = np.column_stack([designs(20), np.linspace(0.2, 4.0, 20)])
    values, jacobian = sc.evaluate(of, some, FOUR, gradients=True)
    assert jacobian.shape == (20, 4, 4)
    for row, design in enumerate(some):
        alone = sc.evaluate(of.with_values([design[3]]), design[:3], FOUR)
        np.testing.assert_allclose(values[row], alone, rtol=1e-12)


def test_designs_that_do_not_turn_are_nan_and_leave_the_others_as_they_are() -> None:
    some = designs(12)
    alone, _ = sc.evaluate(machine(), some, FOUR, gradients=True)
    broken = some.copy()
    broken[1] = [0.08, 0.1, 0.03]
    broken[3] = [0.08, 0.11, 0.03]  # on the limit
    broken[5, 0] = np.nan
    broken[6, 1] = np.inf
    broken[7, 0] = 0.0
    broken[8, 0] = -0.04
    broken[9, 1] = -1.0
    lost = [1, 3, 5, 6, 7, 8, 9]
    values, jacobian = sc.evaluate(machine(), broken, FOUR, gradients=True)
    assert np.isnan(values[lost]).all()
    assert np.isnan(jacobian[lost]).all()
    kept = np.setdiff1d(np.arange(12), lost)
    np.testing.assert_array_equal(values[kept], alone[kept])
    assert np.isfinite(jacobian[kept]).all()


def test_axes_before_the_last_are_kept() -> None:
    some = designs(12)
    values, jacobian = sc.evaluate(machine(), some.reshape(3, 4, 3), FOUR, gradients=True)
    assert values.shape == (3, 4, 4)
    assert jacobian.shape == (3, 4, 4, 3)
    np.testing.assert_allclose(values.reshape(12, 4), sc.evaluate(machine(), some, FOUR), rtol=1e-14)
    np.testing.assert_allclose(values[1, 2], sc.evaluate(machine(), some[6], FOUR), rtol=1e-14)
    assert sc.evaluate(machine(), np.zeros((0, 3)), FOUR).shape == (0, 4)


@pytest.mark.parametrize(
    ("given", "names", "words"),
    [
        ([[0.04, 0.1]], ["stroke"], r"need 3 numbers each \(crank, rod, offset\).*shape \(1, 2\)"),
        (0.04, ["stroke"], "need 3 numbers"),
        ([["a", "b", "c"]], ["stroke"], "arrays of real numbers"),
        ([[0.04, 0.1, 1e-30j]], ["stroke"], "arrays of real numbers"),
        ([[0.04, 0.1, 0.0]], ["strokes"], "did you mean stroke"),
        ([[0.04, 0.1, 0.0]], "stroke", r"write \['stroke'\]"),
        ([[0.04, 0.1, 0.0]], ["position_error"], "needs tolerances; got none; for example, add"),
        ([[0.04, 0.1, 0.0]], ["self_locking_margin"], "needs friction"),
    ],
)
def test_what_cannot_be_evaluated_is_refused(given: object, names: list[str], words: str) -> None:
    with pytest.raises(InputError, match=words):
        sc.evaluate(Mechanism(), given, names)  # type: ignore[call-overload]


def test_no_gradient_is_made_up_for_a_function_that_has_none() -> None:
    own = OwnQuantity(name="mine", function=lambda d: d.crank[:, 0], title="mine", kind=RATIO, gradient="none")
    assert sc.evaluate(Mechanism(), designs(3), ["mine"], own=[own]).shape == (3, 1)
    with pytest.raises(InputError, match='gradient = "none"; got gradients=True'):
        sc.evaluate(Mechanism(), designs(3), ["mine"], gradients=True, own=[own])
