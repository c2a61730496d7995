"""How soon the image answers: every command of the table at rest, in motion at 4 x 200 000 pulses/s
and after a halt; and how soon after power-on it is ready.

Not among them: H and W, which are answered when the axes stand; what writes the memory, which may
take longer and has a figure of its own; J, which comes last.
"""

from __future__ import annotations

from collections.abc import Sequence

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.bench.lines import LOG, byte_ms, row, said_in
from rkm04_tools.target_figures import Figures
from rkm04_tools.target_run import Rig

BAUD = 115_200
BEGIN_MS, APART_MS = 120.0, 8.0
SPINDLE_ONLY = 2
LATER = ("W", "H", "J", "EW", "EUW", "EFW", "%+")
LAST = "!0%+\r"
"""After it commands would need checksums."""
CHANGES = ("XA", "XU", "XD", "XM")
MOTION = ["A8000", "V200000", "$1", *["C2000,-1980,1140,660"] * 120]
"""1.2 s of motion, with the queue full."""
REST_MS = 60.0
"""For a halt."""
ANSWER_MS_MAX = 2500.0
ASK_EVERY_MS = 0.5
READY_MS_MAX = 150.0
BYTES_WRITTEN = 300


def texts(letters: Sequence[str] = (), *, without: Sequence[str] = ()) -> list[str]:
    """The examples of the table, as the line has them."""
    found = []
    for command in host.commands():
        wanted = command.text in letters if letters else command.text not in without
        if (wanted and command.packet == 0) or (wanted and command.text in ("B", "C")):
            address = "7" if command.address == SPINDLE_ONLY else "0"
            found.append(f"!{address}{command.example}\r")
    return found


def longest_ms(rig: Rig, before: Sequence[str], asked: Sequence[str], apart: float) -> float:
    """The longest time from the end of a command to the begin of its answer."""
    at, lines, ends = BEGIN_MS, "", []
    for text in before:
        lines += row(at, text.encode())
        at += len(text) * byte_ms(BAUD) + 1.0
    first = len(before)
    at += REST_MS
    for text in asked:
        lines += row(at, text.encode())
        ends.append(at + len(text) * byte_ms(BAUD))
        at += apart
    options = ("--baud", str(BAUD), "--line-log", str(rig.folder / LOG))
    rig.run(at / 1000, lines, "", *options)
    said = said_in(rig.folder)
    if len(said) != first + len(asked):
        raise Failure(f"{len(said)} answers to {first + len(asked)} commands", NOT_SO)
    return max(each.ms - end for each, end in zip(said[first:], ends, strict=True))


def ready_ms(rig: Rig, *options: str) -> float:
    """The end of the first command after power-on that is answered; it comes again and again."""
    text = b"!0F\r"
    lines = "".join(
        row(i * ASK_EVERY_MS, text) for i in range(round(READY_MS_MAX / ASK_EVERY_MS))
    )  # fmt: skip
    rig.run(
        READY_MS_MAX / 1000, lines, "", "--baud", str(BAUD), "--line-log",
        str(rig.folder / LOG), *options,
    )  # fmt: skip
    said = said_in(rig.folder)
    if not said:
        raise Failure("start-up: the unit does not answer", NOT_SO)
    return said[0].ms


def written(rig: Rig) -> str:
    """A flash in which the memory was written again and again."""
    path = str(rig.folder / "flash")
    lines, at = "", BEGIN_MS
    for number in range(BYTES_WRITTEN):
        lines += row(at, f"!0EW{number % 64 + 16:02X},{number % 251:02X}\r".encode())
        at += 4.0
    rig.run(at / 1000, lines, "", "--baud", str(BAUD), "--flash", path)
    return path


def figures(rig: Rig) -> Figures:
    """For the table."""
    plain = [*texts(without=LATER), LAST]
    motion = [f"!0{text}\r" for text in MOTION]
    changes = texts(CHANGES)
    fresh, used = ready_ms(rig), ready_ms(rig, "--flash", written(rig))
    return {
        "answer_rest": longest_ms(rig, [], plain, APART_MS),
        "answer_motion": longest_ms(rig, motion, [t for t in plain if t not in changes], APART_MS),
        "answer_change": longest_ms(rig, motion, changes, APART_MS),
        "answer_halted": longest_ms(rig, [*motion, "!0H\r"], plain, APART_MS),
        "answer_memory": longest_ms(rig, [], texts(("EW", "EUW", "EFW")), ANSWER_MS_MAX),
        "ready_fresh": fresh,
        "ready_used": used,
    }
