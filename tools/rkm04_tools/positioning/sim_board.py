"""`sim --target stm32`: plays a script to the image of a board, on the virtual board, by its line.

The simulator has played it before: that tells what is wrong with the inputs, how many pulses there
should be, and when the axes should stand.
"""

from __future__ import annotations

import json
from argparse import Namespace
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rkm04_tools import board, sim_board, sim_talk, target_run
from rkm04_tools.positioning import board_line, host
from rkm04_tools.positioning.board_player import Player, shown
from rkm04_tools.positioning.board_script import Line, lines_of
from rkm04_tools.positioning.client_options import RATES
from rkm04_tools.positioning.report import end_text, lines_notes, state_of
from rkm04_tools.positioning.state import mm_text
from rkm04_tools.sim_files import Outputs
from rkm04_tools.source import Source
from rkm04_tools.table import table
from rkm04_tools.virtual_board import Talk

UNIT = "positioning"
BAUD = RATES[-1]
"""What the line has if nothing else is said: lines of a script are often some ms apart."""
SPARE_SECONDS = 4.0
"""For the answer to STORE, and the last look at the axes."""
MS_DECIMALS = 3
HEAD = (*sim_talk.HEAD, "position mm", "at the end")
LOOKED_AT = ("status", "error", "flags", "captures", "position_um")


@dataclass(frozen=True)
class Played:
    """What became of a script on the board. `ended`: all was answered, and the axes stand."""

    ran: target_run.Ran
    player: Player
    lines: list[Line]
    baud: int
    ended: bool


def simulate(
    source: Source, script: Path, inputs: Path | None, outputs: Outputs, options: Namespace
) -> tuple[dict[str, Any], Played]:
    """Play the script on both; write the files of the board."""
    given = ["--inputs", str(inputs)] if inputs else []
    simulated = host.simulate([str(script), "--for", options.seconds, *given])
    rig = target_run.rig(script.parent, options.board or board.DEFAULT_BOARD, UNIT)
    played = _play(rig, source, inputs, outputs, options, simulated["seconds"])
    sim_talk.write_files(rig, outputs)
    return simulated, played


def _play(
    rig: target_run.Rig, source: Source, inputs: Path | None, outputs: Outputs,
    options: Namespace, rests_seconds: float,
) -> Played:  # fmt: skip
    baud, seconds = options.baud or BAUD, float(options.seconds)
    lines = list(lines_of(source.text))

    def master_of(talk: Talk) -> tuple[Player, bool]:
        player = Player(talk, source.name, lines, baud)
        return player, player.play(seconds, rests_seconds)

    ran, (player, ended) = sim_talk.play(
        rig, seconds + SPARE_SECONDS, master_of,
        *board_line.options(rig, baud), *sim_talk.waves(rig, outputs),
        inputs=inputs.read_bytes() if inputs else None, steps=outputs.steps is not None,
    )  # fmt: skip
    return Played(ran, player, lines, baud, ended)


def course(simulated: Mapping[str, Any], played: Played) -> dict[str, Any]:
    """What has become of axes and lines, in the words of the simulator's summary."""
    counted = sim_talk.axes(simulated, played.ran)
    looked = (shown(axis) for axis in played.player.axes)
    return {
        "ended": "idle" if played.ended else "time",
        "axes": [
            {**axis, **{name: state[name] for name in LOOKED_AT}}
            for axis, state in zip(counted, looked, strict=True)
        ],
        "executed": played.player.executed,
        "lines": len(played.lines),
        "baud": played.baud,
        "behind_ms": round(played.player.behind_ms, MS_DECIMALS),
        "told": played.player.told,
    }


def as_json(
    name: str, simulated: Mapping[str, Any], played: Played, options: Namespace
) -> str:  # fmt: skip
    """For scripts."""
    facts = sim_talk.facts(name, simulated, played.ran, options)
    return json.dumps({**facts, **course(simulated, played)}, indent=2)


def summary(simulated: Mapping[str, Any], played: Played, limit: str) -> str:
    """The table of the axes, how it ended, and what the board had to do for it."""
    told = course(simulated, played)
    rows = [
        (*sim_talk.row(axis), mm_text(axis["position_um"]), state_of(axis).words)
        for axis in told["axes"]
    ]
    lines = [end_text(told, limit), *lines_notes(told), _times(told)]
    return "\n".join(
        [table([HEAD, *rows], "rrrrrl"), "", *lines, *sim_board.cost(played.ran.summary)]
    )


def _times(told: Mapping[str, Any]) -> str:
    begun = f"the script began {sim_board.READY_MS:g} ms after power-on, at {told['baud']} Bd"
    behind_ms = told["behind_ms"]
    late = f"lines went out up to {behind_ms:.1f} ms after their times"
    return f"{begun}; {late if behind_ms else 'all lines went out at their times'}"
