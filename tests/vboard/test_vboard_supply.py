"""The supply of the virtual board, and what the part is: thresholds and sizes of the data sheet."""

from __future__ import annotations

import pytest

LOW = 4
DETECTOR = {
    0: ((1.98, 2.09), (2.08, 2.19)), 1: ((2.13, 2.23), (2.25, 2.37)),
    2: ((2.29, 2.39), (2.39, 2.51)), 3: ((2.44, 2.54), (2.56, 2.65)),
    4: ((2.59, 2.70), (2.71, 2.82)), 5: ((2.65, 2.86), (3.02, 2.99)),
    6: ((2.85, 2.96), (2.99, 3.10)), 7: ((2.95, 3.07), (3.09, 3.21)),
}  # fmt: skip
"""DS8626, VPVD: falling and rising, in V, at the low and at the high end of the range."""
POWER_FLAGS, PIN_FLAG, BROWN_OUT_FLAGS = 0x0E000000, 0x04000000, 0x06000000
DELIVERED = 0x0FFFAAED
LEVEL_3, LEVEL_2 = "0fffaae1", "0fffaae5"
FOR_EVER = "STAYS=0xffffffff"


def near(volts: float) -> str:
    return f"{volts:.3f}"


@pytest.mark.parametrize("level", DETECTOR)
@pytest.mark.parametrize(("corner", "which"), [("low", 0), ("high", 1)])
def test_a_detector_that_is_switched_on_says_low_below_its_rising_threshold(
    run_image, level, corner, which
):
    rising = DETECTOR[level][which][1]
    options = ("--thresholds", corner, "--supply")
    below = run_image("supply", *options, near(rising - 0.001)).result
    above = run_image("supply", *options, near(rising)).result

    assert (below[4 + level], above[4 + level], above[13]) == (LOW, 0, 0)


@pytest.mark.parametrize(("corner", "which"), [("low", 0), ("high", 1)])
def test_a_falling_and_a_rising_supply_meet_thresholds_of_their_own(run_image, corner, which):
    falling, rising = DETECTOR[6][which]
    run = run_image("falling", "--supply", "3.3,10:3.3,20:2.3,30:3.3", "--thresholds", corner)

    assert run.result[0] == pytest.approx(1e4 + 1e4 * (3.3 - falling), abs=20)
    assert run.result[1] == pytest.approx(2e4 + 1e4 * (rising - 2.3), abs=20)
    assert run.summary["supply"]["least_mv"] == 2300
    assert run.result[2:5] == [1 << 16, 1 << 16, 0]  # lines of EXTI: RM0090 5.2.3


def test_the_detector_is_not_to_be_believed_at_once(run_image):
    run = run_image("supply", defines=["SETTLE_US=90"])

    assert run.status == 1
    assert "before the voltage detector, just switched on, can be believed" in run.told


@pytest.mark.parametrize(
    ("options", "mv", "flags", "kept"),
    [
        (LEVEL_3, 2830, BROWN_OUT_FLAGS, 2), (LEVEL_2, 2500, BROWN_OUT_FLAGS, 2),
        ("0fffaae9", 2190, BROWN_OUT_FLAGS, 2), ("0fffaaed", 1680, POWER_FLAGS, 1),
        (LEVEL_3, 1680, POWER_FLAGS, 1),
    ],
)  # fmt: skip
def test_a_supply_below_its_level_holds_the_part_in_reset(run_image, options, mv, flags, kept):
    low = f"3.3,5:3.3,6:{near((mv - 1) / 1000)},10:{near((mv - 1) / 1000)},11:3.3"
    run = run_image("resets", "--supply", low, "--option-bytes", options, defines=["STAYS=70000"])

    assert run.result[0:2] == [kept, flags]
    assert run.summary["microseconds"] > 12_000


@pytest.mark.parametrize(("options", "mv"), [(LEVEL_3, 2830), (LEVEL_2, 2500), ("0fffaaed", 1680)])
def test_a_supply_at_its_level_holds_nothing(run_image, options, mv):
    supply = f"3.3,5:3.3,6:{near(mv / 1000)}"
    run = run_image(
        "resets", "--supply", supply, "--option-bytes", options, seconds=0.01, defines=[FOR_EVER]
    )

    assert run.summary["supply"] == {"mv": mv, "least_mv": mv, "held": False, "brown_outs": 0}


