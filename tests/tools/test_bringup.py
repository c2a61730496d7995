"""`bringup`: the walk over a board that nobody has tried: on the virtual board, on fake lines."""

from __future__ import annotations

import io
import json
import os
import re
import shutil
import socket
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from bringup_bench import INNER, NAME, Bench, FakeLine, Hands, powered, whole
from rkm04_tools import board
from rkm04_tools.board_header import read_board
from rkm04_tools.bringup import command, talk, together
from rkm04_tools.bringup import step as step_bench
from rkm04_tools.bringup.part import option_bytes
from rkm04_tools.bringup.person import Person
from rkm04_tools.bringup.plan import STEPS
from rkm04_tools.line_errors import GarbledAnswer, NoAnswer

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host") / "bin" / "rkm04-vboard"
modelled = pytest.mark.skipif(
    not PROGRAM.is_file() or not shutil.which(board.COMPILER),
    reason="there is no virtual board, or no compiler for the image",
)


def answers(*, leave: Sequence[str] = (), until: str = "", no: Sequence[int] = ()) -> str:
    """What somebody types who goes through it: leaves steps out, has some outputs switched twice
    and says n then, and is gone before the step `until`."""
    lines = ["y"]
    for step in STEPS:
        if step.name == until:
            break
        if step.name in leave:
            lines.append("s")
            continue
        inner = ["y"] * INNER.get(step.name, 0)
        for number in no if step.name == "outputs" else ():
            inner[number - 1] = "r\nn"
        lines += ["", *inner, ""]
    return "\n".join([*lines, ""])


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    return lambda text: monkeypatch.setattr("sys.stdin", io.StringIO(text))


@pytest.fixture
def power(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Bench]]:
    """Power on a virtual board with the image, in virtual time."""
    with ExitStack() as running:

        def begin(*options: str, name: str = board.DEFAULT_BOARD) -> Bench:
            return running.enter_context(
                powered(tmp_path, monkeypatch, name, *options, pressed=True)
            )

        yield begin


def step(report: dict[str, Any], name: str) -> dict[str, Any]:
    found: dict[str, Any] = next(each for each in report["steps"] if each["name"] == name)
    return found


def seen(report: dict[str, Any], name: str, what: str) -> tuple[str, str]:
    """What was seen, and whether it is good."""
    row = next(row for row in step(report, name)["seen"] if row["what"].strip() == what)
    return row["seen"], row["verdict"]


def bad(report: dict[str, Any]) -> list[str]:
    return [
        f"{each['name']}: {row['what'].strip()}"
        for each in report["steps"] for row in each["seen"] if row["verdict"] == "BAD"
    ]  # fmt: skip


@modelled
def test_a_good_board_is_gone_through_and_all_is_good(tool, power, monkeypatch, tmp_path):
    bench = power("--option-bytes", "0fffaae1", "--lsi", "30000", "--supply", "3.25")
    monkeypatch.setattr("sys.stdin", Hands(bench.walked()))

    result = tool("bringup", "--port", "virtual", "--json", "--report", tmp_path / "report.txt")

    report = result.json
    assert bad(report) == []
    assert (result.status, report["complete"], report["good"]) == (0, True, True)
    assert seen(report, "part", "flash") == ("1024 kB", "good")
    assert seen(report, "pulses", "pulses") == ("16 of 16", "good")
    told = "4800, 4800, 4800, 4800, 1 us apart"
    assert seen(report, "all motors", "pulses") == (told, "good")
    for name in ("step", "line", "tick", "plan"):
        cycles = re.fullmatch(
            r"\d+ times, longest (\d+) cycles", seen(report, "interrupts", f"{name} interrupt")[0]
        )
        assert cycles
        assert 0 < int(cycles[1]) < 20_000
    assert seen(report, "part", "brown-out reset")[0].startswith("level 3")
    assert seen(report, "start", "last reset")[0] == "brown-out, reset pin, power-on"
    assert seen(report, "clocks", "clock") == ("168 MHz", "good")
    assert seen(report, "clocks", "low-speed oscillator") == ("30000 Hz", "good")
    assert seen(report, "supply", "supply at the part") == ("3.250 V", "good")
    assert seen(report, "outputs", "BO_8 at PB15") == ("on, alone", "good")
    assert seen(report, "watchdog", "cause of the start") == ("watchdog", "good")
    assert seen(report, "stack guard", "cause of the start") == ("fault", "good")
    assert "exception 3" in seen(report, "stack guard", "fault")[0]
    assert "seen at" not in result.out  # inputs that somebody presses follow no output
    assert "Are the motors unpowered" in result.err
    written = (tmp_path / "report.txt").read_text()
    assert written.endswith("nothing bad was seen\n")


