"""The program memory of one motor in the model: a ring of commands with ordinals."""

from __future__ import annotations

from collections import deque

from language_text import Command, listing

COMMANDS_MAX = 700


class Memory:
    """Commands since the last `\\`; the first one has the ordinal 1."""

    def __init__(self) -> None:
        self._commands: deque[Command] = deque()
        self._written = 0
        self._released = 0

    @property
    def end(self) -> int:
        """The ordinal after the youngest command."""
        return self._written + 1

    @property
    def oldest(self) -> int:
        """The ordinal of the oldest command that is left."""
        return self.end - len(self._commands)

    @property
    def text(self) -> bytes:
        """The listing of what is left."""
        return listing(list(self._commands))

    def write(self, command: Command, locked: bool) -> bool:
        """Append a command; whether there was room. If not, the oldest goes, or this if locked."""
        full = len(self._commands) == COMMANDS_MAX
        if full and locked:
            return False
        if full:
            self._commands.popleft()
        self._commands.append(command)
        self._written += 1
        if command.letter == "]":
            self._released = self._written
        return not full

    def read(self, ordinal: int) -> Command:
        """The command of an ordinal."""
        return self._commands[ordinal - self.oldest]

    def is_released(self, ordinal: int) -> bool:
        """Whether a `]` has been stored after an ordinal."""
        return self._released > ordinal

    def find_label(self, number: int) -> int | None:
        """The ordinal of the youngest label with a number."""
        wanted = Command("@", number)
        for back, command in enumerate(reversed(self._commands)):
            if command == wanted:
                return self._written - back
        return None
