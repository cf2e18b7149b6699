"""A tool is a function; its input schema and validation follow from its parameters."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cached_property
from typing import Any, get_args, get_type_hints

from pydantic import BaseModel, ConfigDict, Field, ValidationError, create_model
from pydantic.fields import FieldInfo

from ...model.errors import InputError
from ...objectives.units import closest_word, quote
from ...optimise.job.mistake_messages import broken_rule
from ...optimise.job.model import schema_of
from .call import Call, ToolResult


@dataclass(frozen=True)
class Tool:
    """Tool. run: function of a call and named inputs; its docstring is the description.

    Annotate each parameter like a command-line option, help included, or with a pydantic `Field`; a dataclass parameter
    stands for its fields. writes: whether it writes files.
    """

    name: str
    run: Callable[..., ToolResult]
    writes: bool = False

    @property
    def description(self) -> str:
        """Description for agents."""
        return inspect.cleandoc(self.run.__doc__ or "")

    @cached_property
    def input_groups(self) -> dict[str, Any]:
        """Input dataclasses, by parameter."""
        hints = get_type_hints(self.run, include_extras=True)
        return {name: hint for name, hint in hints.items() if is_dataclass(hint) and name not in ("call", "return")}

    @cached_property
    def input_model(self) -> type[BaseModel]:
        """Pydantic model of the inputs."""
        hints, definitions = get_type_hints(self.run, include_extras=True), dict[str, Any]()
        for name, parameter in inspect.signature(self.run).parameters.items():
            if name in self.input_groups:
                types = get_type_hints(self.input_groups[name], include_extras=True)
                definitions |= {
                    item.name: _input_field(types[item.name], _field_default(item))
                    for item in fields(self.input_groups[name])
                }
            elif parameter.kind is parameter.KEYWORD_ONLY:
                definitions[name] = _input_field(hints[name], parameter.default)
        return create_model(self.name, __config__=ConfigDict(extra="forbid", strict=True), **definitions)

    @cached_property
    def schema(self) -> dict[str, Any]:
        """JSON Schema of the inputs."""
        return {key: value for key, value in schema_of(self.input_model).items() if key not in ("$schema", "title")}

    def execute(self, call: Call, arguments: Mapping[str, Any]) -> ToolResult:
        """Run the tool. Raises `InputError` for unknown inputs."""
        try:
            inputs = self.input_model.model_validate(dict(arguments))
        except ValidationError as error:
            raise InputError("; ".join(map(self._error_sentence, error.errors(include_url=False)[:5]))) from None
        values = {name: getattr(inputs, name) for name in self.input_model.model_fields}
        for name, group in self.input_groups.items():
            values[name] = group(**{item.name: values.pop(item.name) for item in fields(group)})
        return self.run(call, **values)

    def _error_sentence(self, details: Any) -> str:
        """Return the error message for an input: rule, value, remedy."""
        name, accepted = str(details["loc"][0]), list(self.input_model.model_fields)
        if details["type"] == "extra_forbidden":
            near = closest_word(name, accepted)
            remedy = f"did you mean {near}?" if near else "leave it out"
            rule = f"accepts only {', '.join(accepted)}" if accepted else "has no inputs"
            return f"{self.name} {rule}; got {quote(name)}; {remedy}"
        if details["type"] == "missing":
            return f"{self.name} needs {name}, which is missing; add it"
        path = ".".join(str(part) for part in details["loc"] if not str(part).startswith(("dict[", "str", "list[")))
        return f"{path} {broken_rule(details)}; got {quote(details['input'])}; correct it"


def _field_default(item: Any) -> Any:
    """Return the default of a dataclass field as a parameter default."""
    if item.default_factory is not MISSING:
        return item.default_factory()
    return inspect.Parameter.empty if item.default is MISSING else item.default


def _input_field(hint: Any, default: Any) -> tuple[Any, FieldInfo]:
    """Return type and field for a parameter."""
    kind, *annotations = get_args(hint)
    field = next((metadata for metadata in annotations if isinstance(metadata, FieldInfo)), None)
    if field is None:
        option: Any = next((metadata for metadata in annotations if not isinstance(metadata, str)), None)
        text = (
            next((metadata for metadata in annotations if isinstance(metadata, str)), None)
            or option.help.partition("  [")[0]
        )
        field = Field(description=text, ge=getattr(option, "min", None), le=getattr(option, "max", None))
    if default is not inspect.Parameter.empty:
        field = FieldInfo.merge_field_infos(field, default=default)
    return kind, field
