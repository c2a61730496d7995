"""The image of the reference board makes the pulses that the simulator makes, tick for tick.

Ticks are compared from the first pulse of a run. Where a program waits for an input, or a guard
acts, the board may see the edge a little later, up to 50 us if it comes after another; what is
compared then is told by each test.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from pathlib import Path

import pytest
from reference import TICK_HZ, Curve, single
from rkm04_tools import board
from virtual_board import (
    TICKS_PER_MS,
    Message,
    Modelled,
    Simulated,
    VirtualBoard,
    differences,
    first_tick,
    get_positions,
    of_motor,
    script,
    shifted,
    together,
)

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "tools" / "examples"
SEED = 20261121
RANDOM_PROGRAMS = 10
SECONDS_MAX = 4.0
SAMPLE_MS = 0.05
"""How long the unit may hold an edge off."""


def both(
    unit: VirtualBoard,
    programs: dict[int, bytes],
    seconds: float,
    messages: list[Message],
    inputs: Sequence[tuple[float, int, int]] = (),
) -> tuple[Simulated, Modelled]:
    """Run programs on the simulator and, with the inputs at the same time, on the board."""
    sent = script(messages)
    simulated = unit.simulate(programs, seconds, shifted(inputs, 0) if inputs else "")
    begin = sent.come_ms[-1] / 1000
    levels = ""
    if inputs:
        ahead_ms = first_tick(simulated.steps) / TICKS_PER_MS
        early = [change for change in inputs if change[0] < ahead_ms]
        quiet = unit.run(sent.lines, begin + ahead_ms / 1000 + 0.1, shifted(early, 0))
        zero = first_tick(quiet.steps) - first_tick(simulated.steps)
        levels = shifted(inputs, zero / TICKS_PER_MS)
    end = begin + simulated.summary["seconds"] + 0.1
    modelled = unit.run(sent.lines + get_positions(end * 1000), end + 0.1, levels)
    return simulated, modelled


def example(name: str) -> bytes:
    return (EXAMPLES / f"{name}.rks").read_bytes()


@pytest.mark.parametrize(
    ("name", "seconds"),
    [
        ("1-three-moves", 20),
        ("2-back-and-forth", 8),
        ("3-branch", 4),
        ("4-loop", 20),
        ("6-guards", 12),
        ("7-total-stop", 8),
        ("8-subroutine", 12),
        ("9-compound", 30),
        ("fragment-4.6-loop", 10),
    ],
)
def test_an_example_with_quiet_inputs_makes_the_same_pulses(unit, name, seconds):
    text = example(name)

    simulated, modelled = both(unit, {1: text}, seconds, [Message(1, text)])

    assert len(simulated.steps.tick) > 0
    assert differences(simulated, modelled) == []


@pytest.mark.parametrize(("name", "seconds"), [("2-back-and-forth", 8), ("9-compound", 30)])
def test_pulses_of_half_a_period_are_at_the_same_ticks(unit, name, seconds):
    half = VirtualBoard(
        unit.program, board.build(board.DEFAULT_BOARD, half_period=True), unit.folder
    )
    text = example(name)

    simulated, modelled = both(half, {1: text}, seconds, [Message(1, text)])

    assert differences(simulated, modelled) == []


def test_a_branch_that_an_input_chooses_makes_the_same_pulses(unit):
    text = example("3-branch")
    inputs = [(3000, 5, 1), (6000, 5, 0)]

    simulated, modelled = both(unit, {1: text}, 9, [Message(1, text)], inputs)

    assert differences(simulated, modelled) == []


def test_moves_after_waits_for_inputs_begin_within_a_sample_of_the_same_time(unit):
    text = example("5-wait-for-inputs")
    inputs = [(1000, 5, 1), (7000, 2, 1), (14500, 5, 0)]

    simulated, modelled = both(unit, {1: text}, 25, [Message(1, text)], inputs)

    assert len(simulated.steps.tick) == 16000
    assert differences(simulated, modelled, waited=(1, 2), slack_ms=SAMPLE_MS) == []


@pytest.mark.parametrize(
    ("name", "edges", "seconds"),
    [
        ("6-guards", [(0, 6, 1), (2500, 3, 1), (6000, 6, 0)], 9),
        ("7-total-stop", [(4000, 4, 1)], 6),
    ],
)
def test_an_edge_in_the_middle_of_an_interval_stops_at_the_same_pulse(unit, name, edges, seconds):
    text = example(name)
    inputs = list(edges)
    for i, (ms, number, level) in enumerate(edges):
        if ms:
            simulated = unit.simulate({1: text}, seconds, shifted(inputs[:i], 0))
            inputs[i] = (middle_ms(simulated, ms), number, level)

    simulated, modelled = both(unit, {1: text}, seconds, [Message(1, text)], inputs)

    assert any(event.event == "stop" for event in simulated.events)
    assert differences(simulated, modelled) == []


def middle_ms(simulated: Simulated, ms: float) -> float:
    """Half-way between the two pulses around a time."""
    ticks = simulated.steps.tick
    after = int((ticks > ms * TICKS_PER_MS).argmax())
    return float(ticks[after - 1] + ticks[after]) / 2 / TICKS_PER_MS


def random_move(rng: random.Random) -> str:
    speed = rng.choice([rng.randint(50, 2000), rng.randint(1000, 16000)])
    accel = rng.choice([rng.randint(200, 60000), 60000])
    steps = rng.randint(1, max(2, speed // 2))
    way = rng.choice(["F", "B"])
    return f"V{speed} A{accel} {way}{steps} R"


def random_compound(rng: random.Random) -> str:
    way = rng.choice(["F", "B"])
    sections = [
        f"V{rng.randint(100, 6000)} A{rng.randint(1000, 60000)} {way}{rng.randint(1, 900)} Y"
        for _ in range(rng.randint(2, 6))
    ]
    return " ".join([*sections, "R"])


def random_part(rng: random.Random) -> str:
    """A few commands that make no program error wherever they stand."""
    output = rng.randint(1, 8)
    return rng.choice(
        [
            random_move(rng),
            random_move(rng),
            random_compound(rng),
            f"L{rng.randint(1, 3)} {random_move(rng)} D R W{rng.randint(1, 40)} E",
            f"T0{output} W{rng.randint(1, 60)} C0{output}",
            f"T5{output}",
            f"G{rng.randint(1, 900)}",
            "H",
            f"={rng.randint(-1000, 1000)}",
        ]
    )


def random_program(rng: random.Random) -> bytes:
    parts = [f"S{rng.randint(20, 2000)}", random_move(rng)]
    parts += [random_part(rng) for _ in range(rng.randint(2, 6))]
    return " ".join(parts).encode()


def short_programs(unit: VirtualBoard, seed: int, motors: int) -> dict[int, bytes]:
    """Random programs that have ended after a few seconds."""
    rng = random.Random(seed)
    while True:
        programs = {motor: random_program(rng) for motor in range(1, motors + 1)}
        if unit.simulate(programs, SECONDS_MAX).summary["ended"] == "idle":
            return programs


@pytest.mark.parametrize("seed", range(SEED, SEED + RANDOM_PROGRAMS))
def test_a_random_program_makes_the_same_pulses(unit, seed):
    programs = short_programs(unit, seed, 1)
    print(f"seed {seed}: {programs}")

    simulated, modelled = both(unit, programs, SECONDS_MAX, [Message(1, programs[1])])

    assert differences(simulated, modelled) == []


@pytest.mark.parametrize("seed", [SEED, SEED + 1, SEED + 2])
def test_random_programs_of_four_motors_make_the_same_pulses(unit, seed):
    programs = short_programs(unit, seed, 4)
    print(f"seed {seed}: {programs}")

    simulated, modelled = both(unit, programs, SECONDS_MAX, together(programs))

    assert differences(simulated, modelled) == []


@pytest.mark.parametrize("start_speed", [100, 1000, 2000])
def test_four_motors_that_are_released_together_begin_on_the_same_tick(unit, start_speed):
    text = b"S%d V16000 A60000 F1000 R" % start_speed
    programs = dict.fromkeys(range(1, 5), text)

    simulated, modelled = both(unit, programs, 5, together(programs))

    assert differences(simulated, modelled) == []


def test_four_motors_at_full_speed_with_ramps_make_the_same_pulses(unit):
    text = b"S500 V16000 A40000 L3 F9000 R D R D E"
    programs = dict.fromkeys(range(1, 5), text)

    simulated, modelled = both(unit, programs, 10, together(programs))

    assert len(simulated.steps.tick) == 4 * 6 * 9000
    assert differences(simulated, modelled) == []


def fits(modelled: Modelled, first: int, count: int, curve: Curve) -> bool:
    """Whether some pulses of motor 1 stand on a curve, from its first pulse on: that one and each
    other are within a tick of it."""
    ticks, _ = of_motor(modelled.steps, 1)
    due = [float(tick) for tick in curve.ticks(range(1, count + 1))]
    made = ticks[first : first + count]
    return all(abs(int(t - made[0]) - (d - due[0])) <= 2 for t, d in zip(made, due, strict=True))


def test_simulation_that_another_motor_switches_costs_no_pulse(unit):
    """It comes on in the first move and goes off in the second, both at full speed."""
    programs = {1: b"S2000 V16000 A60000 B4000 R F4000 R B500 R", 2: b"W150 T41 W500 C41"}
    sent = script(together(programs))
    end = sent.come_ms[-1] / 1000 + 1.5

    modelled = unit.run(sent.lines + get_positions(end * 1000), end + 0.1)

    ticks, positions = of_motor(modelled.steps, 1)
    assert (len(ticks), positions[-1]) == (4000 + 500, -4500)
    assert modelled.positions[0] == -4500
    assert fits(modelled, 0, 4000, single(4000, 2000, 16000, 60000))
    assert fits(modelled, 4000, 500, single(500, 2000, 16000, 60000))
    assert modelled.late_steps == 0


def test_k_stops_down_the_ramp_and_c75_makes_the_rest_of_the_move(unit):
    sent = script(
        [Message(1, b"S100 V2000 A4000 F3000 R"), Message(1, b"K", 700), Message(1, b"C75", 900)]
    )
    whole = single(3000, 100, 2000, 4000)

    modelled = unit.run(sent.lines, sent.come_ms[-1] / 1000 + 4)

    ticks, positions = of_motor(modelled.steps, 1)
    pause = int((ticks[1:] - ticks[:-1]).argmax()) + 1
    at = round(sent.come_ms[1] * TICKS_PER_MS) - first_tick(modelled.steps)
    passed = int((ticks <= at).sum())
    stops = [whole.stopped_at(k) for k in range(passed - 2, passed + 4)]
    assert positions[-1] == 3000
    assert any(c.last == pause and fits(modelled, 0, pause, c) for c in stops)
    assert fits(modelled, pause, 3000 - pause, single(3000 - pause, 100, 2000, 4000))
    assert modelled.late_steps == 0


def test_a_speed_that_is_sent_alone_changes_the_move_from_the_next_pulse(unit):
    sent = script([Message(1, b"S100 V1000 A2000 F3000 R"), Message(1, b"V2500", 900)])
    whole = single(3000, 100, 1000, 2000)

    modelled = unit.run(sent.lines, sent.come_ms[-1] / 1000 + 3)

    ticks, positions = of_motor(modelled.steps, 1)
    at = round(sent.come_ms[1] * TICKS_PER_MS) - first_tick(modelled.steps)
    passed = int((ticks <= at).sum())
    changed = [whole.speed_changed_at(k, 2500) for k in range(passed - 2, passed + 4)]
    assert positions[-1] == 3000
    assert any(fits(modelled, 0, 3000, curve) for curve in changed)
    assert modelled.late_steps == 0


ONE_STEP = b"S2000 V16000 A60000 L30 F1 R D R D E"
TEN_SECTIONS = b"S2000 %s R R R" % b" ".join(
    b"V%d A%d F%d Y" % (2000 + 1400 * (i % 3), 60000 - 1000 * i, 1 + i) for i in range(10)
)


@pytest.mark.parametrize(
    ("text", "motors"),
    [
        (ONE_STEP, 1),
        (TEN_SECTIONS, 1),
        (ONE_STEP, 4),
        (TEN_SECTIONS, 4),
    ],
    ids=["one step", "ten sections", "four times one step", "four times ten sections"],
)
def test_the_quickest_moves_come_in_time(unit, text, motors):
    programs = dict.fromkeys(range(1, motors + 1), text)

    simulated, modelled = both(unit, programs, 5, together(programs))

    assert differences(simulated, modelled) == []


@pytest.mark.parametrize("motors", [1, 4])
def test_a_guard_acts_within_a_millisecond_at_full_speed(unit, motors):
    text = b"S500 V16000 A60000 M03 F60000 R"
    sent = script(together(dict.fromkeys(range(1, motors + 1), text)))
    edge_ms = sent.come_ms[-1] + 600
    interval = TICK_HZ // 16000

    modelled = unit.run(sent.lines, edge_ms / 1000 + 0.02, f"{edge_ms:.6f},3,1\n")

    edge = round(edge_ms * TICKS_PER_MS) - first_tick(modelled.steps)
    after = []
    for motor in range(1, motors + 1):
        ticks, _ = of_motor(modelled.steps, motor)
        changed = (ticks[1:] > edge) & (ticks[1:] - ticks[:-1] != interval)
        after.append(int(ticks[:-1][changed][0]) - edge)
    assert max(after) <= TICKS_PER_MS
