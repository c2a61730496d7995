"""`gve134 serve`: a unit in real time on TCP and on a pty, which keeps its EEPROM in a file."""

from __future__ import annotations

import os
import select
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from rkm04_tools.cli import run_tool
from rkm04_tools.gve134.cli import make_parser
from served import COMMAND, GVE_COMMAND, PATIENCE_SECONDS, Served, connect, refusal

SILENCE_SECONDS = 0.3

Serve = Callable[..., Served]
Meet = Callable[[Served], "Host"]


class Host:
    """A client: lines out, answers in."""

    def __init__(self, place: str) -> None:
        if place.startswith("socket://"):
            connection = connect(place)
            self._fd, self.close = connection.fileno(), connection.close
        else:
            fd = os.open(place, os.O_RDWR | os.O_NOCTTY)
            self._fd, self.close = fd, lambda: os.close(fd)
        self._came = b""

    def send(self, line: str) -> None:
        os.write(self._fd, f"{line}\r".encode())

    def answer(self, seconds: float = PATIENCE_SECONDS) -> str | None:
        end = time.monotonic() + seconds
        while b"\r" not in self._came:
            left = end - time.monotonic()
            if left <= 0 or not select.select([self._fd], [], [], left)[0]:
                return None
            self._came += os.read(self._fd, 4096)
        answer, _, self._came = self._came.partition(b"\r")
        return answer.decode("latin-1")

    def ask(self, line: str) -> str | None:
        self.send(line)
        return self.answer()


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Serve]:
    """Start units that end with the test."""
    started: list[Served] = []

    def start(*arguments: str | Path, on_pty: bool = False) -> Served:
        place = [] if on_pty else ["--tcp", "0"]
        served = Served(*place, *arguments, cwd=tmp_path, command=GVE_COMMAND)
        started.append(served)
        return served

    yield start
    for served in started:
        served.end()


@pytest.fixture
def meet() -> Iterator[Meet]:
    """Connect hosts that let go at the end of the test."""
    hosts: list[Host] = []

    def connect_to(served: Served) -> Host:
        hosts.append(Host(served.place))
        return hosts[-1]

    yield connect_to
    for host in hosts:
        host.close()


@pytest.fixture
def host(serve: Serve, meet: Meet) -> Host:
    """A host of a unit without file."""
    return meet(serve())


