"""Groups of inputs that several tools share; their descriptions for agents come from declarations elsewhere."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from pydantic import Field

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.units import quote
from ...optimise.front.front import ParetoFront
from ...optimise.job.model import Job as JobModel
from ...optimise.problem.problem import Problem
from ...optimise.problem.question_registry import SUBJECTS
from ..designs.columns import find_column
from ..designs.design_selection_options import require_single_choice
from ..designs.stored_designs import front_of_result, stored_design
from ..presets.jobs import shipped_jobs
from ..questions.compare.runs import ComparedRun, compared_run
from ..questions.discovery import (
    ALL,
    DESIGN_QUESTIONS,
    FRONT_OR_JOB_QUESTIONS,
    QUESTION_COMMANDS,
    QUESTIONS,
    TOPICS,
    chosen_topics,
)
from ..questions.inputs import read_inputs
from ..text.options import Dimensions, Rows, Units
from ..text.tables import ROWS
from .call import Call, Job, tables_with_files

_TABLES = ", ".join(f"{name} ({field.description})" for name, field in JobModel.model_fields.items())
_TOPIC_WORDS = [f"{name} ({topic.shows})" for name, topic in TOPICS.items()]
_TOPIC_WORDS += [f"{name} ({command.help.partition('.')[0]}; alone)" for name, command in QUESTION_COMMANDS.items()]
_TOPIC_WORDS += [
    f"{name} ({one.shows}; alone, of {SUBJECTS[one.subject]})" for name, one in FRONT_OR_JOB_QUESTIONS.items()
]
_INPUTS: dict[str, dict[str, Any]] = {}
for _topic in QUESTIONS.values():
    for _input in _topic.inputs:
        _input_schema = _INPUTS.setdefault(_input.name, {"description": "", **_input.schema})
        _input_schema["description"] += f"{_topic.name}: {_input.remark}  "

JobInput = Annotated[
    Job,
    Field(
        description="A job: its tables, the TOML text of a job file, or the name of an included job: "
        f"{', '.join(shipped_jobs())}. Tables: {_TABLES}. `describe` explains every key."
    ),
]
OptionalJob = Annotated[Job | None, Field(description="A job, as for `check`.")]
Files = Annotated[
    dict[str, str],
    Field(
        description="Contents of the files that the job refers to, by file name: tables of loads, options or motions."
    ),
]
Number = Annotated[int | None, Field(description="Number of a design in the run.", ge=1)]
Topics = Annotated[
    list[str],
    Field(
        description=f"Analyses of the design, or {ALL} for every analysis of a rotating crank: "
        f"{'; '.join(_TOPIC_WORDS)}."
    ),
]
TopicInputs = Annotated[
    dict[str, Any],
    Field(
        description="Inputs of the topics, each as text with its unit.",
        json_schema_extra={"properties": dict(_INPUTS), "additionalProperties": False},
    ),
]
Dimension = Annotated[
    str | None, Field(description='Length of the design, such as "40 mm"; leave it out if the job fixes it.')
]


@dataclass(frozen=True)
class FrontPart:
    """Part of the front in an answer."""

    rows: Rows = ROWS
    columns: Annotated[
        list[str] | None,
        Field(
            description=f'Quantities or columns of each design. Default: dimensions, stroke and objectives; ["{ALL}"] '
            "gives all."
        ),
    ] = None
    units: Units = "metric"

    def requested_keys(self, columns: list[str], usual: list[str]) -> list[str] | None:
        """Return the requested columns, or None for all. Raises `InputError` for unknown columns."""
        if self.columns == [ALL]:
            return None
        return usual if self.columns is None else [find_column(name, columns).key for name in self.columns]


class Machine(NamedTuple):
    """Machine with a linkage, and the problem of its job or run."""

    mechanism: Mechanism
    linkage: Linkage
    problem: Problem


@dataclass(frozen=True)
class Design:
    """Design of a run, or a design with given lengths for a job."""

    run: Annotated[str | None, Field(description='Name of a run, or "latest"; instead of a job and lengths.')] = None
    design: Number = None
    job: OptionalJob = None
    files: Files = field(default_factory=dict)
    crank: Dimension = None
    rod: Dimension = None
    offset: Dimension = None
    runs: Annotated[list[str], Field(description="Names of the runs to compare.", max_length=50)] = field(
        default_factory=list
    )

    def machine(self, call: Call) -> Machine:
        """Return the machine. Raises `InputError` for neither or for both."""
        if (self.run is None) == (self.job is None):
            received = "both" if self.run else "neither"
            raise InputError(f"a design must come from a run or a job; got {received}; give one of them")
        return self._machine_of_job(call) if self.run is None else self._machine_of_run(call, self.run)

    def problem(self, call: Call) -> Problem:
        """Return the problem of the job. Raises `InputError` if there is no job."""
        if self.job is None or self.run is not None:
            raise InputError("this topic needs a job; got none; give a job, without a run")
        return call.problem(tables_with_files(self.job, self.files), feasible=False)

    @property
    def given_lengths(self) -> dict[str, str]:
        """The given lengths."""
        return {name: length for name in DIMENSIONS if (length := getattr(self, name)) is not None}

    def folder_front_and_row(self, call: Call) -> tuple[Path, ParetoFront, int | None]:
        """Return the run's folder, its front and the row of the design. Raises `InputError` if there is no run."""
        if self.run is None or self.job is not None:
            received = "a job" if self.job is not None else "none"
            raise InputError(f"this topic needs the front of a run; got {received}; name a run, without a job")
        self._require_no_lengths()
        folder, result = call.load_run(self.run)
        row = None
        if self.design is not None:
            require_single_choice(self.design, result, has_other_choice=False)
            row = self.design - 1
        return folder, front_of_result(call.problem_of_run(folder, result), result), row

    def compared_runs(self, call: Call) -> list[ComparedRun]:
        """Return several runs. Raises `InputError` for a single run or a job."""
        if self.run is not None or self.job is not None:
            raise InputError(f"this topic needs runs; got a {'run' if self.run else 'job'}; list the names of all runs")
        return [compared_run(*call.load_run(name)) for name in self.runs]

    def _require_no_lengths(self) -> None:
        for name in self.given_lengths:
            raise InputError(
                f"dimensions must not be given with a run, whose designs have their own; got run and {name}; "
                "leave out one of the two"
            )

    def _machine_of_run(self, call: Call, run: str) -> Machine:
        self._require_no_lengths()
        folder, result = call.load_run_with_designs(run)
        number = 1 + (result.knee or 0) if self.design is None else self.design
        require_single_choice(number, result, has_other_choice=False)
        stored = stored_design(call.problem_of_run(folder, result), result, number)
        return Machine(stored.mechanism, stored.linkage, stored.part)

    def _machine_of_job(self, call: Call) -> Machine:
        problem = call.problem(tables_with_files(self.job or {}, self.files), feasible=False)
        return Machine(problem.mechanism.nominal, Dimensions(**self.given_lengths).linkage(problem, str), problem)


