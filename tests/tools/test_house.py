"""The house check finds what it is there for, at the right line, and leaves good files alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from checks import house

LONG_BODY = "    step();\n" * (house.FUNCTION_LINES + 1)
LONG_FUNCTION = f"void run(void)\n{{\n{LONG_BODY}}}\n"


@pytest.mark.parametrize(
    ("name", "text", "line", "complaint"),
    [
        ("firmware/io/a.c", LONG_FUNCTION, 2, "the function has 61 lines"),
        ("firmware/io/a.h", "int a;\n" * 501, 501, "the file has 501 lines"),
        ("firmware/io/a.c", f"int a;\n/* {'a' * 115} */\n", 2, "the line has 121 columns"),
        ("firmware/io/a.c", "int a;\nfloat b;\n", 2, "floating point"),
        ("firmware/io/a.h", "typedef struct a a;\n", 1, "typedef"),
        ("tools/a.py", "def f():\n" + "    pass\n" * 61, 1, "f has 61 lines"),
        ("tools/a.py", 'a = "https://' + 'example.org/x"\n', 1, "names the host"),
        ("tests/a.txt", f"ok\nsee {house.ROOT}/tests\n", 2, "path of this machine"),
    ],
)
def test_a_planted_fault_is_found_at_its_line(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    text: str,
    line: int,
    complaint: str,
) -> None:
    path = tmp_path / name
    path.parent.mkdir(parents=True)
    path.write_text(text)
    monkeypatch.setattr(house, "ROOT", tmp_path)

    [(offset, what)] = house.check_file(path)

    assert complaint in what
    assert text.count("\n", 0, offset) + 1 == line


@pytest.mark.parametrize(
    ("name", "include", "complaint"),
    [
        ("a.c", "../../engine/axis/axis.h", "a source includes by a path"),
        ("a.h", "../../engine/step/step_channel.h", "from engine/step, which is not"),
        ("a.h", "../messages/messages.h", "from rkm04/messages, which is not"),
        ("a.h", "../../../hal/include/hal_io.h", "from ../hal/include, which is not"),
    ],
)
def test_an_include_by_path_is_a_headers_and_of_a_stage_in_its_deps(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, include: str, complaint: str
) -> None:
    stage = tmp_path / "firmware" / "rkm04" / "interpreter"
    stage.mkdir(parents=True)
    (stage / "CMakeLists.txt").write_text("firmware_add_stage(a DEPS rkm04_program engine_axis)\n")
    good = stage / "good.h"
    good.write_text('#include "../../engine/axis/axis.h"\n#include "../program/program.h"\n')
    wrong = stage / name
    wrong.write_text(f'#include "base.h"\n#include "{include}"\n')
    monkeypatch.setattr(house, "ROOT", tmp_path)

    [(offset, what)] = house.check_file(wrong)

    assert complaint in what
    assert wrong.read_text().count("\n", 0, offset) + 1 == 2
    assert not list(house.check_file(good))


def test_a_flat_switch_that_says_so_may_be_long() -> None:
    marked = f"/* One case an opcode. {house.EXEMPTION} */\n{LONG_FUNCTION}"

    assert not list(house.check_c(marked))
    assert len(list(house.check_c(f"{marked}\n{LONG_FUNCTION}"))) == 1


def test_a_line_of_120_columns_is_not_too_long() -> None:
    assert not list(house.check_source(f"int a;\n/* {'a' * 114} */\n"))


def test_words_in_comments_are_not_floating_point() -> None:
    assert not list(house.check_firmware("/* a double\n float */ int a; // float\n"))


def test_the_top_level_has_nothing_but_what_belongs_there() -> None:
    names = ["README.md", ".gitignore", ".ci/run", "hal/a.c", "default.profraw", "shots/a.png"]

    assert house.strangers([house.ROOT / name for name in names]) == ["default.profraw", "shots"]
