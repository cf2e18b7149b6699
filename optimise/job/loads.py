"""The loads on the slider in a job file, [[load]], and how each becomes a load of the model. Several add up."""

from __future__ import annotations

import itertools
from functools import cached_property
from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    model_validator,
)

from ...model.errors import InputError
from ...model.machine import loads as model
from ...model.machine.loads import Datum, During
from .kinds import Kinds
from .units import shown
from .values import Angle, Damping, Force, Length, Part, Resistance, Stiffness

_DURING: Any = Field("cycle", description="when the load acts", examples=["outward stroke"])
_DATUM: Any = Field(
    "crank pivot",
    description="what the positions are counted from: the crank pivot or the inner dead centre "
    "(both outward), or the outer dead centre (inward)",
    examples=["outer dead centre"],
)
_FORCES: Any = Field(
    min_length=2,
    max_length=1000,
    description="force on the slider at each point, positive outward, away from the crank pivot",
    examples=[["-600 N", "0 N"]],
)


def increasing(given: Any, handler: ValidatorFunctionWrapHandler) -> tuple[float, ...]:
    """Return the points of a table in SI, refusing any that is not above the one before."""
    points: tuple[float, ...] = handler(given)
    for n, (before, after) in enumerate(itertools.pairwise(points)):
        if after <= before:
            raise InputError(f"must increase; got {shown(given[n + 1])} after {shown(given[n])}; sort the table")
    return points


class OpposingForce(Part):
    """A force of constant size that opposes a stroke, or every motion (Coulomb friction of known size)."""

    force: Resistance = Field(description="its size", examples=["200 N"])
    opposes: Literal["outward stroke", "inward stroke", "motion"] = Field(
        description="what it resists", examples=["outward stroke"]
    )

    def build(self) -> model.Load:
        """Return the load as the model has it."""
        return model.StrokeForce(
            outward=0.0 if self.opposes == "inward stroke" else -self.force,
            inward=0.0 if self.opposes == "outward stroke" else self.force,
        )


class DirectedForce(Part):
    """A force of constant size and direction, throughout or during one stroke."""

    force: Resistance = Field(description="its size", examples=["200 N"])
    direction: Literal["outward", "inward"] = Field(
        description="where it pushes the slider: outward is away from the crank pivot",
        examples=["inward"],
    )
    during: During = _DURING

    def build(self) -> model.Load:
        """Return the load as the model has it."""
        force = self.force if self.direction == "outward" else -self.force
        return model.StrokeForce(
            outward=0.0 if self.during == "inward stroke" else force,
            inward=0.0 if self.during == "outward stroke" else force,
        )


class SpringLoad(Part):
    """A linear spring between slider and frame."""

    stiffness: Stiffness = Field(description="of the spring", examples=["20 N/mm"])
    free_position: Length = Field(description="slider position where the spring is free of force", examples=["25 mm"])
    measured_from: Datum = _DATUM

    def build(self) -> model.Load:
        """Return the load as the model has it."""
        return model.Spring(stiffness=self.stiffness, free_position=self.free_position, datum=self.measured_from)


class ViscousLoad(Part):
    """A resistance proportional to the slider speed."""

    viscous: Damping = Field(description="force per speed", examples=["50 N s/m"])

    def build(self) -> model.Load:
        """Return the load as the model has it."""
        return model.Viscous(coefficient=self.viscous)


class PositionLoad(Part):
    """A force tabulated over the slider position: linear between the points, constant beyond them."""

    positions: Annotated[tuple[Length, ...], WrapValidator(increasing)] = Field(
        min_length=2,
        max_length=1000,
        description="slider positions, increasing",
        examples=[["0 mm", "20 mm"]],
    )
    forces: tuple[Force, ...] = _FORCES
    measured_from: Datum = _DATUM
    during: During = _DURING

    @model_validator(mode="after")
    def _possible(self) -> PositionLoad:
        self.build()
        return self

    def build(self) -> model.Load:
        """Return the load as the model has it."""
        return self.built

    @cached_property
    def built(self) -> model.Load:
        """The load as the model has it, which takes a time where a table is long."""
        return model.PositionTable(
            positions=self.positions,
            forces=self.forces,
            datum=self.measured_from,
            during=self.during,
        )


class AngleLoad(Part):
    """A force tabulated over the crank angle: linear between the points, periodic."""

    crank_angles: Annotated[tuple[Angle, ...], WrapValidator(increasing)] = Field(
        min_length=2,
        max_length=1000,
        description="crank angles, increasing, spanning less than 360 deg",
        examples=[["0 deg", "90 deg"]],
    )
    forces: tuple[Force, ...] = _FORCES
    during: During = _DURING

    @model_validator(mode="after")
    def _possible(self) -> AngleLoad:
        self.build()
        return self

    def build(self) -> model.Load:
        """Return the load as the model has it."""
        return self.built

    @cached_property
    def built(self) -> model.Load:
        """The load as the model has it, which takes a time where a table is long."""
        return model.AngleTable(angles=self.crank_angles, forces=self.forces, during=self.during)


# The key that tells a kind of load, in the order in which kinds are told apart.
_KINDS = Kinds(
    {
        "opposes": OpposingForce,
        "direction": DirectedForce,
        "stiffness": SpringLoad,
        "viscous": ViscousLoad,
        "positions": PositionLoad,
        "crank_angles": AngleLoad,
    },
    "{ force, opposes }, { force, direction }, { stiffness, free_position }, { viscous }, "
    "{ positions, forces } or { crank_angles, forces }",
    "give each its own [[load]], loads add up",
)

Load = Annotated[
    Annotated[OpposingForce, Tag("(opposes)")]
    | Annotated[DirectedForce, Tag("(direction)")]
    | Annotated[SpringLoad, Tag("(stiffness)")]
    | Annotated[ViscousLoad, Tag("(viscous)")]
    | Annotated[PositionLoad, Tag("(positions)")]
    | Annotated[AngleLoad, Tag("(crank_angles)")],
    Discriminator(_KINDS.tag),
    BeforeValidator(_KINDS.one),
]