def test_the_help_has_examples(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        run_tool(make_parser(), ["serve", "--help"])
    assert end.value.code == 0
    assert "example:\n  gve134 serve" in capsys.readouterr().out


def test_a_unit_answers_by_tcp(host: Host) -> None:
    assert host.ask("!0?") == "0,IP134/200 v1 22.11.2026"


def test_a_unit_answers_on_a_pty(serve: Serve, meet: Meet, tmp_path: Path) -> None:
    served = serve("--pty", tmp_path / "line", on_pty=True)

    assert served.place == str(tmp_path / "line")
    assert meet(served).ask("!7?") == "0,IP134/200 v1 22.11.2026"


def test_the_position_changes_while_axes_move(host: Host) -> None:
    assert host.ask("!0L1000000,0,0,-1000000") == "0"
    while (answer := host.ask("!0P4")) == "0,0,0,0,0":
        pass
    assert answer is not None
    x, *_, a = map(int, answer.split(",")[1:])
    assert x > 0 > a
    assert host.ask("!0H") == "8"


def test_the_unit_hears_while_h_waits(host: Host) -> None:
    host.ask("!0V200000")
    host.ask("!0L100000000")
    host.send("!0H")
    assert host.ask("!0J") in ("0", "8")


@pytest.mark.parametrize("options", [["--unpaced"], ["--speed", "0"], ["--baud", "921600"]])
def test_a_packet_is_taken_at_any_pace(serve: Serve, meet: Meet, options: list[str]) -> None:
    host = meet(serve(*options))
    host.send("!0*S")
    for _ in range(100):
        host.send("!0C10,20,30")
    assert host.ask("!0*E100") == "0,100"


def test_inputs_are_set_by_lines_on_standard_input(serve: Serve, meet: Meet) -> None:
    served = serve()
    host = meet(served)
    assert host.ask("!0I1") == "0,FF"

    assert order(served, "3=0") == {"ok": True}
    assert host.ask("!0I1") == "0,FB"
    assert order(served, "3=1") == {"ok": True}
    assert order(served, "8=0") == {"ok": True}
    assert (host.ask("!0I1"), host.ask("!0I2")) == ("0,FF", "0,7F")


def test_an_order_for_nothing_is_refused(serve: Serve) -> None:
    served = serve()
    for text in ["5=0", "6=1", "9=0", "1.3=0", "3=2", "3", "x"]:
        assert "there are 1 to 4, 7 and 8" in str(order(served, text)["error"])


def test_the_state_tells_axes_inputs_outputs_and_lights(serve: Serve, meet: Meet) -> None:
    served = serve("--control", "0")
    host = meet(served)
    host.ask("!7V300")
    host.ask("!0O0,FE")
    host.ask("!0L5,-7")
    host.ask("!0L0,0,0,0")
    control = served.control()
    control.order("1=0")
    control.wait_for("?", lambda state: state["idle"] and state["leds"][4] == 1)

    state = control.order("?")

    assert "node" not in state
    assert state["positions"] == [5, -7, 0, 0]
    assert state["inputs"] == [0, 1, 1, 1, 1, 1, 1, 1]
    assert state["outputs"] == [1, 0, 0, 0, 1, 0, 0, 0]
    assert (state["pwm"], len(state["leds"]), state["leds"][0]) == (300, 8, 1)
    assert state["clients"] == 1


def order(served: Served, text: str) -> dict[str, object]:
    """Write a line to its standard input; what it answers."""
    assert served.process.stdin is not None
    served.process.stdin.write(f"{text}\n")
    served.process.stdin.flush()
    answer: dict[str, object] = served.line()
    return answer


# ---- a bad line ---------------------------------------------------------------------------------


def heard(host: Host, count: int) -> list[str]:
    """What comes back to so many commands, sent together, and a silence after them."""
    host.send("\r".join(f"!0A{number + 100}" for number in range(count)))
    came = []
    while (answer := host.answer(SILENCE_SECONDS)) is not None:
        came.append(answer)
    return came


def test_a_bad_line_is_the_same_with_the_same_seed_and_another_one_with_another(
    serve: Serve, meet: Meet
) -> None:
    bad = ["--noise", "2000", "--loss", "2000", "--seed"]
    one, same, other = (heard(meet(serve(*bad, seed)), 300) for seed in ("1", "1", "2"))

    assert one == same
    assert one != other
    assert one != ["0"] * 300


def test_what_a_line_changes_and_loses_is_told(serve: Serve, meet: Meet) -> None:
    served = serve("--unpaced", "--noise", "20000", "--loss", "10000")
    heard(meet(served), 1000)
    state = order(served, "?")

    assert isinstance(state["changed"], int)
    assert isinstance(state["lost"], int)
    assert 100 < state["changed"] < 400
    assert 50 < state["lost"] < 200


def test_a_line_that_loses_all_is_silent_and_a_good_one_harms_nothing(
    serve: Serve, meet: Meet
) -> None:
    assert heard(meet(serve("--loss", "1000000")), 3) == []
    served = serve("--seed", "7")
    assert heard(meet(served), 3) == ["0"] * 3
    state = order(served, "?")
    assert (state["changed"], state["lost"]) == (0, 0)


# ---- the EEPROM ---------------------------------------------------------------------------------


def test_the_eeprom_is_there_when_the_unit_is_switched_on_again(
    serve: Serve, meet: Meet, tmp_path: Path
) -> None:
    flash = tmp_path / "unit.flash"
    served = serve("--flash", flash)
    assert meet(served).ask("!0EUW10,12345678") == "0"
    assert served.end() == (0, "")

    assert meet(serve("--flash", flash)).ask("!7EUR10") == "0,12345678"
    assert [path.name for path in tmp_path.iterdir()] == ["unit.flash"]


def test_the_eeprom_survives_a_kill_after_the_answer(
    serve: Serve, meet: Meet, tmp_path: Path
) -> None:
    served = serve("--flash", tmp_path / "unit.flash")
    host = meet(served)
    for value in range(5):
        assert host.ask(f"!0EW20,{value:02X}") == "0"
    served.end(signal.SIGKILL)

    assert meet(serve("--flash", tmp_path / "unit.flash")).ask("!0ER20") == "0,04"


def test_without_a_file_the_eeprom_is_as_delivered(host: Host) -> None:
    assert [host.ask(f"!0ER{place}") for place in ("01", "05", "FD")] == ["0,00", "0,FF", "0,0A"]


def test_j_keeps_the_eeprom_and_forgets_the_rest(host: Host) -> None:
    host.ask("!0EW20,55")
    host.ask("!0SW0,0F")
    assert host.ask("!0J") == "0"
    assert (host.ask("!0ER20"), host.ask("!0SR0")) == ("0,55", "0,00")


def test_the_flash_of_another_kind_of_unit_is_refused(tmp_path: Path) -> None:
    flash = tmp_path / "unit.flash"
    other = Served("--tcp", "0", "--flash", flash, cwd=tmp_path, command=COMMAND)
    other.end()
    kept = flash.read_bytes()

    status, complaint = refusal("--tcp", "0", "--flash", flash, command=GVE_COMMAND)

    assert status == 2
    assert "not the flash of a unit (it is damaged, or of another kind of unit)" in complaint
    assert flash.read_bytes() == kept


def test_a_flash_in_use_is_refused(serve: Serve, tmp_path: Path) -> None:
    flash = tmp_path / "unit.flash"
    serve("--flash", flash)
    status, complaint = refusal("--tcp", "0", "--flash", flash, command=GVE_COMMAND)
    assert status == 2
    assert f"{flash}: another gve134 serve uses it" in complaint


# ---- options ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--baud", "19200"], "--baud 19200: no rate of the unit; write 38400, 57600, 115200, "),
        (["--speed", "2000"], "--speed 2000: write 0.001 to 1000 times real time"),
        (["--tcp", "99999"], "--tcp 99999: not a port"),
        (["--noise", "1000001"], "--noise 1000001: not such a number, or out of range"),
        (["--loss", "-1"], "--loss -1: not such a number, or out of range"),
        (["--node", "1"], "unrecognized arguments: --node 1"),
        (["--tcp", "0", "--pty", "x"], "not allowed with argument"),
    ],
)
def test_wrong_options_are_told(options: list[str], complaint: str) -> None:
    status, told = refusal(*options, command=GVE_COMMAND)
    assert status == 2
    assert told.startswith("gve134: ")
    assert complaint in told


