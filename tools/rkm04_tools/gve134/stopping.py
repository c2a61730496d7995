"""Ctrl-C, other ends that a process is asked for, and a line that is silent while axes move: they
halt the axes, and say so or shout.

The first signal is looked at between exchanges, never in the middle of one, so that H does not
come after half a command. While H is under way a second one ends the tool at once.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace

from rkm04_tools.failure import INTERRUPTED, NO_CONNECTION, Failure
from rkm04_tools.gve134.link import HALT_SECONDS
from rkm04_tools.gve134.link_errors import LineError, NotConfirmed, Restarted
from rkm04_tools.gve134.state import Flags, Positions, positions_text
from rkm04_tools.gve134.unit import Halted, Unit
from rkm04_tools.stopper import ENDED_BEFORE, TWICE_SECONDS, Stopper, shout

SPINDLE_NOT_KNOWN = (
    "whether the spindle turns is NOT KNOWN, the unit cannot be asked (gve134 spindle 0 stops it)"
)
REST_MAY_WAIT = "ITS REST MAY WAIT, and gve134 go would make it: gve134 delete"
SPINDLE_AFTER_RESTART = "the restart has switched the spindle off"
SPINDLE_OF_OTHERS = "whether the spindle turns is NOT KNOWN (gve134 spindle 0 stops it)"


def guarded(
    unit: Unit,
    work: Callable[[Stopper], int],
    done: Callable[[], str] = lambda: "",
    after: Callable[[Halted], str] = lambda _: "",
    spindle: Callable[[], str] = lambda: SPINDLE_NOT_KNOWN,
) -> int:
    """Do what moves axes; Ctrl-C halts them.

    `done` says what is to be told of the work besides, `after` what more when the axes stand.
    """
    with Stopper(unit.link.wire) as stopper:
        try:
            return work(stopper)
        except KeyboardInterrupt:
            return halt_at_signal(unit, stopper, done(), "", after, spindle)
        except NotConfirmed as error:
            shout(str(error))
            raise


def guarded_motion(unit: Unit, work: Callable[[], int], then: str = "") -> int:
    """Do what moves axes, and ends when they stand.

    Where it ends early, by a signal, an error or a silent line, the axes are halted, and it is told
    where they stand and what the spindle does, or shouted that nobody knows.
    """
    with Stopper(unit.link.wire) as stopper:
        try:
            try:
                return work()
            except LineError:
                raise
            except Failure as failure:
                raise Failure(f"{failure}; {_standing(unit)}", failure.status) from None
        except KeyboardInterrupt:
            return halt_at_signal(unit, stopper, "", then)
        except Restarted as error:
            raise Failure(f"{error}; {SPINDLE_AFTER_RESTART}", error.status) from None
        except LineError as error:
            print(f"gve134: {error}", file=sys.stderr)
            halt_at_signal(unit, stopper, "it is NOT KNOWN whether the axes move; ", then)
            return NO_CONNECTION


def _standing(unit: Unit) -> str:
    """Where the axes stand, as the unit confirms it, and what the spindle does.

    What another one has moved is left alone.
    """
    flags, positions = unit.flags(), unit.positions()
    text = standing_text(flags, positions)
    if not flags.stands:
        text = f"the axes are {flags.text}, at {positions_text(positions)}"
    return f"{text}; {SPINDLE_NOT_KNOWN}"


def halt_at_signal(
    unit: Unit,
    stopper: Stopper,
    text: str = "",
    then: str = "",
    after: Callable[[Halted], str] = lambda _: "",
    spindle: Callable[[], str] = lambda: SPINDLE_NOT_KNOWN,
) -> int:
    """Halt the axes, and tell where they stand and what was done.

    `then` is a command that ends what would go on else.

    The exit status: INTERRUPTED only where the unit has confirmed that they stand.
    """
    print(f"\ngve134: {text}halting ...", file=sys.stderr, flush=True)
    waits = f"; {REST_MAY_WAIT}" if then else ""
    try:
        with stopper.at_once(TWICE_SECONDS):
            halted = halt_loudly(unit)
            if then:
                unit.order(then)
                halted = replace(halted, flags=unit.flags())
    except KeyboardInterrupt:
        shout(ENDED_BEFORE)
        print(f"gve134: {spindle()}{waits}", file=sys.stderr)
        return NO_CONNECTION
    except Failure as failure:
        print(f"gve134: {failure}; {spindle()}{waits}", file=sys.stderr)
        return NO_CONNECTION
    turns = spindle_after(halted, spindle)
    print(f"gve134: {halted_text(halted)}{after(halted)}; {turns}", file=sys.stderr)
    return INTERRUPTED


def halt_loudly(unit: Unit) -> Halted:
    """Halt; what is not confirmed is shouted, and raised."""
    try:
        return unit.halt(lambda: _shout_meanwhile())
    except Failure as failure:
        shout(str(failure))
        raise Failure(
            "the stop is NOT CONFIRMED, use the emergency stop; what stands or moves is not known",
            NO_CONNECTION,
        ) from None


def spindle_after(halted: Halted, spindle: Callable[[], str] = lambda: SPINDLE_NOT_KNOWN) -> str:
    """What the spindle does, as far as it is known."""
    if halted.restarted:
        return SPINDLE_AFTER_RESTART
    return SPINDLE_OF_OTHERS if halted.others else spindle()


def halted_text(halted: Halted) -> str:
    """How the axes stand, in words."""
    what = f"{halted.others}; " if halted.others else ""
    if halted.restarted:
        what = "the unit HAS RESTARTED, its positions count anew; "
    return f"{what}{standing_text(halted.flags, halted.positions)}"


def standing_text(flags: Flags, positions: Positions) -> str:
    """Where the axes stand, as the unit has told."""
    return f"the axes stand at {positions_text(positions)}; {flags.text}; confirmed by the unit"


def _shout_meanwhile() -> None:
    print(
        f"gve134: STOP NOT CONFIRMED YET: no answer to H, which is sent for {HALT_SECONDS:.0f} s; "
        "where the axes do not brake, use the emergency stop",
        file=sys.stderr, flush=True,
    )  # fmt: skip
