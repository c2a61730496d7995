"""The port, the unit at its end, and what is seen of it. To be used from the worker's thread."""

from __future__ import annotations

import time
from collections.abc import Callable

from rkm04_tools.failure import Failure
from rkm04_tools.gve134.answers import Answer
from rkm04_tools.gve134.link import Link
from rkm04_tools.gve134.link_errors import Restarted
from rkm04_tools.gve134.service import working
from rkm04_tools.gve134.service.board import NOT_CONNECTED, Board
from rkm04_tools.gve134.service.heard import AFTER_RESET, HeardWire, Known
from rkm04_tools.gve134.service.looking import Looks, Made
from rkm04_tools.gve134.service.words import told
from rkm04_tools.gve134.state import RUN, Positions
from rkm04_tools.gve134.unit import Unit
from rkm04_tools.line_errors import LineError, PortError
from rkm04_tools.service import virtual
from rkm04_tools.service.trouble import Fault, NotConnected
from rkm04_tools.service.virtual import VirtualLine
from rkm04_tools.transport import open_transport

LOOK_SECONDS = 0.1
"""From one look to the next at least; looks take no more than half of the line's time."""
INPUTS_SECONDS = 0.6
"""From one look at the inputs to the next while a file is sent."""


class Connection:
    """`unit` is None where no port is open. `job` is the last file that was started there.

    `jogging`: a motion by hand is under way, as far as is known.
    """

    def __init__(
        self, board: Board, units: VirtualLine, baud: int, mind_halt: Callable[[], None]
    ) -> None:
        self.unit: Unit | None = None
        self.job: working.Work | None = None
        self.jogging = False
        self.looks = Looks()
        self.made = Made()
        self.look_due = 0.0
        self._inputs_due = 0.0
        self._board = board
        self._units = units
        self._baud = baud
        self._mind_halt = mind_halt
        self._wire: HeardWire | None = None

    @property
    def known(self) -> Known:
        """What follows from what was sent."""
        return self._wire.known if self._wire else Known()

    # ---- the port ----

    def connect(self, port: str) -> str:
        """Open the port if it is not open, and ask what is there: nothing moves."""
        if not self.unit or self._board.state.port != port:
            self.close()
            self._board.heard_at = None
            self._board.change(**{**NOT_CONNECTED, "port": port, "virtual": port == virtual.NAME})
            self._open(port)
        self._board.change(connected=True)
        assert self.unit is not None
        self.unit.link.connect()
        self.look(self.unit)
        self._board.change(version=self.unit.link.version, error=None)
        return self.unit.link.version

    def disconnect(self) -> str:
        """Close the port."""
        self.close()
        self._board.change(**{**NOT_CONNECTED, "port": None, "virtual": False})
        return "the port is closed; the unit is left as it is"

    def reopen(self) -> Unit:
        """The unit; a port that was lost is opened again."""
        if not self.unit:
            self._open(self._board.state.port or "")
            self._board.change(connected=True, away=False, version=None)
        assert self.unit is not None
        return self.unit

    def close(self, abandons: bool = False) -> None:
        """Close the port; `abandons`: what waits in it is not sent any more."""
        if self._wire:
            if abandons:
                self._wire.port.abandon()
            else:
                self._wire.port.close()
        if self.job and self.job.is_open:
            self.end_job(working.FAILED, Failure("the port was closed; the rest was not sent"))
        self._wire = self.unit = None
        self.jogging = False

    def _open(self, port: str) -> None:
        place = self._units.open() if port == virtual.NAME else port
        self._wire = HeardWire(
            open_transport(place, self._baud), self._baud, look=self._mind_halt,
            begins=self._begin, told=self._hear,
        )  # fmt: skip
        self.unit = Unit(Link(self._wire))
        self.looks, self.job = Looks(), None
        self.begin_way()

    def _begin(self, commands: tuple[str, ...]) -> None:
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

    def restart(self) -> None:
        """The unit has started anew: what it was told is gone."""
        if self._wire:
            self._wire.known = AFTER_RESET
        self.looks = Looks()
        self.jogging = False
        if self.job and self.job.is_open:
            self.end_job(working.FAILED, Failure("the unit has restarted; the job is gone"))
        self._board.change(restarted=True, known=self.known, wanted=None)

    def note(self, got: str | Failure, comes_back: bool = True) -> None:
        """Keep what says that there is no connection; a port that is lost is closed.

        A port that `comes_back` is opened again when it is there; virtual units need the user.
        """
        board = self._board
        if isinstance(got, str):
            board.change(error=None)
        elif isinstance(got, Restarted):
            self.restart()
        elif isinstance(got, PortError):
            self.close(abandons=True)
            is_virtual = board.state.virtual
            error = virtual.ended() if is_virtual and not isinstance(got, Fault) else got
            board.change(
                connected=False, version=None, reference=False, error=told(error),
                away=comes_back and not is_virtual, known=Known(), wanted=None,
            )  # fmt: skip
        elif isinstance(got, LineError):
            board.change(error=told(got), reference=False)
        elif not self.unit and not isinstance(got, NotConnected):
            board.change(connected=False, error=told(got))

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