def test_a_port_in_use_is_told(serve: Serve) -> None:
    number = serve().place.rpartition(":")[2]
    status, complaint = refusal("--tcp", number, command=GVE_COMMAND)
    assert status == 3
    assert complaint.startswith(f"gve134: --tcp {number}: cannot listen there")


def test_it_ends_without_a_word(serve: Serve, meet: Meet) -> None:
    served = serve()
    meet(served).ask("!0L1000000")
    assert served.end(signal.SIGINT) == (0, "")


def test_what_is_for_another_address_has_no_answer(host: Host) -> None:
    host.send("!3?")
    assert host.answer(SILENCE_SECONDS) is None
    assert host.ask("!0@") == "0,0"


# ---- several clients ----


def sized(commands: int) -> list[str]:
    """A packet of so many vectors, as lines."""
    return ["!0*S", *["!0C100,100,100,100"] * commands, f"!0*E{commands}"]


def test_each_client_hears_the_answers_to_what_it_has_sent(serve: Serve, meet: Meet) -> None:
    served = serve()
    one, other = meet(served), meet(served)

    for turn in range(20):
        one.send("!0SR4")
        other.send("!0SR6")
        one.send(f"!0ER{turn:02X}")
        assert one.answer() == "0,00"
        assert other.answer() == "0,00"
        assert one.answer() == ("0,00" if turn == 1 else "0,FF")

    assert one.answer(SILENCE_SECONDS) is None
    assert other.answer(SILENCE_SECONDS) is None


