"""Messages on mistakes in a job, in the words of the job file: key, rule, value, remedy.

They avoid the validator's jargon.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from ...objectives.registry import FACTS
from ...objectives.units import closest_word, quote, quoted_if_unprintable
from .suggested_bounds import suggested_bounds

_MOST_KEYS = 20  # keys to list if none is similar

MOST = 8
"""Number of mistakes in one job that are listed."""

DEEPEST = 8
"""Levels of nested tables; a job has five at most."""

LONGEST = 100
"""Number of mistakes to examine; each costs a search for a similar key."""

SEVERAL, SINGLE = (
    "each {0} must begin with [[{0}]], in double brackets",
    "there must be only one [{0}], in single brackets",
)

Schema = dict[str, Any]

_WISHES = ("minimise", "maximise", "minimize", "maximize")

_TABLE, _NUMBER, _INTEGER = "must be a table of keys", "must be a number", "must be a whole number"
_RULES = {
    **dict.fromkeys(("model_type", "model_attributes_type", "dict_type"), _TABLE),
    **dict.fromkeys(("tuple_type", "list_type"), "must be a list"),
    **dict.fromkeys(("float_type", "float_parsing"), _NUMBER),
    **dict.fromkeys(("int_type", "int_from_float", "int_parsing"), _INTEGER),
    **dict.fromkeys(("bool_type", "bool_parsing"), "must be true or false"),
    "int_parsing_size": "must be a whole number of moderate size",
    "finite_number": "must be a finite number",
    "string_type": "must be text in quotes",
    "string_unicode": "must be printable text",
    "string_too_short": "must not be empty",
}
_LIMITS = {
    "greater_than_equal": ("must be at least {}", "ge"),
    "greater_than": ("must be above {}", "gt"),
    "less_than_equal": ("must be at most {}", "le"),
    "less_than": ("must be below {}", "lt"),
    "string_pattern_mismatch": ("must match the pattern {}", "pattern"),
    "string_too_long": ("must have at most {} characters", "max_length"),
    "too_short": ("must have at least {} entries", "min_length"),
    "too_long": ("must have at most {} entries", "max_length"),
    "literal_error": ("must be {}", "expected"),
    "enum": ("must be {}", "expected"),
}
"""Sentences for kinds of errors, by their pydantic names, and the context value that each uses."""


def sentences_on_mistakes(error: ValidationError, schema: Schema, tables: Mapping[str, Any] | None = None) -> list[str]:
    """Return one sentence for each mistake, most useful first.

    schema: the JSON Schema of the job, with the allowed keys and an example for each. tables: the tables as read, for
    the order of their keys. Unknown keys come first, because a misspelt key explains the missing one, which is then
    omitted.
    """
    unknown, wrong, missing, explained = dict[tuple[Any, ...], str](), list[str](), dict[str, str](), set[str]()
    misplaced_objectives = set[str]()  # includes custom quantities, which the schema does not name
    listed = error.errors(include_url=False)[:LONGEST]
    parents = {details["loc"][:steps] for details in listed for steps in range(len(details["loc"]))}
    for details in listed:
        if details["type"] == "too_short" and details["loc"] in parents:
            continue  # a list that is too short only because entries were rejected
        path = keys_of_location(details["loc"])
        if details["type"] == "extra_forbidden":
            unknown[details["loc"]], near = _unknown_key_message(details["loc"], details["input"], schema)
            explained.add(near)
        elif path[:-1] == ["constraints"] and details["input"] in _WISHES:
            unknown[tuple(path)] = f"{key_of_location(path)}: {mistake_sentence(details, schema)}"
            misplaced_objectives.add(path[-1])
        else:
            sentence = f"{key_of_location(path)}: {mistake_sentence(details, schema)}"
            if details["type"] != "missing":
                wrong.append(sentence)
            else:
                missing[key_of_location(path)] = sentence
    for table in dict.fromkeys(loc[:-1] for loc in unknown):
        keys = [str(loc[-1]) for loc in unknown if loc[:-1] == table]
        keys.sort(key=list((tables or {}).get("constraints", keys) if table == ("constraints",) else keys).index)
        are_objectives = table == ("constraints",) and misplaced_objectives.issuperset(keys)
        owners = ["[objectives]"] if are_objectives else _tables_with_all_keys(keys, schema)
        owner = min(owners, key=lambda one: one.strip("[]") not in missing, default="")
        if len(keys) > 1 and owner and owner.strip("[]") not in table:
            unknown = {loc: sentence for loc, sentence in unknown.items() if loc[:-1] != table}
            place = f"in {key_of_location(keys_of_location(table))}" if table else "at the top of the file"
            wrong.append(
                f"{key_of_location(keys_of_location([*table, keys[0]]))}: {', '.join(keys[:-1])} and {keys[-1]} "
                "belong below the heading "
                f"{owner}; got them {place}; write {owner} above {keys[0]}, or move them there"
            )
            explained.add(owner.strip("[]"))
    return [
        *unknown.values(),
        *wrong,
        *(text for key, text in missing.items() if not {key, key.split(".")[0]} & explained),
    ]


def _is_form_of_value(part: object) -> bool:
    """Whether a step of a location is the form of a value, "(by mass)", rather than a key."""
    return isinstance(part, str) and part.startswith("(") and part.endswith(")")


def keys_of_location(loc: Sequence[Any]) -> list[Any]:
    """Return a location in the tables of a job, without the validator's tags."""
    return [part for part in loc if not _is_form_of_value(part)]


