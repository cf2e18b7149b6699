"""Preview of a job during editing: mistakes, possible values, and an example linkage."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from fastapi import APIRouter
from pydantic import BaseModel, Field, ValidationError

from ...model.cycle.stroke_times import massless_machine, slow_stroke, time_ratio
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import Kind
from ...objectives.machine_needs import ONE_TIMING
from ...objectives.tables.curve_extremes import curve_extremes
from ...optimise.problem.question_registry import changes_of
from ..designs.design_curves import cycle_table
from ..preview.possible_swing import PossibleSwing
from ..preview.preview import JobPreview, job_preview
from .computing import QuickRoute
from .cycle import OutlinesModel, outlines_model
from .job_parsing_and_checks import ChangeModel, Understood, describe_problem
from .job_requests import Submission, problem_of_tables
from .problem_documents import validation_message
from .settings import SettingsDep

router = APIRouter(route_class=QuickRoute, tags=["jobs"])

_ANGLES = 180
_CURVES = (
    *("crank_angle_deg", "slider_position_mm", "slider_velocity_m_s"),
    *("slider_acceleration_m_s2", "transmission_angle_deg"),
)
Ends = tuple[float, float]


class Draft(BaseModel, extra="forbid", strict=True):
    """A job that may be incomplete."""

    job: dict[str, Any] = Field(
        description="the tables of a job file",
        examples=[{"variables": {"crank": ["20 mm", "60 mm"], "rod": "100 mm", "offset": "10 mm"}}],
    )
    submission: dict[str, Any] = Field(
        default_factory=dict,
        description="priority and limits, side by side",
        examples=[{"priority": 1, "seconds": 600}],
    )


class WrongModel(BaseModel):
    """Mistake in a job. path: the key, "" for the whole job, or a name such as "submission.seconds".

    infeasible: whether the input is valid but no design can meet it.
    """

    path: str = Field(examples=["mechanism.slider.mass"])
    sentence: str = Field(examples=['must be a mass; got "2 mm", which is a length; write it like "0.8 kg"'])
    infeasible: bool = Field(False, examples=[False])


class AllowedModel(BaseModel):
    """Values that the ranges of crank, rod and offset allow, from samples.

    turning_share: fraction of the box that rotates fully. stroke_mm, time_ratio, transmission_angle_deg: ranges,
    subject to all other requirements on the dimensions; null if these exclude each other. slow_strokes: slow strokes of
    the designs that meet all checked requirements, or else of those that rotate fully. feasible_share: fraction of the
    `sampled` designs, spread uniformly, that meet all checked requirements; equalities are met exactly. hardest,
    hardest_share: the requirement that the fewest fully rotating designs meet. unchecked: requirements that take too
    long to check, or for which numbers of the machine are missing.
    """

    turning_share: float = Field(examples=[0.83])
    stroke_mm: Ends | None = Field(examples=[[40.0, 118.0]])
    time_ratio: Ends | None = Field(examples=[[1.0, 1.6]])
    transmission_angle_deg: Ends | None = Field(examples=[[2.0, 71.0]])
    slow_strokes: list[str] = Field(examples=[["inward", "outward"]])
    feasible_share: float = Field(examples=[0.4])
    sampled: int = Field(examples=[512])
    met_by_all: list[str] = Field(
        description="requirements that each sample meets: exact values and narrow bands", examples=[["stroke"]]
    )
    hardest: str | None = Field(examples=["transmission_angle"])
    hardest_share: float | None = Field(examples=[0.6])
    unchecked: list[str] = Field(examples=[["position_error"]])
    said: list[str] = Field(description="requirements that cannot be met, in words", examples=[[]])
    changes: list[ChangeModel] = Field(description="that settle them", examples=[[]])


class MotionModel(BaseModel):
    """Slider motion over one crank revolution, evenly spaced from 0 deg, at the job's speed or 1 rad/s."""

    crank_angle_deg: list[float]
    slider_position_mm: list[float]
    slider_velocity_m_s: list[float]
    slider_acceleration_m_s2: list[float]
    transmission_angle_deg: list[float]