@modelled
@pytest.mark.parametrize("name", [name for name in board.names() if name != board.DEFAULT_BOARD])
def test_every_board_can_be_gone_through(tool, power, monkeypatch, name):
    bench = power(name=name)
    monkeypatch.setattr("sys.stdin", Hands(bench.walked()))

    result = tool("bringup", "--board", name, "--port", "virtual", "--json")

    assert bad(result.json) == []
    assert (result.status, result.json["complete"]) == (0, True)


@modelled
def test_what_is_wrong_with_a_board_is_found_and_what_was_not_done_is_told(tool, power, typed):
    power("--flash-kb", "512", "--stuck", "PC2=1", "--stuck", "PC5=0", "--stuck", "PB8=0",
                   "--stuck", "PB10=1", "--supply", "3.05")  # fmt: skip
    typed(answers(leave=["LEDs"], no=[1], until="enables"))

    result = tool("bringup", "--port", "virtual", "--json", "--patience", "2")

    report = result.json
    assert (result.status, report["complete"], report["good"]) == (1, False, False)
    assert seen(report, "part", "flash") == ("512 kB", "BAD")
    assert seen(report, "part", "brown-out reset")[1] == "note"
    assert seen(report, "supply", "supply at the part") == ("3.050 V", "BAD")
    assert seen(report, "inputs", "BI_3 at PC2") == ("always 0", "BAD")
    assert seen(report, "inputs", "BI_6 at PC5") == ("always 1", "BAD")
    assert "also 1 then: BI_6" in seen(report, "inputs", "BI_1 at PC0")[0]
    assert seen(report, "outputs", "BO_1 at PB8") == ("not so", "BAD")
    assert seen(report, "outputs", "BO_2 at PB9") == ("on, alone", "good")
    rows = [row["seen"] for row in step(report, "outputs")["seen"] if "read" in row["what"]]
    assert rows[:3] == ["BO_3", "BO_2, BO_3", "BO_3"]
    assert [step(report, name)["state"] for name in ("LEDs", "directions", "watchdog")] == [
        "left out", "done", "not done",
    ]  # fmt: skip


@modelled
def test_a_board_without_a_crystal_is_told_and_its_leds_and_directions_too(tool, power, typed):
    power("--no-crystal")
    done = ("line", "clocks", "LEDs", "directions", "pulses")
    few = [step.name for step in STEPS if step.name not in done]
    text = answers(leave=few).replace("y\ny\ny\ny\n", "")
    typed(text)

    result = tool("bringup", "--port", "virtual")

    assert result.status == 1
    assert re.search(r"BAD +crystal +does not run +runs, 8 MHz", result.out)
    assert re.search(r"BAD +clock +", result.out) is None
    assert result.out.count("there is no crystal") >= 2
    assert "NOT DONE: part, start, supply, inputs" in result.out


@modelled
@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("f405", ["--apb-wait", "9"], r"BAD +edges +one came too late, .* must be longer"),
        ("skr-pro-1.2", [], r"note +edges +not tried +only streams"),
        ("f405", ["--no-crystal"], r"BAD +no pulses are made +there is no crystal"),
    ],
)
def test_streams_that_do_not_keep_up_with_four_motors_are_told(
    tool, power, typed, name, options, said
):
    power(*options, name=name)
    typed(answers(leave=[step.name for step in STEPS if step.name != "all motors"]))

    result = tool("bringup", "--board", name, "--port", "virtual")

    assert re.search(said, result.out)
    assert ("nothing bad was seen" in result.out) == said.startswith("note")


@modelled
def test_an_image_for_other_pins_ends_the_walk_before_anything_is_switched(tool, power, typed):
    power()
    typed(answers())

    result = tool("bringup", "--board", "weact-f405", "--port", "virtual")

    assert result.status == 1
    told = r"the board has the image bringup-f405 4 \w{8}, not bringup-weact-f405 4 \w{8}: flash"
    assert re.search(told, result.out)
    assert "NOT DONE: line, part" in result.out


