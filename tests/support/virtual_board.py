"""The same programs on the simulator and on the virtual board, side by side.

On the simulator programs begin at tick 0, on the board when the line has brought them. So times are
compared from the first pulse of the run, and inputs are scripted in the simulator's time: a board
is run with its inputs only when a first run has told where that time begins.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from chance import epoch, timer_start
from frames import frame
from judge import Event, Steps, judge_files, read_steps, read_trace
from reference import TICK_HZ
from rkm04_tools import board, host, virtual_board

TICKS_PER_MS = TICK_HZ // 1000
BYTE_MS = 10 / 19.2
NODE = 1
EPOCH_MAX = 10**18
"""What the simulator takes."""
READY_MS = 50.0
"""The unit listens by then."""
ANSWER_MS = 40.0
"""Time for an answer of four bytes, and for the silence around it."""

PIN_TIMES_US = {"width_min": 0.5, "gap_min": 0.5, "dir_setup_min": 5.0, "dir_hold_min": 5.0}
"""What the board's drivers need (BOARD_STEP_HIGH_NS and its like): STEP high and low, DIR still."""

SET_COMMAND = b"\x02"
GET_POSITION = b"\x040"
SIGNAL = re.compile(r"^\$var wire 1 (\S+) (\w+) \$end$", re.MULTILINE)
OUTPUT = re.compile(r"bo([1-8])")

Edges = dict[int, list[tuple[int, int]]]
"""Of each output that changes: tick and level."""


@dataclass(frozen=True)
class Message:
    """A Set Command, and how long after the answer to the one before it is sent."""

    motor: int
    text: bytes
    after_ms: float = 0.0


@dataclass(frozen=True)
class Script:
    """What the line sends: lines of a script, and when each message has come, in ms."""

    lines: str
    come_ms: list[float]


def script(messages: Sequence[Message]) -> Script:
    """Send messages one after the other, with time for the answers."""
    at = READY_MS
    lines, come = [], []
    for message in messages:
        at += message.after_ms
        data = frame(NODE, 0, SET_COMMAND + b"%d" % message.motor + message.text)
        lines.append(f"{at:.3f} {data.hex()}\n")
        come.append(at + len(data) * BYTE_MS)
        at = come[-1] + ANSWER_MS
    return Script("".join(lines), come)


def get_positions(at_ms: float) -> str:
    """A line of a script that asks for the positions of all motors."""
    return f"{at_ms:.3f} {frame(NODE, 0, GET_POSITION).hex()}\n"


def together(programs: Mapping[int, bytes]) -> list[Message]:
    """Programs that are held until all have come, and begin on the same tick."""
    held = [Message(motor, b"[" + text) for motor, text in programs.items()]
    return [*held, Message(0, b"]")]


@dataclass
class Simulated:
    """A run of the simulator."""

    summary: dict[str, Any]
    steps: Steps
    events: list[Event]

    @property
    def outputs(self) -> Edges:
        edges: Edges = {}
        for event in self.events:
            if event.event == "out":
                level = int(int(event.value) > 0)
                mine = edges.setdefault(abs(int(event.value)), [])
                if level != (mine[-1][1] if mine else 0):
                    mine.append((event.tick, level))
        return edges

    @property
    def positions(self) -> list[int]:
        return [int(motor["position"]) for motor in self.summary["motors"]]


