"""The job: content of a job file, key by key. Also the JSON body of a request. After reading, every value is in SI.

Its JSON Schema is of draft 2020-12.
"""

from functools import lru_cache
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, Field
from pydantic_core import CoreSchema, core_schema

from ...model.errors import InputError
from ...model.machine.cylinders_and_turns import turns_per_cycle
from ...model.machine.mechanism import Mechanism, SliderDistances
from ...model.swing.swing import Swing
from ...objectives.units import quote
from ..methods.registry import methods_by_name
from ..problem.problem import Settings
from .constraints_and_objectives import ConstraintsPart, ObjectivesPart, Stated, constraint_and_objective_tables
from .custom_quantities import MOST_QUANTITIES, Declared, QuantityPart, require_one_line, require_usable_names
from .drive import ClearancePart, DrivePart, FrictionPart
from .lever import ArmPart, CylinderPart, SpringPart, lever_of, swing_of
from .loads import Load
from .mechanism import MechanismPart, TolerancesPart
from .motion import MotionPart
from .sections_table import EXAMPLE as SECTIONS
from .sections_table import CostsPart, RobustPart, SectionsPart
from .target_motion import TargetMotionPart
from .value_types import Built, Part, optional_entry, required_entry, with_entry_types
from .variables import ChoicePart, VariablesPart, choice_type_with_constraints

EXAMPLE = {
    "option": [
        {"name": "GM 40", "constraints": {"peak_torque": {"max": "40 N m"}}},
        {"name": "GM 90", "constraints": {"peak_torque": {"max": "90 N m"}}},
    ],
    "constraints": {"transmission_angle": {"min": "40 deg"}},
    "objectives": {"time_ratio": "maximise", "peak_torque": "minimise"},
}
"""Maximum length of the tables that name quantities."""

LARGEST_SEED = 2**53 - 1
"""JSON readers must not change it, and a browser stores whole numbers as floats."""


class _MethodName:
    """The name of a method; the schema lists all methods."""

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        return core_schema.literal_schema(list(methods_by_name()))


class OptimiserPart(Built[Settings]):
    """Settings of the search."""

    makes = Settings

    method: Annotated[str, _MethodName()] = optional_entry(
        "search method: the default finds the front of any number of objectives and polishes every design; the others "
        "return unpolished designs",
        "auto",
        default="auto",
    )
    designs: Annotated[int, Field(strict=True, ge=1, le=10_000)] = optional_entry(
        "maximum number of designs on the front", 100, default=100
    )
    samples: Annotated[int, Field(strict=True, ge=1, le=10_000_000)] | None = optional_entry(
        "designs evaluated per round of the search; default chosen by the method", 20_000
    )
    evaluations: Annotated[int, Field(strict=True, ge=1, le=100_000_000)] | None = optional_entry(
        "maximum number of designs that a method other than auto evaluates; default chosen by the method", 50_000
    )
    seed: Annotated[int, Field(strict=True, ge=0, le=LARGEST_SEED)] = optional_entry(
        "random seed: the same job with the same seed gives the same front", 1, default=1
    )


def _require_printable(text: str) -> str:
    if not text.strip() or not text.replace("\n", " ").replace("\t", " ").isprintable():
        raise InputError(f"must be printable text, not empty; got {quote(text)}")
    return text


def _require_objective(objectives: ObjectivesPart) -> ObjectivesPart:
    if not objectives.model_fields_set:
        raise InputError(
            'must name at least one quantity; got an empty table; for example, add peak_torque = "minimise"'
        )
    return objectives


