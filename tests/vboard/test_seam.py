"""What the seam gives a unit with a line of full duplex, at the pins of the reference board.

The image (images/seam_main.c) stands on hal/stm32 as the GVE134 image does, and does one thing
after the other. What is expected comes from the README of the board and from hal/include.
"""

from __future__ import annotations

import os
import random
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from rkm04_tools import board, virtual_board
from virtual_board import Modelled
from wires import wires

UNIT = "gve134"
EVERY_RATE = (38_400, 57_600, 115_200, 230_400, 460_800, 921_600)
RATES = EVERY_RATE if "RKM04_LONG" in os.environ else (38_400, 115_200, 921_600)
MOTORS = range(1, 5)
START_MS = 50.0
BEGIN_MS, ACT_MS, ACTS = 40.0, 5.0, 16
TOP_INTERVAL = 420
"""Ticks: 200 000 steps/s."""
PULSE_US = 2.5
REST = 0xFF
"""Polarity: all rising, none turned."""


@dataclass
class Seen(Modelled):
    """A run of the image."""

    @property
    def echo(self) -> list[str]:
        """What was sent back, in hexadecimal; * after what nobody could read."""
        return [row.split()[1] for row in (self.folder / "log.txt").read_text().splitlines()]

    @property
    def broken(self) -> set[int]:
        """The numbers of the bytes that were broken."""
        words = self.summary["watch"]["seam_broken"]
        return {32 * i + j for i, word in enumerate(words) for j in range(32) if word >> j & 1}


Run = Callable[..., Seen]


@pytest.fixture
def run(program: Path, tmp_path: Path) -> Run:
    """Run the image with constants, at a rate, with bytes on the line."""

    def make(
        line: str = "", ms: float = 130.0, baud: int = 115_200, wires: str = "", **constants: Any
    ) -> Seen:
        image = board.build(board.DEFAULT_BOARD, "seam_image", UNIT, baud)
        elf = image.folder / "bin" / f"{image.name}-seam.elf"
        (tmp_path / "pins").write_text(wires or virtual_board.board_pins(image.board, UNIT))
        (tmp_path / "line").write_text(line)
        options = ["--elf", str(elf), "--pins", str(tmp_path / "pins"), "--baud", str(baud)]
        options += ["--line-script", str(tmp_path / "line"), "--for", f"{ms / 1000:.6f}"]
        for option, name in (("steps", "board.csv"), ("vcd", "board.vcd"), ("line-log", "log.txt")):
            options += [f"--{option}", str(tmp_path / name)]
        for name in ("stm32_late_steps", "seam_heard", "seam_broken"):
            options += ["--watch", name]
        for name, value in constants.items():
            options += ["--set", f"seam_{name}={value.hex()}"]
        return Seen(virtual_board.run(program, options), None, tmp_path)  # type: ignore[arg-type]

    return make


def words(*values: int) -> bytes:
    return struct.pack(f"<{len(values)}I", *values)


def acts(values: Sequence[int], rest: int = 0) -> bytes:
    """A byte for each act."""
    return bytes([*values, *[rest] * (ACTS - len(values))])


def script(data: Sequence[int], marks: dict[int, str] | None = None) -> str:
    """Bytes back to back, some of them damaged."""
    damage = marks or {}
    shown = [f"{byte:02X}{damage.get(i, '')}" for i, byte in enumerate(data)]
    return f"{START_MS} {' '.join(shown)}\n"


# --- the line ---


@pytest.mark.parametrize("baud", RATES)
def test_every_byte_value_goes_both_ways_at_once(run: Run, baud: int) -> None:
    data = [*range(256), *reversed(range(256))]
    seen = run(script(data), START_MS + 2 * len(data) * 10_000 / baud, baud)

    assert seen.echo == [f"{byte:02X}" for byte in data]
    assert seen.broken == set()
    assert seen.summary["line"]["overruns"] == seen.summary["line"]["collisions"] == 0
    assert abs(seen.summary["line"]["baud"] / baud - 1) < 0.002