@dataclass
class Modelled:
    """A run of the virtual board. Ticks count from power-on."""

    summary: dict[str, Any]
    steps: Steps
    folder: Path

    @cached_property
    def changes(self) -> list[tuple[int, str, int]]:
        """All changes of levels, in order: time in ns, signal, level."""
        text = (self.folder / "board.vcd").read_text()
        names = dict(SIGNAL.findall(text))
        found = []
        nanoseconds = 0
        for line in text.partition("$dumpvars")[2].partition("$end")[2].splitlines():
            if line[:1] == "#":
                nanoseconds = int(line[1:])
            elif line[:1] in ("0", "1") and line[1:] in names:
                found.append((nanoseconds, names[line[1:]], int(line[0])))
        return found

    @cached_property
    def outputs(self) -> Edges:
        edges: Edges = {}
        for nanoseconds, signal, level in self.changes:
            if name := OUTPUT.fullmatch(signal):
                tick = nanoseconds * TICK_HZ // 10**9
                edges.setdefault(int(name[1]), []).append((tick, level))
        return edges

    def edges(self, signal: str) -> list[tuple[float, int]]:
        """The changes of a signal: time in ms, and level."""
        return [(ns / 1e6, level) for ns, name, level in self.changes if name == signal]

    @cached_property
    def positions(self) -> list[int]:
        """What the unit has answered to `get_positions`; empty if it has not."""
        rows = [line.split() for line in (self.folder / "log.txt").read_text().splitlines()]
        sent = bytes(int(byte, 16) for _, byte in rows)
        _, asked, answer = sent.rpartition(bytes([0x80 | NODE, 0]) + GET_POSITION)
        found: list[int] = []
        while asked and len(found) < 4:
            end = 1 + answer[0]
            found.append(int(answer[1:end]))
            answer = answer[end:]
        return found

    def vector(self, name: str) -> dict[str, Any]:
        """What an exception has cost."""
        found: dict[str, Any] = next(v for v in self.summary["vectors"] if v["name"] == name)
        return found

    @property
    def late_steps(self) -> int:
        return int(self.summary["watch"]["stm32_late_steps"])


@dataclass(frozen=True)
class VirtualBoard:
    """The virtual board with the image of a board in it; `wires` is what else than what the header
    says is at its pins."""

    program: Path
    image: board.Image
    folder: Path
    wires: str = ""

    def simulate(
        self, programs: Mapping[int, bytes], seconds: float, inputs: str = ""
    ) -> Simulated:
        """Run programs on the simulator, under the judge."""
        steps, trace = self.folder / "simulated.csv", self.folder / "trace.csv"
        arguments = ["--for", str(seconds), "--steps", str(steps), "--trace", str(trace)]
        for motor, text in programs.items():
            file = self.folder / f"{motor}.rks"
            file.write_bytes(text)
            arguments += ["--motor", f"{motor}={file}"]
        arguments += ["--epoch", str(epoch() % EPOCH_MAX)]
        summary = host.simulate([*arguments, *self._file("inputs", inputs)])
        assert judge_files(steps, trace, counter_set=True) == []
        return Simulated(summary, read_steps(steps), read_trace(trace))

    def run(self, lines: str, seconds: float, inputs: str = "", *options: str) -> Modelled:
        """Run the image, with a script for the line and one for the inputs, under the judge."""
        steps = self.folder / "board.csv"
        arguments = ["--elf", str(self.image.file("elf")), "--for", f"{seconds:.6f}"]
        arguments += self._file("pins", self.wires or virtual_board.board_pins(self.image.board))
        arguments += ["--steps", str(steps), "--vcd", str(self.folder / "board.vcd")]
        arguments += ["--line-log", str(self.folder / "log.txt")]
        if "--timer-start" not in options:
            arguments += ["--timer-start", str(timer_start())]
        arguments += ["--watch", "stm32_late_steps", "--stack-limit", "stm32_stack_bottom"]
        arguments += [*self._file("line-script", lines), *self._file("inputs", inputs), *options]
        summary = virtual_board.run(self.program, arguments)
        assert judge_files(steps) == []
        assert pin_times_too_short(summary) == []
        return Modelled(summary, read_steps(steps), self.folder)

    def _file(self, name: str, text: str) -> list[str]:
        if not text:
            return []
        path = self.folder / name
        path.write_text(text)
        return [f"--{name}", str(path)]


def pin_times_too_short(summary: Mapping[str, Any]) -> list[str]:
    """Where STEP or DIR of the reference board moved too soon; a reset may cut a pulse short."""
    resets = sum(summary["resets"].values()) + summary["pin_resets"]
    if resets + summary["supply"]["brown_outs"] > 1:
        return []
    return [
        f"motor {motor['motor']}: {name} {motor[name]} us, less than {least}"
        for motor in summary["motors"]
        for name, least in PIN_TIMES_US.items()
        if motor["pulses"] and motor[name] is not None and motor[name] < least
    ]


