"""`sim --target stm32` of units whose host waits for answers: the image of a board with that host
on its line, in virtual time. What GVE134 and positioning have in common."""

from __future__ import annotations

import shutil
from argparse import Namespace
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from rkm04_tools import board
from rkm04_tools.failure import NOT_SO, Failure, finished_or_absent, writing_failed
from rkm04_tools.sim_board import READY_MS, later, step_interrupt
from rkm04_tools.sim_files import Outputs
from rkm04_tools.table import thousands
from rkm04_tools.target_run import Ran, Rig
from rkm04_tools.virtual_board import Talk

STEPS, VCD = "steps.csv", "board.vcd"
SECONDS_MAX = 1_000_000.0
"""So long the virtual board runs at most."""
HEAD = ("axis", "pulses", "on the simulator", "forward less backward")
Made = TypeVar("Made")


def play(
    rig: Rig, seconds: float, host: Callable[[Talk], Made], *options: str,
    inputs: bytes | None = None, steps: bool = True,
) -> tuple[Ran, Made]:  # fmt: skip
    """Run the image of a rig; from `READY_MS` on a host has its line, for so long at most. What it
    returns comes back beside the run; times of the inputs count from there, too."""
    told = list(options)
    if inputs is not None:
        changed = rig.folder / "levels.csv"
        changed.write_bytes(later(inputs, READY_MS))
        told += ["--inputs", str(changed)]
    length = min(READY_MS / 1000 + seconds, SECONDS_MAX)
    with rig.talk(length, *told, steps=steps) as talk:
        while talk.ms < READY_MS:
            talk.until(READY_MS)
        made = host(talk)
        ran = Ran(talk.end(), rig.folder)
    if ran.summary["resets"]["watchdog"]:
        raise Failure("the image was reset by its watchdog; what it did then is not told", NOT_SO)
    return ran, made


def waves(rig: Rig, outputs: Outputs) -> list[str]:
    """The option that has waveforms written, where they were asked for."""
    return ["--vcd", str(rig.folder / VCD)] if outputs.vcd else []


def write_files(rig: Rig, outputs: Outputs) -> None:
    """Write those that were asked for."""
    for name, path in ((STEPS, outputs.steps), (VCD, outputs.vcd)):
        if path:
            _copy(rig.folder / name, path)


def _copy(made: Path, path: Path) -> None:
    try:
        with finished_or_absent(path) as whole, made.open("rb") as source, whole.open("wb") as out:
            shutil.copyfileobj(source, out)
    except OSError as error:
        raise writing_failed(path, error) from None


def facts(name: str, simulated: Mapping[str, Any], ran: Ran, options: Namespace) -> dict[str, Any]:
    """What is told of each run, for scripts."""
    return {
        "file": name,
        "target": "stm32",
        "board": options.board or board.DEFAULT_BOARD,
        "model": ran.summary["model"],
        "began_ms": READY_MS,
        "seconds": ran.summary["microseconds"] / 1e6,
        "seconds_simulated": simulated["seconds"],
        "load": ran.summary["load"],
        "late_steps": ran.late,
        "step_interrupt": step_interrupt(ran.summary),
    }


def axes(simulated: Mapping[str, Any], ran: Ran) -> list[dict[str, Any]]:
    """What is told of each axis."""
    motors: Sequence[Mapping[str, Any]] = ran.summary["motors"]
    return [
        {
            "axis": axis["axis"],
            "pulses": motor["pulses"],
            "pulses_simulated": axis["pulses"],
            "position": motor["position"],
        }
        for axis, motor in zip(simulated["axes"], motors, strict=True)
    ]


def row(axis: Mapping[str, Any]) -> tuple[str, ...]:
    """What is told of an axis, under `HEAD`."""
    counts = (axis[name] for name in ("pulses", "pulses_simulated", "position"))
    return (str(axis["axis"]), *map(thousands, counts))
