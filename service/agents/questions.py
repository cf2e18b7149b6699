"""Tools that do not search: list and explain names, analyse designs, check jobs."""

import inspect
from collections.abc import Iterator, Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import asdict
from typing import Annotated, Any

from pydantic import Field

from ...model.errors import InputError, NotFound, RunError
from ...model.file_name_encoding import path_text
from ...objectives.kinds import System
from ...objectives.units import closest_word
from ...optimise.job.mistake_messages import schema_nodes_at, toml_text
from ...optimise.job.model import Job, schema_of
from ...optimise.problem.problem import Problem
from ...optimise.problem.question_registry import SUBJECTS
from ..designs.quantity_facts import facts_of_all_quantities
from ..designs.rotating_crank import require_rotating_crank
from ..jobs.job_toml import job_toml
from ..jobs.stores import run_folders
from ..jobs.submission import end_custom_processes_on_exit
from ..presets.jobs import shipped_jobs
from ..questions.design_question import DesignQuestion
from ..questions.discovery import ALL, DESIGN_QUESTIONS, FRONT_OR_JOB_QUESTIONS, QUESTIONS
from ..questions.front_or_job_question import FrontOrJobQuestion, SearchListener
from ..questions.record_types import schema_of as schema_of_record
from ..render.blocks import Block
from .call import Call, ToolResult, tables_with_files, text_printed_by
from .inputs import Design, Files, JobInput, Machine, TopicRequest

_MOST_RUNS = 20
_OF_TOPIC = ("name", "title", "help", "usual", "example", "required")
_OF_KEY = ("description", "examples", "default", "enum")


def list_jobs_quantities_topics_and_runs(call: Call) -> ToolResult:
    """List the included jobs, the quantities, the topics with their inputs, and the latest runs.

    `describe` explains each. Start from the included job closest to the task.
    """
    jobs = [
        {"name": name, "title": job["name"], "sentence": job.get("description", "")}
        for name, job in shipped_jobs().items()
    ]
    quantities = [
        {key: facts[key] for key in ("name", "title", "column", "unit", "better")}
        for facts in facts_of_all_quantities()
    ]
    topics, runs = list(map(_topic_description, QUESTIONS.values())), list(_latest_run_records(call))
    lines = [
        *("Included jobs:", *(f"  {job['name']}: {job['sentence'] or job['title']}" for job in jobs)),
        *(
            "Topics:",
            *(
                f"  {topic['name']}, of {SUBJECTS[topic['of']]}: {topic['shows'].partition(chr(10))[0]}"
                for topic in topics
            ),
        ),
        *("Quantities:", f"  {', '.join(facts['name'] for facts in quantities)}"),
        *("Runs, newest first:", *(f"  {run['run']}: {run['message']}" for run in runs)),
    ]
    record = {"jobs": jobs, "quantities": quantities, "topics": topics, "runs": runs}
    return ToolResult(record, "\n".join(lines))


def describe(
    call: Call,
    *,
    name: Annotated[
        str,
        Field(
            description="A quantity, a topic, an included job, or a key of a job, such as load or mechanism.slider; "
            '"job" lists its tables.',
            max_length=200,
        ),
    ],
) -> ToolResult:
    """Describe a quantity (meaning, formula, unit), a topic, an included job (its tables and TOML), or a job key."""
    word = name.strip()
    facts = {item["name"]: item for item in facts_of_all_quantities()}
    record: dict[str, Any] = {}
    lines = []
    if word in facts:
        record["quantity"] = quantity = facts[word]
        lines.append(
            f"{quantity['title']} ({quantity['column']}): {quantity['sentence']} {quantity['advice']}\n"
            f"{quantity['formula']}"
        )
    if word in QUESTIONS:
        record["topic"] = topic = _topic_description(QUESTIONS[word])
        input_lines = "".join(f"\n  {item.name}: {item.remark}" for item in QUESTIONS[word].inputs)
        lines.append(f"topic {word}: {topic['shows']}{input_lines}")
    if word in DESIGN_QUESTIONS:
        topic["answer"] = schema = schema_of_record(DESIGN_QUESTIONS[word].record_type)
        lines.append(f"  answer (keys have other endings in inches): {', '.join(schema['properties'])}")
    if word in shipped_jobs():
        text = job_toml(shipped_jobs()[word])
        record["job"] = {"tables": shipped_jobs()[word], "toml": text}
        lines.append(text)
    with suppress(NotFound):
        record["key"] = key = _job_key_description(word)
        lines += [f"key {word}: {key['description']}", *_job_key_lines(key)]
    if not record:
        near = closest_word(word, [*facts, *QUESTIONS, *shipped_jobs()])
        remedy = f"did you mean {near}?" if near else "call `list` for all names"
        raise NotFound(f"a name must belong to a quantity, a topic, a job or a key of a job; got {word!r}; {remedy}")
    return ToolResult(record, "\n".join(lines))