class Job(Part):
    """A slider-crank to be sized: what is fixed, what may vary, what must hold, and the objectives."""

    name: Annotated[str, Field(max_length=80), AfterValidator(require_one_line)] = required_entry(
        "name of the job and of its run", "Vibrating sieve"
    )
    description: Annotated[str, Field(max_length=4000), AfterValidator(_require_printable)] | None = optional_entry(
        "any text to store with the results", "Second draft"
    )
    mechanism: MechanismPart = required_entry(
        "speed, masses and gravity of the machine", {"speed": "300 rpm", "slider": {"mass": "0.8 kg"}}
    )
    motion: MotionPart = optional_entry(
        "motion of the crank: it rotates fully, or swings between two angles, driven at the crank or at the slider",
        {"kind": "turn"},
        default=MotionPart(),
    )
    cylinder: CylinderPart | None = optional_entry(
        'cylinder of inversion = "turning cylinder": its size, pressure, friction and masses',
        {"bore": "40 mm", "rod": "25 mm", "supply_pressure": "160 bar"},
    )
    arm: ArmPart | None = optional_entry(
        'arm that the crank of inversion = "turning cylinder" turns about the cylinder\'s pivot: masses, torque, ram',
        {"inertia": "0.5 kg m^2", "ram": "500 mm", "ram_force": "2 kN"},
    )
    spring: SpringPart | None = optional_entry(
        'gas or coil spring on the lever of inversion = "turning cylinder"',
        {"frame": "500 mm", "frame_angle": "-90 deg", "lever": "300 mm", "force": "600 N", "length": "450 mm"},
    )
    load: tuple[Load, ...] = optional_entry(
        "loads on the slider along its line, or on the crank; several add up",
        [{"force": "200 N", "opposes": "outward stroke"}],
        default=(),
        max_length=50,
    )
    drive: DrivePart | None = optional_entry(
        "motor, gearbox and flywheel, for analyses that compute the speed",
        {"motor": {"torque": "20 N m"}, "flywheel": "0.5 kg m^2"},
    )
    friction: FrictionPart = optional_entry(
        "Coulomb friction in the guide and in the three pins; default: none",
        {"guide": 0.1, "crank_pin": {"radius": "10 mm", "coefficient": 0.08}},
        default=FrictionPart(),
    )
    tolerances: TolerancesPart = optional_entry(
        "tolerances of dimensions and crank angle",
        {"crank": "0.05 mm", "crank_angle": "0.1 deg"},
        default=TolerancesPart(),
    )
    clearance: ClearancePart | None = optional_entry(
        "a joint with clearance, for the simulation of its impacts; designs are sized with ideal joints",
        {"joint": "crank pin", "radial_clearance": "1 mm", "journal_radius": "10 mm"},
    )
    costs: CostsPart | None = optional_entry(
        "costs of tolerances, for their allocation",
        {"crank": {"cost": 8.0, "at": "0.05 mm"}, "crank_angle": {"cost": 10.0, "at": "0.1 deg"}},
    )
    target_motion: TargetMotionPart | None = optional_entry(
        "target slider motion, from which motion_deviation and motion_deviation_rms are measured",
        {"crank_angles": ["0 deg", "90 deg", "180 deg"], "positions": ["240 mm", "200 mm", "160 mm"]},
    )
    quantity: Annotated[
        dict[str, QuantityPart], Field(max_length=MOST_QUANTITIES), AfterValidator(require_usable_names)
    ] = optional_entry(
        "custom formulas and functions as quantities, by name",
        {"clearance": {"formula": "offset - crank"}},
        {"least_jerk": {"function": "mymodule:greatest_jerk", "unit": "m/s^3"}},
        default={},
    )
    variables: VariablesPart = required_entry(
        "ranges of the three dimensions and of any other number of the job",
        {"crank": ["20 mm", "200 mm"], "rod": ["60 mm", "600 mm"], "offset": ["0 mm", "200 mm"]},
    )
    choice: tuple[ChoicePart, ...] = optional_entry(
        "choices between options that each set several numbers; every combination is tried",
        [{"name": "gearmotor", "option": EXAMPLE["option"]}],
        default=(),
        max_length=10,
    )
    constraints: ConstraintsPart = optional_entry(
        "requirements that every design must meet", EXAMPLE["constraints"], default=ConstraintsPart()
    )
    objectives: Annotated[ObjectivesPart, AfterValidator(_require_objective)] = required_entry(
        "objectives: the front shows the best compromises", EXAMPLE["objectives"]
    )
    robust: RobustPart | None = optional_entry(
        "objectives and constraints within the tolerances", {"kind": "percentile", "share": 0.99}
    )
    sections: SectionsPart | None = optional_entry(
        "material, pins and safety of crank and rod, for stress and safety and the sizing of sections", SECTIONS
    )
    optimiser: OptimiserPart = optional_entry("how to search", {"designs": 200, "seed": 1}, default=OptimiserPart())

    def swing(self) -> Swing | None:
        """Return the swing of its crank or lever; None for a crank that rotates fully."""
        return swing_of(self.mechanism, self.motion)

    def machine(self) -> Mechanism:
        """Return the machine of the job with its numbers as stated."""
        mechanism = self.mechanism
        parts: dict[str, Any] = {
            "crank": mechanism.crank,
            "rod": mechanism.rod,
            "counterweight": mechanism.counterweight,
        }
        parts |= {"drive": self.drive, "clearance": self.clearance, "arrangement": mechanism.cylinders}
        parts |= {"speed_profile": mechanism.speed_profile}
        loads = tuple(load.build() for load in self.load)
        return Mechanism(
            speed=mechanism.crank_speed(turns_per_cycle(loads)),
            acceleration=mechanism.acceleration,
            slider_mass=0.0 if mechanism.slider is None else mechanism.slider.mass,
            slider=SliderDistances() if mechanism.slider is None else mechanism.slider.distances,
            gravity=mechanism.gravity_vector,
            loads=loads,
            tolerances=self.tolerances.build(),
            friction=self.friction.with_pins(None if self.sections is None else self.sections.pins),
            branch=mechanism.branch,
            strength=None if self.sections is None else self.sections.strength(),
            start=self.motion.start_ranges,
            lever=lever_of(mechanism, self.cylinder, self.arm, self.spring),
            **{name: part.build() for name, part in parts.items() if part is not None},
        )


