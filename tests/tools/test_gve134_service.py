"""What is behind the page of a GVE134: jobs, halts, units that are silent, absent or restart."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from fake_gve134 import FakeGve, lost
from gve134_ports import FakeGveLine
from gve_desk import GveDesk
from rkm04_tools.failure import Failure
from rkm04_tools.gve134.link import HALT_SECONDS
from rkm04_tools.gve134.service.orders import read_order
from rkm04_tools.service import turns
from rkm04_tools.service.trouble import BadRequest

EXAMPLES = Path(__file__).resolve().parents[2] / "tools/examples/gve"
CHAIN = "L0,0,0,0\nV500\n" + "C10,20\n" * 400


@pytest.fixture
def unit() -> FakeGve:
    return FakeGve(vector_s=0.01)


@pytest.fixture
def line(unit: FakeGve) -> Iterator[FakeGveLine]:
    line = FakeGveLine(unit)
    yield line
    line.close()


@pytest.fixture
def desk(line: FakeGveLine, monkeypatch: pytest.MonkeyPatch) -> Iterator[GveDesk]:
    monkeypatch.setattr(turns, "LOOK_AGAIN_SECONDS", 0.2)
    desk = GveDesk(line.port)
    desk.connected()
    yield desk
    desk.close()


@pytest.fixture
def virtual() -> Iterator[GveDesk]:
    desk = GveDesk("virtual")
    desk.connected()
    yield desk
    desk.close()


def vectors_of(unit: FakeGve) -> int:
    return len(unit.taken)


def start(desk: GveDesk, text: str = CHAIN) -> int:
    number = desk.say("start", file=desk.open("a.gve", text))
    desk.phase("sending")
    return number


def restart(line: FakeGveLine) -> None:
    with line.lock:
        line.unit.restart()


# ---- jobs ----


def test_connecting_only_asks(desk: GveDesk, unit: FakeGve) -> None:
    desk.live()

    names = {each.partition(",")[0].rstrip("0123456789") for each in unit.done}
    assert names <= {"%+", "?", "P", "F", "I", "SR"}


def test_a_file_is_sent_and_its_end_is_told(desk: GveDesk, unit: FakeGve) -> None:
    number = start(desk)

    assert desk.answer(number)["text"] == (
        "a.gve: 401 vectors made; the axes stand at X 4000  Y 8000  Z 0  A 0"
    )
    assert vectors_of(unit) == 401
    assert unit.modal["XM"] == "100"
    assert desk.now["job"]["phase"] == "done"


def test_where_the_unit_is_on_the_path_is_told_from_its_positions(
    desk: GveDesk, unit: FakeGve
) -> None:
    number = start(desk)
    found = [desk.live(lambda m: m["progress"] is not None) for _ in range(5)]
    desk.answer(number)

    for each in found:
        progress, x = each["progress"], each["positions"][0]
        assert progress["line"] in (None, progress["at"] + 3)
        assert abs(progress["at"] - x // 10) <= 1
        assert 0 <= progress["level"] <= 128
        assert progress["level"] == progress["sent"] - progress["at"]
    places = [place for m in desk.told if m["type"] == "live" for place in m["made"]]
    assert places[-1] == (4000, 8000, 0)
    assert all(y == 2 * x for x, y, _ in places)


def test_a_halt_is_confirmed_and_the_job_goes_on_where_it_was(desk: GveDesk, unit: FakeGve) -> None:
    number = start(desk)
    desk.live(lambda m: m["positions"][0] > 100)
    halted = desk.ask("halt")

    assert halted["text"].startswith("the axes stand at X ")
    assert "gve134" not in halted["text"]
    assert (desk.now["halt"], desk.now["job"]["phase"]) == (None, "held")
    assert next(m for m in desk.told if m.get("id") == number)["error"]["kind"] == "Held"
    sent = vectors_of(unit)
    desk.live()
    assert vectors_of(unit) == sent

    again = desk.ask("go")
    assert again["text"].startswith("a.gve: 401 vectors made; the axes stand at X 4000  Y 8000")
    assert unit.taken == [(0, 0, 0, 0), *[(10, 20, 0, 0)] * 400]


def test_a_job_that_was_halted_can_be_ended(desk: GveDesk, unit: FakeGve) -> None:
    start(desk)
    desk.live(lambda m: m["positions"][0] > 100)
    desk.ask("halt")

    assert "the queue is empty" in desk.ask("delete")["text"]
    assert desk.now["job"]["phase"] == "failed"
    assert desk.ask("start", file=desk.open("b.gve", "C1\n"))["text"].startswith("b.gve: 1 vec")
    assert unit.taken[-1] == (1, 0, 0, 0)


def test_an_interrupt_holds_the_job_with_its_cause(desk: GveDesk, line: FakeGveLine) -> None:
    number = start(desk)
    desk.live(lambda m: m["positions"][0] > 100)
    with line.lock:
        line.unit.interrupt(1)

    job = desk.phase("held")
    assert "INTERRUPTED by RefX" in job["trouble"]["cause"]
    assert desk.answer(number)["error"]["kind"] == "Interrupted"
    assert desk.live()["causes"] == ["RefX"]
    assert desk.ask("go")["text"].startswith("a.gve: 401 vectors made")


def test_what_would_disturb_a_job_is_refused_and_questions_are_not(desk: GveDesk) -> None:
    number = start(desk)

    for kind, told in (
        ("jog", {"parts": [1, 0, 0, 0], "speed": 100}),
        ("typed", {"text": "C1"}),
        ("delete", {}),
        ("connect", {"port": "virtual"}),
        ("go", {}),
    ):
        assert "would disturb it" in desk.ask(kind, **told)["error"]["cause"], kind
    assert desk.ask("typed", text="sr7")["text"] == "SR7 → 0,00  done"
    with pytest.raises(BadRequest, match=r"a\.gve is not done"):
        desk.open("b.gve", "C1\n")
    assert desk.answer(number)["error"] is None


def test_a_person_is_asked_and_the_job_waits(desk: GveDesk, unit: FakeGve) -> None:
    number = start(desk, "C1\n;@pause line 7: put in tool 1\nC2\n")

    assert desk.phase("waits")["text"] == "line 7: put in tool 1"
    desk.live()
    assert vectors_of(unit) == 1
    assert desk.ask("resume")["error"] is None
    assert desk.answer(number)["error"] is None
    assert vectors_of(unit) == 2


# ---- speed ----


def test_the_speed_of_a_job_changes_in_sixteenths_as_xm_would_level_its_vectors(
    desk: GveDesk, unit: FakeGve
) -> None:
    number = start(desk)
    desk.ask("override", percent=50)
    known = desk.state(lambda m: m["wanted"] is None and m["known"]["percent"] is not None)["known"]
    desk.answer(number)

    assert known["percent"] == pytest.approx(50, abs=2)
    steps = unit.done.count("XD") - unit.done.count("XU")
    assert known["percent"] == pytest.approx(100 * (15 / 16) ** steps, rel=0.01)
    assert [each for each in unit.done if each.startswith("XM")] == ["XM100"]


def test_at_rest_the_speed_is_set_exactly(desk: GveDesk, unit: FakeGve) -> None:
    desk.ask("override", percent=37)

    assert desk.state(lambda m: m["known"]["percent"] is not None)["known"]["percent"] == (
        pytest.approx(37, abs=0.001)
    )
    assert unit.modal["XM"] == "37"


# ---- by hand ----


def test_a_jog_moves_and_a_halt_ends_it_for_good(desk: GveDesk, unit: FakeGve) -> None:
    unit.vector_s = 2.0
    desk.ask("jog", parts=[0, -500, 0, 0], speed=700)
    desk.live(lambda m: m["flags"] & 0x40)
    desk.ask("halt")

    assert unit.taken == [(0, -500, 0, 0)]
    assert unit.modal["V"] == "700"
    assert desk.live()["flags"] == 0
    assert "nothing waits to go on" in desk.ask("go")["error"]["cause"]


def test_outputs_are_not_known_until_they_were_set_here(desk: GveDesk, line: FakeGveLine) -> None:
    assert desk.now["known"] == {"port": None, "spindle": None, "factor": None, "percent": None}

    desk.ask("output", port=0xFB)
    desk.ask("spindle", permille=305)
    assert (desk.now["known"]["port"], desk.now["known"]["spindle"]) == (0xFA, 305)
    with line.lock:
        line.unit.faults.extend([lost] * 3)
    desk.ask("output", port=0xFF)
    assert line.unit.ports["O"] == 0xFF
    assert any(m["known"]["port"] is None for m in desk.told[-30:] if m["type"] == "state")


@pytest.mark.parametrize("text", ["H", "@", "%-", "WX1,2,3,4", "*S"])
def test_what_the_page_does_otherwise_is_not_typed(desk: GveDesk, unit: FakeGve, text: str) -> None:
    told = desk.ask("typed", text=text)

    assert "the page has a button for it" in told["error"]["cause"]
    assert text not in unit.done


def test_a_wrong_command_is_refused_before_it_is_sent(desk: GveDesk, unit: FakeGve) -> None:
    told = desk.ask("typed", text="V5")

    assert told["error"]["cause"].startswith("V5: ")
    assert "V5" not in unit.done


# ---- what is late, silent, absent, or new ----


def test_old_clicks_are_refused_but_not_an_old_halt(desk: GveDesk, unit: FakeGve) -> None:
    number = desk.open("a.gve", CHAIN)
    desk.late = True

    for kind, told in (
        ("start", {"file": number}),
        ("jog", {"parts": [1, 0, 0, 0], "speed": 100}),
        ("output", {"port": 0}),
    ):
        assert desk.ask(kind, **told)["error"]["kind"] == "Late"
    assert unit.taken == []
    assert desk.ask("halt")["error"] is None


def test_a_silent_unit_is_told_and_nothing_asked_meanwhile_happens_later(
    desk: GveDesk, line: FakeGveLine, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    with line.lock:
        unit.mute = True
    number = desk.say("jog", parts=[5, 0, 0, 0], speed=100)
    error = desk.state(lambda m: m["error"] is not None)["error"]
    assert error["kind"] == "NoAnswer"
    assert desk.answer(number)["error"] is not None
    with line.lock:
        unit.mute = False
    desk.state(lambda m: m["error"] is None)
    desk.live()

    assert unit.taken == []


def test_a_halt_that_is_not_confirmed_is_told_until_one_is(
    desk: GveDesk, line: FakeGveLine, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert HALT_SECONDS > 3
    monkeypatch.setattr("rkm04_tools.gve134.unit.HALT_SECONDS", 1.0)
    start(desk)
    desk.live(lambda m: m["positions"][0] > 50)
    with line.lock:
        unit.mute = True
    number = desk.say("halt")

    desk.state(lambda m: m["halt"] == "asked")
    assert desk.answer(number)["error"]["kind"] == "NotConfirmed"
    assert desk.now["halt"] == "failed"
    with line.lock:
        unit.mute = False
    desk.live()
    assert desk.now["halt"] == "failed"
    assert desk.ask("halt")["error"] is None
    assert desk.now["halt"] is None


def test_a_halt_without_a_port_is_not_confirmed(desk: GveDesk) -> None:
    desk.ask("disconnect")

    assert desk.ask("halt")["error"]["kind"] == "NotConnected"
    assert desk.now["halt"] == "failed"


def test_a_unit_that_restarts_ends_the_job_and_is_told_until_noted(
    desk: GveDesk, line: FakeGveLine, unit: FakeGve
) -> None:
    number = start(desk)
    desk.live(lambda m: m["positions"][0] > 50)
    restart(line)
    state = desk.state(lambda m: m["restarted"])
    told = desk.answer(number)

    assert told["error"]["kind"] == "Restarted"
    taken = vectors_of(unit)
    desk.live()
    assert vectors_of(unit) == taken
    assert desk.now["job"]["phase"] == "failed"
    assert desk.now["restarted"]
    assert "gve134" not in told["error"]["cause"] + told["error"]["next"]
    again = desk.ask("start", file=desk.now["file"]["number"])
    assert "take note of that first" in again["error"]["next"]
    assert state["known"]["port"] == 0xFF
    desk.ask("seen")
    assert not desk.now["restarted"]


def test_a_unit_that_restarts_at_rest_is_told(desk: GveDesk, line: FakeGveLine) -> None:
    desk.ask("jog", parts=[5, 0, 0, 0], speed=500)
    desk.live(lambda m: m["positions"][0] == 5)
    restart(line)
    assert desk.state(lambda m: m["restarted"])["error"] is None


def test_a_unit_that_is_absent_at_the_start_is_found_when_it_comes(
    line: FakeGveLine, unit: FakeGve, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(turns, "LOOK_AGAIN_SECONDS", 0.2)
    unit.mute = True
    desk = GveDesk(line.port)
    try:
        assert desk.state(lambda m: m["error"] is not None)["error"]["kind"] == "NoAnswer"
        assert desk.now["seen_ago_s"] is None
        with line.lock:
            unit.mute = False
        assert desk.connected()["version"].startswith("IP134")
    finally:
        desk.close()


def test_a_port_that_is_absent_at_the_start_is_told(tmp_path: Path) -> None:
    desk = GveDesk(str(tmp_path / "none"))
    try:
        state = desk.state(lambda m: m["error"] is not None)
        assert state["error"]["kind"] == "PortMissing"
        assert state["away"]
        assert not state["connected"]
    finally:
        desk.close()


def test_a_port_that_is_lost_ends_the_job_with_what_is_not_known(
    desk: GveDesk, line: FakeGveLine
) -> None:
    number = start(desk)
    desk.live(lambda m: m["positions"][0] > 50)
    line.close()

    cause = desk.answer(number)["error"]
    assert "NOT KNOWN" in cause["cause"] + cause["next"]
    assert desk.state(lambda m: m["away"])["job"]["phase"] == "failed"


# ---- files ----


@pytest.mark.parametrize(
    ("name", "text", "place"),
    [("a.gve", "V500\nC1\n  V5\n", (3, 4)), ("a.nc", "G21\nG1 X10 F0\n", (2, 8))],
)
def test_a_file_with_errors_has_their_places_and_is_not_sent(
    desk: GveDesk, unit: FakeGve, name: str, text: str, place: tuple[int, int]
) -> None:
    desk.open_mill((EXAMPLES / "mill.rkm").read_bytes())
    number = desk.open(name, text)
    file = desk.desk.file(number)

    assert [(p["line"], p["column"], p["severity"]) for p in file.problems] == [(*place, "error")]
    assert desk.state(lambda m: m["file"] is not None)["file"]["ok"] is False
    done = list(unit.done)
    assert desk.ask("start", file=number)["error"]["cause"] == f"{name} has errors"
    assert not [each for each in unit.done[len(done) :] if each[0] in "LCVX"]


def test_gcode_needs_a_machine_and_is_turned_anew_for_another(desk: GveDesk) -> None:
    mill = (EXAMPLES / "mill.rkm").read_bytes()
    with pytest.raises(Failure, match=r"a\.nc: for which machine\?"):
        desk.open("a.nc", "G1 X10 F600\n")
    desk.open_mill(mill)
    desk.open("a.nc", "G1 X10 F600\n")
    desk.open_mill(mill.replace(b'"steps_per_mm": 320', b'"steps_per_mm": 100'))

    course = desk.desk.file(desk.state(lambda m: m["file"] is not None)["file"]["number"] + 1)
    assert course.course is not None
    assert course.course.parts.tolist() == [[1000, 0, 0, 0]]


def test_a_start_is_for_the_file_that_its_page_shows(desk: GveDesk, unit: FakeGve) -> None:
    first = desk.open("a.gve", "C1\n")
    desk.open("b.gve", "C2\n")

    with pytest.raises(BadRequest, match="another file was opened meanwhile"):
        desk.say("start", file=first)
    assert unit.taken == []


@pytest.mark.parametrize("name", sorted(p.name for p in EXAMPLES.glob("*.nc")))
def test_the_course_of_each_example_has_its_times_and_lines(desk: GveDesk, name: str) -> None:
    desk.open_mill((EXAMPLES / "mill.rkm").read_bytes())
    file = desk.desk.open_file(name, (EXAMPLES / name).read_bytes())

    assert file.course is not None
    assert file.seconds is not None
    assert file.plan is not None
    assert len(file.seconds) == len(file.course) == file.plan.vectors
    assert file.seconds.sum() == pytest.approx(file.plan.seconds, abs=0.002 * file.plan.chains)
    lines = file.text.split("\n")
    assert all("G" in lines[n - 1] or "X" in lines[n - 1] or "Y" in lines[n - 1] or
               "Z" in lines[n - 1] or "A" in lines[n - 1] for n in file.course.lines)  # fmt: skip


# ---- on the virtual unit ----


def test_an_example_runs_on_the_virtual_unit_and_every_look_is_on_its_path(
    virtual: GveDesk,
) -> None:
    virtual.open_mill((EXAMPLES / "mill.rkm").read_bytes())
    text = (EXAMPLES / "circle.nc").read_text()
    number = virtual.say("start", file=virtual.open("circle.nc", text))
    virtual.live(lambda m: m["progress"] and (m["progress"]["at"] or 0) > 20)
    virtual.ask("override", percent=200)
    assert virtual.answer(number)["error"] is None

    looks = [m["progress"] for m in virtual.told if m["type"] == "live" and m["progress"]]
    assert all(look["at"] is not None for look in looks)
    numbers = [look["at"] for look in looks]
    assert numbers == sorted(numbers)
    assert {5, 6, 7} <= {look["line"] for look in looks}


def test_homing_is_a_job_in_which_the_unit_tells_nothing(virtual: GveDesk) -> None:
    with pytest.raises(BadRequest, match="which switches"):
        virtual.say("home", axis="X")
    virtual.open_mill((EXAMPLES / "mill.rkm").read_bytes())
    virtual.say("input", input=1, level=0)  # the switch opens when it is hit
    number = virtual.say("home", axis="X")
    virtual.state(lambda m: m["reference"])
    virtual.say("input", input=1, level=1)
    time.sleep(0.2)
    virtual.say("input", input=1, level=0)

    assert virtual.answer(number)["text"].startswith(
        "home X.nc: 1 vectors made; the axes stand at X 0"
    )
    assert not virtual.now["reference"]


def test_a_halt_in_a_reference_run_acts_at_once(virtual: GveDesk) -> None:
    virtual.open_mill((EXAMPLES / "mill.rkm").read_bytes())
    virtual.say("input", input=1, level=0)
    virtual.say("home", axis="X")
    virtual.state(lambda m: m["reference"])

    assert virtual.ask("halt")["text"].startswith("the axes stand at X -")
    assert virtual.now["job"]["phase"] == "failed"


@pytest.mark.parametrize(
    "told",
    [
        "", "[]", "{}", '{"type": "start"}', '{"type": "start", "file": "1"}',
        '{"type": "jog", "parts": [1, 2], "speed": 100}',
        '{"type": "jog", "parts": [0, 0, 0, 0], "speed": 100}',
        '{"type": "jog", "parts": [1, 0, 0, true], "speed": 100}',
        '{"type": "jog", "parts": [2147483648, 0, 0, 0], "speed": 100}',
        '{"type": "jog", "parts": [1, 0, 0, 0], "speed": 9}', '{"type": "home", "axis": "B"}',
        '{"type": "override", "percent": 0}', '{"type": "output", "port": 256}',
        '{"type": "spindle", "permille": 1001}', '{"type": "typed", "text": ""}',
        '{"type": "typed", "text": "' + "X" * 81 + '"}',
        '{"type": "input", "input": 5, "level": 1}',
        '{"type": "connect", "port": "spy:///dev/ttyS0?file=/tmp/x"}', '{"type": "halt", "id": -1}',
    ],
)  # fmt: skip
def test_what_is_not_possible_is_refused(told: str) -> None:
    with pytest.raises(BadRequest):
        read_order(told)