def key_of_location(path: Sequence[object]) -> str:
    """Return a location as a job file writes it: mechanism.slider.mass, load #2.force."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f" #{part + 1}"
        else:
            word = str(part)
            plain = word.isidentifier() and word.isascii() and len(word) <= 60
            text += ("." if text else "") + (word if plain else quote(word))
    return text or "the job"


def _unknown_key_message(loc: Sequence[Any], value: object, schema: Schema) -> tuple[str, str]:
    """Return the message on an unknown key, and the key that was probably meant; "" if none is similar.

    In a table with several kinds, such as a load, only the keys of its own kind are possible.
    """
    table, key = loc[:-1], loc[-1]
    path = keys_of_location(table)
    allowed = sorted(_possible_keys(schema, table), key=FACTS.__contains__)  # custom quantities first
    left_over = (
        f" and {len(allowed) - _MOST_KEYS} more, all in `slidercrank schema`" if len(allowed) > _MOST_KEYS else ""
    )
    possible = f"possible here: {', '.join(allowed[:_MOST_KEYS])}{left_over}"
    place = key_of_location([*path, key])
    owning_kinds, kind = (
        _kinds_with_key(str(key), schema, path),
        table[-1][1:-1] if table and _is_form_of_value(table[-1]) else "",
    )
    if owning_kinds and kind in allowed:
        noun = path[-2] if isinstance(path[-1], int) else "table"
        owners = " or ".join(filter(None, (", ".join(owning_kinds[:-1]), owning_kinds[-1])))
        return (
            f"{place}: a {noun} with {kind} must not have this key; got {quote(value)}; it belongs to a {noun} with "
            f"{owners}; {possible}"
        ), ""
    owner = where_key_belongs(str(key), schema)
    longer = [name for name in allowed if "_" in str(key) and name.endswith(f"_{key}")]
    near = next(iter(longer), None) if "[objectives]" in owner else None
    owner = "" if near else owner
    near = near or (None if owner else closest_word(str(key), allowed))
    subject, suggestion = f"key {quote(str(key))}", near
    if not table and isinstance(value, Mapping | list):
        subject, suggestion = f"heading [{place}]", next(iter(headings_with_keys([near or ""], schema)), near)
    choice = f"did you mean {suggestion}?" if near else owner or possible
    return f"{place}: unknown {subject}; {choice}", key_of_location([*path, near]) if near else ""


_RARE = ("[arm]", "[spring]")
"""Rarely used tables whose keys are common words, such as torque and force: a similar key of another table is
likelier."""


def where_key_belongs(key: str, schema: Schema) -> str:
    """Name the table to which a key belongs that its own table lacks; "" if no table has it."""
    if key in schema["properties"] and not headings_with_keys([key], schema):
        return f"{key} belongs above the first table of the file; move it there"
    owners = [owner for owner in _tables_with_all_keys([key], schema) if owner not in _RARE]
    owners.sort(key="[cylinder]".__eq__)
    return f"it belongs in {' or '.join(owners)}; move it there" if owners else ""


def _tables_with_all_keys(keys: Sequence[str], schema: Schema) -> list[str]:
    """Return the headings of the tables that have all of the given keys."""
    names = schema["properties"]
    return [
        heading
        for name in names
        for heading, allowed_keys in headings_with_keys([name], schema).items()
        if allowed_keys.issuperset(keys)
    ]


def headings_with_keys(words: Sequence[str], schema: Schema) -> dict[str, set[str]]:
    """Return a table's heading, none if it is another entry, with the keys allowed below it."""
    (first, *rest), name = words, ".".join(words)
    tops: list[list[Any]] = [[first], [first, 0]] if rest else [[first]]
    places = [place for top in tops for place in ((f"[{name}]", [*top, *rest]), (f"[[{name}]]", [*top, *rest, 0]))]
    return {heading: keys for heading, path in places if (keys := set(_possible_keys(schema, path)))}


