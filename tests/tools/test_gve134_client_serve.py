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
from rkm04_tools.gve134.answers import encoded
from rkm04_tools.gve134.link_errors import LineError
from rkm04_tools.gve134.probing import BEFORE, WORDS
from rkm04_tools.gve134.unit import open_unit

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_S = 60.0
Tool = Any
Start = Callable[..., "subprocess.Popen[str]"]


class ServedGve:
    """A running `gve134 serve`."""

    def __init__(self, tmp_path: Path, *options: str) -> None:
        command = [sys.executable, "-P", "-m", "rkm04_tools.gve134", "serve", "--tcp", "0"]
        self.process = subprocess.Popen(
            [*command, "--json", *options],
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

    def until_quiet(self) -> None:
        """Wait until nothing has moved for half a second of unit time.

        A unit is idle between packets, too: what a host has sent comes at the rate of the line.
        """
        since, travel = 0.0, None

        def is_quiet(state: Any) -> bool:
            nonlocal since, travel
            if state["travel"] != travel or not state["idle"]:
                since, travel = state["seconds"], state["travel"]
            return bool(state["seconds"] - since > 0.5)

        self.until(is_quiet)

    def end(self) -> None:
        self.process.send_signal(signal.SIGTERM)
        self.process.communicate(timeout=PATIENCE_S)


Serve = Callable[..., ServedGve]


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Serve]:
    """Start units."""
    units = []

    def start(*options: str) -> ServedGve:
        units.append(ServedGve(tmp_path, *options))
        return units[-1]

    yield start
    for unit in units:
        unit.end()


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
    served.until_quiet()
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

    assert process.returncode == 0
    assert told == (
        "gve134: X goes up to -100000 pulses to its switch at 1000 pulses/s, then up to 100000 "
        "off it at 500; Ctrl-C halts\n"
    )
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


def test_a_unit_and_the_simulator_refuse_a_closed_sensor_in_the_same_words(
    gve: Tool, served: ServedGve, tmp_path: Path
) -> None:
    job = file_of(tmp_path, "SW3,00\nSW1,80\nL0,0,-200\n;@probe\nC0,0,10\n")
    inputs = tmp_path / "closed.csv"
    inputs.write_text("0,8,0\n", encoding="utf-8")
    served.order("8=0")

    sent, simulated = gve("send", job), gve("sim", job, "--inputs", inputs)

    assert (sent.status, simulated.status) == (1, 1)
    assert WORDS[BEFORE] in sent.err
    assert WORDS[BEFORE] in simulated.err
    assert served.order("?")["positions"] == [0, 0, 0, 0]


def test_a_halt_comes_through_beside_a_job_and_ends_it(
    gve: Tool, start_gve: Start, served: ServedGve, tmp_path: Path
) -> None:
    process = start_gve("send", file_of(tmp_path, "V1000\nC90000,1\n"))
    served.until(lambda state: state["positions"][0] > 100)

    assert gve("position").status == 3
    halt = gve("halt")
    _, told = process.communicate(timeout=PATIENCE_S)

    assert (halt.status, process.returncode) == (0, 1)
    assert "stopped, the rest of the vectors waits" in halt.out
    assert "INTERRUPTED by H; the axes stand" in told
    assert gve("delete").status == 0


def test_a_jog_that_another_one_halts_leaves_nothing_in_the_queue(
    gve: Tool, start_gve: Start, served: ServedGve
) -> None:
    process = start_gve("jog", "X100000", "--speed", "200")
    served.until(lambda state: state["positions"][0] > 10)

    halt = gve("halt")
    _, told = process.communicate(timeout=PATIENCE_S)

    assert (halt.status, process.returncode) == (0, 1)
    assert "INTERRUPTED by H, its rest is deleted; the axes stand at" in told
    assert gve("go").status == 1
    assert gve("status", "--json").json["state"] == "at rest"


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


BAD_LINE = ("--noise", "300", "--loss", "300", "--seed")


