"""The commands that move axes and stop them: halt, go, delete, home, jog, override."""

from __future__ import annotations

import re
import select
import sys
from argparse import Namespace
from dataclasses import dataclass
from types import SimpleNamespace

from rkm04_tools.client_base import tell
from rkm04_tools.failure import NO_CONNECTION, NOT_SO, Failure
from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.client_base import require_good, unit_of
from rkm04_tools.gve134.link_errors import Refused
from rkm04_tools.gve134.sending import causes_of
from rkm04_tools.gve134.state import AXES, INTA, RUN, Flags, Positions, positions_text
from rkm04_tools.gve134.stopping import (
    REST_MAY_WAIT,
    guarded_motion,
    halt_loudly,
    halted_text,
    spindle_after,
)
from rkm04_tools.gve134.unit import POLL_SECONDS, Unit
from rkm04_tools.stopper import ENDED_BEFORE, Stopper, shout

HOME_EXTRA_SECONDS = 10.0
POSITION_MAX = 2_147_483_647
SLOWEST_RAMP = 1000
"""Pulses/s², the least that A can be."""
WAY = re.compile(r"([XYZA])([-+]?)([0-9]{1,10})", re.IGNORECASE)
SPEED = re.compile(r"[0-9]+")
OVERRIDES = {"up": "XU", "down": "XD", "last": "XA"}


def run_halt(options: Namespace) -> int:
    """Stop the axes, and tell where they stand, and what the spindle does."""
    with Stopper(SimpleNamespace()) as stopper:
        try:
            with stopper.at_once(), unit_of(options, shared=True) as unit:
                halted = halt_loudly(unit)
        except KeyboardInterrupt:
            shout(ENDED_BEFORE)
            return NO_CONNECTION
    text = f"{halted_text(halted)}; {spindle_after(halted)}"
    return tell(options, _state(halted.flags, halted.positions), text)


def run_go(options: Namespace) -> int:
    """Let the vectors that wait go on; status 1 if they do not."""
    with unit_of(options) as unit:
        begin = unit.positions()
        answer = unit.link.ask("G")
        if answer.code == answers.NOTHING_TO_GO_ON:
            raise Refused("nothing waits to go on", answer, f"the unit is {unit.flags().text}")
        if answer.code != answers.DONE:
            raise Refused("G", answer)
        unit.link.pause(POLL_SECONDS)
        flags = unit.flags()
        if flags.has(INTA):
            causes = ", ".join(causes_of(unit, flags)) or "what the unit does not tell"
            raise Failure(f"it goes on, and is interrupted at once by {causes}", NOT_SO)
        state = {**_state(flags, unit.positions()), "from": dict(zip(AXES, begin, strict=True))}
    return tell(options, state, f"it goes on from {positions_text(begin)}")


def run_delete(options: Namespace) -> int:
    """Delete the queue."""
    with unit_of(options) as unit:
        answer = unit.link.ask("D")
        if answer.code == answers.NOT_WHILE_MOVING:
            raise Refused("nothing was deleted", answer, "the axes move; gve134 halt comes first")
        if answer.code != answers.DONE:
            raise Refused("D", answer)
        flags, positions = unit.flags(), unit.positions()
    text = f"the queue is empty; the axes stand at {positions_text(positions)}"
    return tell(options, _state(flags, positions), text)


def run_home(options: Namespace) -> int:
    """Find a reference switch."""
    parameters = (options.way, options.speed, options.back, options.speed2)
    command = f"W{options.axis.upper()}{','.join(parameters)}"
    require_good(command, "home")
    with unit_of(options) as unit:
        if not unit.flags().bits & (INTA | RUN):
            print(f"gve134: {_ways_text(options)}; Ctrl-C halts", file=sys.stderr, flush=True)
        return guarded_motion(unit, lambda: _home(options, unit, command))


def _ways_text(options: Namespace) -> str:
    """What a reference run will do: the unit tells nothing of it before its end."""
    way, speed, back, speed2 = (
        int(each) for each in (options.way, options.speed, options.back, options.speed2)
    )
    return (
        f"{options.axis.upper()} goes up to {way} pulses to its switch at {speed} pulses/s, then "
        f"up to {-back if way > 0 else back} off it at {speed2}"
    )


def _home(options: Namespace, unit: Unit, command: str) -> int:
    axis, seconds = command[1], _home_seconds(options)
    answer = unit.link.ask_long(command, seconds)
    if answer.code == answers.NOT_WHILE_MOVING:
        raise Refused(f"{axis} was not homed", answer)
    flags, positions = unit.flags(), unit.positions()
    if answer.code == answers.BOUNDS and answer.inta:
        raise Refused(f"{axis} was not homed", answer, answers.SWITCH_NOT_FOUND)
    if answer.code != answers.DONE:
        raise Refused(f"{axis} was not homed", answer)
    if answer.inta:
        causes = ", ".join(causes_of(unit, flags)) or "what the unit does not tell"
        raise Failure(f"{axis} was not homed: INTERRUPTED by {causes}", NOT_SO)
    text = f"{axis} stands where its switch lets go, at {positions[AXES.index(axis)]}"
    return tell(options, {"axis": axis, **_state(flags, positions)}, text)


