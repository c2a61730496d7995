"""Ctrl-C and other ends that a process is asked for: they halt the axes, and say so or shout.

The first signal is looked at between exchanges, never in the middle of one, so that H does not
come after half a command. While H is under way a second one ends the tool at once.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace

from rkm04_tools.failure import INTERRUPTED, NO_CONNECTION, Failure
from rkm04_tools.gve134.link import HALT_SECONDS
from rkm04_tools.gve134.link_errors import NotConfirmed
from rkm04_tools.gve134.state import positions_text
from rkm04_tools.gve134.unit import Halted, Unit
from rkm04_tools.stopper import ENDED_BEFORE, TWICE_SECONDS, Stopper, shout


def guarded(
    unit: Unit,
    work: Callable[[Stopper], int],
    done: Callable[[], str] = lambda: "",
    then: str = "",
    after: Callable[[Halted], str] = lambda _: "",
) -> int:
    """Do what moves axes; Ctrl-C halts them.

    `done` says what is to be told of the work besides, `after` what more when the axes stand;
    `then` is a command for after the stop.
    """
    with Stopper(unit.link.wire) as stopper:
        try:
            return work(stopper)
        except KeyboardInterrupt:
            return halt_at_signal(unit, stopper, done(), then, after)
        except NotConfirmed as error:
            shout(str(error))
            raise


def halt_at_signal(
    unit: Unit,
    stopper: Stopper,
    text: str = "",
    then: str = "",
    after: Callable[[Halted], str] = lambda _: "",
) -> int:
    """Halt the axes, and tell where they stand and what was done; the exit status."""
    print(f"\ngve134: {text}halting ...", file=sys.stderr, flush=True)
    try:
        with stopper.at_once(TWICE_SECONDS):
            halted = halt_loudly(unit)
            if then:
                unit.order(then)
                halted = replace(halted, flags=unit.flags())
    except KeyboardInterrupt:
        shout(ENDED_BEFORE)
        return INTERRUPTED
    except Failure as failure:
        print(f"gve134: {failure}", file=sys.stderr)
        return NO_CONNECTION
    print(f"gve134: {halted_text(halted)}{after(halted)}", file=sys.stderr)
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


def halted_text(halted: Halted) -> str:
    """How the axes stand, in words."""
    what = "the unit HAS RESTARTED, its positions count anew; " if halted.restarted else ""
    return f"{what}the axes stand at {positions_text(halted.positions)}; {halted.flags.text}"


def _shout_meanwhile() -> None:
    print(
        f"gve134: STOP NOT CONFIRMED YET: no answer to H, which is sent for {HALT_SECONDS:.0f} s; "
        "where the axes do not brake, use the emergency stop",
        file=sys.stderr, flush=True,
    )  # fmt: skip
