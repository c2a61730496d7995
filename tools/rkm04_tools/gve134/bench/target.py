"""`bench --target stm32`: the figures of the GVE134 image beside their goals, modelled."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory

from rkm04_tools import board_size, target_run
from rkm04_tools.gve134.bench import answering, saturated, streaming
from rkm04_tools.target_rows import STACK, Goal, rows_of
from rkm04_tools.target_unit import Measure, measure, tell

UNIT = "gve134"
FAST_BD, USUAL_BD = saturated.BAUD, answering.BAUD

MEASURES: Mapping[str, tuple[int, Measure]] = {
    "alike": (FAST_BD, saturated.alike),
    "apart": (FAST_BD, saturated.apart),
    "quick": (FAST_BD, streaming.quick),
    "slow": (USUAL_BD, streaming.slow),
    "answers": (USUAL_BD, answering.figures),
}
"""The rate of the line of each, and what measures."""

FIGURES = [
    Goal("load_alike", "load at 4 x 200 000 pulses/s, 2000 vectors/s, 921 600 Bd saturated, "
         "axes alike", "%", 65, budget="load_saturated_percent"),
    Goal("late_alike", "... late pulses", "pulses", 0),
    Goal("lost_alike", "... bytes lost, commands not done", "", 0),
    Goal("width_alike", "... the shortest pulse", "us", 2.4, at_most=False),
    Goal("load_apart", "load at the same, axes with shares of their own", "%", 65),
    Goal("late_apart", "... late pulses", "pulses", 0),
    Goal("lost_apart", "... bytes lost, commands not done", "", 0),
    Goal("made_quick", "streamed by send, 921 600 Bd, latency 1 ms", "vectors/s", 1999.5, False),
    Goal("least_quick", "... the least in the queue", "vectors", 1, False),
    Goal("late_quick", "... late pulses", "pulses", 0),
    Goal("load_quick", "... load", "%"),
    Goal("made_slow", "streamed by send, 115 200 Bd, latency 16 ms", "vectors/s", 199.5, False),
    Goal("least_slow", "... the least in the queue", "vectors", 64, False),
    Goal("made_slower", "the same, more vectors", "vectors/s"),
    Goal("least_slower", "... the least in the queue", "vectors", 64, False),
    Goal("answer_rest", "from CR to the answer, at most: at rest", "ms", 1),
    Goal("answer_motion", "... at 4 x 200 000 pulses/s, 120 vectors", "ms", 1),
    Goal("answer_change", "... the same, X commands", "ms", 1),
    Goal("answer_halted", "... after a halt, 120 vectors", "ms", 1),
    Goal("answer_memory", "... what writes the memory, with an erase", "ms", 2000),
    Goal("ready_fresh", "power-on to ready, memory never written", "ms", 100),
    Goal("ready_used", "... written 300 times", "ms", 100),
    Goal(STACK, "stack that was used in all runs", "bytes"),
]  # fmt: skip


def run(options: Namespace) -> int:
    """Measure everything and print it."""
    with TemporaryDirectory() as folder:
        rigs = {
            baud: target_run.rig(_folder(folder, baud), unit=UNIT, baud=baud)
            for baud in (USUAL_BD, FAST_BD)
        }
        usual = rigs[USUAL_BD].image
        sizes = asdict(board_size.measure(usual.file("elf"), usual.folder, UNIT))
        figures = measure({name: (rigs[baud], each) for name, (baud, each) in MEASURES.items()})
    return tell(rows_of(FIGURES, figures, sizes, UNIT), options.json)


def _folder(whole: str, baud: int) -> Path:
    folder = Path(whole) / str(baud)
    folder.mkdir()
    return folder
