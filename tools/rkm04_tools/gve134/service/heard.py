"""A line that notes what becomes known of the unit. What was sent and not answered is not known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.answers import Answer
from rkm04_tools.gve134.known import Known
from rkm04_tools.gve134.wire import Request, Wire


@dataclass(eq=False)
class HeardWire(Wire):
    """A wire that tells of every exchange: `begins` what is sent, `told` the answer if any came."""

    begins: Callable[[tuple[str, ...]], None] = lambda commands: None
    told: Callable[[Answer | None], None] = lambda answer: None
    known: Known = field(default_factory=Known)

    def exchange(self, request: Request) -> Answer | None:
        """Send once and wait, as Wire does."""
        self.begins(request.commands)
        answer = super().exchange(request)
        for command in request.commands:
            if answer is None or answer.code == answers.DAMAGED:
                self.known = self.known.without(command)
            elif answer.code == answers.DONE:
                self.known = self.known.after(command)
        self.told(answer)
        return answer