def ask(call: Call, *, subject: Design, question: TopicRequest) -> ToolResult:
    """Analyse one design: its quantities, how it meets the requirements of its job, and topics such as static_forces.

    The design comes from a run (its knee by default), or has your own lengths for a job. Some topics concern the front
    of a run (wish), several runs (compare), or a job (sweep).
    """
    if question.topic_with_separate_command in FRONT_OR_JOB_QUESTIONS:
        return _ask_front_or_job(call, subject, question, FRONT_OR_JOB_QUESTIONS[question.topic_with_separate_command])
    options = question.options_by_topic()
    machine = subject.machine(call)
    with end_custom_processes_on_exit(machine.problem):
        alone = question.topic_with_separate_command or (
            "swing" if machine.problem.motion is not None and not question.topics else None
        )
        if alone is not None:
            return _run_question_command(alone, machine, question)
        require_rotating_crank(machine.problem.motion, f"the topic {next(iter(options), '')}")
        return _analyse_rotating(call, machine, options, question)


def check(call: Call, *, job: JobInput, files: Files = {}) -> ToolResult:  # noqa: B006
    """Check a job before a search: how it was understood, or any mistake or contradiction with its remedy."""
    from ...objectives.own.quantity import OwnQuantity
    from ..preview.preview import job_preview
    from ..text.job_in_words import freedom_in_words, job_in_words

    tables = tables_with_files(job, files)
    look = job_preview(tables, call.problem)
    record: dict[str, Any] = {
        "valid": look.problem is not None,
        "wrong": [asdict(mistake) for mistake in look.wrong],
        "said": look.sentences,
        "unchecked": look.unchecked,
    }
    if look.problem is None:
        lines = [": ".join(filter(None, (mistake.path, mistake.sentence))) for mistake in look.wrong]
        return ToolResult(record, "\n".join(("this job cannot be solved:", *dict.fromkeys((*lines, *look.sentences)))))
    for quantity in look.problem.own:
        if isinstance(quantity, OwnQuantity):
            quantity.require_function()
    record |= job_in_words(look.problem, tables)
    lists = [f"{name}: {'; '.join(record[name])}" for name in ("given", "variables", "rules", "objectives", "warnings")]
    heading = f"a valid job: {look.problem.name}"
    return ToolResult(
        record, "\n".join((heading, *lists, freedom_in_words(look.problem), *look.sentences, *record["notes"]))
    )


def _analyse_rotating(
    call: Call, machine: Machine, options: Mapping[str, dict[str, Any]], question: TopicRequest
) -> ToolResult:
    """Analyse a design that rotates fully. options: options for each topic."""
    from ..questions.design_analysis import analysis_of, judge_design, quantities_of_design, show_analysis

    row, undefined = quantities_of_design(machine.mechanism, machine.linkage, machine.problem.own)
    analysis = analysis_of(
        row,
        machine.mechanism,
        machine.linkage,
        tuple(options),
        options=options,
        cancelled=call.cancelled,
        lenient=ALL in question.topics,
        undefined=undefined,
    )
    judgement = judge_design(machine.problem, machine.mechanism, machine.linkage, row, question.units)
    text = text_printed_by(
        lambda screen: show_analysis(screen, analysis, judgement, question.units, custom=machine.problem.own)
    )
    return ToolResult(analysis.record(question.units, judgement), "\n".join((text, *analysis.notes, *analysis.refused)))


def _run_question_command(name: str, machine: Machine, question: TopicRequest) -> ToolResult:
    """Answer a question about a design, if the question is a separate command."""
    from ..designs.display_units import convert_record

    bound_question = DESIGN_QUESTIONS[name].bind_to_problem(
        machine.mechanism, machine.linkage, machine.problem, question.inputs
    )
    record = bound_question.numbers(lambda: False)
    text = _blocks_and_notes_as_text(bound_question.blocks(record), bound_question.notes(record), question.units)
    return ToolResult(convert_record(record, question.units), text)