@pytest.mark.parametrize(("volts", "held"), [("2.96", True), ("2.97", False)])
def test_a_part_whose_level_is_too_high_for_its_supply_never_starts(run_image, volts, held):
    run = run_image(
        "resets", "--supply", volts, "--option-bytes", LEVEL_3, "--thresholds", "high",
        seconds=0.01, defines=[FOR_EVER],
    )  # fmt: skip

    assert run.summary["supply"]["held"] is held
    assert (run.summary["instructions"] == 0) == held


def test_a_part_starts_when_its_supply_has_come(run_image):
    run = run_image("resets", "--supply", "0,10:0,20:3.3", defines=["STAYS=1"])

    assert run.result[0:2] == [1, POWER_FLAGS]
    assert run.summary["microseconds"] == pytest.approx(1e4 + 1e4 * 1.72 / 3.3 + 1500, abs=20)


def test_the_reset_pin_leaves_its_flag_alone(run_image):
    run = run_image("resets", "--fault", "5:reset", defines=["STAYS=70000"])

    assert run.result[0:2] == [2, PIN_FLAG]
    assert run.summary["pin_resets"] == 1


@pytest.mark.parametrize(("size", "mv"), [(2, 2700), (1, 2100), (0, 1800)])
def test_an_operation_needs_the_supply_of_its_parallelism(run_image, size, mv):
    supplies = [near((mv - each) / 1000) for each in (1, 0)]
    below, at = (
        run_image("weak", "--supply", volts, "--flash-erase", "1", defines=[f"SIZE={size}"])
        for volts in supplies
    )

    assert below.status == 1
    assert f"begins at {mv - 1} mV, PSIZE {size} needs {mv}" in below.told
    assert at.result[0:2] == [0, 0xFFFFFFFF]


def test_an_operation_in_a_supply_that_falls_is_not_what_it_seems(run_image, tmp_path):
    flash = tmp_path / "flash"
    flash.write_bytes(bytes(0x100000))
    run = run_image("weak", "--flash", str(flash), "--supply", "3.3,1:3.3,2:2.6,3:3.3",
                    "--flash-erase", "4")  # fmt: skip

    assert run.result[0] == 0
    assert run.summary["flash"]["weakened"] == 1
    assert 0 < flash.read_bytes()[0x10000:0x20000].count(b"\xff") < 0x8000


@pytest.mark.parametrize(
    ("supply", "mv", "needs"),
    [("3.3,4:3.3,5:2.6", 2699, 6), ("2.399", 2399, 7), ("2.099", 2099, 8)],
)
def test_a_low_supply_needs_more_wait_states(run_image, supply, mv, needs):
    run = run_image("spin", "--supply", supply, seconds=0.02)

    assert run.status == 1
    assert f"has 5 wait states and needs {needs} at 168 MHz and {mv} mV" in run.told


@pytest.mark.parametrize("text", ["", "x", "3.3,", "3.3,5", "3.3,5:", "3.3,5:4.1", "3.3,5:3,5:2"])
def test_a_supply_that_cannot_be_read_is_told(run_image, text):
    run = run_image("victim", "--supply", text)

    assert run.status == 1
    assert f"--supply {text}: not volts" in run.told


@pytest.mark.parametrize(
    ("option", "value"), [("--flash-kb", "768"), ("--revision", "B"), ("--revision", "A1"),
                          ("--thresholds", "middle"), ("--option-bytes", "x")],
)  # fmt: skip
def test_a_part_that_does_not_exist_is_told(run_image, option, value):
    run = run_image("victim", option, value)

    assert run.status == 2
    assert run.told.startswith(f"rkm04-vboard: {option} {value}: ")


def test_a_part_says_what_it_is(run_image):
    usual, other = run_image("loader"), run_image("loader", "--flash-kb", "512", "--revision", "A")

    assert usual.result[7:9] == [1024, 0x10076413]
    assert other.result[7:9] == [512, 0x20006411]


def test_a_smaller_part_has_no_memory_at_the_end(run_image):
    whole = run_image("loader", defines=["READ_LAST"])
    half = run_image("loader", "--flash-kb", "512", defines=["READ_LAST"])

    assert whole.result[9] == 0xFFFFFFFF
    assert half.summary["faults"]["count"] == 1


@pytest.mark.parametrize(
    ("sector", "told"), [(7, ""), (8, "sector 8 is erased, which a part of 512 kB does not have")]
)
def test_a_smaller_part_has_eight_sectors(run_image, sector, told):
    run = run_image("weak", "--flash-kb", "512", "--flash-erase", "1", defines=[f"SECTOR={sector}"])

    assert run.status == (1 if told else 0)
    assert told in run.told


