"""Analysis of one design: its quantities, reasons for undefined ones, and its cycle."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, TypeVar, overload

import numpy as np
from numpy.typing import ArrayLike

from ...model.errors import InputError, number_in_si_and_usual_unit, warn_user
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.linkage.linkage_values import real_or_complex_array
from ...model.machine.cylinders_and_turns import cycle_turns
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...objectives.formula.quantity import FormulaQuantity
from ...objectives.formula.resolve_names import resolve_quantities
from ...objectives.kinds import ANGLE, unit_text
from ...objectives.quantity import Array, Quantity, Values
from ...objectives.registry import QUANTITIES
from ...objectives.tables.all_quantities import missing_value_reason
from ...objectives.tables.curve_deviation import curve_deviations
from ...objectives.tables.cycle_curves import Curve, cycle_curves, cycle_table, even_angles
from ...objectives.tables.design_input import (
    designs_as_array,
    has_finite_numbers,
    names_of_design_numbers,
    printed_or_type_text,
    require_machine,
    warn_of_lengths,
)
from ...objectives.tables.evaluate_quantities import violations_of_allowables
from ...objectives.tables.measured_curves import samples_of_measured_table
from ...objectives.tables.swing_columns import linkage_that_can_move, quantities_for_swing, require_quantities_of_motion
from ...objectives.tables.swing_curves import curves_of_both_strokes, motion_and_drive_curves, swing_table

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

Default = TypeVar("Default")
_DEVIATION = (
    *("title", "unit", "samples", "rms", "mean", "largest", "largest_at_rad"),
    *("best_shift_rad", "best_shift", "rms_left"),
)
_PLOTTED = ("slider_position", "slider_velocity", "slider_acceleration", "torque", "drive")


@dataclass(frozen=True)
class Analysis(Mapping[str, float]):
    """One design with all its quantities: `analysis["peak_torque"]` is a number in SI.

    It maps the quantities' names in job files to their values. It excludes quantities that the machine does not define:
    accessing one raises `InputError` with the reason, and `undefined` has the reasons for all. mechanism: the machine
    of this design.
    linkage: its dimensions. quantity_values: the mapping itself. title: title of the problem, "" if it has none. swing:
    motion of its crank instead of a full turn.
    """

    mechanism: Mechanism
    linkage: Linkage
    quantity_values: Mapping[str, float]
    undefined: Mapping[str, str]
    quantities: tuple[Quantity, ...]
    title: str = ""
    swing: Swing | None = None

    def __getitem__(self, name: str) -> float:
        """Return the value of a quantity or formula, SI. Raises `InputError` if it is undefined or unknown."""
        if name in self.quantity_values:
            return self.quantity_values[name]
        if name in self.undefined:
            raise InputError(f"{name} is not defined here: {self.undefined[name]}")
        require_quantities_of_motion([name], self.quantities, self.swing)
        (known,) = resolve_quantities([name], self.mechanism, self.quantities, turning=self.swing is None)
        if isinstance(known, FormulaQuantity) and known.name not in self.quantity_values:
            return self._formula_value(known)
        if known.name not in self.quantity_values:
            raise InputError(
                f"{name} needs a rotating crank; this crank swings; ask for a quantity of a swing, such as "
                f"{', '.join(of.name for of in self.quantities if of.name in self.quantity_values)}"
            )
        return self.quantity_values[known.name]

    def _formula_value(self, formula: FormulaQuantity) -> float:
        sizes = [float(getattr(self.linkage, name)) for name in DIMENSIONS]
        parts = {part.name: Values(np.array([self[part.name]]), None) for part in formula.parts}
        return float(formula.combine_parts(parts, self.mechanism, np.array([sizes]), gradients=False).values[0])

    @overload
    def get(self, name: str, /) -> float | None: ...
    @overload
    def get(self, name: str, /, default: float | Default) -> float | Default: ...
    def get(self, name: str, /, default: object = None) -> object:
        """Return the value of a quantity, SI, or `default` if it is undefined or unknown."""
        return self.quantity_values.get(name, default)

    def __contains__(self, name: object) -> bool:
        return name in self.quantity_values

    def __iter__(self) -> Iterator[str]:
        return iter(self.quantity_values)

    def __len__(self) -> int:
        return len(self.quantity_values)

    @property
    def violated(self) -> dict[str, float]:
        """Excess over each allowable value that the design violates, SI, by quantity.

        Allowable values are the bearing pressure and the shear yield strength S_y / sqrt(3) of the material at the
        pins, and safety factors of 1 in the bars. Without a material, there are none.
        """
        return {
            name: float(beyond[0])
            for name, beyond in violations_of_allowables(self.mechanism, self.quantity_values.get).items()
        }

    def table(self) -> pd.DataFrame:
        """Return a table with one row per quantity, by name: title, value, display unit, reason if undefined."""
        rows = {
            item.name: {
                "title": item.title,
                "value": item.unit.factor * self.quantity_values.get(item.name, np.nan),
                "unit": item.unit.symbol,
                "undefined_because": self.undefined.get(item.name, ""),
            }
            for item in self.quantities
        }
        import pandas as pd

        return pd.DataFrame.from_dict(rows, orient="index")

    def cycle(self, angles: int | ArrayLike = 360) -> pd.DataFrame:
        """Return the curves over the cycle in SI, one row per crank angle; for a swing, over both strokes.

        angles: number of crank angles, evenly spaced over the cycle from 0 (two turns if a load has a cycle of 720
        deg); or crank angles (n,), rad. Columns carry their unit: crank_angle_rad, slider_position_m,
        slider_velocity_m_s, slider_acceleration_m_s2, slider_jerk_m_s3, rod_angle_rad, transmission_angle_rad,
        torque_Nm, power_W, load_N, the joint forces, position errors. See `cycle_curves`. Issues an `InputWarning` for
        angles beyond two turns, which are probably in degrees.

        For a swing, angles is the number of evenly spaced times; see `objectives.tables.swing_curves.swing_table`.
        """
        if self.swing is not None:
            return swing_table(self.mechanism, self.linkage, self.swing, angles)
        for angle in () if np.ndim(angles) == 0 else real_or_complex_array(angles, "a crank angle").real.flat:
            if math.isfinite(angle) and not ANGLE.is_plausible(angle):
                usual = ANGLE.metric
                doubt = number_in_si_and_usual_unit("crank angle", angle, ANGLE.unit, usual.symbol, usual.factor)
                warn_user(f"crank angles must be in rad: {doubt}")
                break
        return cycle_table(self.mechanism, self.linkage, angles)

    def deviations(self, measured: Mapping[str, ArrayLike] | pd.DataFrame) -> pd.DataFrame:
        """Return the deviations of measured curves from the computed ones in SI, one row per curve, by name.

        measured: columns with units in their names: crank_angle_deg, or time_s at constant speed, and curves of `cycle`
        in SI, metric or inch units, such as slider_position_mm; NaN where nothing was measured. Columns of the result:
        title, unit, samples, rms, mean, largest (with its sign) and largest_at_rad; best_shift_rad and best_shift,
        which minimise rms_left when added to the measured crank angles and values. Raises `InputError` for a table
        without crank angle or curve, wrong units, impossible values, or a design that swings.
        """
        if self.swing is not None:
            raise InputError(
                "measured curves can only be compared for a crank that rotates fully; got a crank that swings, "
                "which passes each angle twice; compare with `Analysis.cycle`, which has both strokes over time"
            )
        import pandas as pd

        given = samples_of_measured_table(measured, self.mechanism, self.linkage)
        rows = {}
        for found in curve_deviations(self.mechanism, self.linkage, given.crank_angle, given.values):
            fit = (found.fit.crank_angle, found.fit.value, found.fit.rms) if found.fit else (np.nan,) * 3
            numbers = (found.count, found.rms, found.mean, found.largest, found.crank_angle, *fit)
            rows[found.name] = dict(zip(_DEVIATION, (found.title, found.kind.unit, *numbers), strict=True))
        return pd.DataFrame.from_dict(rows, orient="index")

    def plot(self) -> Figure:
        """Return a matplotlib figure of position, velocity, acceleration and drive over the cycle or both strokes."""
        from ...model.notebook_figure import NotebookFigure

        strokes = self._curves_of_strokes()
        names = [name for name in _PLOTTED if name in strokes[0]]
        found = NotebookFigure(figsize=(6.4, 2.0 * len(names)), layout="constrained")
        for name, axes in zip(names, np.atleast_1d(found.subplots(len(names), 1, sharex=True)), strict=True):
            for curves in strokes:
                curve, angle = curves[name], curves["crank_angle"]
                axes.plot(angle.kind.metric.factor * angle.values, curve.kind.metric.factor * curve.values)
            axes.set_ylabel(f"{curve.title},\n{unit_text(curve.kind.metric.symbol)}")
            axes.set_xlabel("crank angle, deg")
            if self.swing is None:
                turns = cycle_turns(self.mechanism)
                axes.set_xticks(range(0, 360 * turns + 1, 60 * turns))
            axes.label_outer()
        found.suptitle(self.title or self.linkage.label)
        return found

    def _curves_of_strokes(self) -> list[dict[str, Curve]]:
        """Return the curves by name: over the closed cycle, or over the forward and return strokes of a swing."""
        if self.swing is None:
            turns = cycle_turns(self.mechanism)
            closed_angles = turns * np.append(even_angles(360 * turns), 2.0 * np.pi)
            return [{curve.name: curve for curve in cycle_curves(self.mechanism, self.linkage, closed_angles)}]
        described = {curve.name: curve for curve in motion_and_drive_curves(self.swing)}
        return [
            {name: Curve(name, one.title, getattr(way, one.attribute), one.kind) for name, one in described.items()}
            for way in curves_of_both_strokes(self.mechanism, self.linkage, self.swing)
        ]

    def _repr_html_(self) -> str:
        """Drawing of the linkage and table of its quantities, for notebooks."""
        picture = "" if self.mechanism.lever is not None else self.linkage._repr_html_() or ""
        table = self.table().to_html(float_format="{:.5g}".format, na_rep="")
        lines = "".join(f"<p>{escape(line)}</p>" for line in (self.title, self._exceeded_allowables_text()) if line)
        return f"<div>{lines}{picture}{table}</div>"

    def __repr__(self) -> str:
        named_quantities = [item for item in self.quantities if item.name in self.quantity_values][:4]
        numbers = ", ".join(
            f"{item.title} {item.unit.factor * self.quantity_values[item.name]:.4g} {item.unit.symbol}".rstrip()
            for item in named_quantities
        )
        parts = [
            numbers,
            f"{len(self.quantity_values)} quantities, {len(self.undefined)} undefined",
            self._exceeded_allowables_text(),
        ]
        return f"Analysis({self.linkage.label}: {'; '.join(filter(None, parts))})"

    def _exceeded_allowables_text(self) -> str:
        titles = [QUANTITIES[name].title for name in self.violated]
        return f"beyond the allowable value: {', '.join(titles)}" if titles else ""


def machine_and_design_row(mechanism: Mechanism, design: ArrayLike) -> tuple[Mechanism, Array]:
    """Return a design's machine and numbers (3 + k,); raise `InputError` for anything that is not a design."""
    require_machine(mechanism)
    names = names_of_design_numbers(mechanism)
    sizes = designs_as_array(design, names)
    if sizes.ndim != 1 or not np.isfinite(sizes).all() or (sizes[0] > 0.0 and not has_finite_numbers(sizes[None])[0]):
        raise InputError(
            f"a design must be {len(names)} finite numbers ({', '.join(names)}), SI; got "
            f"{printed_or_type_text(design)}; "
            "give one "
            "design, as a list of these"
        )
    machine = mechanism.with_values(sizes[3:].tolist())
    return machine, sizes


