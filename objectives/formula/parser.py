"""Parser for formulas: converts text to a tree; nothing in the text is ever executed."""

import re
from dataclasses import dataclass
from typing import NoReturn, Protocol

from ...model.errors import InputError
from ..units import SPACES
from .expression import ARGUMENTS, Call, Name, Node, Number

LONGEST = 500
"""Maximum number of characters in a formula."""
_MOST = 100
"""Maximum number of operators and functions in a formula, which also limits the depth of its tree."""
DEEPEST = 40
"""Maximum nesting of brackets, functions and operators."""
_TOKEN = re.compile(
    r"""\s*(?:
    (?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)
    |(?P<name>[A-Za-zµμ°_]\w*(?:\.\w+)*)
    |(?P<sign>\*\*|[-+*/^(),·⋅])
    )""",
    re.VERBOSE | re.ASCII,
)
_UNIT = r"([A-Za-zµμ°]+)(?:(?=\d(?![\w.]))|(?![\w.]))(?!\s*\()"
_NEXT_UNIT = re.compile(rf"\s*{_UNIT}", re.ASCII)
_OTHER_UNIT = re.compile(rf"\s*[*/·⋅]\s*{_UNIT}", re.ASCII)
_POWER = re.compile(r"(?:(?:\^|\*\*)([+-]?\d)|(\d))(?![\w.])", re.ASCII)
_SAME: dict[int, str] = {
    ord(sign): other for sign, other in zip("^·⋅−×÷²³", ("**", "*", "*", "-", "*", "/", "**2", "**3"), strict=True)
} | {ord(space): " " for space in SPACES}
_EXAMPLE = '"offset - 2 * crank" or "min(crank, 30 mm)"'


class Units(Protocol):
    """Units that numbers in a formula may have."""

    def is_unit(self, name: str) -> bool:
        """Return whether a name after a number is a unit."""
        ...

    def number_in_si(self, digits: str, unit: str) -> float:
        """Return a number in SI. Raises `InputError`, whose message begins with the unit, for an unknown unit."""
        ...


def parse(text: str, units: Units) -> Node:
    """Return the tree of a formula. Raises `InputError` for anything else.

    Numbers may be followed by a unit: "3 mm", "2 N m", "7800 kg/m^3". Any other name is a quantity or another number in
    the problem. Operators: + - * / ** (or ^) and brackets; functions: `ARGUMENTS`.
    """
    if len(text) > LONGEST:
        raise InputError(f"a formula may have at most {LONGEST} characters; got {len(text)}; give parts of it names")
    reader = _Reader(text.translate(_SAME), units)
    node = reader.read_sum()
    if reader.next.text:
        reader.raise_error(f"one of + - * / ** is missing before {reader.next.text}")
    return node


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    end: int


