"""Curves of a design over its cycle, and its outlines for drawings, as JSON."""

import cmath
import math

from pydantic import BaseModel, Field

from ...model.cycle.stroke_times import slow_stroke
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...model.turning_cylinder.lever_of_design import lever_machine, lever_swing, movable_lever_linkage
from ..designs.design_curves import design_curves
from ..designs.stored_designs import StoredDesign
from ..drawings.lever_parts import barrel_length, centre_of_lever, lever_extent
from ..drawings.linkage_shapes import linkage_sizes
from ..drawings.swing_parts import half_body_side, swing_sizes
from ..runs.result import json_ready
from .fronts import ColumnModel, OfDesign


class BarrelModel(BaseModel):
    """Cylinder on the slider line: positions of its open end and its head, clearance included."""

    bore_mm: float = Field(examples=[70.0])
    foot_mm: float = Field(examples=[65.0])
    head_mm: float = Field(examples=[148.0])


class ActuatorModel(BaseModel):
    """Schematic actuator of the slider: ends of its barrel and its face towards the slider."""

    face_mm: float = Field(examples=[3900.0])
    foot_mm: float = Field(examples=[6400.0])
    width_mm: float = Field(examples=[240.0])


class BodyModel(BaseModel):
    """Body on the crank: mass centre along and across the crank, and side length of its schematic square."""

    along_mm: float = Field(examples=[700.0])
    across_mm: float = Field(examples=[0.0])
    side_mm: float = Field(examples=[420.0])


class LeverOutlinesModel(BaseModel):
    """Lever moved by a cylinder: direction from its pivot to the cylinder's, angle from the lever to its pin.

    start_deg, end_deg: lever angles at both ends of the swing. barrel_mm: length of the barrel, schematic.
    """

    frame_angle_deg: float = Field(examples=[-60.0])
    pin_angle_deg: float = Field(examples=[0.0])
    start_deg: float = Field(examples=[-20.0])
    end_deg: float = Field(examples=[50.0])
    barrel_mm: float = Field(examples=[620.0])


class OutlinesModel(BaseModel):
    """Sizes of the drawn parts, mm; bore, clearance and mass centre are true to scale, the rest is schematic.

    extent_mm: left, bottom, right and top of all parts over the cycle. slider_height_mm: the bore if the slider is a
    piston. actuator, body: null if the machine has none. lever: null for a crank with rod and slider; a lever has no
    slider, and its body lies along and across the line to its pin.
    """

    extent_mm: tuple[float, float, float, float] = Field(examples=[(-43.0, -40.0, 150.0, 52.0)])
    slider_length_mm: float = Field(examples=[24.0])
    slider_height_mm: float = Field(examples=[16.0])
    cylinders: list[BarrelModel]
    actuator: ActuatorModel | None
    body: BodyModel | None
    lever: LeverOutlinesModel | None


class CycleModel(BaseModel):
    """Curves over the cycle: one crank revolution, two if a load repeats every 720 deg, or a swing.

    columns: descriptions of the curves. curves: values by column, equal in length; null where friction leaves a force
    undetermined. Samples are at evenly spaced crank angles from 0 deg; for a swing, at evenly spaced times, half on the
    forward and half on the return stroke. turns: crank revolutions; 0 for a swing, which has no dead centres. seconds:
    cycle duration; null without a speed and for a quasi-static swing. slider_ends_mm: slider positions at the inner and
    outer dead centres, or at the start and end of a swing; for a lever, lengths of its cylinder. slow_stroke: outward,
    inward or equal; differs if cylinders differ. outlines: outlines of the moving parts.
    """

    turns: int = Field(examples=[1])
    seconds: float | None = Field(examples=[0.2])
    inner_dead_centre_deg: float | None
    outer_dead_centre_deg: float | None
    slider_ends_mm: tuple[float, float] = Field(examples=[(20.8, 100.8)])
    slow_stroke: str | None = Field(examples=["inward"])
    outlines: OutlinesModel
    columns: list[ColumnModel]
    curves: dict[str, list[float | None]] = Field(
        examples=[{"crank_angle_deg": [0.0, 90.0, 180.0, 270.0], "slider_position_mm": [100.8, 60.8, 20.8, 22.4]}]
    )


class CurvesModel(OfDesign, CycleModel):
    """Curves of a design on a front over its cycle."""


def design_curves_model(design: StoredDesign, angles: int) -> CycleModel:
    """Return the curves of a design as JSON."""
    curves = design_curves(design, angles)
    inner, outer = curves.centres or (None, None)
    slow = None if inner is None else str(slow_stroke(design.mechanism, design.linkage))
    return CycleModel(
        turns=curves.turns,
        seconds=curves.seconds,
        inner_dead_centre_deg=inner,
        outer_dead_centre_deg=outer,
        slider_ends_mm=curves.slider_ends,
        slow_stroke=slow,
        outlines=outlines_model(design.mechanism, design.linkage, design.part.motion),
        columns=[ColumnModel(key=column.key, title=column.title, unit=column.unit) for column in curves.columns],
        curves={column.key: json_ready(column.values, gaps=True) for column in curves.columns},
    )


def outlines_model(mechanism: Mechanism, linkage: Linkage, swing: Swing | None) -> OutlinesModel:
    """Return the outlines of a design that rotates fully or swings.

    Raises the errors of `linkage_sizes`, `swing_sizes` and `movable_lever_linkage`.
    """
    if swing is not None and mechanism.lever is not None:
        return _outlines_of_lever(mechanism, linkage, swing)
    drawn = None if swing is None else swing_sizes(mechanism, linkage, swing)
    look = linkage_sizes(mechanism, linkage) if drawn is None else drawn.look
    actuator, body = (None, None) if drawn is None else (drawn.cylinder, drawn.body)
    return OutlinesModel(
        extent_mm=look.extent if drawn is None else drawn.extent,
        slider_length_mm=1.5 * look.slider_size,
        slider_height_mm=look.block,
        cylinders=[
            BarrelModel(bore_mm=barrel.bore, foot_mm=barrel.foot, head_mm=barrel.head) for barrel in look.barrels
        ],
        actuator=None
        if actuator is None
        else ActuatorModel(face_mm=actuator.near_end, foot_mm=actuator.foot, width_mm=actuator.width),
        body=None
        if body is None
        else BodyModel(along_mm=body[0], across_mm=body[1], side_mm=2.0 * half_body_side(look)),
        lever=None,
    )


def _outlines_of_lever(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> OutlinesModel:
    placed = lever_swing(mechanism, linkage, swing)
    machine, _ = lever_machine(mechanism, movable_lever_linkage(mechanism, linkage, swing), swing)
    sizes, body = machine.sizes, None
    if machine.lever.mass:
        centre = centre_of_lever(machine) * cmath.exp(-1j * sizes.pin_angle)
        side = 0.08 * max(1e3 * sizes.crank, 1e3 * sizes.frame)
        body = BodyModel(along_mm=1e3 * centre.real, across_mm=1e3 * centre.imag, side_mm=side)
    return OutlinesModel(
        extent_mm=lever_extent(machine, placed),
        slider_length_mm=0.0,
        slider_height_mm=0.0,
        cylinders=[],
        actuator=None,
        body=body,
        lever=LeverOutlinesModel(
            frame_angle_deg=math.degrees(sizes.frame_angle),
            pin_angle_deg=math.degrees(sizes.pin_angle),
            start_deg=math.degrees(placed.start),
            end_deg=math.degrees(placed.end),
            barrel_mm=1e3 * barrel_length(machine, placed),
        ),
    )
