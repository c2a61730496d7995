"""How long a vector file takes and how fast it becomes, by the planner of the firmware.

The program `gve134-host plan` reads the lines while they are being written.
"""

from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

from rkm04_tools import child
from rkm04_tools.failure import Failure
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.gcode.axes import Mill

PIECE_LETTERS = 1 << 16


@dataclass(frozen=True)
class Previewed:
    """What the planner says of a file whose lines come in time, at the speeds that it orders."""

    vectors: int
    chains: int
    """Motions from a stand to a stand."""
    seconds: float
    """Of motion, with the pauses between chains."""
    peak_mm_per_s: float
    """Of X, Y and Z together."""
    peaks: list[float]
    """Of each axis, pulses/s."""
    runs: int
    """Reference runs, which take as long as they take."""
    pauses: int
    """For a person."""


class Preview:
    """The planner at work."""

    def __init__(self, mill: Mill, is_wanted: bool = True, course: Path | None = None) -> None:
        """`course`: a file that gets the course of X and Y, for `draw_course`."""
        self._pieces: list[str] = []
        self._letters = 0
        self._process: subprocess.Popen[bytes] | None = None
        if is_wanted:
            more = [str(course)] if course else []
            scales = [str(float(axis.steps_per_unit)) if axis else "1" for axis in mill.axes[:3]]
            self._process = subprocess.Popen(
                [str(host.program_path()), "plan", *scales, *more],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env=child.bound(),
            )

    def __enter__(self) -> Preview:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.communicate()

    def put(self, text: str) -> None:
        """Let it read the next lines."""
        if self._process is None:
            return
        self._pieces.append(text)
        self._letters += len(text)
        if self._letters > PIECE_LETTERS:
            self._pass_on()

    def end(self) -> Previewed | None:
        """There are no more lines; None where no preview was wanted."""
        if self._process is None:
            return None
        self._pass_on()
        answer, complaint = self._process.communicate()
        if self._process.returncode:
            raise Failure(complaint.decode(errors="replace").strip() or "the planner has ended")
        return Previewed(**json.loads(answer))

    def _pass_on(self) -> None:
        """A planner that has ended is told of by `end`."""
        process = self._process
        if process is not None and process.stdin is not None:
            try:
                process.stdin.write("".join(self._pieces).encode())
                process.stdin.flush()
            except BrokenPipeError:
                pass
        self._pieces.clear()
        self._letters = 0


def draw_course(course: Path, title: str, picture: Path) -> None:
    """Draw the path in X and Y, in mm, coloured by the speed that is planned."""
    import numpy as np

    from rkm04_tools.gve134 import xy

    x, y, seconds = np.fromfile(course).reshape(-1, 3).T
    speed = np.hypot(np.diff(x, prepend=0.0), np.diff(y, prepend=0.0)) / seconds
    units = xy.Units("mm", "mm/min", False)
    xy.draw(xy.Path2(x, y, 60 * speed), title, picture, units)
