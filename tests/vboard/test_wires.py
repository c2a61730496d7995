"""Each wire of a board by itself, at the pin that its README says.

One run of a board moves one wire after the other, its neighbours at rest; the tests look at what
the pins did. What is expected of them comes from the README of the board and the documents of the
unit, never from the header or the driver.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path

import pytest
from board_talk import Answer, ask, heard
from rkm04_tools import board
from rkm04_tools.board_header import Pin, inputs_without_edges
from rkm04_tools.status import parse_status
from virtual_board import BYTE_MS, Modelled, VirtualBoard
from wires import levels, pins_file, times_us, wires

VERSION, GET_STATUS = b"\x01", b"\xc8"
NUMBERS = range(1, 9)
MOTORS = range(1, 5)
NODES = range(1, 17)
ALL = 0xFF
WALK = [0, *(1 << i for i in range(8)), ALL, *(ALL & ~(1 << i) for i in range(8)), 0]
"""Masks in which each of eight wires is the only one that is 1, then the only one that is 0."""

START_MS = 50.0
APART_MS = 0.2
"""Between changes of inputs: longer than edges are held off for."""
STATUS_MS = 75.0
"""A question for the status, and its answer."""
INPUTS_MS = START_MS
OUTPUTS_MS = INPUTS_MS + STATUS_MS * len(WALK)
MOTORS_MS = OUTPUTS_MS + 250
MOTOR_MS = 80.0
END_MS = MOTORS_MS + MOTOR_MS * len(MOTORS)

Board = Callable[..., VirtualBoard]


@pytest.fixture(scope="module", params=board.names())
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def wired(name: str, program: Path, tmp_path_factory: pytest.TempPathFactory) -> Board:
    """A board with all wires of its README, or without some kinds of them."""
    image = board.build(name)

    def make(*but: str) -> VirtualBoard:
        return VirtualBoard(program, image, tmp_path_factory.mktemp("wires"), pins_file(name, but))

    return make


def walk() -> list[list[tuple[int, int]]]:
    """From mask to mask: the wires that change, and to which level."""
    pairs = pairwise([0, *WALK])
    return [
        [(n, new >> (n - 1) & 1) for n in NUMBERS if (old ^ new) >> (n - 1) & 1]
        for old, new in pairs
    ]


def changes_of_inputs() -> list[tuple[float, int, int]]:
    """One edge after the other: ms, input, level."""
    return [
        (INPUTS_MS + STATUS_MS * i + APART_MS * j, *change)
        for i, changes in enumerate(walk())
        for j, change in enumerate(changes)
    ]


def walk_of_outputs() -> bytes:
    """A program that shows all masks, 3 ms each."""
    words = ["".join(f"{'CT'[level]}{n}" for n, level in changes) for changes in walk()]
    return "W3".join(words).encode()


@pytest.fixture(scope="module")
def tour(wired: Board) -> Modelled:
    """One after the other: each input, each output, each motor 3 steps back and 2 forward."""
    inputs = "".join(f"{ms:.6f},{number},{level}\n" for ms, number, level in changes_of_inputs())
    line = "".join(ask(INPUTS_MS + STATUS_MS * i + 5, GET_STATUS) for i in range(len(WALK)))
    line += ask(OUTPUTS_MS, b"\x021\\" + walk_of_outputs())
    for motor in MOTORS:
        line += ask(MOTORS_MS + MOTOR_MS * (motor - 1), b"\x02%d\\S2000V2000B3RW5F2R" % motor)
    return wired().run(line, END_MS / 1000, inputs)


def told(modelled: Modelled, number: int) -> list[Answer]:
    return [answer for answer in heard(modelled.folder) if answer.message[0] == number]


def mask(bits: Sequence[bool]) -> int:
    return sum(bit << i for i, bit in enumerate(bits))


def test_each_input_is_seen_by_itself(tour):
    seen = [mask(parse_status(answer.message).inputs) for answer in told(tour, GET_STATUS[0])]

    assert seen == WALK


def edge_vector(pin: str) -> str:
    """The interrupt of the edges of a pin, RM0090 12.1.3 and 12.2.5: the pin's number decides."""
    line = int(pin[1:])
    return f"EXTI{line}" if line < 5 else "EXTI9_5" if line < 10 else "EXTI15_10"


