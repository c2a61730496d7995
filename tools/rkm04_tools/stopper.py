"""Ctrl-C and other ends that a process is asked for while something moves, and the shout.

The first signal is looked at between exchanges, never in the middle of one, so that a stop does
not come after half a command.
"""

from __future__ import annotations

import math
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any

ENDED_BEFORE = "the tool was ended before the unit had confirmed the stop"
TWICE_SECONDS = 0.3
"""A second signal before that is the same wish: the stop has gone out by then."""
NUDGE_SECONDS = 0.1
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

    `wire` has a `look`, which it calls before it sends.

    `number` is that of the last one.
    """

    def __init__(self, wire: Any) -> None:
        self._wire = wire
        self.number = 0
        self._asked = False
        self._at_once_from = math.inf
        self._before: dict[int, object] = {}

    def __enter__(self) -> Stopper:
        for name in SIGNALS:
            if hasattr(signal, name):
                number = getattr(signal, name)
                self._before[number] = signal.signal(number, self._note)
        self._wire.look = self.look
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._wire.look = lambda: None
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


@contextmanager
def nudged() -> Iterator[None]:
    """Inside this the main thread notices a signal soon, whatever it waits in.

    One that comes just before readline waits has set a flag only, at which nothing looks until
    a key is pressed. Here each nudge interrupts that wait, and Python looks. SIGURG is ignored
    where nobody handles it, so one that comes late does no harm.
    """
    if not hasattr(signal, "SIGURG"):  # on Windows, where the wait ends by itself
        yield
        return
    before = signal.signal(signal.SIGURG, lambda number, frame: None)
    main, ended = threading.get_ident(), threading.Event()

    def nudge() -> None:
        while not ended.wait(NUDGE_SECONDS):
            signal.pthread_kill(main, signal.SIGURG)

    nudger = threading.Thread(target=nudge, daemon=True)
    nudger.start()
    try:
        yield
    finally:
        ended.set()
        nudger.join()
        signal.signal(signal.SIGURG, before)


def shout(why: str) -> None:
    """Say in the largest letters that there are that nobody knows whether the axes stand."""
    lines = [f"STOP NOT CONFIRMED: {why}", "USE THE EMERGENCY STOP"]
    if sys.stderr.isatty():
        big = [*_large("STOP"), "", *_large("NOT"), "", *_large("CONFIRMED")]
        lines = [f"\x1b[1;41;97m{line.ljust(60)}\x1b[0m" for line in ["", *big, ""]] + lines
    print("\n".join(lines), file=sys.stderr, flush=True)


def _large(word: str) -> list[str]:
    rows = []
    for row in range(5):
        cells = (f"{LETTERS[letter][row]:05b}" for letter in word)
        rows.append(" " + " ".join(cells).replace("0", " ").replace("1", "#"))
    return rows
