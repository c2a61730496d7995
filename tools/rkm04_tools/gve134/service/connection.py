"""The port, the unit at its end, and what is seen of it. To be used from the worker's thread."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import Any

from rkm04_tools.failure import Failure
from rkm04_tools.gve134.answers import Answer
from rkm04_tools.gve134.client_base import TOOL
from rkm04_tools.gve134.known import AFTER_RESET, Known
from rkm04_tools.gve134.link import Link
from rkm04_tools.gve134.link_errors import OutOfStep, Restarted
from rkm04_tools.gve134.service import working
from rkm04_tools.gve134.service.board import NOT_CONNECTED, Board, State
from rkm04_tools.gve134.service.heard import HeardWire
from rkm04_tools.gve134.service.looking import Looks, Made
from rkm04_tools.gve134.service.saying import WORDS
from rkm04_tools.gve134.state import RUN, Positions
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.holding import UNKNOWN, held, holder_of
from rkm04_tools.line_errors import PortBusy
from rkm04_tools.service import virtual
from rkm04_tools.service.unit_line import UnitLine
from rkm04_tools.service.virtual import VirtualLine
from rkm04_tools.transport import Port, open_transport

LOOK_SECONDS = 0.1
"""From one look to the next at least; looks take no more than half of the line's time."""
ADVICE = "end it, then connect again"
INPUTS_SECONDS = 0.6
"""From one look at the inputs to the next while a file is sent."""


class Connection(UnitLine[Unit, State]):
    """`job` is the last file that was started there.

    `jogging`: a motion by hand is under way, as far as is known.
    """

    restarted = Restarted

    def __init__(
        self, board: Board, units: VirtualLine, baud: int, mind_halt: Callable[[], None]
    ) -> None:
        super().__init__(board, NOT_CONNECTED, WORDS)
        self.job: working.Work | None = None
        self.jogging = False
        self.looks = Looks()
        self.made = Made()
        self._inputs_due = 0.0
        self._units = units
        self._baud = baud
        self._mind_halt = mind_halt
        self._wire: HeardWire | None = None
        self._link: Link | None = None
        self._note = ExitStack()

    @property
    def known(self) -> Known:
        """What follows from what was sent."""
        return self._wire.known if self._wire else Known()

    # ---- the port ----

    def _greet(self, unit: Unit) -> str:
        unit.link.connect()
        if unit.link.restarted:
            self.restart()
        self.look(unit)
        return unit.link.version

    def version_of(self, unit: Unit) -> str:
        """The version, after a look."""
        return unit.link.version

    def take_back(self) -> None:
        """What waits in the port is not sent any more."""
        if self._wire:
            self._wire.port.take_back()

    def _drop(self) -> None:
        if self._wire:
            self._wire.port.abandon()
        if self.job and self.job.is_open:
            self.end_job(working.FAILED, Failure("the port was closed; the rest was not sent"))
        self._note.close()
        self._wire = None
        self.jogging = False

    def disconnect(self) -> str:
        """Close the port; what is connected to next may be another unit."""
        self._link = None
        return super().disconnect()

    def _open(self, port: str) -> None:
        self._wire = HeardWire(
            self._opened(port), self._baud, look=self._mind_halt,
            begins=self._begin, told=self._hear,
        )  # fmt: skip
        if self._link is None or self._link.name != self._wire.port.name:
            self._link = Link(self._wire)
        self._link.wire = self._wire  # a unit that has started anew meanwhile is known by it
        self.unit = Unit(self._link)
        self.looks, self.job = Looks(), None
        self.begin_way()

    def _opened(self, port: str) -> Port:
        """The port, which no command may use beside this page; each virtual unit is its own."""
        if port == virtual.NAME:
            return open_transport(self._units.open(), self._baud)
        try:
            self._note.enter_context(held(port, TOOL, ADVICE))
            return open_transport(port, self._baud)
        except PortBusy:
            self._note.close()
            who = holder_of(port).removeprefix(f"{TOOL} ")  # its name is not for a page
            if who == UNKNOWN:
                raise
            raise PortBusy(f"{port}: the command {who} has this line; {ADVICE}") from None
        except Failure:
            self._note.close()
            raise

    def _begin(self, commands: Sequence[str]) -> None:
        self._board.change(reference=commands[0].startswith("W"))

    def _hear(self, answer: Answer | None) -> None:
        if answer is not None:
            self._board.heard_at = time.monotonic()
        self._board.change(known=self.known)

    # ---- what is seen ----

    def begin_way(self) -> None:
        """Forget the way that was made."""
        self.made.clear()
        self._board.tell(self.made.as_json())

    def look(self, unit: Unit, pause_seconds: float = LOOK_SECONDS) -> None:
        """Look at the unit, and tell what there is to be seen."""
        now, job = time.monotonic(), self.job
        self.look_due = now + pause_seconds
        with_inputs = not (job and job.is_under_way) or now >= self._inputs_due
        if with_inputs:
            self._inputs_due = now + INPUTS_SECONDS
        seen = self.looks.look(unit, with_inputs)
        positions, flags = self.looks.positions, self.looks.flags
        assert positions is not None
        assert flags is not None
        is_at_rest = flags.stands and not flags.has(RUN)
        self.jogging = self.jogging and not is_at_rest
        corners: list[Positions] = []
        progress = None
        if job and job.is_open:
            corners = job.see(positions, is_at_rest)
            percent = self.known.percent
            progress = job.progress(flags, None if percent is None else percent / 100)
        made = [place[:3] for place in self.made.go(corners, positions)]
        self._board.tell({**seen, "progress": progress, "made": made})

    def forget(self) -> None:
        """The unit has started anew: what it was told is gone."""
        if self._wire:
            self._wire.known = AFTER_RESET
        self.looks = Looks()
        self.jogging = False
        if self.job and self.job.is_open:
            self.end_job(working.FAILED, Failure("the unit has restarted; the job is gone"))
        self._board.change(known=self.known, wanted=None)

    def lose(self, why: Failure) -> None:
        """Another program has used the line: the job is not gone on with."""
        if self.job and self.job.is_open:
            self.end_job(working.FAILED, why)

    def note(self, got: object, comes_back: bool = True) -> None:
        """Keep what says that there is no connection, see UnitLine."""
        if isinstance(got, OutOfStep):
            self.lose(got)
        super().note(got, comes_back)

    def kept_when_lost(self) -> dict[str, Any]:
        """What of a state stays as it is when the port is lost."""
        return {**super().kept_when_lost(), "job": self._board.state.job}

    def when_silent(self) -> dict[str, Any]:
        """What of a state changes where the unit does not answer."""
        return {"reference": False}

    # ---- the job ----

    def enter(self, phase: str, text: str = "") -> None:
        """Tell in which phase the job is."""
        assert self.job is not None
        self.job.phase, self.job.text = phase, text
        self._board.change(job=self.job.as_json())

    def end_job(self, phase: str, trouble: Failure | None) -> None:
        """Tell how it has ended."""
        assert self.job is not None
        self.job.trouble = trouble
        self.enter(phase)
