"""4 x 200 000 pulses/s while not a moment of the line to the unit is free.

Packets of vectors come as often as vectors are made, with questions and settings; the rest of the
time is filled with commands for another unit. All have checksums.
"""

from __future__ import annotations

from dataclasses import dataclass

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.gve134 import answers
from rkm04_tools.gve134.answers import encoded
from rkm04_tools.gve134.bench.lines import LOG, byte_ms, packet, row, said_in
from rkm04_tools.target_figures import Figures
from rkm04_tools.target_run import Rig

BAUD = 921_600
SPEED, ACCEL = 200_000, 8000
STEPS = 100
VECTORS_PER_SECOND = SPEED / STEPS
ALIKE = (STEPS, STEPS, STEPS, STEPS)
APART = (100, -99, 57, 33)
AHEAD = 60
"""Vectors that are there before the flood begins."""
BEGIN_MS, FLOOD_BEGIN_MS = 120.0, 160.0
FLOOD_SECONDS = 1.0
REST_MS = 150.0
PACKET = 16
ASKED = ("P4", f"V{SPEED}", "SR6")
"""With each packet."""
FOREIGN = "!1V200000"


@dataclass(frozen=True)
class Flood:
    """What comes without a pause; how many answers there are to it, and how many vectors in it."""

    data: bytes
    answers: int
    vectors: int


def flood(vector: str, seconds: float) -> Flood:
    """So long."""
    whole = packet([vector] * PACKET, sums=True)
    whole += b"".join(encoded(text, sums=True) for text in ASKED)
    foreign = encoded(FOREIGN, sums=True)
    data, packets = b"", 0
    per_packet = PACKET * 1000 / (byte_ms(BAUD) * VECTORS_PER_SECOND)
    while len(data) * byte_ms(BAUD) < 1000 * seconds:
        if packets * per_packet <= len(data):
            data += whole
            packets += 1
        else:
            data += foreign
    return Flood(data, packets * (1 + len(ASKED)), packets * PACKET)


def measure(rig: Rig, name: str, steps: tuple[int, ...], seconds: float = FLOOD_SECONDS) -> Figures:
    """Flood the line while the axes move."""
    first = [encoded("%+", sums=False)]
    first += [encoded(text, sums=True) for text in (f"A{ACCEL}", f"V{SPEED}", "$1")]
    vector = f"C{','.join(map(str, steps))}"
    sent = flood(vector, seconds)
    line = "".join(row(BEGIN_MS + 3 * i, each) for i, each in enumerate(first))
    ahead = packet([vector] * AHEAD, sums=True)
    line += row(FLOOD_BEGIN_MS, ahead + sent.data)
    begin = FLOOD_BEGIN_MS + len(ahead) * byte_ms(BAUD)
    end = begin + len(sent.data) * byte_ms(BAUD)
    options = ("--baud", str(BAUD), "--line-log", str(rig.folder / LOG))
    measured = rig.run(end / 1000, line, "", *options, "--measure-from", f"{begin:.3f}")
    whole = rig.run((end + REST_MS) / 1000, line, "", *options)
    said = [answers.parsed(each.text, sums=True) for each in said_in(rig.folder)]
    good = sum(each is not None and each.code == answers.DONE for each in said)
    wanted = [(AHEAD + sent.vectors) * each for each in steps]
    if whole.positions != wanted:
        raise Failure(f"{name}: the axes stand at {whole.positions}, not at {wanted}", NOT_SO)
    widths = [motor["width_min"] for motor in whole.summary["motors"]]
    return {
        f"load_{name}": measured.load,
        f"late_{name}": whole.late,
        f"lost_{name}": whole.summary["line"]["overruns"] + len(first) + 1 + sent.answers - good,
        f"width_{name}": min(widths),
        f"interrupt_{name}": measured.step_interrupt["max"],
        "stack_used": max(measured.stack_used, whole.stack_used),
    }


def alike(rig: Rig) -> Figures:
    """All axes step together."""
    return measure(rig, "alike", ALIKE)


def apart(rig: Rig) -> Figures:
    """Axes with shares of their own."""
    return measure(rig, "apart", APART)
