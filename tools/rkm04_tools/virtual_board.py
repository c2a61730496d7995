"""The C program `rkm04-vboard`: the image of a board, run instruction by instruction.

This module says which signal is on which pin, starts the program, and reads what it tells. It is
there only where libunicorn and libcapstone are.
"""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from rkm04_tools import child, host
from rkm04_tools.board import UNIT, header_of, is_full_duplex
from rkm04_tools.board_header import Board
from rkm04_tools.failure import NOT_SO, Failure

PROGRAM = "rkm04-vboard"
REPLY = re.compile(r"\d+\.\d+ [0-9A-F]*\n")
SAY_BYTES = 4096
MODEL = "modelled: P = 3, 5 wait states"

# The names of a board header, and those of the virtual board.
NAMES = {
    "STEP": "m{}_step", "DIR": "m{}_dir", "LED": "m{}_led", "BI": "bi{}", "BO": "bo{}",
    "S1": "s1_{}", "EN": "m{}_en",
}  # fmt: skip

MORE_LEDS = {f"LED_{number}": f"led{number}" for number in range(5, 9)}
"""LEDs that belong to no motor."""

LEVELS = {"EN": "ENABLE"}
"""As a board header names the level of a kind, where not as its wires."""


def _low(level: str) -> str:
    return " low" if level == "0U" else ""


def pins(board: Board, unit: str = UNIT) -> str:
    """The file that says which signal is on which pin. A line of full duplex has two wires, and
    nobody switches its driver."""
    lines = []
    unused = (
        {"LINE_DE", *(f"S1_{number}" for number in range(1, 5))} if is_full_duplex(unit) else set()
    )
    for pin in board.pins:
        if pin.signal in unused:
            continue
        kind, _, which = pin.signal.partition("_")
        level = board.values.get(f"BOARD_{LEVELS.get(kind, kind)}_LEVEL", "1U")
        if pin.signal == "LINE_DE":
            lines.append(f"de P{pin.pin}")
        elif kind == "PWM" or pin.signal in MORE_LEDS:
            lines.append(f"{MORE_LEDS.get(pin.signal, 'pwm')} P{pin.pin}{_low(level)}")
        elif kind in NAMES:
            number = "1" if which == "ALL" else which
            lines.append(f"{NAMES[kind].format(number)} P{pin.pin}{_low(level)}")
    usart = board.values["BOARD_USART"].rstrip("U")
    return "\n".join([*lines, f"line USART{usart}", ""])


def board_pins(name: str, unit: str = UNIT) -> str:
    """The same of a board by its name."""
    return pins(header_of(name), unit)


def program_path() -> Path:
    """Where the program was built: beside that of the simulator."""
    path = host.program_path().with_name(PROGRAM)
    if not path.is_file():
        hint = "apt-get install libunicorn-dev libcapstone-dev pkg-config, then try again"
        raise Failure(f"{PROGRAM} is not built, as its libraries are missing: {hint}")
    return path


def run(program: Path, arguments: Sequence[str]) -> dict[str, Any]:
    """Run an image; the answer is the summary."""
    done = subprocess.run(
        [str(program), *arguments],
        capture_output=True, text=True, errors="replace", env=child.bound(),
    )  # fmt: skip
    return _summary(done.returncode, done.stdout, done.stderr)


class Talk:
    """An image that runs with a client on its line, in virtual time: `--lockstep`.

    Time passes in `until` only.
    """

    def __init__(self, program: Path, arguments: Sequence[str]) -> None:
        self.ms = 0.0
        self._process = subprocess.Popen(
            [str(program), *arguments],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            text=True, errors="replace", env=child.bound(),
        )  # fmt: skip

    def __enter__(self) -> Talk:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._process.kill()
        self._process.communicate()

    def say(self, data: bytes) -> None:
        """Put bytes onto the line; it takes them one after the other."""
        for first in range(0, len(data), SAY_BYTES):
            self._order(f"say {data[first : first + SAY_BYTES].hex()}")

    def wire(self, text: str) -> None:
        """Lead a wire from one pin to another, as `PA0=PB6`; `none=PB6` takes it off."""
        self._order(f"wire {text}")

    def until(self, ms: float) -> bytes:
        """Let time go on until then, or until the unit has sent something, which is returned."""
        self._order(f"until {max(ms, 0.0):.6f}")
        assert self._process.stdout
        reply = self._process.stdout.readline()
        if not REPLY.fullmatch(reply):
            _, complaint = self._process.communicate()
            _summary(self._process.returncode, reply, complaint)
            raise Failure(f"the time of the run on {PROGRAM} is over", NOT_SO)
        at, _, heard = reply.rstrip("\n").partition(" ")
        # A cycle may begin a little before the time that was asked for.
        self.ms = float(at) if heard else max(ms, float(at))
        return bytes.fromhex(heard)

    def end(self) -> dict[str, Any]:
        """End the run; the answer is the summary."""
        out, complaint = self._process.communicate("end\n")
        return _summary(self._process.returncode, out, complaint)

    def _order(self, text: str) -> None:
        assert self._process.stdin
        with suppress(BrokenPipeError):
            self._process.stdin.write(f"{text}\n")
            self._process.stdin.flush()


def _summary(status: int, out: str, complaint: str) -> dict[str, Any]:
    if status != 0:
        line = complaint.strip().rpartition("\n")[2].removeprefix(f"{PROGRAM}: ")
        raise Failure(line or f"{PROGRAM} ended with status {status}", NOT_SO)
    answer = json.loads(out)
    if not isinstance(answer, dict):
        raise Failure(f"{PROGRAM} did not answer with an object; build it again")
    return answer
