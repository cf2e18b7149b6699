"""Designs as callers pass them: arrays, lists, or pandas tables with a column for each number in a design."""

import re
import sys
import warnings
from collections.abc import Sequence

import numpy as np

from ...model.arrays import Mask
from ...model.errors import LONGEST, InputError, InputWarning
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage_values import implausible_length_text
from ...model.machine.mechanism import Mechanism
from ...model.machine.raw_numbers_of_designs import unit_of_number
from ...model.machine.varying_numbers import Varying
from ..kinds import KINDS, LENGTH, DisplayUnit
from ..quantity import Array


def column_of_variable(varying: Varying) -> tuple[str, DisplayUnit]:
    """Return the key of a variable in tables and JSON, and its unit there.

    The key is the name without a leading "mechanism", with underscores, and the unit: "mechanism.slider.mass" becomes
    slider_mass_kg, "load.1.force" load_1_force_N. A fraction of a dimension has no unit.
    """
    unit = next(kind.metric for kind in KINDS if kind.unit == unit_of_number(varying.paths[0]))
    name = re.sub("[^a-z0-9]+", "_", varying.name.removeprefix("mechanism.").lower()).strip("_")
    return name + unit.suffix, unit


def words_of_number_name(name: str) -> str:
    """Return the words for a number in a job from its name or key: "slider mass", "crank pin diameter"."""
    words = re.sub("[._]", " ", name.removeprefix("mechanism."))
    return re.sub("^sections pins (.+)", r"\1 diameter", words)


def columns_of_design_numbers(varying: Sequence[Varying]) -> dict[str, tuple[str, DisplayUnit]]:
    """Return key and unit for each number of a design by name: crank, rod, offset, and extra variables."""
    lengths = {name: (f"{name}{LENGTH.metric.suffix}", LENGTH.metric) for name in DIMENSIONS}
    return lengths | {item.name: column_of_variable(item) for item in varying}


_LEAST, _MOST = 1e-50, 1e50
"""Lengths, m: the fifth power of anything longer may overflow double precision."""
_WARNED = "lengths warned of"
"""Stored in a machine or problem so that it warns only once."""


def names_of_design_numbers(mechanism: Mechanism) -> tuple[str, ...]:
    """Return the names of the numbers in a design for a machine, in order."""
    return (*DIMENSIONS, *(item.name for item in mechanism.varying))


def require_machine(mechanism: object) -> None:
    """Raise `InputError` unless the argument is a machine: problems and job tables have their own functions."""
    if not isinstance(mechanism, Mechanism):
        raise InputError(
            f"a machine is needed; got {type(mechanism).__name__}; give a Mechanism, or build a problem with "
            "`problem` or `load_job` and use its evaluate and analyse"
        )


def designs_as_array(designs: object, names: Sequence[str]) -> Array:
    """Return designs (..., k) as an array, SI, with numbers in the order of the names.

    Table columns, or the index of one row, are found by these names, in any order and among others; without names their
    order counts. Raises `InputError` for values other than real numbers, for other columns, and other widths.
    """
    needed = ", ".join(names)
    table_or_array = _in_order_of_names(designs, names)
    try:
        if isinstance(table_or_array, np.ma.MaskedArray):  # masked values are missing
            table_or_array = np.ma.filled(np.ma.asarray(table_or_array, dtype=np.float64), np.nan)
        array = np.asarray(table_or_array)
        written = array.dtype.kind in "US" or (array.dtype.kind == "O" and any(isinstance(x, str) for x in array.flat))
        if written or np.iscomplexobj(array):
            raise TypeError
        array = np.asarray(array, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(
            f"designs must be arrays of real numbers, SI; got {printed_or_type_text(designs)}; "
            f"give {needed} of each, in m, not as "
            "text "
            "and not complex"
        ) from None
    if array.ndim == 0 or array.shape[-1] != len(names):
        raise InputError(
            f"designs need {len(names)} numbers each ({needed}), along the last axis; got an array of shape "
            f"{array.shape}"
        )
    return array


def warn_of_lengths(owner: object, designs: Array, greatest: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
    """Warn about designs (..., 3 + k) with implausible lengths, probably in mm instead of m.

    Warns once for each machine or problem `owner`, attributed to the caller's caller, even if other owners had a
    warning at the same line. greatest: intended crank, rod and offset, m, which never cause a warning.
    """
    if _WARNED in vars(owner):
        return
    doubt = implausible_length_text(
        (designs[..., place] for place in range(3)), (max(LONGEST, size) for size in greatest)
    )
    if doubt is not None:
        vars(owner)[_WARNED] = True
        user = sys._getframe(2)
        # Without the module's warning registry, Python's default filter repeats the message for the next owner.
        warnings.warn_explicit(
            f"lengths of designs must be in m: {doubt}",
            InputWarning,
            user.f_code.co_filename,
            user.f_lineno,
            user.f_globals.get("__name__"),
        )


def has_finite_numbers(designs: Array) -> Mask:
    """Return which designs (n, 3 + k) contain only finite numbers, and lengths whose powers are finite, too."""
    return np.asarray(np.isfinite(designs).all(axis=1) & (designs[:, 0] > _LEAST) & (designs[:, 1] < _MOST))


def printed_or_type_text(value: object) -> str:
    """Return a value as it prints, or only its type if that is long."""
    text = repr(value)
    return text if len(text) <= 60 and "\n" not in text else type(value).__name__


def _in_order_of_names(designs: object, names: Sequence[str]) -> object:
    pandas = None if isinstance(designs, np.ndarray) else sys.modules.get("pandas")
    if pandas is None or not isinstance(designs, pandas.DataFrame | pandas.Series):
        return designs
    labels = designs.columns if isinstance(designs, pandas.DataFrame) else designs.index
    if not any(isinstance(label, str) for label in labels):
        return designs
    if not set(names) <= set(labels):
        columns = ", ".join(map(str, labels[: len(names)])) + (", ..." if len(labels) > len(names) else "")
        raise InputError(
            f"a table of designs must have the columns {', '.join(names)}, SI; got {columns}; rename them, lengths "
            "in m; the designs of a front are `front.dimensions`"
        )
    ordered_columns: object = designs[list(names)]
    return ordered_columns
