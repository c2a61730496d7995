"""mbpoll, which is libmodbus, reads and writes every register, by Modbus TCP and by RTU."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from rkm04_tools.positioning.listing import places
from rkm04_tools.positioning.table import Register
from served import Served

VALUE = re.compile(r"^\[(\d+)\]:\s+0x([0-9A-F]{4})", re.MULTILINE)
NAME = "mbpoll"
Serve = Callable[..., Served]
Ask = Callable[..., subprocess.CompletedProcess[str]]

pytestmark = pytest.mark.skipif(
    not shutil.which(NAME), reason="mbpoll is not installed: run tools/setup test"
)


@pytest.fixture(params=["tcp", "rtu"])
def ask(request: pytest.FixtureRequest, pos_serve: Serve, tmp_path: Path) -> Ask:
    """Call mbpoll for a unit."""
    if request.param == "tcp":
        served = pos_serve("--unpaced", place="--modbus-tcp")
        host, _, port = served.place.removeprefix("modbus://").rpartition(":")
        line = ["-m", "tcp", "-p", port, host]
    else:
        pos_serve("--unpaced", place="--pty", at=str(tmp_path / "unit"))
        line = ["-m", "rtu", "-b", "19200", "-P", "none", str(tmp_path / "unit")]

    def call(*arguments: str | int, values: list[int] | None = None):
        command = [NAME, "-0", "-1", "-q", "-o", "2", *map(str, arguments), *line]
        return subprocess.run(
            [*command, *map(str, values or [])], capture_output=True, text=True, timeout=30
        )

    return call


def words(answer: subprocess.CompletedProcess[str]) -> list[int]:
    assert answer.returncode == 0, answer
    return [int(value, 16) for _, value in VALUE.findall(answer.stdout)]


def own(row: Register) -> int:
    """A value to write that differs from the delivered one where there is one."""
    if row.form == "RATE":
        return 1152
    if row.form in ("RECORD", "CODE", "FACTOR"):
        return {"RECORD": 1, "CODE": 0, "FACTOR": row.start * 2}[row.form]
    return row.most if row.form != "ANY" else row.all_values[-1]


def test_every_register_is_read(ask: Ask):
    for place in places():
        row = place.register
        found = words(ask("-t", "4:hex", "-r", place.number, "-c", row.words))
        assert len(found) == row.words
        if row.access != "r":
            assert row.of_words(found) == row.start


def test_every_register_that_is_only_read_is_an_input_register(ask: Ask):
    for place in places():
        row = place.register
        answer = ask("-t", "3:hex", "-r", place.number, "-c", row.words)
        if row.access == "r":
            assert len(words(answer)) == row.words
        else:
            assert "Illegal data address" in answer.stderr


def test_every_register_is_written_that_can_be(ask: Ask):
    for place in places():
        row = place.register
        if row.name == "STORE":
            continue
        written = ask("-t", 4, "-r", place.number, values=row.to_words(own(row)))
        if row.access == "r":
            assert "Illegal data address" in written.stderr
            continue
        assert written.returncode == 0, written
        found = words(ask("-t", "4:hex", "-r", place.number, "-c", row.words))
        # POS_CONTROL takes nothing of an axis that is free
        taken = own(row) if row.use != "MOTION" else 0
        assert row.of_words(found) == taken, place


def test_the_images_are_read_and_written(ask: Ask):
    full = [word for axis in range(4) for word in (0x0101, 0, 0, 1000 + axis, 500, 1, 0, 0)]

    assert ask("-t", 4, "-r", 600, values=full).returncode == 0
    assert words(ask("-t", "4:hex", "-r", 600, "-c", 32)) == full
    assert words(ask("-t", "3:hex", "-r", 640, "-c", 32)) == [1, 0, 0x0101, 0, 0, 0, 0, 0] * 4
    assert words(ask("-t", "4:hex", "-r", 500, "-c", 12)) == [1, 0, 0] * 4
    assert ask("-t", 4, "-r", 500, values=[0] * 12).returncode == 0
    assert words(ask("-t", "4:hex", "-r", 500, "-c", 12)) == [0] * 12
    assert words(ask("-t", "3:hex", "-r", 520, "-c", 16)) == [1, 0, 0, 0] * 4


def test_half_a_value_and_what_is_not_there_are_refused(ask: Ask):
    for number, count in [(6, 1), (102, 1), (28, 1), (108, 1), (107, 1), (520, 3), (700, 1)]:
        assert "Illegal data address" in ask("-t", "4:hex", "-r", number, "-c", count).stderr