def test_each_edge_of_each_input_has_an_interrupt(tour, name):
    """But for those whose line for edges another one has."""
    pins = {wire.signal: wire.pin for wire in wires(name)}
    without = inputs_without_edges([Pin(wire.signal, wire.pin, "") for wire in wires(name)])
    named = [f"BI_{number}" for _, number, _ in changes_of_inputs()]
    due = Counter(edge_vector(pins[signal]) for signal in named if signal not in without)

    assert {n: tour.vector(n)["count"] for n in due} == due


def window(tour: Modelled, begin_ms: float, end_ms: float) -> list[tuple[int, str, int]]:
    """What the unit has changed at its pins; the driver of the line is looked at elsewhere."""
    others = ("bi", "de")
    return [
        change
        for change in tour.changes
        if begin_ms <= change[0] / 1e6 < end_ms
        and not change[1].startswith(others)
        and not change[1].endswith("_en")
    ]


def test_each_output_is_switched_by_itself(tour):
    masks, now, last = [], 0, 0
    for ns, signal, level in window(tour, OUTPUTS_MS, MOTORS_MS):
        bit = 1 << (int(signal.removeprefix("bo")) - 1)
        now = now | bit if level else now & ~bit
        if ns - last > 1e6:
            masks.append(now)
        masks[-1], last = now, ns

    assert masks == WALK[1:]


@pytest.mark.parametrize("motor", MOTORS)
def test_each_motor_has_its_own_step_direction_and_led(tour, motor):
    begin = MOTORS_MS + MOTOR_MS * (motor - 1)
    moved = window(tour, begin, begin + MOTOR_MS)
    signals: dict[str, list[int]] = {}
    steps, backward = [], 0
    for _, signal, level in moved:
        signals.setdefault(signal, []).append(level)
        if signal == f"m{motor}_dir":
            backward = level
        elif signal == f"m{motor}_step" and level:
            steps.append(-1 if backward else 1)

    assert signals == {
        f"m{motor}_dir": [1, 0],
        f"m{motor}_step": [1, 0] * 5,
        f"m{motor}_led": [1, 0] * 2,
    }
    assert steps == [-1, -1, -1, 1, 1]


def test_nothing_moves_at_the_pins_before_it_is_told_to(tour):
    assert window(tour, 0, INPUTS_MS) == []


def test_the_driver_of_the_line_is_on_for_answers_and_at_no_other_time(tour):
    rows = (tour.folder / "log.txt").read_text().splitlines()
    begins = [float(row.split()[0]) for row in rows]
    edges = tour.edges("de")
    driven = [(on, off) for (on, _), (off, _) in zip(edges[::2], edges[1::2], strict=True)]

    assert [level for _, level in edges] == [1, 0] * len(heard(tour.folder))
    for on, off in driven:
        bytes_of_it = [ms for ms in begins if on <= ms < off]
        assert on <= bytes_of_it[0] < on + BYTE_MS
        assert bytes_of_it[-1] + BYTE_MS <= off + 1e-6
    assert len(begins) == sum(sum(on <= ms < off for ms in begins) for on, off in driven)
    assert tour.summary["line"]["unheard"] == tour.summary["line"]["collisions"] == 0


def test_pulses_are_as_wide_and_directions_stand_as_long_as_the_readme_says(tour, name):
    least_us = times_us(name)

    for motor in tour.summary["motors"]:
        assert {k: motor[k] for k, least in least_us.items() if motor[k] < least} == {}, motor


def test_edges_of_steps_take_a_fiftieth_of_the_shortest_pulse_at_most(tour):
    """DS8626: 10 ns with a speed of 1, 100 ns with 0."""
    assert [motor["pin_speed"] for motor in tour.summary["motors"]] == [1, 1, 1, 1]


