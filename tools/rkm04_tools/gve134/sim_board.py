"""`sim --target stm32`: plays a vector file to the image of a board, on the virtual board.

The simulator has played it before, at the same rate of the line: that tells what is wrong with the
inputs, and how many pulses there should be.
"""

from __future__ import annotations

import json
import re
import shutil
from argparse import Namespace
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rkm04_tools import board, sim_board, target_run
from rkm04_tools.failure import NOT_SO, Failure, finished_or_absent, writing_failed
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.board_player import Player, lines_of
from rkm04_tools.gve134.client_options import BAUD_DEFAULT, BAUDS
from rkm04_tools.gve134.report import AXES, counts_text, end_text, lines_notes
from rkm04_tools.sim_files import Outputs
from rkm04_tools.sim_target import TARGET, require_no
from rkm04_tools.source import Source
from rkm04_tools.table import table, thousands

UNIT = "gve134"
SPARE_SECONDS = 1.0
LEVEL = re.compile(rb"^(\s*\d+(?:\.\d+)?\s*,\s*\d+\s*,\s*)([01])", re.MULTILINE)
HEAD = ("axis", "pulses", "on the simulator", "forward less backward")


@dataclass(frozen=True)
class Played:
    """What became of a file on the board. `ended`: whether all was answered and the axes stand."""

    ran: target_run.Ran
    player: Player
    ended: bool


def require_possible(options: Namespace, outputs: Outputs, source: Source) -> None:
    """Refuse what only the simulator can do."""
    require_no({"trace": outputs.trace, "plot": outputs.plot, "xy": outputs.xy})
    rates = list(map(str, BAUDS))
    if options.baud is not None and options.baud not in rates:
        raise Failure(
            f"--baud {options.baud}: images for {TARGET} have {', '.join(rates)}; choose one"
        )
    for _ in lines_of(source):
        pass


def simulate(
    source: Source, inputs: Path | None, outputs: Outputs, options: Namespace, folder: Path
) -> tuple[dict[str, Any], Played]:
    """Play the file on both; write the files of the board."""
    baud = int(options.baud or BAUD_DEFAULT)
    script = folder / "script.gve"
    script.write_text(source.text, "utf-8", "surrogatepass", newline="")
    arguments = [str(script), "--for", options.seconds, "--baud", str(baud)]
    simulated = host.simulate([*arguments, *(["--inputs", str(inputs)] if inputs else [])])
    rig = target_run.rig(folder, options.board or board.DEFAULT_BOARD, UNIT, baud)
    played = play(rig, source, baud, float(options.seconds), inputs)
    for name, path in (("steps.csv", outputs.steps), ("board.vcd", outputs.vcd)):
        if path:
            _copy(folder / name, path)
    return simulated, played


def play(
    rig: target_run.Rig, source: Source, baud: int, seconds: float,
    inputs: Path | None = None, *more: str,
) -> Played:  # fmt: skip
    """Play a file to the image of a rig, from `sim_board.READY_MS` after power-on."""
    options = ["--baud", str(baud), "--vcd", str(rig.folder / "board.vcd"), *more]
    if inputs:
        changed = rig.folder / "levels.csv"
        changed.write_bytes(sim_board.later(levels(inputs.read_bytes()), sim_board.READY_MS))
        options += ["--inputs", str(changed)]
    length = sim_board.READY_MS / 1000 + seconds + SPARE_SECONDS
    with rig.talk(length, *options, steps=True) as talk:
        while talk.ms < sim_board.READY_MS:
            talk.until(sim_board.READY_MS)
        player = Player(talk, source, baud)
        ended = player.play(seconds)
        ran = target_run.Ran(talk.end(), rig.folder)
    if ran.summary["resets"]["watchdog"]:
        raise Failure("the image was reset by its watchdog; what it did then is not told", NOT_SO)
    return Played(ran, player, ended)


def levels(inputs: bytes) -> bytes:
    """An inputs file as the virtual board has it: 1 is an input that is closed."""
    return LEVEL.sub(lambda found: found[1] + (b"1" if found[2] == b"0" else b"0"), inputs)


def _copy(made: Path, path: Path) -> None:
    try:
        with finished_or_absent(path) as whole, made.open("rb") as source, whole.open("wb") as out:
            shutil.copyfileobj(source, out)
    except OSError as error:
        raise writing_failed(path, error) from None


def as_json(
    name: str, simulated: Mapping[str, Any], played: Played, options: Namespace
) -> str:  # fmt: skip
    """For scripts."""
    summary = played.ran.summary
    axes = [
        {
            "axis": axis["axis"],
            "pulses": motor["pulses"],
            "pulses_simulated": axis["pulses"],
            "position": motor["position"],
        }
        for axis, motor in zip(simulated["axes"], summary["motors"], strict=True)
    ]
    facts = {
        "file": name,
        "target": "stm32",
        "board": options.board or board.DEFAULT_BOARD,
        "model": summary["model"],
        "began_ms": sim_board.READY_MS,
        "seconds": summary["microseconds"] / 1e6,
        "seconds_simulated": simulated["seconds"],
        "load": summary["load"],
        "late_steps": played.ran.late,
        "step_interrupt": sim_board.step_interrupt(summary),
        "axes": axes,
        **course(played),
    }
    return json.dumps(facts, indent=2)


def course(played: Played) -> dict[str, Any]:
    """What has become of the lines, in the words of the simulator's summary."""
    player = played.player
    stuck = None
    if player.stuck is not None:
        line, reason = player.stuck
        stuck = {"line": line.number, "command": line.text, "reason": reason}
    return {
        "ended": "idle" if played.ended else "time",
        **asdict(player.counts),
        "stuck": stuck,
        "answers": [asdict(answer) for answer in player.told],
        "answers_more": 0,
        "refused": sum(answer.refused for answer in player.told),
    }


def summary(simulated: Mapping[str, Any], played: Played, limit: str) -> str:
    """The table of the axes, what was sent, and what the board had to do for it."""
    motors: Sequence[Mapping[str, Any]] = played.ran.summary["motors"]
    rows = [
        (axis, *map(thousands, (motor["pulses"], there["pulses"], motor["position"])))
        for axis, motor, there in zip(AXES, motors, simulated["axes"], strict=True)
    ]
    told = course(played)
    began = f"the first line went out {sim_board.READY_MS:g} ms after power-on"
    lines = [counts_text(told), end_text(told, limit), *lines_notes(told), began]
    return "\n".join(
        [table([HEAD, *rows], "rrrr"), "", *lines, *sim_board.cost(played.ran.summary)]
    )
