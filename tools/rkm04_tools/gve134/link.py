"""The host's end of the line: a command, its answer, and what is done where one gets lost.

One command is sent, then its answer is waited for. The rules of the unit are in
firmware/gve134/docs/line.md; this is the state machine that they call for:

    UNKNOWN  nothing is known of the unit: at the start, and after every error that was raised.
             The next command connects first: checksums are switched on (%+, asked for in a way
             that both a unit with and without them answers), ? tells that it is a GVE134, @ how
             many commands it has counted. Then READY.
    READY    a command goes out: WAITING.
    WAITING  an answer that can be one to this command, with a right checksum: READY. Code 2, a
             damaged answer, or none in time: DOUBT. What cannot be an answer to it is skipped: it
             belongs to a command that was given up.
    DOUBT    > is asked for the last answer, then @ until enough answers in succession agree: those
             before could be late ones to the command itself. The unit has counted
               none of the command: it was not executed; it is sent again, WAITING;
               all of it: > has told how it ended, READY;
               a part of a packet: a packet is taken whole or not at all, so it was not; sent again;
               anything else: OutOfStep, UNKNOWN.
             An answer without a checksum is that of a unit which has restarted: @ without a
             checksum proves it, here and when connecting, Restarted, UNKNOWN. After too many
             attempts NoAnswer, UNKNOWN.

> comes first, as a unit that gets a damaged @ answers code 2, which > repeats from then on; where
that has happened it is EndUnknown, UNKNOWN.

So no command is executed twice, and none is sent again to a unit that has restarted. Whatever is
raised, the port is then given up so that nothing still waits in it to be sent (`close`).

The unit throws away what comes after damage until 100 ms pass in silence, and takes a packet that
was cut off for over after 1 s: every time-out here is longer than the first, and those after the
first attempt are longer than the second.

H has a way of its own (`halt`): it is repeated, which does no harm, with and without a checksum.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from types import TracebackType

from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.answers import Answer, encoded, parsed
from rkm04_tools.gve134.link_errors import (
    EndUnknown,
    GarbledAnswer,
    LineError,
    NoAnswer,
    NotConfirmed,
    OtherDevice,
    OutOfStep,
    Restarted,
)
from rkm04_tools.gve134.wire import (
    BARE,
    PACKET_OVER_SECONDS,
    PATIENCE_SECONDS,
    Heard,
    Request,
    Wire,
)
from rkm04_tools.transport import open_transport

BAUD = 115_200
MEMORY_SECONDS = 2.5
RESET_SECONDS = 0.5
ATTEMPTS = 4
INDEX_ATTEMPTS = 8
CONNECT_PAUSE_SECONDS = (0.0, 0.2, PACKET_OVER_SECONDS, 0.2)
"""Before each attempt to connect; one of them is long enough for a packet that was cut off."""
LONG_ATTEMPTS = 20
INDEX_MODULUS = 256
HALT_SECONDS = 30.0
HALT_USUAL_SECONDS = 3.0
HALT_REPEAT_SECONDS = (0.3, 0.3, 0.5, 1.0, 2.0, 4.0)
HALTED = Answer(answers.DONE, inta=True)
NAME = "IP134"

INDEX = Request.of("@")
PATIENT_INDEX = Request.of("@", PACKET_OVER_SECONDS)
VERSION = Request(("?",), re.compile(f"{NAME}.*"), 1, PATIENCE_SECONDS)
NOTHING_OR_INDEX = re.compile(f"|{answers.ONE_NUMBER.pattern}")
BARE_INDEX = re.compile(r"[0-9A-F],\d{1,3}")


def open_link(port: str, baud: int = BAUD, sums: bool = True) -> Link:
    """Open a line: a serial device, a pty, or socket://HOST:PORT. Nothing is sent yet."""
    return Link(Wire(open_transport(port, baud), baud), sums)


