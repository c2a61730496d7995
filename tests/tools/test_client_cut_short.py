"""A line that is lost, or a person who ends a command, in the middle: what is not known is told."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from fake_unit import MOVING, RUNNING, STOPPED, FakeLine, FakeUnit, lost
from rkm04_tools import acting
from rkm04_tools.client_base import PORT_VARIABLE
from rkm04_tools.doubt import interrupted_by_any_end
from rkm04_tools.line import ATTEMPTS, Wait
from statuses import Vector

NODE = 3
GET_STATUS = b"\x10"
LONG = "\\ C100 S500 " + "W1000 F1000 R " * 220
"""Three messages."""
OWN_BRACKETS = LONG + "[ W1 ]"
MOVES = b"  2;[(1;100),(9;0)]"


@pytest.fixture
def unit():
    return FakeUnit(NODE, programs={1: b"C100R", 2: b"", 3: b"", 4: b""})


def acts(unit: FakeUnit) -> list[bytes]:
    """The Set Command messages."""
    return [done for done in unit.done if done[0] == 2]


def silent_after(fake: FakeLine, unit: FakeUnit, is_last: Callable[[bytes], bool]) -> None:
    """No answer to what is meant comes back, and none to what follows."""

    def fault(answer: bytes) -> bytes:
        return b"" if any(map(is_last, unit.done)) else answer

    fake.faults += [fault] * 1000


def has(text: bytes) -> Callable[[bytes], bool]:
    return lambda message: message[0] == 2 and text in message


def started(start, fake: FakeLine, unit: FakeUnit, *arguments) -> subprocess.Popen[str]:
    """A command as a process, when it waits for an answer that does not come."""
    process: subprocess.Popen[str] = start(*arguments, "--port", fake.port)
    end = time.monotonic() + 20
    while len(fake.requests) < 2 or fake.requests[-1] != fake.requests[-2]:
        assert time.monotonic() < end, process.communicate(timeout=1)
        time.sleep(0.01)
    return process


def test_a_stop_on_a_port_that_cannot_be_opened_calls_for_the_emergency_stop(tool):
    result = tool("stop", "--port", "socket://127.0.0.1:1")

    assert result.status == 3
    assert result.complaint.startswith("rkm04: NOT CONFIRMED: K: socket://127.0.0.1:1: nobody ")
    assert result.complaint.endswith("; use the emergency stop")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_stop_that_is_cut_short_calls_for_the_emergency_stop(start, fake, unit, number):
    silent_after(fake, unit, has(b"K"))
    process = started(start, fake, unit, "stop")

    process.send_signal(number)
    out, err = process.communicate(timeout=10)

    assert (process.returncode, out) == (130, "")
    assert err == "rkm04: NOT CONFIRMED: K: interrupted; use the emergency stop\n"


def test_an_end_that_is_to_be_ignored_stays_ignored():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with interrupted_by_any_end():
            assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
            assert signal.getsignal(signal.SIGTERM) == signal.default_int_handler
        assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


@pytest.mark.parametrize(
    ("command", "order"),
    [(["resume"], b"C75"), (["reset"], b"\\"), (["speed", "500"], b"V500")],
)
def test_an_order_that_nobody_answers_may_have_been_taken(tool, fake, unit, command, order):
    unit.states[0] = RUNNING | MOVING
    silent_after(fake, unit, has(order))

    result = tool(*command, "--motor", "1")

    assert (result.status, acts(unit)) == (3, [b"\x021" + order])
    assert result.complaint.startswith(f"rkm04: NOT CONFIRMED: whether {order.decode()} was taken")
    assert "does not answer" in result.complaint
    assert result.complaint.endswith(f"; {acting.MAY_MOVE}")


def test_an_order_that_was_not_sent_is_in_no_doubt(tool, fake, unit):
    silent_after(fake, unit, lambda message: True)

    result = tool("resume")

    assert result.status == 3
    assert "NOT CONFIRMED" not in result.complaint
    assert acts(unit) == []


SENT = [
    # what is sent, what the unit gets before it falls silent, what is not known, what is
    ("\\ F100 R", has(b"F100"), "whether {} was taken, and runs: ", acting.MAY_MOVE),
    ("\\ F100 R", lambda message: message[0] > 7, "{} was taken, but what the motor does: ",
     acting.MAY_MOVE),
    (LONG, has(b"[C100"), "how much of {} was taken: what there is of it waits for the rest: ",
     "0 of 3 messages taken; what was in the memory before may be gone; rkm04 reset forgets it"),
    (OWN_BRACKETS, has(b"\\["),
     "how much of {} was taken: rkm04 resume would run what there is of it: ",
     "0 of 3 messages taken; what was in the memory before may be gone; do not resume: rkm04 "),
    (OWN_BRACKETS, has(b"W1]"),
     "how much of {} was taken: rkm04 resume would run what there is of it: ",
     "2 of 3 messages taken; what was in the memory before is gone; do not resume: rkm04 reset"),
    (LONG, has(b"R]"), "whether {} was taken whole, and runs: ", "2 of 3 messages taken"),
    (OWN_BRACKETS, has(b"C75"), "{} was taken, but what the motor does: ", acting.MAY_MOVE),
]  # fmt: skip


@pytest.mark.parametrize(("text", "last", "what", "known"), SENT)
def test_a_send_that_is_cut_short_tells_what_may_run(tool, fake, unit, write, text, last, what,
                                                     known):  # fmt: skip
    file = write(text)
    unit.tables[1] = b"  0;[]"
    silent_after(fake, unit, last)

    result = tool("send", file)

    assert result.status == 3
    assert result.complaint.startswith(f"rkm04: NOT CONFIRMED: {what.format(file)}")
    assert known in result.complaint


@pytest.mark.parametrize("text", ["\\ F100 R", LONG, OWN_BRACKETS])
def test_a_send_to_a_unit_that_is_not_there_is_in_no_doubt(tool, fake, unit, write, text):
    silent_after(fake, unit, lambda message: True)

    result = tool("send", write(text))

    assert result.status == 3
    assert "does not answer" in result.complaint
    assert "NOT CONFIRMED" not in result.complaint
    assert "memory" not in result.complaint
    assert acts(unit) == []


@pytest.mark.parametrize(
    ("command", "last", "state"),
    [
        (["send"], b"F100", 0),
        (["resume"], b"C75", STOPPED),
        (["reset"], b"\\", RUNNING | MOVING),
        (["speed", "500"], b"V500", RUNNING | MOVING),
    ],
)
def test_a_unit_that_restarts_after_an_order_is_told(tool, fake, unit, write, command, last, state):
    unit.states[0] = state
    is_last = has(last)

    def fault(answer: bytes) -> bytes:
        if is_last(unit.done[-1]):
            unit.restart()
        return answer

    fake.faults += [fault] * 1000
    file = [write("\\ F100 R")] if command == ["send"] else []

    result = tool(*command, *file, "--motor", "1")

    assert result.status == 3
    assert "has restarted, the request was executed before that or not at all" in result.complaint


def test_an_interrupted_send_tells_it_too(start, fake, unit, write):
    silent_after(fake, unit, has(b"[C100"))
    process = started(start, fake, unit, "send", write(LONG), "--node", NODE)

    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=10)

    assert process.returncode == 130
    assert (
        "waits for the rest: interrupted; 0 of 3 messages taken; what was in the memory before may"
        in err
    )


CUTS: list[Callable[[FakeLine], object]] = [
    lambda fake: os.kill(os.getpid(), signal.SIGINT),
    lambda fake: fake.faults.extend([lost] * ATTEMPTS),
]


def cut_at(
    fake: FakeLine, monkeypatch: pytest.MonkeyPatch, text: bytes, cut: Callable[[FakeLine], object]
) -> None:
    """Cut the command short, once, when the unit takes what is meant."""
    original, cuts = FakeUnit.execute, [cut]

    def execute(unit: FakeUnit, message: bytes) -> bytes:
        if has(text)(message) and cuts:
            cuts.pop()(fake)
        return original(unit, message)

    monkeypatch.setattr(FakeUnit, "execute", execute)


@pytest.mark.parametrize("part", [b"\\[", b"]C100", b"W1]"])
@pytest.mark.parametrize("cut", CUTS)
def test_a_part_of_a_program_that_k_holds_is_forgotten(tool, fake, unit, write, monkeypatch, part,
                                                       cut):  # fmt: skip
    """`resume`, which is for all motors, would run it."""
    cut_at(fake, monkeypatch, part, cut)

    result = tool("send", write(OWN_BRACKETS))

    assert result.status == (130 if cut is CUTS[0] else 3)
    assert unit.programs[1] == b""
    assert acts(unit)[-1] == b"\x021\\"
    assert "NOT CONFIRMED" not in result.complaint
    assert (
        f"; what had come of it is forgotten again: the memory of motor 1 of unit {NODE} is empty"
    ) in result.complaint
    assert "resume" not in result.complaint


def test_so_is_the_part_that_restore_has_sent(tool, fake, unit, folder, monkeypatch):
    cut_at(fake, monkeypatch, b"W2", CUTS[0])

    result = tool("restore", folder)

    assert result.status == 130
    assert unit.programs[2] == b""
    assert f"the memory of motor 2 of unit {NODE} is empty; restored: " in result.complaint


REFUSED = [["--motor", "1"], ["--motor", "0"], ["--motor", "1", "--node", "0"]]


@pytest.mark.parametrize("where", REFUSED)
def test_what_is_refused_leaves_the_memory_and_says_that_a_motor_moves_on(tool, fake, unit, write,
                                                                          where):  # fmt: skip
    unit.status = Vector("T40", switches=4).whole

    result = tool("send", write("\\" + "W100" * 699), *where)

    assert result.status == 1
    assert acts(unit) == []
    assert "gone" not in result.complaint
    assert "taken" not in result.complaint
    assert result.complaint.endswith(f"; {acting.KEPT}")


def test_so_does_a_machine_of_which_a_program_is_refused(tool, fake, unit, write):
    unit.status = Vector("T40", switches=4).whole
    motors = [{"program": "\\" + "W100" * 699}, *[{"program": ""}] * 3]
    content = {"format": "rkm04-machine", "version": 1, "name": "a", "motors": motors}

    result = tool("machine", "send", write(json.dumps(content), "a.rkm"))

    assert (result.status, acts(unit)) == (1, [])
    assert result.complaint == (
        f"rkm04: motor 1: has no room for [ and ] while T40 is on; send C40 first; {acting.KEPT}"
    )


def test_a_stream_whose_unit_falls_silent_tells_what_runs_on(tool, fake, unit, write):
    unit.states[0] = RUNNING
    silent_after(fake, unit, lambda message: message[0] == 7)

    result = tool("send", write("\\" + "W1" * 900), "--stream")

    assert result.status == 3
    assert result.complaint.startswith(
        "rkm04: NOT CONFIRMED: what the motor does: without more it runs on with up to 300 commands"
    )
    assert "; 100 of 900 commands were sent; " in result.complaint
    assert "rkm04 stop stops it; if it must stand, use the emergency stop" in result.complaint


def test_an_interrupted_stream_whose_stop_is_not_answered_says_so(start, fake, unit, write):
    unit.states[0] = RUNNING
    silent_after(fake, unit, lambda message: message[0] == 7)
    file = write("\\" + "W1" * 900)
    process = started(start, fake, unit, "send", file, "--stream", "--node", NODE)

    process.send_signal(signal.SIGTERM)
    _, err = process.communicate(timeout=10)

    assert process.returncode == 3
    assert err.startswith("rkm04: NOT CONFIRMED: K: ")
    assert err.endswith("; interrupted after 100 of 900 commands; use the emergency stop\n")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Programs of three motors of one unit."""
    folder = tmp_path / "programs"
    folder.mkdir()
    for motor in (1, 2, 3):
        (folder / f"unit-0{NODE}-motor-{motor}.rks").write_text(f"\\ W{motor}")
    return folder


