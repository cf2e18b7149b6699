"""Strength of one design: its numbers are those of the quantities, its curves those of sections from the other end."""

from __future__ import annotations

import io
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from rich.console import Console

import slidercrank as sc
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar, Counterweight
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.bar_pieces import LINKS
from slidercrank.objectives.quantity import Group
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.service.figures.panel_figure import panel_in_units
from slidercrank.service.questions.strength.analysis import blocks, figure, numbers
from slidercrank.service.render.terminal import print_blocks
from slidercrank.service.runs.result import json_ready
from tests.model.cases import STRENGTH, random_designs
from tests.model.strength.sections import eye_rows, linkage_with, random_bars, section_stress
from tests.service import fronts


def random_bar_machine(seed: int) -> tuple[Mechanism, Linkage]:
    """Return a random machine whose links are bars, without a counterweight, and a design of it."""
    random = np.random.default_rng(seed)
    machine = replace(random_bars(random), counterweight=Counterweight(mass=0.0, radius=0.0))
    return machine, linkage_with(machine, random_designs(1, seed=seed, least_margin=3e-2)[0])


def test_numbers_are_those_of_the_quantities_and_places_those_of_the_greatest_stress() -> None:
    for seed in (21, 22, 23):
        machine, linkage = random_bar_machine(seed)
        found = numbers(machine, linkage)
        assert json_ready(found) == {key: "inf" if value == np.inf else value for key, value in found.items()}
        design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
        row = analyse(machine, design).iloc[0]
        own = [of.field for of in QUANTITIES.values() if of.group is Group.STRENGTH and not np.isnan(row[of.field])]
        assert len(own) > 15
        assert found.keys() - {"bars", "violated"} == set(own)
        for key, value in found.items():
            if key not in ("bars", "violated"):
                assert value == pytest.approx(row[key], rel=1e-9), key
        for name, bar in found["bars"].items():
            own_link: Any = getattr(machine, name)
            edges = eye_rows(machine, name, linkage, np.linspace(0.0, 2.0 * np.pi, 4001))
            eyes = {pin: bar[f"eye_at_{pin}_MPa"] for pin in ("crank_pin", LINKS[name].far)}
            pivot = eyes.get("crank_pivot")
            assert pivot is None or 1e6 * pivot >= abs(edges[:, 2:]).max() * (1.0 - 1e-9)
            along = [bar[f"greatest_{word}_MPa"] for word in ("tension", "compression")]
            assert max(*along, *eyes.values()) == pytest.approx(row[f"{name}_stress_MPa"], rel=1e-9)
            for pin, stress in eyes.items():
                force = row[{"crank_pivot": "peak_pivot_force_N"}.get(pin, f"peak_{pin}_force_N")]
                net = (own_link.width - getattr(STRENGTH, pin)) * own_link.depth
                assert 1e6 * stress >= 2.5 * force / net * (1.0 - 1e-9)
                assert pin == "crank_pivot" or 1e6 * stress == pytest.approx(2.5 * force / net, rel=1e-9)
                at = np.radians(bar[f"eye_at_{pin}_at_crank_angle_deg"])
                sides = np.array([at - 1e-8, at + 1e-8])  # it may be on one side of a jump
                cycle = sc.analyse(machine, design[0]).cycle(sides)
                pin_name = pin.removeprefix("crank_") if pin == "crank_pivot" else pin
                ends = [2.5 * np.hypot(cycle[f"{pin_name}_x_N"], cycle[f"{pin_name}_y_N"]).max() / net]
                if pin == "crank_pivot":
                    ends.append(abs(eye_rows(machine, name, linkage, sides)[:, 2:]).max())
                assert 1e6 * stress == pytest.approx(max(ends), rel=1e-5)
            for sign, word in ((1.0, "tension"), (-1.0, "compression")):
                at = np.radians(bar[f"greatest_{word}_at_crank_angle_deg"])
                share = 1e-3 * bar[f"greatest_{word}_from_crank_pin_mm"] / float(getattr(linkage, name))
                sides = np.array([at - 1e-8, at + 1e-8])  # it may be on one side of a jump
                there = [sign * section_stress(machine, name, linkage, sides, share, face) for face in (1.0, -1.0)]
                assert 1e6 * bar[f"greatest_{word}_MPa"] == pytest.approx(np.max(there), rel=1e-5)


def test_curves_of_the_figure_are_those_of_a_section_cut_from_the_other_end() -> None:
    machine, linkage = random_bar_machine(22)
    panels = [panel_in_units(panel, "metric") for panel in figure(machine, linkage).panels]
    assert [str(panel.title).split()[0] for panel in panels] == [name for name in LINKS for _ in range(2)]
    for name, over, along in zip(LINKS, panels[::2], panels[1::2], strict=True):
        length = float(getattr(linkage, name))
        share = 1e-3 * float(str(over.title).split()[3]) / length
        degrees = over.lines[0].x
        inner = np.flatnonzero((np.diff(degrees, prepend=-1.0) > 1e-3) & (np.diff(degrees, append=361.0) > 1e-3))[::20]
        for face, line in zip((1.0, -1.0), over.lines, strict=True):
            told = section_stress(machine, name, linkage, np.radians(line.x[inner]), share, face)
            assert 1e6 * line.y[inner] == pytest.approx(told, rel=2e-3, abs=2e-3 * abs(told).max())
        place = np.argmin(abs(along.lines[0].x - 1e3 * share * length))
        assert along.lines[0].y[place] == min(line.y.min() for line in over.lines)
        assert along.lines[1].y[place] == max(line.y.max() for line in over.lines)


def test_the_text_tells_every_number_and_what_is_missing_is_said() -> None:
    machine, linkage = random_bar_machine(23)
    screen = Console(file=io.StringIO(), width=120)
    found = numbers(machine, linkage)
    print_blocks(screen, blocks(found))
    text = screen.file.getvalue()  # type: ignore[attr-defined]
    assert f"{found['rod_stress_MPa']:.6g} MPa" in " ".join(text.split())
    for asked in (numbers, figure):
        with pytest.raises(InputError, match="material and pins"):
            asked(fronts.MACHINE, linkage)


def test_a_sign_that_the_stress_of_a_bar_never_has_is_left_blank() -> None:
    """A light rod that is pulled all the time has no greatest compression, but some tension."""
    bar = Bar(width=0.03, depth=0.012, density=1.0)
    pulled = Mechanism(
        speed=1.0, crank=bar, rod=bar, loads=(StrokeForce(outward=500.0, inward=500.0),), strength=STRENGTH
    )
    rod = numbers(pulled, Linkage(0.05, 0.2))["bars"]["rod"]
    assert rod["greatest_tension_MPa"] == pytest.approx(1e-6 * 500.0 / np.sqrt(1.0 - 0.0625) / (0.03 * 0.012), rel=1e-3)
    assert [value for key, value in rod.items() if "compression" in key] == [None, None, None]
