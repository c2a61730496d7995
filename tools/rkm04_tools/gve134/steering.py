"""What a person does to a job with keys: its speed, a halt, and that it goes on.

The speed goes in sixteenths (XU, XD), as XM and XA would give all vectors the last V, which may be
that of a rapid move. A unit does not tell its factor, so it is shown against that at the start
until a command says what it is.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

from rkm04_tools.bar import Bar
from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.keys import Keys
from rkm04_tools.gve134.known import FACTOR_ONE, step_towards, stepped
from rkm04_tools.gve134.link_errors import Refused
from rkm04_tools.gve134.sending import Sender
from rkm04_tools.gve134.stopping import halt_loudly, halted_text
from rkm04_tools.gve134.unit import POLL_SECONDS

FASTER, SLOWER, AS_BEFORE = "+=", "-_", "0"
HALT, GO = " !", "gG~"
HELP = (
    "keys: + faster, - slower, 0 about the speed at the start, space halts, g goes on; "
    "Ctrl-C halts and ends"
)
HELD = "g goes on, Ctrl-C ends the job and leaves the line to others"
STEPS_PER_TURN = 4
LATE_SECONDS = 0.5
"""A halt that cannot be obeyed between two commands until then ends the job, as Ctrl-C does."""
LOOK_SECONDS = 1.0


class Held(Exception):
    """A person wants the axes to stand, and the job to wait."""


class Steering:
    """Reads keys, and does what they ask for between two commands of a job."""

    def __init__(self, sender: Sender, keys: Keys, bar: Bar) -> None:
        self._sender = sender
        self._keys = keys
        self._bar = bar
        self._steps: list[str] = []
        self._to_start = False
        self._factor = FACTOR_ONE
        """Against the start."""
        self._halt_due = 0.0
        """When a halt that was asked for must be obeyed at the latest; 0: none was."""
        self._goes_on = False
        self._holds = False
        self.held_s = 0.0

    @property
    def text(self) -> str:
        """The speed, for the line that shows how far it is."""
        if self._sender.known.percent is not None:
            return f", speed {self._sender.known.percent:.1f} %"
        return f", speed x{self._factor / FACTOR_ONE:.2f}" if self._factor != FACTOR_ONE else ""

    def watching(self, look: Callable[[], None]) -> Callable[[], None]:
        """What is to be called again and again while an answer is waited for."""

        def both() -> None:
            look()
            self._read()
            if 0 < self._halt_due < time.monotonic():
                self._halt_due = 0.0
                raise KeyboardInterrupt

        return both

    def _read(self) -> None:
        for key in self._keys.read():
            if key in HALT and not self._holds:
                self._halt_due = self._halt_due or time.monotonic() + LATE_SECONDS
            elif key in GO:
                self._goes_on = True
            elif key in AS_BEFORE:
                self._steps, self._to_start = [], True
            elif key in FASTER + SLOWER and not self._holds:
                self._steps.append("XU" if key in FASTER else "XD")
                self._to_start = False

    def between(self) -> None:
        """Between two commands: do what was asked for; Held: the axes are to stand."""
        self._read()
        if self._halt_due:
            self._halt_due = 0.0
            raise Held
        for _ in range(STEPS_PER_TURN):
            command = self._next_step()
            if command is None:
                break
            self._sender.unit.order(command)
            self._factor = stepped(self._factor, command)
            self._sender.known = self._sender.known.after(command)

    def _next_step(self) -> str | None:
        if self._steps:
            return self._steps.pop(0)
        if self._to_start:
            known = self._sender.known.factor
            step = step_towards(self._factor if known is None else known, 100)
            self._to_start = step is not None
            return step
        return None

    def hold(self) -> None:
        """Halt, tell where the axes stand, and wait until the job is to go on."""
        begun = time.monotonic()
        self._holds = True
        self._bar.clear()
        print("gve134: halting ...", file=sys.stderr, flush=True)
        sender, unit = self._sender, self._sender.unit
        halted = halt_loudly(unit)
        halted.require_known(unit.link.name)
        text = f"{halted_text(halted)}; {sender.executed_text(halted.positions)}"
        print(f"gve134: {text}; {sender.spindle_text}", file=sys.stderr)
        print(f"gve134: {HELD}", file=sys.stderr, flush=True)
        self._wait_for_go()
        unit.link.require_own()
        answer = unit.link.ask("G")
        if answer.code not in (answers.DONE, answers.NOTHING_TO_GO_ON):
            raise Refused("G", answer)
        self._holds = False
        self.held_s += time.monotonic() - begun

    def _wait_for_go(self) -> None:
        """Until then it is looked whether the unit is still there, and has not restarted."""
        self._goes_on, look_due = False, 0.0
        while not self._goes_on:
            if time.monotonic() >= look_due:
                self._sender.unit.flags()
                look_due = time.monotonic() + LOOK_SECONDS
            self._sender.unit.link.pause(POLL_SECONDS)
