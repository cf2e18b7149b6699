"""Parts of a job with several kinds, such as loads and motors. A key that no other kind has identifies each."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...model.errors import InputError
from ...objectives.units import closest_word, quote
from .value_types import Part

_FEW = 4  # kinds that a table may lack one key for, in a message


@dataclass(frozen=True)
class Kinds:
    """The kinds of a part, each by its key.

    choice: all of them, for messages. remedy: advice if a table matches several.

    synonyms: other words that people try for these keys.
    """

    parts: Mapping[str, type[Part]]
    choice: str
    remedy: str
    synonyms: Mapping[str, str] = field(default_factory=dict)

    def require_one_kind(self, value: object) -> object:
        """Return the value; reject one that is not a table, or matches no kind or several kinds."""
        if isinstance(value, Part):
            return value
        if not isinstance(value, Mapping):
            raise InputError(f"must be a table such as {self.choice}; got {quote(value)}")
        keys_present = [key for key in self.parts if key in value]
        if not keys_present:
            keys = ", ".join(quote(key).strip('"') for key in list(value)[:6]) or "no keys"
            near = [self.synonyms.get(key) or closest_word(key, self.parts) for key in value if isinstance(key, str)]
            hint = next((f"; did you mean {key}?" for key in near if key), "")
            lacking = [key for key, kind in self.parts.items() if value.keys() <= kind.model_fields.keys()]
            if value and 0 < len(lacking) <= min(_FEW, len(self.parts) - 1):
                raise InputError(f"must also have {' or '.join(lacking)}; got {keys} alone")
            raise InputError(f"must be one of {self.choice}; got {keys}{hint}")
        if len(keys_present) > 1:
            raise InputError(f"must be of one kind; got {' and '.join(keys_present)}; {self.remedy}")
        return value

    def kind_tag(self, value: object) -> str:
        """Return the tag of a table's kind, its key in brackets; empty if the table matches no kind."""
        if isinstance(value, Part):
            return next(f"({key})" for key, kind in self.parts.items() if isinstance(value, kind))
        keys = value if isinstance(value, Mapping) else ()
        return next((f"({key})" for key in self.parts if key in keys), "")
