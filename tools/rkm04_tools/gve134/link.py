"""The host's end of the line: a command, its answer, and what is done where one gets lost.

One command is sent, then its answer is waited for. The rules of the unit are in
firmware/gve134/docs/line.md; how they are kept is told in tools/gve134_master/gve_master.h. No
command is executed twice, and none is sent again to a unit that has restarted. Whatever is raised,
the port is then given up so that nothing still waits in it to be sent (`close`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import TracebackType

from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.answers import Answer
from rkm04_tools.gve134.link_errors import (
    EndUnknown,
    GarbledAnswer,
    LineError,
    NoAnswer,
    NotConfirmed,
    OtherDevice,
    OutOfStep,
    Restarted,
    SumsOff,
)
from rkm04_tools.gve134.master import End, Kind, Master
from rkm04_tools.gve134.sums import Sums
from rkm04_tools.gve134.wire import Wire
from rkm04_tools.transport import open_transport

BAUD = 115_200
NS_PER_SECOND = 1_000_000_000
HALT_SECONDS = 30.0
OTHERS = {
    End.SUMS_OFF: "another program has switched its checksums off",
    End.OUT_OF_STEP: "whether it has restarted, or another program has switched its checksums off, "
    "is NOT KNOWN",
}
OTHER_CHARACTERS_MAX = 40


def open_link(port: str, baud: int = BAUD, sums: int = Sums.ON) -> Link:
    """Open a line: a serial device, a pty, or socket://HOST:PORT. Nothing is sent yet."""
    return Link(Wire(open_transport(port, baud), baud), sums)