class Link:
    """An open line with a unit.

    `sums`: whether checksums are wanted. `version` is the unit's answer to ?. `repairs` counts the
    answers that got lost. `restarted`: the unit was found to have started anew when it was
    connected to again.
    """

    def __init__(self, wire: Wire, sums: bool = True) -> None:
        self.wire = wire
        self.name = wire.port.name
        self.sums = sums
        self.version = ""
        self.repairs = 0
        self._ready = False
        self.restarted = False
        self._index = 0

    def __enter__(self) -> Link:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None:
            self.wire.port.close()
        else:
            self.wire.port.abandon()

    # ---- commands ----

    def ask(self, command: str, seconds: float = PATIENCE_SECONDS) -> Answer:
        """Have a command executed once, and return the answer."""
        return self._settle(Request.of(command, seconds))

    def send_packet(self, commands: Sequence[str]) -> Answer:
        """Have a packet taken, or refused, once."""
        return self._settle(Request.packet(commands))

    def try_packet(self, commands: Sequence[str]) -> Answer | None:
        """Send a packet once; None: it came damaged, and nothing of it was taken."""
        self._get_ready()
        with self._forgetting():
            return self._attempt(Request.packet(commands))

    def ask_long(self, command: str, seconds: float) -> Answer:
        """Have a command executed once that is answered when the axes stand.

        Until then the unit answers nothing. An @ after it tells a command that was lost from one
        that takes its time: it is answered at once, or after the command's own answer.
        """
        self._get_ready()
        request = Request.of(command)
        with self._forgetting():
            for _ in range(ATTEMPTS):
                answer = self.wire.exchange(request) or self._wait_long(seconds)
                if answer is not None and answer.code != answers.DAMAGED:
                    return self._counted(request, answer)
                answer = self._repair(request, was_refused=False)
                if answer is not None:
                    return answer
            raise self._unanswered(self.wire.heard)

    def reset(self, address: str = answers.INTERPOLATOR) -> Answer:
        """Send J, and connect to the unit that then starts anew."""
        answer = Answer(answers.DONE, inta=False)
        with suppress(Restarted):
            answer = self.ask(f"!{address}J")
        self.pause(RESET_SECONDS)
        self.connect()
        self.restarted = False
        return answer

    def pause(self, seconds: float) -> None:
        """Wait; what comes meanwhile is no answer to anything."""
        self.wire.wait(None, seconds)

    # ---- connecting ----

    def connect(self) -> None:
        """Find out whether a unit is there, and how it stands with checksums and its index."""
        self._ready = False
        self.restarted = False
        heard = Heard()
        for pause_seconds in CONNECT_PAUSE_SECONDS:
            self.pause(pause_seconds)
            if self._switch_sums() and self._ask_version():
                self._index = self._find_index()
                self._ready = True
                return
            heard.add(self.wire.heard)
        raise self._unanswered(heard)

    def _switch_sums(self) -> bool:
        """Bring checksums about, or do away with them, in whatever state they are."""
        done = self._switched(encoded("%+", sums=True), sums=True)
        if not done and self.wire.heard.bare:
            if self.sums and self.version:
                if not (self._has_no_sums() or self._has_no_sums()):  # one may get lost
                    return False
                self.restarted = True
            done = not self.sums or self._switched(encoded("%+", sums=False), sums=True)
        elif done and not self.sums:
            done = self._switched(encoded("%-", sums=True), sums=False)
        self.wire.sums = self.sums
        return done

    def _switched(self, data: bytes, sums: bool) -> bool:
        """Send, and hear whether it was done; its answer has a checksum or not."""
        self.wire.sums = sums
        self.wire.write(data)
        answer = self.wire.wait(answers.NO_VALUES, PATIENCE_SECONDS)
        return answer is not None and answer.code == answers.DONE

    def _ask_version(self) -> bool:
        answer = self.wire.exchange(VERSION) or self.wire.exchange(VERSION)
        self.version = answer.values if answer is not None else ""
        return bool(self.version)

    # ---- an answer, come what may ----

    def _settle(self, request: Request) -> Answer:
        self._get_ready()
        with self._forgetting():
            for _ in range(ATTEMPTS):
                if (answer := self._attempt(request)) is not None:
                    return answer
            raise self._unanswered(self.wire.heard)

    def _attempt(self, request: Request) -> Answer | None:
        """Send once; None: it was not executed."""
        answer = self.wire.exchange(request)
        if answer is not None and answer.code != answers.DAMAGED:
            return self._counted(request, answer)
        return self._repair(request, self.wire.heard.bare)

    def _counted(self, request: Request, answer: Answer) -> Answer:
        self._index = (self._index + request.counts) % INDEX_MODULUS
        return answer

    @contextmanager
    def _forgetting(self) -> Iterator[None]:
        """Whatever is raised inside leaves nothing known of the unit."""
        try:
            yield
        except BaseException:
            self._ready = False
            raise

    def _get_ready(self) -> None:
        """Connect if need be. What was asked for is not for a unit that has restarted since."""
        if not self._ready:
            self.connect()
            if self.restarted:
                raise Restarted(self.name, executed=False)

    def _repair(self, request: Request, was_refused: bool) -> Answer | None:
        """Find out what has become of a request; None: it was not executed.

        `was_refused`: it had an answer that only a unit gives which has restarted.
        """
        self.repairs += 1
        last = self._last_answer(request)
        index = self._find_index(2 if last else 3, may_be_executed=not was_refused)
        done = (index - self._index) % INDEX_MODULUS
        if done > request.counts:
            raise OutOfStep(self.name)
        self._index = index
        if done < request.counts or request.counts == 0:
            return None
        return self._executed(request, last)

    def _last_answer(self, request: Request) -> Answer | None:
        return self.wire.exchange(Request((">",), request.form, 0, PATIENCE_SECONDS))

    def _executed(self, request: Request, last: Answer | None) -> Answer | None:
        """The answer to what was executed; None: a packet that was not taken after all."""
        for _ in range(ATTEMPTS):
            if last is not None:
                break
            last = self._last_answer(request)
        if last is not None and last.code != answers.DAMAGED:
            return last
        if last is not None and len(request.commands) > 1 and last.values:
            return None
        raise EndUnknown(self.name, request.commands[-1])

    def _find_index(self, needed: int = 2, may_be_executed: bool = False) -> int:
        """Ask for the index until so many answers in succession agree.

        All but one of them could still be late answers to what was asked before.
        """
        index, agree = -1, 0
        for attempt in range(INDEX_ATTEMPTS):
            answer = self.wire.exchange(PATIENT_INDEX if attempt else INDEX)
            if answer is not None and answer.code == answers.DONE:
                agree = agree + 1 if answer.numbers[0] == index else 1
                index = answer.numbers[0]
                if agree == needed:
                    return index
            elif self.wire.heard.bare:
                self._refuse_restarted(may_be_executed)
        raise self._unanswered(self.wire.heard)

    def _refuse_restarted(self, may_be_executed: bool) -> None:
        if self._has_no_sums():
            self.version = ""  # so that connecting to it is no news any more
            raise Restarted(self.name, may_be_executed)

    def _has_no_sums(self) -> bool:
        """Ask without a checksum: only a unit without them, as after a restart, answers that."""
        self.wire.write(encoded("@", sums=False))
        until = self.wire.clock() + PATIENCE_SECONDS
        while (left := until - self.wire.clock()) > 0:
            for line in self.wire.lines(left):
                if BARE_INDEX.fullmatch(line) and parsed(line, sums=True) is None:
                    return True
        return False

    def _wait_long(self, seconds: float) -> Answer | None:
        """Wait for what ends when the axes stand; None: it has ended without an answer that can
        be read, or the unit never got it."""
        end = self.wire.clock() + seconds
        for asked in range(1, LONG_ATTEMPTS):
            self.wire.port.write(INDEX.encode(self.wire.sums))
            self.wire.heard = Heard()
            answer = self.wire.wait(NOTHING_OR_INDEX, end - self.wire.clock())
            if answer is not None:
                for _ in range(asked if not answer.values else 0):
                    self.wire.wait(answers.ONE_NUMBER, PATIENCE_SECONDS)
                return answer if not answer.values else None
            if self.wire.heard.bare:
                return None
            if not self.wire.heard.any:
                break
        raise NotConfirmed(
            f"{self.name}: no answer in {seconds:.0f} s, and it is NOT KNOWN whether the "
            "axes move; gve134 halt stops them"
        )

    # ---- halting ----

    def halt(self, seconds: float = HALT_SECONDS, waits: Callable[[], None] = lambda: None) -> None:
        """Send H until it is answered, in whatever state the line is; then connect anew.

        `waits` is called once if there is no answer for longer than a usual stop takes.
        """
        self._ready = False
        begun, sums, told, attempt = self.wire.clock(), True, False, 0
        while not self._halt_once(sums, HALT_REPEAT_SECONDS[attempt]):
            passed = self.wire.clock() - begun
            if passed > seconds:
                raise NotConfirmed(f"{self.name}: H has no answer in {seconds:.0f} s")
            if passed > HALT_USUAL_SECONDS and not told:
                told = True
                waits()
            sums = not sums
            attempt = min(attempt + 1, len(HALT_REPEAT_SECONDS) - 1)
        self.connect()

    def _halt_once(self, sums: bool, seconds: float) -> bool:
        """Whether H was answered, by one with or without a checksum: several may be under way."""
        self.wire.write(encoded("H", sums))
        until = self.wire.clock() + seconds
        while (left := until - self.wire.clock()) > 0:
            for line in self.wire.lines(left):
                if HALTED in (parsed(line, sums=True), parsed(line, sums=False)):
                    return True
                if sums and BARE.fullmatch(line):
                    return False
        return False

    def _unanswered(self, heard: Heard) -> LineError:
        where = self.name
        if heard.other and not self.version:
            shown = "".join(c if c.isprintable() else "?" for c in heard.other[:40])
            return OtherDevice(
                f"{where}: another device answers, {shown}; name the port of a GVE134"
            )
        if heard.echoes and not heard.damaged:
            return NoAnswer(
                f"{where}: only what is sent comes back, no unit answers; "
                "are TX and RX connected to each other?"
            )
        if heard.any:
            return GarbledAnswer(
                f"{where}: what comes back is damaged or not from a GVE134; check the rate "
                f"(--baud, it is {self.wire.baud} Bd), the cable, and which device is at this port"
            )
        return NoAnswer(
            f"{where}: the unit does not answer; check power, cable (TX and RX crossed) and rate "
            f"(--baud, it is {self.wire.baud} Bd); a unit that waits for its axes (H, W) answers "
            "nothing but gve134 halt"
        )
