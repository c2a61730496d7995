"""A line that notes what becomes known of the unit. What was sent and not answered is not known."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.answers import Answer
from rkm04_tools.gve134.known import Known
from rkm04_tools.gve134.wire import Wire


@dataclass(eq=False)
class HeardWire(Wire):
    """A wire that tells of every request: `begins` what is sent, `told` the answer if any came."""

    begins: Callable[[Sequence[str]], None] = lambda commands: None
    told: Callable[[Answer | None], None] = lambda answer: None
    known: Known = field(default_factory=Known)

    def begin(self, commands: Sequence[str]) -> None:
        """Commands are going to be sent, see Wire."""
        self.begins(commands)

    def end(self, commands: Sequence[str], answer: Answer | None) -> None:
        """They had an answer or none, see Wire."""
        for command in commands:
            if answer is None:
                self.known = self.known.without(command)
            elif answer.code == answers.DONE:
                self.known = self.known.after(command)
        self.told(answer)

    def lose(self) -> None:
        """Nothing that was known has to be true any more, see Wire."""
        self.known = Known()
