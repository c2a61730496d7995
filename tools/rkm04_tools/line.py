"""A line with its units, for scripts and for the commands.

    from rkm04_tools.line import open_line

    with open_line("COM5") as line:
        print(line.unit(3).motor(2).position())

Every call ends: with an answer, or with an error of `line_errors` that says what to do. A request
that gets no answer is repeated with the same number, so that the unit executes it once at most,
and a unit that has restarted refuses it (firmware/rkm04/docs/line.md): that is the work of the
master, in C (tools/master). Calls from several threads take turns.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from threading import RLock
from types import TracebackType

from rkm04_tools import messages
from rkm04_tools.failure import Failure
from rkm04_tools.frame import BROADCAST, NODES
from rkm04_tools.line_errors import GarbledAnswer, LineError, NoAnswer, UnitRestarted
from rkm04_tools.line_master import REQUEST_BYTES_MAX, End, Master
from rkm04_tools.messages import (
    ALL_MOTORS,
    GET_COMMAND,
    GET_POSITION,
    GET_PROGRESS,
    GET_STATUS,
    GET_TABLE,
    MOTORS,
    SET_COMMAND,
    STORE_FLASH,
    VERSION,
    BreakPoint,
    Progress,
    Version,
)
from rkm04_tools.sending import Sent, Tell, check_program, send_program, silent
from rkm04_tools.status import Status, parse_status
from rkm04_tools.transport import BAUD, Transport, open_transport

ATTEMPTS = 4
PATIENCE_SECONDS = 0.2
"""For an answer to begin: 20 ms are the unit's, the rest is for adapters and a busy computer."""
STORE_SECONDS = 2.5
SCAN_SECONDS = 0.045
SCAN_ATTEMPTS = 2
STALE_BYTES_MAX = 65_536
BROADCAST_STOPS = 3


@dataclass(frozen=True)
class Found:
    """What one address of a line has answered; `version` is None if no answer was whole."""

    node: int
    version: Version | None
    remark: str = ""


@dataclass(frozen=True)
class Wait:
    """How long and how often an answer is waited for."""

    seconds: float = PATIENCE_SECONDS
    attempts: int = ATTEMPTS

    @property
    def ms(self) -> int:
        """The seconds in ms."""
        return round(self.seconds * 1000)


USUAL = Wait()
STORING = Wait(STORE_SECONDS, 3)
SCANNING = Wait(SCAN_SECONDS, SCAN_ATTEMPTS)


def open_line(port: str) -> Line:
    """Open a line: a serial device, a pty, or socket://HOST:PORT."""
    return Line(open_transport(port))