def job_type_with_quantities(declared: Declared) -> type[Job]:
    """Return the job type whose [objectives] and [constraints], also those of options, may name custom quantities."""
    if not declared.tables and not declared.formulas:
        return Job
    return _job_type_with(tuple(declared.tables.items()), declared.formulas)


# A form requests the same job type repeatedly, and building one takes as long as reading ten jobs.
@lru_cache(maxsize=16)
def _job_type_with(custom_facts: tuple[tuple[str, Stated], ...], formulas: tuple[str, ...]) -> type[Job]:
    constraints, objectives = constraint_and_objective_tables(dict(custom_facts), formulas)
    choice: Any = choice_type_with_constraints(constraints)
    wishes: Any = Annotated[objectives, AfterValidator(_require_objective)]
    return with_entry_types(Job, choice=tuple[choice, ...], constraints=constraints, objectives=wishes)


@lru_cache(maxsize=16)
def schema_of(job: type[BaseModel]) -> dict[str, Any]:
    """Return the JSON Schema of a job, without nulls; do not change it, because it is cached."""
    schema = job.model_json_schema(mode="validation")
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_without_null(schema)}


def _without_null(node: Any) -> Any:
    """Return a schema without nulls, because optional keys are omitted instead."""
    if isinstance(node, list):
        return [_without_null(item) for item in node]
    if not isinstance(node, dict):
        return node
    entries = {key: _without_null(item) for key, item in node.items()}
    if entries.get("default", 0) is None or isinstance(entries.get("default"), dict):
        del entries["default"]
    choices = [choice for choice in entries.get("anyOf", ()) if choice != {"type": "null"}]
    if len(choices) == 1 and len(entries["anyOf"]) == 2:
        del entries["anyOf"]
        return {**choices[0], **entries}
    return {**entries, "anyOf": choices} if choices else entries
