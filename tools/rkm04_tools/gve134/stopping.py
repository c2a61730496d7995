"""Ctrl-C and other ends that a process is asked for: they halt the axes, and say so or shout.

The first signal is looked at between exchanges, never in the middle of one, so that H does not
come after half a command. While H is under way a second one ends the tool at once.
"""

from __future__ import annotations

import math
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from types import FrameType, TracebackType

from rkm04_tools.failure import INTERRUPTED, NO_CONNECTION, Failure
from rkm04_tools.gve134.link import HALT_SECONDS
from rkm04_tools.gve134.link_errors import NotConfirmed
from rkm04_tools.gve134.state import positions_text
from rkm04_tools.gve134.unit import Halted, Unit

ENDED_BEFORE = "the tool was ended before the unit had confirmed the stop"
TWICE_SECONDS = 0.3
"""A second signal before that is the same wish: H has gone out by then."""
SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT")
# Letters of five rows and five columns, a row a number, the left column its highest bit.
LETTERS = {
    "N": (17, 25, 21, 19, 17), "O": (14, 17, 17, 17, 14), "T": (31, 4, 4, 4, 4),
    "C": (15, 16, 16, 16, 15), "F": (31, 16, 30, 16, 16), "I": (14, 4, 4, 4, 14),
    "R": (30, 17, 30, 18, 17), "M": (17, 27, 21, 17, 17), "E": (31, 16, 30, 16, 31),
    "D": (30, 17, 17, 17, 30), "S": (15, 16, 14, 1, 30), "P": (30, 17, 30, 16, 16),
    " ": (0, 0, 0, 0, 0),
}  # fmt: skip


class Stopper:
    """While the block runs, signals are kept until `look` is called, which raises the wish.

    `number` is that of the last one.
    """

    def __init__(self, unit: Unit) -> None:
        self._unit = unit
        self.number = 0
        self._asked = False
        self._at_once_from = math.inf
        self._before: dict[int, object] = {}

    def __enter__(self) -> Stopper:
        for name in SIGNALS:
            if hasattr(signal, name):
                number = getattr(signal, name)
                self._before[number] = signal.signal(number, self._note)
        self._unit.link.wire.look = self.look
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._unit.link.wire.look = lambda: None
        for number, handler in self._before.items():
            signal.signal(number, handler)  # type: ignore[arg-type]

    def look(self) -> None:
        """Raise KeyboardInterrupt if a signal has come."""
        if self._asked:
            self._asked = False
            raise KeyboardInterrupt

    @contextmanager
    def at_once(self, after_seconds: float = 0.0) -> Iterator[None]:
        """Inside this, and so long after its beginning, a signal is raised when it comes.

        One that came just before is raised, too, unless there is such a time.
        """
        self._at_once_from = time.monotonic() + after_seconds
        try:
            if not after_seconds:
                self.look()
            yield
        finally:
            self._at_once_from = math.inf

    def _note(self, number: int, frame: FrameType | None) -> None:
        self.number = number
        if time.monotonic() >= self._at_once_from:
            raise KeyboardInterrupt
        self._asked = self._at_once_from == math.inf


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
    with Stopper(unit) as stopper:
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


def shout(why: str) -> None:
    """Say in the largest letters that there are that nobody knows whether the axes stand."""
    lines = [f"STOP NOT CONFIRMED: {why}", "USE THE EMERGENCY STOP"]
    if sys.stderr.isatty():
        big = [*_large("STOP"), "", *_large("NOT"), "", *_large("CONFIRMED")]
        lines = [f"\x1b[1;41;97m{line.ljust(60)}\x1b[0m" for line in ["", *big, ""]] + lines
    print("\n".join(lines), file=sys.stderr, flush=True)


def _shout_meanwhile() -> None:
    print(
        f"gve134: STOP NOT CONFIRMED YET: no answer to H, which is sent for {HALT_SECONDS:.0f} s; "
        "where the axes do not brake, use the emergency stop",
        file=sys.stderr, flush=True,
    )  # fmt: skip


def _large(word: str) -> list[str]:
    rows = []
    for row in range(5):
        cells = (f"{LETTERS[letter][row]:05b}" for letter in word)
        rows.append(" " + " ".join(cells).replace("0", " ").replace("1", "#"))
    return rows
