"""What is made of branches and decisions that the C tests reached."""

from __future__ import annotations

import pytest
from checks import mcdc

SOURCE = """\
void f(int a, int b)
{
    assert(a > 0 &&
           b > 0);
    if (a > 1 && b > 1) {
        g();
    }
}
"""
SOURCES = {"engine/motion/f.c": SOURCE}
PLACE = ("engine/motion/f.c", 5, 9)


def files(taken: int, passed: int, shown: list[bool]) -> list[dict[str, object]]:
    """Return what llvm-cov says of one source: an assertion that never fails, and a branch."""
    return [
        {
            "filename": str(mcdc.ROOT / "firmware/engine/motion/f.c"),
            "branches": [[4, 12, 4, 17, 7, 0, 0, 0, 4], [5, 9, 5, 14, taken, passed, 0, 0, 4]],
            "mcdc_records": [[3, 12, 4, 17, 0, 5, [False]], [5, 9, 5, 23, 0, 5, shown]],
        },
        {"filename": "/elsewhere.c", "branches": [[1, 1, 1, 2, 0, 0, 0, 0, 4]]},
    ]


def test_copies_of_a_line_count_together_and_assertions_not_at_all() -> None:
    copies = files(1, 0, [True, False]) + files(0, 2, [False, True])

    motion = mcdc.collect(copies, SOURCES)["engine/motion"]

    assert motion.branches == {PLACE: mcdc.Branch("f", "a > 1", 1, 2)}
    assert motion.decisions == {PLACE: [True, True]}


def test_a_branch_that_was_never_taken_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    folders = mcdc.collect(files(0, 2, [True, True]), SOURCES)

    assert not mcdc.report(folders, SOURCES, [])

    assert "never true: engine/motion/f.c:5:9  if (a > 1 && b > 1) {" in capsys.readouterr().out


def test_a_branch_with_a_reason_is_excused() -> None:
    folders = mcdc.collect(files(0, 2, [True, True]), SOURCES)
    excuses = mcdc.read_excuses("# why\nengine/motion/f.c | f | a>1 | true | never so\n")

    assert mcdc.report(folders, SOURCES, excuses)


@pytest.mark.parametrize(
    "row", ["engine/motion/g.c | f | a > 1 | true", "engine/motion/f.c | g | a > 1 | true",
            "engine/motion/f.c | f | b > 1 | true", "engine/motion/f.c | f | a > 1 | false"]
)  # fmt: skip
def test_an_excuse_of_another_condition_or_function_is_none(row: str) -> None:
    folders = mcdc.collect(files(0, 2, [True, True]), SOURCES)

    assert not mcdc.report(folders, SOURCES, mcdc.read_excuses(f"{row} | never so\n"))


def test_an_excuse_outlives_what_stands_around_its_condition() -> None:
    sources = {
        "engine/motion/f.c": SOURCE.replace("if (a > 1 && b > 1) {", "if (a > 1 ||\n        b) {")
    }
    folders = mcdc.collect(files(0, 2, [True, True]), sources)

    assert mcdc.report(
        folders, sources, mcdc.read_excuses("engine/motion/f.c | f | a > 1 | true | never so\n")
    )


def test_an_excuse_is_for_one_of_equal_conditions() -> None:
    sources = {"engine/motion/f.c": SOURCE.replace("a > 1 && b > 1", "a > 1 && a > 1")}
    [first] = files(0, 2, [True, True])[:1]
    twice = {**first, "branches": [[5, 9, 5, 14, 0, 2, 0, 0, 4], [5, 18, 5, 23, 0, 2, 0, 0, 4]]}
    row = "engine/motion/f.c | f | a > 1 | true | never so\n"

    folders = mcdc.collect([twice], sources)

    assert not mcdc.report(folders, sources, mcdc.read_excuses(row))
    assert mcdc.report(folders, sources, mcdc.read_excuses(row + row))


def test_an_excuse_for_what_was_reached_is_an_error(capsys: pytest.CaptureFixture[str]) -> None:
    folders = mcdc.collect(files(1, 2, [True, True]), SOURCES)
    excuses = mcdc.read_excuses("engine/motion/f.c | f | a > 1 | true | never so")

    assert not mcdc.report(folders, SOURCES, excuses)

    assert "excused but reached" in capsys.readouterr().out


def test_conditions_that_were_not_shown_to_decide_are_too_few() -> None:
    assert not mcdc.report(mcdc.collect(files(1, 2, [True, False]), SOURCES), SOURCES, [])


def test_a_source_that_no_test_has_in_it_is_told() -> None:
    sources = {**SOURCES, "engine/motion/g.c": "", "engine/motion/g.h": ""}

    assert mcdc.never_linked(files(1, 2, [True, True]), sources) == ["engine/motion/g.c"]
