"""The flow of a program in the model of the language: labels, jumps, loops, subroutines."""

from __future__ import annotations

from collections.abc import Callable

from language_memory import Memory
from language_setup import Failed
from language_text import Command

LOOPS_MAX = 8
CALLS_MAX = 6


class Flow:
    """Where a program is. `next` and `place` are ordinals: of the next command, and of the last."""

    def __init__(self, memory: Memory) -> None:
        self.next = 1
        self.place = 0
        self._memory = memory
        self._calls: list[int] = []
        self._loops: list[list[tuple[int, int]]] = [[]]
        """Those open in the main program, and in each call: where its body begins, passes left."""

    def fetch(self) -> Command:
        """Take the next command, the oldest that is left if that one is gone."""
        self.place = max(self.next, self._memory.oldest)
        self.next = self.place + 1
        return self._memory.read(self.place)

    def obey(self, command: Command, level: Callable[[int], int]) -> None:
        """Do a command of the flow; `level` tells that of an input or variable."""
        match command.letter:
            case "J":
                self.next = self._find(command.number)
            case "IH" | "IL":
                if level(command.number) == int(command.letter == "IH"):
                    self.next = self._find(command.label)
            case "L":
                self._begin_loop(command.number)
            case "E":
                self._end_loop()
            case "'":
                self._call(command.number)
            case ".":
                if not self._calls:
                    raise Failed(". without a call")
                self.next = self._calls.pop()
                self._loops.pop()

    def _find(self, label: int) -> int:
        target = self._memory.find_label(label)
        if target is None:
            raise Failed("label not found")
        return target

    def _call(self, label: int) -> None:
        if len(self._calls) == CALLS_MAX:
            raise Failed("more than 6 nested calls")
        target = self._find(label)
        self._calls.append(self.next)
        self._loops.append([])
        self.next = target

    def _begin_loop(self, times: int) -> None:
        """Begin a loop; what has been jumped out of, and comes again, begins anew."""
        here = self._loops[-1]
        begins = [begin for begin, _ in here]
        if self.next in begins:
            del here[begins.index(self.next) :]
        if sum(map(len, self._loops)) == LOOPS_MAX:
            raise Failed("more than 8 nested loops")
        here.append((self.next, times))

    def _end_loop(self) -> None:
        """End a pass of the loop begun last, be it in a caller."""
        loops = next((loops for loops in reversed(self._loops) if loops), None)
        if loops is None:
            raise Failed("E without L")
        begin, left = loops.pop()
        if left > 1:
            loops.append((begin, left - 1))
            self.next = begin