class ExtremeModel(BaseModel):
    """Minimum or maximum of a curve over the continuous crank angle, in the unit of its key."""

    value: float = Field(examples=[0.38])
    crank_angle_deg: float = Field(examples=[298.7])


class ExampleModel(BaseModel):
    """Linkage within the ranges. feasible: whether it meets all checked requirements.

    slider_ends_mm, dead_centres_deg: slider positions and crank angles at the inner and outer dead centres.
    """

    crank_mm: float = Field(examples=[40.0])
    rod_mm: float = Field(examples=[100.0])
    offset_mm: float = Field(examples=[10.0])
    feasible: bool
    clockwise: bool
    slow_stroke: str = Field(examples=["outward"])
    stroke_mm: float
    slider_ends_mm: tuple[float, float] = Field(examples=[(59.2, 139.6)])
    dead_centres_deg: tuple[float, float] = Field(examples=[(189.6, 4.1)])
    time_ratio: float | None = Field(description="time ratio; null if cylinders differ", examples=[1.2])
    least_transmission_angle_deg: float
    motion: MotionModel
    extremes: dict[str, tuple[ExtremeModel, ExtremeModel]] | None = Field(
        description="minimum and maximum of each curve in motion; null unless all three lengths are fixed",
        examples=[
            {"slider_velocity_m_s": ({"value": -0.31, "crank_angle_deg": 87}, {"value": 0.38, "crank_angle_deg": 299})}
        ],
    )


class SwingCurve(BaseModel):
    """Slider motion over one crank revolution, evenly spaced from 0 deg; null outside the swing."""

    crank_angle_deg: list[float]
    slider_position_mm: list[float | None]


class SwingExample(BaseModel):
    """Linkage within the ranges that makes the swing. feasible: whether it meets all checked requirements.

    slider_ends_mm: slider positions at the start and end of the swing. outlines: null for a crank with rod and slider;
    of a lever, travel and positions are those of its cylinder.
    """

    crank_mm: float = Field(examples=[1400.0])
    rod_mm: float = Field(examples=[1800.0])
    offset_mm: float = Field(examples=[-50.0])
    feasible: bool
    travel_mm: float = Field(examples=[2200.0])
    slider_ends_mm: tuple[float, float] = Field(examples=[(2940.0, 740.0)])
    motion: SwingCurve
    outlines: OutlinesModel | None = None


class SwingPreview(BaseModel):
    """Values that the ranges of a swing job allow, from samples.

    closing_share: fraction of the box that makes the swing. travel_mm: slider travel between its ends; of a lever, that
    of its cylinder.
    feasible_share: fraction of the uniform samples that meet all checked requirements.
    """

    from_deg: float | None = Field(description="start of the example's swing; null without one", examples=[11.16])
    to_deg: float | None = Field(description="end of the example's swing; null without one", examples=[101.16])
    closing_share: float = Field(examples=[0.6])
    travel_mm: Ends | None = Field(description="travel; null if no design makes the swing", examples=[[1900.0, 2400.0]])
    feasible_share: float = Field(examples=[0.3])
    sampled: int = Field(examples=[512])
    met_by_all: list[str] = Field(
        description="requirements that each sample meets: exact values and narrow bands", examples=[["stroke"]]
    )
    unchecked: list[str] = Field(examples=[[]])
    example: SwingExample | None = Field(description="a linkage that makes the swing; null if none does")


class FormulaModel(BaseModel):
    """Formula in a job: its path, as in mistakes, and the kind and unit of its values.

    kind and unit: null for a mistake, or while those of a name in the formula are unknown.
    """

    path: str = Field(examples=['constraints."2 * crank + rod"'])
    kind: str | None = Field(examples=["length"])
    unit: str | None = Field(examples=["mm"])