class Link:
    """An open line with a unit. `sums`: one of Sums."""

    def __init__(self, wire: Wire, sums: int = Sums.ON) -> None:
        self.wire = wire
        self.name = wire.port.name
        self.sums = sums != Sums.NONE
        self._master = Master(wire.baud, sums)

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

    @property
    def version(self) -> str:
        """The unit's answer to ?."""
        return self._master.version

    @property
    def repairs(self) -> int:
        """The answers that got lost."""
        return self._master.repairs

    @property
    def restarted(self) -> bool:
        """Whether the unit was found to have started anew when it was connected to again."""
        return self._master.restarted

    @property
    def others(self) -> str:
        """What another program was found to have done when it was connected to again, in words."""
        return OTHERS.get(self._master.others, "")

    def ask(self, command: str) -> Answer:
        """Have a command executed once, and return the answer."""
        return self._answered(Kind.ASK, [command])

    def send_packet(self, commands: Sequence[str]) -> Answer:
        """Have a packet taken, or refused, once."""
        return self._answered(Kind.PACKET, commands)

    def try_packet(self, commands: Sequence[str]) -> Answer | None:
        """Send a packet once; None: it came damaged, and nothing of it was taken."""
        return self._done(Kind.PACKET_ONCE, commands)

    def ask_long(self, command: str, seconds: float) -> Answer:
        """Have a command executed once that is answered when the axes stand."""
        return self._answered(Kind.LONG, [command], seconds)

    def reset(self, address: str = answers.INTERPOLATOR) -> Answer:
        """Send J, and connect to the unit that then starts anew."""
        return self._answered(Kind.RESET, [f"!{address}J"])

    def connect(self) -> None:
        """Find out whether a unit is there, and how it stands with checksums and its index."""
        self._done(Kind.CONNECT, ["?"])

    def require_own(self) -> None:
        """Nothing is executed: OutOfStep if the unit has counted what was not sent from here."""
        self._done(Kind.OWN, ["@"])

    def halt(self, seconds: float = HALT_SECONDS, waits: Callable[[], None] = lambda: None) -> None:
        """Send H until it is answered, in whatever state the line is; then connect anew.

        `waits` is called once if there is no answer for longer than a usual stop takes.
        """
        self._done(Kind.HALT, ["H"], seconds, waits)

    def pause(self, seconds: float) -> None:
        """Wait; what comes meanwhile is no answer to anything."""
        clock = self.wire.clock
        end = clock() + seconds
        while (left := end - clock()) > 0:
            self._master.take(self.wire.read(left), self._now_ns)

    def _answered(self, kind: Kind, commands: Sequence[str], seconds: float = 0.0) -> Answer:
        answer = self._done(kind, commands, seconds)
        assert answer is not None
        return answer

    def _done(
        self,
        kind: Kind,
        commands: Sequence[str],
        seconds: float = 0.0,
        waits: Callable[[], None] = lambda: None,
    ) -> Answer | None:
        """What a request was answered; None: nothing of it was taken."""
        answer = None
        self.wire.begin(commands)
        try:
            self._master.ask(kind, commands, seconds, self._now_ns)
            end = self._end(waits)
            if end is End.ANSWERED:
                answer = answers.answer_of(*self._master.answer)
            elif end is not End.NOT_TAKEN:
                if end in OTHERS:
                    self.wire.lose()
                raise self._error(end, kind, commands, seconds)
        except BaseException:
            self._master.forget()
            raise
        finally:
            self.wire.end(commands, answer)
        if self._master.others is not End.WAITS and kind in (Kind.CONNECT, Kind.HALT):
            self.wire.lose()
        return answer

    def _end(self, waits: Callable[[], None]) -> End:
        """Write, hear and wait until the request has ended."""
        wire, master, told = self.wire, self._master, False
        while True:
            master.take(wire.read_waiting(), self._now_ns)
            end = master.poll(self._now_ns)
            if out := master.take_out():
                wire.write(out)
            if end is not End.WAITS:
                return end
            if master.long_halt and not told:
                told = True
                waits()
            left_ns = max(0, master.until_ns - self._now_ns)
            master.take(wire.read(left_ns / NS_PER_SECOND), self._now_ns)

    @property
    def _now_ns(self) -> int:
        return int(self.wire.clock() * NS_PER_SECOND)

    def _error(self, end: End, kind: Kind, commands: Sequence[str], seconds: float) -> LineError:
        where, baud = self.name, self.wire.baud
        if end is End.OTHER_DEVICE:
            other = self._master.other[:OTHER_CHARACTERS_MAX]
            shown = "".join(c if c.isprintable() else "?" for c in other)
            return OtherDevice(
                f"{where}: another device answers, {shown}; name the port of a GVE134"
            )
        if end is End.ECHOED:
            return NoAnswer(
                f"{where}: only what is sent comes back, no unit answers; "
                "are TX and RX connected to each other?"
            )
        if end is End.GARBLED:
            return GarbledAnswer(
                f"{where}: what comes back is damaged or not from a GVE134; check the rate "
                f"(--baud, it is {baud} Bd), the cable, and which device is at this port"
            )
        if end in (End.RESTARTED, End.RESTARTED_PERHAPS):
            return Restarted(where, executed=end is End.RESTARTED_PERHAPS)
        if end in OTHERS:
            return SumsOff(where) if end is End.SUMS_OFF else OutOfStep(where)
        if end is End.END_UNKNOWN:
            is_packet = kind in (Kind.PACKET, Kind.PACKET_ONCE)
            return EndUnknown(where, f"*E{len(commands)}" if is_packet else commands[0])
        if end is End.NOT_CONFIRMED and kind is Kind.HALT:
            return NotConfirmed(f"{where}: H has no answer in {seconds:.0f} s")
        if end is End.NOT_CONFIRMED:
            return NotConfirmed(
                f"{where}: no answer in {seconds:.0f} s, and it is NOT KNOWN whether the "
                "axes move; gve134 halt stops them"
            )
        return NoAnswer(
            f"{where}: the unit does not answer; check power, cable (TX and RX crossed) and rate "
            f"(--baud, it is {baud} Bd); a unit that waits for its axes (H, W) answers "
            "nothing but gve134 halt"
        )
