"""Get Status (message 200): what a unit is like, in one answer of fixed layout.

The layout is that of firmware/rkm04/docs/messages.md. Later ones only add bytes, and new bits
and numbers, which are passed by or told as numbers here.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

from rkm04_tools.line_errors import WrongAnswer
from rkm04_tools.messages import GET_STATUS, MOTORS, NAMES, require_known
from rkm04_tools.table import table, thousands

INPUTS = OUTPUTS = 8
VARIABLES = range(80, 96)

CAUSES = ("power-on", "reset", "watchdog", "fault")
ERRORS = (
    "",
    "label not found",
    "E without L",
    "more than 8 nested loops",
    "more than 6 nested calls",
    ". without a call",
    "more than 10 sections",
    "change of direction inside a compound move",
    "Y without F or B",
    "the stored program is damaged",
    "no motion without the crystal",
)
LINE_COUNTS = {
    "frames": "good frames for this unit",
    "foreign": "good frames for others, and answers",
    "stray": "bytes outside of frames",
    "broken": "bytes with a framing, noise or overrun error",
    "fcs": "frames with a wrong FCS",
    "abort": "frames that were aborted",
    "escape": "frames with a byte escaped that must not be",
    "short": "frames without a message",
    "long": "frames that were too long",
    "gap": "frames with a gap",
    "repeats": "requests that were not executed again",
    "unsent": "answers not begun, as the line was not silent",
}
"""What the link of a unit counts, in the order of the answer, with what it means."""
UNTIMED = "by an interrupt (class 2): less than 4 us late, or counted as late"
"""What the steps of a board are that no timer makes."""

# Number, layout; inputs, outputs, cause, switches; states; errors; positions; late steps; counts.
LAYOUT = struct.Struct(f"<BB4B4B4B4qI{len(LINE_COUNTS)}I")
LAYOUT_OLDEST = 1
WAITS = struct.Struct("<4B")
"""What layout 2 has after it: what each motor waits for."""

WAITS_HIGH, WAITS_TIME, WAITS_RELEASE = 0x80, 96, 97


@dataclass(frozen=True)
class Awaited:
    """What a program waits for: an `input` or a `variable` with its number and level, a `time`,
    or `]`; with number and level 0."""

    what: str
    number: int = 0
    level: int = 0

    @property
    def text(self) -> str:
        """In words."""
        if self.number:
            return f"{self.what} {self.number} to become {self.level}"
        return f"a {self.what}" if self.what == "time" else self.what


@dataclass(frozen=True)
class MotorStatus:
    """What a motor does. `error` says why its program has failed, empty if it has not.

    `moving`: a move is in progress. `running`: its program is; `waiting`: it is, and waits for a
    time, a level or `]`; for which of them is in `awaited`, if the unit tells. `stopped` by K until
    C75, `failed` and `ended` (by X) until `\\`. `simulated`: its pins are disconnected (T41).
    """

    motor: int
    position: int
    moving: bool
    running: bool
    waiting: bool
    stopped: bool
    failed: bool
    ended: bool
    error: str
    awaited: Awaited | None = None
    simulated: bool = False

    @property
    def at_rest(self) -> bool:
        """Whether it stands, and all that is stored has run."""
        busy = self.moving or self.running or self.stopped
        return not (busy or self.failed or self.ended)

    @property
    def text(self) -> str:
        """The state in words."""
        words = [
            word
            for word, is_so in (
                (f"failed: {self.error}", self.failed),
                ("ended by X", self.ended),
                ("stopped by K", self.stopped),
                ("moving", self.moving),
                (f"waiting{f' for {self.awaited.text}' if self.awaited else ''}", self.waiting),
                ("running", self.running and not (self.moving or self.waiting)),
            )
            if is_so
        ]
        return ", ".join((words or ["at rest"]) + ["simulated"] * self.simulated)


@dataclass(frozen=True)
class Status:
    """What a unit is like.

    `inputs` and `outputs` are levels, BI1 and BO1 first; outputs as programs have set them: while
    `simulating` (T41) the pins are at 0. `cause` of the last start: power-on, reset, watchdog or
    fault. `late_steps` (pulses made too late) and `line` (see LINE_COUNTS) count since the start,
    modulo 2^32.
    """

    layout: int
    inputs: tuple[bool, ...]
    outputs: tuple[bool, ...]
    cause: str
    no_crystal: bool
    not_started: bool
    memory_locked: bool
    simulating: bool
    no_store: bool
    untimed: bool
    motors: tuple[MotorStatus, ...]
    late_steps: int
    line: dict[str, int]

    def as_json(self) -> dict[str, Any]:
        """For scripts; levels are 0 and 1."""
        return {
            "layout": self.layout,
            "inputs": [int(level) for level in self.inputs],
            "outputs": [int(level) for level in self.outputs],
            "cause": self.cause,
            "no_crystal": self.no_crystal,
            "not_started": self.not_started,
            "memory_locked": self.memory_locked,
            "simulating": self.simulating,
            "no_store": self.no_store,
            "untimed": self.untimed,
            "motors": [asdict(motor) for motor in self.motors],
            "late_steps": self.late_steps,
            "line": dict(self.line),
        }


def parse_status(answer: bytes) -> Status:
    """Read an answer to Get Status, of this layout or a later one."""
    require_known(GET_STATUS, answer)
    if len(answer) < LAYOUT.size or answer[0] != GET_STATUS or answer[1] < LAYOUT_OLDEST:
        raise WrongAnswer(NAMES[GET_STATUS], answer)
    values = iter(LAYOUT.unpack(answer[: LAYOUT.size]))
    _, layout, inputs, outputs, cause, switches = _take(values, 6)
    states, errors, positions = (_take(values, len(MOTORS)) for _ in range(3))
    rest = answer[LAYOUT.size :]
    if layout > LAYOUT_OLDEST and len(rest) < WAITS.size:
        raise WrongAnswer(NAMES[GET_STATUS], answer)
    codes = WAITS.unpack(rest[: WAITS.size]) if layout > LAYOUT_OLDEST else [0] * len(MOTORS)
    awaited = map(_awaited, codes)
    motors = zip(MOTORS, positions, states, errors, awaited, strict=True)
    return Status(
        layout=layout,
        inputs=_levels(inputs, INPUTS),
        outputs=_levels(outputs, OUTPUTS),
        cause=CAUSES[cause] if cause < len(CAUSES) else f"cause {cause}",
        no_crystal=bool(switches & 1),
        not_started=bool(switches & 2),
        memory_locked=bool(switches & 4),
        simulating=bool(switches & 8),
        no_store=bool(switches & 16),
        untimed=bool(switches & 32),
        motors=tuple(_motor(*each) for each in motors),
        late_steps=next(values),
        line=dict(zip(LINE_COUNTS, values, strict=True)),
    )


def levels_text(levels: tuple[bool, ...]) -> str:
    """The numbers, from 1, of the inputs or outputs that are 1."""
    return " ".join(str(number) for number, level in enumerate(levels, 1) if level) or "none"


def status_text(status: Status) -> str:
    """For people."""
    rows = [("motor", "position", "state")]
    rows += [(str(m.motor), thousands(m.position), m.text) for m in status.motors]
    counts = [f"{thousands(status.line[name])} {LINE_COUNTS[name]}" for name in LINE_COUNTS]
    counts = [text for text in counts if not text.startswith("0 ")]
    facts = {
        "inputs at 1": levels_text(status.inputs),
        "outputs at 1": levels_text(status.outputs) + ", simulated (T41)" * status.simulating,
        "started by": status.cause + ", without stored programs" * status.not_started,
        "late steps": thousands(status.late_steps),
        "line": ("\n" + " " * 14).join(counts) or "nothing yet",
    }
    facts |= {"memory": "refuses commands when full (T40)"} if status.memory_locked else {}
    facts |= {"crystal": "missing: no motion"} if status.no_crystal else {}
    facts |= {"stored": "no programs, the part is too small"} if status.no_store else {}
    facts |= {"steps": UNTIMED} if status.untimed else {}
    lines = [f"{name + ':':<13} {text}" for name, text in facts.items()]
    return "\n".join([table(rows, "rrl"), "", *lines])


def _take(values: Iterator[int], count: int) -> list[int]:
    return [next(values) for _ in range(count)]


def _levels(byte: int, count: int) -> tuple[bool, ...]:
    return tuple(bool(byte >> place & 1) for place in range(count))


def _awaited(code: int) -> Awaited | None:
    number, level = code & ~WAITS_HIGH, int(bool(code & WAITS_HIGH))
    if 1 <= number <= INPUTS:
        return Awaited("input", number, level)
    if number in VARIABLES:
        return Awaited("variable", number, level)
    return {WAITS_TIME: Awaited("time"), WAITS_RELEASE: Awaited("]")}.get(code)


def _motor(
    motor: int, position: int, state: int, error: int, awaited: Awaited | None
) -> MotorStatus:
    moving, running, waiting, stopped, failed, ended, simulated = _levels(state, 7)
    text = ERRORS[error] if error < len(ERRORS) else f"error {error}"
    return MotorStatus(
        motor, position, moving, running, waiting, stopped, failed, ended, text if failed else "",
        awaited if waiting else None, simulated,
    )  # fmt: skip
