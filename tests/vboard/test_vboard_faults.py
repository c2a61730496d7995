"""Faults on request: each does what its option says, at its time, until the next reset."""

from __future__ import annotations

import pytest

TICKS = 20
IBUSERR, STKERR = 1 << 8, 1 << 12
POWER_FLAGS = 0x0E000000
UNTOUCHED = 0xA5A5A5A5
WRPERR, PGSERR = 1 << 4, 1 << 7
SECTOR_4 = 0x10000


def run(run_image, *faults: str, seconds: float = 0.03):
    options = [part for fault in faults for part in ("--fault", fault)]
    done = run_image("victim", *options, seconds=seconds)
    assert done.status == 0, done.told
    return done


def words(done) -> list[int]:
    return list(done.summary["watch"]["result"])


def test_without_a_fault_main_and_tick_go_on(run_image):
    done = run(run_image)

    assert done.summary["ended"] == "reached"
    assert words(done)[2:6] == [TICKS, 5, 0, 0]


def test_a_jump_goes_on_somewhere_else(run_image):
    done = run(run_image, "5.5:jump=60000000")

    assert words(done)[2] == 5
    assert words(done)[4:6] == [IBUSERR, 1]


def test_a_jump_can_go_to_a_function(run_image):
    done = run(run_image, "5.5:jump=test_end")

    assert done.summary["ended"] == "reached"
    assert words(done)[2] == 5


def test_a_stack_that_is_nowhere_fails_at_the_next_exception(run_image):
    done = run(run_image, "5.5:sp=60000000")

    assert words(done)[2] == 5
    assert words(done)[4] == STKERR


def test_a_word_of_memory_changes(run_image):
    assert words(run(run_image, "5.5:word=guard:1f"))[3] == 0x1F
    assert words(run(run_image, "5.5:word=result+8:8"))[2] == TICKS


def test_what_is_held_stays_while_interrupts_go_on(run_image):
    free = words(run(run_image))[1]
    done = run(run_image, "5.5:hold=work")

    assert done.summary["ended"] == "time"
    assert words(done)[1] == pytest.approx(free * 5.5 / TICKS, rel=0.02)
    assert words(done)[2] in (29, 30)


def test_an_exception_can_be_lost_for_ever_or_for_some_time(run_image):
    lost = run(run_image, "5.5:lose=15")
    late = run(run_image, "5.5:lose=15,3")

    assert lost.summary["ended"] == "time"
    assert words(lost)[2] == 5
    # Three periods have become one late tick.
    assert late.summary["ended"] == "reached"
    assert late.summary["microseconds"] == pytest.approx(22_000, abs=50)
    assert late.vector("SysTick")["latency_max"] == pytest.approx(2.5 * 16000, rel=0.01)


def test_power_that_goes_and_comes_back_starts_anew_and_the_memory_forgets(run_image):
    done = run(run_image, "5.5:power")

    assert done.summary["resets"]["power"] == 2
    assert done.summary["last_reset"]["microseconds"] == pytest.approx(5500, abs=1)
    assert words(done)[0] == POWER_FLAGS
    assert words(done)[6] == UNTOUCHED
    assert done.summary["microseconds"] == pytest.approx(25_500, abs=50)


def test_a_reset_ends_a_fault(run_image):
    done = run(run_image, "3:hold=work", "4.5:lose=15", "5.5:power")

    assert words(done)[2] == TICKS


@pytest.mark.parametrize(
    "fault", ["5", "5:", "5:jump", "5:jump=nothing", "5:lose=3", "5:lose=15,x", "5:word=guard",
              "5:dma=16", "5:dma=1,2", "5:slow=1", "5:slow=16,1", "5:slow=1,x", "x:power",
              "5:word=guard+1:0", "5:powerful",
              "5:sp=123456789", "5:resets"],
)  # fmt: skip
def test_a_fault_that_cannot_be_read_is_told(run_image, fault):
    done = run_image("victim", "--fault", fault)

    assert done.status == 1
    assert f"--fault {fault}: not a time and a fault" in done.told
    assert done.told.count("\n") == 1


@pytest.mark.parametrize(
    ("how", "status", "word"),
    [("wrp", WRPERR, 0xFFFFFFFF), ("pgs", PGSERR, 0xFFFFFFFF), ("silent", 0, 0xFFFFFFFF)],
)
def test_an_operation_can_fail_in_several_ways(run_image, tmp_path, how, status, word):
    flash = tmp_path / "flash"
    done = run_image("store", "--flash", str(flash), "--flash-fail", f"9:{how}")

    content = flash.read_bytes()
    assert int.from_bytes(content[SECTOR_4 + 28 : SECTOR_4 + 32], "little") == word
    assert done.result[1] == (1 if status else 0)


def test_a_single_bit_can_fail(run_image, tmp_path):
    flash = tmp_path / "flash"
    run_image("store", "--flash", str(flash), "--flash-fail", "3:bit")

    # 22222222 with the lowest of the bits that were to be cleared still set.
    assert flash.read_bytes()[SECTOR_4 + 4 : SECTOR_4 + 8] == bytes([0x23, 0x22, 0x22, 0x22])


@pytest.mark.parametrize(("leaves", "ones"), [("nothing", 32), ("all", 8), ("half", 20)])
def test_a_cut_leaves_what_is_asked_for(run_image, tmp_path, leaves, ones):
    flash = tmp_path / "flash"
    run_image("store", "--flash", str(flash), "--power-cut", f"2:{leaves}")

    word = int.from_bytes(flash.read_bytes()[SECTOR_4 : SECTOR_4 + 4], "little")
    assert word.bit_count() == ones


def test_a_cut_with_a_seed_leaves_some_of_the_bits_and_the_same_ones_again(run_image, tmp_path):
    left: list[bytes] = []
    for seed in (1, 1, 2):
        flash = tmp_path / f"flash{len(left)}"
        flash.write_bytes(bytes(0x100000))
        run_image("store", "--flash", str(flash), "--power-cut", f"1:{seed}")
        left.append(flash.read_bytes()[SECTOR_4 : SECTOR_4 + 0x10000])

    ones = sum(byte.bit_count() for byte in left[0])
    assert ones == pytest.approx(4 * 0x10000, rel=0.02)
    assert left[0] == left[1] != left[2]


def test_an_erase_can_be_made_short(run_image):
    assert run_image("flash", "--flash-erase", "3").result[13] == 3


def test_the_step_timer_can_start_with_a_count(run_image):
    pins = "m1_step PA0\nm2_step PA1\n"
    run = run_image("timer_compare", "--ticks", "timer", "--timer-start", "600", pins=pins)

    assert run.steps == [(100, 2, 1), (400, 1, 1), (900, 1, 2)]


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--flash-fail", "0"], "--flash-fail 0"),
        (["--flash-fail", "1:x"], "--flash-fail 1:x"),
        (["--power-cut", "1:x"], "--power-cut 1:x"),
        (["--power-cut", "x"], "--power-cut x"),
        ([*["--power-cut", "1"] * 5], "--power-cut 1"),
        ([*["--fault", "1:power"] * 17], "one too many"),
    ],
)
def test_wrong_options_for_faults_are_told(run_image, options, told):
    done = run_image("victim", *options)

    assert done.status == 2
    assert told in done.told
