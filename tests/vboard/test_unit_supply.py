"""The images of two boards on the supplies that their boards have, and on worse ones.

The reference board runs at 3.3 V, the Discovery at 2.89 to 2.94 V; a store is refused below the
level of the voltage detector that the board has chosen, while motors go on as ever.
"""

from __future__ import annotations

import csv

import numpy as np
import pytest
from board_talk import ask, heard
from rkm04_tools import board
from rkm04_tools.status import parse_status
from stored import area, flash, record
from virtual_board import TICKS_PER_MS, Modelled, VirtualBoard

REFERENCE, DISCOVERY = board.DEFAULT_BOARD, "f407-discovery"
OLD, NEW = b"S2000V2000F5R", b"S2000V2000B7R"
MOVING = b"S2000V4000A40000F100000R"
STORED = flash(area(1, [record(2, 2, MOVING), record(1, 3, OLD)]))
FULL = flash(area(1, [record(2, 2, MOVING), record(1, 3, OLD)])[:-4] + bytes(4))
"""The next store has to erase the other area first."""
DONE, FAILED = b"\x031\0", b"\x031\x01"
GET_STATUS = b"\xc8"
LOCKS = (1 << 31, 1)
"""Of FLASH_CR and FLASH_OPTCR."""
FLASH_SR, PWR_CSR = "40023c0c", "40007004"
LEVEL_3, LEVEL_2 = "0fffaae1", "0fffaae5"


@pytest.fixture(scope="session")
def images() -> dict[str, board.Image]:
    return {name: board.build(name) for name in (REFERENCE, DISCOVERY)}


@pytest.fixture
def unit_of(program, images, tmp_path, monkeypatch):
    """A board by its name."""
    monkeypatch.setenv("RKM04_BUILD", str(program.parents[1]))
    return lambda name: VirtualBoard(program, images[name], tmp_path)


def run(
    unit: VirtualBoard, supply: str, seconds: float, *options: str, sent: str = "",
    content: bytes = STORED, inputs: str = "",
) -> Modelled:  # fmt: skip
    path = unit.folder / "flash"
    path.write_bytes(content)
    power = ["--flash", str(path), "--supply", supply]
    return unit.run(sent, seconds, inputs, *power, *options)


def of(unit: VirtualBoard, number: int) -> list[bytes]:
    return [answer.message for answer in heard(unit.folder) if answer.message[0] == number]


def store(ms: float, program: bytes = NEW) -> str:
    return ask(ms, b"\x021\\" + program) + ask(ms + 25, b"\x031")


def ticks(modelled: Modelled, motor: int) -> np.ndarray:
    found: np.ndarray = modelled.steps.tick[modelled.steps.motor == motor]
    return found


def assert_locked(modelled: Modelled) -> None:
    state = modelled.summary["flash"]
    assert (state["cr"] & LOCKS[0], state["optcr"] & LOCKS[1], state["sr"]) == (*LOCKS, 0)
    assert state["option_writes"] == 0


@pytest.mark.parametrize(
    ("name", "volts", "thresholds", "content", "answer"),
    [
        (REFERENCE, "3.3", "typical", FULL, DONE), (REFERENCE, "3.135", "high", STORED, DONE),
        (REFERENCE, "3.0", "typical", STORED, FAILED), (REFERENCE, "3.0", "typical", FULL, FAILED),
        (DISCOVERY, "2.89", "high", FULL, DONE), (DISCOVERY, "3.3", "low", STORED, DONE),
        (DISCOVERY, "2.69", "low", STORED, FAILED), (DISCOVERY, "2.75", "typical", FULL, FAILED),
    ],
)  # fmt: skip
def test_a_store_needs_the_supply_that_its_board_has(
    unit_of, name, volts, thresholds, content, answer
):
    unit = unit_of(name)
    options = ("--thresholds", thresholds, "--flash-erase", "0.5")
    modelled = run(unit, volts, 0.11, *options, sent=store(30), content=content)

    assert of(unit, 3) == [answer]
    begun = modelled.summary["flash"]["operations"] > 0
    assert begun == (answer == DONE)
    assert_locked(modelled)


@pytest.mark.parametrize(
    ("name", "supply"),
    [(REFERENCE, "3.3,40:3.3,50:2.8,85:2.8,95:3.3"), (DISCOVERY, "3,40:3,50:2.5,85:2.5,95:3")],
)
@pytest.mark.parametrize("content", [STORED, FULL], ids=["word", "erase"])
def test_a_supply_that_falls_in_motion_stops_stores_and_no_motor(unit_of, name, supply, content):
    unit = unit_of(name)
    sent = store(55) + ask(110, b"\x031")
    options = ("--flash-erase", "0.5")
    still = run(unit, supply.partition(",")[0], 0.15, *options, sent=sent, content=content)
    fallen = run(unit, supply, 0.15, *options, sent=sent, content=content)

    assert of(unit, 3) == [FAILED, DONE]
    assert len(ticks(fallen, 2)) > 400
    assert list(ticks(fallen, 2)) == list(ticks(still, 2))
    assert fallen.late_steps == 0
    assert_locked(fallen)


