"""The step at the STEP pins: one after the other is wired to the pin of a second timer, and
measured."""

from __future__ import annotations

from rkm04_tools.bringup import train
from rkm04_tools.bringup.findings import NOTE, Seen, bad_before, compared, rows_of
from rkm04_tools.bringup.person import AGAIN, GO
from rkm04_tools.bringup.step import Bench
from rkm04_tools.bringup.talk import Refused
from rkm04_tools.bringup.wires import KINDS, MOTORS, NO_CRYSTAL, all_off, name_of, signals_of

CAPTURE = "CAPTURE"
MEASURE = "Enter: measure, q: stop here"
DEAD = """\
nothing that can be switched moves it: STEP shorted, the wire somewhere else, or none and a \
resistor at the pin"""
AFTER = "Enter: go on, r: once more, q: stop here"


def measure(bench: Bench) -> list[Seen]:
    if not bench.has(CAPTURE):
        return [Seen("pulses", "not measured", "the board's header has no CAPTURE pin", NOTE)]
    seen = bench.seen
    try:
        for motor in range(1, MOTORS + 1):
            seen += _motor(bench, motor)
    except Refused as refused:
        if refused.why != NO_CRYSTAL:
            raise
        seen.append(compared("no pulses are made", "there is no crystal", "a crystal", False))
    return seen


def _motor(bench: Bench, motor: int) -> list[Seen]:
    step, capture = name_of(bench, f"STEP_{motor}"), name_of(bench, CAPTURE)
    said, before = AGAIN, list[Seen]()
    while said == AGAIN:
        bench.person.tell(f"A wire from {step} to {capture}, and nothing else there.")
        bench.person.choose(MEASURE, "", enter=GO)
        rows = _measured(bench, motor)
        bench.person.tell(rows_of(rows))
        said = bench.person.choose(AFTER, AGAIN, enter=GO)
        if said == AGAIN:
            before += bad_before(rows)
    return [*rows, *_named(before)]


def _measured(bench: Bench, motor: int) -> list[Seen]:
    what = name_of(bench, f"STEP_{motor}")
    found = train.read(bench.talk.ask(f"s{motor}"))
    if found.captured:
        return [compared(what, "comes", "comes", good=True),
                *_named(train.judge(found, train.limits(bench.header)))]  # fmt: skip
    text = train.wire_text(found)
    if found.pulled != train.FLOATS:
        text += _elsewhere(bench, motor)
    return [compared(what, text, f"a wire to {name_of(bench, CAPTURE)}", good=False)]


def _named(seen: list[Seen]) -> list[Seen]:
    """Below the name of the motor."""
    return [Seen(f"  {each.what}", each.seen, each.expected, each.verdict) for each in seen]


def _elsewhere(bench: Bench, motor: int) -> str:
    """Where the wire leads: what the image can switch is switched, one after the other."""
    bench.person.tell("Nothing comes. The other pins are tried, to see where the wire leads.")
    for other in range(1, MOTORS + 1):
        if other != motor and train.read(bench.talk.ask(f"s{other}")).captured:
            return f"; the wire is at {name_of(bench, f'STEP_{other}')}"
    for kind, (letter, _) in KINDS.items():
        rest = bench.talk.ask(f"{letter}0").number("capture")
        try:
            for number, signal in enumerate(signals_of(bench, kind), 1):
                if bench.talk.ask(f"{letter}{number}").number("capture") != rest:
                    return f"; the wire is at {name_of(bench, signal)}"
        finally:
            all_off(bench, letter)
    return f"; {DEAD}"
