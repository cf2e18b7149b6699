"""Functions of your own as quantities: what they are given, what becomes of what they return."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.kinds import RATIO, kind_displayed_in
from slidercrank.objectives.own.designs import Designs, magnitude
from slidercrank.objectives.own.quantity import Gradient, OwnQuantity
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import MACHINES, SMOOTH, STROKES, random_designs

DESIGNS = random_designs(60, seed=4, least_margin=1e-2)
ANGLES = np.linspace(0.1, 6.2, 40)


def own(function: Callable[[Designs], Any], gradient: Gradient = "complex step", name: str = "mine") -> OwnQuantity:
    return OwnQuantity(name=name, function=function, title="mine", kind=kind_displayed_in("N", 1.0), gradient=gradient)


# What the software has already, written as an engineer would.
SAME: dict[str, Callable[[Designs], Any]] = {
    "stroke": lambda d: d.stroke,
    "time_ratio": lambda d: d.time_ratio,
    "transmission_angle": lambda d: d.least_transmission_angle,
    "rod_to_crank": lambda d: (d.rod / d.crank)[:, 0],
    "peak_slider_speed": lambda d: d.peaks(lambda angle: magnitude(d.velocity(angle))),
    "peak_slider_acceleration": lambda d: d.greatest(lambda angle: magnitude(d.acceleration(angle))),
    "peak_slider_pin_force": lambda d: d.peaks(lambda angle: d.forces(angle).slider_pin.size),
    "peak_torque": lambda d: d.peaks(lambda angle: magnitude(d.forces(angle).torque)),
    "rms_torque": lambda d: np.sqrt(d.mean(lambda angle: d.forces(angle).torque ** 2)),
}


@pytest.mark.parametrize("name", SAME)
def test_function_that_says_what_a_quantity_says_is_equal_to_it(name: str) -> None:
    found = own(SAME[name]).evaluate(SMOOTH, DESIGNS, gradients=True)
    expected = QUANTITIES[name].evaluate(SMOOTH, DESIGNS, gradients=True)
    np.testing.assert_allclose(found.values, expected.values, rtol=1e-12)
    assert found.gradients is not None
    assert expected.gradients is not None
    # A peak is located to 1e-9 of a turn, and its derivative follows its place; a mean has no place.
    size = np.abs(expected.gradients).max(axis=1)[:, None]
    np.testing.assert_allclose(found.gradients / size, expected.gradients / size, rtol=0, atol=2e-7)


def test_peak_on_a_jump_at_a_dead_centre_moves_with_it() -> None:
    found = own(SAME["peak_slider_pin_force"]).evaluate(STROKES, DESIGNS, gradients=True)
    expected = QUANTITIES["peak_slider_pin_force"].evaluate(STROKES, DESIGNS, gradients=True)
    np.testing.assert_allclose(found.values, expected.values, rtol=1e-8)  # 1e-9 rad beside the jump
    assert found.gradients is not None
    assert expected.gradients is not None
    size = np.abs(expected.gradients).max(axis=1)[:, None]
    np.testing.assert_allclose(found.gradients / size, expected.gradients / size, rtol=0, atol=1e-6)


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_curves_are_those_of_the_cycle(machine: Mechanism) -> None:
    designs = Designs(machine, DESIGNS[:5])
    forces = designs.forces(ANGLES)
    for n, (crank, rod, offset) in enumerate(DESIGNS[:5]):
        linkage = Linkage(crank, rod, offset, machine.branch)
        curves = cycle(machine, linkage, ANGLES)
        motion = linkage.at(ANGLES, speed=machine.speed, acceleration=machine.acceleration)
        for own_curve, known in (
            (designs.position(ANGLES), curves.slider_position),
            (designs.velocity(ANGLES), curves.slider_velocity),
            (designs.acceleration(ANGLES), curves.slider_acceleration),
            (designs.transmission_angle(ANGLES), motion.transmission_angle),
            (forces.torque, curves.torque),
            (forces.load, curves.load),
            (forces.guide, curves.guide),
            (forces.pivot.x, curves.pivot_x),
            (forces.crank_pin.y, curves.crank_pin_y),
            (forces.slider_pin.size, np.hypot(curves.slider_pin_x, curves.slider_pin_y)),
        ):
            scale = np.abs(known).max()
            np.testing.assert_allclose(own_curve[n] / scale, known / scale, rtol=0, atol=1e-11)


def test_jerk_is_the_rate_of_the_acceleration() -> None:
    designs = Designs(SMOOTH, DESIGNS)
    # By complex step in the crank angle; the speed changes by w dw = alpha dtheta.
    angle = ANGLES + 1e-30j
    later = Designs(SMOOTH, DESIGNS.astype(complex)).position(angle)
    assert np.all(np.isfinite(later))
    x_1 = np.asarray(later.imag) / 1e-30
    np.testing.assert_allclose(designs.velocity(ANGLES), SMOOTH.speed * x_1, rtol=1e-11, atol=1e-11)
    h = 1e-4
    speeds = Designs(Mechanism(speed=1.0), DESIGNS)
    x_2 = [speeds.acceleration(ANGLES + step) for step in (-2 * h, -h, h, 2 * h)]
    x_3 = (x_2[0] - 8.0 * x_2[1] + 8.0 * x_2[2] - x_2[3]) / (12.0 * h)
    expected = x_3 * SMOOTH.speed**3 + 3.0 * speeds.acceleration(ANGLES) * SMOOTH.speed * SMOOTH.acceleration
    scale = np.abs(expected).max(axis=1)[:, None]
    np.testing.assert_allclose(designs.jerk(ANGLES) / scale, expected / scale, rtol=0, atol=1e-6)


def test_means_are_exact_for_smooth_curves() -> None:
    designs = Designs(SMOOTH, DESIGNS)
    ones = designs.mean(lambda angle: np.ones_like(angle))
    np.testing.assert_allclose(ones, 1.0, rtol=1e-13)
    np.testing.assert_allclose(designs.mean(designs.velocity), 0.0, atol=1e-13 * SMOOTH.speed)


def test_pieces_are_the_peaks_and_keep_their_angles() -> None:
    quantity = own(lambda d: d.peaks(lambda angle: magnitude(d.acceleration(angle))) / 2.0 + 1.0)
    pieces = quantity.pieces(SMOOTH, DESIGNS)
    known = QUANTITIES["peak_slider_acceleration"].pieces(SMOOTH, DESIGNS)
    assert pieces.values.shape == (60, 3)
    np.testing.assert_allclose(pieces.values[:, :2], 0.5 * known.values[:, :2] + 1.0, rtol=1e-10)
    away = np.angle(np.exp(1j * (pieces.labels[:, :2] - known.labels[:, :2])))
    np.testing.assert_allclose(np.where(np.isfinite(known.values[:, :2]), away, 0.0), 0.0, atol=1e-6)


def test_a_curve_may_write_into_its_angles_and_into_what_it_gets() -> None:
    def writing(designs: Designs) -> Any:
        def curve(angle: Any) -> Any:
            place = designs.position(angle)
            place *= designs.acceleration(angle)
            angle = np.array(angle)
            ahead = designs.position(angle)
            angle += 0.3
            return place + ahead * designs.velocity(angle)

        return designs.peaks(curve)

    def plain(designs: Designs) -> Any:
        def curve(angle: Any) -> Any:
            bend = designs.acceleration(angle) + designs.velocity(angle + 0.3)
            return designs.position(angle) * bend

        return designs.peaks(curve)

    written, known = own(writing).pieces(SMOOTH, DESIGNS), own(plain).pieces(SMOOTH, DESIGNS)
    np.testing.assert_allclose(written.values, known.values, rtol=1e-12)
    np.testing.assert_allclose(written.gradients, known.gradients, rtol=1e-9, atol=1e-9)


def test_a_curve_with_one_peak_is_one_piece() -> None:
    pieces = own(lambda d: d.peaks(lambda angle: d.position(angle))).pieces(SMOOTH, DESIGNS)
    assert np.all(pieces.values[:, 1:] == -np.inf)
    np.testing.assert_allclose(
        pieces.values[:, 0], [Linkage(*design).dead_centres[1] for design in DESIGNS], rtol=1e-12
    )


def test_finite_differences_are_close_to_the_complex_step() -> None:
    exact = own(SAME["peak_slider_speed"]).evaluate(SMOOTH, DESIGNS, gradients=True).gradients
    found = own(SAME["peak_slider_speed"], "finite differences").evaluate(SMOOTH, DESIGNS, gradients=True).gradients
    assert exact is not None
    assert found is not None
    assert np.max(np.abs(found - exact) / np.abs(exact).max(axis=1)[:, None]) < 1e-7


def test_without_a_gradient_there_is_none() -> None:
    pieces = own(lambda d: np.round(d.rod[:, 0] * 1e3), "none").pieces(SMOOTH, DESIGNS)
    assert np.all(pieces.gradients == 0.0)
    np.testing.assert_array_equal(pieces.values[:, 0], np.round(DESIGNS[:, 1] * 1e3))


def test_what_friction_locks_has_no_finite_value() -> None:
    rubbing = Mechanism(speed=5.0, slider_mass=1.0, friction=Friction(guide=0.9))
    designs = np.array([[0.1, 0.4, 0.0], [0.1, 0.13, 0.02]])
    quantity = own(lambda d: d.crank)
    assert quantity.evaluate(rubbing, designs).values.tolist() == [0.1, np.inf]
    found = quantity.pieces(rubbing, designs)
    assert found.values[:, 0].tolist() == [0.1, np.inf]
    assert np.all(found.gradients[1] == 0.0)


def crashing(_: Designs) -> Any:
    pins: dict[str, float] = {}
    return pins["pin"]


def writing(designs: Designs) -> Any:
    designs.crank[:] = 1.0
    return designs.crank


BROKEN: dict[str, tuple[Callable[[Designs], Any], str]] = {
    "raises": (crashing, r"not raise; got KeyError: 'pin' \(test_own_quantity.py:\d+\)"),
    "writes": (writing, r"not raise; got ValueError: assignment destination is read-only \(test_own_quantity.py:\d+\)"),
    "nan": (lambda d: d.crank[:, 0] * np.nan, "finite number for every design; got nan for crank"),
    "infinite": (lambda d: d.crank[:, 0] * 0.0 + np.inf, "got inf for crank .* rod .* offset .* correct the function"),
    "one number": (lambda d: 1.0, r"shape \(60,\) or \(60, k\); got shape \(\)"),
    "too many": (lambda d: d.crank[:-1], r"got shape \(59, 1\)"),
    "a curve": (lambda d: d.position(np.linspace(0.0, 6.0, 50)), r"up to 32 .* got shape \(60, 50\)"),
    "words": (lambda d: ["good"] * 60, "array of numbers; got one of <U4"),
    "nothing": (lambda d: None, "array of numbers; got one of object"),
    "complex": (lambda d: d.crank + 1j, "return real numbers for real designs; got complex ones"),
}


@pytest.mark.parametrize(("function", "said"), BROKEN.values(), ids=BROKEN)
def test_a_broken_function_is_named_with_what_it_did(function: Callable[[Designs], Any], said: str) -> None:
    with pytest.raises(InputError, match=r"the quantity mine \(.*\) must .*" + said):
        own(function, "none").evaluate(SMOOTH, DESIGNS)


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (lambda d: np.abs(d.offset), 'keep the complex numbers .* or set gradient = "finite differences"'),
        (lambda d: np.arctan2(d.offset, d.rod), "in complex numbers, for the gradient, TypeError.*magnitude in place"),
        (lambda d: d.crank * np.conj(d.rod), "agrees with differences; got .* by the rod .* leave the imaginary parts"),
        (lambda d: d.crank + 0.0 * d.crank.real * 1j, "must return real numbers"),
    ],
    ids=["abs", "arctan2", "conjugate", "complex"],
)
def test_a_complex_step_that_is_no_derivative_is_refused(function: Callable[[Designs], Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        own(function).evaluate(SMOOTH, DESIGNS)


def test_a_kink_at_one_design_is_no_reason_to_refuse() -> None:
    designs = DESIGNS.copy()
    designs[0] = [0.05, 0.2, 0.0]
    assert own(lambda d: magnitude(d.offset)).evaluate(SMOOTH, designs).values[0] == 0.0


def test_wrong_declarations_are_refused() -> None:
    for change, said in (
        ({"name": "My jerk"}, "lower-case letters, digits and underscores"),
        ({"function": "mymodule.jerk"}, '"module:function"; got'),
        ({"gradient": "exact"}, "gradient must be 'complex step' or"),
        ({"limit": 0.0}, "time limit must be more than zero"),
    ):
        given: dict[str, Any] = {"name": "mine", "function": "a:b", "title": "mine", "kind": RATIO}
        with pytest.raises(InputError, match=said):
            OwnQuantity(**(given | change))
    with pytest.raises(InputError, match="may only depend on crank, rod and offset"):
        own(lambda d: d.crank).evaluate(SMOOTH, np.ones((2, 4)))


@pytest.mark.parametrize(
    ("symbol", "field"),
    [("m/s^3", "mine_m_s3"), ("MPa", "mine_MPa"), ("", "mine"), ("N m", "mine_Nm"), ("kg m^2", "mine_kg_m2")],
)
def test_field_carries_the_unit(symbol: str, field: str) -> None:
    assert OwnQuantity(name="mine", function="a:b", title="mine", kind=kind_displayed_in(symbol, 1.0)).field == field


def test_quantity_can_be_copied_and_sent() -> None:
    quantity = OwnQuantity(name="mine", function="a:b", title="mine", kind=RATIO)
    assert copy.deepcopy(quantity) == pickle.loads(pickle.dumps(quantity)) == quantity


@pytest.mark.parametrize(
    "profile",
    [{"cosines": [0.05, 0.03], "sines": [0.04]}, {"crank_angles": ["0 deg", "80 deg", "190 deg", "270 deg"]}],
    ids=["harmonics", "points"],
)
def test_motion_of_a_function_follows_a_speed_profile(profile: dict[str, list[Any]]) -> None:
    if "crank_angles" in profile:
        profile = profile | {"speeds": ["60 rad/s", "62 rad/s", "58 rad/s", "59 rad/s"]}
    functions: dict[str, tuple[Callable[[Designs], Any], str]] = {
        "peak_slider_speed": (lambda designs: designs.peaks(lambda t: magnitude(designs.velocity(t))), "m/s"),
        "peak_slider_acceleration": (
            lambda designs: designs.peaks(lambda t: magnitude(designs.acceleration(t))),
            "m/s^2",
        ),
        "peak_slider_jerk": (lambda designs: designs.peaks(lambda t: magnitude(designs.jerk(t))), "m/s^3"),
    }
    tables: dict[str, Any] = {
        "name": "Uneven",
        "mechanism": {"speed": "60 rad/s", "slider": {"mass": "1 kg"}, "speed_profile": profile},
        "quantity": {f"own_{name}": {"function": f, "unit": unit} for name, (f, unit) in functions.items()},
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["90 mm", "250 mm"], "offset": ["-20 mm", "20 mm"]},
        "objectives": {"time_ratio": "maximise"},
    }
    if "speeds" in profile:  # the mean of a table over the crank angle must be that of the job
        with pytest.raises(sc.JobError, match="the mean of speed_profile") as told:
            sc.problem(tables)
        tables["mechanism"]["speed"] = re.findall(r'give speed = "(.*)"', str(told.value))[0]
    problem = sc.problem(tables)
    designs = [[0.03, 0.12, 0.01], [0.05, 0.11, -0.015]]
    own, own_slopes = problem.evaluate(designs, [f"own_{name}" for name in functions], gradients=True)
    known, slopes = problem.evaluate(designs, [*functions], gradients=True)
    np.testing.assert_allclose(own, known, rtol=1e-9)
    size = np.abs(slopes).max(axis=(0, 2), keepdims=True)
    np.testing.assert_allclose(own_slopes / size, slopes / size, rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("machine", ["a profile", "two turns"])
def test_forces_that_a_function_cannot_have_are_refused_without_blame(machine: str) -> None:
    mechanism: dict[str, Any] = {"speed": "60 rad/s", "slider": {"mass": "1 kg"}}
    load: list[dict[str, Any]] = []
    if machine == "a profile":
        mechanism["speed_profile"] = {"cosines": [0.05]}
    else:
        load = [{"crank_angles": ["0 deg", "90 deg", "400 deg"], "forces": ["1 N", "2 N", "3 N"], "cycle": "720 deg"}]
    problem = sc.problem(
        {
            "name": "Refused",
            "mechanism": mechanism,
            "load": load,
            "quantity": {
                "pin": {"function": lambda designs: designs.peaks(lambda t: designs.forces(t).guide), "unit": "N"}
            },
            "variables": {"crank": "30 mm", "rod": ["90 mm", "250 mm"], "offset": "10 mm"},
            "objectives": {"pin": "minimise"},
        }
    )
    with pytest.raises(
        InputError, match=r"is not available for this machine: .*; got a (speed profile|load with one of 720)"
    ):
        problem.evaluate([0.03, 0.1, 0.01])


@pytest.mark.parametrize("asked", ["links", "links / crank"])
@pytest.mark.parametrize("table", ["objectives", "constraints"])
def test_with_other_variables_a_function_is_refused_before_anything_runs(asked: str, table: str) -> None:
    tables: dict[str, Any] = {
        "name": "Others vary",
        "mechanism": {"speed": "60 rad/s", "slider": {"mass": "1 kg"}},
        "quantity": {"links": {"function": lambda designs: designs.crank + designs.rod, "unit": "mm"}},
        "variables": {
            "crank": "30 mm",
            "rod": ["90 mm", "250 mm"],
            "offset": "10 mm",
            "mechanism.slider.mass": ["1 kg", "3 kg"],
        },
        "objectives": {"peak_torque": "minimise"},
    }
    one: Any = "minimise" if table == "objectives" else {"max": 9.0}
    with pytest.raises(
        sc.JobError, match=r"offset; got other variables, mechanism\.slider\.mass; fix them, or use other"
    ):
        sc.problem({**tables, table: {**tables.get(table, {}), asked: one}})
    problem = sc.problem(tables)
    analysis = problem.analyse([0.03, 0.1, 0.01, 2.0])
    assert "links" not in analysis
    assert "got other variables" in analysis.undefined["links"]
