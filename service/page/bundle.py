"""The page's modules joined into one script, and its styles into one stylesheet: two requests instead of seventy.

The first view of 10,000 designs appears a fifth sooner. The modules stay unchanged, and are tested as served. Comments,
types and indentation are removed, which saves three tenths of the text. The modules use a small part of
JavaScript's module syntax; anything else is rejected when the service starts: `import { a, b as c } from "./file.js";`,
`import("./file.js")`, and `export` before a function, class or const.
"""

import posixpath
import re
from collections.abc import Mapping

_IMPORT = re.compile(r'^import \{([^}]*)\} from "([^"]+)";', re.MULTILINE)
_LATER = re.compile(r'\bimport\("([^"]+)"\)')
_EXPORT = re.compile(r"^export ((?:async )?function\*? |class |const )(\w+)", re.MULTILINE)
_LEFT = re.compile(r"^(?:import|export)\b.*|\bimport\(.*", re.MULTILINE)
_EXPLAINED = re.compile(
    r"^[ \t]*(?:/\*\*(?:(?!\*/).)*\*/|//[^\n]*)\n|/\*\* @type [^\n]*?\*/ |[ \t]+// [^\"'`\n]*$",
    re.MULTILINE | re.DOTALL,
)
_INDENTATION = re.compile(r"^[ \t]+", re.MULTILINE)
_TAKE = """const made = {};
const make = {};
function take(name) {
  return (made[name] ??= make[name]());
}
"""


def joined_modules(sources: Mapping[str, str], first: str) -> str:
    """Return one module equivalent to the module `first`. sources: text by name, such as "lib/dom.js".

    Each module becomes a function that returns its exports and is called on the first import. Raises ValueError for
    circular imports and for unsupported syntax.
    """
    parts: dict[str, str] = {}

    def add(name: str, importers: tuple[str, ...] = ()) -> None:
        if name in importers:
            raise ValueError(f"modules must not import each other in a circle; got {' -> '.join((*importers, name))}")
        if name in parts:
            return
        text, now, later = _as_function(name, sources)
        for imported in now:
            add(imported, (*importers, name))
        parts[name] = text
        for imported in later:
            add(imported)

    add(first)
    return _TAKE + "".join(parts.values()) + f'take("{first}");\n'


def _as_function(name: str, sources: Mapping[str, str]) -> tuple[str, list[str], list[str]]:
    """Return a module as an entry of `make`, and the modules that it imports immediately and later."""
    if name not in sources:
        raise ValueError(f"a module imports {name}, which is not there")
    now: list[str] = []
    later: list[str] = []

    def resolve(path: str) -> str:
        return posixpath.normpath(posixpath.join(posixpath.dirname(name), path))

    def replace_import(match: re.Match[str]) -> str:
        now.append(resolve(match[2]))
        return f'const {{{match[1].replace(" as ", ": ")}}} = take("{now[-1]}");'

    def replace_dynamic_import(match: re.Match[str]) -> str:
        later.append(resolve(match[1]))
        return f'Promise.resolve().then(() => take("{later[-1]}"))'

    code = _INDENTATION.sub("", _EXPLAINED.sub("", sources[name]))
    text = _LATER.sub(replace_dynamic_import, _IMPORT.sub(replace_import, code))
    exported = [match[2] for match in _EXPORT.finditer(text)]
    text = _EXPORT.sub(r"\1\2", text)
    if strange := _LEFT.search(text):
        raise ValueError(f"{name} must import and export as bundle.py says; got {strange[0][:100]!r}")
    return f'make["{name}"] = () => {{\n{text}return {{ {", ".join(exported)} }};\n}};\n', now, later


def joined_styles(sources: Mapping[str, str]) -> str:
    """Return the concatenated styles, those for all views first. sources: text by name."""
    common = [name for name in sources if name.endswith("shell.css")]
    return "\n".join(sources[name] for name in (*common, *sorted(set(sources) - set(common))))