class NameModel(BaseModel):
    """Name that only formulas of this job may use: a custom quantity, or a variable."""

    name: str = Field(examples=["clearance"])
    title: str = Field(examples=["clearance beside the crank"])
    unit: str | None = Field(description="unit; null while it is not known", examples=["mm"])


class PreviewModel(BaseModel):
    """Findings about a job during editing."""

    wrong: list[WrongModel]
    understood: Understood | None = Field(description="the job as it was understood, once nothing is wrong")
    allowed: AllowedModel | None = Field(description="values that the ranges allow; null while these cannot be read")
    example: ExampleModel | None = Field(description="a linkage within the ranges; null where none rotates fully")
    swing: SwingPreview | None = Field(
        description="values that a swing allows, once swing and ranges can be read; null for a rotating crank"
    )
    formulas: list[FormulaModel] = Field(description="formulas of the job, in their order", examples=[[]])
    names: list[NameModel] = Field(
        description="names that its formulas may contain besides those of /quantities", examples=[[]]
    )


@router.post("/preview")
def preview_job(draft: Draft, settings: SettingsDep) -> PreviewModel:
    """Preview a job that may be incomplete: mistakes and their places, values that its ranges allow, and an example."""
    look = job_preview(draft.job, lambda tables: problem_of_tables(tables, settings.allowed_quantities))
    return PreviewModel(
        wrong=[
            WrongModel(path=wrong.path[:500], sentence=wrong.sentence[:2000], infeasible=wrong.infeasible)
            for wrong in look.wrong
        ]
        + _submission_mistakes(draft.submission),
        understood=None if look.problem is None else describe_problem(look.problem, draft.job),
        allowed=_allowed_model(look),
        example=_example_design_model(look),
        swing=_swing_preview(look.swing),
        formulas=[
            FormulaModel(
                path=item.key[:500],
                kind=item.kind and item.kind.name_without_article,
                unit=_metric_unit_symbol(item.kind),
            )
            for item in look.formulas
        ],
        names=[
            NameModel(name=item.name[:500], title=item.title[:200], unit=_metric_unit_symbol(item.kind))
            for item in look.names
        ],
    )


def _submission_mistakes(submission: dict[str, Any]) -> list[WrongModel]:
    priority = {"priority": submission["priority"]} if "priority" in submission else {}
    limits = {key: value for key, value in submission.items() if key != "priority"}
    try:
        Submission.model_validate({"job": {}, "limits": limits, **priority})
    except ValidationError as error:
        return [
            WrongModel(path=f"submission.{details['loc'][-1]}"[:500], sentence=validation_message(details)[:2000])
            for details in error.errors(include_url=False)
        ]
    return []


def _metric_unit_symbol(kind: Kind | None) -> str | None:
    return None if kind is None else kind.metric.symbol


def _allowed_model(look: JobPreview) -> AllowedModel | None:
    possible = look.possible
    if possible is None:
        return None
    return AllowedModel(
        turning_share=possible.turning,
        stroke_mm=_ends_times_factor(1e3, possible.stroke),
        time_ratio=_ends_times_factor(1.0, possible.time_ratio),
        transmission_angle_deg=_ends_times_factor(180.0 / math.pi, possible.transmission_angle),
        slow_strokes=list(possible.slow_strokes),
        feasible_share=possible.feasible,
        sampled=possible.sampled,
        met_by_all=list(possible.met_by_all),
        hardest=possible.hardest[0] if possible.hardest else None,
        hardest_share=possible.hardest[1] if possible.hardest else None,
        unchecked=look.unchecked,
        said=look.sentences,
        changes=[ChangeModel(**change) for change in changes_of(look.sentences)],
    )


def _ends_times_factor(factor: float, ends: Ends | None) -> Ends | None:
    return None if ends is None else (factor * ends[0], factor * ends[1])