def _home_seconds(options: Namespace) -> float:
    """What a reference run takes at the most, unless VL slows it down: then twice that."""
    way, speed, back, speed2 = (
        abs(int(each)) for each in (options.way, options.speed, options.back, options.speed2)
    )
    ways = way / speed + 2 * back / speed2
    return 2 * (ways + (speed + 3 * speed2) / SLOWEST_RAMP) + HOME_EXTRA_SECONDS


def run_override(options: Namespace) -> int:
    """Change the speed of the queue."""
    given = options.percent.removesuffix("%")
    command = OVERRIDES.get(given) or f"XM{given}"
    require_good(command, f"override {options.percent}")
    with unit_of(options) as unit:
        unit.order(command)
    text = {"up": "one sixteenth faster", "down": "one sixteenth slower", "last": "100 %"}
    return tell(options, {"sent": command}, text.get(given, f"{given} % of the last V"))


@dataclass(frozen=True)
class Jog:
    """A way of all axes, and where it leads to."""

    parts: tuple[int, int, int, int]

    @property
    def command(self) -> str:
        """The vector."""
        return f"L{','.join(map(str, self.parts))}"

    def require_reach(self, at: Positions) -> None:
        """Refuse what would lead past the positions that there are: they go on at the other end."""
        for axis, begin, way in zip(AXES, at, self.parts, strict=True):
            if abs(begin + way) > POSITION_MAX:
                raise Failure(
                    f"nothing was moved: {axis} would go from {begin} to {begin + way}, and "
                    f"positions end at {POSITION_MAX}; set a smaller one (N{axis}0 in the console)",
                    NOT_SO,
                )

    def text(self, at: Positions) -> str:
        """From where to where."""
        return ", ".join(
            f"{axis} from {begin} to {begin + way}"
            for axis, begin, way in zip(AXES, at, self.parts, strict=True)
            if way
        )


def run_jog(options: Namespace) -> int:
    """Move axes a little."""
    jog = _jog_of(options.ways)
    require_good(jog.command, "jog")
    if options.speed is not None:
        if not SPEED.fullmatch(options.speed):  # K, N and L would make another command of V
            raise Failure(f"jog --speed {options.speed}: write pulses/s, 10 to 200000")
        require_good(f"V{options.speed}", "jog --speed")
    with unit_of(options) as unit:
        flags, begin = unit.flags(), unit.positions()
        if not flags.stands or flags.has(INTA):
            raise Failure(f"nothing was moved: the unit is {flags.text}", NOT_SO)
        jog.require_reach(begin)
        until = ", until Enter is pressed" if options.hold else ""
        print(f"gve134: {jog.text(begin)}{until}; Ctrl-C halts", file=sys.stderr, flush=True)
        if options.speed is not None:
            unit.order(f"V{options.speed}")
        return guarded_motion(unit, lambda: _jog(options, unit, jog), then="D")


def _jog_of(ways: list[str]) -> Jog:
    parts = dict.fromkeys(AXES, 0)
    for way in ways:
        match = WAY.fullmatch(way)
        if not match or parts[match[1].upper()]:
            raise Failure(f"jog {way}: write each axis once with its pulses, as in X1000 Y-200")
        parts[match[1].upper()] = int(f"{match[2]}{match[3]}")
    if not any(parts.values()):
        raise Failure("jog: that is no way at all; write pulses other than 0")
    return Jog((parts["X"], parts["Y"], parts["Z"], parts["A"]))


def _jog(options: Namespace, unit: Unit, jog: Jog) -> int:
    unit.order(jog.command)
    released = False
    while not (flags := unit.flags()).stands and not released:
        unit.link.pause(POLL_SECONDS)
        released = options.hold and _input_has_come()
    if released and not flags.stands:
        flags = halt_loudly(unit).flags
        unit.order("D")
    elif flags.has(INTA):
        causes = ", ".join(causes_of(unit, flags)) or "what the unit does not tell"
        raise Failure(f"INTERRUPTED by {causes}{_rest_deleted(unit, flags)}", NOT_SO)
    positions = unit.positions()
    text = f"the axes stand at {positions_text(positions)}"
    return tell(options, _state(unit.flags(), positions), text)


def _rest_deleted(unit: Unit, flags: Flags) -> str:
    """Delete what waits of a jog: whoever has stopped it does not, and G would make it."""
    if not flags.has(RUN):
        return ""
    try:
        unit.order("D")
    except Refused as refused:
        return f"; {REST_MAY_WAIT} ({refused})"
    return ", its rest is deleted"


def _input_has_come() -> bool:
    """Whether Enter was pressed, or input has ended."""
    if sys.platform == "win32":
        import msvcrt  # select of Windows takes sockets only

        if sys.stdin.isatty() and not msvcrt.kbhit():
            return False
    elif not select.select([sys.stdin], [], [], 0)[0]:
        return False
    sys.stdin.readline()
    return True


def _state(flags: Flags, positions: Positions) -> dict[str, object]:
    return {"state": flags.text, "positions": dict(zip(AXES, positions, strict=True))}
