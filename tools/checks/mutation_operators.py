"""Small changes of C sources: another operator, a number off by one, a statement left out.

General tools for mutation write many hundred mutants of a file, most of which do not compile or
change a comment. These know the layout of our sources: operators of two operands stand between
blanks, a statement has a line of its own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

IGNORED = re.compile(
    r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"|^ *#(?:[^\n]*\\\n)*[^\n]*$|\b(?:static_)?assert\(.*?\);',
    re.DOTALL | re.MULTILINE,
)
"""What is not mutated; assertions are not what the tests are for."""

BINARY = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"),
    "==": ("!=",), "!=": ("==",),
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("/",), "&&": ("||",), "||": ("&&",),
    "&": ("|",), "|": ("&",), "^": ("|",), "<<": (">>",), ">>": ("<<",),
    "+=": ("-=",), "-=": ("+=",), "|=": ("&=",), "&=": ("|=",), "^=": ("|=",),
}  # fmt: skip
BINARY_OPERATOR = re.compile(
    r"(?<= )(?:" + "|".join(map(re.escape, sorted(BINARY, key=len, reverse=True))) + r")(?=\s)"
)
OTHER = re.compile(r"\+\+|--|!(?!=)|(?<=[ (\[=])[-~](?=\w)|\btrue\b|\bfalse\b")
OTHERS = {"++": "--", "--": "++", "!": "", "-": "", "~": "", "true": "false", "false": "true"}
NUMBER = re.compile(r"(?<![\w.])(0x[0-9A-F]+|\d+)(U?L?L?)\b")
STATEMENT = re.compile(
    r"^ +(?!return|case|default|static|const|struct|enum|u?int\d|bool|unsigned|for|while|if)"
    r"[\w*(].*;$"
)
DECLARATION = re.compile(r"^ +\w+ \*?\w+( = .*)?;$")


@dataclass(frozen=True)
class Mutant:
    """A source in which something else stands at one place."""

    begin: int
    end: int
    new: str

    def apply(self, source: str) -> str:
        """The source with this change."""
        return source[: self.begin] + self.new + source[self.end :]


def blank_out(source: str) -> str:
    """The source with blanks where nothing is to be mutated."""
    return IGNORED.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), source)


def replacements(line: str) -> Iterator[tuple[int, int, str]]:
    """What could stand in a line instead: from, to, text."""
    for match in BINARY_OPERATOR.finditer(line):
        for new in BINARY[match[0]]:
            yield match.start(), match.end(), new
    for match in OTHER.finditer(line):
        yield match.start(), match.end(), OTHERS[match[0]]
    for match in NUMBER.finditer(line):
        number = int(match[1], 0)
        for other in (number + 1, number - 1):
            if other >= 0:
                yield match.start(), match.end(), f"{other}{match[2]}"


def is_statement(lines: list[str], place: int) -> bool:
    """Whether a line is a whole statement that can be left out."""
    line = lines[place]
    before = next((text.rstrip() for text in reversed(lines[:place]) if text.strip()), "")
    begins = before.endswith(("{", "}", ";", ":"))
    return begins and bool(STATEMENT.match(line)) and not DECLARATION.match(line)


def mutants(source: str) -> Iterator[Mutant]:
    """All mutants of a source, in its order."""
    code = blank_out(source).split("\n")
    start = 0
    for place, line in enumerate(code):
        for begin, end, text in replacements(line):
            yield Mutant(start + begin, start + end, text)
        if is_statement(code, place):
            yield Mutant(start + len(line) - len(line.lstrip()), start + len(line), ";")
        start += len(line) + 1