@pytest.mark.parametrize("intervals", [(420, 420, 420, 420), (420, 421, 423, 427)])
def test_no_byte_is_lost_while_four_motors_make_200_000_steps_a_second(
    run: Run, intervals: tuple[int, ...]
) -> None:
    data = list(random.Random(1).randbytes(3500))
    seen = run(script(data), 95.0, 921_600, interval_ticks=words(*intervals))

    assert seen.summary["watch"]["seam_heard"] == len(data)
    assert seen.echo == [f"{byte:02X}" for byte in data[: len(seen.echo)]]
    assert len(seen.echo) > 3000
    assert seen.broken == set()
    assert seen.late_steps == 0
    assert seen.summary["line"]["overruns"] == 0
    for motor, interval in zip(seen.summary["motors"], intervals, strict=True):
        assert motor["pulses"] == pytest.approx(90_000 * 84 / interval, rel=0.05)
        assert motor["width_min"] == pytest.approx(PULSE_US, abs=0.001)
        assert motor["period_min"] == pytest.approx(interval / 84, abs=0.001)


@pytest.mark.parametrize("seed", range(4))
def test_no_byte_with_an_error_is_taken_for_good(run: Run, seed: int) -> None:
    chance = random.Random(seed)
    baud = chance.choice(RATES)
    data = list(chance.randbytes(1500))
    bad = {i: chance.choice("*~") for i in range(len(data)) if chance.random() < 0.02}
    intervals = words(TOP_INTERVAL, 500, 600, 700)
    ms = START_MS + len(data) * 10_000 / baud + 10
    seen = run(script(data, bad), ms, baud, interval_ticks=intervals)

    assert seen.summary["watch"]["seam_heard"] == len(data)
    assert seen.broken >= bad.keys()
    assert max(min(abs(i - j) for j in bad) for i in seen.broken) < 0.1 * baud / 1000 + 3


def test_an_error_leaves_what_comes_after_a_silence_good(run: Run) -> None:
    line = "50 21 30 50*\n60 21 30 50 46 0D\n70 21*\n80 30 31\n"
    seen = run(line, 90.0, 921_600)

    assert seen.broken >= {2, 8}
    assert seen.broken <= {0, 1, 2, 8}
    assert seen.summary["watch"]["seam_heard"] == 11


def test_the_driver_of_the_line_is_on_for_ever(run: Run) -> None:
    (pin,) = (wire.pin for wire in wires(board.DEFAULT_BOARD) if wire.signal == "LINE_DE")
    seen = run("50 21\n", 60.0, wires=f"led5 P{pin.removeprefix('P')}\nline USART1\n")

    assert [level for _, level in seen.edges("led5")] == [1]


def test_a_byte_wakes_main_soon_enough_for_an_answer(run: Run) -> None:
    seen = run("50 21\n53.4 22\n", 60.0, 38_400)
    log = [row.split() for row in (seen.folder / "log.txt").read_text().splitlines()]

    late = [float(ms) - at - 10 / 38.4 for (ms, _), at in zip(log, (50, 53.4), strict=True)]
    assert max(late) < 0.6


# --- PWM and LEDs ---


def test_the_pwm_is_on_for_so_many_thousandths_of_each_millisecond(run: Run) -> None:
    values = [1, 500, 999, 1000, 250, 0]
    seen = run(pwm=words(*values, *[0] * (ACTS - len(values))))
    edges = seen.edges("pwm")

    def high_us(begin_ms: float, end_ms: float) -> float:
        now, last, total = 0, begin_ms, 0.0
        for ms, level in [*edges, (end_ms, 0)]:
            if ms > begin_ms:
                total += (min(ms, end_ms) - last) * now * 1000
                last = min(ms, end_ms)
            now = level
        return total

    begin = edges[0][0]
    for number, permille in enumerate(values):
        from_ms = begin + ACT_MS * number + 1
        assert high_us(from_ms, from_ms + 3) == pytest.approx(3 * permille, abs=0.1)
    rises = [ms for ms, level in edges if level and ms < begin + 4]
    assert rises[1] - rises[0] == pytest.approx(1, abs=0.001)
    assert high_us(0, begin - 0.001) == 0