def shifted(inputs: Sequence[tuple[float, int, int]], by_ms: float) -> str:
    """Changes of inputs (ms, input, level) as a file, later by some time; those at 0 stay there."""
    rows = [(ms + by_ms if ms else 0.0, number, level) for ms, number, level in inputs]
    return "".join(f"{ms:.6f},{number},{level}\n" for ms, number, level in rows)


def first_tick(steps: Steps) -> int:
    """When the first pulse came."""
    return int(steps.tick.min())


def of_motor(steps: Steps, motor: int) -> tuple[np.ndarray, np.ndarray]:
    """Ticks from the first pulse of the run, and positions, of one motor's pulses."""
    mine = steps.motor == motor
    return steps.tick[mine] - first_tick(steps), steps.position[mine]


def differences(
    simulated: Simulated, modelled: Modelled, waited: Sequence[int] = (), slack_ms: float = 0.0
) -> list[str]:
    """What is not the same of the two, as sentences.

    `waited` are the moves of motor 1 (0 is the first) that an input has let begin: between them and
    what was before there may be a difference of `slack_ms`. A run that its time has ended is
    compared as far as the simulator went.
    """
    found = []
    for motor in range(1, 5):
        found += _steps_differ(simulated, modelled, motor, waited if motor == 1 else (), slack_ms)
    ended = simulated.summary["ended"] == "idle"
    if ended and modelled.positions != simulated.positions:
        found.append(f"positions {modelled.positions}, not {simulated.positions}")
    if modelled.late_steps:
        found.append(f"{modelled.late_steps} late steps")
    return found + _outputs_differ(simulated, modelled)


def _steps_differ(
    simulated: Simulated, modelled: Modelled, motor: int, waited: Sequence[int], slack_ms: float
) -> list[str]:
    ticks, positions = of_motor(simulated.steps, motor)
    real, places = of_motor(modelled.steps, motor)
    if len(real) > len(ticks) and simulated.summary["ended"] == "time":
        real, places = real[: len(ticks)], places[: len(ticks)]
    if len(real) != len(ticks):
        return [f"motor {motor}: {len(real)} pulses, not {len(ticks)}"]
    starts = [e.tick for e in simulated.events if (e.motor, e.event) == (motor, "move")]
    begun = np.array([starts[i] for i in waited], dtype=np.int64) - first_tick(simulated.steps)
    found = []
    for index in np.searchsorted(ticks, begun, side="right"):
        shift = int(real[index] - ticks[index])
        real[index:] -= shift
        if abs(shift) > slack_ms * TICKS_PER_MS:
            found.append(f"motor {motor}: pulse {index} is {shift} ticks late")
    wrong = np.flatnonzero(real != ticks)
    if len(wrong):
        at = int(wrong[0])
        late = int(real[at] - ticks[at])
        found.append(f"motor {motor}: {len(wrong)} pulses differ, first {at} by {late} ticks")
    # The board's driver counts pulses; the unit's counter jumps where a program writes it.
    ways, made = np.diff(positions), np.diff(places)
    if np.any((ways != made) & (np.abs(ways) == 1)):
        found.append(f"motor {motor}: steps in the other direction")
    return found


def _outputs_differ(simulated: Simulated, modelled: Modelled, slack_ms: float = 1.0) -> list[str]:
    """Whether each output changes as often, within a millisecond of the same times."""
    slack = round(slack_ms * TICKS_PER_MS)
    shift = first_tick(modelled.steps) - first_tick(simulated.steps)
    ended = simulated.summary["ended"] == "time"
    last = int(simulated.summary["ticks"]) - slack if ended else int(modelled.steps.tick.max()) * 2
    found = []
    wanted, made = simulated.outputs, modelled.outputs
    for number in sorted({*wanted, *made}):
        due = [(t, level) for t, level in wanted.get(number, []) if t <= last]
        real = [(t - shift, level) for t, level in made.get(number, []) if t - shift <= last]
        if [level for _, level in real] != [level for _, level in due]:
            found.append(f"output {number}: {real}, not {due}")
            continue
        late = [abs(r - d) for (r, _), (d, _) in zip(real, due, strict=True)]
        if max(late, default=0) > slack:
            found.append(f"output {number} is {max(late)} ticks off")
    return found
