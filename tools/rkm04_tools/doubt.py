"""What is not known when a command is cut short, by a lost line or by whoever ends it.

A request that is under way may have been taken, and a motor goes on without the tool. So a command
notes beforehand what is in doubt, and whatever cuts it short is told together with that.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from rkm04_tools.failure import INTERRUPTED, Failure
from rkm04_tools.line_errors import LineError, UnitRestarted, WrongAnswer

ENDS = tuple(
    getattr(signal, name)
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT")
    if hasattr(signal, name)
)
CUT_SHORT = (LineError, WrongAnswer)


@dataclass
class Doubt:
    """What would be told now. `what` is not known (empty: nothing is in doubt), `done` is."""

    what: str = ""
    advice: str = ""
    done: str = ""

    def about(self, what: str, advice: str, done: str = "") -> None:
        """Note what is in doubt from now on."""
        self.what, self.advice, self.done = what, advice, done

    def words(self, why: str) -> str:
        """The whole line, for what cuts the command short now."""
        parts = [f"NOT CONFIRMED: {self.what}: {why}", self.done, self.advice]
        return "; ".join(filter(None, parts))


@contextmanager
def in_doubt(doubt: Doubt) -> Iterator[Doubt]:
    """Tell what is in doubt if the block is cut short. Ends that are asked for are as Ctrl-C.

    What has notes is in no doubt any more: they say what has become of it.
    """
    try:
        with interrupted_by_any_end():
            yield doubt
    except KeyboardInterrupt as end:
        known = _known(end, doubt)
        if doubt.what and not hasattr(end, "__notes__"):
            raise Failure(doubt.words("interrupted"), INTERRUPTED) from None
        if not known:
            raise
        raise Failure("; ".join(["interrupted", *known]), INTERRUPTED) from None
    except Failure as failure:
        # A restart says itself what became of the request.
        is_told = isinstance(failure, UnitRestarted) or hasattr(failure, "__notes__")
        if doubt.what and isinstance(failure, CUT_SHORT) and not is_told:
            failure.args = (doubt.words(str(failure)),)
        else:
            failure.args = ("; ".join([str(failure), *_known(failure, doubt)]),)
        raise


def _known(end: BaseException, doubt: Doubt) -> list[str]:
    """What is known when something ends a command."""
    return [*getattr(end, "__notes__", []), *filter(None, [doubt.done])]


@contextmanager
def interrupted_by_any_end() -> Iterator[None]:
    """Make the ends that a process is asked for be as Ctrl-C."""
    with _handled_by(signal.default_int_handler):
        yield


@contextmanager
def undisturbed() -> Iterator[None]:
    """Let nobody interrupt a stop, which takes a few seconds at the most."""
    with _handled_by(signal.SIG_IGN):
        yield


@contextmanager
def _handled_by(handler: signal.Handlers | object) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield  # signals come to the main thread only
        return
    before = {number: signal.getsignal(number) for number in ENDS}
    # What is ignored is meant to be, as by nohup.
    changed = {number: usual for number, usual in before.items() if usual != signal.SIG_IGN}
    for number in changed:
        signal.signal(number, handler)  # type: ignore[arg-type]
    try:
        yield
    finally:
        for number, usual in changed.items():
            signal.signal(number, usual)