def test_the_pwm_changes_between_its_periods(run: Run) -> None:
    values = [500, 0, 1000, 0, 1000, 0]
    seen = run(pwm=words(*values, *[0] * (ACTS - len(values))))
    period = [ms for ms, level in seen.edges("pwm") if level][1]
    whole = [ms for ms, _ in seen.edges("pwm") if ms > period + ACT_MS]
    apart = [(ms - period) % 1 for ms in whole]

    assert len(whole) == 4
    assert [min(each, 1 - each) for each in apart] == pytest.approx([0] * 4, abs=0.002)


def test_the_pwm_is_0_in_a_fault(run: Run) -> None:
    seen = run(pwm=words(*[1000] * ACTS), fails=words(3), ms=60.0)
    edges = seen.edges("pwm")

    assert sum(seen.summary["resets"].values()) > 1
    assert [level for _, level in edges[:2]] == [1, 0]
    assert edges[1][0] - edges[0][0] == pytest.approx(3 * ACT_MS, abs=1.1)


@pytest.mark.parametrize("led", range(8))
def test_each_led_is_lit_by_itself(run: Run, led: int) -> None:
    seen = run(leds=acts([1 << led]), ms=60.0)
    names = [*(f"m{motor}_led" for motor in MOTORS), *(f"led{number}" for number in range(5, 9))]
    lit = {name: [level for _, level in seen.edges(name)] for name in names}

    assert lit == {name: [1, 0] if name == names[led] else [] for name in names}


# --- levels of STEP and DIR ---


WIRES = [*(f"m{motor}_step" for motor in MOTORS), *(f"m{motor}_dir" for motor in MOTORS)]
"""In the order of the bits of a polarity."""


@pytest.mark.parametrize("bit", range(8))
def test_a_polarity_changes_the_level_of_one_wire_that_stands_once(run: Run, bit: int) -> None:
    seen = run(polarity=acts([REST, REST, REST ^ 1 << bit, REST ^ 1 << bit], REST), ms=75.0)
    changes = {wire: seen.edges(wire) for wire in WIRES}
    own = changes.pop(WIRES[bit])

    assert [level for _, level in own] == [1, 0]
    assert own[1][0] - own[0][0] == pytest.approx(2 * ACT_MS, abs=0.5)
    assert not any(changes.values())


@pytest.mark.parametrize("motor", MOTORS)
def test_the_levels_of_one_motor_are_those_that_its_driver_wants(run: Run, motor: int) -> None:
    """It counts falling edges, and its DIR is turned; it stays beside the others."""
    pins = virtual_board.board_pins(board.DEFAULT_BOARD, UNIT)
    mine = (f"m{motor}_step ", f"m{motor}_dir ")
    lines = [f"{line} low" if line.startswith(mine) else line for line in pins.splitlines()]
    seen = run(
        polarity=acts([], REST ^ 1 << (motor - 1) ^ 16 << (motor - 1)),
        steps=words(7), interval_ticks=words(8400, 8400, 8400, 8400),
        wires="\n".join(lines) + "\n", ms=BEGIN_MS + 7 * ACT_MS,
    )  # fmt: skip
    found = {each["motor"]: each for each in seen.summary["motors"]}
    own, other = found[motor], found[motor % 4 + 1]

    assert other["pulses"] == 7 * 7
    assert other["position"] == own["position"] == 7
    assert own["pulses"] == other["pulses"]
    assert own["width_min"] == pytest.approx(PULSE_US, abs=0.001)
    assert own["dir_setup_min"] >= 5
    assert own["dir_hold_min"] >= 5
