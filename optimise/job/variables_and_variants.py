"""From the paths in [variables] and [[choice]] to extra variables of the machine and to variants of the problem.

A path names a number of the job. To find its effect, the machine is built twice, with the number at both ends of its
range. Every number of the machine that differs must be proportional to it. So each number is read, and rejected, by the
rules of its own key, and any number in a job may vary.
"""

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

from pydantic import ValidationError

from ...model.errors import InputError, JobError
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import SlowStroke
from ...model.machine.mechanism import Mechanism, Start
from ...model.machine.raw_numbers_of_designs import unit_of_number
from ...model.machine.varying_numbers import Varying
from ...objectives.catalogue_amount import Amount
from ...objectives.formula.formulas import Formulas
from ...objectives.kinds import ANGULAR_SPEED
from ...objectives.units import plus_minus_ends, quote
from ..problem.problem import Variant
from ..problem.requirements import Constraint, Discrete, Range
from .constraints_and_objectives import constraints_of, slow_stroke_of
from .crank_speed import TIME_KEYS
from .mistake_messages import sentences_on_mistakes
from .model import Job, schema_of
from .option_amounts import amounts_of_option
from .plain_numbers import stated_values_of_part, unknown_path_message, with_value_at_path
from .value_grids import Grid, crossed_ends_remedy, read_grid, states_value_grid
from .value_types import Choices, RangeOf, ToleranceOf

MOST = 200
"""Maximum number of combinations of choices to enumerate."""
_MOST_READ = 2000
"""Maximum number of extra variables, counted in every combination; each takes up to 1 ms with fifty loads."""
_ROUNDING = 1e-12  # rounding error of a factor


@dataclass(frozen=True)
class _Option:
    label: str
    values: dict[str, Any]
    limits: tuple[Constraint, ...] = ()
    slow_stroke: SlowStroke | None = None
    amounts: tuple[tuple[str, float], ...] = ()
    notes: tuple[tuple[str, str, str], ...] = ()
    searched: bool = True
    rank: int = 0


def machine_with_variables(job: Job, key: str = "variables") -> Mechanism:
    """Return the machine of a job with the extra variables from [variables]. Raises JobError, naming the path."""
    base = job.machine()
    varying = []
    for path, stated_value in job.variables.stated_values_by_path.items():
        if not has_list_of_values(stated_value):
            varying.append(_varying_number(job, f"{key}.{path}", path, stated_value))
    if not any(path.startswith("start.") for item in varying for path in item.paths):
        base = replace(base, start=Start())
    try:
        return replace(base, varying=tuple(varying))
    except InputError as error:
        raise JobError(f"{key}: {error}") from None


def choices_and_variants(
    job: Job, formulas: Formulas, amounts: Mapping[str, Amount]
) -> tuple[tuple[str, ...], tuple[Variant, ...], tuple[Variant, ...]]:
    """Return the names of a job's choices, every combination of their options, and the combinations in the catalogue.

    All are empty if there are no choices. formulas: those of the job, which its options may also constrain.
    amounts: those of the job.
    """
    every = list(_choice_axes(job, formulas, amounts))
    axes = [(name, [option for option in options if option.searched]) for name, options in every]
    if not axes:
        return (), (), ()
    count = math.prod(len(options) for _, options in axes)
    if count > MOST:
        sizes = " x ".join(str(len(options)) for _, options in axes)
        raise JobError(
            f"variables: at most {MOST} combinations of choices may be given, because each is tried; got {sizes} = "
            f"{count}; leave out some, or let a number vary over a range"
        )
    numbers = sum(not has_list_of_values(value) for value in job.variables.stated_values_by_path.values())
    if count * numbers > _MOST_READ:
        raise JobError(
            f"variables: variables times combinations of choices must be at most {_MOST_READ}; got {numbers} "
            f"variables in {count} combinations; leave out some of either"
        )
    names = [name for name, _ in axes]
    combinations = list(itertools.product(*(options for _, options in axes)))
    variants = tuple(_variant_of_options(job, names, chosen) for chosen in combinations)
    searched = {tuple(map(id, chosen)): variant for chosen, variant in zip(combinations, variants, strict=True)}
    catalogue = dict(searched) if any(part.table is not None for part in job.choice) else {}
    for place, (_, options) in enumerate(every) if catalogue else ():
        alike = {tuple(option.values.items()): option for option in axes[place][1]}
        for option in options:
            if option.searched:
                continue
            like = alike.get(tuple(option.values.items()))
            for chosen in combinations if like is not None else ():
                if chosen[place] is like:
                    named = (*chosen[:place], option, *chosen[place + 1 :])
                    machine = searched[tuple(map(id, chosen))]
                    catalogue[tuple(map(id, named))] = replace(machine, **_variant_parts(names, named))
    return tuple(name for name in names if name not in DIMENSIONS), variants, tuple(catalogue.values())


