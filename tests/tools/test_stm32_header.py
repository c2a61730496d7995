"""The form of a board header: what the compiler would read otherwise than the build is refused."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from checks import board_pins
from own_board import configured
from rkm04_tools import board, board_form, board_header
from rkm04_tools.failure import NOT_SO

GOOD = (board.BOARDS / "f405" / "board.h").read_text()
ROW = "X(BO_1, B, 8, OUT)"
USART = "#define BOARD_USART 1\n"
LOADER = "#define BOARD_LOADER_BYTES 0x10000\n"
ENABLES = "#define BOARD_ENABLE_PINS(X) X(EN_ALL, D, 2, OUT)\n"
IN_COMMENT = "is in a comment"
NO_IF = "a board header has only #define"
PLAIN = "BOARD_USART must be one plain value"


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        (USART, f"{USART}/*\n{LOADER}*/\n", f"`#define BOARD_LOADER_BYTES` {IN_COMMENT}"),
        (USART, f"{USART}/* {ENABLES} */\n", f"`#define BOARD_ENABLE_PINS` {IN_COMMENT}"),
        (ROW, f"/* was X(BO_1, A, 2, OUT) */ {ROW}", f"`X(BO_1, A, 2, OUT)` {IN_COMMENT}"),
        (ROW, f"{ROW} /* X(BO_2,A,2,OUT) */", f"`X(BO_2,A,2,OUT)` {IN_COMMENT}"),
        (USART, f'{USART}// X(A, 2, "USB")\n', f'`X(A, 2, "USB")` {IN_COMMENT}'),
        (USART, f"{USART}/* #if 0 */\n", f"`#if 0` {IN_COMMENT}"),
        (USART, f"#if 0\n{USART}#endif\n", f"#if: {NO_IF}"),
        (USART, f"#ifdef OLD\n{LOADER}#else\n#endif\n{USART}", f"#else: {NO_IF}"),
        (USART, f"{USART}#undef BOARD_USART\n", f"#undef: {NO_IF}"),
        (USART, f'#include "more.h"\n{USART}', f"#include: {NO_IF}"),
        (USART, f"{USART}enum {{ MORE = 2 }};\n", "`enum { MORE = 2 };` is neither a #define nor"),
        (USART, f"{USART}#define BOARD_USART 2\n", "BOARD_USART is defined twice"),
        (USART, f"{USART}#define BOARD_PINS(X)\n", "BOARD_PINS is defined twice"),
        (ROW, f"{ROW} X(BO_1, D, 2, OUT)", "BO_1 has two pins"),
        (ROW, f"{ROW} X(BO_1,D,2,OUT)", "BO_1 has two pins"),
        (ROW, f"{ROW} X(EN_ALL, D, 2, OUT)", "EN_ALL belongs in BOARD_ENABLE_PINS, not in BOARD_P"),
        (ROW, f"{ROW} MORE(X)", "BOARD_PINS: `MORE(X)` is not X(SIGNAL, PORT, NUMBER, USE)"),
        (ROW, f'{ROW} X(A, 2, "USB")', 'BOARD_PINS: `X(A, 2, "USB")` is not X(SIGNAL,'),
        (USART, f"{USART}#define BOARD_TAKEN(X) X(A, 2, USB)\n", "`X(A, 2, USB)` is not X(PORT,"),
        (USART, f"{USART}#define BOARD_TAKEN X(A, 2, USB)\n", "must be `#define BOARD_TAKEN(X)`"),
        (
            USART,
            f"{USART}#define BOARD_LOADER_BYTE 0x8000\n",
            "BYTE is not a name that a board has",
        ),
        (USART, f"{USART}#define BOARD_LOADER_BYTE 0x8000\n", "but BOARD_LOADER_BYTES is"),
        (
            USART,
            f"{USART}#define BOARD_TAKE(X)\n",
            "BOARD_TAKE is not a name that a board has, but",
        ),
        (USART, f"{USART}#define IMAGE_PWM 1\n", "IMAGE_PWM is not a name that a board has"),
        (USART, "#define BOARD_USART \\\n1\n", PLAIN),
        (USART, "#define BOARD_USART\n", PLAIN),
        (USART, "/* the line */ #define BOARD_USART 1\n", PLAIN),
        (USART, "#define BOARD_USART /* of the\nline */ 1\n", PLAIN),
    ],
)
def test_what_is_not_read_alike_is_refused(old: str, new: str, complaint: str) -> None:
    assert old in GOOD

    errors = list(board_pins.find_errors(GOOD.replace(old, new)))

    assert any(complaint in error for error in errors), errors


def test_comments_may_name_pins_and_values_in_words() -> None:
    words = "/* BO_1 was at PA2; X(signal, port, pin, use); #3 of LOADER_BYTES */\n// as was BO_2\n"
    text = GOOD.replace(USART, words + USART).replace(ROW, f"{ROW} /* a relay */")

    assert list(board_pins.find_errors(text)) == []
    assert board_header.read_board(text) == board_header.read_board(GOOD)


def test_a_string_is_not_a_comment() -> None:
    taken = '#define BOARD_TAKEN(X) X(D, 2, "5 V // 3 V /*") X(C, 13, "*/")\n'

    assert list(board_form.form_errors(GOOD.replace(USART, taken + USART))) == []
    assert board_header.read_board(taken).taken == {"D2": "5 V // 3 V /*", "C13": "*/"}


def test_rows_are_read_with_and_without_spaces() -> None:
    assert board_header.read_board(GOOD.replace(ROW, "X( BO_1 ,B,8,OUT )")) == (
        board_header.read_board(GOOD)
    )


def test_the_names_of_values_are_those_of_the_page() -> None:
    page = (board.BOARDS / "README.md").read_text().partition("\n## Values\n")[2]
    cells = re.findall(r"^\| (`(?!BOARD_)[^|]*) \|", page.partition("\n## ")[0], re.MULTILINE)
    names = [name for cell in cells for name in re.findall(r"`(\w+)`", cell)]
    named = {f"BOARD_{name}LEVEL" if name.endswith("_") else f"BOARD_{name}" for name in names}

    assert named == board_form.VALUES


def test_the_names_of_lists_are_those_of_the_page() -> None:
    page = (board.BOARDS / "README.md").read_text().partition("\n## Values\n")[0]

    assert set(re.findall(r"BOARD_\w*(?:PINS|TAKEN|PULLED_UP)\b", page)) == board_form.LISTS


@pytest.mark.parametrize("command", ["pins", "options"])
def test_commands_that_build_nothing_refuse_such_a_header_too(
    tool: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    (tmp_path / "odd").mkdir()
    (tmp_path / "odd" / "board.h").write_text(GOOD.replace(USART, f"#if 0\n{USART}#endif\n"))
    monkeypatch.setattr(board, "BOARDS", tmp_path)

    result = tool("board", command, "--board", "odd")

    assert result.status == NOT_SO
    assert f"board.h: #if: {NO_IF}" in result.complaint


@pytest.mark.skipif(not shutil.which(board.COMPILER), reason=f"{board.COMPILER} is not installed")
def test_an_image_is_not_put_behind_a_loader_that_only_a_comment_has(tmp_path: Path) -> None:
    configured(tmp_path, GOOD.replace(USART, f"{USART}/*\n{LOADER}*/\n"))

    done = subprocess.run(
        ["cmake", "--build", "--preset", "stm32"], cwd=tmp_path, capture_output=True, text=True
    )

    assert done.returncode != 0
    assert f"`#define BOARD_LOADER_BYTES` {IN_COMMENT}" in done.stderr + done.stdout
    assert not list(tmp_path.glob("build/stm32/bin/*"))
