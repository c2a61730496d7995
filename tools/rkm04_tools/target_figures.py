"""What `bench --target stm32` measures: each function here makes some figures with one cycle model.

Cycles are those of the virtual board (tools/vboard/README.md), so everything here is modelled.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rkm04_tools.failure import NOT_SO, Failure
from rkm04_tools.frame import Frame
from rkm04_tools.sim_board import ANSWER_MS, BYTE_MS, NODE, READY_MS, SET_COMMAND
from rkm04_tools.target_run import MOTORS, MOVES_BEGIN_MS, Move, Ran, Rig, ended_well, programs

Figures = dict[str, float]

RAMPS = b"S500 V16000 A60000 F8000 R"
RAMPS_SECONDS = 0.85
"""How long that takes at most."""

FASTEST, ACCEL_LIMIT = 400_000, 8_000_000
"""MOTION_SPEED_MAX, what the planner of one motor is built for, and STEP_ACCEL_MAX."""
RATE_LEAST, RATE_STEP = 10_000, 1.01
"""The search for the highest rate ends with one that held and one 1 % above that did not."""
RAMP_SECONDS, CRUISE_SECONDS = 0.05, 0.05
START_SPEED = 1000
FAST, FAST_ACCEL = 200_000, 1_000_000
APART_TICKS = (0, 8_505, 17_010, 25_515)
"""Starts of four motors: in a ramp up to 200 000 steps/s the pulses pass each other in every order,
and in the cruise they are a quarter of a period apart."""

FOREIGN_NODE = 7
FOREIGN_FRAMES, FOREIGN_BYTES = 3, 30
OPENING, GET_POSITION, STORE_FLASH = b"\x01", b"\x040", b"\x03"
ANSWER_BYTES = 46 + 6
"""Of Get Position for all motors, with its frame."""
OPENING_ANSWER_BYTES = 18 + 6
TURN_ROUND_MS = 2.5
"""From a request to its answer, and from that to the next frame."""

BUSY = b"S500 V16000 A60000 X04 M03 @1 T0%d F16000 R C0%d D R D T5%d J1"
BUSY_SECONDS = 2.0
BUSY_CRUISE_MS = (280.0, 950.0)
"""Of the first move, from the release on."""

STORM = b"S500 V16000 A60000 M08 F16000 R"
"""Input 8 would stop it; it stays quiet."""
STORM_INPUTS, STORM_KHZ = 7, 100
STORM_MS = (280.0, 880.0)
"""The cruise, from the release on."""

STARTED = b"S2000 V16000 A60000 F1000 R "
FILLER = b"V16000 " * 690
"""With it the program is nearly as long as it may be, 700 commands."""
STORE_MS = 2500.0
"""For storing one program."""


def step_cycles(rig: Rig) -> Figures:
    """Cycles of the step interrupt for each pulse, entry and exit included."""
    lone = ramps(rig, 1)
    together = ramps(rig, len(MOTORS))
    fast = rig.run_moves(fast_moves(len(MOTORS), FAST, FAST_ACCEL, (0,) * 4))
    fastest = rig.run_moves(fast_moves(len(MOTORS), FASTEST, ramp_accel(FASTEST), (0,) * 4))
    runs = (lone, together, fast, fastest)
    return {
        "lone_step": lone.step_cycles,
        "together_step": together.step_cycles,
        "fast_step": fast.step_cycles,
        "fastest_step": fastest.step_cycles,
        "interrupt_max": max(ran.step_interrupt["max"] for ran in runs),
        "stack_used": max(ran.stack_used for ran in runs),
    }


def ramps(rig: Rig, motors: int, profile: bool = False) -> Ran:
    """A move with ramps up to 16 000 steps/s, of some motors together."""
    line = programs(dict.fromkeys(range(1, motors + 1), RAMPS))
    seconds = line.released_ms / 1000 + RAMPS_SECONDS
    return rig.run(seconds, line.lines, profile=profile)


def highest_rate(holds: Callable[[int], bool], limit: int) -> int:
    """The highest rate, to 1 %, at which a test holds; 0 if it does not at the least one."""
    if holds(limit):
        return limit
    if not holds(RATE_LEAST):
        return 0
    good, bad = RATE_LEAST, limit
    while bad > good * RATE_STEP:
        middle = round((good * bad) ** 0.5)
        if holds(middle):
            good = middle
        else:
            bad = middle
    return good


def ramp_accel(speed: int) -> int:
    """An acceleration that gives a ramp its time, or the highest."""
    return min(round(speed / RAMP_SECONDS), ACCEL_LIMIT)


def fast_moves(motors: int, speed: int, accel: int, delays: Sequence[int]) -> list[Move]:
    """Ramp, cruise, ramp."""
    steps = speed * speed // accel + round(speed * CRUISE_SECONDS)
    return [Move(steps, START_SPEED, speed, accel, delays[i]) for i in range(motors)]


def flood(begin_ms: float, end_ms: float) -> str:
    """The line at 100 %: frames for another node, requests to this one, room for its answers."""
    content = bytes(ord("a") + i % 26 for i in range(FOREIGN_BYTES))
    foreign = Frame(FOREIGN_NODE, 0, SET_COMMAND + b"1" + content).encode() * FOREIGN_FRAMES
    opening = foreign + Frame(NODE, 255, OPENING).encode()
    lines, number = f"{begin_ms:.3f} {opening.hex()}\n", 0
    at = begin_ms + (len(opening) + OPENING_ANSWER_BYTES) * BYTE_MS + TURN_ROUND_MS
    while at < end_ms:
        number = number % 255 + 1
        data = foreign + Frame(NODE, number, GET_POSITION).encode()
        lines += f"{at:.3f} {data.hex()}\n"
        at += (len(data) + ANSWER_BYTES) * BYTE_MS + TURN_ROUND_MS
    return lines


def load_language(rig: Rig) -> Figures:
    """Four busy programs at 16 000 steps/s while the line is flooded."""
    line = programs({motor: BUSY % (motor, motor, motor) for motor in MOTORS})
    begin = line.released_ms
    end = begin + 1000 * BUSY_SECONDS
    lines = line.lines + flood(begin + TURN_ROUND_MS, end)
    measured = ["--measure-from", f"{begin:.3f}"]
    whole = rig.run(end / 1000, lines, "", *measured)
    first, last = (begin + ms for ms in BUSY_CRUISE_MS)
    cruise = rig.run(last / 1000, lines, "", "--measure-from", f"{first:.3f}")
    told = whole.summary["line"]
    # Bytes of the whole run, as the summary has them; the programs came before.
    before = sum(len(text.split()[1]) // 2 for text in line.lines.splitlines())
    busy_ms = (told["heard"] - before + told["sent"]) * BYTE_MS
    return {
        "load_16000": whole.load,
        "load_16000_cruise": cruise.load,
        "late_16000": whole.late,
        "latency_16000": whole.step_interrupt["latency_max"],
        "line_busy": 100 * busy_ms / (end - begin),
        "stack_used": max(whole.stack_used, cruise.stack_used),
    }


def load_storm(rig: Rig) -> Figures:
    """Four motors at 16 000 steps/s in the cruise while inputs change 100 000 times a second."""
    line = programs(dict.fromkeys(MOTORS, STORM))
    first, last = (line.released_ms + ms for ms in STORM_MS)
    level = [0] * (STORM_INPUTS + 1)
    inputs = ""
    for i in range(round((last - first) * STORM_KHZ)):
        number = i % STORM_INPUTS + 1
        level[number] ^= 1
        inputs += f"{first + i / STORM_KHZ:.6f},{number},{level[number]}\n"
    ran = rig.run(last / 1000, line.lines, inputs, "--measure-from", f"{first:.3f}")
    return {"load_storm": ran.load, "late_storm": ran.late, "stack_used": ran.stack_used}


def load_fast(rig: Rig) -> Figures:
    """Four motors at 200 000 steps/s with ramps while the line is flooded."""
    ramp_ms = 1000 * FAST / FAST_ACCEL
    lines = flood(MOVES_BEGIN_MS, MOVES_BEGIN_MS + 2 * ramp_ms + 1000 * CRUISE_SECONDS + 100)
    figures: Figures = {}
    for name, delays in (("together", (0,) * 4), ("apart", APART_TICKS)):
        moves = fast_moves(len(MOTORS), FAST, FAST_ACCEL, delays)
        ran = rig.run_moves(moves, "--measure-from", str(MOVES_BEGIN_MS), line=lines)
        if not ended_well(ran, moves):
            raise Failure(
                f"4 x 200 000 steps/s, {name}: the moves did not come to their ends", NOT_SO
            )
        figures[f"late_200000_{name}"] = ran.late
        figures[f"load_200000_{name}"] = ran.load
    return figures


def start_up(rig: Rig) -> Figures:
    """From power-on to the first pulse of a stored program."""
    full = STARTED + FILLER
    short_ms, _ = first_pulse(rig, {1: STARTED}, "short.bin")
    full_ms, stack = first_pulse(rig, dict.fromkeys(MOTORS, full), "full.bin")
    return {"start_short": short_ms, "start_full": full_ms, "stack_used": stack}


def first_pulse(rig: Rig, texts: dict[int, bytes], name: str) -> tuple[float, int]:
    """From power-on to the first pulse, with these programs stored, in ms; and the stack used."""
    flash = rig.folder / name
    at, lines = READY_MS, ""
    messages = [SET_COMMAND + b"%d" % motor + text for motor, text in texts.items()]
    messages += [STORE_FLASH + b"%d" % motor for motor in texts]
    for message in messages:
        data = Frame(NODE, 0, message).encode()
        lines += f"{at:.3f} {data.hex()}\n"
        at += len(data) * BYTE_MS + (STORE_MS if message[:1] == STORE_FLASH else ANSWER_MS)
    stored = rig.run(at / 1000, lines, flash=flash)
    started = rig.run(1.0, flash=flash)
    first = started.summary["first_step_microseconds"]
    if first is None:
        raise Failure("start-up: the stored program did not start", NOT_SO)
    return first / 1000, max(stored.stack_used, started.stack_used)