def _example_design_model(look: JobPreview) -> ExampleModel | None:
    if look.stated is None or look.possible is None or look.possible.example is None:
        return None
    machine = look.stated.mechanism
    linkage = Linkage(*look.possible.example, machine.branch)
    inner, outer = (math.degrees(float(angle)) for angle in linkage.dead_centre_angles)
    turning = replace(massless_machine(machine), speed=machine.speed or 1.0)
    return ExampleModel(
        crank_mm=1e3 * float(linkage.crank),
        rod_mm=1e3 * float(linkage.rod),
        offset_mm=1e3 * float(linkage.offset),
        feasible=look.possible.example_feasible,
        clockwise=machine.speed < 0.0,
        slow_stroke=str(slow_stroke(machine, linkage)),
        stroke_mm=1e3 * float(linkage.stroke),
        slider_ends_mm=(1e3 * float(linkage.dead_centres[0]), 1e3 * float(linkage.dead_centres[1])),
        dead_centres_deg=(inner, outer),
        time_ratio=float(time_ratio(machine, linkage)) if ONE_TIMING.is_met(machine) else None,
        least_transmission_angle_deg=math.degrees(float(linkage.least_transmission_angle)),
        motion=_motion_model(turning, linkage),
        extremes=_extreme_models_by_curve(turning, linkage)
        if all(look.stated.ranges[name].fixed for name in DIMENSIONS)
        else None,
    )


def _swing_preview(possible: PossibleSwing | None) -> SwingPreview | None:
    if possible is None:
        return None
    return SwingPreview(
        from_deg=None if possible.example_swing is None else math.degrees(possible.example_swing.start),
        to_deg=None if possible.example_swing is None else math.degrees(possible.example_swing.end),
        closing_share=possible.closing,
        travel_mm=_ends_times_factor(1e3, possible.travel),
        feasible_share=possible.feasible,
        sampled=possible.sampled,
        met_by_all=list(possible.met_by_all),
        unchecked=list(possible.unchecked),
        example=None if possible.example is None else _swing_example(possible, possible.example),
    )


def _swing_example(possible: PossibleSwing, lengths: tuple[float, float, float]) -> SwingExample:
    swing = possible.example_swing or possible.swing
    low, high = sorted((math.degrees(swing.start), math.degrees(swing.end)))
    # One point per degree: the points of a full revolution that lie within the swing, plus one beyond each end at the
    # position of that end.
    angles = range(math.floor(low), math.floor(high) + 2)
    clipped_angles = np.radians(np.clip(angles, low, high))
    places = {angle % 360: possible.position_at(at) for angle, at in zip(angles, clipped_angles, strict=True)}
    curve = [places.get(angle, math.nan) for angle in range(360)]
    ends = possible.ends_of(swing)
    crank, rod, offset = (1e3 * length for length in lengths)
    lever = possible.example_lever
    return SwingExample(
        crank_mm=crank,
        rod_mm=rod,
        offset_mm=offset,
        feasible=possible.example_feasible,
        travel_mm=1e3 * abs(ends[1] - ends[0]),
        slider_ends_mm=(1e3 * ends[0], 1e3 * ends[1]),
        motion=SwingCurve(
            crank_angle_deg=[float(angle) for angle in range(360)],
            slider_position_mm=[1e3 * x if math.isfinite(x) else None for x in curve],
        ),
        outlines=None if lever is None else outlines_model(lever, Linkage(*lengths), swing),
    )


def _motion_model(turning: Mechanism, linkage: Linkage) -> MotionModel:
    curves = {column.key: column.values for column in cycle_table(turning, linkage, angles=_ANGLES)}
    return MotionModel(**{key: curves[key] for key in _CURVES})


def _extreme_models_by_curve(turning: Mechanism, linkage: Linkage) -> dict[str, tuple[ExtremeModel, ExtremeModel]]:
    extremes = {}
    for curve in curve_extremes(turning, linkage):
        key = f"{curve.name}{curve.kind.metric.suffix}"
        if key in _CURVES:
            least, greatest = (
                ExtremeModel(value=curve.kind.metric.factor * end.value, crank_angle_deg=math.degrees(end.crank_angle))
                for end in (curve.least, curve.greatest)
            )
            extremes[key] = (least, greatest)
    return extremes