def discrete_variables(job: Job) -> tuple[Discrete, ...]:
    """Return a job's variables with discrete values. Raises JobError, naming the path."""
    discrete = []
    for name in DIMENSIONS:
        stated = getattr(job.variables, name)
        if isinstance(stated, Grid):
            for part in job.choice:
                if any(name in option.values_by_path for option in part.option):
                    raise JobError(
                        f"variables.{name}: a number set by options of the choice {quote(part.name)} must not be a "
                        "variable as well; leave out one of the two"
                    )
            discrete.append(Discrete(name=name, values=stated.values, rule=stated.rule))
    for path, stated in job.variables.stated_values_by_path.items():
        if states_value_grid(stated):
            grid = _read_grid(job, f"variables.{path}", path, stated)
            discrete.append(Discrete(name=path, values=grid.values, rule=grid.rule))
    return tuple(discrete)


def _read_grid(job: Job, key: str, path: str, table: Mapping[str, Any]) -> Grid:
    """Return the values of a number that varies, read by the rules of its own key."""
    try:
        return read_grid(table, lambda value: _number_at(with_values_at_paths(job, {path: value}, key), path, key))
    except InputError as error:
        text = str(error)
        raise JobError(text if text.startswith(key) else f"{key}: {text}") from None


def range_of_dimension(stated: tuple[float, float] | Choices | Grid) -> Range:
    """Return the range of a dimension; for choices and discrete values, from the least to the greatest."""
    if isinstance(stated, Grid):
        return Range(lower=stated.values[0], upper=stated.values[-1])
    if isinstance(stated, Choices):
        return Range(lower=min(stated.choices), upper=max(stated.choices))
    return Range(lower=stated[0], upper=stated[1])


def dimension_ranges(job: Job) -> dict[str, Range]:
    """Return each dimension's possible range, whatever is chosen."""
    ranges_by_name = {}
    for name in DIMENSIONS:
        options = [
            _read_length_range(
                name, option.values_by_path[name], f"choice {quote(part.name)}, option {quote(option.name)}"
            )
            for part in job.choice
            for option in part.option
            if name in option.values_by_path
        ]
        ranges = [range_of_dimension(getattr(job.variables, name)), *map(range_of_dimension, options)]
        ranges_by_name[name] = Range(lower=min(ends.lower for ends in ranges), upper=max(ends.upper for ends in ranges))
    return ranges_by_name


def has_list_of_values(value: object) -> bool:
    """Return whether a variable has a list of values that need not be numbers."""
    return isinstance(value, Mapping) and set(value) == {"choices"}


def _choice_axes(job: Job, formulas: Formulas, amounts: Mapping[str, Amount]) -> Iterator[tuple[str, list[_Option]]]:
    """Yield name and options of every choice."""
    for name in DIMENSIONS:
        stated = getattr(job.variables, name)
        if isinstance(stated, Choices):
            yield name, [_Option(f"{1e3 * value:.6g} mm", {name: value}) for value in stated.choices]
    for path, stated in job.variables.stated_values_by_path.items():
        if has_list_of_values(stated):
            values = stated["choices"]
            if not isinstance(values, list | tuple) or len(values) < 2:
                raise JobError(f"variables.{path}: choices must be a list of at least two values; got {quote(values)}")
            labels = [str(value) for value in values]
            if len(set(labels)) < len(labels):
                raise JobError(f"variables.{path}: choices must differ; got {quote(values)}; leave out the second")
            yield path.removeprefix("mechanism."), [_Option(str(value), {path: value}) for value in values]
    for part in job.choice:
        options = []
        for rank, o in enumerate(part.option):
            option_name = f"choice {quote(part.name)}, option {quote(o.name)}"
            options.append(
                _Option(
                    o.name,
                    o.values_by_path,
                    tuple(constraints_of(o.constraints, formulas, f"{option_name}: ")),
                    slow_stroke_of(o.constraints),
                    amounts_of_option(o.amounts, amounts, option_name),
                    tuple((part.name, head, text) for head, text in o.notes.items()),
                    o.searched,
                    0 if part.table is None else rank,
                )
            )
        yield part.name, options