def test_a_restore_that_is_cut_short_tells_which_motors_have_their_programs(
    tool, fake, unit, folder
):
    silent_after(fake, unit, has(b"W2"))

    result = tool("restore", folder)

    assert result.status == 3
    assert result.complaint.startswith(
        f"rkm04: NOT CONFIRMED: unit {NODE} motor 2: its memory may hold a part of the program, "
    )
    assert (
        f"; restored: unit {NODE} motor 1; not begun: unit {NODE} motor 3; restore again"
        in result.complaint
    )


def test_a_unit_that_falls_silent_in_a_backup_leaves_no_part_of_one(tool, fake, unit, tmp_path):
    unit.programs[1] = b"W1"
    silent_after(fake, unit, lambda message: message == b"\x052")

    result = tool("backup", tmp_path / "programs")

    assert result.status == 3
    assert result.complaint.rstrip().endswith("; nothing was saved")
    assert not (tmp_path / "programs").exists()


def test_restore_tells_which_motors_it_has_stopped_and_which_have_no_file(
    tool, fake, unit, folder, monkeypatch
):
    def execute(unit: FakeUnit, message: bytes) -> bytes:
        unit.tables = {} if acts(unit) else {1: MOVES}
        return original(unit, message)

    original = FakeUnit.execute
    monkeypatch.setattr(FakeUnit, "execute", execute)

    result = tool("restore", folder)

    assert result.status == 0
    assert result.out.splitlines()[3:5] == [
        f"moved, and were stopped: unit {NODE} motor 1",
        f"left as they are, without a file: unit {NODE} motor 4",
    ]
    told = tool("restore", folder, "--json").json
    assert (told["moved"], told["left"]) == ([], [{"node": NODE, "motor": 4}])


