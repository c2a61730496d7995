"""Board headers: the checker finds what is wrong in one, and tables and headers agree."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from checks import board_pins
from rkm04_tools import board, board_header, board_wiring
from rkm04_tools.failure import NOT_SO
from rkm04_tools.tree import ROOT
from wires import times_us, wires

GOOD = (board.BOARDS / "f405" / "board.h").read_text()
CAPTURE = "X(CAPTURE, B, 6, TIM4_CH1)"
PLAIN = GOOD.partition("#define BOARD_PWM_PINS")[0] + GOOD.partition(CAPTURE)[2]
"""Without the pins that only some images have."""


@pytest.mark.parametrize("name", board.names())
def test_a_board_has_nothing_wrong(name: str) -> None:
    assert list(board_pins.find_errors((board.BOARDS / name / "board.h").read_text())) == []


@pytest.mark.parametrize("name", board.names())
def test_the_table_of_a_board_has_the_pins_of_its_header(name: str) -> None:
    pins = board_header.read_board((board.BOARDS / name / "board.h").read_text()).pins

    assert [(w.signal, w.pin) for w in wires(name)] == [(p.signal, p.pin) for p in pins]


# Datasheet DS8626, table 9: which pins have what of the timers, and of USARTs for the line.
FUNCTIONS = {
    "A0": ["TIM2_CH1", "TIM5_CH1"], "A1": ["TIM2_CH2", "TIM5_CH2"],
    "A2": ["TIM2_CH3", "TIM5_CH3", "USART2_TX"], "A3": ["TIM2_CH4", "TIM5_CH4", "USART2_RX"],
    "A5": ["TIM2_CH1"], "A9": ["USART1_TX"], "A10": ["USART1_RX"], "A15": ["TIM2_CH1"],
    "B3": ["TIM2_CH2"], "B6": ["USART1_TX"], "B7": ["USART1_RX"],
    "B10": ["TIM2_CH3", "USART3_TX"], "B11": ["TIM2_CH4", "USART3_RX"],
    "C10": ["USART3_TX"], "C11": ["USART3_RX"], "D5": ["USART2_TX"], "D6": ["USART2_RX"],
    "D8": ["USART3_TX"], "D9": ["USART3_RX"],
}  # fmt: skip
CHANNEL = re.compile(r"TIM(\d) channel (\d)")


@pytest.mark.parametrize("name", board.names())
def test_the_table_of_a_board_names_functions_that_the_datasheet_gives_its_pins(name: str) -> None:
    rows = {wire.signal: wire for wire in wires(name)}
    steps = [rows[f"STEP_{channel}"] for channel in range(1, 5)]
    ends = {end: rows[f"LINE_{end}"] for end in ("TX", "RX")}

    channels = [CHANNEL.sub(r"TIM\1_CH\2", wire.note).split(",")[0] for wire in steps]
    if set(channels) != {"GPIO"}:
        for channel, wire in zip(channels, steps, strict=True):
            assert channel in FUNCTIONS[wire.pin]
        assert len(set(channels)) == len(channels)
        assert "TIM2_CH4" not in channels  # it calls the step interrupt
    pins = board_header.read_board((board.BOARDS / name / "board.h").read_text()).pins
    assert channels == [pin.use for pin in pins if pin.signal.startswith("STEP")]
    for end, wire in ends.items():
        assert f"{wire.note}_{end}" in FUNCTIONS[wire.pin]


def value_us(board_h: str, key: str) -> float:
    return int(board_header.read_board(board_h).values[key].rstrip("U")) / 1000


@pytest.mark.parametrize("name", board.names())
def test_the_page_of_a_board_has_the_times_of_its_header(name: str) -> None:
    header = (board.BOARDS / name / "board.h").read_text()
    keys = ("STEP_HIGH", "STEP_LOW", "DIR_SETUP", "DIR_HOLD")

    assert list(times_us(name).values()) == [value_us(header, f"BOARD_{key}_NS") for key in keys]


def test_a_board_is_there_when_its_folder_is(
    tool: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("second", "first"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "board.h").touch()
    (tmp_path / "notes").mkdir()
    monkeypatch.setattr(board, "BOARDS", tmp_path)

    assert tool("completion", "--words", "board", "build", "--board", "").out.split() == [
        "first",
        "second",
    ]
    assert "one of first, second" in " ".join(tool("board", "size", "--help").out.split())
    assert "nucleo: no such board; there are first, second" in (
        tool("board", "build", "--board", "nucleo").complaint
    )


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (["--board", "skr-pro-1.2"], "an interrupt makes the steps of skr-pro-1.2"),
        (["--image", "bringup"], "what a new board is tried with has pulses of one width"),
    ],
)
def test_pulses_of_half_a_period_are_refused_where_they_cannot_be(
    tool: Callable[..., Any], options: list[str], why: str
) -> None:
    result = tool("board", "build", "--half-period", *options)

    assert result.status == 2
    assert f"--half-period: {why}" in result.complaint


@pytest.mark.skipif(not shutil.which(board.COMPILER), reason=f"{board.COMPILER} is not installed")
def test_a_build_for_an_unknown_board_is_told_which_there_are(tmp_path: Path) -> None:
    done = subprocess.run(
        ["cmake", "--preset", "stm32", "-B", str(tmp_path), "-DFIRMWARE_BOARD=nucleo"],
        cwd=ROOT, capture_output=True, text=True,
    )  # fmt: skip

    assert done.returncode != 0
    assert f"no such board; there are {', '.join(board.names())}" in " ".join(done.stderr.split())


FIRST = "X(STEP_1, A, 0, TIM5_CH1)"
LAST = "#define BOARD_DIR_HOLD_NS"


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("X(LED_2, C, 9, OUT)", "X(LED_2, C, 8, OUT)", "PC8 is used twice: LED_1 and LED_2"),
        ("X(DIR_2, A, 7, TIM3_CH2)", "X(DIR_2, A, 7, OUT)", "DIR_2 must be one of TIM3_CH1"),
        ("X(DIR_2, A, 7, TIM3_CH2)", "X(DIR_2, A, 7, TIM3_CH1)", "PA7 has no TIM3_CH1"),
        ("X(DIR_1, A, 6, TIM3_CH1)", "X(DIR_1, B, 5, TIM3_CH2)", "DIR_2 and DIR_1 are both"),
        (FIRST, "X(STEP_1, C, 12, TIM5_CH1)", "PC12 has no TIM5_CH1"),
        (FIRST, "X(STEP_1, B, 10, TIM5_CH3)", "PB10 has no TIM5_CH3"),
        (FIRST, "X(STEP_1, A, 0, OUT)", "STEP_1 must be one of TIM2_CH1, TIM2_CH2, TIM2_CH3, TIM5"),
        (FIRST, "X(STEP_1, A, 3, TIM2_CH4)", "STEP_1 must be one of"),
        (FIRST, "X(STEP_1, A, 1, TIM5_CH2)", "STEP_2 and STEP_1 are both TIM5_CH2"),
        (FIRST, "X(STEP_1, C, 12, TIM5_CH2)", "PC12 has no TIM5_CH2"),
        ("X(LINE_TX, A, 9, USART1)", "X(LINE_TX, B, 7, USART1)", "PB7 has no USART1_TX"),
        ("X(LINE_RX, A, 10, USART1)", "X(LINE_RX, A, 10, IN)", "LINE_RX must be USART1"),
        ("#define BOARD_USART 1", "#define BOARD_USART 3", "must be USART3, as BOARD_USART says"),
        ("X(BO_1, B, 8, OUT)", "X(BO_1, D, 8, OUT)", "BO_1: LQFP64 has no PD8"),
        ("X(BO_1, B, 8, OUT)", "X(BO_1, A, 13, OUT)", "BO_1: PA13 belongs to SWDIO"),
        ("X(BO_1, B, 8, OUT)", "X(BO_1, B, 8, IN)", "BO_1 cannot be IN"),
        ("X(BO_1, B, 8, OUT)", "X(BO_1, B, 4, OUT)", "BO_1: PB4 is pulled up at reset as NJTRST"),
        (FIRST, "X(STEP_1, A, 15, TIM2_CH1)", "STEP_1: PA15 is pulled up"),
        ("X(BO_1, B, 8, OUT)", "X(BO_1, C, 13, OUT)", "BO_1: PC13 must feed nothing (DS8626)"),
        ("X(LED_1, C, 8, OUT)", "X(LED_1, C, 15, OUT)", "LED_1: PC15 must feed nothing (DS8626)"),
        ("X(BI_1, C, 0, IN_UP)", "X(BI_1, C, 0, OUT)", "BI_1 cannot be OUT"),
        ("X(BI_1, C, 0, IN_UP)", "", "BI_1 has no pin"),
        ("X(S1_1, A, 4, IN_UP)", "X(S1_1, A, 4, IN_UP) X(EN_1, B, 6, OUT)", "ENABLE is EN_ALL, or"),
        ("X(PWM, B, 6, TIM4_CH1)", "X(PWM, B, 4, TIM4_CH1)", "PB4 has no TIM4_CH1"),
        ("X(PWM, B, 6, TIM4_CH1)", "X(PWM, A, 15, OUT)", "PWM: PA15 is pulled up at reset"),
        ("X(PWM, B, 6, TIM4_CH1)", "X(PWM, A, 15, OUT)", "PWM must be one of TIM4_CH1"),
        ("X(LED_8, B, 7, OUT)", "X(LED_9, B, 7, OUT)", "LED_9 is not a signal"),
        ("X(LED_8, B, 7, OUT)", "X(LED_8, B, 7, IN)", "LED_8 cannot be IN"),
        (CAPTURE, "X(CAPTURE, B, 6, TIM4_CH2)", "CAPTURE must be one of TIM1_CH1, TIM4_CH1"),
        (CAPTURE, "X(CAPTURE, A, 8, TIM4_CH1)", "PA8 has no TIM4_CH1"),
        (CAPTURE, "X(CAPTURE, A, 8, TIM1_CH1)", "PA8 is used twice: LINE_DE and CAPTURE"),
        ("X(BI_1, C, 0, IN_UP)", "X(BI_9, C, 0, IN_UP)", "BI_9 is not a signal"),
        ('"LQFP64"', '"LQFP65"', "BOARD_PACKAGE must be one of"),
        ("BOARD_BI_LEVEL 0U", "BOARD_BI_LEVEL 0", "BOARD_BI_LEVEL must be 0U or 1U, not 0"),
        ("BOARD_PWM_LEVEL 1U", "BOARD_PWM_LEVEL 2U", "BOARD_PWM_LEVEL must be 0U or 1U, not 2U"),
        ("BOARD_USART 1", "BOARD_USART 1 /* P5 */", "BOARD_USART must be one plain value"),
        ("BOARD_USART 1", "BOARD_USART (1)", "BOARD_USART must be one plain value"),
        ("#define BOARD_USART", " # define BOARD_USART", "BOARD_USART must be one plain value"),
        (LAST, f"#define BOARD_LOADER_BYTES 0x8000U\n{LAST}", "as 0x8000, not 0x8000U"),
        (LAST, f"#define BOARD_LOADER_BYTES 32 * 1024\n{LAST}", "BOARD_LOADER_BYTES must be one"),
    ],
)
def test_a_planted_fault_is_found(old: str, new: str, complaint: str) -> None:
    assert old in GOOD

    errors = list(board_pins.find_errors(GOOD.replace(old, new)))

    assert any(complaint in error for error in errors), errors


@pytest.mark.parametrize(
    "pin", ["A, 5, TIM2_CH1", "B, 3, TIM2_CH2", "A, 0, TIM2_CH1", "B, 10, TIM2_CH3"]
)
def test_a_step_pin_may_be_a_channel_of_either_timer(pin: str) -> None:
    errors = list(board_pins.find_errors(GOOD.replace(FIRST, f"X(STEP_1, {pin})")))

    assert [e for e in errors if "STEP_1" in e and "used twice" not in e] == []


def test_inputs_may_be_on_any_pins_and_the_first_of_those_that_share_a_line_has_it() -> None:
    header = PLAIN.replace("X(BI_5, C, 4, IN_UP)", "X(BI_5, B, 3, IN_UP)")

    assert header != PLAIN
    assert list(board_pins.find_errors(header)) == []
    assert board_header.inputs_without_edges(board_header.read_board(header).pins) == ["BI_5"]
    assert board_header.inputs_without_edges(board_header.read_board(GOOD).pins) == []


@pytest.mark.parametrize(
    "rows",
    [
        "X(EN_ALL, B, 6, OUT)",
        "X(EN_1, B, 6, OUT) X(EN_2, B, 7, OUT) X(EN_3, C, 12, OUT) X(EN_4, D, 2, OUT)",
    ],
)
def test_enable_is_one_pin_or_one_of_each_motor(rows: str) -> None:
    assert list(board_pins.find_errors(f"{PLAIN}#define BOARD_ENABLE_PINS(X) {rows}\n")) == []


def test_an_led_that_is_on_at_low_may_be_at_a_pin_that_only_sinks() -> None:
    header = GOOD.replace("X(LED_1, C, 8, OUT)", "X(LED_1, C, 13, OUT)")

    header = header.replace("BOARD_LED_LEVEL 1U", "BOARD_LED_LEVEL 0U")

    assert list(board_pins.find_errors(header)) == []


@pytest.mark.parametrize(("level", "wrong"), [("0U", False), ("1U", True)])
def test_drivers_that_a_reset_would_switch_on_are_found(level: str, wrong: bool) -> None:
    enable = (
        f"#define BOARD_ENABLE_PINS(X) X(EN_ALL, A, 15, OUT)\n#define BOARD_ENABLE_LEVEL {level}"
    )

    errors = list(board_pins.find_errors(f"{PLAIN}{enable}\n"))

    assert errors == ["EN_ALL: PA15 is pulled up at reset as JTDI"] * wrong


def test_a_pin_that_a_part_of_the_board_takes_is_found() -> None:
    taken = '#define BOARD_TAKEN(X) X(B, 8, "a lamp")\n'

    assert list(board_pins.find_errors(GOOD + taken)) == ["BO_1: PB8 belongs to a lamp"]


def test_the_checker_says_what_is_wrong_with_a_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    header = tmp_path / "board.h"
    header.write_text(GOOD.replace("X(LED_2, C, 9, OUT)", "X(LED_2, C, 8, OUT)"))

    assert board_pins.main([str(header)]) == 1
    assert f"{header}: PC8 is used twice" in capsys.readouterr().err


@pytest.mark.parametrize("line", ["#define BOARD_USART 6", ""])
def test_a_line_that_no_driver_has_is_told_once(line: str) -> None:
    header = GOOD.replace("USART1)", "USART6)").replace("#define BOARD_USART 1", line)

    assert list(board_pins.find_errors(header)) == [
        "BOARD_USART must be 1, 2 or 3, as the line's driver has USART1, USART2, USART3"
    ]


def test_the_pins_of_a_board_are_shown_with_what_the_hardware_makes_of_them(
    tool: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "odd").mkdir()
    enables = (
        "#define BOARD_ENABLE_PINS(X) X(EN_ALL, B, 6, OUT)\n#define BOARD_ENABLE_LEVEL 0U\n"
        "#define BOARD_ENABLE_READY_US 150U\n#define BOARD_ENABLE_IDLE_MS 2500U\n"
    )
    header = PLAIN.replace("X(BI_5, C, 4, IN_UP)", "X(BI_5, B, 3, IN_UP)")
    (tmp_path / "odd" / "board.h").write_text(header + enables)
    monkeypatch.setattr(board, "BOARDS", tmp_path)

    rows = tool("board", "pins", "--board", "odd", "--json").json["pins"]
    shown = {row["signal"]: (row["pin"], row["one"], row["what"]) for row in rows}
    lines = tool("board", "pins", "--board", "odd").out.splitlines()

    assert shown["STEP_1"] == ("PA0", "high", "TIM5 channel 1, class 1, each edge on its tick")
    assert shown["BI_4"] == ("PC3", "low", "an edge acts at once")
    assert shown["BI_5"][2] == "looked at every millisecond, as BI_4 has its line for edges"
    assert shown["EN_ALL"][1] == "low"
    assert shown["EN_ALL"][2] == (
        "on 150 us before a motion's first pulse, off 2.5 s after the last motion"
    )
    assert len(lines) == 1 + len(rows)
    assert lines[1].split()[:3] == ["STEP_1", "PA0", "high"]


LOADER_BOARD = "skr-pro-1.2"


def test_an_image_after_a_loader_is_written_there(tmp_path: Path) -> None:
    command = board.flash_command("dfu-util", board.Image(LOADER_BOARD, tmp_path), "stlink", "")

    assert "0x08008000:leave" in command


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (["--tool", "stm32flash", "--port", "x"], "stm32flash would erase the loader of the board"),
        (["--tool", "dfu-util"], f"dfu-util is said not to work on {LOADER_BOARD}: its crystal"),
    ],
)
@pytest.mark.parametrize("image", board.IMAGES)
def test_what_does_not_get_an_image_into_a_board_is_refused_before_anything_is_built(
    tool: Callable[..., Any], monkeypatch: pytest.MonkeyPatch, options: list[str], why: str,
    image: str,
) -> None:  # fmt: skip
    monkeypatch.setattr(board, "build", lambda *_, **__: pytest.fail("it was built"))

    result = tool(
        "board", "flash", "--board", LOADER_BOARD, "--dry-run", "--image", image, *options
    )

    assert result.status == NOT_SO
    assert why in result.complaint
    assert result.complaint.endswith("; take --tool openocd")


def test_a_board_of_class_2_has_its_steps_on_any_pins_and_says_so() -> None:
    header = board_header.read_board((board.BOARDS / LOADER_BOARD / "board.h").read_text())
    shown = {wire.signal: wire.what for wire in board_wiring.wires(header)}

    assert "class 2" in shown["STEP_1"]
    assert shown["BI_5"] == "looked at every millisecond, as BI_1 has its line for edges"
    timed = GOOD + "#define BOARD_STEP_CLASS 2\n"
    assert "STEP_1 must be GPIO, as BOARD_STEP_CLASS says, not TIM5_CH1" in list(
        board_pins.find_errors(timed)
    )
    assert "BOARD_STEP_CLASS must be 1 or 2" in list(
        board_pins.find_errors(GOOD + "#define BOARD_STEP_CLASS 3\n")
    )
