"""The line of the GVE134 image on the virtual board: while the flash is erased, without a crystal,
after an upset of its stream, at the lowest and the highest rate."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from rkm04_tools import board, virtual_board
from virtual_board import Modelled

UNIT = "gve134"
START_MS = 50.0
VERSION = board.version(UNIT)
FLASH_BYTES = 1 << 20
AREAS_BEGIN = 0xC0000
"""Sectors 10 and 11, with what is kept without power."""

Ask = Callable[..., "Talk"]


class Talk(Modelled):
    """A run, and what the unit has said."""

    @property
    def said(self) -> list[tuple[float, str]]:
        """Answers, with the time at which each began, in ms."""
        found, begin, text = [], 0.0, ""
        for row in (self.folder / "log.txt").read_text().splitlines():
            ms, byte = row.split()
            begin = begin if text else float(ms)
            text += chr(int(byte, 16))
            if text.endswith("\r"):
                found.append((begin, text[:-1]))
                text = ""
        return found

    @property
    def answers(self) -> list[str]:
        return [answer for _, answer in self.said]


@pytest.fixture
def ask(program: Path, tmp_path: Path) -> Ask:
    """Send commands: ms, and what then comes back to back."""

    def run(
        *sent: tuple[float, str],
        ms: float = 200.0,
        baud: int = 115_200,
        options: tuple[str, ...] = (),
    ) -> Talk:
        image = board.build(board.DEFAULT_BOARD, what=UNIT, baud=baud)
        (tmp_path / "pins").write_text(virtual_board.board_pins(image.board, UNIT))
        lines = (f"{at:.3f} {text.encode().hex()}\n" for at, text in sent)
        (tmp_path / "line").write_text("".join(lines))
        arguments = ["--elf", str(image.file("elf")), "--pins", str(tmp_path / "pins")]
        arguments += ["--line-script", str(tmp_path / "line"), "--baud", str(baud)]
        arguments += ["--line-log", str(tmp_path / "log.txt"), "--for", f"{ms / 1000:.6f}"]
        arguments += ["--vcd", str(tmp_path / "board.vcd"), "--watch", "stm32_late_steps"]
        arguments += ["--stack-limit", "stm32_stack_bottom", *options]
        return Talk(virtual_board.run(program, arguments), None, tmp_path)  # type: ignore[arg-type]

    return run


def test_the_start_does_not_hold_the_line_low(ask: Ask) -> None:
    talk = ask((START_MS, "!0?\r"), ms=START_MS + 10)

    assert talk.answers == [f"0,{VERSION}"]
    assert talk.summary["line"]["breaks"] == 0


@pytest.mark.parametrize("baud", [board.RATES[0], board.RATES[-1]])
def test_an_answer_begins_at_most_a_millisecond_after_its_command(ask: Ask, baud: int) -> None:
    commands = ["!0?\r", "!0V1000\r", "!7V300\r", "!0PF\r", "!0SR6\r"]
    sent = [(START_MS + 20.37 * i, command) for i, command in enumerate(commands)]
    talk = ask(*sent, baud=baud)

    assert talk.answers == [f"0,{VERSION}", "0", "0", "0,0,0,0", "0,00"]
    late = [
        begin - at - len(command) * 10_000 / baud
        for (begin, _), (at, command) in zip(talk.said, sent, strict=True)
    ]
    assert min(late) > 0
    assert max(late) < 1


def test_what_comes_while_the_flash_is_erased_is_executed_after_it(
    ask: Ask, tmp_path: Path
) -> None:
    """The areas are neither erased nor good, so the first write erases one."""
    flash = np.full(FLASH_BYTES, 0xFF, dtype=np.uint8)
    flash[AREAS_BEGIN:] = 0
    (tmp_path / "flash").write_bytes(flash.tobytes())
    asks = "".join(f"!0ER{number:02d}\r" for number in range(40))
    talk = ask(
        (START_MS, f"!0EW10,01\r{asks}!0ER10\r"), ms=2500.0,
        options=("--flash", str(tmp_path / "flash")),
    )  # fmt: skip

    assert len(asks) >= 256
    assert talk.summary["flash"]["erases"] >= 1
    assert talk.said[0][0] > START_MS + 500
    assert len(talk.answers) == 42
    assert talk.answers[0] == "8"
    assert talk.answers[-1] == "8,01"
    assert "2" not in {answer[0] for answer in talk.answers}


def test_without_a_crystal_it_answers_and_makes_no_step(ask: Ask) -> None:
    talk = ask(
        (150.0, "!0?\r"), (170.0, "!0L100,0,0,0\r"), (190.0, "!0SR6\r"), ms=1300.0,
        options=("--no-crystal",),
    )  # fmt: skip

    assert talk.answers == [f"8,{VERSION}", "F", "8,84"]
    assert [motor["pulses"] for motor in talk.summary["motors"]] == [0, 0, 0, 0]
    blinks = [ms for ms, _ in talk.edges("m1_led")]
    assert [round(b - a, -1) for a, b in pairwise(blinks[1:])] == [500.0]
    assert not talk.edges("m2_led")  # all four blink with RKM04 only


def test_the_line_goes_on_after_its_stream_was_led_astray(ask: Ask) -> None:
    talk = ask(
        (START_MS, "!0?\r"), (60.0, "!0V100\r"), (250.0, "!0V200\r"), (400.0, "!0PF\r"), ms=500.0,
        options=("--fault", "60.3:dma=10"),
    )  # fmt: skip

    assert talk.answers[0] == f"0,{VERSION}"
    assert talk.answers[-1] == "0,0,0,0"
    assert len(talk.answers) >= 3


def test_a_host_that_does_not_wait_for_answers_brings_no_step_to_a_fault(ask: Ask) -> None:
    """More commands than can be executed are damage; the axes go on."""
    vectors = "!0*S\r" + "!0C100,100,100,100\r" * 60 + "!0*E60\r"
    talk = ask(
        (START_MS, "!0A8000\r"), (START_MS + 2, "!0V200000\r"), (START_MS + 4, "!0$1\r"),
        (START_MS + 6, vectors + "!0C100,100,100,100\r!0P4\r!0V200000\r!0P4\r" * 300),
        (START_MS + 400, "!0P4\r"), ms=START_MS + 420, baud=921_600,
    )  # fmt: skip

    assert talk.summary["resets"] == {"power": 1, "software": 0, "watchdog": 0}
    assert talk.summary["line"]["overruns"] == 0
    assert {answer[0] for answer in talk.answers} <= {"0", "1", "2"}
    assert talk.answers[-1].startswith("0,")
    assert len(set(talk.answers[-1][2:].split(","))) == 1
    assert int(talk.answers[-1].split(",")[1]) >= 6000
