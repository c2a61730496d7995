"""The flash of the virtual board: keys, times, stalls, errors, power cuts."""

from __future__ import annotations

import struct

import pytest

LOCK = 1 << 31
PGSERR = 1 << 7
PGPERR = 1 << 6
SECTOR_4 = 0x10000
ERASED = 0xFFFFFFFF
WORDS = [0x11111111 * (i + 1) for i in range(8)]


def test_the_control_register_is_locked_until_both_keys_came(run_image):
    result = run_image("flash").result

    assert result[0] == LOCK
    assert result[1] == LOCK
    assert result[3] & LOCK == 0


def test_a_wrong_key_locks_until_the_next_reset(run_image):
    assert run_image("flash").result[16] == LOCK


def test_a_write_that_was_not_prepared_is_an_error(run_image):
    result = run_image("flash").result

    assert result[2] == PGSERR
    assert result[7] == PGPERR


def test_programming_only_clears_bits(run_image):
    assert run_image("flash").result[6] == 0xFFFF00FF & 0x00FFFFFF


def test_code_in_flash_waits_for_an_operation_and_code_in_ram_goes_on(run_image):
    result = run_image("flash").result

    assert result[4] < 20
    assert result[9] == pytest.approx(16 * 16, abs=20)  # 16 us at 16 MHz
    assert result[10] == 0x12345678
    assert result[11] == 1


def test_a_read_of_the_flash_by_code_in_ram_waits_too(run_image):
    assert run_image("flash").result[12] == pytest.approx(16 * 16, abs=20)


def test_an_erase_takes_its_time_and_leaves_ones(run_image):
    result = run_image("flash").result

    assert result[13] == 550
    assert result[14] == ERASED


def test_the_worst_times_are_longer(run_image):
    result = run_image("flash", "--slow-flash", seconds=3).result

    assert result[13] == 1100
    assert result[9] == pytest.approx(16 * 100, abs=20)


def test_no_interrupt_is_served_while_code_in_flash_waits(run_image):
    run = run_image("ram_vectors")

    assert run.result[0] == 1
    assert run.vector("SysTick")["latency_max"] > 549 * 16000


def read_words(path):
    return list(struct.unpack_from("<8I", path.read_bytes(), SECTOR_4))


def test_the_content_is_kept_in_a_file(run_image, tmp_path):
    run = run_image("store", "--flash", str(tmp_path / "flash"))

    assert run.result[0:2] == [9, 0]
    assert read_words(tmp_path / "flash") == WORDS


def test_an_operation_can_fail(run_image, tmp_path):
    run = run_image("store", "--flash", str(tmp_path / "flash"), "--flash-fail", "4")

    assert run.result[0:2] == [8, 1]
    assert read_words(tmp_path / "flash") == [*WORDS[:2], ERASED, *WORDS[3:]]


@pytest.mark.parametrize("how", ["wrp", "silent"])
def test_the_data_cache_has_a_word_that_the_flash_has_not_taken(run_image, tmp_path, how):
    flash = tmp_path / "flash"
    run = run_image("store", "--flash", str(flash), "--flash-fail", f"4:{how}", defines=["CACHED"])

    assert run.result[2:6] == [WORDS[2], ERASED, WORDS[2], ERASED]
    assert read_words(flash) == [*WORDS[:2], ERASED, *WORDS[3:]]


def test_a_word_that_is_written_once_more_is_in_the_flash_too(run_image, tmp_path):
    flash = tmp_path / "flash"
    defines = ["CACHED", "AGAIN"]
    run = run_image("store", "--flash", str(flash), "--flash-fail", "4", defines=defines)

    assert run.result[2:6] == [WORDS[2]] * 4
    assert read_words(flash) == WORDS


@pytest.mark.parametrize("operation", [2, 5, 9])
def test_power_can_be_cut_while_a_word_is_programmed(run_image, tmp_path, operation):
    run = run_image("store", "--flash", str(tmp_path / "flash"), "--power-cut", str(operation))
    written = operation - 2

    assert run.summary["ended"] == "power_cut"
    assert read_words(tmp_path / "flash") == [
        *WORDS[:written],
        WORDS[written] | 0xFFFF0000,
        *[ERASED] * (7 - written),
    ]


def test_power_can_be_cut_while_a_sector_is_erased(run_image, tmp_path):
    flash = tmp_path / "flash"
    flash.write_bytes(bytes(0x100000))
    run_image("store", "--flash", str(flash), "--power-cut", "1")

    content = flash.read_bytes()
    assert content[SECTOR_4 : SECTOR_4 + 0x8000] == b"\xff" * 0x8000
    assert content[SECTOR_4 + 0x8000 : SECTOR_4 + 0x10000] == bytes(0x8000)


OPTIONS = 0x0FFFAAED
"""OPTCR of a part as delivered, locked."""


def test_option_bytes_are_locked_until_both_keys_came(run_image):
    result = run_image("supply").result

    assert result[0:4] == [OPTIONS, OPTIONS, OPTIONS & ~1, OPTIONS & ~0xC]


def test_option_bytes_outlast_a_reset(run_image):
    run = run_image("supply", defines=["AGAIN"])

    assert run.result[14] == OPTIONS & ~0xC
    assert run.summary["flash"]["options"] == OPTIONS & ~0xD
    assert run.summary["flash"]["option_writes"] == 1
