"""`sim --target stm32`: plays a vector file to the image of a board, on the virtual board.

The simulator has played it before, at the same rate of the line: that tells what is wrong with the
inputs, and how many pulses there should be.
"""

from __future__ import annotations

import json
import re
from argparse import Namespace
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rkm04_tools import board, sim_board, sim_talk, target_run
from rkm04_tools.failure import Failure
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.board_player import Player, lines_of
from rkm04_tools.gve134.client_options import BAUD_DEFAULT, BAUDS
from rkm04_tools.gve134.report import counts_text, end_text, lines_notes
from rkm04_tools.sim_files import Outputs
from rkm04_tools.sim_target import TARGET, require_no
from rkm04_tools.source import Source
from rkm04_tools.table import table
from rkm04_tools.virtual_board import Talk

UNIT = "gve134"
SPARE_SECONDS = 1.0
LEVEL = re.compile(rb"^(\s*\d+(?:\.\d+)?\s*,\s*\d+\s*,\s*)([01])", re.MULTILINE)


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
    waves = sim_talk.waves(rig, outputs)
    played = play(rig, source, baud, float(options.seconds), inputs, *waves)
    sim_talk.write_files(rig, outputs)
    return simulated, played


def play(
    rig: target_run.Rig, source: Source, baud: int, seconds: float,
    inputs: Path | None = None, *more: str,
) -> Played:  # fmt: skip
    """Play a file to the image of a rig, from `sim_board.READY_MS` after power-on."""

    def host_of(talk: Talk) -> tuple[Player, bool]:
        player = Player(talk, source, baud)
        return player, player.play(seconds)

    changed = levels(inputs.read_bytes()) if inputs else None
    told = ("--baud", str(baud), *more)
    ran, (player, ended) = sim_talk.play(
        rig, seconds + SPARE_SECONDS, host_of, *told, inputs=changed
    )
    return Played(ran, player, ended)


def levels(inputs: bytes) -> bytes:
    """An inputs file as the virtual board has it: 1 is an input that is closed."""
    return LEVEL.sub(lambda found: found[1] + (b"1" if found[2] == b"0" else b"0"), inputs)


def as_json(
    name: str, simulated: Mapping[str, Any], played: Played, options: Namespace
) -> str:  # fmt: skip
    """For scripts."""
    facts = sim_talk.facts(name, simulated, played.ran, options)
    axes = sim_talk.axes(simulated, played.ran)
    return json.dumps({**facts, "axes": axes, **course(played)}, indent=2)


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
    rows = map(sim_talk.row, sim_talk.axes(simulated, played.ran))
    told = course(played)
    began = f"the first line went out {sim_board.READY_MS:g} ms after power-on"
    lines = [counts_text(told), end_text(told, limit), *lines_notes(told), began]
    return "\n".join(
        [table([sim_talk.HEAD, *rows], "rrrr"), "", *lines, *sim_board.cost(played.ran.summary)]
    )