def _kinds_with_key(key: str, schema: Schema, path: Sequence[Any]) -> list[str]:
    """Return the keys that identify those kinds of a table that have a key."""
    having = [node for node in schema_nodes_at(schema, path) if key in node.get("properties", {})]
    keys = [node.get("x-load", {}).get("key") or next(iter(node.get("required", ())), "") for node in having]
    return list(dict.fromkeys(filter(None, keys)))


def mistake_sentence(details: ErrorDetails, schema: Schema) -> str:
    """Return rule, value and remedy for one mistake."""
    kind, value, context, path = details["type"], details["input"], details.get("ctx", {}), details["loc"]
    example = example_of_key(schema, path)
    write = f"; for example, write {example}" if example else ""
    value_text = f"got {quote(value)}"
    if kind == "value_error":
        return str(context["error"])
    if kind == "missing":
        return f"is missing, but required{write.replace('write', 'add')}"
    table = ".".join(quoted_if_unprintable(key) for key in keys_of_location(path) if isinstance(key, str))
    if kind in ("tuple_type", "list_type") and isinstance(value, Mapping) and _possible_keys(schema, [*path, 0]):
        return f"{SEVERAL.format(table)}; got a single one; write [[{table}]] for [{table}]"
    if broken_rule(details) == _TABLE and isinstance(value, list) and any(isinstance(item, Mapping) for item in value):
        return f"{SINGLE.format(table)}; got a list of {len(value)}; write [{table}] for [[{table}]]"
    if kind == "literal_error":
        # Tables for different kinds of load share key names, so this description comes from the validator.
        expected = re.findall(r"'([^']*)'", str(context.get("expected", "")))
        words = expected or list(dict.fromkeys(_allowed_words(schema_nodes_at(schema, path))))
        near = closest_word(value, words) if isinstance(value, str) else None
        hint = f'; did you mean "{near}"?' if near else ""
        return f"must be {_alternatives_text(words)}; {value_text}{hint}"
    if kind == "string_pattern_mismatch":  # names of choices, which become columns
        return f"must begin with a letter and contain only letters, digits, spaces, - and _; {value_text}{write}"
    if kind == "string_too_long":
        return f"{broken_rule(details)}; {value_text}; shorten it"
    if kind in ("too_short", "too_long"):
        return f"{broken_rule(details)}; got {len(value)}{write}"
    is_value = isinstance(value, str | float | int) and not isinstance(value, bool)
    if broken_rule(details) == _TABLE and value in _WISHES and keys_of_location(path)[-2:-1] == ["constraints"]:
        return f"{quote(value)} belongs below [objectives]; got it below [{path[0]}]; move it there"
    if broken_rule(details) == _TABLE and is_value and "equals" in _possible_keys(schema, path):
        fact = FACTS.get(str(path[-1]))
        first, *alternatives = map(toml_text, suggested_bounds(value, fact.kind if fact else None))
        write = f"; write {key_of_location(path[-1:])} = {', '.join(filter(None, (first, ' or '.join(alternatives))))}"
        return f"must be a table with equals, min or max; {value_text}{write}"
    return f"{broken_rule(details)}; {value_text}{write}"