def analyse(
    mechanism: Mechanism,
    design: ArrayLike,
    *,
    own: Sequence[Quantity] = (),
    title: str = "",
    swing: Swing | None = None,
) -> Analysis:
    """Return the analysis of one design (3 + k,): crank, rod, offset, m, and the machine's k extra variables, SI.

    own: custom quantities besides the built-in ones. swing: motion that the design must make instead of a full turn.
    Raises `AssemblyError` for a design that does not rotate fully, and `InputError` for one that is not 3 + k finite
    numbers or cannot make the swing. Warns once per machine about lengths that are probably in mm.

    >>> from slidercrank import Mechanism, analyse
    >>> analysis = analyse(Mechanism(slider_mass=0.8, speed=30.0), [0.04, 0.1, 0.02])
    >>> round(analysis["peak_torque"], 6)
    1.05063
    """
    machine, sizes = machine_and_design_row(mechanism, design)
    warn_of_lengths(mechanism, sizes)
    return analyse_machine(mechanism, machine, sizes, own=own, title=title, swing=swing)


def analyse_machine(
    mechanism: Mechanism,
    machine: Mechanism,
    sizes: Array,
    *,
    own: Sequence[Quantity] = (),
    title: str = "",
    swing: Swing | None = None,
) -> Analysis:
    """Return the result of `analyse`. machine: machine of the design with the numbers `sizes` (3 + k,)."""
    given = Linkage(sizes[0], sizes[1], sizes[2], machine.branch)
    linkage = linkage_that_can_move(machine, given, swing)
    values: dict[str, float] = {}
    undefined: dict[str, str] = {}
    chosen = (*QUANTITIES.values(), *own) if swing is None else quantities_for_swing(own)
    row = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset), *sizes[3:]]])
    for item in chosen:
        reason = item.undefined_because([mechanism]) or item.zero_because([mechanism])
        if reason:
            undefined[item.name] = reason
        else:
            value = float(item.evaluate(mechanism, row).values[0])
            reason = missing_value_reason(item, value, machine, linkage, swing)
            if reason:
                undefined[item.name] = reason
            else:
                values[item.name] = value
    return Analysis(machine, linkage, values, undefined, chosen, title, swing)