def test_open_inputs_and_switches_are_off(wired):
    modelled = wired("BI", "S1").run(ask(START_MS, GET_STATUS), (START_MS + STATUS_MS) / 1000)

    (answer,) = heard(modelled.folder)
    assert answer.node == 1
    assert mask(parse_status(answer.message).inputs) == 0


def test_each_address_of_the_switch_is_answered_to_alone(wired):
    line = "".join(ask(START_MS + 25 * i, VERSION, node) for i, node in enumerate(NODES))
    unit = wired()

    answered = {}
    for node in NODES:
        unit.run(line, (START_MS + 25 * len(NODES)) / 1000, "", "--node", str(node))
        answered[node] = [answer.node for answer in heard(unit.folder)]

    assert answered == {node: [node] for node in NODES}


def ranks(name: str) -> list[set[str]]:
    """Who interrupts whom: steps go before the line, that before the tick and edges, and planning
    is last. Those of a rank do not interrupt each other."""
    rows = {wire.signal: wire for wire in wires(name)}
    edges = {edge_vector(rows[f"BI_{number}"].pin) for number in NUMBERS}
    refill = {"TIM5"} if rows["STEP_1"].note.startswith("GPIO") else set()
    return [{"TIM2"}, {rows["LINE_RX"].note, *refill}, {"SysTick", *edges}, {"PendSV"}]


FAULT_MS = 160.0
HELD_MS = 30.0


@pytest.mark.parametrize(
    ("held", "before"),
    [
        ("stm32_step_interrupt", 0),
        ("stm32_line_interrupt", 1),
        ("stm32_tick_interrupt", 2),
        ("stm32_edge_interrupt", 2),
        ("stm32_plan_interrupt", 3),
    ],
)
def test_an_interrupt_that_does_not_end_holds_off_none_before_it_and_all_others(
    wired, name, held, before
):
    """Motor 1 runs; an input stops motor 2, which is planned; bytes and edges come all the time."""
    line = ask(START_MS, b"\x021S500V2000G+") + ask(START_MS + 40, b"\x022S500V500M08G+")
    line += f"{FAULT_MS:.3f} {'55' * round(HELD_MS / BYTE_MS)}\n"
    inputs = "".join(f"{FAULT_MS + 0.5 + i},{i % 8 + 1},{i < 8:d}\n" for i in range(16))
    after = f"{FAULT_MS + 8:.3f}"

    modelled = wired().run(
        line, (FAULT_MS + HELD_MS) / 1000, inputs,
        "--fault", f"{FAULT_MS}:hold={held}", "--measure-from", after,
    )  # fmt: skip

    ran = {vector["name"] for vector in modelled.summary["vectors"]}
    assert ran == set().union(*ranks(name)[:before])


STEPS_MIN, TURNS_MIN = 60, 20


def test_the_direction_stands_still_around_pulses_when_simulation_begins_and_ends(wired, name):
    """Motor 1 goes backward all the time, so its DIR changes with the simulation only."""
    unit = wired()
    line = ask(START_MS, b"\x021\\S2000V2000[L40B5RB3RW1E")
    line += ask(START_MS + 40, b"\x022\\[L25C41W4T41W3E")
    line += ask(START_MS + 80, b"\x020]")

    modelled = unit.run(line, (START_MS + 330) / 1000)

    motor = modelled.summary["motors"][0]
    assert motor["pulses"] > STEPS_MIN
    assert len(modelled.edges("m1_dir")) > TURNS_MIN
    assert {k: motor[k] for k, least in times_us(name).items() if motor[k] < least} == {}


def test_the_readme_tells_the_level_of_every_kind_of_wire(name):
    kinds = {wire.kind for wire in wires(name)} - {"CAPTURE"}

    assert set(levels(name)) == kinds
    assert kinds - {"EN", "PWM"} == {"STEP", "DIR", "LINE", "BI", "BO", "LED", "S1"}
