"""The step in which all motors get pulses at once: whether four streams keep up with the edges."""

from __future__ import annotations

from rkm04_tools.bringup.findings import NOTE, Seen, compared
from rkm04_tools.bringup.part import fault_text
from rkm04_tools.bringup.step import Bench
from rkm04_tools.bringup.talk import Answer, Refused
from rkm04_tools.bringup.wires import NO_CRYSTAL
from rkm04_tools.line_errors import GarbledAnswer

OUTPUT_STOPPED = "44"
"""The exception that is told where the driver of the steps has stopped the outputs: its own."""
WIDER = "all in time; else BOARD_STEP_HIGH_NS and _LOW_NS of the header must be longer"


def try_together(bench: Bench) -> list[Seen]:
    if bench.header.values.get("BOARD_STEP_CLASS", "1") != "1":
        return [Seen("edges", "not tried", "only streams make edges at one tick", NOTE)]
    before = _faults(bench.talk.ask("p"))
    try:
        return _judged(bench.talk.ask("m", tries=1))
    except Refused as refused:
        if refused.why != NO_CRYSTAL:
            raise
        return [compared("no pulses are made", "there is no crystal", "a crystal", good=False)]
    except GarbledAnswer:
        answer = bench.talk.ask("p")
        if _faults(answer) == before:
            return _judged(bench.talk.ask("m"))
        bench.talk.started = False
        return [_restarted(answer)]


def _judged(answer: Answer) -> list[Seen]:
    wanted, made, late = answer.number("wanted"), answer.numbers("made"), answer.number("late")
    period_us = 1e6 * answer.number("period_ticks") / answer.number("tick_hz")
    return [
        compared("pulses", f"{', '.join(map(str, made))}, {period_us:g} us apart",
                 f"{wanted} of each motor, by the driver's count", made == [wanted] * len(made)),
        compared("late", f"{late}", "0", late == 0),
    ]  # fmt: skip


def _faults(answer: Answer) -> list[str]:
    """How many since power-on, and what the last one was."""
    return answer.words("faults")


def _restarted(answer: Answer) -> Seen:
    if _faults(answer)[1:2] == [OUTPUT_STOPPED]:
        return compared("edges", "one came too late, and the part was reset", WIDER, good=False)
    return compared("edges", f"the part was reset: {fault_text(answer)}", WIDER, good=False)