def _variant_of_options(job: Job, names: list[str], chosen: tuple[_Option, ...]) -> Variant:
    ranges: dict[str, Any] = {name: getattr(job.variables, name) for name in DIMENSIONS}
    values: dict[str, Any] = {}
    for name, option in zip(names, chosen, strict=True):
        for path, value in option.values.items():
            if path in values or (
                path in job.variables.stated_values_by_path and path not in _path_of_choice(name, option)
            ):
                raise JobError(f"choice {name!r}: {path} may be set only once; got it twice; leave out one of the two")
            values[path] = value
    for name in DIMENSIONS:
        if name in values:
            ranges[name] = _read_length_range(name, values.pop(name), "choice")
    try:
        other = with_values_at_paths(job, values, "choice") if values else job
    except JobError:
        for name, option in zip(names, chosen, strict=True):  # report the one that is invalid by itself
            single = next(iter(_path_of_choice(name, option)), None)
            name_of_part = f"variables.{single}" if single else f"choice {quote(name)}, option {quote(option.label)}"
            with_values_at_paths(
                job, {path: value for path, value in option.values.items() if path in values}, name_of_part
            )
        raise
    return Variant(
        mechanism=machine_with_variables(other),
        crank=range_of_dimension(ranges["crank"]),
        rod=range_of_dimension(ranges["rod"]),
        offset=range_of_dimension(ranges["offset"]),
        **_variant_parts(names, chosen),
    )


def _variant_parts(names: list[str], chosen: tuple[_Option, ...]) -> dict[str, Any]:
    """Return limits, amounts and notes for a combination of options."""
    labelled = [option for name, option in zip(names, chosen, strict=True) if name not in DIMENSIONS]
    return {
        "labels": tuple(option.label for option in labelled),
        "limits": tuple(limit for option in chosen for limit in option.limits),
        "slow_stroke": _required_slow_stroke(chosen),
        "amounts": tuple(amount for option in chosen for amount in option.amounts),
        "notes": tuple(note for option in chosen for note in option.notes),
        "ranks": tuple(option.rank for option in labelled),
    }


def _required_slow_stroke(chosen: tuple[_Option, ...]) -> SlowStroke | None:
    """Return which stroke the options require to be slow. Raises JobError if they differ."""
    stroke_labels = {option.slow_stroke: option.label for option in chosen if option.slow_stroke is not None}
    if len(stroke_labels) > 1:
        raise JobError(
            "choice: options that are chosen together must have the same slow stroke; got "
            f"{' and '.join(f'{stroke} with {quote(label)}' for stroke, label in stroke_labels.items())}; leave out one"
        )
    return next(iter(stroke_labels), None)


def _path_of_choice(name: str, option: _Option) -> tuple[str, ...]:
    """Return the path of a choice that is stated in [variables] itself."""
    paths = tuple(option.values)
    return paths if len(paths) == 1 and paths[0].removeprefix("mechanism.") == name else ()


def _read_length_range(name: str, value: Any, key: str) -> tuple[float, float] | Choices:
    try:
        found = RangeOf("any" if name == "offset" else "positive").read(value)
        if isinstance(found, Grid):
            raise InputError(
                f"of an option must be a value or a range; got {quote(value)}; give the values in [variables]"
            )
        return found
    except InputError as error:
        raise JobError(f"{key}: {name} {error}") from None