@pytest.mark.parametrize(
    ("name", "supply"),
    [
        (REFERENCE, "3.3,70:3.3,71:2.8,72:3.3"), (DISCOVERY, "3,70:3,71:2.5,72:3"),
        (REFERENCE, "3.3,70:3.3,70.0005:2.8,70.001:3.3"),
    ],
)  # fmt: skip
def test_an_erase_in_which_the_supply_was_low_is_not_believed(unit_of, name, supply):
    unit = unit_of(name)
    modelled = run(
        unit, supply, 0.19, "--flash-erase", "20", "--fault", "100:power",
        sent=store(30) + ask(140, b"\x051"), content=FULL,
    )  # fmt: skip

    assert modelled.summary["flash"]["erases"] == 1
    assert of(unit, 3) == [FAILED]
    assert of(unit, 5) == [b"\x051" + OLD]


@pytest.mark.parametrize(
    ("name", "level", "supply"),
    [(REFERENCE, LEVEL_3, "3.3,60:3.3,80:0,100:3.3"), (DISCOVERY, LEVEL_2, "3,60:3,80:0,100:3")],
)
@pytest.mark.parametrize("thresholds", ["low", "high"])
def test_with_its_brown_out_level_a_board_goes_down_before_its_clock_is_too_fast(
    unit_of, name, level, supply, thresholds
):
    unit = unit_of(name)
    options = ("--option-bytes", level, "--thresholds", thresholds)
    modelled = run(unit, supply, 0.2, *options, sent=ask(120, GET_STATUS))

    made = ticks(modelled, 2)
    down = (made > 62 * TICKS_PER_MS) & (made < 97 * TICKS_PER_MS)
    assert not (made[down] > 70 * TICKS_PER_MS).any()
    assert (made > 100 * TICKS_PER_MS).any()
    (status,) = map(parse_status, of(unit, GET_STATUS[0]))
    assert (status.cause, status.not_started) == ("power-on", False)
    assert modelled.summary["flash"]["option_writes"] == 0


@pytest.mark.parametrize(
    ("before", "options", "cause"),
    [
        ("", (), "power-on"),
        ("", ("--supply", "3.3,50:3.3,51:2.8,55:3.3", "--option-bytes", LEVEL_3), "power-on"),
        ("", ("--fault", "50:reset"), "reset"),
        ("40:jump=60000000", ("--fault", "50:reset"), "fault"),
        ("40:jump=60000000", ("--fault", "50:power"), "power-on"),
        (
            "40:jump=60000000",
            ("--supply", "3.3,50:3.3,51:2.8,55:3.3", "--option-bytes", LEVEL_3), "power-on",
        ),
    ],
    ids=["power", "brown-out", "pin", "pin after a fault", "power after a fault",
         "brown-out after a fault"],
)  # fmt: skip
def test_each_cause_of_a_reset_is_told_and_decides_whether_programs_start(
    unit_of, before, options, cause
):
    unit = unit_of(REFERENCE)
    faults = ("--fault", before) if before else ()
    modelled = run(unit, "3.3", 0.15, *faults, *options, sent=ask(80, GET_STATUS))

    (status,) = map(parse_status, of(unit, GET_STATUS[0]))
    assert (status.cause, status.not_started) == (cause, cause == "fault")
    assert (ticks(modelled, 2) > 65 * TICKS_PER_MS).any() == (cause != "fault")


def test_a_part_without_the_sectors_says_so_and_does_all_else(unit_of):
    unit = unit_of(REFERENCE)
    sent = ask(30, GET_STATUS) + store(130)
    modelled = run(unit, "3.3", 0.2, "--flash-kb", "512", sent=sent)

    (status,) = map(parse_status, of(unit, GET_STATUS[0]))
    assert status.no_store
    assert [motor.error for motor in status.motors] == ["the stored program is damaged"] * 4
    assert [m["led"] for m in modelled.summary["motors"]] == [0, 1, 1, 1]
    assert len(ticks(modelled, 1)) == 7
    assert of(unit, 3) == [FAILED]
    assert modelled.summary["flash"]["operations"] == 0


def test_a_part_with_the_sectors_says_nothing_of_it(unit_of):
    unit = unit_of(DISCOVERY)
    modelled = run(unit, "2.9", 0.13, sent=ask(40, GET_STATUS))

    (status,) = map(parse_status, of(unit, GET_STATUS[0]))
    assert not status.no_store
    assert len(ticks(modelled, 1)) == 5