@pytest.mark.parametrize("name", ["unit-01-motor-9.rks", "unit-1-motor-2.rks", "Unit-17-x"])
def test_a_name_that_is_nearly_one_of_backup_is_refused(tool, fake, unit, folder, name):
    (folder / name).write_text("\\ W9")

    result = tool("restore", folder)

    assert result.status == 2
    assert f"{folder / name}: is named like no motor of a unit" in result.complaint
    assert "nothing was restored" in result.complaint
    assert unit.done == []


def test_a_store_that_nobody_answers_is_not_confirmed(tool, fake, unit, monkeypatch):
    monkeypatch.setattr("rkm04_tools.line.STORING", Wait(0.1, 1))
    silent_after(fake, unit, lambda message: message[0] == 3)

    result = tool("store")

    assert result.status == 3
    assert result.complaint.startswith(
        f"rkm04: NOT CONFIRMED: whether unit {NODE}, motor 1 has stored: "
    )


def test_an_empty_port_does_not_mean_another_unit(tool, fake, unit, gve134, positioning,
                                                  monkeypatch):  # fmt: skip
    for variable in (PORT_VARIABLE, "GVE134_PORT", "POSITIONING_PORT"):
        monkeypatch.setenv(variable, fake.port)
    for result in (
        tool("stop", "--port", ""),
        tool("service", "--port", "", "--no-browser"),
        gve134("status", "--port", ""),
        gve134("service", "--port", "", "--no-browser"),
        positioning("status", "--port", ""),
        positioning("service", "--port", "", "--no-browser"),
    ):
        assert result.status == 2
        assert "--port is empty" in result.err
    assert fake.requests == []