def test_revision_a_has_no_prefetch(run_image):
    assert run_image("loader", "--revision", "Z", defines=["PREFETCH"]).status == 0
    run = run_image("loader", "--revision", "A", defines=["PREFETCH"])

    assert "revision A has no prefetch that works" in run.told


def test_a_cache_that_is_reset_while_it_is_on_is_told(run_image):
    assert "a cache is reset while it is on" in run_image("loader", defines=["RESET_CACHE"]).told


def test_a_boot_loader_leaves_clocks_interrupts_and_errors(run_image):
    result = run_image("loader", "--left-by-loader").result

    assert result[0] & 0x03030000 == 0x03030000  # PLL and HSE on and ready
    assert result[1] == 0xA  # SYSCLK is the PLL
    assert result[2] == 0xA0  # PGSERR, PGAERR
    assert result[3] == 0  # FLASH_CR is open
    assert result[4] == 7  # SysTick runs
    assert result[5] == 1 << 67 - 64  # USB is enabled and pending
    assert result[6] == 0x1FFF0000
    assert result[10] >> 8 & 7 == 6  # PRIGROUP: one bit
    assert result[11] == 1 << 6 | 1 << 7  # PB6 and PB7 are open drain


def test_a_boot_loader_leaves_a_task_of_its_system(run_image):
    result = run_image("loader", "--left-by-loader").result

    assert result[12] == 6  # CONTROL: the process stack, floating point
    assert 0x20003F00 < result[13] <= 0x20004000
    assert result[14:16] == [0x10, 1]  # BASEPRI, FAULTMASK
    assert result[16:18] == [4, 1]  # deep sleep, MPU


def test_a_deep_sleep_is_told(run_image):
    run = run_image("loader", "--left-by-loader", defines=["SLEEP"])

    assert "a deep sleep, in which all clocks stop" in run.told


def test_the_mpu_of_a_boot_loader_lets_nothing_in_sram_be_executed(run_image):
    run = run_image("loader", "--left-by-loader", defines=["RAM_CODE"])
    off = run_image("loader", "--left-by-loader", defines=["RAM_CODE", "MPU_OFF"])

    assert run.summary["watch"]["result"][31] == 0xDEAD0003  # HardFault
    assert off.result[18] == 1


def test_a_boot_loader_leaves_nothing_after_a_reset_of_all(run_image):
    result = run_image("loader", "--left-by-loader", defines=["RESET_ALL"]).result

    assert result[11] == 0


@pytest.mark.parametrize("define", ["WRITE", "TOO_SOON"])
def test_the_pll_takes_no_configuration_until_it_stands(run_image, define):
    run = run_image("loader", "--left-by-loader", defines=[define])

    assert "RCC_PLLCFGR must be written only while the PLL is off" in run.told


def test_reserved_bits_of_the_pll_are_kept(run_image):
    run = run_image("loader", defines=["RESERVED"])

    assert "RCC_PLLCFGR: reserved bits must be kept at their reset value, 20000000" in run.told


def test_the_pll_takes_no_configuration_while_that_of_i2s_runs(run_image):
    run = run_image("loader", defines=["I2S"])

    assert "RCC_PLLCFGR must be written only while the PLL is off, and the one of I2S" in run.told


@pytest.mark.parametrize(
    ("defines", "told"),
    [([], ""), (["CACHE"], "data cache may have the old word"), (["CACHE", "FORGET"], "")],
)
def test_a_read_after_an_erase_needs_the_data_cache_reset(run_image, defines, told):
    run = run_image("weak", defines=defines)

    assert run.status == (1 if told else 0)
    assert told in run.told


def test_old_errors_let_no_erase_begin(run_image):
    run = run_image("weak", "--left-by-loader", defines=["DIRTY"])

    assert run.result[0] & 1 << 7
    assert run.summary["flash"]["erases"] == 0


@pytest.mark.parametrize(
    ("define", "lost"),
    [
        ('AHB="2"', True),
        ('AHB="3"', False),
        ("READ_BACK", True),
        ('APB1="5"', True),
        ('APB1="6"', False),
    ],
)
def test_an_access_right_after_a_clock_enable_is_lost(run_image, define, lost):
    run = run_image("clock_enable", defines=[define])

    assert run.status == int(lost)
    assert ("so short a time ago that the access is lost" in run.told) == lost
