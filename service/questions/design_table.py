"""Tables of designs, with a row for each quantity, for answers to questions about a front."""

from collections.abc import Collection

from ...objectives.kinds import name_and_kind_of_key
from ..designs.columns import find_column
from ..render.blocks import Text, Unit


def title_and_unit(key: str, keys: Collection[str]) -> tuple[Text, Text]:
    """Return the title of a metric column and its unit."""
    return find_column(key, keys).title, Unit(name_and_kind_of_key(key)[1])
