"""A line with its units, for scripts and for the commands.

    from rkm04_tools.line import open_line

    with open_line("COM5") as line:
        print(line.unit(3).motor(2).position())

Every call ends: with an answer, or with an error of `line_errors` that says what to do. A request
that gets no answer is repeated with the same number, so that the unit executes it once at most,
and a unit that has restarted refuses it (firmware/rkm04/docs/line.md). Calls from several
threads take turns.
"""

from __future__ import annotations

import random
import time
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, field
from threading import RLock
from types import TracebackType

from rkm04_tools import messages
from rkm04_tools.failure import Failure
from rkm04_tools.frame import ANSWER, BROADCAST, NODES, NUMBERS, REFUSED, Frame, Receiver
from rkm04_tools.line_errors import GarbledAnswer, LineError, NoAnswer, UnitRestarted
from rkm04_tools.messages import (
    ALL_MOTORS,
    ANSWER_BYTES_MAX,
    CHANGING,
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
from rkm04_tools.transport import Transport, open_transport, seconds_on_line

ATTEMPTS = 4
PATIENCE_SECONDS = 0.2
"""For an answer to begin: 20 ms are the unit's, the rest is for adapters and a busy computer."""
STORE_SECONDS = 2.5
SCAN_SECONDS = 0.045
SCAN_ATTEMPTS = 2
GAP_SECONDS = 0.1
"""Silence that ends an answer which has begun."""
BROADCAST_PAUSE_SECONDS = 0.005
ENVELOPE_BYTES = 12
STALE_BYTES_MAX = 65_536


@dataclass
class Heard:
    """What came back while an answer was waited for, and was none."""

    echoes: int = 0
    damaged: int = 0


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


USUAL = Wait()
STORING = Wait(STORE_SECONDS, 3)
SCANNING = Wait(SCAN_SECONDS, SCAN_ATTEMPTS)


def open_line(port: str) -> Line:
    """Open a line: a serial device, a pty, or socket://HOST:PORT."""
    return Line(open_transport(port))


@dataclass(eq=False)
class Line:
    """An open line. `echoes` tells whether its adapter hears what it sends, which does no harm.

    `sessions` counts those that were begun with each address.
    """

    transport: Transport
    echoes: bool = False
    sessions: Counter[int] = field(default_factory=Counter)
    _numbers: dict[int, int] = field(default_factory=dict)
    _twice: bool = False  # two answers have come to the last request
    _lock: RLock = field(default_factory=RLock)

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
        if node != BROADCAST and node not in NODES:
            raise Failure(f"node {node}: units have the addresses 1 to 16; 0 means all of them")
        return Unit(self, node)

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
        with self._lock:
            if node == BROADCAST:
                self._broadcast(message)
                return b""
            try:
                return self._in_session(node, message, wait)
            except UnitRestarted:
                if message[0] in CHANGING:
                    raise
                return self._in_session(node, message, wait)

    def request_at_once(self, node: int, message: bytes, wait: Wait = USUAL) -> bytes:
        """Send a request that may be executed twice, without the session that prevents it."""
        with self._lock:
            if node == BROADCAST:
                self._broadcast(message)
                return b""
            return self._exchange(Frame(node, 0, message), wait)

    def _in_session(self, node: int, message: bytes, wait: Wait) -> bytes:
        if node not in self._numbers:
            version = self._begin(node, wait)
            if message == bytes([VERSION]):
                return version
        return self._numbered(node, message, wait)

    def _begin(self, node: int, wait: Wait) -> bytes:
        """Send Version, with a random number and with the next.

        So the unit does not take what follows for a repeat of somebody else's. An answer to an
        older Version that is still under way can be taken for one of the two, never for both.
        """
        self._numbers[node] = random.choice(NUMBERS)
        self.sessions[node] += 1
        patience = Wait(min(wait.seconds, USUAL.seconds), wait.attempts)
        self._numbered(node, bytes([VERSION]), patience)
        return self._numbered(node, bytes([VERSION]), patience)

    def _numbered(self, node: int, message: bytes, wait: Wait) -> bytes:
        number = self._numbers[node] % NUMBERS[-1] + 1
        self._numbers[node] = number
        try:
            return self._exchange(Frame(node, number, message), wait)
        except BaseException:
            # It may be under way still: the next request begins a session of its own.
            del self._numbers[node]
            raise

    def _broadcast(self, message: bytes) -> None:
        data = Frame(BROADCAST, 0, message).encode()
        self.transport.write(data)
        time.sleep(seconds_on_line(len(data)) + BROADCAST_PAUSE_SECONDS)

    def _exchange(self, frame: Frame, wait: Wait) -> bytes:
        heard = Heard()
        for attempt in range(wait.attempts):
            answer = self._attempt(frame, wait.seconds, heard)
            if answer and answer.address & REFUSED:
                where = f"{self.transport.name}: unit {frame.node}"
                raise UnitRestarted(where, repeated=attempt > 0)
            if answer:
                return answer.message
        raise self._unanswered(frame.node, heard)

    def _attempt(self, frame: Frame, patience_seconds: float, heard: Heard) -> Frame | None:
        """Send a request once and wait for its answer; nothing prolongs that past `last`."""
        self._drop_stale()
        data = frame.encode()
        self.transport.write(data)
        until = time.monotonic() + seconds_on_line(len(data)) + patience_seconds
        answer_bytes = 2 * (ANSWER_BYTES_MAX.get(frame.message[0], 4) + ENVELOPE_BYTES)
        last = until + seconds_on_line(answer_bytes) + GAP_SECONDS
        receiver = Receiver()
        while (left := until - time.monotonic()) > 0:
            came = self.transport.read(left)
            got = list(receiver.feed(came))
            self._note(got, frame, heard)
            answers = [each for each in got if _answers(each, frame)]
            if answers:
                self._twice = len(answers) > 1
                return answers[0]
            if came:
                until = min(last, max(until, time.monotonic() + GAP_SECONDS))
        heard.damaged += receiver.dropped.total() + receiver.is_inside
        return None

    def _drop_stale(self) -> None:
        """Forget what came when nobody asked, such as an answer that was too late."""
        dropped = 0
        while dropped < STALE_BYTES_MAX and (stale := self.transport.read(0)):
            dropped += len(stale)

    def _note(self, got: Collection[Frame], sent: Frame, heard: Heard) -> None:
        if sent in got:
            heard.echoes += 1
            self.echoes = True

    def _unanswered(self, node: int, heard: Heard) -> LineError:
        where = f"{self.transport.name}: "
        if heard.damaged:
            return GarbledAnswer(
                f"{where}what comes back from unit {node} is damaged; do two units have this "
                "address (switch S1), are A and B swapped, is the line terminated?"
            )
        if heard.echoes:
            return NoAnswer(
                f"{where}unit {node} does not answer, only the adapter's echo comes back; "
                "check power, wiring (A, B) and address (switch S1); rkm04 scan shows who is there"
            )
        return NoAnswer(
            f"{where}unit {node} does not answer; "
            "check power, wiring (A, B) and address (switch S1); rkm04 scan shows who is there"
        )

    def _look_for(self, node: int) -> Found | None:
        with self._lock:
            self._numbers.pop(node, None)
            try:
                answer = self.request(node, bytes([VERSION]), SCANNING)
            except GarbledAnswer:
                return Found(node, None, "damaged answers: two units with this address?")
            except NoAnswer:
                return None
            again = self.transport.read(SCAN_SECONDS)
            twice = self._twice or any(_is_version_of(f, node) for f in Receiver().feed(again))
        remark = "answers twice: two units with this address?" if twice else ""
        return Found(node, messages.parse_version(answer), remark)


def _answers(got: Frame, sent: Frame) -> bool:
    """Whether a frame is the answer to a request, or says that it is refused."""
    if got.number != sent.number:
        return False
    if got.address == sent.address | ANSWER | REFUSED:
        return True
    expected = (sent.message[0], messages.UNKNOWN)
    return got.address == sent.address | ANSWER and got.message[0] in expected


def _is_version_of(frame: Frame, node: int) -> bool:
    return frame.address == node | ANSWER and frame.message[0] == VERSION


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
        # A second K does nothing, so this need not wait for a session to begin.
        message = messages.request(SET_COMMAND, self.number, b"K")
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