def broken_rule(details: Mapping[str, Any]) -> str:
    """Return the rule that a value breaks, from the validator's finding but without Python terms."""
    kind, context = details["type"], details.get("ctx", {})
    if kind in _LIMITS:
        words, name = _LIMITS[kind]
        return words.format(context[name])
    return _RULES.get(kind) or str(details["msg"])[:1].lower() + str(details["msg"])[1:]


def _alternatives_text(words: Sequence[str]) -> str:
    quoted = [f'"{word}"' for word in words]
    return " or ".join(quoted) if len(quoted) < 3 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"


def example_of_key(schema: Schema, path: Sequence[Any]) -> str:
    """Return an example of the key, as in a job file; "" if the schema has none."""
    for node in schema_nodes_at(schema, path):
        if node.get("examples"):
            key = next((str(part) for part in reversed(keys_of_location(path)) if isinstance(part, str)), "")
            return f"{key} = {toml_text(node['examples'][0])}"
    return ""


def toml_text(value: object) -> str:
    """Return a value in TOML notation, on one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key_of_location([key])} = {toml_text(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(toml_text(item) for item in value) + "]"
    return quote(value)


def _possible_keys(schema: Schema, path: Sequence[Any]) -> dict[str, Any]:
    """Return the keys that are possible in a table."""
    properties: dict[str, Any] = {}
    for node in schema_nodes_at(schema, path):
        properties |= node.get("properties", {})
    return properties


def _allowed_words(nodes: Sequence[Schema]) -> Iterator[str]:
    for node in nodes:
        yield from (str(word) for word in node.get("enum", []))
        if "const" in node:
            yield str(node["const"])


def schema_nodes_at(schema: Schema, path: Sequence[Any]) -> list[Schema]:
    """Return every alternative of the schema at a location; after a tag, only those with its key."""
    nodes = _schema_alternatives(schema, schema)
    for part in path:
        if _is_form_of_value(part):
            nodes = [node for node in nodes if part[1:-1] in node.get("properties", {})] or nodes
            continue
        inner_nodes = []
        for node in nodes:
            inner = node.get("items") if isinstance(part, int) else None
            inner = inner or node.get("properties", {}).get(part) or _schema_of_key_pattern(node, part)
            if inner is None and isinstance(node.get("additionalProperties"), dict):
                inner = node["additionalProperties"]
            if inner:
                inner_nodes += _schema_alternatives(schema, inner)
        nodes = inner_nodes
    return nodes


def _schema_of_key_pattern(node: Schema, part: object) -> Schema | None:
    """Return the schema of keys that match a pattern, such as formulas."""
    patterns = node.get("patternProperties", {}).items() if isinstance(part, str) else ()
    return next((inner for pattern, inner in patterns if re.search(pattern, str(part))), None)


def _schema_alternatives(schema: Schema, node: Schema) -> list[Schema]:
    """Return a node, and the nodes that it refers to or offers as alternatives."""
    nodes = [node]
    if "$ref" in node:
        nodes += _schema_alternatives(schema, schema["$defs"][node["$ref"].rsplit("/", 1)[1]])
    for choice in (*node.get("anyOf", ()), *node.get("oneOf", ())):
        nodes += _schema_alternatives(schema, choice)
    return nodes