@pytest.fixture
def listener() -> Iterator[socket.socket]:
    """A port at which nobody answers."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(0.1)
        yield server


def port_of(listener: socket.socket) -> str:
    return f"socket://127.0.0.1:{listener.getsockname()[1]}"


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(talk, "ANSWER_SECONDS", 0.05)


def test_a_silent_line_is_told_loudly_with_what_to_look_at(tool, listener, typed, impatient):
    typed("y\n\nr\nq\n")

    result = tool("bringup", "--board", "weact-f405", "--port", port_of(listener))

    assert result.status == 3
    assert result.out.count("Nothing answers. What to look at") == 2
    assert "board flash --board weact-f405 --image bringup" in result.out
    assert "DE and /RE at LINE_DE (PB15)" in result.out
    assert "BAD: line (answer); NOT DONE: line, part" in result.out


@pytest.mark.parametrize("text", ["n\n", "", "q\n"])
def test_nothing_is_even_opened_before_the_motors_are_said_to_be_unpowered(
    tool, listener, typed, text
):
    typed(text)

    result = tool("bringup", "--port", port_of(listener))

    assert result.status == 1
    assert "NOT DONE: line, part" in result.out
    with pytest.raises(TimeoutError):
        listener.accept()


def test_bytes_that_are_no_text_are_a_wrong_answer_and_not_the_end(tool, listener, monkeypatch):
    typed = io.TextIOWrapper(io.BytesIO(b"\xc3\nn\n"), encoding="utf-8")
    monkeypatch.setattr("sys.stdin", typed)

    result = tool("bringup", "--port", port_of(listener))

    assert result.status == 1
    assert "one of y, n, q (stop here)" in result.out
    assert "NOT DONE: line, part" in result.out


def test_a_report_that_is_there_is_kept_and_told_before_anything_is_asked(
    tool, typed, listener, write
):
    kept = write("what was seen of another board\n", "board.txt")
    typed("y\n\nq\n")

    result = tool("bringup", "--port", port_of(listener), "--report", kept)

    assert result.status == 2
    assert f"{kept}: is there already, and a report replaces none" in result.complaint
    assert kept.read_text() == "what was seen of another board\n"


def test_a_report_that_cannot_be_written_is_told_before_anything_is_asked(
    tool, typed, listener, tmp_path
):
    typed("y\n\nq\n")

    for place in (tmp_path / "none" / "board.txt", tmp_path):
        result = tool("bringup", "--port", port_of(listener), "--report", place)

        assert result.status == 2
        assert f"{place}: cannot be written" in result.complaint


def test_a_walk_that_has_done_nothing_makes_no_report(tool, typed, listener, tmp_path):
    typed("n\n")

    result = tool("bringup", "--port", port_of(listener), "--report", tmp_path / "board.txt")

    assert result.status == 1
    assert "board.txt: not written, as nothing was done" in result.out
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "before",
    [
        b"",
        NAME.replace(b"ready", b"rea\xffy"),
        NAME.replace(b"ea", b"db"),
        NAME[:-3],
        b"error ? broken\n",
        NAME.replace(b"end h", b"end p"),
        b"\xff" * 500,
    ],
)
def test_an_answer_that_was_damaged_is_asked_for_again(before):
    line = FakeLine(before, NAME)

    assert talk.Talk(line).ask("h").word("ready") == "bringup-f405"
    assert line.sent == [b"\nh\n"] * 2


def test_an_adapter_that_hears_itself_is_no_matter():
    line = FakeLine(b"\nh\n" + NAME)

    assert talk.Talk(line).ask("h").word("ready") == "bringup-f405"


def test_silence_and_noise_are_told_apart():
    with pytest.raises(NoAnswer, match="no answer"):
        talk.Talk(FakeLine(b"\nh\n")).ask("h")
    with pytest.raises(GarbledAnswer, match="no whole answer"):
        talk.Talk(FakeLine(b"\x80\x81\n")).ask("h")


def test_a_damaged_answer_is_no_part_that_was_reset():
    told = whole(b"cause fault\nfaults 1 44 0 0 0 4223\n", b"p")
    made = b"wanted 2\nmade 2 2 2 2\nlate 0\nperiod_ticks 84\ntick_hz 84000000\n"
    line = FakeLine(told, b"wanted\xff\n", told, whole(made, b"m"))
    header = read_board((board.BOARDS / board.DEFAULT_BOARD / "board.h").read_text())
    bench = step_bench.Bench(
        board.DEFAULT_BOARD, header, talk.Talk(line), Person(io.StringIO()), patience=1.0
    )

    assert [each.verdict for each in together.try_together(bench)] == ["good", "good"]
    assert line.sent == [b"\np\n", b"\nm\n", b"\np\n", b"\nm\n"]


def test_what_restarts_the_board_is_sent_once_only():
    line = FakeLine()

    with pytest.raises(NoAnswer):
        talk.Talk(line).ask("w", tries=1)
    assert line.sent == [b"\nw\n"]


class InterruptedHands:
    """Somebody who presses Ctrl-C once all is typed."""

    def __init__(self, text: str) -> None:
        self._text = io.StringIO(text)

    def readline(self) -> str:
        text = self._text.readline()
        if not text:
            raise KeyboardInterrupt
        return text


def test_ctrl_c_among_the_outputs_switches_them_off_and_tells_what_was_not_done(
    tool, monkeypatch, tmp_path
):
    rest = b"leds 00\ndirections 00\nsteps 00\nenables 00\ninputs 00\ncapture 0\n"
    off, on = (whole(b"outputs %s\n" % mask + rest, b"o") for mask in (b"00", b"01"))
    line = FakeLine(NAME, off, on, off)
    monkeypatch.setattr(command, "open_transport", lambda _: line)
    early = [step.name for step in STEPS[1:] if step.name != "outputs"]
    kept = answers(leave=early, until="LEDs").splitlines()
    monkeypatch.setattr("sys.stdin", InterruptedHands("\n".join(kept[:-9]) + "\n"))

    result = tool("bringup", "--port", "x", "--report", tmp_path / "report.txt")

    assert result.status == 130
    assert line.sent[1:] == [b"\no0\n", b"\no1\n", b"\no0\n"]
    assert "interrupted" in result.out
    assert "outputs: not done" in (tmp_path / "report.txt").read_text()


@pytest.mark.parametrize(
    ("last", "silent"), [("q", False), (None, False), ("y", True)], ids=["q", "ctrl-c", "silence"]
)
def test_what_was_bad_in_a_step_that_did_not_end_stays_in_the_report(
    tool, monkeypatch, impatient, last, silent
):
    rest = b"leds 00\ndirections 00\nsteps 00\nenables 00\ninputs 00\ncapture 0\n"
    off, on = (whole(b"outputs %s\n" % mask + rest, b"o") for mask in (b"00", b"01"))
    line = FakeLine(NAME, off, on, *([] if silent else [on, off]))
    monkeypatch.setattr(command, "open_transport", lambda _: line)
    early = ["s" for step in STEPS[1 : [step.name for step in STEPS].index("outputs")]]
    typed = ["y", "", "", *early, "", "n", *([last] if last else [])]
    monkeypatch.setattr("sys.stdin", InterruptedHands("\n".join(typed) + "\n"))

    result = tool("bringup", "--port", "x", "--json")

    report = json.loads(result.out)
    assert step(report, "outputs")["state"] == "not done"
    assert "BO_1 at PB8" in [row["what"] for row in step(report, "outputs")["seen"]]
    assert not report["good"]


def test_a_step_that_was_bad_is_still_bad_when_its_repetition_is_broken_off(
    tool, monkeypatch, impatient
):
    def broken_off(data: bytes) -> None:
        raise KeyboardInterrupt

    line = FakeLine()
    hands = Hands(["y", "", ("r", lambda: monkeypatch.setattr(line, "write", broken_off))])
    monkeypatch.setattr(command, "open_transport", lambda _: line)
    monkeypatch.setattr("sys.stdin", hands)

    report = json.loads(tool("bringup", "--port", "x", "--json").out)

    assert step(report, "line")["state"] == "not done"
    assert not report["good"]


@pytest.mark.parametrize(
    ("control", "verdicts"),
    [
        (0x0FFFAAE1, ["good", "good"]),
        (0x0FFFAAED, ["good", "note"]),
        (0x0FFF00E1, ["BAD", "good"]),
        (0x0FFEAAE1, ["BAD", "good"]),
        (0x0FFFAAC1, ["BAD", "good"]),
    ],
)
def test_option_bytes_are_held_against_what_board_options_wants(control, verdicts):
    assert [row.verdict for row in option_bytes("f405", control)] == verdicts


def test_an_image_is_flashed_by_its_name(tool, monkeypatch):
    def built(
        name: str, target: str = "all", what: str = board.UNIT, baud: int | None = None,
        half_period: bool = False,
    ) -> board.Image:  # fmt: skip
        return board.image_of(name, what, baud, half_period)

    monkeypatch.setattr(board, "build", built)

    shown = tool("board", "flash", "--image", "bringup", "--board", "weact-f405", "--dry-run").out

    assert "bringup-weact-f405.elf" in shown


def test_the_report_can_be_read_by_programs(tool, listener, typed, impatient):
    typed("y\n\nq\n")

    result = tool("bringup", "--port", port_of(listener), "--json")

    assert json.loads(result.out)["steps"][0]["seen"][0]["verdict"] == "BAD"
    assert "Nothing answers" in result.err
