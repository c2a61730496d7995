"""Steps at the pins: inputs, the address switch, and outputs one at a time."""

from __future__ import annotations

import time
from collections.abc import Callable

from rkm04_tools.bringup.findings import Seen, compared, noted
from rkm04_tools.bringup.person import AGAIN, NO, YES
from rkm04_tools.bringup.step import Bench
from rkm04_tools.bringup.talk import Answer, Refused
from rkm04_tools.doubt import undisturbed

INPUTS, OUTPUTS, MOTORS = 8, 8, 4
POLL_SECONDS = 0.3
KINDS = {"BO": ("o", "outputs"), "LED": ("e", "leds"), "DIR": ("d", "directions"),
         "EN": ("a", "enables")}  # fmt: skip
"""Letter of the command, and what the pins are called in its answer."""
NO_CRYSTAL = "no_crystal"
ALWAYS = ("step", "line", "tick", "plan")
"""Interrupts that come whatever was done before; that of edges comes with inputs."""
REFILL = "refill"
IS_IT_SO = "y: so it is, n: it is not, q: stop here"


def signals_of(bench: Bench, kind: str) -> list[str]:
    """The signals of a kind that the image can switch, in the order of their numbers."""
    if kind == "EN":
        return [pin.signal for pin in bench.header.pins if pin.signal.startswith("EN_")]
    return [f"{kind}_{i}" for i in range(1, (OUTPUTS if kind == "BO" else MOTORS) + 1)]


def look_at_inputs(bench: Bench) -> list[Seen]:
    """Every input on and off, in any order, by the person's hand."""
    bench.talk.ask("n")
    told: set[int] = set()
    last = time.monotonic()
    while True:
        answer = bench.talk.ask("i")
        new = _moved(answer) - told
        for number in sorted(new):
            bench.person.tell(f"  {name_of(bench, f'BI_{number}')}: to 1 and back")
        told |= new
        now = time.monotonic()
        last = now if new else last
        if len(told) == INPUTS or now - last > bench.patience:
            return [_input(bench, answer, number) for number in range(1, INPUTS + 1)]
        time.sleep(POLL_SECONDS)


def _moved(answer: Answer) -> set[int]:
    """Inputs that have gone to 1 and back."""
    pairs = zip(answer.numbers("rises"), answer.numbers("falls"), strict=True)
    return {i for i, (up, down) in enumerate(pairs, 1) if up and down}


def _input(bench: Bench, answer: Answer, number: int) -> Seen:
    place = number - 1
    level = answer.number("inputs", 16) >> place & 1
    up, down = answer.numbers("rises")[place], answer.numbers("falls")[place]
    beside = [i + 1 for i in range(INPUTS) if answer.numbers("beside", 16)[place] >> i & 1]
    seen = f"to 1: {up}, to 0: {down}, now {level}"
    if not up and not down:
        seen = f"always {level}"
    if beside:
        seen += f"; also 1 then: {', '.join(f'BI_{each}' for each in beside)}"
    good = bool(up and down and not beside)
    what = name_of(bench, f"BI_{number}")
    return compared(what, seen, "to 1 and back to 0, alone", good)


def name_of(bench: Bench, signal: str) -> str:
    return f"{signal} at {bench.pin_of(signal)}"


def look_at_switch(bench: Bench) -> list[Seen]:
    node = bench.talk.ask("i").number("node")
    closed = [f"S1-{i + 1}" for i in range(4) if node - 1 >> i & 1]
    bench.person.tell(f"The switch says address {node}: {', '.join(closed) or 'none'} closed.")
    right = bench.person.choose(f"Is it so? {IS_IT_SO}", YES + NO) == YES
    return [compared("address", str(node), "as the switch stands", right)]


def walk(kind: str) -> Callable[[Bench], list[Seen]]:
    """One after the other of a kind goes on, alone."""

    def run(bench: Bench) -> list[Seen]:
        letter, _ = KINDS[kind]
        signals = signals_of(bench, kind)
        if not signals:
            return [noted(kind, "the board has none")]
        seen = bench.seen
        try:
            rest = bench.talk.ask(f"{letter}0")
            for number, signal in enumerate(signals, 1):
                seen += _switch(bench, f"{letter}{number}", signal, rest)
        except Refused as refused:
            if refused.why != NO_CRYSTAL:
                raise
            seen.append(compared("cannot be switched", "there is no crystal", "a crystal", False))
        finally:
            all_off(bench, letter)
        return seen

    return run


def all_off(bench: Bench, letter: str) -> None:
    """Also when Ctrl-C is pressed twice."""
    with undisturbed():
        bench.talk.ask(f"{letter}0")


def _switch(bench: Bench, command: str, signal: str, rest: Answer) -> list[Seen]:
    """Until the person has seen it: the image switches it off after a minute."""
    what = name_of(bench, signal)
    said = AGAIN
    while said == AGAIN:
        answer = bench.talk.ask(command)
        at = _followers(bench, command, answer, rest)
        bench.person.tell(f"{what} is on for a minute, all others are off.")
        if at:
            bench.person.tell(f"It is seen at {at}.")
        said = bench.person.choose(f"Is it so? r: once more, {IS_IT_SO}", YES + NO + AGAIN)
    seen = [
        compared(what, "on, alone" if said == YES else "not so", "on, alone", said == YES),
        _read_back(bench, answer, signal),
    ]
    return [*seen, noted("  seen at", at)] if at else seen


def _followers(bench: Bench, command: str, answer: Answer, rest: Answer) -> str:
    """The inputs that follow an output, where a wire leads back to them: once more, as an input may
    have changed by itself."""
    follow = _levels(answer) ^ _levels(rest)
    for number in (0, command[1:]) if follow else ():
        levels = _levels(bench.talk.ask(f"{command[0]}{number}"))
        follow &= levels ^ _levels(answer if number == 0 else rest)
    at = [f"BI_{i + 1}" for i in range(INPUTS) if follow >> i & 1]
    at += ["CAPTURE"] * (follow >> INPUTS & 1)
    return ", ".join(name_of(bench, each) for each in at)


def _levels(answer: Answer) -> int:
    return answer.number("inputs", 16) | answer.number("capture") << INPUTS


def _read_back(bench: Bench, answer: Answer, signal: str) -> Seen:
    """What the part itself reads at its pins: a short to a neighbour is seen without a meter."""
    on = []
    for kind, (_, pins) in KINDS.items():
        mask = answer.number(pins, 16)
        on += [each for i, each in enumerate(signals_of(bench, kind)) if mask >> i & 1]
    on += [f"STEP_{i + 1}" for i in range(MOTORS) if answer.number("steps", 16) >> i & 1]
    if on != [signal] and bench.talk.ask("c").number("crystal_ready") == 0:
        on = [each for each in on if not each.startswith("LED")]  # they blink then
    return compared("  read at the pins", ", ".join(on) or "none is on", f"{signal} only",
                    on == [signal])  # fmt: skip


def look_at_cycles(bench: Bench) -> list[Seen]:
    """How long the interrupts take; those that must have come by then have."""
    rows = [row[1:] for row in bench.talk.ask("t").rows if row[0] == "cycles"]
    return [_cycles(bench, name, int(count), longest) for name, count, longest in rows]


def _cycles(bench: Bench, name: str, count: int, longest: str) -> Seen:
    what = f"{name} interrupt"
    said = f"{count} times, longest {longest} cycles" if count else "has not come yet"
    if name in ALWAYS:
        return compared(what, said, "comes", count > 0)
    if name == REFILL and bench.header.values.get("BOARD_STEP_CLASS", "1") != "2":
        said = "not of this board"
    return noted(what, said)
