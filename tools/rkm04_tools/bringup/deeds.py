"""Steps that end in a reset: what the watchdog and the guard of the stack are for."""

from __future__ import annotations

from rkm04_tools.bringup.findings import Seen, compared, noted
from rkm04_tools.bringup.part import SOFTWARE_FLAG, WATCHDOG_FLAG, fault_text, flags_text
from rkm04_tools.bringup.step import Bench
from rkm04_tools.bringup.talk import Answer

START_SECONDS = 15.0


def _restart(bench: Bench, letter: str) -> tuple[list[Seen], Answer | None]:
    """Sent once only: a second one would end the start that follows."""
    bench.talk.ask(letter, tries=1)
    seconds = bench.talk.wait_ready(START_SECONDS)
    if seconds is None:
        none = compared("starts again", f"not in {START_SECONDS:g} s", "at once", False)
        return [none], None
    answer = bench.talk.ask("p")
    bench.talk.started = False
    return [
        compared("starts again", f"after {seconds:.1f} s", "in a second or so", True),
        noted("last reset", flags_text(answer.number("reset_flags", 16))),
    ], answer


def _caused(answer: Answer, cause: str, flag: int) -> Seen:
    told, flags = answer.word("cause"), answer.number("reset_flags", 16)
    return compared("cause of the start", told, cause, told == cause and bool(flags & flag))


def try_watchdog(bench: Bench) -> list[Seen]:
    seen, answer = _restart(bench, "w")
    return seen if answer is None else [*seen, _caused(answer, "watchdog", WATCHDOG_FLAG)]


def try_stack(bench: Bench) -> list[Seen]:
    seen, answer = _restart(bench, "g")
    if answer is None:
        return seen
    return [
        *seen,
        _caused(answer, "fault", SOFTWARE_FLAG),
        noted("fault", fault_text(answer)),
    ]
