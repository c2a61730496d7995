"""A vector file on its way to the unit: in order, in packets where it can be, with its room.

Runs of C and B go in packets. A packet that finds no room, or comes damaged, costs its time on the
line, so it is halved, and the next ones grow again: while the queue has little room they are small,
and the unit does not run dry while a large one is sent in vain. None takes longer on the line than
H may have to wait. A packet that the file itself has (*S to *E) is sent as it stands.

What is refused ends the job, and so does an interrupt: INTA that no command of the file has
brought about. What a line asks of the host (`gcode.directives`) is done when its turn comes.

`tell` is called between commands and while something is waited for. What it raises ends `send` or
`finish`, and another call goes on where that one was. So it is with an interrupt, and with a sleep
of the computer, after which the axes are halted.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.answers import SWITCH_NOT_FOUND, Answer, encoded
from rkm04_tools.gve134.executed import Executed
from rkm04_tools.gve134.gcode.directives import Pause, Probe, Wait
from rkm04_tools.gve134.job import Asked, Command, Job
from rkm04_tools.gve134.known import Known
from rkm04_tools.gve134.link_errors import Refused
from rkm04_tools.gve134.probing import BEFORE, HALTED, UNTOUCHED, WORDS
from rkm04_tools.gve134.state import INTA, INTCOM, RUN, Flags, Positions, named, positions_text
from rkm04_tools.gve134.unit import POLL_SECONDS, Unit
from rkm04_tools.transport import BITS_PER_BYTE

PACKET_COMMANDS_MAX = 64
PACKET_COMMANDS_FIRST = 32
PACKET_COMMANDS_MIN = 8
PACKET_GROWTH = 2
PACKET_SECONDS = 0.15
"""What H may have to wait for: a packet on the line."""
PACKET_BYTES_MIN = 300
NO_ROOM_SECONDS = 0.01
WAITS_MAX = 3
"""What is refused so often while nothing moves is refused for good."""
LONG_SECONDS = 86_400.0
BEGINS_ANEW = ("D", "G", "J", "H", "R")
"""What may stand first in a file for a unit that was interrupted."""
ENDS_MOTION = ("J", "H")
"""What may stand first in a file for a unit that moves."""

SPINDLE_SET = re.compile(r"!7V(\d+)")

Tell = Callable[[int], None]


class Interrupted(Failure):
    """The unit has stopped the axes by itself. `left`: how they stand then."""

    def __init__(self, message: str, causes: list[str], left: tuple[Flags, Positions]) -> None:
        super().__init__(message, NOT_SO)
        self.causes = causes
        self.left = left


@dataclass
class Sender:
    """Sends a job. `sent` counts its vectors that the unit has taken, `lines` its commands."""

    unit: Unit
    job: Job
    tell: Tell = lambda sent: None
    sent: int = 0
    lines: int = 0
    packets: int = 0
    size: int = PACKET_COMMANDS_FIRST
    inta: bool = False
    spindle: int | None = None
    """In 0.1 %, as the file has set it last; None: not known."""
    ask_person: Callable[[str], None] = lambda text: None
    executed: Executed | None = None
    known: Known = field(default_factory=Known)
    """What is known of the unit because of this job; its spindle is in `spindle`."""
    _under_way: list[Command] = field(default_factory=list)
    _waits: int = 0
    _is_lost: bool = False
    _probes_from: Positions | None = None
    _probed: tuple[int, ...] = (0, 0, 0, 0)
    """The vector that probes."""
    _commands: Iterator[Command] | None = None
    _pending: deque[Command] = field(default_factory=deque)
    _begun: list[Command] = field(default_factory=list)
    """Commands that are not pending any more, and not known to have been executed."""

    def send(self) -> None:
        """Send all of it; return when the unit has taken the last command."""
        if self._commands is None:
            self._commands = self._begin()
        self._pending.extendleft(reversed(self._begun))
        self._begun.clear()
        self.unit.link.wire.take_slept()
        while True:
            count = self._fill()
            if count > 1:
                self._send_run(count)
            elif self._ahead(0):
                self._send_single(self._take())
            else:
                return
            self._between()

    def _between(self) -> None:
        """After a sleep nothing goes on by itself: beside the machine nobody expects that."""
        if slept := self.unit.link.wire.take_slept():
            self.unit.halt()
            raise self.interrupted(
                f"{self.job.source.name}: the computer or its program slept for {slept:.0f} s"
            )
        self.tell(self.sent)

    def _ahead(self, place: int) -> Command | None:
        """The command so many places ahead of the next one; None: there are not so many."""
        while len(self._pending) <= place:
            command = next(self._commands or iter(()), None)
            if command is None:
                return None
            self._pending.append(command)
        return self._pending[place]

    def _take(self) -> Command:
        """The next command, which is begun."""
        command = self._pending.popleft()
        self._begun.append(command)
        return command

    def _begin(self) -> Iterator[Command]:
        """Refuse to add to what moves or was interrupted, unless the file begins with its end."""
        flags = self.unit.flags()
        self.inta = flags.has(INTA)
        first = next(iter(self.job), None)
        if first is not None and first.letter not in ENDS_MOTION:
            require_stands(flags)
        self.executed = Executed(self.unit.positions())
        if flags.bits & (INTA | RUN):
            self.executed.lose()
        if self.inta and first is not None and first.letter not in BEGINS_ANEW:
            raise Failure(f"the unit is {flags.text}; nothing was sent", NOT_SO)
        return iter(self.job)

    # ---- runs of C and B ----

    def _fill(self) -> int:
        """How many of the commands ahead make up the next packet."""
        room, count = self._bytes_max(), 0
        while count < self.size and (command := self._ahead(count)):
            room -= len(encoded(command.text, self.unit.link.sums))
            if not command.goes_in_packets or room < 0:
                break
            count += 1
        return count

    def _bytes_max(self) -> float:
        baud = self.unit.link.wire.baud
        return max(PACKET_BYTES_MIN, baud * PACKET_SECONDS / BITS_PER_BYTE)

    def _send_run(self, count: int) -> None:
        run = [self._pending[place] for place in range(count)]
        insists = count <= PACKET_COMMANDS_MIN
        answer = self._packet(run) if insists else self._try_packet(run)
        if answer is None:
            self.size = max(PACKET_COMMANDS_MIN, count // 2)
            return
        if answer.code == answers.DONE:
            self._taken(run)
        try:
            self._judge(run[0], answer)
        finally:
            if answer.code == answers.DONE:
                for _ in run:
                    self._pending.popleft()
        if answer.code == answers.NO_ROOM:
            if self.size == PACKET_COMMANDS_MIN:
                self._wait_for_room(run[0])
            self.size = max(PACKET_COMMANDS_MIN, self.size // 2)
            return
        self.size = min(PACKET_COMMANDS_MAX, self.size + PACKET_GROWTH)

    def _try_packet(self, run: list[Command]) -> Answer | None:
        """Send a packet; None: it came damaged, and is better sent in parts."""
        return self.unit.link.try_packet(self._texts(run))

    def _packet(self, run: list[Command]) -> Answer:
        return self.unit.link.send_packet(self._texts(run))

    def _texts(self, run: list[Command]) -> list[str]:
        self.packets += 1
        self._under_way = run
        return [command.text for command in run]

    # ---- all else ----

    def _send_single(self, command: Command) -> None:
        whole = [command]
        if command.asked_of_host is not None:
            self._obey(command, command.asked_of_host)
            self._begun.clear()
            return
        if command.text == "*S":
            whole, end = self._packet_of_file()
            command = end or command
        self._probes_from = None
        if command.letter == "L" and self._is_probe_next():
            self._wait_until_stands()
            self._probes_from = self.unit.positions()
            self._probed = command.steps
        while True:
            answer = self._packet(whole) if command.text == "*S" else self._ask(command)
            is_cut_off = command.letter == "W" and answer.inta
            if answer.code == answers.DONE and not is_cut_off:
                self._taken(whole)
            self._judge(command, answer)
            if answer.code == answers.NO_ROOM:
                self._wait_for_room(command)
            elif answer.code == answers.NOT_WHILE_MOVING:
                self._wait_for_rest(command, answer)
            else:
                break

    def _packet_of_file(self) -> tuple[list[Command], Command | None]:
        """The commands after *S up to *E; or what ends the packet before that, H or J, twice."""
        whole: list[Command] = []
        while self._ahead(0):
            each = self._take()
            if each.text.startswith("*E"):
                break
            if each.goes_in_packets:
                whole.append(each)
            elif each.text == "*S":
                whole = []
            else:
                return [each], each
        return whole, None

    def _ask(self, command: Command) -> Answer:
        self._under_way = [command]
        if command.letter == "W":
            return self.unit.link.ask_long(command.text, LONG_SECONDS)
        if command.text == "H":
            self.unit.halt().require_known(self.unit.link.name)
            self.inta = True
            return Answer(answers.DONE, inta=True)
        if command.text in ("J", "!7J"):
            self.inta = False
            return self.unit.link.reset(answers.addressed(command.text)[0])
        return self.unit.link.ask(command.text)

    def _obey(self, command: Command, asked: Asked) -> None:
        """Do what a line asks of the host."""
        if isinstance(asked, Wait):
            self._dwell(asked.seconds)
            self.unit.link.require_own()
        elif isinstance(asked, Pause):
            self._wait_until_stands()
            self.ask_person(asked.text)
            self.unit.link.wire.take_slept()
            self.unit.link.require_own()
        else:
            self._go_back(command)

    def _dwell(self, seconds: float) -> None:
        clock = self.unit.link.wire.clock
        end = clock() + seconds
        while (left := end - clock()) > 0:
            self.unit.link.pause(min(left, POLL_SECONDS))
            self._between()

    def _wait_until_stands(self) -> Flags:
        return self.unit.wait_until_stands(self._between)

    def _go_back(self, command: Command) -> None:
        """Bring the axes back to where the sensor was touched."""
        unit = self.unit
        flags = self._wait_until_stands()
        if not flags.has(INTA) or flags.has(INTCOM):
            raise self._unprobed(command, HALTED if flags.has(INTCOM) else UNTOUCHED, flags)
        touched, stand = unit.positions(latched=True), unit.positions()
        if int(unit.order("SR4").values, 16):
            raise self.interrupted(self._where(command))
        if touched == self._probes_from:
            raise self._unprobed(command, BEFORE, flags)
        unit.order("SW1,00")
        unit.order("D")
        self.inta = False
        way = (
            at - now if step else 0  # a coupled A goes along by itself
            for at, now, step in zip(touched, stand, self._probed, strict=True)
        )
        unit.order(f"L{','.join(map(str, way))}")
        if unit.wait_until_stands().has(INTA):
            raise self.interrupted(self._where(command))
        if self.executed is not None:
            self.executed.stood(unit.positions())

    def _unprobed(self, command: Command, reason: str, flags: Flags) -> Failure:
        self.unit.order("SW1,00")  # the sensor is not to stop what comes later
        at = positions_text(self.unit.positions())
        text = f"{WORDS[reason]}; the axes stand at {at}; the unit is {flags.text}"
        return Failure(f"{self._where(command)}: {text}", NOT_SO)

    @property
    def sent_text(self) -> str:
        """How many vectors were sent; to how many, where the answer to the last has not come."""
        doubtful = sum(command.is_vector for command in self._under_way)
        return f"{self.sent} to {self.sent + doubtful}" if doubtful else str(self.sent)

    @property
    def spindle_text(self) -> str:
        """Whether the spindle turns, as the file has set it: the unit cannot be asked."""
        if self._is_lost:
            return "whether the spindle turns is NOT KNOWN: another program has used this line"
        if self.spindle is None:
            return "whether the spindle turns is NOT KNOWN: this file has not set it"
        if self.spindle == 0:
            return "the spindle is off"
        return f"THE SPINDLE TURNS at {self.spindle / 10:g} %, gve134 spindle 0 stops it"

    def lose(self) -> None:
        """Another program has used the line: nothing is known of the unit any more."""
        self._is_lost = True
        self.spindle, self.known = None, Known()
        if self.executed is not None:
            self.executed.lose()

    def _note_spindle(self, text: str) -> None:
        if match := SPINDLE_SET.fullmatch(text):
            self.spindle = int(match[1])
        elif text in ("J", "!7J"):
            self.spindle = 0
        elif text.startswith("O0"):
            self.spindle = None

    def _taken(self, commands: list[Command]) -> None:
        for command in commands:
            self._note_spindle(command.text)
            self.known = self.known.after(command.text)
        self._begun.clear()
        self._waits = 0
        self.lines += len(commands)
        self.sent += sum(command.is_vector for command in commands)
        self._under_way = []
        if self.executed is None:
            return
        if any(
            command.letter == "W" for command in commands
        ):  # has been answered, so the axes stand
            self.executed.stood(self.unit.positions())
        else:
            self.executed.taken(commands)

    # ---- what has been executed ----

    def look(self, positions: Positions | None = None) -> int | None:
        """How many vectors are over, by where the axes are; None: it is not known."""
        if self.executed is None or self.executed.done is None:
            return None
        return self.executed.look(positions or self.unit.positions(), self._under_way)

    def executed_text(self, positions: Positions) -> str:
        """How many vectors are over, in words."""
        done = self.look(positions)
        how_many = "it is not known how many" if done is None else str(done)
        return f"{how_many} of {self.job.vectors} vectors were executed"

    # ---- answers ----

    def _judge(self, command: Command, answer: Answer) -> None:
        """Notice an interrupt, and what the unit refuses for good."""
        is_new = answer.inta and not self.inta
        if is_new and answer.code == answers.DONE and self._is_probe_next():
            return
        if is_new and command.letter == "W" and answer.code == answers.BOUNDS:
            self.unit.wait_until_stands()
            at = f"the axes stand at {positions_text(self.unit.positions())}"
            raise Refused(self._where(command), answer, f"{SWITCH_NOT_FOUND}; {at}")
        if is_new and not (command.letter == "R" or command.text.startswith("SW6")):
            raise self.interrupted(self._where(command))
        self.inta = answer.inta
        waits = answer.code in (answers.NO_ROOM, answers.NOT_WHILE_MOVING) and not answer.inta
        if waits:
            self._under_way = []
        if answer.code != answers.DONE and not waits:
            raise self._refused(command, answer)

    def _is_probe_next(self) -> bool:
        following = self._ahead(0)
        return following is not None and isinstance(following.asked_of_host, Probe)

    def _refused(self, command: Command, answer: Answer) -> Failure:
        after = f"; the {self.sent} vectors before it are executed" if self.sent else ""
        return Refused(self._where(command), answer, f"refused: {answer.words}{after}")

    def _where(self, command: Command) -> str:
        return f"{self.job.source.name}:{command.line}: {command.text}"

    def finish(self) -> Flags:
        """Wait until the axes stand."""
        flags = self._wait_until_stands()
        if flags.has(INTA) and not self.inta:
            raise self.interrupted(self.job.source.name)
        if self.executed is not None and not flags.has(RUN | INTA):
            self.executed.stood(self.unit.positions())
        return flags

    def interrupted(self, where: str) -> Failure:
        """What has stopped the axes, and where they stand."""
        flags = self.unit.wait_until_stands()
        causes = causes_of(self.unit, flags)
        by_input = causes and not flags.has(INTCOM)  # H leaves PL as it was
        latched = self.unit.link.ask("PL").values if by_input else ""
        at = f", positions at that moment {latched}" if latched else ""
        text = f"INTERRUPTED by {', '.join(causes) or 'what the unit does not tell'}{at}; the axes "
        positions = self.unit.positions()
        text += f"stand at {positions_text(positions)}; {flags.text}; "
        text += f"{self.executed_text(positions)}, {self.sent} were sent"
        return Interrupted(f"{where}: {text}", causes, (flags, positions))

    def _wait_for_room(self, command: Command) -> None:
        """Wait a little; where nothing moves there will never be room."""
        self._between()
        self.unit.link.pause(NO_ROOM_SECONDS)
        if not self.unit.flags().has(RUN):
            self._waits += 1
        if self._waits > WAITS_MAX:
            raise Failure(
                f"{self._where(command)}: no room, though nothing moves: after K there is room "
                "for one L at a time and for no C",
                NOT_SO,
            )

    def _wait_for_rest(self, command: Command, answer: Answer) -> None:
        """Wait until nothing moves; what is refused then is refused for good."""
        flags = self._wait_until_stands()
        if flags.has(INTA):
            raise self.interrupted(self._where(command))
        self._waits += 1
        if self._waits > WAITS_MAX:
            raise self._refused(command, answer)


def require_stands(flags: Flags) -> None:
    """Refuse a file for a unit that still makes another one's vectors: it would join them."""
    if not flags.stands:
        raise Failure(
            f"the unit is {flags.text}; nothing was sent; wait until the axes stand (gve134 watch),"
            " or halt them (gve134 halt)",
            NOT_SO,
        )


def causes_of(unit: Unit, flags: Flags) -> list[str]:
    """The names of what has stopped the axes."""
    low, high = (int(unit.order(f"SR{n}").values, 16) for n in (4, 5))
    causes = named(low, high)
    if flags.has(INTCOM):
        causes.append("H")
    return causes
