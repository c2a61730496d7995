"""`bench --target stm32`: the figures of the positioning image beside their goals, modelled."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory

from rkm04_tools import board_size, target_run
from rkm04_tools.positioning.bench import loads, reactions
from rkm04_tools.target_rows import STACK, Goal, rows_of
from rkm04_tools.target_unit import Measure, measure, tell

UNIT = "positioning"

MEASURES: Mapping[str, Measure] = {
    "full": loads.full,
    "wide": loads.wide,
    "alone": reactions.alone,
    "fast": reactions.fast,
    "hold": reactions.hold,
    "start": reactions.start,
    "slow": reactions.slow,
    "delivered": reactions.delivered,
    "limit": reactions.limit,
    "limits": reactions.limits,
}

FIGURES = [
    Goal("load_full", "load at 4 x 100 000 steps/s, new feeds every 15 ms, 115 200 Bd",
         "%", 50, budget="load_feeds_percent"),
    Goal("late_full", "... late pulses", "pulses", 0),
    Goal("unanswered_full", "... requests not answered", "", 0),
    Goal("answer_full", "... from a request to its answer, at most", "ms", 20),
    Goal("load_wide", "load at the same, feeds from half of that on", "%", 50),
    Goal("late_wide", "... late pulses", "pulses", 0),
    Goal("unanswered_wide", "... requests not answered", "", 0),
    Goal("begins_alone", "from a request that has come to the ramp, 4 x 100 000 steps/s: a feed",
         "us", 1000),
    Goal("changes_alone", "... to the first pulse at another time", "us", 1000),
    Goal("late_alone", "... late pulses", "pulses", 0),
    Goal("begins_change", "... to the ramp: feeds of all axes", "us", 1000),
    Goal("changes_change", "... to the first pulse at another time", "us", 1000),
    Goal("late_change", "... late pulses", "pulses", 0),
    Goal("begins_hold", "... to the ramp: a hold of all axes", "us", 1000),
    Goal("changes_hold", "... to the first pulse at another time", "us", 1000),
    Goal("late_hold", "... late pulses", "pulses", 0),
    Goal("begins_start", "... to the begin of the motion: a measure and a feed of all axes",
         "us", 1000),
    Goal("late_start", "... late pulses", "pulses", 0),
    Goal("begins_slow", "... to the ramp: feeds of all axes, pulses 512 ms apart", "ms", 1),
    Goal("late_slow", "... late pulses", "pulses", 0),
    Goal("begins_delivered", "... to the ramp at 19 200 Bd: feeds of all axes", "us", 1000),
    Goal("changes_delivered", "... to the first pulse at another time", "us", 1000),
    Goal("late_delivered", "... late pulses", "pulses", 0),
    Goal("begins_limit", "from an edge at a limit input to the ramp, 4 x 100 000 steps/s: one axis",
         "us", 1000),
    Goal("changes_limit", "... to the first pulse at another time", "us", 1000),
    Goal("late_limit", "... late pulses", "pulses", 0),
    Goal("begins_limits", "... to the ramp: all axes", "us", 1000),
    Goal("changes_limits", "... to the first pulse at another time", "us", 1000),
    Goal("late_limits", "... late pulses", "pulses", 0),
    Goal(STACK, "stack that was used in all runs", "bytes"),
]  # fmt: skip


def run(options: Namespace) -> int:
    """Measure everything and print it."""
    with TemporaryDirectory() as folder:
        rig = target_run.rig(Path(folder), unit=UNIT)
        sizes = asdict(board_size.measure(rig.elf, rig.image.folder, UNIT))
        figures = measure({name: (rig, each) for name, each in MEASURES.items()})
    return tell(rows_of(FIGURES, figures, sizes, UNIT), options.json)
