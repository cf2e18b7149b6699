"""Words of a schema that are unknown to JSON Schema: readers of the schema ignore them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

_OF_SCHEMAS = (
    *("items", "contains", "additionalProperties", "propertyNames", "not", "if", "then", "else"),
    *("unevaluatedItems", "unevaluatedProperties", "contentSchema"),
)
_OF_LISTS = ("allOf", "anyOf", "oneOf", "prefixItems")
_OF_NAMES = ("$defs", "properties", "patternProperties", "dependentSchemas")
_PLAIN = (
    *("$id", "$schema", "$ref", "$anchor", "$dynamicRef", "$dynamicAnchor", "$vocabulary", "$comment"),
    *("type", "enum", "const", "multipleOf", "maximum", "exclusiveMaximum", "minimum", "exclusiveMinimum"),
    *("maxLength", "minLength", "pattern", "maxItems", "minItems", "uniqueItems", "maxContains", "minContains"),
    *("maxProperties", "minProperties", "required", "dependentRequired", "format"),
    *("title", "description", "default", "deprecated", "readOnly", "writeOnly", "examples"),
    *("contentEncoding", "contentMediaType"),
)
KNOWN = frozenset((*_PLAIN, *_OF_SCHEMAS, *_OF_LISTS, *_OF_NAMES))
"""Words of all vocabularies of draft 2020-12."""
OF_OPENAPI = frozenset(("discriminator", "xml", "externalDocs", "example"))
"""Words that OpenAPI 3.1 adds to a schema."""


def unknown_words(schema: Any, known: frozenset[str] = KNOWN, place: str = "") -> Iterator[str]:
    """Yield place and word of each unknown word; words that begin with x- are allowed."""
    if not isinstance(schema, Mapping):
        return
    for word, value in schema.items():
        if word not in known and not word.startswith("x-"):
            yield f"{place}: {word}"
        if word in _OF_SCHEMAS:
            yield from unknown_words(value, known, f"{place}/{word}")
        elif word in _OF_LISTS:
            for number, inner in enumerate(value):
                yield from unknown_words(inner, known, f"{place}/{word}/{number}")
        elif word in _OF_NAMES:
            for name, inner in value.items():
                yield from unknown_words(inner, known, f"{place}/{word}/{name}")


def schemas_within(document: Any, place: str = "") -> Iterator[tuple[str, Any]]:
    """Yield place and schema of every schema in an OpenAPI description that is not inside another one."""
    if isinstance(document, list):
        for number, item in enumerate(document):
            yield from schemas_within(item, f"{place}/{number}")
    elif isinstance(document, Mapping):
        for key, value in document.items():
            if key == "schema":
                yield place, value
            elif key == "schemas":
                yield from ((f"{place}/schemas/{name}", schema) for name, schema in value.items())
            else:
                yield from schemas_within(value, f"{place}/{key}")
