"""The USART of the virtual board and the RS-485 line after it."""

from __future__ import annotations

import socket
import subprocess
import time

import pytest
from rkm04_tools import virtual_board

PINS = "line USART2\nde PA1\n"
BYTE_MS = 10 / 19.2
FRAMING = 2
NOISE = 4
OVERRUN = 8
IDLE = 0x10
RECEIVED = 0x20


def test_bytes_come_in_and_are_answered(run_image):
    run = run_image("serial", pins=PINS, line="2 41\n5 0aff\n7 FF*\n")

    assert [byte for _, byte in run.log] == ["42", "0B", "00"]
    assert [word & 0xFF for word in run.summary["watch"]["result"][:3]] == [0x41, 0x0A, 0xFF]


@pytest.mark.parametrize(
    ("defines", "pins", "breaks"),
    [
        ([], PINS, 0),
        (["DRIVER_ON"], PINS, 1),
        ([], "line USART2\n", 1),
        (["PINS_LAST"], "line USART2\n", 0),
    ],
)
def test_a_pin_of_a_transmitter_that_is_off_is_low(run_image, defines, pins, breaks):
    run = run_image("serial", pins=pins, line="2 41\n7 FF*\n", defines=defines)

    assert run.summary["line"]["breaks"] == breaks


def test_a_byte_takes_as_long_as_the_rate_says(run_image):
    run = run_image("serial", pins=PINS, line="2 41\n5 0A\n", seconds=0.02)

    (first, _), (second, _) = run.log
    assert first == pytest.approx(
        2 + 0.95 * BYTE_MS, abs=0.02
    )  # received in the middle of the stop bit
    assert second - first == pytest.approx(3, abs=0.01)


def test_errors_of_a_byte_are_in_the_status(run_image):
    run = run_image("serial", pins=PINS, line="2 41*\n5 42~\n8 43\n", seconds=0.02)
    words = run.summary["watch"]["result"]

    assert words[0] >> 8 & (FRAMING | NOISE | RECEIVED) == FRAMING | RECEIVED
    assert words[1] >> 8 & (FRAMING | NOISE | RECEIVED) == NOISE | RECEIVED
    assert words[2] >> 8 & (FRAMING | NOISE | RECEIVED) == RECEIVED


def test_another_rate_gives_framing_errors(run_image):
    run = run_image("serial", "--baud", "9600", pins=PINS, line="2 41\n", seconds=0.02)

    assert run.summary["watch"]["result"][0] >> 8 & FRAMING
    assert run.summary["line"]["unheard"] == 1
    assert run.log[0][1].endswith("*")


def test_an_overrun_keeps_the_first_byte(run_image):
    run = run_image("overrun", pins="line USART2\n", line="2 41 42 43\n")

    assert run.result[0] & (OVERRUN | RECEIVED) == OVERRUN | RECEIVED
    assert run.result[1] == 0x41
    assert run.result[2] & (OVERRUN | RECEIVED) == 0
    assert run.result[3] & IDLE
    assert run.summary["line"]["overruns"] == 2


def test_the_time_to_release_the_bus_is_measured(run_image):
    run = run_image("serial", pins=PINS, line="2 41\n", seconds=0.02)

    assert 0 < run.summary["line"]["release_max"] < 10


def test_a_byte_is_not_heard_while_the_unit_drives_the_bus(run_image):
    # The answer to the first byte is on the bus when the second one comes.
    run = run_image("serial", pins=PINS, line="2 41 42\n", seconds=0.02)

    assert run.summary["line"]["collisions"] == 1
    assert len(run.log) == 1


def test_a_byte_that_is_sent_with_the_driver_off_reaches_nobody(run_image):
    run = run_image("serial", pins="line USART2\nde PA0\n", line="2 41\n", seconds=0.02)

    assert run.summary["line"]["sent"] == 0
    assert run.log[0][1] == "42*"