@dataclass(frozen=True)
class TopicRequest:
    """Topics to analyse, with their inputs."""

    topics: Topics = field(default_factory=list)
    inputs: TopicInputs = field(default_factory=dict)
    units: Units = "metric"

    def __post_init__(self) -> None:
        """Raise `InputError` for unknown topics, topics that exclude each other, and inputs of other topics."""
        if self.topic_with_separate_command is None:
            chosen_topics(self.topics, job=True, word="topics")
        elif len(self.topics) > 1:
            raise InputError(
                f"{self.topic_with_separate_command} may not be combined with other topics; got "
                f"{', '.join(self.topics)}; "
                "ask for the others separately"
            )
        if self.topic_with_separate_command in FRONT_OR_JOB_QUESTIONS:
            return
        accepted = [item.name for name in self.topic_names for item in QUESTIONS[name].inputs]
        for name in self.inputs:
            if name not in accepted and name in _INPUTS:
                (topic, *_) = (topic for topic in QUESTIONS.values() if any(item.name == name for item in topic.inputs))
                raise InputError(f"{name} is an input of the topic {topic.name}, which is missing; add that topic")
            if name not in accepted:
                raise InputError(f"an input must be one of {', '.join(_INPUTS)}; got {name[:60]!r}; leave it out")
            if _INPUTS[name]["type"] == "string" and not isinstance(self.inputs[name], str):
                raise InputError(f"inputs.{name} must be text; got {quote(self.inputs[name])}; correct it")

    @property
    def topic_with_separate_command(self) -> str | None:
        """Topic that is a separate command, or None."""
        return next((name for name in self.topics if name in QUESTION_COMMANDS or name in FRONT_OR_JOB_QUESTIONS), None)

    @property
    def topic_names(self) -> tuple[str, ...]:
        """Names of the topics."""
        return (
            chosen_topics(self.topics, job=True, word="topics")
            if self.topic_with_separate_command is None
            else (self.topic_with_separate_command,)
        )

    def options_by_topic(self) -> dict[str, dict[str, Any]]:
        """Return the inputs of each topic, in SI. Raises `InputError`."""
        takes = {name: DESIGN_QUESTIONS[name].inputs for name in self.topic_names}
        texts = {name: {item.name: self.inputs.get(item.name) for item in inputs} for name, inputs in takes.items()}
        return {name: read_inputs(takes[name], texts[name], f"the topic {name}") for name in takes}