class _Reader:
    """A text parsed from left to right, with one method for each level of binding strength."""

    def __init__(self, text: str, units: Units) -> None:
        self.text, self.units = text, units
        self.depth = self.calls = 0
        self.next = _Token("", "", 0)
        self.advance_to_next_token(0)

    def advance_to_next_token(self, place: int | None = None) -> None:
        """Move to the token after a position, by default the current one."""
        place = self.next.end if place is None else place
        match = _TOKEN.match(self.text, place)
        if match is not None:
            self.next = _Token(str(match.lastgroup), match[str(match.lastgroup)], match.end())
        elif self.text[place:].strip():
            self.raise_error(f"{self.text[place:].strip()[0]!r} has no meaning in a formula")
        else:
            self.next = _Token("end", "", len(self.text))

    def take_operator(self, *signs: str) -> str | None:
        """Return the next operator if it is one of `signs`, and move past it; None otherwise."""
        sign = self.next.text
        if self.next.kind != "sign" or sign not in signs:
            return None
        self.advance_to_next_token()
        return sign

    def raise_error(self, rule: str, remedy: str = f"write it like {_EXAMPLE}") -> NoReturn:
        text = " ".join(self.text.split())
        quoted = text if len(text) <= 60 else f"{text[:60]}..."
        raise InputError(f"{rule}; got the formula {quoted!r}; {remedy}")

    def enter_nesting(self) -> None:
        self.depth += 1
        if self.depth > DEEPEST:
            self.raise_error(
                f"brackets, functions and operators must be nested at most {DEEPEST} deep", "give parts of it names"
            )

    def counted_call(self, function: str, *arguments: Node) -> Call:
        self.calls += 1
        if self.calls > _MOST:
            self.raise_error(f"a formula may have at most {_MOST} operators and functions", "give parts of it names")
        return Call(function, arguments)

    # ---- one method for each level of binding strength ---------------------------------------------------------------

    def read_sum(self) -> Node:
        self.enter_nesting()
        node = self.read_product()
        while sign := self.take_operator("+", "-"):
            node = self.counted_call(sign, node, self.read_product())
        self.depth -= 1
        return node

    def read_product(self) -> Node:
        node = self.read_signed()
        while sign := self.take_operator("*", "/"):
            node = self.counted_call(sign, node, self.read_signed())
        return node

    def read_signed(self) -> Node:
        minus = False
        while sign := self.take_operator("+", "-"):
            minus ^= sign == "-"
        node = self.read_power()
        if not minus:
            return node
        if isinstance(node, Number) and not node.digits.startswith("-"):
            return Number(-node.si, f"-{node.digits}", node.unit)
        return self.counted_call("neg", node)

    def read_power(self) -> Node:
        node = self.read_atom()
        if not self.take_operator("**", "^"):
            return node
        self.enter_nesting()
        node = self.counted_call("**", node, self.read_signed())
        self.depth -= 1
        return node

    def read_atom(self) -> Node:
        token = self.next
        if token.kind == "number":
            return self.read_number()
        if token.kind == "name":
            self.advance_to_next_token()
            return self.read_function_call(token.text) if self.next.text == "(" else Name(token.text)
        if self.take_operator("("):
            node = self.read_sum()
            self.require_closing_bracket()
            return node
        if token.kind == "end":
            self.raise_error("a number, a name or a bracket is missing at its end")
        self.raise_error(f"a number, a name or a bracket is missing before {token.text}")

    def require_closing_bracket(self) -> None:
        if not self.take_operator(")"):
            self.raise_error("every opening bracket must be closed")

    def read_function_call(self, name: str) -> Node:
        if name not in ARGUMENTS:
            self.raise_error(f"a function is one of {', '.join(ARGUMENTS)}", f"{name} is not one of them")
        self.advance_to_next_token()
        arguments = [self.read_sum()]
        while self.take_operator(","):
            arguments.append(self.read_sum())
        self.require_closing_bracket()
        least, greatest = ARGUMENTS[name]
        if not least <= len(arguments) <= greatest:
            count = "one argument" if greatest == 1 else f"{least} to {greatest} arguments, with commas between"
            self.raise_error(f"{name} takes {count}", f"it has {len(arguments)}")
        return self.counted_call(name, *arguments)

    # ---- numbers ---------------------------------------------------------------------------------------------------

    def read_number(self) -> Node:
        digits, place = self.next.text, self.next.end
        unit, place = self.read_unit(place)
        try:
            si = self.units.number_in_si(digits, unit)
        except InputError as error:
            self.raise_error(str(error))
        self.advance_to_next_token(place)
        return Number(si, digits, unit)

    def read_unit(self, place: int) -> tuple[str, int]:
        """Return the unit at a position, "" if there is none, and the position after it."""
        text = ""
        match = _NEXT_UNIT.match(self.text, place)
        while match:
            sign = self.text[match.start() : match.start(1)].strip()
            text += f"{sign or ' '}{match[1]}" if text else match[1]
            place = match.end()
            if power := _POWER.match(self.text, place):
                text, place = f"{text}^{power[1] or power[2]}", power.end()
            match, joined = _NEXT_UNIT.match(self.text, place), _OTHER_UNIT.match(self.text, place)
            if match is None and joined and self.units.is_unit(joined[1]):
                match = joined
        return text, place