def test_a_client_over_tcp_talks_with_the_unit_in_real_time(program, build_image, tmp_path):
    (tmp_path / "pins").write_text(PINS)
    command = [program, "--elf", build_image("serial"), "--pins", tmp_path / "pins"]
    command += ["--tcp", "0", "--for", "0.3"]
    with subprocess.Popen(
        list(map(str, command)), stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stderr
        where = process.stderr.readline()
        port = int(where.strip().rpartition(":")[2])
        started = time.monotonic()
        with socket.create_connection(("127.0.0.1", port)) as client:
            client.settimeout(5)
            client.sendall(b"\x30")
            assert client.recv(1) == b"\x31"
        process.communicate(timeout=10)
        assert process.returncode == 0
        assert time.monotonic() - started > 0.1


def test_a_client_over_a_pseudo_terminal_talks_with_the_unit(program, build_image, tmp_path):
    (tmp_path / "pins").write_text(PINS)
    command = [program, "--elf", build_image("serial"), "--pins", tmp_path / "pins"]
    command += ["--pty", tmp_path / "line", "--for", "0.3"]
    with subprocess.Popen(
        list(map(str, command)), stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stderr
        process.stderr.readline()
        with (tmp_path / "line").open("r+b", buffering=0) as client:
            client.write(b"\x30")
            assert client.read(1) == b"\x31"
        process.communicate(timeout=10)
        assert process.returncode == 0
    assert not (tmp_path / "line").is_symlink()


def test_a_client_in_virtual_time_says_when_and_hears_at_once(program, build_image, tmp_path):
    (tmp_path / "pins").write_text(PINS)
    arguments = ["--elf", build_image("serial"), "--pins", tmp_path / "pins", "--lockstep"]
    with virtual_board.Talk(program, [*map(str, arguments), "--for", "1"]) as talk:
        assert talk.until(5.0) == b""
        assert talk.ms == 5.0
        talk.say(b"\x30")
        assert talk.until(20.0) == b"\x31"
        assert 5.0 < talk.ms < 20.0
        assert talk.until(20.0) == b""
        summary = talk.end()

    assert summary["ended"] == "time"
    assert summary["microseconds"] == pytest.approx(20_000, abs=1)


@pytest.mark.parametrize("order", ["until soon", "wire PA0", "wire", "wires PA0=PA1", "say 4"])
def test_an_order_in_virtual_time_that_makes_no_sense_ends_the_run(program, build_image, order):
    command = [program, "--elf", build_image("serial"), "--lockstep"]
    done = subprocess.run(
        list(map(str, command)), input=f"{order}\n", capture_output=True, text=True, check=False
    )

    assert done.returncode == 1
    assert "`until MS`" in done.stdout + done.stderr


def falls_and_rises(run) -> list[float]:
    """Bits from the first edge of a byte to each; levels must alternate, and end high."""
    edges = run.result[: run.result[30]]
    assert [edge & 1 for edge in edges] == [0, 1] * (len(edges) // 2)
    return [(edge >> 1) / 8 for edge in edges]


@pytest.mark.parametrize(
    ("line", "form", "bits"),
    [
        ("55", "8N1", [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]),
        ("00", "8N1", [0, 9]),
        ("80", "8N2", [0, 8]),
        ("FF", "8E1", [0, 1, 9, 10]),
        ("FF!", "8E1", [0, 1]),
        ("01", "8O1", [0, 1, 2, 10]),
        ("FF00", "8N1", [0, 1, 10, 19]),
    ],
)
def test_each_bit_is_to_be_seen_at_the_pin_of_the_receiver(run_image, line, form, bits):
    options = ("--baud", "115200", "--format", form)
    run = run_image("line_levels", *options, pins="line USART1\n", line=f"1 {line}\n")

    assert falls_and_rises(run) == pytest.approx(bits, abs=0.2)


def test_a_wrong_stop_bit_is_low_up_to_its_middle(run_image):
    run = run_image("line_levels", "--baud", "115200", pins="line USART1\n", line="1 00*\n")

    assert falls_and_rises(run) == pytest.approx([0, 9.5], abs=0.2)
