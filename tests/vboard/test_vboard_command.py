"""The command line and the files of the virtual board."""

from __future__ import annotations

import os
import subprocess

import pytest

RESIDENT_KB_MAX = 900_000
"""More than the run itself needs: what its parent had counts."""


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ([], "no program"),
        (["--elf"], "--elf"),
        (["--nothing", "1"], "--nothing: no such option"),
        (["--elf", "x", "--for", "0"], "--for 0"),
        (["--elf", "x", "--refill", "4"], "--refill 4"),
        (["--elf", "x", "--stuck", "PZ0=1"], "--stuck PZ0=1"),
        (["--elf", "x", "--node", "17"], "--node 17"),
        (["--elf", "x", "--step-timer", "TIM3"], "write TIM2 or TIM5"),
    ],
)
def test_wrong_usage_is_one_line_and_status_2(program, options, told):
    done = subprocess.run([program, *options], capture_output=True, text=True, check=False)

    assert done.returncode == 2
    assert told in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("files", "told"),
    [
        ({"pins": "m5_step PA0\n"}, "no such signal"),
        ({"pins": "m1_step PA16\n"}, "no such pin"),
        ({"pins": "m1_step PA0\nm2_step PA0\n"}, "in use already"),
        ({"pins": "m1_step PA0 high\n"}, "`low` only"),
        ({"inputs": "5,9,1\n"}, "inputs:1: not a change"),
        ({"line": "1 4\n"}, "line-script:1: not a time and bytes"),
    ],
)
def test_a_malformed_file_is_one_line_and_status_1(run_image, files, told):
    run = run_image("preload", **files)

    assert run.status == 1
    assert told in run.told
    assert run.told.count("\n") == 1


def test_a_program_for_another_machine_is_refused(program, tmp_path):
    (tmp_path / "text").write_text("no program\n")
    command = [program, "--elf", tmp_path / "text"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)

    assert done.returncode == 1
    assert "not an ELF program for ARM" in done.stderr


def test_a_variable_is_shown_by_its_size(run_image):
    run = run_image("spin", "--watch", "steps", "--watch", "nothing")

    assert run.summary["watch"]["steps"] == 40000
    assert run.summary["watch"]["nothing"] is None


def test_statistics_can_begin_later(run_image):
    whole = run_image("spin").vector("TIM2")["count"]
    late = run_image("spin", "--measure-from", "30").vector("TIM2")["count"]

    assert 0 < late < whole


def test_the_stack_is_measured(run_image):
    stack = run_image("exceptions").summary["stack"]

    assert 2 * 32 <= stack["used"] < 256
    assert stack["bytes"] > 100_000


def test_the_waveform_has_the_signals_of_the_simulator(run_image):
    run = run_image("timer_compare", pins="m1_step PA0\nm2_step PA1\n")
    wave = (run.folder / "wave.vcd").read_text()

    names = [f"m{i}_{what}" for i in range(1, 5) for what in ("step", "dir", "led")]
    names += [f"{kind}{i}" for kind in ("bi", "bo") for i in range(1, 9)]
    names += [f"m{i}_{what}" for i in range(1, 5) for what in ("position", "speed")]
    assert all(f" {name} $end" in wave for name in names)
    assert "r168000.000" in wave  # 84 MHz / 500


def test_a_profile_counts_each_cycle_once(run_image, tmp_path):
    run = run_image("spin", "--profile", str(tmp_path / "profile.csv"))

    head, *lines = (tmp_path / "profile.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines]
    timer = [row for row in rows if row[0] == str(run.vector("TIM2")["number"])]
    entered = next(int(row[2]) for row in timer if row[1] == "entry")
    assert head == "exception,address,count,cycles,bus_cycles,register"
    assert sum(int(row[3]) for row in rows) == run.summary["cycles"]
    assert sum(int(row[3]) for row in timer) == run.vector("TIM2")["cycles"]
    assert entered == run.vector("TIM2")["count"]
    assert sum(int(row[2]) for row in rows if row[1][0] in "02") == run.summary["instructions"]


def test_a_profile_names_the_register_and_the_waiting_for_it(run_image, tmp_path):
    run_image("spin", "--profile", str(tmp_path / "profile.csv"))

    rows = [line.split(",") for line in (tmp_path / "profile.csv").read_text().splitlines()[1:]]
    accesses = [row for row in rows if row[5].startswith("4000")]
    assert any(int(row[4]) > 0 for row in accesses)
    assert all(row[5] for row in rows if int(row[4]) > 0)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("constant", "write SYMBOL=HEXBYTES"),
        ("nothing=00", "no such constant"),
        ("result=00", "no such constant"),
        ("constant=000000", "not 4 bytes"),
        ("constant=0000000G", "not 4 bytes"),
    ],
)
def test_what_cannot_be_set_is_one_line(run_image, text, told):
    run = run_image("preset", "--set", text)

    assert run.status == 1
    assert told in run.told
    assert run.told.count("\n") == 1


def test_a_constant_can_be_set(run_image):
    plain = run_image("preset")
    run = run_image("preset", "--set", "constant=78563412")

    assert plain.result[0] == 7
    assert run.result[0] == 0x12345678


@pytest.mark.skipif(not hasattr(os, "wait4"), reason="the system does not tell what a process used")
def test_a_run_takes_no_gigabyte_of_memory(program, build_image):
    elf = build_image("preset")
    run = subprocess.Popen([program, "--elf", elf, "--for", "0.01"], stdout=subprocess.DEVNULL)

    _, status, used = os.wait4(run.pid, 0)
    run.returncode = os.waitstatus_to_exitcode(status)

    assert run.returncode == 0
    assert used.ru_maxrss < RESIDENT_KB_MAX
