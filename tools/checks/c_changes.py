"""Small changes of sources, listed by function and expression.

    firmware/engine/step/step_channel.c step_channel_init
    - .direction = 1
    + .direction = 0

is what stands in the function, and what may stand there instead. Tokens are compared, so layout
and comments do not matter. If they stand there more than once, a number after the function tells
which, from 1; without a function they are looked for in the whole file. A line that begins with
blanks goes on with the one above.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from checks.c_source import Mismatch, source, words

PAIRS = re.compile(r"(?:- .*\n(?:  .*\n)*(?:\+(?: .*)?\n(?:  .*\n)*)+)+")
GROUP = re.compile(r"^- ((?:.*\n)(?:  .*\n)*)((?:\+.*\n(?:  .*\n)*)+)", re.MULTILINE)
NEW = re.compile(r"^\+(.*\n(?:  .*\n)*)", re.MULTILINE)

Key = tuple[str, str, int, str, str]


@dataclass(frozen=True)
class Change:
    """One change."""

    file: str
    function: str
    number: int
    old: str
    new: str

    def __str__(self) -> str:
        place = [self.file, self.function, str(self.number or "")]
        old, new = (" ".join(text.split()) for text in (self.old, self.new))
        return f"{' '.join(filter(None, place))}\n- {old}\n+ {new}"

    def key(self) -> Key:
        """What tells it from others: tokens."""
        return self.file, self.function, self.number, words(self.old), words(self.new)

    def apply(self, text: str) -> str:
        """The file's text with this change; a Mismatch if there is no such place, or several."""
        try:
            begin, end = source(text).find(self.function, self.old, self.number)
        except Mismatch as error:
            raise Mismatch(f"{self.file}: {error}") from error
        return text[:begin] + self.new + text[end:]


def read_changes(text: str) -> Iterator[tuple[list[Change], str]]:
    """The blocks of a list, with an empty line between them: changes, and what is said below."""
    for block in text.split("\n\n"):
        lines = [line for line in block.splitlines() if not line.startswith("#")]
        if lines:
            yield read_block(lines)


def read_block(lines: list[str]) -> tuple[list[Change], str]:
    """The changes of one block, and the lines below them."""
    file, *rest = lines[0].split()
    number = int(rest.pop()) if rest and rest[-1].isdecimal() else 0
    pairs = PAIRS.match("\n".join([*lines[1:], ""]))
    if len(rest) > 1 or pairs is None:
        raise Mismatch(f"a place, `- what stands there`, `+ what may stand there`: {lines[0]}")
    changes = [
        Change(file, "".join(rest), number, old.strip(), new.strip())
        for old, several in GROUP.findall(pairs[0])
        for new in NEW.findall(several)
    ]
    return changes, "\n".join(lines[1 + pairs[0].count("\n") :])