def _ask_front_or_job(
    call: Call, subject: Design, question: TopicRequest, definition: FrontOrJobQuestion
) -> ToolResult:
    """Answer a question about the front of a run, several runs, or a job."""
    place, row, inputs = dict[str, Any](), None, question.inputs
    problem: Problem | None = None
    if definition.subject == "runs":
        target: Any = subject.compared_runs(call)
    elif definition.subject == "job":
        target = problem = subject.problem(call)
        inputs = subject.given_lengths | inputs
    else:
        folder, target, row = subject.folder_front_and_row(call)
        problem, place = target.problem, {"run": path_text(folder)}
    with nullcontext() if problem is None else end_custom_processes_on_exit(problem):
        result = definition.ask(target, inputs, row=row, listener=SearchListener(cancelled=call.cancelled))
    text = _blocks_and_notes_as_text(result.blocks, result.notes, question.units)
    return ToolResult(place | result.record(question.units), text, is_error=not result.is_satisfied)


def _blocks_and_notes_as_text(blocks: Sequence[Block], notes: Sequence[str], units: System) -> str:
    """Return the blocks of an answer as plain text, followed by its notes."""
    from ..render.terminal import print_blocks

    return "\n".join((text_printed_by(lambda screen: print_blocks(screen, blocks, units)), *notes))


def _topic_description(question: DesignQuestion | FrontOrJobQuestion) -> dict[str, Any]:
    inputs = [{key: getattr(item, key) for key in _OF_TOPIC} for item in question.inputs]
    if isinstance(question, FrontOrJobQuestion):
        return {
            "name": question.name,
            "of": question.subject,
            "shows": inspect.cleandoc(question.help),
            "inputs": inputs,
        }
    shows = question.shows if question.command is None else inspect.cleandoc(question.command.help)
    return {"name": question.name, "of": "design", "shows": shows, "inputs": inputs}


def _latest_run_records(call: Call) -> Iterator[dict[str, Any]]:
    """Yield the latest runs, each with its outcome."""
    for folder in sorted(run_folders(call.runs), key=lambda folder: folder.name, reverse=True)[:_MOST_RUNS]:
        try:
            _, result = call.load_run(folder.name)
        except (RunError, InputError) as error:
            yield {"run": folder.name, "name": "", "status": "unfinished", "designs": 0, "message": str(error)}
            continue
        summary = {
            "name": result.name,
            "status": result.status,
            "designs": len(result.designs),
            "message": result.message,
        }
        yield {"run": folder.name, **summary}


def _job_key_description(name: str) -> dict[str, Any]:
    """Return the description of a job-file key and of the keys within it. Raises `NotFound`."""
    schema, path = schema_of(Job), list[str | int]()
    for part in [] if name == "job" else name.replace("[", "").replace("]", "").split("."):
        path.append(part)
        if any("items" in node for node in schema_nodes_at(schema, path)):
            path.append(0)
    nodes = schema_nodes_at(schema, path[:-1] if path and path[-1] == 0 else path)
    if not nodes:
        raise NotFound(f"there is no key {name!r}")
    forms = [node for node in schema_nodes_at(schema, path) if "properties" in node]
    return {
        "description": next((node["description"] for node in nodes if "description" in node), ""),
        **{key: node[key] for node in reversed(nodes) for key in _OF_KEY[1:] if key in node},
        "tables": [
            {
                "description": form.get("description", ""),
                "required": form.get("required", []),
                "keys": {
                    key: {fact: inner[fact] for fact in _OF_KEY if fact in inner}
                    for key, inner in form["properties"].items()
                },
            }
            for form in forms
        ],
    }


def _job_key_lines(key: Mapping[str, Any]) -> Iterator[str]:
    for table in key["tables"]:
        if table["description"]:
            yield f"- {table['description']} Needs: {', '.join(table['required']) or 'nothing'}"
        for name, facts in table["keys"].items():
            words = f", one of {', '.join(map(str, facts['enum']))}" if "enum" in facts else ""
            example = f"; such as {name} = {toml_text(facts['examples'][0])}" if "examples" in facts else ""
            yield f"  {name}: {facts.get('description', '')}{words}{example}"
    if "enum" in key:
        yield f"  one of {', '.join(map(str, key['enum']))}"
    if not key["tables"] and key.get("examples"):
        yield f"  such as {toml_text(key['examples'][0])}"
