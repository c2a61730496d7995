"""`bringup`: whatever ends the walk, outputs go off, and what was seen is kept; a line that does
not let it end."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest
from bringup_bench import NAME, FakeLine, Hands, whole
from rkm04_tools.bringup import command, talk
from rkm04_tools.bringup.plan import STEPS
from rkm04_tools.line_errors import GarbledAnswer

REST = b"leds 00\ndirections 00\nsteps 00\nenables 00\ninputs 00\ncapture 0\n"
OFF, ON = (whole(b"outputs %s\n" % mask + REST, b"o") for mask in (b"00", b"01"))
EARLY = ["s" for _ in STEPS[1 : [step.name for step in STEPS].index("outputs")]]


class FakeBoard(FakeLine):
    """Its output 1 can be switched; somebody may act when it is to go off."""

    def __init__(self) -> None:
        super().__init__(NAME)
        self.impatience: list[signal.Signals] = []

    def write(self, data: bytes) -> None:
        if data == b"\no0\n" and b"\no1\n" in self.sent:
            for number in self.impatience:
                signal.raise_signal(number)
        self.texts = [{b"\no1\n": ON, b"\no0\n": OFF}.get(data, NAME)]
        super().write(data)


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> FakeBoard:
    line = FakeBoard()
    monkeypatch.setattr(command, "open_transport", lambda _: line)
    return line


@pytest.mark.parametrize("name", ["SIGHUP", "SIGTERM"])
def test_an_output_goes_off_and_the_report_is_kept_whatever_ends_the_walk(
    tool, fake, monkeypatch, tmp_path, name
):
    number = getattr(signal, name)

    def unhandled(*_: object) -> None:
        raise AssertionError(f"{name} would end the tool at once")

    before = signal.signal(number, unhandled)
    hands = Hands(["y", "", "", *EARLY, "", ("", lambda: signal.raise_signal(number))])
    monkeypatch.setattr("sys.stdin", hands)
    try:
        result = tool("bringup", "--port", "x", "--report", tmp_path / "report.txt")
    finally:
        signal.signal(number, before)

    assert (result.status, fake.sent[-1]) == (130, b"\no0\n")
    assert "outputs: not done" in (tmp_path / "report.txt").read_text()


class Babble(FakeLine):
    """A line that is never quiet, as with a unit of another rate: a byte in half a millisecond."""

    def __init__(self) -> None:
        super().__init__()
        self.seconds = 0.0

    def monotonic(self) -> float:
        return self.seconds

    def read(self, seconds: float) -> bytes:
        self.seconds += 0.0005
        assert self.seconds < 60, "waits for ever"
        return b"U"


def test_a_line_that_is_never_quiet_is_told_and_not_waited_for(monkeypatch):
    line = Babble()
    monkeypatch.setattr(talk, "time", line)

    with pytest.raises(GarbledAnswer, match="something came back"):
        talk.Talk(line).ask("h")


def test_ctrl_c_twice_leaves_no_output_on(tool, fake, monkeypatch):
    fake.impatience = [signal.SIGINT]
    hands = Hands(["y", "", "", *EARLY, "", ("", lambda: signal.raise_signal(signal.SIGINT))])
    monkeypatch.setattr("sys.stdin", hands)

    result = tool("bringup", "--port", "x")

    assert (result.status, fake.sent[-2:]) == (130, [b"\no1\n", b"\no0\n"])
    assert "interrupted" in result.out


def test_the_report_is_kept_where_there_is_no_terminal_any_more(
    tool, fake, monkeypatch, tmp_path: Path
):
    def gone(*_: object, **__: object) -> None:
        raise OSError(5, "Input/output error")

    def hang_up() -> None:
        monkeypatch.setattr("builtins.print", gone)
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("sys.stdin", Hands(["y", "", "", *EARLY, "", ("", hang_up)]))

    with pytest.raises(OSError, match="Input"):
        tool("bringup", "--port", "x", "--report", tmp_path / "report.txt")

    assert "line: done" in (tmp_path / "report.txt").read_text()


def test_a_report_that_cannot_be_written_in_the_end_is_on_the_screen(
    tool, fake, monkeypatch, tmp_path: Path
):
    (tmp_path / "stick").mkdir()
    hands = Hands(["y", "", ("", (tmp_path / "stick").rmdir), "q"])
    monkeypatch.setattr("sys.stdin", hands)

    result = tool("bringup", "--port", "x", "--report", tmp_path / "stick" / "report.txt")

    assert result.status == 2
    assert "report.txt: cannot be written" in result.err
    assert "line: done" in result.out