@pytest.mark.parametrize(("revision", "prefetch"), [("A", False), ("Z", True), ("2", True)])
def test_revision_a_runs_without_prefetch(unit_of, revision, prefetch):
    modelled = run(unit_of(REFERENCE), "3.3", 0.05, "--revision", revision)

    assert bool(modelled.summary["flash"]["acr"] & 1 << 8) == prefetch
    assert len(ticks(modelled, 1)) == 5


@pytest.mark.parametrize(("name", "volts"), [(REFERENCE, "3.3"), (DISCOVERY, "2.9")])
def test_a_start_by_a_boot_loader_is_a_start_as_any_other(unit_of, name, volts):
    unit = unit_of(name)
    usual = run(unit, volts, 0.09, sent=store(30))
    loaded = run(unit, volts, 0.09, "--left-by-loader", sent=store(30))
    count = min(len(ticks(each, 2)) for each in (usual, loaded))

    assert count > 100
    assert list(np.diff(ticks(usual, 2)[:count])) == list(np.diff(ticks(loaded, 2)[:count]))
    assert loaded.summary["hclk_hz"] == 168_000_000
    assert of(unit, 3) == [DONE]
    assert_locked(loaded)


def test_a_start_by_a_boot_loader_without_a_crystal_is_one_too(unit_of):
    unit = unit_of(REFERENCE)
    loaded = run(unit, "3.3", 0.3, "--left-by-loader", "--no-crystal", sent=ask(200, GET_STATUS))

    (status,) = map(parse_status, of(unit, GET_STATUS[0]))
    assert status.no_crystal
    assert loaded.summary["flash"]["operations"] == 0
    assert_locked(loaded)


def test_an_erase_as_slow_as_the_data_sheet_allows_moves_no_pulse(unit_of):
    unit = unit_of(REFERENCE)
    sent = store(30) + ask(2180, b"\x051")
    modelled = run(unit, "3.3", 2.25, "--slow-flash", sent=sent, content=FULL)

    assert of(unit, 3) == [DONE]
    assert modelled.summary["resets"]["watchdog"] == 0
    assert modelled.late_steps == 0
    cruise = ticks(modelled, 2)
    assert len(cruise) > 8000
    assert set(np.diff(cruise[1000:]).tolist()) == {TICKS_PER_MS // 4}
    assert_locked(modelled)


@pytest.mark.parametrize("content", [STORED, FULL], ids=["word", "erase"])
def test_a_store_reads_no_register_that_holds_up_the_edges_of_motors(unit_of, content):
    # PWR_CSR takes longer than other registers (RM0090 5.4.2): it is read at the start.
    unit = unit_of(REFERENCE)
    profile = unit.folder / "profile.csv"
    options = ("--flash-erase", "20", "--measure-from", "25", "--profile", str(profile))
    run(unit, "3.3", 0.13, *options, sent=store(30), content=content)

    assert of(unit, 3) == [DONE]
    registers = {row["register"] for row in csv.DictReader(profile.read_text().splitlines())}
    assert FLASH_SR in registers
    assert PWR_CSR not in registers


@pytest.mark.parametrize("number", [1, 4, 8])
def test_an_input_that_is_active_before_power_comes_counts_from_the_start(unit_of, number):
    programs = [
        record(1, 2, b"O0%dS2000V2000F3R" % number),
        record(2, 3, b"X0%dS2000V2000F3R" % number),
        record(3, 4, b"Z0%dS2000V2000F3R" % number),
        record(4, 5, b"M0%dS100V2000A2000F300R" % number),
    ]
    content = flash(area(1, programs))
    unit = unit_of(REFERENCE)
    run(unit, "3.3", 0.15, content=content, inputs=f"0,{number},1\n", sent=ask(60, GET_STATUS))

    (status,) = map(parse_status, of(unit, GET_STATUS[0]))
    assert status.inputs == tuple(each == number for each in range(1, 9))
    assert [motor.position for motor in status.motors][:3] == [3, 0, 0]
    assert status.motors[3].position < 10
    assert status.motors[1].text == "ended by X"


def test_the_accelerometer_of_the_discovery_is_not_selected(unit_of):
    unit = unit_of(DISCOVERY)
    levels = {}
    for pin in ("PE2", "PE3"):
        file = unit.folder / "other-pins"
        file.write_text(f"m1_led {pin}\n")
        modelled = run(unit, "2.9", 0.01, "--pins", str(file))
        levels[pin] = modelled.summary["motors"][0]["led"]

    assert levels == {"PE2": 0, "PE3": 1}