def test_the_answer_to_w_is_not_that_to_the_h_of_another_client(serve: Serve, meet: Meet) -> None:
    served = serve()
    homing, halting = meet(served), meet(served)
    homing.ask("!0A1")
    homing.send("!0WX1000000,2000,10,10")
    time.sleep(SILENCE_SECONDS)
    homing.send("!0@")
    halting.send("!0H")

    assert halting.answer() == "8"
    assert halting.answer(SILENCE_SECONDS) is None
    assert homing.answer() == "8"
    assert homing.answer() == "8,2"


def test_a_reset_answers_only_who_has_asked_for_it(serve: Serve, meet: Meet) -> None:
    served = serve()
    homing, resetting = meet(served), meet(served)
    homing.send("!0WX1000000,200,10,10")
    homing.send("!0PF")
    time.sleep(SILENCE_SECONDS)

    assert resetting.ask("!0J") == "0"
    assert homing.answer(SILENCE_SECONDS) is None
    assert homing.ask("!0PF") == "0,0,0,0"


def test_a_halt_does_not_come_to_stand_within_a_packet(serve: Serve, meet: Meet) -> None:
    served = serve()
    sending, halting = meet(served), meet(served)
    begin, *vectors, end = sized(100)
    os.write(sending._fd, "\r".join([begin, *vectors[:50], vectors[50][:7]]).encode())
    time.sleep(SILENCE_SECONDS)

    assert halting.ask("!0H") == "8"
    sending.send("\r".join([vectors[50][7:], *vectors[51:], end]))
    assert sending.answer() == "8,100"
    assert sending.answer(SILENCE_SECONDS) is None


def test_what_is_not_whole_does_not_hold_up_another_client(serve: Serve, meet: Meet) -> None:
    served = serve()
    half, halting = meet(served), meet(served)
    os.write(half._fd, b"!0SR")
    time.sleep(SILENCE_SECONDS)

    assert halting.ask("!0H") == "8"
    assert half.ask("6") == "8,90"


def test_a_packet_whose_end_was_lost_is_over_after_a_second(serve: Serve, meet: Meet) -> None:
    host = meet(serve())
    host.send("\r".join(sized(3)[:-1]))
    time.sleep(1.1)

    assert host.ask("!0PF") == "0,0,0,0"


def test_the_last_answer_of_another_client_is_not_told_again(serve: Serve, meet: Meet) -> None:
    served = serve()
    one, other = meet(served), meet(served)
    assert one.ask("!0SR4") == "0,00"
    assert one.ask("!0>") == "0,00"
    assert other.ask("!0H") == "8"

    one.send("!0>")

    assert one.answer(SILENCE_SECONDS) is None
    assert one.ask("!0SR4") == "8,00"
    assert one.ask("!0>") == "8,00"


def test_answers_find_their_client_again_after_damage(serve: Serve, meet: Meet) -> None:
    served = serve()
    one, other = meet(served), meet(served)
    assert one.ask("!0%+") == "0,5C"
    one.send("!0H")  # without a checksum: all is thrown away for a while
    other.send("!0?,BC")
    assert one.answer() == "2,5E"
    assert other.answer(SILENCE_SECONDS) is None

    assert one.ask("!0PF,13") == "0,0,0,0,70"
    assert other.ask("!0?,BC") == "0,IP134/200 v1 22.11.2026,4D"


def test_a_new_client_does_not_hear_what_one_before_it_has_asked(serve: Serve, meet: Meet) -> None:
    served = serve()
    gone = meet(served)
    gone.ask("!0A1")
    gone.ask("!0L1000000")
    time.sleep(SILENCE_SECONDS)
    gone.send("!0H")
    gone.close()
    new = Host(served.place)
    try:
        assert new.ask("!0SR1") == "8,00"
        assert new.answer(SILENCE_SECONDS) is None
    finally:
        new.close()