def _varying_number(job: Job, key: str, path: str, given: Any) -> Varying:
    """Return the extra variable for a path."""
    if states_value_grid(given):
        grid = _read_grid(job, key, path, given)
        if len(grid.values) < 2:
            raise JobError(
                f"{key}: must have at least two values; got one, {grid.rule}; give it as a fixed number instead"
            )
        given = [grid.values[0], grid.values[-1]]
    given = plus_minus_ends(given) or given
    if not isinstance(given, list | tuple) or len(given) != 2:
        raise JobError(
            f"{key}: must be a range [lower, upper], {{ choices = [...] }}, or values; got {quote(given)}; "
            "give a fixed value in its own place only"
        )
    jobs = [with_values_at_paths(job, {path: end}, key) for end in given]
    _require_fixed_time_keys(path, key, jobs)
    lower, upper = (_number_at(other, path, key) for other in jobs)
    if not lower < upper:
        raise JobError(
            f"{key}: must run from its lower to its upper end; got {quote(given[0])} to {quote(given[1])}; "
            f"{crossed_ends_remedy(*given)}"
        )
    sets = []
    for place, low, high in _differing_numbers(jobs[0].machine(), jobs[1].machine(), ""):
        factor = high / upper if upper else low / lower
        tolerance = _ROUNDING * abs(factor) * max(abs(lower), abs(upper))
        if not (abs(low - factor * lower) <= tolerance and abs(high - factor * upper) <= tolerance):
            raise JobError(
                f"{key}: must not vary over a range, because the machine does not depend on it linearly; make it a "
                "choice instead"
            )
        sets.append((place, factor))
    try:
        if not sets:
            raise InputError("has no effect on any quantity of a design; leave it out")
        _require_differentiable(path, [place for place, _ in sets])
        return Varying(name=path, sets=tuple(sets), lower=lower, upper=upper)
    except InputError as error:
        raise JobError(f"{key}: {error}") from None


def _require_fixed_time_keys(path: str, key: str, jobs: list[Job]) -> None:
    """Raise `JobError` if a time that states the crank speed varies. jobs: the jobs at the ends of its range."""
    stated = path.removeprefix("mechanism.")
    if path.startswith("mechanism.") and stated in TIME_KEYS:
        low, high = sorted(ANGULAR_SPEED.metric.factor * other.machine().speed for other in jobs)
        raise JobError(
            f"{key}: only mechanism.speed may vary over a range; got a range of {stated}; give speed in place of "
            f'{stated} and variables.mechanism.speed = ["{low:.6g} rpm", "{high:.6g} rpm"], or make {stated} a choice'
        )


def _require_differentiable(path: str, places: list[str]) -> None:
    """Reject a path to a number of the machine with respect to which there are no derivatives."""
    try:
        for place in places:
            unit_of_number(place)
    except InputError:
        raise InputError(
            f"no quantity depends smoothly on {path}, so it cannot vary; make it a choice instead"
        ) from None


def with_values_at_paths(job: Job, values: Mapping[str, Any], key: str) -> Job:
    """Return the job, without its [[choice]], with values set at paths, read by the rules of their own keys.

    key: source of the values, for messages. Raises JobError.
    """
    data: dict[str, Any] = stated_values_of_part(job)
    for path, value in values.items():
        try:
            data = with_value_at_path(data, path, value)
        except LookupError:
            raise JobError(f"{key}: {unknown_path_message(path, job.model_dump(exclude_unset=True))}") from None
    data["choice"] = ()
    try:
        return type(job).model_validate(data)
    except ValidationError as error:
        sentence = sentences_on_mistakes(error, schema_of(type(job)))[0]
        for path in values:
            sentence = sentence.removeprefix(f"{path}: ") if key.endswith(path) else sentence
        raise JobError(f"{key}: {sentence}") from None


def _number_at(job: Job, path: str, key: str) -> float:
    """Return the number at a path of a job, SI."""
    part: Any = job
    for step in path.split("."):
        part = part[int(step) - 1] if isinstance(part, tuple) else getattr(part, step)
    share = ToleranceOf.fraction_of_length(part)
    number = part if share is None else share
    if isinstance(number, bool) or not isinstance(number, int | float):
        raise JobError(f"{key}: must name a number; got {quote(part)}; make it a choice instead")
    return float(number)


def _differing_numbers(low: Any, high: Any, root: str) -> Iterator[tuple[str, float, float]]:
    """Yield dotted path and both values of every number that differs between two machines."""
    if low == high:
        return
    if is_dataclass(low) and type(low) is type(high):
        for field in fields(low):
            place = f"{root}.{field.name}" if root else field.name
            yield from _differing_numbers(getattr(low, field.name), getattr(high, field.name), place)
    elif isinstance(low, tuple) and isinstance(high, tuple) and len(low) == len(high):
        for number, pair in enumerate(zip(low, high, strict=True)):
            yield from _differing_numbers(*pair, f"{root}.{number}")
    elif isinstance(low, int | float) and isinstance(high, int | float):
        yield root, float(low), float(high)
    else:  # values of other types do not follow the number
        yield root, math.nan, math.nan
