"""The commands of `gve134` with the firmware itself at the other end of the line."""

from __future__ import annotations

import io
import json
import os
import random
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from noisy_line import NoisyLine
from rkm04_tools.gve134.link_errors import LineError
from rkm04_tools.gve134.unit import open_unit

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_S = 60.0
Tool = Any
Start = Callable[..., "subprocess.Popen[str]"]


class ServedGve:
    """A running `gve134 serve`."""

    def __init__(self, tmp_path: Path) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-m", "rkm04_tools.gve134", "serve", "--tcp", "0", "--json"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
        )  # fmt: skip
        assert self.process.stdout is not None
        self.place: str = json.loads(self.process.stdout.readline())["listening"]

    def order(self, text: str) -> Any:
        """Change an input, or ask for the state."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(f"{text}\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def until(self, reached: Callable[[Any], bool]) -> None:
        """Wait until it has come to a state."""
        end = time.monotonic() + PATIENCE_S
        while not reached(state := self.order("?")):
            assert time.monotonic() < end, state
            time.sleep(0.01)

    def end(self) -> None:
        self.process.send_signal(signal.SIGTERM)
        self.process.communicate(timeout=PATIENCE_S)


@pytest.fixture
def served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ServedGve]:
    unit = ServedGve(tmp_path)
    monkeypatch.setenv("GVE134_PORT", unit.place)
    yield unit
    unit.end()


def file_of(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "a.gve"
    path.write_text(text)
    return path


def test_a_job_is_executed_to_the_pulse(gve: Tool, served: ServedGve, tmp_path: Path) -> None:
    lines = [f"C{n % 50},{-n % 70},3,1" for n in range(700)]
    job = "A2000\nV20000\nB20000\nL100\n" + "\n".join(lines) + "\nNZ0\nL0,0,5\n"

    answer = gve("send", file_of(tmp_path, job), "--json").json

    x, y = 100 + sum(n % 50 for n in range(700)), sum(-n % 70 for n in range(700))
    assert answer["positions"] == {"X": x, "Y": y, "Z": 5, "A": 700}
    assert answer["vectors"] == 702
    assert answer["repairs"] == 0


def test_every_reading_command_works(gve: Tool, served: ServedGve) -> None:
    assert gve("position", "--latched").status == 0
    assert gve("status", "--json").json["late_pulses"] == 0
    assert gve("watch", "--count", "2", "--interval", "0.05").status == 0


def test_memory_comes_back(gve: Tool, served: ServedGve, tmp_path: Path) -> None:
    path = tmp_path / "unit.mem"
    assert gve("memory", "backup", path).status == 0
    assert gve("memory", "set", "20", "0.1", "--as", "float").out == "20: 0.100000001\n"
    assert gve("memory", "diff", path).status == 1
    assert gve("memory", "restore", path).status == 0
    assert gve("memory", "get", "20", "--as", "word").out == "20: FFFFFFFF\n"


def test_an_interrupt_is_told_with_its_cause_and_the_rest_goes_on(
    gve: Tool, start_gve: Start, served: ServedGve, tmp_path: Path
) -> None:
    process = start_gve("send", file_of(tmp_path, "SW0,02\nV1000\nL0,2000\nC0,50\n"))
    served.until(lambda state: state["positions"][1] > 100)
    served.order("2=0")
    _, told = process.communicate(timeout=PATIENCE_S)

    assert process.returncode == 1
    assert "INTERRUPTED by RefY, positions at that moment 0," in told
    assert gve("go").complaint.startswith("gve134: it goes on, and is interrupted at once by RefY")
    served.order("2=1")
    assert gve("go").status == 0
    gve("send", file_of(tmp_path, "L0,0,0,0\n"))
    assert gve("position", "--json").json["Y"] == 2050


def test_ctrl_c_halts_a_job(gve: Tool, start_gve: Start, served: ServedGve, tmp_path: Path) -> None:
    process = start_gve("send", file_of(tmp_path, "V1000\nL100000\n"))
    served.until(lambda state: state["positions"][0] > 100)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=PATIENCE_S)

    assert process.returncode == 130
    assert "the axes stand at X " in told
    assert gve("status", "--json").json["causes"] == ["H"]
    assert gve("delete").status == 0


def test_a_reference_run_finds_its_switch(gve: Tool, start_gve: Start, served: ServedGve) -> None:
    process = start_gve("home", "X", "-100000", "1000", "100000", "500")
    served.until(lambda state: state["positions"][0] < -500)
    served.order("1=0")
    at = served.order("?")["positions"][0]
    served.until(lambda state: state["positions"][0] > at + 50)
    served.order("1=1")
    out, told = process.communicate(timeout=PATIENCE_S)

    assert (process.returncode, told) == (0, "")
    assert out.startswith("X stands where its switch lets go, at ")
    assert served.order("?")["idle"]


def test_a_probe_comes_back_to_where_it_was_touched(
    gve: Tool, start_gve: Start, served: ServedGve, tmp_path: Path
) -> None:
    job = "SW3,00\nSW1,80\nA1\nV1000\nL0,0,-20000\n;@probe\nC0,0,10\n"
    process = start_gve("send", file_of(tmp_path, job))
    served.until(lambda state: state["positions"][2] < -200)
    served.order("8=0")
    out, told = process.communicate(timeout=PATIENCE_S)

    latched, stand = gve("position", "--latched", "--json").json, gve("position", "--json").json
    assert (process.returncode, told) == (0, "")
    assert "3 vectors" in out or "2 vectors" in out
    assert latched["Z"] < -100
    assert stand["Z"] == latched["Z"] + 10


@pytest.mark.parametrize("seed", range(4))
def test_each_line_of_a_console_has_one_answer_or_is_not_sent(
    gve: Tool, served: ServedGve, monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    rng = random.Random(seed)
    names = [*"LCT$AVBXPNHGDKRFQOZ?@>%*S", "VK", "VL", "XM", "P4", "PL", "SR", "SW", "I1"]
    names += ["ER", "EUR", "EW", "EFW", "EFR", "!7V", "!7", "!3", "%+", "J"]
    values = ["", "0", "5", "-7", "A0", "x", "999999999999", "1.5"]
    lines = []
    for _ in range(150):
        count = rng.choice([0, 0, 1, 1, 1, 2, 4, 20])
        lines.append(rng.choice(names) + ",".join(rng.choice(values) for _ in range(count)))
    lines = [line for line in lines if line != "*S"]
    typed = "\n".join([*lines, "P4"])
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(typed.encode())))

    result = gve("console")

    answers = result.out.splitlines()
    assert "Traceback" not in result.err
    assert all(re.match(r"[0-9A-F](,\S.*)?  [a-z]", answer) for answer in answers), answers
    assert len(answers) + result.err.count(": not sent: ") == len(lines) + 1
    assert re.match(r"[08](,-?\d+){4}  done", answers[-1])


@pytest.mark.parametrize("seed", range(12))
def test_on_a_bad_line_a_job_arrives_once_or_is_given_up(
    served: ServedGve, gve: Tool, tmp_path: Path, seed: int
) -> None:
    noisy = NoisyLine(served.place.removeprefix("socket://"), seed, 0.02, echo=False)
    try:
        result = gve(
            "send", file_of(tmp_path, "A2000\nV50000\nB50000\n" + "C10,20,-1\n" * 300), "--json",
            "--port", noisy.port,
        )  # fmt: skip
    finally:
        noisy.close()

    if result.status == 0:
        assert result.json["positions"] == {"X": 3000, "Y": 6000, "Z": -300, "A": 0}
        return
    assert result.status in (1, 3)  # given up, or a damage that its sum does not show
    with open_unit(served.place) as unit:
        unit.wait_until_stands()
        x, y, z, _ = unit.positions()
    assert (y, z) == (2 * x, -x // 10)
    assert x <= 3000


@pytest.mark.parametrize("seed", range(12))
def test_a_halt_gets_through_a_bad_line(served: ServedGve, seed: int) -> None:
    with open_unit(served.place) as unit:
        unit.order("L1000000")
    noisy = NoisyLine(served.place.removeprefix("socket://"), seed, 0.1, echo=False)
    try:
        with open_unit(noisy.port) as unit:
            unit.link.halt()
    except LineError:
        pass  # what comes after the halt may fail; the axes must stand all the same
    finally:
        noisy.close()
    with open_unit(served.place) as unit:
        assert unit.flags().stands
