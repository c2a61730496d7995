"""Each wire of a GVE134 unit by itself, at the pin that the README of the board says.

One run moves one wire after the other, its neighbours at rest. What is expected of them comes from
the README of the board and the documents of the unit, never from the header or the driver.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
from rkm04_tools import board, virtual_board
from virtual_board import Modelled
from wires import pins_file

UNIT = "gve134"
INPUTS = range(1, 9)
AXES = range(1, 5)
FIRST_MS = 50.0
APART_MS = 20.0
ACT_MS = 3.0
"""From an input to the questions about it."""

PORT_1 = {1: 0xFE, 2: 0xFD, 3: 0xFB, 4: 0xF7}
PORT_2 = {7: 0xBF, 8: 0x7F}
"""What a port reads while the input alone is closed."""

ON = {0: {"bo1", "bo5", "m4_led"}, 1: {"bo8"}, 2: {"bo6"}, 3: {"bo7"}}
"""By bit of port 0. As delivered, the relay is that of the spindle, and has an LED."""

OUTPUTS_MS = FIRST_MS + APART_MS * len(INPUTS)
SPINDLE_MS = OUTPUTS_MS + APART_MS * len(ON)
MOTORS_MS = SPINDLE_MS + 2 * APART_MS
MOTOR_MS = 40.0
END_MS = MOTORS_MS + MOTOR_MS * len(AXES)


def sent() -> list[tuple[float, str]]:
    """Commands, and when they begin."""
    asks = [(FIRST_MS + APART_MS * i + ACT_MS, "!0I1\r!0I2\r") for i in range(len(INPUTS))]
    acts = [(OUTPUTS_MS + APART_MS * bit, f"!0O0,{0xFF & ~(1 << bit):02X}\r") for bit in ON]
    spindle = [(SPINDLE_MS, "!0O0,FF\r!7V250\r"), (SPINDLE_MS + APART_MS, "!7V0\r")]
    ways = [[n * (axis == each) for each in AXES] for axis in AXES for n in (-3, 2)]
    moves = [f"!0{'LC'[i % 2]}{','.join(map(str, way))}\r" for i, way in enumerate(ways)]
    begins = [MOTORS_MS + MOTOR_MS * (axis - 1) for axis in AXES]
    motions = [(at, "".join(moves[2 * i : 2 * i + 2])) for i, at in enumerate(begins)]
    return [*asks, *acts, *spindle, *motions]


@pytest.fixture(scope="module")
def tour(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Modelled:
    """One after the other: each input, each output, the spindle, each motor there and back."""
    image = board.build(board.DEFAULT_BOARD, what=UNIT)
    folder = tmp_path_factory.mktemp("wires")
    inputs = [
        f"{FIRST_MS + APART_MS * i + at},{number},{level}\n"
        for i, number in enumerate(INPUTS)
        for at, level in ((0, 1), (APART_MS / 2, 0))
    ]
    lines = [f"{at:.3f} {text.encode().hex()}\n" for at, text in sent()]
    (folder / "pins").write_text(pins_file(board.DEFAULT_BOARD, unit=UNIT))
    (folder / "inputs").write_text("".join(inputs))
    (folder / "line").write_text("".join(lines))
    options = ["--elf", str(image.file("elf")), "--for", f"{END_MS / 1000:.6f}"]
    options += ["--baud", "115200", "--pins", str(folder / "pins")]
    options += ["--inputs", str(folder / "inputs"), "--line-script", str(folder / "line")]
    options += ["--line-log", str(folder / "log.txt"), "--vcd", str(folder / "board.vcd")]
    options += ["--watch", "stm32_late_steps"]
    return Modelled(virtual_board.run(program, options), None, folder)  # type: ignore[arg-type]


def window(
    tour: Modelled, begin_ms: float, end_ms: float, but: str = "m3_led"
) -> dict[str, list[int]]:
    """The levels that pins have taken, but for the inputs and the LED of the line's bytes."""
    found: dict[str, list[int]] = {}
    for ns, signal, level in tour.changes:
        if begin_ms <= ns / 1e6 < end_ms and not signal.startswith("bi") and signal != but:
            found.setdefault(signal, []).append(level)
    return found


def answers(tour: Modelled) -> list[str]:
    rows = (tour.folder / "log.txt").read_text().split()[1::2]
    return bytes(int(byte, 16) for byte in rows).decode().rstrip("\r").split("\r")


def test_each_input_is_a_bit_of_its_port(tour: Modelled) -> None:
    ports = [answers(tour)[2 * i : 2 * i + 2] for i in range(len(INPUTS))]

    assert ports == [
        [f"0,{PORT_1.get(number, 0xFF):02X}", f"0,{PORT_2.get(number, 0xFF):02X}"]
        for number in INPUTS
    ]


@pytest.mark.parametrize("number", INPUTS)
def test_each_reference_switch_has_its_led(tour: Modelled, number: int) -> None:
    begin = FIRST_MS + APART_MS * (number - 1)
    seen = window(tour, begin, begin + APART_MS)

    assert seen == ({f"led{number + 4}": [1, 0]} if number in PORT_1 else {})


@pytest.mark.parametrize("bit", ON)
def test_each_bit_of_the_port_has_its_outputs(tour: Modelled, bit: int) -> None:
    begin = OUTPUTS_MS + APART_MS * bit
    seen = window(tour, begin, begin + APART_MS)

    assert {signal for signal, levels in seen.items() if levels == [1]} == ON[bit]
    assert {signal for signal, levels in seen.items() if levels == [0]} == ON.get(bit - 1, set())
    assert all(len(levels) == 1 for levels in seen.values())


def test_the_spindle_has_its_pwm_and_its_output(tour: Modelled) -> None:
    seen = window(tour, SPINDLE_MS + ACT_MS, SPINDLE_MS + APART_MS)
    off = window(tour, SPINDLE_MS + APART_MS + ACT_MS, MOTORS_MS)
    edges = [edge for edge in tour.edges("pwm") if edge[0] < SPINDLE_MS + APART_MS]
    widths = [b - a for (a, level), (b, _) in pairwise(edges) if level]

    assert seen.keys() == {"pwm"}
    assert widths == pytest.approx([0.25] * len(widths), abs=0.001)
    assert len(widths) > 15
    assert not off
    assert tour.edges("bo5")[-1][1] == tour.edges("bo1")[-1][1] == 0


@pytest.mark.parametrize("axis", AXES)
def test_each_axis_has_its_motor_and_run_is_lit(tour: Modelled, axis: int) -> None:
    begin = MOTORS_MS + MOTOR_MS * (axis - 1)
    seen = window(tour, begin, begin + MOTOR_MS)
    steps, backward = 0, False
    for _, signal, level in tour.changes:
        if signal == f"m{axis}_dir":
            backward = bool(level)
        elif signal == f"m{axis}_step" and level:
            steps += -1 if backward else 1

    assert seen == {
        f"m{axis}_dir": [1, 0], f"m{axis}_step": [1, 0] * 5, "m2_led": [1, 0],
    }  # fmt: skip
    assert steps == -1


def test_only_power_is_lit_at_the_start(tour: Modelled) -> None:
    seen = window(tour, 0, FIRST_MS)

    assert {signal: levels for signal, levels in seen.items() if levels[-1]} == {"m1_led": [1]}
