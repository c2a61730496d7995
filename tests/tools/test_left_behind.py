"""Nothing that a tool has started goes on when the tool ends, whatever ends it."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from chance import SEED
from rkm04_tools import child, host
from rkm04_tools.service.virtual import VirtualLine

MOMENTS = 25
PATIENCE_SECONDS = 10.0
AGAIN_SECONDS = 2.0
TOOLS = Path(__file__).resolve().parents[2] / "tools"
ENDLESS = "S2000 V16000 A60000 G+"


def processes(word: str) -> list[int]:
    """The numbers of the processes that have a word in their command line."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if word.encode() in path.read_bytes():
                found.append(int(path.parent.name))
        except OSError:  # it has just ended
            continue
    return found


def wait_until_gone(word: str) -> None:
    end = time.monotonic() + PATIENCE_SECONDS
    while left := processes(word):
        if time.monotonic() > end:
            for number in left:
                os.kill(number, signal.SIGKILL)
            raise AssertionError(f"left behind: {len(left)} processes")
        time.sleep(0.002)


def forked(work: Callable[[], object]) -> int:
    """A process that only does this, and has begun; it does nothing else of this one's at its end.

    What is raised while a process forks is passed by: a signal must not come before it has begun.
    """
    hears, tells = os.pipe()
    number = os.fork()
    if number == 0:
        try:
            os.write(tells, b"!")
            work()
        finally:
            os._exit(0)
    os.read(hears, 1)
    os.close(hears)
    os.close(tells)
    return number


def end(tool: int, number: int) -> None:
    """Send a signal and wait for the end; one that is passed by (see `forked`) is sent again."""
    until = time.monotonic() + PATIENCE_SECONDS
    again = 0.0
    while os.waitpid(tool, os.WNOHANG) == (0, 0):
        if (moment := time.monotonic()) > until:
            os.kill(tool, signal.SIGKILL)
            raise AssertionError("the tool itself does not end")
        if moment > again:
            os.kill(tool, number)
            again = moment + AGAIN_SECONDS
        time.sleep(0.001)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT], ids=["killed", "interrupted"])
def test_a_simulator_ends_with_the_tool_at_whatever_moment_that_ends(write, tmp_path, number):
    """The moments lie around that at which the child is started."""
    program, steps = write(ENDLESS), tmp_path / "steps.csv"
    arguments = ["--motor", f"1={program}", "--for", "100000", "--steps", str(steps)]
    chance = random.Random(SEED)

    for _ in range(MOMENTS):
        tool = forked(lambda: host.simulate(arguments))
        time.sleep(chance.uniform(0, 0.012))
        end(tool, number)
        wait_until_gone(str(steps))

    assert not steps.exists(), "half a file under its final name"


def test_a_request_to_end_leaves_no_half_of_a_file(write, tmp_path):
    folder = tmp_path / "made"
    folder.mkdir()
    command = [sys.executable, "-P", "-m", "rkm04_tools", "sim", write(ENDLESS)]
    more = ["--for", "100000", "--steps", folder / "steps.csv"]
    tool = subprocess.Popen(
        [*command, *more], env={**os.environ, "PYTHONPATH": str(TOOLS), "TMPDIR": str(tmp_path)}
    )
    before = time.monotonic()
    while not list(folder.iterdir()):
        assert time.monotonic() < before + PATIENCE_SECONDS
        time.sleep(0.02)

    tool.terminate()

    assert tool.wait(PATIENCE_SECONDS) == 128 + signal.SIGTERM
    assert list(folder.iterdir()) == []
    assert list(tmp_path.glob("rkm04-*")) == []
    wait_until_gone(str(folder))


def test_a_simulator_whose_tool_has_ended_before_it_begins_does_nothing(write, tmp_path):
    program, steps = write(ENDLESS), tmp_path / "steps.csv"
    command = [host.program_path(), "sim", "--motor", f"1={program}", "--steps", steps]
    somebody_else = {**os.environ, child.PARENT_VARIABLE: "1"}

    done = subprocess.run(command, env=somebody_else, capture_output=True, timeout=20)

    assert (done.returncode, done.stdout) == (1, b"")
    assert not list(tmp_path.glob("steps*"))


@pytest.mark.parametrize("late", [0.0, 0.01, 0.3])
def test_the_virtual_unit_of_the_service_ends_with_it(tmp_path, monkeypatch, late):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))

    def work() -> None:
        VirtualLine().open()
        time.sleep(PATIENCE_SECONDS)

    service = forked(work)
    time.sleep(late)
    end(service, signal.SIGKILL)

    wait_until_gone(str(tmp_path))


@pytest.mark.skipif(sys.platform != "linux", reason="what Linux does")
def test_a_script_ends_with_the_bench_that_has_started_it(tmp_path):
    word = f"import time; time.sleep(30) # {tmp_path}"

    def work() -> None:
        subprocess.run([sys.executable, "-c", word], preexec_fn=child.binder())

    bench = forked(work)
    while not processes(word) and os.waitpid(bench, os.WNOHANG) == (0, 0):
        time.sleep(0.002)
    end(bench, signal.SIGKILL)

    wait_until_gone(word)