@dataclass(eq=False)
class Line:
    """An open line. `echoes` tells whether its adapter hears what it sends, which does no harm.

    `sessions` counts those that were begun with each address. `clock` tells ns.
    """

    transport: Transport
    echoes: bool = False
    sessions: Counter[int] = field(default_factory=Counter)
    clock: Callable[[], int] = time.perf_counter_ns
    _master: Master = field(default_factory=lambda: Master(BAUD, USUAL.ms))
    _lock: RLock = field(default_factory=RLock)
    _kept: dict[int, int | None] = field(default_factory=dict)

    def __enter__(self) -> Line:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the port."""
        self.transport.close()

    def unit(self, node: int) -> Unit:
        """The unit with an address, 1 to 16; 0 means all of them, and none answers."""
        _require_node(node)
        return Unit(self, node)

    @contextmanager
    def one_session(self, node: int) -> Iterator[None]:
        """Inside, a unit that has restarted since its first answer is told, whatever is asked.

        Else a question begins a new session unseen, and what comes after it goes to a unit that
        runs what it has stored. After an error nothing is known, and nothing told.
        """
        outer = node in self._kept
        self._kept.setdefault(node, None)
        try:
            yield
        finally:
            if not outer:
                self._kept.pop(node, None)

    def scan(self, nodes: Collection[int] = NODES, tell: Tell = silent) -> list[Found]:
        """Ask addresses for their version; silent ones are left out."""
        found = []
        for done, node in enumerate(nodes):
            tell(done, len(nodes))
            answer = self._look_for(node)
            if answer:
                found.append(answer)
        tell(len(nodes), len(nodes))
        return found

    def request(self, node: int, message: bytes, wait: Wait = USUAL) -> bytes:
        """Send a request and return the answer; of all units (node 0) it is empty.

        A session is begun where there is none. A unit that has restarted is asked again in a new
        one; what changes something is not sent again, UnitRestarted is raised instead.
        """
        return self._ask(node, message, wait, in_session=True)

    def request_at_once(self, node: int, message: bytes, wait: Wait = USUAL) -> bytes:
        """Send a request that may be executed twice, without the session that prevents it."""
        return self._ask(node, message, wait, in_session=False)

    def _ask(self, node: int, message: bytes, wait: Wait, in_session: bool) -> bytes:
        _require_node(node)
        if not 0 < len(message) <= REQUEST_BYTES_MAX:
            raise Failure(f"a message has 1 to {REQUEST_BYTES_MAX} bytes, not {len(message)}")
        with self._lock:
            self._master.ask(node, in_session, message, wait.ms, wait.attempts, self.clock())
            self._finish(node, in_session)
            return self._master.answer()

    def _finish(self, node: int, in_session: bool) -> None:
        """Wait for the end of what the master has begun."""
        try:
            while (end := self._go_on()) is End.WAITS:
                pass
        except BaseException:
            if in_session:
                # It may be under way still: the next request begins a session of its own.
                self._master.forget(node)
            self._keep_nothing(node)
            raise
        finally:
            self.sessions[node] = self._master.sessions(node)
            self.echoes = self._master.echoes()
        if end is not End.ANSWERED:
            self._keep_nothing(node)
            raise self._failed(node, end)
        if in_session and node in self._kept:
            self._require_kept(node)

    def _keep_nothing(self, node: int) -> None:
        if node in self._kept:
            self._kept[node] = None

    def _require_kept(self, node: int) -> None:
        kept, now = self._kept[node], self.sessions[node]
        self._kept[node] = now
        if kept not in (None, now):
            raise UnitRestarted(f"{self.transport.name}: unit {node}", repeated=True)

    def _go_on(self) -> End:
        if out := self._master.take_out():
            self._drop_stale()
            self.transport.write(out)
        came = self.transport.read(max(0, self._master.until_ns - self.clock()) / 1e9)
        self._master.take(came, self.clock())
        return self._master.poll(self.clock())

    def _drop_stale(self) -> None:
        """Forget what came when nobody asked, such as an answer that was too late."""
        dropped = 0
        while dropped < STALE_BYTES_MAX and (stale := self.transport.read(0)):
            dropped += len(stale)

    def _failed(self, node: int, end: End) -> LineError:
        where = f"{self.transport.name}: "
        if end in (End.RESTARTED, End.RESTARTED_SENT):
            return UnitRestarted(f"{where}unit {node}", repeated=end is End.RESTARTED_SENT)
        if end is End.DAMAGED:
            return GarbledAnswer(
                f"{where}what comes back from unit {node} is damaged; do two units have this "
                "address (switch S1), are A and B swapped, is the line terminated?"
            )
        echo = ", only the adapter's echo comes back" if end is End.ECHOED else ""
        return NoAnswer(
            f"{where}unit {node} does not answer{echo}; "
            "check power, wiring (A, B) and address (switch S1); rkm04 scan shows who is there"
        )

    def _look_for(self, node: int) -> Found | None:
        assert node in NODES
        with self._lock:
            self._master.scan(node, SCANNING.ms, SCANNING.attempts, self.clock())
            try:
                self._finish(node, in_session=True)
            except GarbledAnswer:
                return Found(node, None, "damaged answers: two units with this address?")
            except NoAnswer:
                return None
            answer, twice = self._master.answer(), self._master.twice()
        remark = "answers twice: two units with this address?" if twice else ""
        return Found(node, messages.parse_version(answer), remark)


def _require_node(node: int) -> None:
    if node != BROADCAST and node not in NODES:
        raise Failure(f"node {node}: units have the addresses 1 to 16; 0 means all of them")


@dataclass(frozen=True)
class Unit:
    """A unit of a line; of node 0, all of them: they execute, and none answers."""

    line: Line
    node: int

    def motor(self, number: int) -> Motor:
        """A motor, 1 to 4; 0 means all four."""
        if number != ALL_MOTORS and number not in MOTORS:
            raise Failure(f"motor {number}: a unit has the motors 1 to 4; 0 means all of them")
        return Motor(self, number)

    def begin(self) -> None:
        """See that it is there, before something is sent that is in doubt without an answer."""
        self.ask(bytes([VERSION]))

    def version(self) -> Version:
        """Version and date of the software."""
        return messages.parse_version(self.ask(bytes([VERSION])))

    def positions(self) -> list[int]:
        """The positions of motors 1 to 4."""
        answer = self.ask(messages.request(GET_POSITION, ALL_MOTORS))
        return messages.parse_positions(answer, ALL_MOTORS)

    def status(self) -> Status:
        """Inputs, outputs, motors and counters; UnknownMessage if it is not this firmware."""
        return parse_status(self.ask(bytes([GET_STATUS])))

    def ask(self, message: bytes, wait: Wait = USUAL) -> bytes:
        """Send any request that needs an answer, and return it."""
        if self.node == BROADCAST:
            raise Failure("node 0 means all units, and none of them answers; name one, 1 to 16")
        return self.line.request(self.node, message, wait)


@dataclass(frozen=True)
class Motor:
    """A motor of a unit; number 0 means all four."""

    unit: Unit
    number: int

    def position(self) -> int:
        """The absolute position."""
        (position,) = messages.parse_positions(self._ask(GET_POSITION), self.number)
        return position

    def program(self) -> str:
        """The program in the memory, in canonical form."""
        return messages.parse_program(self._ask(GET_COMMAND), self.number)

    def table(self) -> tuple[BreakPoint, ...]:
        """The break points of the move in progress; none when the motor stands."""
        return messages.parse_table(self._ask(GET_TABLE), self.number)

    def progress(self) -> Progress:
        """Steps made in the move in progress, and the command that is being run."""
        return messages.parse_progress(self._ask(GET_PROGRESS), self.number)

    def send(self, text: str, tell: Tell = silent) -> Sent:
        """Check a program and send it, in as many messages as it needs."""
        return send_program(self, check_program(text), tell)

    def store(self) -> None:
        """Keep the program without power."""
        message = messages.request(STORE_FLASH, self.number)
        answer = self.unit.line.request(self.unit.node, message, STORING)
        if answer:
            messages.parse_store(answer, self.number)

    def command(self, text: str) -> bool:
        """Send a text as one message, as it is; true: the program memory has overflowed."""
        message = messages.request(SET_COMMAND, self.number, text.encode("latin-1"))
        answer = self.unit.line.request(self.unit.node, message)
        return bool(answer) and messages.parse_set_command(answer, self.number)

    def stop(self) -> None:
        """Stop down the ramp, and the program with it."""
        # A second K does nothing, so this need not wait for a session to begin, and where no unit
        # answers it goes out several times.
        message = messages.request(SET_COMMAND, self.number, b"K")
        for _ in range(BROADCAST_STOPS if self.unit.node == BROADCAST else 1):
            answer = self.unit.line.request_at_once(self.unit.node, message)
        if answer:
            messages.parse_set_command(answer, self.number)

    def resume(self) -> None:
        """Go on where `stop` has stopped."""
        self.command("C75")

    def reset(self) -> None:
        """Stop, and forget the program."""
        self.command("\\")

    def set_speed(self, steps_per_s: int) -> None:
        """Change the speed of the move in progress; of a motor at rest, that of its next moves."""
        self.command(f"V{steps_per_s}")

    def _ask(self, message: int) -> bytes:
        if self.number == ALL_MOTORS:
            raise Failure("this asks one motor; name one, 1 to 4")
        return self.unit.ask(messages.request(message, self.number))