@pytest.mark.parametrize("seed", ["2", "3"])
def test_a_job_over_the_bad_line_of_a_unit_is_executed_to_the_pulse(
    gve: Tool, serve: Serve, tmp_path: Path, seed: str
) -> None:
    unit = serve(*BAD_LINE, seed)
    job = "A2000\nV50000\nB50000\n" + "C10,20,-1\nC3,-7,0,2\n" * 300

    answer = gve("send", file_of(tmp_path, job), "--json", "--port", unit.place).json

    assert answer["positions"] == {"X": 3900, "Y": 3900, "Z": -300, "A": 600}
    assert answer["executed"] == 600
    assert answer["repairs"] > 0
    assert unit.order("?")["travel"] == [3900, 3900, -300, 600]


@pytest.mark.parametrize("seed", ["2", "3"])
def test_ctrl_c_halts_a_job_over_a_bad_line_and_tells_where_the_axes_stand(
    start_gve: Start, serve: Serve, tmp_path: Path, seed: str
) -> None:
    unit = serve(*BAD_LINE, seed)
    path = file_of(tmp_path, "A50\nV1000\nB1000\n" + "C20,-10\n" * 2000)
    process = start_gve("send", path, "--port", unit.place)
    unit.until(lambda state: state["positions"][0] > 100)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=PATIENCE_S)

    state = unit.order("?")
    x, y, *_ = state["positions"]
    assert process.returncode == 130
    assert f"the axes stand at X {x}  Y {y}  Z 0  A 0; stopped, the rest of the vectors" in told
    assert f"; {x // 20} of 2000 vectors were executed" in told
    assert not any(state["moving"])


def test_a_host_that_dies_in_a_packet_leaves_nothing_of_it_and_a_line_in_step(
    gve: Tool, served: ServedGve, tmp_path: Path
) -> None:
    with open_unit(served.place) as unit:
        unit.order("V5000")
        packet = "*S", "C100,0,0,0", "C100,0,0,0"
        unit.link.wire.write(b"".join(encoded(each, sums=True) for each in packet) + b"!0C10")

    answer = gve("send", file_of(tmp_path, "C7,8\n"), "--json").json

    assert answer["positions"] == {"X": 7, "Y": 8, "Z": 0, "A": 0}
    assert served.order("?")["travel"] == [7, 8, 0, 0]


def test_a_host_that_is_killed_leaves_whole_packets_only(
    gve: Tool, start_gve: Start, served: ServedGve, tmp_path: Path
) -> None:
    path = file_of(tmp_path, "A2000\nV50000\nB50000\n" + "C10,20,-1\n" * 3000)
    process = start_gve("send", path)
    served.until(lambda state: state["positions"][0] > 500)
    process.kill()
    process.communicate(timeout=PATIENCE_S)
    served.until_quiet()

    at = gve("position", "--json").json
    assert (at["Y"], at["Z"]) == (2 * at["X"], -at["X"] // 10)
    assert at["X"] % 10 == 0
    assert gve("send", file_of(tmp_path, "C1\n")).status == 0


def test_a_restart_in_the_middle_of_a_job_is_told_loudly_and_nothing_goes_on(
    start_gve: Start, serve: Serve, tmp_path: Path
) -> None:
    before, after = serve(), serve()
    noisy = NoisyLine(before.place.removeprefix("socket://"), 1, 0.0, echo=False)
    try:
        path = file_of(tmp_path, "A2000\nV50000\nB50000\n" + "C10,20,-1\n" * 3000)
        process = start_gve("send", path, "--port", noisy.port)
        before.until(lambda state: state["positions"][0] > 500)
        noisy.restarted_as = after.place.removeprefix("socket://")
        _, told = process.communicate(timeout=PATIENCE_S)
    finally:
        noisy.close()

    assert process.returncode == 3
    assert "HAS RESTARTED: its queue, positions and settings are gone" in told
    assert after.order("?")["travel"] == [0, 0, 0, 0]
    with open_unit(after.place) as unit:
        assert not unit.flags().bits


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
